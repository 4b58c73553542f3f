# Plane waves and pulses in bars and boxes that no table was made of, for scene%accuracy: wave NAME prints a deck without
# the accuracy. Materials, units, dimensions, ends, kinds of source, lengths of way differ.
bar() { # bar DIMENSION END LOW HIGH DENSITY P_SPEED S_SPEED
    cat <<DECK
&scene dimension = $1, end_time = $2 /
&material name = 'rock', density = $5, p_speed = $6, s_speed = $7 /
&body material = 'rock', shape = 'box', low = $3, high = $4 /
&reference kind = 'plane-wave' /
&output plots = .false. /
DECK
}
wave() {
    case $1 in
    w1) # a pulse in a bar, steel, held at one end
        bar 1 .0011 0 2.5 7850 5900 3200
        echo "&boundary face='x+', kind='fixed' /"
        echo "&initial kind='plane-wave', amplitude=1, wave='p', direction=1, centre=.6, width=.05 /"
        echo "&receiver name='a', position=1.3 / &receiver name='b', position=2.41 /"
        ;;
    w2) # a bar whose end is moved; three reflections
        bar 1 7 0 2 1 1.5 .8
        echo "&boundary face='x-', kind='displacement', direction=1, amplitude=1, history='gaussian', width=.12, delay=.6 /"
        echo "&receiver name='a', position=.7 / &receiver name='b', position=2 /"
        ;;
    w3) # a rod that is pushed by a wavelet, an absorbing end
        bar 1 4 0 5 2 2 1.1
        echo "&load face='x-', shape='face', direction=1, history='ricker', frequency=1.2, delay=1 /"
        echo "&boundary face='x+', kind='transmitting' /"
        echo "&receiver name='a', position=1 / &receiver name='b', position=3.7 /"
        ;;
    w4) # an S pulse in a rectangle
        bar 2 3 0,0 4,.5 1 1.9 1
        echo "&initial kind='plane-wave', amplitude=1, wave='s', direction=1,0, centre=1,0, width=.15 /"
        echo "&boundary face='y-','y+', kind='displacement', direction=1,0, slip=T, amplitude=0, history='step' /"
        echo "&receiver name='a', position=2,.2 / &receiver name='b', position=3.5,.4 /"
        ;;
    w5) # a P pulse in a box between rollers, along y
        bar 3 1.6 0,0,0 .8,4,.8 1 1.7320508 1
        echo "&initial kind='plane-wave', amplitude=1, wave='p', direction=0,1,0, centre=0,1,0, width=.2 /"
        echo "&boundary face='x-','x+','z-','z+', kind='roller' /"
        echo "&receiver name='a', position=.4,2,.4 / &receiver name='b', position=.2,3.6,.8 /"
        ;;
    w6) # an S pulse through the depth of a box
        bar 3 2.4 0,0,-1 1.2,1.2,3 1 2 1
        echo "&boundary face='x-','x+', kind='symmetry' /"
        echo "&boundary face='y-','y+', kind='displacement', direction=0,0,1, slip=T, amplitude=0, history='step' /"
        echo "&initial kind='plane-wave', amplitude=1, wave='s', direction=0,0,1, polarisation=0,1,0, centre=0,0,0, width=.13 /"
        echo "&receiver name='a', position=.2,.3,1.3 / &receiver name='b', position=0,.25,2.1 /"
        ;;
    w7) # a whole face of a box is pushed by a sine burst
        bar 3 3 0,0,0 6,.6,.6 1 1.7320508 1
        echo "&load face='x-', shape='face', direction=1,0,0, history='sine-burst', frequency=1.5, cycles=4 /"
        echo "&boundary face='y-','y+','z-','z+', kind='roller' /"
        echo "&receiver name='a', position=2,.3,.3 / &receiver name='b', position=4,0,.3 /"
        ;;
    w8) # a bar whose end is shaken, nu = .4
        bar 1 6 0 3 1 2.449490 1
        echo "&boundary face='x-', kind='velocity', direction=1, amplitude=1, history='sine-burst', frequency=1, cycles=2 /"
        echo "&receiver name='a', position=1 / &receiver name='b', position=2.5 /"
        ;;
    w9) # a pulse that goes to and fro ten times
        bar 1 20 0 2 1 1 .5
        echo "&boundary face='x+', kind='fixed' /"
        echo "&initial kind='plane-wave', amplitude=1, wave='p', direction=1, centre=.8, width=.1 /"
        echo "&receiver name='a', position=1.1 / &receiver name='b', position=.3 /"
        ;;
    w10) # a kinked push
        bar 1 3 0 4 1 1.5 .8
        echo "&load face='x-', shape='face', direction=1, history='triangle', duration=.8 /"
        echo "&receiver name='a', position=1 / &receiver name='b', position=3 /"
        ;;
    esac
}
