#!/bin/sh
# What a run leaves, read back by others' programs: h5dump, awk. Argument: the build folder. Prints TAP.
build=${1:-build}
selas=$PWD/$build/selas
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-results-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
failures=0
check() { # check WHAT COMMAND...: ok if the command succeeds
    what=$1
    shift
    if "$@" >"$work/said" 2>&1; then
        echo "ok - $what"
    else
        echo "not ok - $what"
        sed 's/^/# /' "$work/said"
        failures=$((failures + 1))
    fi
}
cat >"$work/small.nml" <<'END'
&scene title = 'A small half-space', dimension = 3, end_time = 3.0 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body name = 'ground', material = 'rock', shape = 'box', low = 0, 0, 0, high = 5, 5, 5, spacing = 0.5 /
&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'lysmer' /
&load face = 'z-', shape = 'square', centre = 2.5, 2.5, 0.0, size = 1.0, 1.0
  direction = 0, 0, 1, history = 'triangle', duration = 2.0 /
&receiver name = 'centre', position = 2.5, 2.5, 0.0 /
&receiver name = 'side', position = 3.3, 2.1, 0.4 /
&profile name = 'depth', from = 2.5, 2.5, 0.0, to = 2.5, 2.5, 5.0, points = 11, times = 1.0, 2.0, fields = 'velocity', 'stress' /
&snapshot every = 1.0, fields = 'velocity', 'pressure' /
&snapshot times = 1.5, fields = 'displacement', region = 0, 0, 0, 2, 5, 1 /
&output plots = .false., history_step = 0.1 /
END
cd "$work" || exit 1
check "the deck runs" "$selas" small.nml output%directory=out
for name in deck.nml centre.dat side.dat depth.dat run.h5 run.xdmf run_2.xdmf report.txt; do
    check "there is $name" test -s "out/$name"
