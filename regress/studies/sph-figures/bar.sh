# Figs 4-10: the bar, profiles at t = .12 ms and the middle over time. Sourced by regress/studies/sph-figures/run.
# The schemes' time step is the paper's CFL number times spacing over c0; stages of rkc by its Eq 28.

# bar NAME NP CFL OVERRIDES...: leaves NAME.profile (x v s) and NAME.middle (t v s), both empty if unstable
bar() {
    name=$1 np=$2 cfl=$3
    shift 3
    : >"$out/$name.profile"
    : >"$out/$name.middle"
    run "$name" input/bar.nml scene%end_time=.4e-3 "body%spacing=$(number "1 / $np")" profile%points=249 "profile%times=$bar_times" \
        "stepping%time_step=$(number "$cfl / $np / sqrt(45e9 / 1738)")" stepping%rule=paper stepping%force=.true. "$@" || return 0
    awk -v profile="$out/$name.profile" -v middle="$out/$name.middle" '
        /^# t =/ { t = $4 }
        /^#/ || NF < 8 { next }
        t > .11999e-3 && t < .12001e-3 { print $2, $5, $8 >profile }
        $2 > .4999 && $2 < .5001 { print t, $5, $8 >middle }' "$out/$name/along.dat"
}

# curves SUFFIX COLUMN FACTOR NAME=LABEL...: one plot element each, the first ones thick so that curves that coincide are
# all seen, _ for a blank; what went unstable has only a line in the legend
curves() {
    suffix=$1 column=$2 factor=$3
    shift 3
    colour=0
    for pair; do
        colour=$((colour + 1))
        file=$out/${pair%%=*}.$suffix label=$(echo "${pair#*=}" | tr _ ' ')
        width=$(number "5.8 - $colour")
        if [ -s "$file" ]; then
            printf ", '%s' using (\$1*%s):(\$%s*%s) with lines lt %d lw %s title '%s'" "$file" "$factor" "$column" "$(unit "$column")" $colour "$width" "$label"
        else
            printf ", NaN with lines lt %d dt 2 title '%s: unstable'" $colour "$label"
        fi
    done
}
unit() { if [ "$1" = 3 ]; then echo 1e-6; else echo 1; fi; }

bar_exact="set samples 2001; c = sqrt(45e9 / 1738)
front(x, t) = x < c * t ? 1 : 0
back(x, t) = 2 - x < c * t ? 1 : 0
velocity(x, t) = front(x, t) - back(x, t)
stress(x, t) = -8.8436 * (front(x, t) + back(x, t))"

# The panels, each a full plot command: panel KIND COLUMN TITLE NAME=LABEL...
panel() {
    kind=$1 column=$2 title=$3
    shift 3
    echo "set title \"$title\""
    if [ "$column" = 2 ]; then
        echo "set ylabel 'velocity [m/s]'; set yrange [-.2:1.7]; quantity(x, t) = velocity(x, t)"
    else
        echo "set ylabel 'stress [MPa]'; set yrange [-$([ "$kind" = profile ] && echo 15 || echo 26):3]; quantity(x, t) = stress(x, t)"
    fi
    if [ "$kind" = profile ]; then
        echo "set xlabel 'x [m]'; set xrange [0:1]"
        echo "plot quantity(x, .12e-3) with lines lw 1.2 lc rgb 'black' title \"d'Alembert\"$(curves profile "$column" 1 "$@")"
    else
        echo "set xlabel 'time [ms]'; set xrange [0:.4]"
        echo "plot quantity(.5, x * 1e-3) with lines lw 1.2 lc rgb 'black' title \"d'Alembert\"$(curves middle "$column" 1000 "$@")"
    fi
}
# pair FILE KIND TITLE NAME=LABEL...: velocity and stress side by side
pair() {
    file=$1 kind=$2 title=$3
    shift 3
    {
        echo "$bar_exact"
        echo "set multiplot layout 1,2 title \"$title\""
        echo 'set key top right'
        panel "$kind" 2 velocity "$@"
        echo "set key bottom $([ "$kind" = profile ] && echo right || echo left)"
        panel "$kind" 3 stress "$@"
    } | draw "$file" 1400 560
}

bar_figures() {
    bar_times=$(series 0 .4e-3 200)
    for scheme in euler pc2 rk4 rkc; do
        bar "bar-$scheme" 250 .6 stepping%scheme=$scheme
    done
    schemes='bar-euler=Euler bar-pc2=PC2 bar-rk4=RK4 bar-rkc=RKC'
    # shellcheck disable=SC2086
    pair fig04 profile 'Fig 4: bar at t = .12 ms, 250 particles, CFL .6, viscosity 2.5' $schemes
    # shellcheck disable=SC2086
    pair fig05 middle 'Fig 5: middle of the bar, 250 particles, CFL .6, viscosity 2.5' $schemes

    rk4='' rkc=''
    for cfl in .2 .6 1 1.2 1.5; do
        bar "bar-rk4-$cfl" 250 $cfl stepping%scheme=rk4
        rk4="$rk4 bar-rk4-$cfl=CFL_$cfl"
    done
    for cfl in .6 1 2.5 3.2 4.8; do
        bar "bar-rkc-$cfl" 250 $cfl stepping%scheme=rkc
        rkc="$rkc bar-rkc-$cfl=CFL_$cfl"
    done
    # shellcheck disable=SC2086
    {
        echo "$bar_exact"
        echo "set multiplot layout 1,2 title 'Fig 6: velocity at t = .12 ms, 250 particles, by CFL number'; set key top right"
        panel profile 2 RK4 $rk4
        panel profile 2 'RKC (stages by Eq 28)' $rkc
    } | draw fig06 1400 560
    # shellcheck disable=SC2086
    {
        echo "$bar_exact"
        echo "set multiplot layout 2,2 title 'Fig 7: middle of the bar, 250 particles, by CFL number'"
        echo 'set key top right'
        panel middle 2 RK4 $rk4
        panel middle 2 'RKC (stages by Eq 28)' $rkc
        echo 'set key bottom left'
        panel middle 3 RK4 $rk4
        panel middle 3 'RKC (stages by Eq 28)' $rkc
    } | draw fig07 1400 1060

    sizes=''
    for np in 250 500 1000; do
        bar "bar-np-$np" $np 2.5 stepping%scheme=rkc
        sizes="$sizes bar-np-$np=NP_$np"
    done
    # shellcheck disable=SC2086
    pair fig08 profile 'Fig 8: bar at t = .12 ms, RKC, CFL 2.5' $sizes
    # shellcheck disable=SC2086
    pair fig09 middle 'Fig 9: middle of the bar, RKC, CFL 2.5' $sizes

    ten=''
    for cfl in 1 2.5 3.2 3.8 4.8; do
        bar "bar-ten-$cfl" 250 $cfl stepping%scheme=rkc stepping%stages=10
        ten="$ten bar-ten-$cfl=CFL_$cfl"
    done
    # shellcheck disable=SC2086
    pair fig10 middle 'Fig 10: middle of the bar, RKC with 10 stages, 250 particles' $ten
}
