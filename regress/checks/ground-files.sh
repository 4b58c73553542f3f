#!/bin/sh
# The ground from a file and its plot, through the program: an even tomography_model.xyz gives the histories of an even
# body, wrong files are refused with their place and exit status 2, `selas check --plot` leaves a picture before anything is
# computed and overwrites no foreign file. Argument: the build folder. Prints TAP.
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
export OMP_NUM_THREADS=1
ok() { # ok TITLE CONDITION...
    title=$1
    shift
    if "$@"; then echo "ok - $title"; else echo "not ok - $title"; fi
}
says() { # says LOG TEXT...
    log=$1
    shift
    for text in "$@"; do grep -qF -- "$text" "$log" || return 1; done
}
# 3 x 3 x 3 values over 2000 x 2000 x 1000; $1: awk that may change line n, x y z vp vs rho
model() {
    awk "BEGIN {
        print \"0 0 -1000 2000 2000 0\"; print \"1000 1000 500\"; print \"3 3 3\"; print \"100 9000 100 9000 100 9000\"
        for (k = 0; k < 3; k++) for (j = 0; j < 3; j++) for (i = 0; i < 3; i++) {
            n++; x = 1000 * i; y = 1000 * j; z = 500 * k - 1000; vp = 3000; vs = 1700; rho = 2500
            $1
            print x, y, z, vp, vs, rho
        }
    }" >"$out/m.xyz"
}
cat >"$out/d.nml" <<D
&scene title = 'ground', dimension = 3, end_time = 0.4 /
&method operator = 'general' /
&body low = 0, 0, 0, high = 2000, 2000, 1000, spacing = 100 /
&load face = 'z-', shape = 'square', centre = 1000, 1000, 0, size = 400, 400, direction = 0, 0, 1, history = 'gaussian', width = .05, delay = .2, amplitude = 1e6 /
&receiver name = 'r', position = 1400, 1200, 0 /
D
cp "$out/d.nml" "$out/even.nml"
echo "&material name = 'rock', density = 2500, p_speed = 3000, s_speed = 1700 /" >>"$out/even.nml"
echo "&model file = 'm.xyz' /" >>"$out/d.nml"
selas() { "$build/selas" "$@" >"$out/log" 2>&1; }

model ""
"$build/selas" -q "$out/d.nml" output%directory="$out/model" && "$build/selas" -q "$out/even.nml" body%material=rock output%directory="$out/even" output%plots=F
"$build/selas" diff "$out/model/r.dat" "$out/even/r.dat" --rtol=1e-9 >"$out/log" 2>&1
ok "an even model: the histories of an even body" test $? = 0
# 41 x 3 x 9 values, all rows back to front, of which every 16th has its place kept
awk 'BEGIN {
    print "2000 2000 0 0 0 -1000"; print "-50 -1000 -125"; print "41 3 9"; print "100 9000 100 9000 100 9000"
    for (k = 0; k < 9; k++) for (j = 0; j < 3; j++) for (i = 0; i < 41; i++)
        print 2000 - 50 * i, 2000 - 1000 * j, -125 * k, 3000 + 7 * ((i * i + 3 * j + k) % 11), 1700 + (i * k + j) % 13, 2500
}' >"$out/back.xyz"
for kept in 0 1e6; do SELAS_MODEL_KEPT=$kept "$build/selas" -q "$out/d.nml" model%file=back.xyz output%plots=F output%directory="$out/back$kept"; done
ok "a text in pieces: the histories of the whole one" cmp -s "$out/back0/r.dat" "$out/back1e6/r.dat"
ok "its pieces are those of the report" says "$out/back0/report.txt" "ground values read for the lattice: 26568 of 26568 bytes"
in_pieces() { SELAS_MODEL_KEPT=0 "$build/test/test_model_files" >"$out/log" 2>&1; }
[ ! -x "$build/test/test_model_files" ] || ok "models in pieces: values, faults and air as of whole ones" in_pieces
little() { (ulimit -v 110000 && "$build/test/test_model_memory") >"$out/log" 2>&1; }
[ ! -x "$build/test/test_model_memory" ] || [ -n "${SELAS_SANITIZED:-}" ] || ok "a model of 180 MB in a process of 110 MB" little
ok "a run on ground from a file draws it" test -s "$out/model/ground.png"
ok "the plan says how depth is taken" says "$out/model/report.txt" "depth 0 is its elevation 0"

