# Spectra of error and exact velocity at the receivers r0, r1, r2 and d2 of a run in $out/NAME, appended to $out/spectra.txt: run, receiver, spacing,
# Rayleigh speed, distance, diagonal, then omega |D|^2 |V|^2 over the pulse's own spectrum (Gaussian of WIDTH), omega up to LIMIT / spacing, then what
# else is given (depth of the first interface and the Rayleigh speed below it).
spectra() { # spectra NAME SPACING WIDTH SPEED LIMIT [TOP BELOW]
    for receiver in r0:0:0 r1:1:0 r2:2:0 d2:2.1213:1; do
        name=${receiver%%:*}
        grep -hv '^#' "$out/$1/$name.exact.dat" >"$out/exact"
        grep -hv '^#' "$out/$1/$name.dat" | paste - "$out/exact" | awk -v head="$1 $name $2 $4 $(echo "${receiver#*:}" | tr : ' ')" -v h="$2" -v width="$3" -v limit="$5" -v more="${6:-} ${7:-}" '
            { t[NR] = $1; for (c = 0; c < 3; c++) { e[NR, c] = $(12 + c); d[NR, c] = $(5 + c) - $(12 + c) } }
            END {
                pi = atan2(0, -1)
                for (j = 1; j <= NR; j++) { # the last quarter fades out, so that its end makes no frequencies
                    late = (t[j] / t[NR] - .75) / .25
                    if (late > 0) for (c = 0; c < 3; c++) { e[j, c] *= .5 * (1 + cos(pi * late)); d[j, c] *= .5 * (1 + cos(pi * late)) }
                }
                for (w = .5 * pi / t[NR]; w < limit / h; w += pi / t[NR]) {
                    whole = error = 0
                    for (c = 0; c < 3; c++) {
                        er = ei = dr = di = 0
                        for (j = 1; j <= NR; j++) {
                            a = cos(w * t[j]); b = sin(w * t[j])
                            er += e[j, c] * a; ei += e[j, c] * b; dr += d[j, c] * a; di += d[j, c] * b
                        }
                        whole += er * er + ei * ei; error += dr * dr + di * di
                    }
                    print head, w, error * exp((w * width)^2), whole * exp((w * width)^2), more
                }
            }' >>"$out/spectra.txt"
    done
}