done
check "no temporary file is left" sh -c '! ls out | grep -q "\.part$"'
check "h5dump reads all of run.h5" h5dump -o /dev/null out/run.h5
extent() { h5dump -H -d "$1" out/run.h5 | grep -q "SIMPLE { ( $2 ) /"; }
check "histories are rows x 7" extent /histories/side "31, 7"
check "a snapshot has 11^3 points x 3" extent /snapshots/0001/velocity "1331, 3"
check "a pressure has one component" extent /snapshots/0001/pressure "1331, 1"
check "a region has its own points" extent /snapshots/0002/displacement "165, 3"
check "the region's positions fit" extent /points/region_2/position "165, 3"
check "a setting is an attribute" sh -c 'h5dump -a /settings/body_1/spacing out/run.h5 | grep -q "(0): 0.5"'
check "the deck is in run.h5" sh -c 'h5dump -a /provenance/deck out/run.h5 | grep -q "A small half-space"'
same_numbers() { # histories in run.h5 and in the text file are the same numbers
    h5dump -y -w 0 -m %.17g -d /histories/side -o table out/run.h5 >/dev/null && tr -d ', \n' <table >a &&
        grep -v '^#' out/side.dat | tr -d ' \n' >b && cmp a b
}
check "run.h5 and side.dat hold the same numbers" same_numbers
in_the_file() { # every data set that run.xdmf names is in run.h5
    sed -n 's/.*run\.h5:\([^<]*\)<.*/\1/p' out/run.xdmf out/run_2.xdmf | sort -u >named
    test "$(wc -l <named)" -ge 9 || return 1
    while read -r set; do h5dump -H -d "$set" out/run.h5 >/dev/null || return 1; done <named
}
check "run.xdmf and run_2.xdmf name data sets that are there" in_the_file
# What gnuplot is told, by one that only listens.
mkdir listens && printf '#!/bin/sh\ncat >>"%s/script"\n' "$work" >listens/gnuplot && chmod +x listens/gnuplot
axes() { # axes ROTATION WORDS [OVERRIDE]...: the maps name their axes so
    rm -f script
    turn=$1 named=$2
    shift 2
    PATH="$work/listens:$PATH" "$selas" small.nml output%directory=turned output%plots=T body%rotation="$turn" scene%end_time=1 \
        'snapshot(1)%every=1' 'snapshot(2)%times=1' profile%times=1 "$@"
    grep -q "set xlabel 'x$named'" script && grep -q "set ylabel 'z$named'" script && grep -q "title .*surface z$named = 0[ (]" script
}
region() { # region CORNERS: what is told about snapshots of it
    rm -f script
    PATH="$work/listens:$PATH" "$selas" small.nml output%directory=turned output%plots=T scene%end_time=1 'snapshot(1)%every=1' \
        'snapshot(2)%times=1' "snapshot(2)%region=$1" profile%times=1
}
flat() { # a region that is a plane or a line is one map or one curve along its own axes
    region 0,0,0,2,5,0 && test "$(grep -c "set ylabel 'z'" script)" = 2 &&
        region 2,0,0,2,5,1 && grep -q "title .*at x = 2" script && grep -q "set xlabel 'y'" script &&
        region 2,1,0,2,1,1 && grep -q "title 'at x = 2, y = 1'" script && grep -q "set xlabel 'z'" script
}
below() { # a region below the surface is a cut
    region 0,0,.5,2,5,1
    grep -q "title .*surface z = 0[ (]" script && grep -q "title .*cut at z = 0.5" script && ! grep -q "title .*surface z = 0.5" script
}
check "maps name the deck's axes" axes 0,0,0 ""
check "a map below the surface is a cut" below
check "a flat region is one map or curve" flat
check "maps of a turned body name its own" axes 0,0,90 " of the body"
tilted() { # ... whose rounding is no place
    axes 0,45,0 " of the body" load%centre=1.982233047,2.5,-0.517766953 profile%from=2.5,2.5,1 profile%to=2.5,2.5,4
    grep -c "title .*surface z of the body = 0[ (]" script && ! grep "title .*= [-0-9.]*e-1" script
}
check "... which is 0 but for rounding" tilted
check "run.xdmf closes what it opens" awk '
    { while (match($0, /<\/?[A-Za-z]+[^>]*>/)) {
          tag = substr($0, RSTART, RLENGTH); $0 = substr($0, RSTART + RLENGTH)
          if (tag ~ /\/>$/) continue
          name = tag; gsub(/[<>\/]| .*/, "", name)
          if (tag ~ /^<\//) { if (open[depth--] != name) exit 1 } else open[++depth] = name } }
    END { if (depth != 0) exit 1 }' out/run.xdmf
check "the profile has two blocks of 11 rows of 4 + 3 + 6 columns" awk '
    !/^#/ && NF { rows++; if (NF != 13) bad = 1 } /^# t = / { blocks++ } END { exit !(rows == 22 && blocks == 2 && !bad) }' out/depth.dat
check "report.txt has a key and a value on every line" awk '!/^[^:]+: ./ { print; bad = 1 } END { exit bad }' out/report.txt
own_memory() { # started by a process of 300 MB the report tells of the run's own memory
    big=$(head -c 300000000 /dev/zero | tr '\0' x)
    "$selas" small.nml output%directory=of_large || return 1
    big=${big%%x*}
    awk -F': ' '$1 == "peak memory bytes" { seen = 1; large = $2 > 2e8 } END { exit large || !seen }' of_large/report.txt
}
check "the peak memory is the run's own" own_memory
check "the energy balance closes" awk -F': ' '$1 == "energy balance defect" { seen = 1; split($2, w, " "); if (w[1] > 0.02) exit 1 } END { if (!seen) exit 1 }' out/report.txt
check "the echoed deck runs" "$selas" out/deck.nml output%directory=again
grep -v '^#' out/side.dat >first
grep -v '^#' again/side.dat >second
check "... to the same bits" cmp first second
check "selas diff finds the runs the same" "$selas" diff out again
awk '/^#/ || $1 < 1.45 || $1 > 1.55 { print; next } { $7 += 1e-4; print }' again/side.dat >other
check "... and a changed value, exit 1" sh -c '"$0" diff out/side.dat other; test $? -eq 1' "$selas"
check "... unless it is allowed" "$selas" diff --atol=0.01 out/side.dat other
check "... and wants two names, exit 2" sh -c '"$0" diff out; test $? -eq 2' "$selas"
cat small.nml - >compared.nml <<'END'
&reference kind = 'file', file = 'out' /
END
check "a run is compared with another one's histories" "$selas" compared.nml output%directory=compared
check "... and is the same" awk '/^error largest:/ { found = 1; far = $3 > 1e-12 } END { exit far || !found }' compared/report.txt
tells() { # tells COUNT WORDS [OVERRIDE]...: so many warnings of reference 'file' with the words
    count=$1 words=$2
    shift 2
    "$selas" check compared.nml "$@" 2>&1 | grep "in reference 'file'" | grep -c "$words" | grep -qx "$count"
}
check "... a receiver that stands elsewhere is told of" tells 1 'stands elsewhere' 'receiver(1)%position=0.01,0,0'
check "... another low-pass once, of all receivers" tells 1 'low-pass is another' output%low_pass=5
check "... other units, too" tells 1 'units have other names' output%length_unit=km
check "... and nothing where all are the same" tells 0 .
check "with histories that end too early it is told, exit 2" sh -c \
    '"$0" compared.nml scene%end_time=4 output%directory=longer 2>said_longer; test $? -eq 2 && grep -q "goes from t = 0 to 3, the run from 0 to 4" said_longer' "$selas"
sed 's/kind = .file.*/kind = "bar" \//' compared.nml >wrong.nml
refuses() { # refuses WORDS DECK [OVERRIDE]...: `selas check` exits 2 with the words, behind the plan
    words=$1
    shift
    "$selas" check "$@" >plan 2>said
    test $? -eq 2 && grep -q "$words" said && grep -q '^steps: ' plan
}
check "selas check refuses them, too" refuses 'goes from t = 0 to 3, the run from 0 to 4' compared.nml scene%end_time=4
check "... and takes what the run takes" "$selas" check compared.nml
check "... and refuses an exact solution that there is not" refuses "reference 'bar': the bar is one-dimensional" \
    wrong.nml
check "... and the results are there" test -s longer/run.h5 -a -s longer/centre.dat -a ! -e longer/centre.exact.dat
# a second run into a folder
sed 's/side/far/; s/depth/deep/; s/^&snapshot.*//' small.nml >second.nml
cp -r out both
echo mine >both/notes.dat
check "another run into the same folder" "$selas" second.nml output%directory=both
check "... takes away what the first one left and it does not write" sh -c \
    '! ls both/side.dat both/depth.dat both/run.xdmf both/run_2.xdmf 2>/dev/null | grep -q .'
check "... leaves what is not selas's" grep -qx mine both/notes.dat
check "... and has all of its own" test -s both/centre.dat -a -s both/far.dat -a -s both/deep.dat -a -s both/run.h5
check "selas diff compares the receivers of run.h5" sh -c \
    'cp -r out more && cp out/side.dat more/stranger.dat && "$0" diff out more && "$0" diff more out' "$selas"
check "... and misses one that is not there" sh -c \
    'rm more/side.dat; "$0" diff out more >said; test $? -eq 1 && grep -q "side .*is not in more" said' "$selas"
told() { # told STATUS WORDS A B [OPTION]...: `selas diff` ends with the status and says the words
    status=$1 words=$2
    shift 2
    "$selas" diff --no-plots "$@" >said 2>&1
    test $? -eq "$status" && grep -q "$words" said
}
words() { # words OLD NEW: out as another run would tell of it
    rm -rf worded && cp -r out worded && sed "/^#/s/$1/$2/" out/side.dat >worded/side.dat
}
set -- $(awk '/^# history/ { print $(NF - 2), $(NF - 1), $NF }' out/side.dat)
words " $1 $2 $3\$" " $1 $2 1.25"
check "selas diff tells where a receiver stands elsewhere" told 0 "side: the receiver stands elsewhere: at $1 $2 $3 in out, at $1 $2 1.25 in worded" out worded
words " $3\$" " $3.00000000000001"
check "... but for rounding" sh -c '! "$0" diff --no-plots out worded 2>&1 | grep elsewhere' "$selas"
words "units: .*" "units: lengths in km"
check "... and of other units" told 0 "the units have other names: .* in out, lengths in km in worded" out worded
words "^# t ux" "# low-passed: spectrum times exp(-(omega\/9)^4), zero phase\n# t ux"
check "... and of another low-pass" told 0 "the low-pass is another one: none in out, spectrum times .* in worded" out worded
sed '$s/ [^ ]*$/ nan/' out/side.dat >nan.dat
check "... and takes no NaN" told 1 "nan.dat:[0-9]*: a value is not finite" out/side.dat nan.dat
check "... on either side" told 1 "nan.dat:[0-9]*: a value is not finite" nan.dat out/side.dat --atol=10
awk '/^#/ { print; next } { print $1, 0, 0, 0, 0, 0, 0 }' out/side.dat >zero.dat
check "... and names what is absolute" told 1 "side\|zero .* (L2 and Linf absolute: the first run is zero)" zero.dat out/side.dat
check "... which is said of no other" sh -c '! "$0" diff --no-plots out/side.dat zero.dat | grep absolute' "$selas"
awk '/^#/ || n++ % 8 == 0' out/side.dat >coarse.dat
check "... and what interpolation between rows makes" told 1 "interpolation between rows alone errs by" out/side.dat coarse.dat
refused() { # refused WORDS DECK [OVERRIDE]...: exit 1, with the words
    words=$1
    shift
    "$selas" "$@" 2>said
    test $? -eq 1 && grep -q "$words" said
}
mkdir own theirs
cp small.nml own/deck.nml
check "a run does not overwrite its deck" refused "own/deck.nml', which the deck is read from" own/deck.nml output%directory=own
check "... the deck is as it was" cmp small.nml own/deck.nml
check "... nor one that an earlier run has left" refused "out/deck.nml', which the deck is read from" out/deck.nml output%directory=out
echo mine | tee theirs/report.txt >theirs/centre.exact.dat
check "a run does not overwrite what is no result" refused "'theirs/report.txt' is no result of selas" small.nml output%directory=theirs
check "... nor do exact histories" refused "'theirs/centre.exact.dat' is no result of selas" exact compared.nml output%directory=theirs
check "... it is as it was" grep -qx mine theirs/report.txt theirs/centre.exact.dat
cp -r out killed
"$selas" small.nml output%directory=killed body%spacing=0.25 scene%end_time=6000 >/dev/null 2>&1 &
run=$!
sleep 1
kill -9 $run 2>/dev/null
wait $run 2>/dev/null
check "a killed run leaves the older run.h5" cmp out/run.h5 killed/run.h5
check "... and no half files" sh -c '! ls killed | grep -q "\.part$"'
touch file
check "a folder that cannot be made is told, exit 1" sh -c '"$0" small.nml output%directory=file/out; test $? -eq 1' "$selas"
# a box shut on all sides whose load acts on after end_time, when the run goes on for the time-dispersion transform
cat >shut.nml <<'END'
&scene dimension = 2, end_time = 3.0 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body material = 'rock', low = 0, 0, high = 5, 5, spacing = 0.25 /
&load kind = 'body-force', shape = 'point', centre = 2.5, 2.0, direction = 0, 1, history = 'gaussian', width = 0.6, delay = 3.0 /
&receiver name = 'side', position = 3.3, 2.1 /
&output plots = .false. /
END
# shellcheck disable=SC2086
of_one_time() { # work and energy of the report belong to one time
    "$selas" -q shut.nml output%directory="shut$1" $2 && awk -F': ' '{ of[$1] = $2 + 0 }
        END { e = of["energy kinetic"] + of["energy strain"] + of["energy absorbed"]; w = of["work of loads"]; print e, w
            exit !(w > 0 && e > .99 * w && e < 1.01 * w) }' "shut$1/report.txt"
}
check "the work of a load that acts on is that of the energy told" of_one_time 1 ""
check "and what dampers absorbed" of_one_time 2 "boundary%face=all boundary%kind=transmitting boundary%layer=lysmer"
# strains that snapshots of straight pieces (degree 1) show at points are those between the points beside them
cat >pieces.nml <<'END'
&scene dimension = 1, end_time = 3.0 /
&method degree = 1 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body material = 'rock', low = 0, high = 10, spacing = 0.25 /
&load face = 'x-', direction = 1, history = 'gaussian', width = 0.4, delay = 1.6 /
&snapshot times = 3, fields = 'displacement', 'strain' /
&output plots = .false. /
END
between() {
    "$selas" -q pieces.nml output%directory=pieces &&
        for field in displacement strain; do
            h5dump -y -w 0 -m %.9g -d /snapshots/0000/$field -o table pieces/run.h5 >/dev/null && tr ',' '\n' <table | grep . >$field.txt
        done
    awk 'FNR == NR { if (FNR % 3 == 1) u[n++] = $1; next } FNR % 6 == 1 { e[m++] = $1 }
        END { for (i = 1; i + 1 < n; i++) { d = e[i] - (u[i + 1] - u[i - 1]) / .5; d = d < 0 ? -d : d; if (d > worst) worst = d
            s = e[i] < 0 ? -e[i] : e[i]; if (s > most) most = s }; print worst, most, n, m; exit !(m == 41 && n == 41 && worst < 1e-5 * most) }' \
        displacement.txt strain.txt
}
check "degree 1: strains at points are those between their neighbours" between
# velocities of profiles and energies are of the modified equation's order, too
cat >passing.nml <<'END'
&scene dimension = 1, end_time = 6.0 /
&material name = 'rock', density = 1.0, p_speed = 1.0, s_speed = 0.5 /
&body material = 'rock', low = 0, high = 12, spacing = 0.1 /
&initial kind = 'plane-wave', direction = 1, centre = 3, width = 0.5, amplitude = 0.001 /
&receiver name = 'there', position = 8.5 /
&profile name = 'line', from = 8.5, to = 9.5, points = 2, times = 3, 5, 6 /
&output plots = .false., history_step = 1 /
END
of_order_4() {
    "$selas" -q passing.nml output%directory=passing && grep -v '^#' passing/line.dat | awk 'NF && $2 == 8.5 { print $5 }' >shown.txt &&
        grep -v '^#' passing/there.dat | awk 'NR == 4 || NR == 6 || NR == 7 { print $5 }' | paste - shown.txt |
        awk '{ d = $1 - $2; d = d < 0 ? -d : d; if (d > worst) worst = d } END { print worst; exit !(NR == 3 && worst < 2e-6) }' &&
        awk -F': ' '{ of[$1] = $2 + 0 } END { r = of["energy kinetic"] / of["energy strain"]; print r; exit !(r > .999 && r < 1.001) }' \
            passing/report.txt
}
check "velocities of profiles are those of histories" of_order_4
exit $((failures > 0))
