# Figs 11-13: the clamped beam. Sourced by regress/studies/sph-figures/run. The paper's spacing .0033 costs a minute a run in the updated
# form; drawn here are .01 and .005, which the titles say.

# beam_field FILE COLUMN TITLE: a stress component (MPa) of the run beam-field on the deformed shape at four instants
beam_field() {
    {
        echo "set multiplot layout 2,2 title \"$3\""
        echo "set size ratio -1; set xrange [-.02:.54]; set yrange [-.13:.19]; set xlabel 'x [m]'; set ylabel 'y [m]'; unset key"
        echo "load '$out/palette'"
        for number in 0 1 2 3; do
            echo "set title 't = $(echo "$beam_times" | cut -d, -f$((number + 1)) | awk '{ printf "%.2f", $1 * 1e6 }') microseconds'"
            largest=$(awk -v c="$2" '{ v = $c < 0 ? -$c : $c; if (v > m) m = v } END { printf "%.3g", m * 1e-6 }' "$out/beam-field.$number")
            echo "set cbrange [-$largest:$largest]"
            echo "plot '$out/beam-field.$number' using (\$1+\$4):(\$2+\$5):(\$$2*1e-6) with points pt 5 ps .45 lc palette"
        done
    } | draw "$1" 1500 800
}

# beam_panel COLUMN TITLE LABEL EXACT: tip over time, RUN=LABEL by the variable beams
beam_panel() {
    echo "set title '$2'; set ylabel '$3'"
    echo "plot $4 with lines lw 1.2 lc rgb 'black' title 'exact frequency, small amplitude'$(
        colour=0
        for name in $beams; do
            colour=$((colour + 1))
            form='updated' frequency=$(value "$name" 'frequency at tip')
            case $name in *total*) form='total (quadratic)' ;; esac
            printf ", '%s' using (\$1*1e3):%s with lines lt %d title '%s, %s m: %.0f rad/s'" \
                "$out/$name/tip.dat" "$1" $colour "$form" "${name##*-}" "$frequency"
        done
    )"
}

beam_figures() {
    beam_times=73.7e-6,1621.33e-6,3316.37e-6,4937.7e-6
    # the deck has snapshots at even times; these are the paper's
    sed "s/^&snapshot .*/\&snapshot times = $beam_times, fields = 'displacement', 'stress' \//" input/beam.nml >"$out/beam-field.nml"
    if run beam-field "$out/beam-field.nml" method%variant=updated-lagrangian body%spacing=.005 body%high=.5,.05 \
        'receiver(1)%position=.5,.025' 'receiver(2)%position=.25,.025' initial%amplitude=.02 scene%end_time=4.94e-3; then
        field beam-field /points/position >"$out/beam-field.points"
        for number in 0 1 2 3; do
            field beam-field "/snapshots/000$number/displacement" >"$out/beam-field.u"
            field beam-field "/snapshots/000$number/stress" >"$out/beam-field.s"
            paste "$out/beam-field.points" "$out/beam-field.u" "$out/beam-field.s" >"$out/beam-field.$number"
        done
        note='beam .5 x .05 m, V_f = .02, updated Lagrangian, spacing .005 m (paper .0033)'
        beam_field fig11 7 "Fig 11: stress xx [MPa], $note"
        beam_field fig12 8 "Fig 12: stress yy [MPa], $note"
    else
        echo 'figs 11, 12: not drawn, the run was refused or went unstable' >&2
    fi

    beams=''
    for spacing in .01 .005; do
        run beam-updated-$spacing input/beam.nml method%variant=updated-lagrangian body%spacing=$spacing scene%end_time=.0066 &&
            beams="$beams beam-updated-$spacing"
        run beam-total-$spacing input/beam.nml body%spacing=$spacing scene%end_time=.0066 && beams="$beams beam-total-$spacing"
    done
    start=$(awk '!/^#/ && NF { print $6; exit }' "$out/beam-total-.005/tip.dat")
    {
        echo "set multiplot layout 1,2 title 'Fig 13: tip of the beam .5 x .1 m, V_f = .01 (the paper has .0033 m too)'"
        echo "set xlabel 'time [ms]'; set xrange [0:6.6]; set samples 1001; set key bottom left; w = 2008.3; v0 = $start"
        echo "set yrange [-.062:.036]"
        beam_panel 3 displacement 'vertical displacement [m]' 'v0/w*sin(w*x*1e-3)'
        echo "set yrange [-125:72]"
        beam_panel 6 velocity 'vertical velocity [m/s]' 'v0*cos(w*x*1e-3)'
    } | draw fig13 1500 640
}
