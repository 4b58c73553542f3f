#!/bin/sh
# What a run says when it grows by itself: refused beforehand, stopped with place and time, or warned of at the end, each once; the
# hard cases all together are `regress/studies/stability/run BUILD quick`.
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
OMP_NUM_THREADS=1
export OMP_NUM_THREADS
cat >"$out/box.nml" <<'D'
&scene dimension = 3, end_time = 20 /
&method variant = 'paper', filter = 0 /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = 0, 0, 0, high = 1, 1, 1, spacing = .25 /
&load face = 'z-', shape = 'square', centre = .5, .5, 0, size = .5, .5, direction = 0, 0, 1
  history = 'gaussian', width = .3, delay = 2 /
&receiver name = 'r', position = .5, .5, 0 /
D
expect() { # expect WHAT STATUS PATTERN DECK OVERRIDES...
    what=$1
    status=$2
    pattern=$3
    shift 3
    "$build/selas" -q "$@" output%plots=F "output%directory=$out/run" >"$out/log" 2>&1
    got=$?
    if [ $got -eq "$status" ] && grep -q "$pattern" "$out/log"; then echo "ok - $what"; else
        echo "not ok - $what: exit status $got"
        cat "$out/log"
    fi
}
expect 'growth is stopped with place and time' 1 'went unstable at t = .*fastest at' "$out/box.nml"
# the last good checkpoint is at least a hundred steps old, and named
named() { # named WHAT DECK EVERY
    expect "$1 names the last good checkpoint, one every $3 steps" 1 'likely: ' "$2" stepping%time_step=.03 "output%checkpoint_every=$3"
    step=$(sed -n 's/.*unstable at t = .*(step \([0-9]*\)).*/\1/p' "$out/log")
    good=$(sed -n 's/^the last good checkpoint is that of step \([0-9]*\), t = [0-9.]*: selas restart .*/\1/p' "$out/log")
    file=$(sed -n 's/^the last good .*: selas restart //p' "$out/log")
    if [ -n "$good" ] && { [ "$good" -eq 0 ] || [ $((step - good)) -ge 100 ]; } && [ -e "$file" ] &&
        ! "$build/selas" -q restart "$file" >"$out/log" 2>&1 && grep -q "unstable at t = .*(step $step)" "$out/log"; then
        echo "ok - ... of step $good of $step, which a restart reads and fails at the same step"
    else
        echo "not ok - ... of step '$good' of '$step', '$file'"
        cat "$out/log"
    fi
    rm -rf "$out/run"
}
for every in 10 60 150; do named growth "$out/box.nml" $every; done
# the same body driven by a face, for which there is no balance of energy
sed -e '/^&load/,/^  history/d' -e 's/end_time = 20/end_time = 40/' "$out/box.nml" >"$out/moved.nml"
echo "&boundary face = 'x-', kind = 'displacement', direction = 1, 0, 0, history = 'gaussian', width = .3, delay = 2 /" >>"$out/moved.nml"
named 'growth with a moved face' "$out/moved.nml" 60
expect 'growth too small to stop is warned of' 0 'warning: the body ends with .* that nobody gave it' "$out/box.nml" scene%end_time=7.6
expect 'a scheme that is unstable for every step is refused' 2 'unstable for every time step' input/bar.nml \
    method%viscosity_alpha=0 method%viscosity_beta=0
"$build/selas" -q "$out/box.nml" method%variant=consistent method%filter= output%plots=F "output%directory=$out/run" >"$out/log" 2>&1
if [ $? -eq 0 ] && ! grep -q warning "$out/log"; then echo "ok - a sound run is not warned of"; else
    echo "not ok - a sound run is not warned of"
    cat "$out/log"
fi
