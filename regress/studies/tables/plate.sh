# The plate with a hole: what Tables 3 and 4 share. Sourced by regress/studies/tables/run.

# hole_error FILE COLUMN RADIUS TRUTH: "L1 L2" of the stress in a column over x (column 2) on the ligament, with the far
# stress that fits best (least squares). TRUTH: 'infinite' (Kirsch) or a finite-plate curve in regress/reference/hole.
hole_error() {
    awk -v column="$2" -v R="$3" -v truth="$4" '
        BEGIN { if (truth != "infinite") while ((getline line < truth) > 0)
            if (line !~ /^#/) { split(line, f, ","); x[++n] = f[1]; s[n] = f[2] } }
        function exact(at,   k) {
            if (truth == "infinite") return 1 + R^2 / at^2 / 2 + 1.5 * R^4 / at^4
            for (k = 1; k + 1 < n && x[k + 1] < at;) k++
            return s[k] + (s[k + 1] - s[k]) * (at - x[k]) / (x[k + 1] - x[k])
        }
        /^#/ || NF < column { next }
        { v[++rows] = $column; e[rows] = exact($2); ve += v[rows] * e[rows]; ee += e[rows]^2 }
        END {
            far = ve / ee
            for (i = 1; i <= rows; i++) { d = v[i] / far - e[i]; a += d < 0 ? -d : d; b += e[i]; q += d * d }
            printf "%.4f %.4f", a / b, sqrt(q / ee)
        }' "$1"
}
published='method%variant=updated-lagrangian method%viscosity_alpha=2.5 method%viscosity_beta=2.5 boundary(2)%kind=velocity
    boundary(2)%amplitude=-.2 boundary(2)%smoothing=0. scene%end_time=.9949e-3 profile(1)%times=.9949e-3
    profile(2)%times=.9949e-3 snapshot%times=.9949e-3'
settled='method%variant=updated-lagrangian method%viscosity_alpha=2.5 method%artificial_stress=0.'

# plate_errors NAME RADIUS: four errors | cost of the last run
plate_errors() {
    if [ -e "$out/$1/ligament.dat" ]; then
        set -- "$1" "$2" $(hole_error "$out/$1/ligament.dat" 9 "$2" infinite) \
            $(hole_error "$out/$1/ligament.dat" 9 "$2" "regress/reference/hole/R0.${2#.}_disp.csv")
        echo "$(value "$1" points) | $3 | $4 | $5 | $6 | $(cpu "$1") | $(evaluations "$1") |"
    else
        echo '| unstable or refused | | | | | |'
    fi
}
# plate NAME RADIUS OVERRIDES...
plate() {
    name=$1 radius=$2
    shift 2
    run "$name" input/plate.nml "body%hole_radius=$radius" "profile(1)%from=$radius,0." "$@"
    plate_errors "$name" "$radius"
}
