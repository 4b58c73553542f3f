#!/bin/sh
# What every run keeps, on a dozen scenes drawn by chance (regress/hardening/relations/relations.c; doc/developers/robustness.md). Argument: the build
# folder. Prints TAP.
build=${1:-build}
if [ ! -x "$build/test/relations" ]; then
    echo "ok - relations # SKIP $build/test/relations is not built"
    exit 0
fi
exec "$build/test/relations" 1 12
