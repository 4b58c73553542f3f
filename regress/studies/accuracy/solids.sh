# Beams and plates that no table was made of, for scene%accuracy: solid NAME prints a deck without the accuracy, solid_error NAME the error of the run in
# $out/run that accuracy promises: of a beam's frequency, of the stress along a plate's ligament.
strip() { # strip DIMENSION END MATERIAL HIGH AMPLITUDE TIP
    cat <<DECK
&scene dimension = $1$([ "$1" = 2 ] && echo ", plane = '${plane:-stress}'"), end_time = $2 /
&material name = 'stuff', $3 /
&body material = 'stuff', shape = 'box', low = $(echo "0,0,0" | cut -d, -f1-"$1"), high = $4 /
&boundary face = 'x-', kind = 'fixed' /
&initial kind = 'beam-mode', amplitude = $5 /
&receiver name = 'tip', position = $6 /
&reference kind = 'beam' /
&output plots = .false. /
DECK
}
solid() {
    magnesium='density = 1738, young = 45e9, poisson = .35'
    case $1 in
    b1) # plane strain
        plane=strain strip 2 .0066 "$magnesium" .5,.1 .001 .5,.05
        echo "&method name = 'sph' /"
        ;;
    b2) # the strip of Gray, Monaghan and Swift, swinging a tenth of its length
        strip 2 1.4 'density = 1000, young = 2e6, poisson = .3975' .2,.02 .01 .2,.01
        echo "&method name = 'sph' /"
        ;;
    b3) # splines, another material, eight times as long as wide; no exact frequency
        strip 2 540 'density = 1.5, young = 1, poisson = .2' 4,.5 .001 4,.25
        ;;
    b4) # linear gradients, plane strain, slender
        plane=strain strip 2 .013 "$magnesium" .5,.05 .001 .5,.025
        echo "&method name = 'sph', gradient = 'linear' /"
        ;;
    b5) # in space, twice as wide as thick; no exact frequency
        strip 3 .0066 "$magnesium" .5,.1,.05 .001 .5,.05,.025
        ;;
    b6) # splines, plane strain, slender
        plane=strain strip 2 .013 "$magnesium" .5,.05 .001 .5,.025
        ;;
    p1) # a smaller hole, edge moved
        plate .2
        ;;
    p2) # the same under a traction
        plate .2 | traction
        ;;
    p3) # rubber in other units, linear gradients
        plate .2 | sed "s/1738.0/1.1/; s/45.0e9/20/; s/smoothing = 0.008/smoothing = 8/; s/1.0e-6/1.0e-5/; s/end_time = 0.010/end_time = 10/; s/times = 0.010/times = 10/" |
            sed "s/'quadratic'/'linear'/"
        ;;
    esac
}
plate() { # plate RADIUS
    sed "s/, spacing = 0.0304//; s/hole_radius = 0.3/hole_radius = $1/; s/from = 0.3/from = $1/" input/plate.nml
}
traction() { # the edge is pulled in place of moved
    awk '/^&boundary$/ { out = 1; print "&load face=~y+~, shape=~face~, direction=0,1, amplitude=4.5e4, history=~step~, smoothing=0.008 /" }
        !out { print }
        /^\// { out = 0 }' | tr '~' "'"
}
plate_curve() { # plate_curve NAME: the finite plate's
    case $1 in
    p2) echo R0.2_trac ;;
    *) echo R0.2_disp ;;
    esac
}
tip_frequency() { awk -F': ' '/^frequency at tip/ { print $2 }' "$1/report.txt"; }
solid_error() {
    case $1 in
    p*) ligament "$(plate_curve "$1")" ;;
    b3 | b5) # against splines of degree 3
        if [ ! -e "$out/fine-$1/report.txt" ]; then
            solid "$1" >"$out/fine.nml"
            "$build/selas" -q "$out/fine.nml" "body%spacing=$([ "$1" = b3 ] && echo .0625 || echo .0125)" method%degree=3 method%mass=exact \
                stepping%scheme=modified-equation "output%directory=$out/fine-$1" >"$out/log" 2>&1
        fi
        tip_frequency "$out/run" | awk -v true="$(tip_frequency "$out/fine-$1")" '{ e = $1 / true - 1; printf "%.3g", e < 0 ? -e : e }'
        ;;
    b*) awk -F': ' '/^frequency error at tip/ { printf "%.3g", $2 < 0 ? -$2 : $2 }' "$out/run/report.txt" ;;
    esac
}
