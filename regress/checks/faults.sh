#!/bin/sh
# The quick ones of the planted faults of regress/hardening/faults/list; all of them: make faults. Argument: the build folder. Prints TAP.
exec regress/hardening/faults/run "${1:-build}" quick
