# Figs 15-19: the plate with a hole. Sourced by regress/studies/sph-figures/run. "as published": pushed at .2 m/s, updated Lagrangian, the
# published switches, as in regress/studies/tables; the settled total-Lagrangian run and the finite plate stand beside it.
. regress/studies/tables/plate.sh

# plate_run NAME RADIUS OVERRIDES...
plate_run() {
    name=$1 radius=$2
    shift 2
    run "$name" input/plate.nml "body%hole_radius=$radius" "profile(1)%from=$radius,0." \
        "snapshot%fields='displacement','velocity','stress'" "$@" || { echo "$name: refused or unstable" >&2; return 1; }
}
# plate_points NAME SNAPSHOT: NAME.SNAPSHOT with x y z, u (3), v (3), stress (6)
plate_points() {
    for what in displacement velocity stress; do
        field "$1" "/snapshots/000$2/$what" >"$out/plate.$what"
    done
    field "$1" /points/position | paste - "$out/plate.displacement" "$out/plate.velocity" "$out/plate.stress" >"$out/$1.$2"
}
# cross_section NAME RADIUS: NAME.section with x and stress over the far stress that fits best to the finite plate
cross_section() {
    awk -v truth="regress/reference/hole/R0.${2#.}_disp.csv" '
        BEGIN { while ((getline line < truth) > 0) if (line !~ /^#/) { split(line, f, ","); x[++n] = f[1]; s[n] = f[2] } }
        /^#/ || NF < 9 { next }
        {
            for (k = 1; k + 1 < n && x[k + 1] < $2;) k++
            e = s[k] + (s[k + 1] - s[k]) * ($2 - x[k]) / (x[k + 1] - x[k])
            at[++rows] = $2; v[rows] = $9; ve += $9 * e; ee += e * e
        }
        END { for (i = 1; i <= rows; i++) print at[i], v[i] / (ve / ee) }' "$out/$1/ligament.dat" >"$out/$1.section"
}
# section_panel TITLE RADIUS NAME=LABEL...
section_panel() {
    title=$1 radius=$2
    shift 2
    printf "set title '%s'; plot [%s:1] 1 + %s**2/x**2/2 + 1.5*%s**4/x**4 with lines dt 2 lw 1.4 lc rgb 'black' title 'infinite plate (Kirsch)'" \
        "$title" "$radius" "$radius" "$radius"
    printf ", '%s' using 1:2 with lines lw 1.8 lc rgb 'black' title 'finite plate (two finite-element programs)'" \
        "< tr , \" \" <regress/reference/hole/R0.${radius#.}_disp.csv"
    colour=0
    for pair; do
        colour=$((colour + 1))
        [ -s "$out/${pair%%=*}.section" ] || continue
        printf ", '%s' using 1:2 with linespoints ps .6 lw 1 lt %d title '%s'" "$out/${pair%%=*}.section" $colour \
            "$(echo "${pair#*=}" | tr _ ' ')"
    done
    echo
}
section_axes="set xlabel 'x [m]'; set ylabel 'stress yy on y = 0 / far stress'; set key top right"

# map NAME.SNAPSHOT QUANTITY PALETTE MIRRORS SIZE TITLE: one panel of coloured points on the deformed shape (x 300)
map() {
    plot=''
    for mirror in $4; do
        sx=${mirror%,*} sy=${mirror#*,}
        quantity=$(echo "$2" | sed "s/MIRROR/$sx*$sy/")
        plot="$plot, '$out/$1' using ($sx*(\$1+300*\$4)):($sy*(\$2+300*\$5)):($quantity) with points pt 7 ps $5 lc palette"
    done
    echo "load '$out/$3'; set title '$6'"
    echo "plot ${plot#, }"
}
# row NAME.SNAPSHOT MIRRORS SIZE TITLE: shear stress, normal stress, speed; the shear is odd in x and y
row() {
    map "$1" '$13*1e-6*MIRROR' palette-shear "$2" "$3" "$4: stress xy [MPa]"
    map "$1" '$11*1e-6' palette-pressed "$2" "$3" "$4: stress yy [MPa]"
    map "$1" 'sqrt($7**2+$8**2)' palette-speed "$2" "$3" "$4: speed [m/s]"
}

plate_figures() {
    echo "set palette defined (0 '#ffffd0', .5 '#f08030', 1 '#500030'); set cbrange [0:.25]" >"$out/palette-speed"
    echo "set palette defined (0 '#500030', .5 '#f08030', 1 '#ffffd0'); set cbrange [-25:0]" >"$out/palette-pressed"
    echo "load '$out/palette'; set cbrange [-6:6]" >"$out/palette-shear"
    arrangements='lattice:.0322 radial:.0304 equally-radial:.0318'
    published_runs='' settled_runs=''
    for pair in $arrangements conformal:.0334; do
        arrangement=${pair%:*}
        # shellcheck disable=SC2086
        plate_run "plate-$arrangement" .3 "body%arrangement=$arrangement" "body%spacing=${pair#*:}" $published || continue
        plate_points "plate-$arrangement" 0
        cross_section "plate-$arrangement" .3
        published_runs="$published_runs plate-$arrangement=$arrangement"
        plate_run "plate-total-$arrangement" .3 "body%arrangement=$arrangement" "body%spacing=${pair#*:}" || continue
        cross_section "plate-total-$arrangement" .3
        settled_runs="$settled_runs plate-total-$arrangement=$arrangement"
    done

    {
        echo "set multiplot layout 1,3 title 'Fig 15: squared, radial, equally radial points (some 900 in the quarter)'"
        echo "set size ratio -1; set xrange [0:1]; set yrange [0:1]; unset key; set xlabel 'x [m]'; set ylabel 'y [m]'"
        for pair in $arrangements; do
            echo "set title '${pair%:*}, $(value "plate-${pair%:*}" points) points'"
            echo "plot '$out/plate-${pair%:*}.0' using 1:2 with points pt 7 ps .35 lc rgb '#0060ad'"
        done
    } | draw fig15 1500 560

    {
        echo "set multiplot layout 3,3 title 'Fig 16: plate pushed at .2 m/s, t = 995 microseconds, updated Lagrangian as published; displacements x 300'"
        echo "set size ratio -1; set xrange [-.02:1.08]; set yrange [-.02:1.02]; unset key; set xlabel 'x [m]'; set ylabel 'y [m]'"
        for pair in $arrangements; do
            row "plate-${pair%:*}.0" 1,1 .75 "${pair%:*}"
        done
    } | draw fig16 1500 1500

    # shellcheck disable=SC2086
    {
        echo "$section_axes; set yrange [0:4]"
        echo "set multiplot layout 1,2 title 'Fig 17: stress yy along y = 0, R = .3 m, some 900 points'"
        section_panel 'updated Lagrangian as published, t = 995 microseconds' .3 $published_runs
        section_panel 'total Lagrangian (quadratic), settled' .3 $settled_runs
    } | draw fig17 1500 640

    {
        echo "$section_axes; set yrange [0:4]"
        echo "set multiplot layout 1,2 title 'Fig 18: stress yy along y = 0; finite elements: the two programs of regress/reference/hole'"
        for pair in .3:.0202 .2:.0203; do
            radius=${pair%:*}
            # shellcheck disable=SC2086
            plate_run "plate-fine$radius" "$radius" body%arrangement=equally-radial "body%spacing=${pair#*:}" $published &&
                cross_section "plate-fine$radius" "$radius"
            plate_run "plate-settled$radius" "$radius" body%spacing=.0334 && cross_section "plate-settled$radius" "$radius"
            section_panel "R = $radius m" "$radius" \
                "plate-fine$radius=updated_(equally_radial)_as_published,_$(value "plate-fine$radius" points)_points" \
                "plate-settled$radius=total_(conformal),_settled,_$(value "plate-settled$radius" points)_points"
        done
    } | draw fig18 1500 640

    # shellcheck disable=SC2086
    plate_run plate-times .3 body%arrangement=equally-radial body%spacing=.0162 \
        $(echo "$published" | sed 's/snapshot%times=[^ ]*/snapshot%times=331.6366e-6,663.2731e-6,994.9e-6/')
    {
        echo "set multiplot layout 3,3 title 'Fig 19: whole plate, equally radial, $(value plate-times points) points in the quarter; displacements x 300'"
        echo "set size ratio -1; set xrange [-1.1:1.1]; set yrange [-1.02:1.02]; unset key; set xlabel 'x [m]'; set ylabel 'y [m]'"
        for pair in 0:332 1:663 2:995; do
            plate_points plate-times "${pair%:*}"
            row "plate-times.${pair%:*}" '1,1 -1,1 1,-1 -1,-1' .35 "t = ${pair#*:} microseconds"
        done
    } | draw fig19 1500 1500
}
