# shellcheck shell=sh disable=SC2086,SC2154
# Lattices in slabs over depth, ground in layers.
tall="regress/parallel/tall.nml $early"
same "1 3 7" "layers, one pass" $tall
as_planned "a rank sends the bytes a step that the plan tells" ranks
quiet 3 $tall material%q_p=40 material%q_s=25 output%plots=F output%directory="$work/damped"
as_planned "and on damped ground of two operators" damped
same 4 "layers, dissipation" $tall method%dissipation=.02
same 3 "layers, passes one by one, nothing is quiet" $tall method%fused=F method%quiet=0
same 4 "damped ground, one pass" $tall material%q_p=40 material%q_s=25
same 3 "damped ground, modified equation" $tall material%q_p=40 material%q_s=25 stepping%scheme=modified-equation
same 4 "mirror planes, a moved face and a fixed one" regress/parallel/tall-mirrors.nml scene%end_time=1.5 "boundary%kind=displacement" "boundary%direction=.2,0,1" "boundary%history=gaussian" boundary%width=.4 boundary%delay=.6
same "2 4" "snapshots, all and a part of the body" $shown
same 3 "snapshots of damped ground" $shown material%q_p=40 material%q_s=25
dampers="regress/parallel/tall-dampers.nml $early profile(1)%times=1,1.4"
same 3 "dampers, exact mass" $dampers method%mass=exact
same "2 4" "layers, exact mass of degree 3" regress/parallel/tall-exact.nml
short="regress/parallel/tall-exact.nml method%degree=4 body%high=4,25.5 layer(2)%top=12 load(2)%centre=1,13 load(3)%centre=1,23 receiver(2)%position=1,14 receiver(3)%position=1,22"
same 2 "layers, exact mass of degree 4, parts as thin as may be" $short
same 3 "layers, exact mass in three dimensions, modified equation" $tall method%mass=exact stepping%scheme=modified-equation body%high=2,2,32
quiet 3 regress/parallel/tall-exact.nml output%directory="$work/reach"
as_planned "and a rank sends what the plan tells, its solves among it" reach
same 2 "damped ground, exact mass" regress/parallel/tall-exact.nml "material(1)%q_p=40" "material(1)%q_s=25" "material(2)%q_p=40" "material(2)%q_s=25" "boundary(2)%layer=lysmer" "boundary(2)%layer_points=" "boundary(2)%always=" scene%end_time=.8
same 3 "a profile of steps in one pass" $dampers "boundary(2)%layer=pml"
same 4 "dampers, mass of sweeps" $dampers
same 4 "moment tensor" input/buried-source.nml body%spacing=.25 load%width=.4 load%delay=.6 body%low=-2,-2,-4 body%high=2,2,4 scene%end_time=1.2
same "2 3" "initial state in one dimension" input/plane-wave.nml body%spacing=.05 initial%width=.2
layered='input/layered.nml body%spacing=.25 body%high=3,3,15 scene%end_time=3'
same 3 "layered ground, exact mass" $layered
same 4 "layered ground, mass of sweeps, layers" $layered method%degree=2 method%mass=vc3 'boundary(3)%layer=pml' 'boundary(3)%always=T'
