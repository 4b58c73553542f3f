# shellcheck shell=sh disable=SC2086,SC2154
# Lattices in blocks over y and depth.
wide="regress/parallel/wide.nml $early profile(1)%times=1.4 profile(2)%times=1.4"
same "2x1 1x2 3x2" "blocks, layers, one pass" $wide
as_planned "a rank sends the bytes a step that the plan of blocks tells" ranks
same "2x2" "blocks, layers, passes one by one" $wide method%fused=F
same "2x2" "blocks, nothing is quiet" $wide method%quiet=0
deep='body%high=3,9,24 load(2)%centre=.9,6.4,12.4 method%quiet=1e-6'
same "2x2" "deep blocks, halos that travel while the inside is made" $wide $deep
same "2x2" "deep blocks, passes one by one" $wide $deep method%fused=F
reached='method%quiet=1e-6 load(2)%centre=.9,4.4,1.8 body%high=3,18,9 profile(2)%to=.6,17,6.6'
same "3x2" "blocks in single precision, no wave has reached half of them" $wide method%precision=single $reached
same "2x2" "blocks, damped ground, one pass" $wide material%q_p=40 material%q_s=25
as_planned "and on blocks of damped ground of two operators" ranks
same "2x2" "blocks, dissipation, initial state" $wide method%dissipation=.02 body%high=3,11,9 initial%kind=gaussian initial%amplitude=1 initial%width=1.5 initial%centre=1,4,4 initial%direction=.3,.2,1
same "2x2" "blocks, snapshots" $shown body%high=3,10,10 "load(1)%centre=1.5,4,0" "load(2)%centre=1.5,5,10" "snapshot(2)%region=.5,.4,1,2.5,7.4,8.6"
same "2x2" "blocks, snapshots and mirror planes" $shown body%high=3,10,10 "load(1)%centre=1.5,5,0" "load(2)%centre=1.5,5,10" "snapshot(2)%region=.5,.4,1,2.5,7.4,8.6"
same "3x2" "blocks, dampers, four stages of Runge and Kutta" regress/parallel/tall-dampers.nml body%high=2,6,12 "load(1)%delay=.6" "load(2)%delay=.6" profile%to=1,.3,11.5 profile%times=.9 "load(2)%centre=1.1,3.4,9.8" "receiver(3)%position=.6,4.7,10.2" "receiver(4)%position=1.1,1.2,11.9" stepping%scheme=rk4 stepping%time_step=.03 scene%end_time=1
same "3x2" "blocks, moment tensor" input/buried-source.nml body%spacing=.25 load%width=.4 load%delay=.6 body%low=-2,-4,-4 body%high=2,4,4 scene%end_time=1 method%mass=vc3 method%degree=2 boundary%layer=pml boundary%layer_points=4 boundary%always=T
same "2x2" "blocks, layered ground" input/layered.nml body%spacing=.25 body%high=3,9,9 scene%end_time=2 method%degree=2 method%mass=vc3 'boundary(3)%layer=pml' 'boundary(3)%always=T'
same "3x2" "blocks, moving load" input/moving-load.nml body%spacing=.25 'load(1)%width=.5' 'load(2)%width=.5' method%mass=vc3 method%degree=2 body%high=8,6,10 body%low=-4,-5,0 boundary%layer=pml boundary%layer_points=5 boundary%always=T scene%end_time=1.5
for blocks in "2 1" "4 2" "6 3"; do
    set -- $blocks
    timeout 60 $mpirun -n "$1" "$build/mpi/blocks" "$work/blocks.h5" "$2" >"$work/log" 2>&1
    bad=$?
    verdict $bad "$1 blocks, $2 side by side: each writes and reads its own"
    [ "$bad" = 0 ] || sed 's/^/#   /' "$work/log" | head -5
done
