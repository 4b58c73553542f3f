# Read by the scripts that run tests under a checker (regress/hardening/sanitize, threads, valgrind): with verdict_folder set to
# where the logs go.
# One TAP line a test with the seconds of CPU that it took, what a checker found below it.
# Scripts that run the program on small scenes. Those left out: accuracy, plate, paper-halfspace, plane-wave, beam, cloud,
# dissipation, sph-published, symmetry, absorbing (the same code on larger scenes, for their figures), stability, faults,
# nightly, fuzz (they build or run other things), hosts, leaks, namelist (they build with compilers of their own).
verdict_scripts='wrong-decks hostile restart results needed moved-face program advice'
verdict_good=0 verdict_bad=0
mkdir -p "$verdict_folder"

verdict_cpu() { # seconds of CPU that the children of this shell have had so far, in $verdict_clock
    times >"$verdict_folder/times.$$" # not in a pipe: a shell of its own would count its own children
    verdict_clock=$(sed -n '2s/[a-z]/ /gp' "$verdict_folder/times.$$" | awk '{ printf "%d", 60 * ($1 + $3) + $2 + $4 }')
}

verdict() { # verdict NAME PATTERN COMMAND ...: a failure is a status other than 0 or a TAP line "not ok"
    name=$1 pattern=$2
    shift 2
    verdict_cpu
    begin=$verdict_clock
    "$@" >"$verdict_folder/$name.log" 2>&1
    status=$?
    verdict_cpu
    if [ $status -eq 0 ] && ! grep -q '^not ok' "$verdict_folder/$name.log"; then
        verdict_good=$((verdict_good + 1))
        echo "ok - $name ($((verdict_clock - begin)) s)"
    else
        verdict_bad=$((verdict_bad + 1))
        echo "not ok - $name ($((verdict_clock - begin)) s): exit status $status"
        grep -E -A12 "$pattern" "$verdict_folder/$name.log" | head -40
    fi
}

verdict_last() { # verdict_last WHAT: the counts; fails if anything did
    verdict_cpu
    echo "$verdict_good passed, $verdict_bad failed $1 ($verdict_clock s of CPU)"
    [ $verdict_bad -eq 0 ]
}
