# Scenes that are not in the table of errors, for scene%accuracy: scene NUMBER prints a deck without the accuracy.
# Pulses, widths, materials, patches, receivers, units differ from those that the table was made of.
ground() { # ground END DENSITY P_SPEED S_SPEED
    cat <<DECK
&scene dimension = 3, end_time = $1 /
&material name = 'rock', density = $2, p_speed = $3, s_speed = $4 /
&body material = 'rock', shape = 'half-space' /
&reference kind = 'lamb' /
&output plots = .false. /
DECK
}
scene() {
    case $1 in
    1) # Gaussian; receivers off the axes
        ground 5 1 1.7320508 1
        echo "&load face='z-', shape='square', centre=0,0,0, size=1,1, direction=0,0,1, history='gaussian', width=.22, delay=1.2 /"
        echo "&receiver name='a', position=.3,.2,0 / &receiver name='b', position=1.3,.4,0 / &receiver name='c', position=1.6,1,0 /"
        ;;
    2) # Ricker on a small patch, nu = .3
        ground 5 1 1.870829 1
        echo "&load face='z-', shape='square', centre=0,0,0, size=.6,.6, direction=0,0,1, history='ricker', frequency=.5, delay=2 /"
        echo "&receiver name='a', position=1,0,0 / &receiver name='b', position=1.5,0,0 /"
        ;;
    3) # short smooth triangle on a disc, nu = .4
        ground 4 1 2.449490 1
        echo "&load face='z-', shape='disc', centre=0,0,0, size=1.2, direction=0,0,1, history='triangle', duration=1.4, smoothing=.7 /"
        echo "&receiver name='a', position=0,0,0 / &receiver name='b', position=1.5,0,0 /"
        ;;
    4) # the kinked triangle
        ground 5 1 1.7320508 1
        echo "&load face='z-', shape='square', centre=0,0,0, size=1,1, direction=0,0,1, history='triangle', duration=2 /"
        echo "&receiver name='a', position=0,0,0 / &receiver name='b', position=1.25,0,0 /"
        ;;
    5) # sine burst far away, nu = .2
        ground 8 1 1.632993 1
        echo "&load face='z-', shape='square', centre=0,0,0, size=1,1, direction=0,0,1, history='sine-burst', frequency=.6, cycles=3 /"
        echo "&receiver name='a', position=2.5,0,0 /"
        ;;
    6) # soil in SI units, a long patch
        ground .05 1800 450 240
        echo "&load face='z-', shape='square', centre=0,0,0, size=3,1.5, direction=0,0,1, history='gaussian', width=.0016, delay=.009 /"
        echo "&receiver name='a', position=0,0,0 / &receiver name='b', position=4,0,0 /"
        ;;
    7) # an oblique push, one receiver in the ground
        ground 4 1 1.7320508 1
        echo "&load face='z-', shape='square', centre=0,0,0, size=1,1, direction=1,0,1, history='gaussian', width=.3, delay=1.5 /"
        echo "&receiver name='a', position=1.5,0,0 / &receiver name='b', position=.5,0,.8 /"
        ;;
    8) # over before any reflection: no layers
        ground 2.2 1 1.7320508 1
        echo "&load face='z-', shape='square', centre=0,0,0, size=1,1, direction=0,0,1, history='gaussian', width=.2, delay=1 /"
        echo "&receiver name='a', position=0,0,0 / &receiver name='b', position=.8,0,0 /"
        ;;
    9) # a quarter of a box with layers behind its faces
        box 5 1 2 1 0,0,0 3.2,2.4,2.4
        echo "&boundary face='x-','y-', kind='symmetry' / &boundary face='x+','y+','z+', kind='transmitting', layer='pml' /"
        echo "&load face='z-', shape='square', centre=0,0,0, size=.8,.8, direction=0,0,1, history='gaussian', width=.24, delay=1.3 /"
        echo "&receiver name='a', position=.3,.2,0 / &receiver name='b', position=1.6,.8,0 /"
        ;;
    10) # a box so large that nothing comes back, a disc, oblique
        box 2.6 2 1.8 1 -4,-4,0 4,4,3.2
        echo "&load face='z-', shape='disc', centre=0,0,0, size=1.5, direction=1,0,2, history='ricker', frequency=.8, delay=1.4 /"
        echo "&receiver name='a', position=0,0,0 / &receiver name='b', position=1,.5,0 /"
        ;;
    12) # a small quarter with layers
        box 4 1 1.7320508 1 0,0,0 2,1.5,1.5
        echo "&boundary face='x-','y-', kind='symmetry' / &boundary face='x+','y+','z+', kind='transmitting', layer='pml' /"
        echo "&load face='z-', shape='square', centre=0,0,0, size=1,1, direction=0,0,1, history='gaussian', width=.3, delay=1.5 /"
        echo "&receiver name='a', position=.25,.25,0 / &receiver name='b', position=1.2,.3,0 /"
        ;;
    11) # a box in SI units with layers, soft ground, off its middle
        box .06 1900 500 200 -10,-8,0 10,8,8
        echo "&boundary face='x-','x+','y-','y+','z+', kind='transmitting', layer='pml' /"
        echo "&load face='z-', shape='square', centre=-2,0,0, size=4,4, direction=0,0,1, history='triangle', duration=.03, smoothing=.015 /"
        echo "&receiver name='a', position=-2,0,0 / &receiver name='b', position=5,2,0 /"
        ;;
    l1) # a layer on rock, a quarter, nothing comes back: tuned splines
        strata 4.5 0,0,0 6,6,5 '1 1.9 1.1' '.8 1.1 .6:0' 'x:.7'
        echo "&boundary face='x-','y-', kind='symmetry' /"
        echo "&load face='z-', shape='square', centre=0,0,0, size=1,1, direction=0,0,1, history='gaussian', width=.3, delay=1.6 /"
        echo "&receiver name='a', position=.3,.2,0 / &receiver name='b', position=1.4,.5,0 /"
        ;;
    l2) # two layers on rock, SI units; the box is the program's
        strata .06 '' '' '2200 900 500' '1700 400 200:0' '1900 600 320:3' 'x:7'
        echo "&load face='z-', shape='square', centre=0,0,0, size=4,4, direction=0,0,1, history='gaussian', width=.004, delay=.02 /"
        echo "&receiver name='a', position=0,0,0 / &receiver name='b', position=5,0,0 /"
        ;;
    l3) # a stiff layer on soft ground, a disc, absorbing layers: splines of degree 2 with sweeps
        strata 5 0,0,0 2,2,2 '1 1.5 .8' '1.1 2.2 1.2:0' 'x:.5'
        echo "&boundary face='x-','y-', kind='symmetry' / &boundary face='x+','y+','z+', kind='transmitting', layer='pml' /"
        echo "&load face='z-', shape='disc', centre=0,0,0, size=1.2, direction=0,0,1, history='gaussian', width=.35, delay=1.8 /"
        echo "&receiver name='a', position=0,0,0 / &receiver name='b', position=1.5,0,0 /"
        ;;
    l4) # a soft layer, Ricker's wavelet, absorbing layers
        strata 6 0,0,0 2,2,2 '1 1.7320508 1' '1 .95 .55:0' 'x:.5'
        echo "&boundary face='x-','y-', kind='symmetry' / &boundary face='x+','y+','z+', kind='transmitting', layer='pml' /"
        echo "&load face='z-', shape='square', centre=0,0,0, size=1,1, direction=0,0,1, history='ricker', frequency=.35, delay=3 /"
        echo "&receiver name='a', position=0,0,0 / &receiver name='b', position=1.5,.5,0 /"
        ;;
    esac
}
strata() { # strata END LOW HIGH ROCK LAYER:TOP... x:TOP: density, P and S speed of each; x is the rock below; no LOW: a half-space
    if [ -n "$2" ]; then set -- "$1" "shape = 'box', low = $2, high = $3" "$@"; else set -- "$1" "shape = 'half-space'" "$@"; fi
    where=$2
    echo "&scene dimension = 3, end_time = $1 /"
    stratum rock "$6"
    shift 6
    for layer; do
        name=rock
        case $layer in
        x:*) ;;
        *)
            name=soil${layer#*:}
            stratum "$name" "${layer%:*}"
            ;;
        esac
        echo "&layer material = '$name', top = ${layer#*:} /"
    done
    echo "&body material = 'rock', $where /"
    echo "&reference kind = 'lamb' /"
    echo "&output plots = .false. /"
}
stratum() { echo "&material name = '$1', density = ${2%% *}, p_speed = $(echo "$2" | cut -d' ' -f2), s_speed = ${2##* } /"; }
box() { # box END DENSITY P_SPEED S_SPEED LOW HIGH
    ground "$1" "$2" "$3" "$4" | sed "s/shape = 'half-space'/shape = 'box', low = $5, high = $6/"
}
