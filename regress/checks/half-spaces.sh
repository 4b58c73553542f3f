#!/bin/sh
# Half-spaces drawn by chance, each against a larger box (regress/studies/half-spaces; more of them every night).
build=${1:-build}
if said=$(regress/studies/half-spaces "$build" 23 30); then
    echo "ok - $(echo "$said" | head -1)"
else
    echo "not ok - $(echo "$said" | tr '\n' ';')"
fi
