#!/bin/sh
# What every run keeps, on a dozen scenes drawn by chance and on six small decks (regress/hardening/relations/relations.c; doc/developers/robustness.md). Argument: the build
# folder. Prints TAP.
build=${1:-build}
if [ ! -x "$build/test/relations" ]; then
    echo "ok - relations # SKIP $build/test/relations is not built"
    exit 0
fi
"$build/test/relations" 1 12
status=$?
[ ! -x "$build/test/decks" ] || OMP_NUM_THREADS=1 "$build/test/decks" 1 regress/hardening/relations/decks/*.nml \
    regress/cases/half-space-step/deck.nml || status=1
exit $status