# what a file holds above the surface is not there, as with layers
for top in 3000 900; do
    awk -v top=$top 'BEGIN {
        print "0 0 -1000 2000 2000 0"; print "1000 1000 125"; print "3 3 9"; print "100 9000 100 9000 100 9000"
        for (k = 0; k < 9; k++) for (j = 0; j < 3; j++) for (i = 0; i < 3; i++) {
            speed = k == 8 ? top : 3000
            print 1000 * i, 1000 * j, 125 * k - 1000, speed, speed * 17 / 30, 2500
        }
    }' >"$out/$top.xyz"
    printf '0 0 -130\n2000 0 -130\n0 2000 -130\n2000 2000 -130\n' >"$out/heights.txt"
    "$build/selas" -q "$out/d.nml" model%file="$top.xyz" topography%file=heights.txt receiver%position=1400,1200 receiver%depth=0 load%depth=0 \
        load%centre=1000,1000 output%plots=F output%directory="$out/cut$top" >"$out/log" 2>&1
done
"$build/selas" diff "$out/cut3000/r.dat" "$out/cut900/r.dat" --rtol=1e-9 >>"$out/log" 2>&1
ok "what a model holds above the surface is not seen" test $? = 0

# a row of heavy rock between values a sixteenth of the spacing apart counts as layers that go over into it
awk 'BEGIN {
    print "0 0 -1000 2000 2000 0"; print "2000 2000 6.25"; print "2 2 161"; print "100 9000 100 9000 100 99000"
    for (k = 0; k < 161; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++)
        print 2000 * i, 2000 * j, 6.25 * k - 1000, 3000, 1700, k == 145 ? 12500 : 2500
}' >"$out/row.xyz"
cat "$out/even.nml" - >"$out/rows.nml" <<'D'
&material name = 'heavy', density = 12500, p_speed = 3000, s_speed = 1700 /
&layer material = 'rock', top = 0 /
&layer material = 'rock', bottom = 'heavy', top = 87.5 /
&layer material = 'heavy', bottom = 'rock', top = 93.75 /
&layer material = 'rock', top = 100 /
D
"$build/selas" -q "$out/d.nml" model%file=row.xyz output%directory="$out/row" output%plots=F && "$build/selas" -q "$out/rows.nml" body%material=rock output%directory="$out/rows" output%plots=F
"$build/selas" diff "$out/row/r.dat" "$out/rows/r.dat" --rtol=1e-2 >"$out/log" 2>&1
ok "a thin row of a model: the histories of thin layers" awk '$1 == "r" { n++; if (!($3 < 3e-3)) exit bad = 1 } END { exit bad || n != 6 }' "$out/log"

# a dike of heavy rock between values a sixteenth of the spacing apart counts wherever it lies
for row in 202 203; do
    awk -v row=$row 'BEGIN {
        print "0 0 -1000 2000 2000 0"; print "2000 6.25 1000"; print "2 321 2"; print "100 9000 100 9000 100 99000"
        for (k = 0; k < 2; k++) for (j = 0; j < 321; j++) for (i = 0; i < 2; i++)
            print 2000 * i, 6.25 * j, 1000 * k - 1000, 3000, 1700, j == row ? 12500 : 2500
    }' >"$out/dike.xyz"
    "$build/selas" -q "$out/d.nml" model%file=dike.xyz output%directory="$out/dike$row" output%plots=F
done >"$out/log" 2>&1
"$build/selas" diff "$out/dike202/r.dat" "$out/dike203/r.dat" --rtol=1 >"$out/log" 2>&1
ok "a dike of a model: the same ones wherever it lies between columns" awk '$1 == "r" { n++; if (!($3 < 1e-2)) exit bad = 1 } END { exit bad || n != 6 }' "$out/log"

