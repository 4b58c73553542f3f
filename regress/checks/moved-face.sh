#!/bin/sh
# (Where the transform is on, the record is band-limited and rounds the kink of x(t) at t = 0: looked at after t = .2.)
# A bar whose end is pushed at speed 1 from t = 0 on, without any warning before: the end must be at x = t after every scheme and
# every step, and behind the front d'Alembert's wave moves with v = 1 and stress -rho c.
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
cat >"$out/push.nml" <<'D'
&scene dimension = 1, end_time = 2.0 /
&material name = 'bar', density = 1.0, lambda = 0.0, mu = 0.5 /
&body material = 'bar', low = 0.0, high = 4.0, spacing = 0.05 /
&boundary face = 'x-', kind = 'velocity', direction = 1.0, history = 'step' /
&receiver name = 'end', position = 0.0 /
&receiver name = 'inside', position = 1.0 /
D
for scheme in leapfrog modified-equation 'leapfrog stepping%unwarp=F' 'leapfrog method%mass=exact'; do
    # shellcheck disable=SC2086
    OMP_NUM_THREADS=1 "$build/selas" -q "$out/push.nml" output%plots=F output%directory="$out/run" stepping%scheme=$scheme \
        >"$out/log" 2>&1 || cat "$out/log" >&2
    worst=$(awk '!/^#/ && $1 > 0.2 { e = $2 - $1; if (e < 0) e = -e; if (e > w) w = e } END { print w + 0 }' "$out/run/end.dat")
    if awk -v w="$worst" 'BEGIN { exit !(w != "" && w < 2e-4) }'; then
        echo "ok - the end is at x = t, $scheme: off by at most $worst"
    else
        echo "not ok - the end is at x = t, $scheme: off by $worst"
    fi
    # the front passes x = 1 at t = 1; at t = 2 the place has moved by 1, but for what rings behind the front
    moved=$(tail -1 "$out/run/inside.dat" | cut -d' ' -f2)
    if awk -v u="$moved" 'BEGIN { exit !(u > 0.99 && u < 1.01) }'; then
        echo "ok - the wave carries the push, $scheme: u = $moved"
    else
        echo "not ok - the wave carries the push, $scheme: u = $moved, wanted 1"
    fi
done
