#!/bin/sh
# Damped ground: the half-space of input/damped.nml against velocities for constant Q that another program computed (regress/reference/damped) and
# against the exact solution for the run's own mechanisms; Q without end; what is refused (doc/theory/damping.md).
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
OMP_NUM_THREADS=1
export OMP_NUM_THREADS
selas=$build/selas

run() { # run NAME Q_P Q_S WORDS...
    name=$1 p=$2 s=$3
    shift 3
    "$selas" -q input/damped.nml material%q_p="$p" material%q_s="$s" output%plots=F output%directory="$out/$name" "$@" >"$out/$name.log" 2>&1 || cat "$out/$name.log"
}
check() { # check TITLE CONDITION...
    title=$1
    shift
    if "$@"; then echo "ok - $title"; else echo "not ok - $title"; fi
}
less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a + 0 < b + 0) }'; }
error() { sed -n "s/^error $2 vz: L2 \([^ ]*\).*/\1/p" "$out/$1/report.txt"; }
# L2 of v_z off a file of the reference, over that of the reference, at the times that both have
off() { # off NAME RECEIVER FILE
    awk '/^#/ { next } FILENAME ~ /csv$/ { split($0, c, ","); z[sprintf("%.6f", c[1])] = c[3]; next }
        { t = sprintf("%.6f", $1) } t in z { d += ($7 - z[t])^2; s += z[t]^2; n++ } END { if (n > 90) printf "%.5f", sqrt(d / s) }' \
        "regress/reference/damped/$3.csv" "$out/$1/$2.dat"
}

for q in "20 20" "100 50"; do
    p=${q% *} s=${q#* }
    run "q$p" "$p" "$s" reference%spectrum=scheme
    receiver=0
    for limits in ".0010 .0012" ".0015 .0020" ".0022 .0030"; do
        e=$(error "q$p" "r$receiver")
        check "Q $p/$s, own mechanisms: v_z at r$receiver errs by $e" less "$e" "${limits% *}"
        e=$(off "q$p" "r$receiver" "const_${p}_${s}_x$receiver")
        check "Q $p/$s, constant Q by another program: v_z at r$receiver errs by $e" less "$e" "${limits#* }"
        receiver=$((receiver + 1))
    done
done

# a q_frequency far outside the source's band: what is wanted is met in the band
for frequency in 0.005 50; do
    run away 20 20 material%q_frequency=$frequency
    for receiver in "r0 .002" "r1 .003" "r2 .0045"; do
        e=$(error away "${receiver% *}")
        check "q_frequency $frequency, constant Q: v_z at ${receiver% *} errs by $e" less "$e" "${receiver#* }"
    done
done

# without damping the same histories, but for what Q = 1e6 does
small="body%spacing=0.25 scene%end_time=5 stepping%time_step=0.04"
run large 1e6 1e6 $small
grep -v 'q_p =' input/damped.nml >"$out/plain.nml"
sed -i "s/s_speed = 1.0/s_speed = 1.0 \//; /^&material/,/^\/$/ { /^\/$/d }" "$out/plain.nml"
"$selas" -q "$out/plain.nml" $small output%plots=F output%directory="$out/plain" >"$out/plain.log" 2>&1 || cat "$out/plain.log"
apart() {
    paste "$out/$1/r2.dat" "$out/$2/r2.dat" | awk '!/^#/ { d += ($7 - $14)^2; s += $7^2 } END { printf "%.2e", sqrt(d / s) }'
}
check "Q = 1e6 is $(apart plain large) off no damping" less "$(apart plain large)" 1e-5

# steps in one pass, with one operator and with two, are steps pass by pass, but for rounding; in single precision too
for p in 20 40; do
    run pass $p 20 $small
    run passes $p 20 $small method%fused=F
    run single $p 20 $small method%precision=single
    check "Q $p/20: one pass is $(apart passes pass) off pass by pass" less "$(apart passes pass)" 1e-11
    check "and the plan says so" grep -q "^step: leapfrog's is one pass" "$out/pass/report.txt"
    said=$(sed -n 's/^single precision adds: about \([^ ]*\) of .*/\1/p' "$out/single/report.txt")
    check "Q $p/20: single precision is $(apart passes single) off, said: $said" less "$(apart passes single)" "$said"
done

# the general operator on damped layers: against the exact solution for its own mechanisms as without damping
cat >"$out/general.nml" <<END
&scene dimension = 3, end_time = 5.0 /
&method mechanisms = 3, operator = 'general' /
&material name = 'rock', density = 1.5, lambda = 4.0, mu = 4.0, q_p = 60.0, q_s = 40.0, q_frequency = 0.5 /
&material name = 'soil', density = 1.0, lambda = 1.0, mu = 1.0, q_p = 20.0, q_s = 12.0, q_frequency = 0.5 /
&body material = 'rock', shape = 'half-space', spacing = 0.25 /
&layer material = 'soil', top = 0.0 /
&layer material = 'rock', top = 0.75 /
&load face = 'z-', shape = 'square', centre = 3*0.0, size = 1.0, 1.0, direction = 0.0, 0.0, 1.0, history = 'gaussian', width = 0.6, delay = 2.4 /
&receiver name = 'r', position = 0.6, 0.4, 0.0 /
&receiver name = 'd', position = 0.6, 0.4, 1.0 /
&reference kind = 'layered', spectrum = 'scheme', tolerance = 1e-4 /
&output plots = .false. /
END
"$selas" -q "$out/general.nml" output%directory="$out/general" >"$out/log" 2>&1 || cat "$out/log"
sed 's/, q_p = .*0.5//; s/mechanisms = 3, //' "$out/general.nml" | sed "s/, spectrum = 'scheme'//" >"$out/elastic.nml"
"$selas" -q "$out/elastic.nml" output%directory="$out/elastic" >"$out/log" 2>&1 || cat "$out/log"
one=$(sed -n 's/^error largest: \([^ ]*\).*/\1/p' "$out/general/report.txt") other=$(sed -n 's/^error largest: \([^ ]*\).*/\1/p' "$out/elastic/report.txt")
check "general operator, damped layers: error $one, undamped $other" awk "BEGIN { exit !($one > 0 && $one < 1.2 * $other) }"

# the same layers in a box by words, as a block of a model of rock, and as a model whose step is a ramp of 20
awk 'BEGIN { print "-1000 -1000 -2000 2000 2000 0"; print "3000 3000 20"; print "2 2 101"; print "1 9999 1 9999 1 9999"
    for (k = 0; k < 101; k++) for (j = 0; j < 2; j++) for (i = 0; i < 2; i++) { z = 2000 - 20 * k
        print 3000 * i - 1000, 3000 * j - 1000, -z, z < 750 ? "1732.05081 1000 1000 20 12" : "2828.42712 1632.99316 1500 60 40" } }' >"$out/soil.xyz"