# a thin layer over which the speeds rise tenfold counts as thin even ones
{
    cat "$out/even.nml"
    echo "&material name = 'soft', density = 2500, p_speed = 300, s_speed = 170 /"
    printf "&layer material = 'rock', top = 0 /\n&layer material = 'soft', bottom = 'rock', top = 110 /\n&layer material = 'rock', top = 135 /\n"
} >"$out/rises.nml"
{
    cat "$out/even.nml"
    echo "&layer material = 'rock', top = 0 /"
    awk 'BEGIN { for (k = 0; k < 128; k++) {
        part = .1 + .9 * (k + .5) / 128
        printf "&material name = \047m%d\047, density = 2500, p_speed = %.9g, s_speed = %.9g /\n", k, 3000 * part, 1700 * part
        printf "&layer material = \047m%d\047, top = %.9g /\n", k, 110 + 25 * k / 128
    } }'
    echo "&layer material = 'rock', top = 135 /"
} >"$out/evens.nml"
for deck in rises evens; do "$build/selas" -q "$out/$deck.nml" body%material=rock output%directory="$out/$deck" output%plots=F; done >"$out/log" 2>&1
"$build/selas" diff "$out/rises/r.dat" "$out/evens/r.dat" --rtol=1e-2 >"$out/log" 2>&1
ok "a thin graded layer: the histories of thin even ones" awk '$1 == "r" { n++; if (!($3 < 3e-3)) exit bad = 1 } END { exit bad || n != 6 }' "$out/log"

# the same with Q in columns 7 and 8
model ""
sed '5,$s/$/ 40 20/' "$out/m.xyz" >"$out/q.xyz" && sed '/^&model/d; s/&method /\&method mechanisms = 2, /' "$out/d.nml" >"$out/dq.nml"
cp "$out/dq.nml" "$out/evenq.nml"
echo "&model file = 'q.xyz', q_frequency = 3 /" >>"$out/dq.nml"
echo "&material name = 'rock', density = 2500, p_speed = 3000, s_speed = 1700, q_p = 40, q_s = 20, q_frequency = 3 /" >>"$out/evenq.nml"
"$build/selas" -q "$out/dq.nml" output%directory="$out/modelq" output%plots=F && "$build/selas" -q "$out/evenq.nml" body%material=rock output%directory="$out/evenq" output%plots=F
"$build/selas" diff "$out/modelq/r.dat" "$out/evenq/r.dat" --rtol=1e-9 >"$out/log" 2>&1
ok "an even damped model: the histories of an even damped body" test $? = 0
sed -i 's/q_frequency = 3/q_frequency = 200/' "$out/evenq.nml"
"$build/selas" -q "$out/dq.nml" model%q_frequency=200 output%directory="$out/modelf" output%plots=F && "$build/selas" -q "$out/evenq.nml" body%material=rock output%directory="$out/evenf" output%plots=F
"$build/selas" diff "$out/modelf/r.dat" "$out/evenf/r.dat" --rtol=1e-9 >"$out/log" 2>&1
ok "the same with a q_frequency beyond the source's band" test $? = 0
"$build/selas" diff "$out/model/r.dat" "$out/evenq/r.dat" --rtol=1e-2 >"$out/log" 2>&1
ok "which are not those without Q" test $? = 1
"$build/selas" -q "$out/dq.nml" model%damped=F model%q_frequency= method%mechanisms= output%directory="$out/withoutq" output%plots=F
"$build/selas" diff "$out/model/r.dat" "$out/withoutq/r.dat" --rtol=1e-12 >"$out/log" 2>&1
ok "model%damped = .false.: those without Q" test $? = 0

