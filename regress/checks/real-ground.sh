#!/bin/sh
# Scenes of real ground drawn by chance and what must hold of each (regress/studies/real-ground/run; more of them every night).
build=${1:-build}
if said=$(regress/studies/real-ground/run "$build" 9 12); then
    echo "ok - $(echo "$said" | head -1)"
else
    echo "not ok - $(echo "$said" | tr '\n' ';')"
fi
