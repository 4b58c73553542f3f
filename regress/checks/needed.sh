#!/bin/sh
# Only what the scene needs. Layers behind faces that no reflection can be seen from are left out: histories with and without
# (boundary%always) agree to 1e-5 of the largest value: what is felt ahead of the first wave. Parts that a deck does not ask for are not in the plan and take no
# memory: each adds its line and its bytes to those of the bare deck.
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
OMP_NUM_THREADS=1
export OMP_NUM_THREADS

cat >"$out/far.nml" <<'D'
&scene dimension = 3, end_time = 2.2 /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = 0, 0, 0, high = 3, 3, 3, spacing = 0.25 /
&boundary face = 'x-', 'y-', kind = 'symmetry' /
&boundary face = 'x+', 'y+', 'z+', kind = 'transmitting', layer = 'pml' /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1, 1, direction = 0, 0, 1
  history = 'gaussian', width = 0.3, delay = 1 /
&stepping time_step = 0.04 /
&receiver name = 'r1', position = 0.5, 0, 0 /
&receiver name = 'r2', position = 0.25, 0.25, 0.5 /
D
run() { # run NAME DECK WORDS...
    name=$1 deck=$2
    shift 2
    "$build/selas" -q "$out/$deck.nml" output%plots=F output%directory="$out/$name" "$@" >"$out/$name.log" 2>&1 ||
        cat "$out/$name.log"
}
value() { sed -n "s/^$2: \([^ ]*\).*/\1/p" "$out/$1/report.txt"; }
check() { # check TITLE CONDITION...
    title=$1
    shift
    if "$@"; then echo "ok - $title"; else echo "not ok - $title"; fi
}
less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && b != "" && a + 0 < b + 0) }'; }

run without far
run with far 'boundary(2)%always=T'
cat "$out/with/"r?.dat | grep -v '^#' >"$out/with.txt"
difference=$(cat "$out/without/"r?.dat | grep -v '^#' | paste - "$out/with.txt" | awk '{
    for (i = 2; i <= 7; i++) {
        d = $i - $(i + 7); if (d < 0) d = -d; if (d > worst) worst = d
        a = $i < 0 ? -$i : $i; if (a > largest) largest = a
    } } END { if (largest > 0 && NR > 100) printf "%.2e", worst / largest }')
check "layers that nothing can be seen of: histories differ by $difference" less "$difference" 1e-5
check "three layers are left out" test "$(grep -c '^layer .*: none' "$out/without/report.txt")" = 3
check "and kept on request" test "$(grep -c '^layer .*: C-PML' "$out/with/report.txt")" = 3
check "memory without them $(value without 'planned memory bytes') of $(value with 'planned memory bytes')" \
    less "$(value without 'planned memory bytes')" "$(awk -v m="$(value with 'planned memory bytes')" 'BEGIN { print .2 * m }')"

# The bare deck, and each part alone.
sed -e "s/, layer = 'pml'/, layer = 'lysmer'/" "$out/far.nml" >"$out/bare.nml"
run bare bare
parts='^(layer |memory variables|dissipation|snapshot groups|profiles|low-pass|symmetry)'
check "the bare plan lists none of the parts" test "$(grep -Ec "$parts" "$out/bare/report.txt")" = 0
points=$(value bare points)
vectors=$(awk -v m="$(value bare 'planned memory bytes')" -v u="$(value bare 'unknowns')" -v h="$(value bare 'model memory bytes')" \
    -v r="$(value bare steps)" -v x="$(value bare 'steps beyond end_time')" \
    'BEGIN { printf "%g", (m - h - 2 * 72 * (r + x + 2)) / (8 * u) }')
check "the bare state holds $vectors numbers per unknown" less "$vectors" 4
part() { # part NAME LINE BYTES-AT-LEAST DECK-TEXT
    { cat "$out/bare.nml"; echo "$4"; } >"$out/$1.nml"
    run "$1" "$1"
    lines=$(grep -E "$parts" "$out/$1/report.txt" | cut -d: -f1 | sort -u | tr '\n' ' ')
    check "$1: the plan lists it and nothing else ($lines)" test "$lines" = "$2 "
    more=$(awk -v a="$(value "$1" 'planned memory bytes')" -v b="$(value bare 'planned memory bytes')" 'BEGIN { printf "%d", a - b }')
    check "$1: $more bytes more than the bare deck" less "$(($3 - 1))" "$more"
}
part dissipation dissipation 1 "&method dissipation = 0.3 /"
part snapshots 'snapshot groups' $((48 * points)) "&snapshot times = 1.0, fields = 'velocity' /"
part low_pass low-pass 0 "&output low_pass = 20 /"
part profile profiles 0 "&profile name = 'p', from = 0, 0, 0, to = 1, 0, 0, points = 5, times = 1.0 /"
# Loads: a point force in the body takes its entries alone, no field; a second one the same again.
force="&load kind = 'body-force', shape = 'point', centre = 1.1, 1.2, 1.3, direction = 0, 0, 1, history = 'gaussian', width = 0.3, delay = 1 /"
fine='body%spacing=0.0625 stepping%time_step=0.01 scene%end_time=0.02'
# shellcheck disable=SC2086 # words
run fine bare $fine
field=$(awk -v u="$(value fine unknowns)" 'BEGIN { print 8 * u }')
for count in 1 2; do
    { cat "$out/bare.nml"; echo "$force"; test $count = 1 || echo "$force"; } >"$out/force$count.nml"
    # shellcheck disable=SC2086
    run force$count force$count $fine
    eval "more$count=$(awk -v a="$(value force$count 'model memory bytes')" -v b="$(value fine 'model memory bytes')" 'BEGIN { printf "%d", a - b }')"
