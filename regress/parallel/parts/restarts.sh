# shellcheck shell=sh disable=SC2086,SC2154
# Runs that go on with other ranks.
one=3 two=2
chain "restart with snapshots" regress/parallel/tall-shown.nml scene%end_time=6
chain "restart, general ground in one pass, layers" $hill stepping%time_step=.03 $layers
chain "restart, damped general ground, layers" $hill stepping%time_step=.03 $layers $quality
chain "restart, layers beside the exact mass" regress/parallel/tall-exact.nml scene%end_time=8
chain "restart, damped ground, modified equation" regress/parallel/tall.nml material%q_p=40 material%q_s=25 stepping%scheme=modified-equation
chain "restart, points along the first axis" regress/parallel/long-sph.nml scene%end_time=20
chain "restart, points in layers" regress/parallel/column-sph.nml scene%end_time=10
LC_ALL=C awk -v n="52 7 6" -v jitter=.1 -f regress/parallel/points.awk >"$work/drawn.txt"
chain "restart, points of a file" regress/parallel/file-sph.nml body%file="$work/drawn.txt" scene%end_time=8
chain "restart, particles that move" regress/parallel/moving-particles.nml scene%end_time=20
chain "restart, dampers beside a mass of sweeps" regress/parallel/tall-dampers.nml scene%end_time=20
grep -q '^energy absorbed: ' "$work/alone/report.txt" && ! grep -qE '^energy absorbed: |^warning: of the energy' "$work/chain/report.txt"
verdict $? "and what its dampers took on ranks, which is not told, is not told after them"
one=2x2 two=3x1
chain "restart on blocks" regress/parallel/wide.nml
chain "restart on blocks, passes one by one, damped" regress/parallel/wide.nml method%fused=F material%q_p=40 material%q_s=25
chain "restart on blocks, single precision" regress/parallel/wide.nml method%precision=single
