#!/bin/sh
# The coefficients of the plate's law in src/accuracy/plate.c (doc/verification/accuracy.md, Eq 12), anew: the settled plate with a hole of radius .3 pulled by
# its edge and under a traction, errors of the stress along the ligament, least squares of the logarithms.
# Usage: sh regress/studies/accuracy/plates.sh [BUILD] (a minute of one core). Leaves output/accuracy-plates/.
set -eu
build=${1:-build}
out=output/accuracy-plates
mkdir -p "$out"
OMP_NUM_THREADS=1
export OMP_NUM_THREADS
. regress/studies/accuracy/runs.sh
. regress/studies/accuracy/solids.sh
: >"$out/errors.txt"
plate .3 >"$out/disp.nml"
traction <"$out/disp.nml" >"$out/trac.nml"
for gradient in quadratic linear; do
    for pull in disp trac; do
        for h in .08 .057 .0425 .0304 .0215; do
            "$build/selas" -q "$out/$pull.nml" body%spacing=$h method%gradient=$gradient output%plots=F "output%directory=$out/run"
            echo "$gradient $pull $h $(ligament R0.3_$pull)" >>"$out/errors.txt"
        done
    done
done
for gradient in quadratic linear; do
    awk -v g=$gradient '
        $1 == g { n++; x[n] = log($3); y[n] = log($4); sx += x[n]; sy += y[n]; sxx += x[n]^2; sxy += x[n] * y[n] }
        END {
            order = (n * sxy - sx * sy) / (n * sxx - sx * sx); level = (sy - order * sx) / n
            for (i = 1; i <= n; i++) { r = y[i] - level - order * x[i]; sum += r * r; if (r > high) high = r; if (r < low) low = r }
            printf "%s: error = %.2f (spacing / E)^%.2f, r.m.s. factor %.2f, measured over predicted %.2f to %.2f\n", g, exp(level), order, exp(sqrt(sum / n)), exp(low), exp(high)
        }' "$out/errors.txt"
done