done
# shellcheck disable=SC2154 # more1 and more2 are set by eval
check "a body force takes $more1 bytes of a model, less than a twentieth of a field ($field)" \
    less "$(awk -v m="$more1" 'BEGIN { print 20 * m }')" "$field"
# shellcheck disable=SC2154
check "two of them twice that ($more2), and more than nothing" test "$more1" -gt 0 -a "$more2" -eq $((2 * more1))

# C-PML: its memory variables and nothing else of their size; without it none of its memory.
run lysmer far 'boundary(2)%layer=lysmer'
run pml far 'boundary(2)%always=T'
variables=$(value pml 'memory variables of layers')
extra=$(awk -v a="$(value pml 'planned memory bytes')" -v b="$(value lysmer 'planned memory bytes')" -v p="$(value pml unknowns)" -v u="$(value lysmer unknowns)" \
    'BEGIN { printf "%.2f", (a - b) / (8 * (p - u)) }')
check "C-PML layers: $variables memory variables, listed with C-PML alone; planned memory grows by $extra numbers per unknown more" \
    test "$(grep -c '^memory variables' "$out/lysmer/report.txt")$(grep -c '^memory variables' "$out/pml/report.txt")" = 01

# The state of either smoothed point method is displacement, velocity and work vectors alone: nothing of other methods'.
cat >"$out/block.nml" <<'D'
&scene dimension = 3, end_time = 0.1 /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = 0, 0, 0, high = 1.5, 1.5, 1.5, spacing = 0.25 /
&load face = 'z-', shape = 'face', direction = 0, 0, 1, history = 'gaussian', width = 0.3, delay = 1.2 /
&receiver name = 'r1', position = 0.5, 0.5, 0.5 /
D
for method in consistent paper; do # u, v, a; the paper's filter keeps the state before a step besides
    case $method in consistent) wanted=3.00 ;; *) wanted=5.00 ;; esac
    run $method block method%variant=$method
    state=$(awk -v m="$(value $method 'planned memory bytes')" -v u="$(value $method unknowns)" -v h="$(value $method 'model memory bytes')" \
        -v r="$(value $method steps)" -v x="$(value $method 'steps beyond end_time')" 'BEGIN { printf "%.2f", (m - h - 72 * (r + x + 2)) / (8 * u) }')
    check "$method: $state numbers of state per unknown" test "$state" = $wanted
done
echo "# $points points"

# What general ground and scattered points take, set-up included: the run's peak without the program's own memory, that of a scene of 250 points.
"$build/selas" -q input/bar.nml output%plots=F output%directory="$out/bar" >"$out/bar.log" 2>&1 || cat "$out/bar.log"
cat >"$out/uneven.nml" <<'D'
&scene dimension = 3, end_time = 0.05 /
&method name = 'sph', variant = 'total-lagrangian' /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = 0, 0, 0, high = 5, 5, 5, spacing = 0.25, jitter = .15 /
&load face = 'z-', shape = 'face', direction = 0, 0, 1, history = 'gaussian', width = 0.3, delay = 1.2 /
&receiver name = 'r1', position = 0.5, 0.5, 0.5 /
D
cp input/hill.nml input/loh1.nml "$out"
for deck in hill loh1 uneven; do
    word=method%operator=general
    [ $deck != uneven ] || word=body%jitter=.15
    "$build/selas" -q "$out/$deck.nml" output%plots=F scene%end_time=.1 $word output%directory="$out/$deck" >"$out/$deck.log" 2>&1 ||
        cat "$out/$deck.log"
    part=$(awk -v p="$(value $deck 'peak memory bytes')" -v b="$(value bar 'peak memory bytes')" -v m="$(value $deck 'planned memory bytes')" \
        'BEGIN { if (m > 0) printf "%.3f", (p - b) / m }')
    check "$deck.nml: the run takes $part of the planned memory" less .85 "$part"
    # a sanitizer keeps what was freed
    [ -n "${SELAS_SANITIZED:-}" ] || check "and not more than 1.15" less "$part" 1.15
done
