#!/bin/sh
# Three of the planted faults of regress/faults.list; all of them: make faults. Argument: the build folder. Prints TAP.
exec regress/faults "${1:-build}" quick