refused() { # refused TITLE TEXT...
    selas check "$out/d.nml"
    status=$?
    wrong=$1
    shift
    ok "refused: $wrong" test "$status" = 2
    ok "with its place: $wrong" says "$out/log" "$@"
}
model "if (n == 5) vs = -1700"
refused "a negative speed" "line 9" "s_speed -1700"
model "if (n == 5) x = 900"
refused "uneven rows" "line 9" "x = 900; expected 1000"
model "vp /= 1000; vs /= 1000"
sed 's/^100 9000 100 9000/1 9 1 9/' "$out/m.xyz" >"$out/km.xyz" && mv "$out/km.xyz" "$out/m.xyz"
refused "km/s" "p_speed 3," "m/s, not km/s"
model "if (n == 20) exit"
refused "cut short" "ends after 19 of 3 x 3 x 3"
model ""
sed 's/high = 2000, 2000, 1000/high = 2000, 2000, 1100/' "$out/d.nml" >"$out/deep.nml"
mv "$out/deep.nml" "$out/d.nml"
refused "a body below the model" "from 0 to 1000 along z" "from 0 to 1100"

# plots
plot() { # plot NAME DECK WORDS...
    name=$1 deck=$2
    shift 2
    timeout 100 "$build/selas" check --plot "$deck" output%directory="$out/$name" "$@" >"$out/log" 2>&1
    ok "a picture of $name" test -s "$out/$name/ground.png"
    test -s "$out/$name/ground.png" || head -3 "$out/log" | sed 's/^/# /'
}
plot "even ground" "$out/even.nml" body%material=rock
cat >"$out/two.nml" <<D
&scene dimension = 2, end_time = 1 /
&material name = 'rock', density = 2.5, p_speed = 4, s_speed = 2.3 /
&material name = 'soil', density = 2.0, p_speed = 2, s_speed = 1 /
&body material = 'rock', low = 0, 0, high = 12, 5, spacing = .25 /
&block material = 'soil', shape = 'ellipsoid', centre = 6, 5, size = 6, 3 /
&boundary face = 'x-', 'x+', 'y-', kind = 'transmitting', layer = 'pml' /
&load face = 'y+', shape = 'square', centre = 3, 5, size = .5, direction = 0, -1, history = 'gaussian', width = 0.3, delay = 1.5 /
D
plot "two dimensions" "$out/two.nml"
cat >"$out/hill.nml" <<D
&scene dimension = 2, end_time = 1 /
&material name = 'rock', density = 2.5, p_speed = 4, s_speed = 2.3 /
&body material = 'rock', low = 0, 0, high = 12, 5, spacing = .25 /
&topography shape = 'gaussian', height = 1, centre = 6, width = 1 /
&load kind = 'body-force', shape = 'point', centre = 3, 2, direction = 0, 1, history = 'gaussian', width = 0.3, delay = 1.5 /
D
plot "a hill" "$out/hill.nml"
mkdir "$out/bin" && printf '#!/bin/sh\ncat >"%s/script"\n' "$out" >"$out/bin/gnuplot" && chmod +x "$out/bin/gnuplot"
PATH="$out/bin:$PATH" selas check --plot "$out/hill.nml" 'boundary%face=x-,x+' 'boundary%kind=transmitting' output%directory="$out/air"
ok "absorbing layers beside a hill end at the surface" \
    awk '/^\$/ { in_layers = /^\$layers0/ } in_layers && NF == 2 { n++; if ($2 < -.1) exit bad = 1 } END { exit bad || n < 10 }' "$out/script"
mkdir "$out/foreign" && echo mine >"$out/foreign/ground.png"
selas check --plot "$out/two.nml" output%directory="$out/foreign"
ok "a foreign picture is not overwritten" test "$(cat "$out/foreign/ground.png")" = mine
cat >"$out/bar.nml" <<D
&scene dimension = 1, end_time = 1 /
&material name = 'rock', density = 1, young = 1, poisson = 0 /
&body material = 'rock', low = 0, high = 1, spacing = .1 /
&initial kind = 'uniform-velocity', velocity = 1 /
D
selas check --plot "$out/bar.nml" output%directory="$out/bar"
ok "one dimension has none" says "$out/log" "no plot of the ground"
selas --plot "$out/two.nml"
ok "--plot goes with check" says "$out/log" "--plot goes with check"
