# shellcheck shell=sh disable=SC2086,SC2154
# General ground.
stepped="$hill stepping%time_step=.03"
same "1 3 4" "general ground, one pass" $hill
same 3 "general ground, passes one by one" $stepped method%fused=F
same 2 "general ground in single precision" $stepped method%precision=single body%high=4,4,16
same 4 "general operator, mirror planes" $shown method%operator=general body%high=4,4,18
same 3 "general ground, dampers" $stepped "boundary(1)%face=x-,y+,z+" "boundary(1)%kind=transmitting" "boundary(1)%layer=lysmer"
same "2 4" "general ground, layers, one pass" $stepped $layers
same 2 "the same, passes one by one" $stepped method%fused=F $layers
same 3 "the same in single precision" $stepped method%precision=single body%high=4,4,16 $layers
same "1 2 3 4" "damped general ground, layers, one pass" $stepped $layers $quality
same 3 "the same, passes one by one" $stepped method%fused=F $layers $quality
same 2 "the same in single precision" $stepped method%precision=single body%high=4,4,16 $layers $quality
same 3 "general ground in two dimensions, layers" regress/parallel/tall-plane.nml load%delay=.5 scene%end_time=1.5 snapshot%every=.7
same "3 4" "moment tensors beside the sides of a block" regress/parallel/block-side.nml
