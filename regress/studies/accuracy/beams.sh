#!/bin/sh
# The coefficients of the beam's law in src/accuracy/beam.c (doc/verification/accuracy.md, Eq 11), anew: frequencies of beams by splines of degree 1, 2, 3 and
# by particles, errors against two-dimensional elasticity (a fine run with splines of degree 3), least squares of the logarithms; and how a large swing
# changes the frequency. Usage: sh regress/studies/accuracy/beams.sh [BUILD] (two minutes of one core). Leaves output/accuracy-beams/.
set -eu
build=${1:-build}
out=output/accuracy-beams
mkdir -p "$out"
OMP_NUM_THREADS=1
export OMP_NUM_THREADS

frequency() { # frequency PLANE POISSON LENGTH/WIDTH N OVERRIDES...: of a beam of width 1 with N spacings across, units of sqrt(E / rho)
    cat >"$out/beam.nml" <<DECK
&scene dimension = 2, plane = '$1', end_time = $(awk "BEGIN { print 16 * $3 * $3 }") /
&material name = 'stuff', density = 1, young = 1, poisson = $2 /
&body material = 'stuff', shape = 'box', low = 0, 0, high = $3, 1, spacing = $(awk "BEGIN { printf \"%.17g\", 1 / $4 }") /
&boundary face = 'x-', kind = 'fixed' /
&initial kind = 'beam-mode', amplitude = .001 /
&receiver name = 'tip', position = $3, .5 /
&reference kind = 'beam' /
&output plots = .false., directory = '$out/run' /
DECK
    shift 4
    "$build/selas" -q "$out/beam.nml" "$@" >"$out/log" 2>&1
    awk -F': ' '/^frequency at tip/ { print $2 }' "$out/run/report.txt"
}
fine() { frequency "$1" "$2" "$3" 8 method%degree=3 method%mass=exact stepping%scheme=modified-equation; }
error() { awk "BEGIN { e = $1 / $2 - 1; print e < 0 ? -e : e }"; }
: >"$out/errors.txt" # setting, W / L, nu', n, error
for case in stress:0:5 stress:.35:5 stress:.45:5 stress:.35:10 strain:.2:5 strain:.35:5; do
    plane=${case%%:*}
    ratio=${case##*:}
    poisson=${case#*:}
    poisson=${poisson%:*}
    true=$(fine "$plane" "$poisson" "$ratio")
    hindered=$(awk "BEGIN { print \"$plane\" == \"strain\" ? $poisson / (1 - $poisson) : $poisson }")
    for n in 1 2 3 4; do
        at="$(awk "BEGIN { print 1 / $ratio }") $hindered $n"
        echo "degree1 $at $(error "$(frequency "$plane" "$poisson" "$ratio" $n method%degree=1)" "$true")"
        echo "degree2 $at $(error "$(frequency "$plane" "$poisson" "$ratio" $n)" "$true")"
        [ $n -gt 3 ] || echo "degree3 $at $(error "$(frequency "$plane" "$poisson" "$ratio" $n method%degree=3 method%mass=exact stepping%scheme=modified-equation)" "$true")"
    done
    [ "$ratio$plane" = 5stress ] || [ "$ratio" = 10 ] || continue
    for n in 4 6 8 10; do
        at="$(awk "BEGIN { print 1 / $ratio }") $hindered $n"
        echo "quadratic $at $(error "$(frequency "$plane" "$poisson" "$ratio" $n method%name=sph)" "$true")"
        echo "linear $at $(error "$(frequency "$plane" "$poisson" "$ratio" $n method%name=sph method%gradient=linear)" "$true")"
    done
done >>"$out/errors.txt"
awk '
    # a s^q (1 + m nu^4) / (n^p + b) + d s nu^2 n^-r
    function law(i) { return p[1] * s[i]^p[2] * (1 + p[3] * nu[i]^4) / (n[i]^p[4] + p[5]) + p[6] * s[i] * nu[i]^2 * n[i]^-p[7] }
    function cost(    i, x, sum) {
        for (i = 1; i <= rows; i++) { x = law(i); if (x <= 0) return 1e9; x = log(x / e[i]); sum += x * x }
        return sqrt(sum / rows)
    }
    function fit(name, start, free,    best, round, q, sign, kept, found, c, step, names) {
        rows = 0
        for (i = 1; i <= all; i++) if (setting[i] == name) { rows++; s[rows] = S[i]; nu[rows] = NU[i]; n[rows] = N[i]; e[rows] = E[i] }
        split(start, p, " "); split(free, open, " ")
        for (q = 1; q <= 7; q++) step[q] = .3 * (p[q] != 0 ? p[q] : 1)
        best = cost()
        for (round = 1; round <= 60; round++) for (q = 1; q <= 7; q++) if (open[q]) {
            found = 0
            for (sign = 1; sign >= -1 && !found; sign -= 2) {
                kept = p[q]; p[q] = kept + sign * step[q]; c = cost()
                if (c < best) { best = c; found = 1; step[q] *= 1.3 } else p[q] = kept
            }
            if (!found) step[q] *= .5
        }
        printf "%-10s a %.3g q %d m %.2g p %.3g b %.2g d %.3g r %.3g: %d cases, r.m.s. factor %.2f\n", name, p[1], p[2], p[3], p[4], p[5], p[6], p[7], rows, exp(best)
    }
    { all++; setting[all] = $1; S[all] = $2; NU[all] = $3; N[all] = $4; E[all] = $5 }
    END {
        fit("degree1", ".3 0 5 2 .3 0 0", "1 0 1 0 1 0 0")
        fit("degree2", ".1 1 0 3 0 .2 1.5", "1 0 0 1 0 1 1")
        fit("degree3", "6e-4 1 0 3 0 .1 1.5", "1 0 0 1 0 1 1")
        fit("quadratic", ".5 0 0 2 0 0 0", "1 0 0 0 0 0 0")
        fit("linear", "5 0 0 2 5 0 0", "1 0 0 0 1 0 0")
    }' "$out/errors.txt"
small=$(frequency stress .35 5 6 method%name=sph)
large=$(frequency stress .35 5 6 method%name=sph initial%amplitude=.05)
awk -v a="$small" -v b="$large" 'BEGIN { swing = .05 / a / 5; printf "large swings: the frequency falls by %.3g (deflection / length)^2\n", (1 - b / a) / swing^2 }'