sed 's/ 1732.05081 .*/ 2828.42712 1632.99316 1500 60 40/' "$out/soil.xyz" >"$out/rock.xyz"
cat >"$out/box-model.nml" <<END
&scene dimension = 3, end_time = 4.0 /
&method mechanisms = 3, operator = 'general' /
&body low = -1000, -1000, 0, high = 1000, 1000, 2000, spacing = 250 /
&load face = 'z-', shape = 'square', centre = 3*0.0, size = 1000.0, 1000.0, direction = 0.0, 0.0, 1.0, history = 'gaussian', width = 0.6, delay = 2.4 /
&receiver name = 'r', position = 600, 400, 0.0 /
&stepping time_step = 0.03 /
&output plots = .false. /
END
materials="&material name = 'rock', density = 1500, p_speed = 2828.42712, s_speed = 1632.99316, q_p = 60.0, q_s = 40.0, q_frequency = 0.5 /
&material name = 'soil', density = 1000, p_speed = 1732.05081, s_speed = 1000, q_p = 20.0, q_s = 12.0, q_frequency = 0.5 /"
{ cat "$out/box-model.nml"; echo "$materials"; } | sed "s/&body/\&layer material = 'soil', top = 0.0 \/\n\&layer material = 'rock', top = 750 \/\n&/" >"$out/box-words.nml"
{ cat "$out/box-model.nml"; echo "$materials" | tail -1; echo "&model file = 'rock.xyz', q_frequency = 0.5, origin = 0, 0 /
&block material = 'soil', shape = 'box', centre = 0, 0, -2125, size = 9999, 9999, 5750 /"; } >"$out/box-block.nml"
echo "&model file = 'soil.xyz', q_frequency = 0.5, origin = 0, 0 /" >>"$out/box-model.nml"
for ground in words block model; do
    "$selas" -q "$out/box-$ground.nml" output%directory="$out/box-$ground" >"$out/log" 2>&1 || cat "$out/log"
done
off_words() { paste "$out/box-words/r.dat" "$out/$1/r.dat" | awk '!/^#/ { d += ($7 - $14)^2; s += $7^2 } END { printf "%.2e", sqrt(d / s) }'; }
check "a block in a damped model: $(off_words box-block) off the layer" less "$(off_words box-block)" 1e-4
check "a damped model: $(off_words box-model) off the layer" less "$(off_words box-model)" 6e-3

# what damping takes, by the balance of energy and measured: errors fall as the square of the step
cat >"$out/box.nml" <<END
&scene dimension = 3, end_time = 6.0 /
&material name = 'rock', density = 1.0, p_speed = 1.7320508, s_speed = 1.0, q_p = 40.0, q_s = 20.0, q_frequency = 0.5 /
&body material = 'rock', shape = 'box', low = -2, -2, 0, high = 2, 2, 2, spacing = 0.25 /
&load face = 'z-', shape = 'square', centre = 3*0.0, size = 1.0, 1.0, direction = 0.0, 0.0, 1.0, history = 'gaussian', width = 0.5, delay = 2.0 /
&output plots = .false. /
END
for step in 0.05 0.025; do
    "$selas" -q "$out/box.nml" stepping%time_step=$step output%balance=T output%directory="$out/balance$step" >"$out/log" 2>&1 || cat "$out/log"
done
"$selas" -q "$out/box.nml" stepping%time_step=0.025 output%directory="$out/unasked" >"$out/log" 2>&1 || cat "$out/log"
figure() { sed -n "s/^energy $2: \([^ ]*\).*/\1/p" "$out/$1/report.txt"; }
coarse=$(figure balance0.05 'balance defect') fine=$(figure balance0.025 'balance defect')
check "balance of energy: $coarse, at half the step $fine" awk "BEGIN { exit !($fine < 5e-4 && $coarse / $fine > 3.5 && $coarse / $fine < 4.5) }"
one=$(figure unasked 'taken by damping') other=$(figure balance0.025 'taken by damping')
check "damping takes $other, by what is left $one" awk "BEGIN { off = $one - $other; exit !($one > .04 && off * off < (5e-4 * .2241)^2) }"

# motion at t = 0, where leapfrog's transform cannot run: against short steps; by the scheme that the program takes, by its own step and fitted through it
cat >"$out/moving.nml" <<END
&scene dimension = 2, end_time = 6.0 /
&material name = 'rock', density = 1.0, p_speed = 1.7320508, s_speed = 1.0, q_p = 40.0, q_s = 20.0, q_frequency = 0.5 /
&body material = 'rock', shape = 'box', low = -3.0, 0.0, high = 3.0, 4.0, spacing = 0.1 /
&initial kind = 'gaussian', centre = 0.3, 1.7, width = 0.4, direction = 0.0, 1.0, amplitude = 0.01 /
&receiver name = 'r', position = -2.0, 1.2 /
&output plots = .false. /
END
moving() { # moving NAME WORDS...: L2 of the velocities off those of "short", at the times that both have
    name=$1
    shift
    "$selas" -q "$out/moving.nml" output%directory="$out/$name" "$@" >"$out/log" 2>&1 || cat "$out/log"
    awk '/^#/ { next } { t = sprintf("%.5f", $1) } FNR == NR { x[t] = $5; y[t] = $6; next }
        t in x { d += ($5 - x[t])^2 + ($6 - y[t])^2; s += x[t]^2 + y[t]^2; n++ } END { if (n > 150) printf "%.5f", sqrt(d / s) }' "$out/short/r.dat" "$out/$name/r.dat"
}
moving short stepping%scheme=modified-equation stepping%time_step=0.003947368421 >"$out/none"
late=$(moving late stepping%scheme=leapfrog stepping%time_step=0.019736842105)
own=$(moving own)
fitted=$(moving fitted stepping%time_step=0.039473684211)
check "motion at t = 0 is moved by the modified equation" grep -q '^scheme: modified-equation' "$out/own/report.txt"
check "with steps of .039 it errs by $own, fitted by $fitted; leapfrog with steps of .020 by $late" \
    awk "BEGIN { exit !($own > 0 && $own < .006 && $fitted < .003 && $late > .02) }"

# layers of low Q, thinner than the spacing, in general ground: errors are those of the lattice
for scene in 5 21 23; do
    regress/studies/q-layers "$build" $scene $scene >"$out/layer" 2>"$out/log" || cat "$out/log"
    check "a layer of low Q$(sed 's/^[0-9]*:/:/' "$out/layer")" awk -F '[:;]' '
        function most(text, i, n, list, found) { n = split(text, list, " "); for (i = 1; i <= n; i++) if (list[i] + 0 > found) found = list[i] + 0
            return found }
        { damped = most($3); sub(/undamped/, "", $4); plain = most($4) } END { exit !(damped > 0 && plain > 0 && damped < 1.3 * plain) }' "$out/layer"
done

refused() { # refused TITLE MESSAGE WORDS...
    title=$1 message=$2
    shift 2
    "$selas" check input/damped.nml "$@" >"$out/text" 2>&1
    if [ $? -eq 2 ] && grep -q -e "$message" "$out/text"; then echo "ok - refused: $title"; else
        echo "not ok - refused: $title"
        sed 's/^/#   /' "$out/text"
    fi
}
refused "compression that would gain energy" "q_p = 60 is too large beside q_s = 20.* = 45" material%q_p=60
refused "Q_s alone" "'q_p' is not given" material%q_p=
refused "so low a Q" "cannot stand for so low a Q" material%q_p=0.05 material%q_s=0.05
refused "points without order" "'cloud', has no damping by q_p and q_s" method%variant=cloud method%mechanisms=
particles="method%name=sph method%variant=total-lagrangian"
check "particles take Q by Hooke's law" sh -c "'$selas' check '$out/box.nml' $particles method%law=linear | grep -q 'damping adds: 2 operator calls'"
check "and by no other" sh -c "'$selas' check '$out/box.nml' $particles 2>&1 | grep -q \"damping by q_p and q_s is linear; expected law = 'linear'\""
refused "the modified equation beside dampers" "beside dampers .* need scheme 'leapfrog', not 'modified-equation'" stepping%scheme=modified-equation "boundary(1)%face=x-" "boundary(1)%kind=transmitting" "boundary(1)%layer=lysmer"
refused "an undamped reference" "reference 'lamb' is undamped" reference%kind=lamb reference%tolerance=
refused "an accuracy that leaves no choice of mechanisms" "'mechanisms' does not belong to a deck with scene%accuracy" scene%accuracy=0.01 body%spacing=
check "the plan says what is reached" sh -c "'$selas' check input/damped.nml | grep -q 'damping of rock: Q_p 40 wanted, 39.* reached'"

# the size of a table and the amplitude make the same source, however it is shared
printf '0 0\n.5 1e-8\n1 5e-8\n2 9e-8\n3 1e-7\n' >"$out/small.txt"
printf '0 0\n.5 .1\n1 .5\n2 .9\n3 1\n' >"$out/large.txt"
cat >"$out/table.nml" <<END
&scene dimension = 2, end_time = 6.0 /
&material name = 'rock', density = 1.0, p_speed = 1.7320508, s_speed = 1.0, q_p = 40.0, q_s = 20.0 /
&body material = 'rock', shape = 'box', low = 0, 0, high = 4, 2, spacing = 0.125 /
&boundary face = 'x-', kind = 'fixed' /
&boundary face = 'x+', kind = 'velocity', direction = 0.3, 1.0, history = 'table', file = '$out/small.txt', amplitude = 1e-2 /
END
band() { "$selas" check "$out/table.nml" "$@" | sed -n 's/.*; source between/source between/p'; }
small=$(band) large=$(band "boundary(2)%file=$out/large.txt" "boundary(2)%amplitude=1e-9")
check "a table's size is no matter of the band: $small" sh -c "[ -n '$small' ] && [ '$small' = '$large' ]"

# a wanted error: spacing and number of mechanisms follow
for wanted in 0.1 0.02 0.005; do
    "$selas" -q input/damped.nml scene%accuracy=$wanted scene%end_time=8 body%spacing= method%mechanisms= output%plots=F output%directory="$out/wanted" >"$out/log" 2>&1 ||
        cat "$out/log"
    reached=$(sed -n 's/^error largest: \([^ ]*\).*/\1/p' "$out/wanted/report.txt")
    check "wanted $wanted, reached $reached:$(sed -n 's/^accuracy:.*;\(.* mechanisms\), .*/\1/p' "$out/wanted/report.txt")" \
        awk "BEGIN { exit !($reached < $wanted && $reached > $wanted / 5) }"
done
