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
    esac
}
box() { # box END DENSITY P_SPEED S_SPEED LOW HIGH
    ground "$1" "$2" "$3" "$4" | sed "s/shape = 'half-space'/shape = 'box', low = $5, high = $6/"
}
deck_of() { # deck_of NUMBER: a scene, or a wave of waves.sh (w1, w2, ...)
    case $1 in
    w*) wave "$1" ;;
    *) scene "$1" ;;
    esac
}
