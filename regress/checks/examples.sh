#!/bin/sh
# What an addition costs: regress/examples/ adds a kernel, an exact solution, a time scheme and a spatial method by a file
# and a line in src/deck/choices.h each, and the program built with them (regress/rules.mk) runs, plans and refuses with
# their names like any other. Prints TAP.
build=${1:-build}
selas=$build/examples/selas
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
ok() { # ok WHAT: of the last command
    if [ $? -eq 0 ]; then echo "ok - $1"; else echo "not ok - $1"; fi
}
error_of() { # error_of DECK OVERRIDE...: L2 of the velocity against the exact solution
    deck=$1
    shift
    "$selas" "regress/examples/$deck.nml" output%directory="$out/$deck" output%plots=.false. "$@" >"$out/said" 2>&1
    sed -n 's/^error largest: \([^ ]*\) .*/\1/p' "$out/said"
}
below() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && a + 0 <= b) }'; }

added=$(diff src/deck/choices.h "$build/examples/src/deck/choices.h" | grep -c '^> .*[(]')
files=$(ls regress/examples/*.c | wc -l)
# a list's last line before the new one gets a \ at its end: it counts as changed, too
[ "$files" -eq 4 ] && [ "$added" -eq 8 ]
ok "four examples are four files and four lines"
coarse=$(error_of bar) fine=$(error_of bar body%spacing=.025)
below "$coarse" .0040 && below "$fine" .0010
ok "method and scheme: a pulse on a bar, .0037 and .0009 at half the spacing (now $coarse, $fine)"
for part in 8 4 2; do
    error_of bar stepping%courant=.$part output%history_step=.1 >/dev/null
    grep -v '^#' "$out/bar/ahead.dat" >"$out/$part"
done
# with errors C dt^3 the first differs from the last (.8^3 - .2^3) / (.4^3 - .2^3) = 9 times as much as the second does
times=$(paste "$out/8" "$out/4" "$out/2" | awk '{ a += ($2 - $16)^2; b += ($9 - $16)^2 } END { print sqrt(a / b) }')
awk -v t="$times" 'BEGIN { exit !(t > 8.5 && t < 9.5) }'
ok "scheme: order 3 in time (differences of three steps 1 to $times, expected 9)"
below "$(error_of drift)" 1e-14
ok "exact solution and kernel: a free body moves as a whole"
"$build/examples/test_kernel" >"$out/kernel" 2>&1
ok "kernel: integral, slopes and plane factor as those of the others (test_kernel)"
"$selas" check regress/examples/drift.nml | grep -q '^kernel: lucy$'
ok "the plan names it"
"$selas" check regress/examples/bar.nml stepping%scheme=rk33 2>&1 | grep -q "did you mean 'rk3'?"
ok "a misspelt name suggests it"
"$selas" check regress/examples/bar.nml boundary%face=x+ boundary%kind=transmitting >"$out/said" 2>&1
grep -q "finite-differences" "$out/said"
ok "the table of kinds of faces refuses for it what it cannot do"
