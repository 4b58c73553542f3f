#!/bin/sh
# Disks that fail: writes that end in ENOSPC, EDQUOT or EIO at any place of a run (regress/checks/parts/failing.c), a disk and
# folders that cannot be written, results that stand in the way or are open elsewhere. A run either ends as it should, with the
# same bits, or says why with exit status 1, leaves no half file, and goes on from what it left to the same bits.
# Argument: the build folder. Prints TAP.
build=${1:-build}
selas=$PWD/$build/selas
. "$PWD/regress/checks/parts/scenes.sh"
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-disks-XXXXXX") || exit 1
trap 'cd /; umount "$work"/ro 2>/dev/null; chattr -i "$work"/fixed 2>/dev/null; rm -rf "$work"' EXIT
failing=$work/failing.so
${CC:-cc} -shared -fPIC -O1 -o "$failing" regress/checks/parts/failing.c -ldl || exit 1
cd "$work" || exit 1
export OMP_NUM_THREADS=1
failures=0
ok() {
    echo "ok - $1"
}
not_ok() { # not_ok WHAT WHY
    echo "not ok - $1: $2"
    sed 's/^/# /' err
    failures=$((failures + 1))
}

# sound FOLDER: nothing half, all files with names can be read.
sound() {
    if find "$1" -name '*.part' -o -name .running -o -name '*_link' 2>/dev/null | grep .; then return 1; fi
    for file in "$1"/*.h5 "$1"/unfinished/*.h5; do
        [ ! -f "$file" ] || h5dump -o /dev/null "$file" >/dev/null 2>&1 || { echo "not readable: $file"; return 1; }
    done
    for file in "$1"/*.dat "$1"/report.txt "$1"/deck.nml; do
        [ ! -f "$file" ] || [ "$(tail -c 1 "$file" | od -An -tx1)" = " 0a" ] || { echo "no end: $file"; return 1; }
    done
}

# completed FOLDER: goes on with what is there, or anew; the same bits as the whole run.
completed() {
    if [ -e "$1/unfinished/checkpoint.h5" ]; then
        "$selas" -q restart "$1/unfinished/checkpoint.h5" 2>again
    else
        "$selas" -q paper.nml output%directory="$1" output%checkpoint_every=5 2>again
    fi
    same whole "$1" >differs 2>&1 || { cat again differs; return 1; }
}

scene paper
"$selas" -q paper.nml output%directory=whole output%checkpoint_every=5 2>err || not_ok "a run" "it failed"
FAIL_COUNT=$work/count LD_PRELOAD=$failing "$selas" -q paper.nml output%directory=counted output%checkpoint_every=5 2>err
writes=$(head -1 count)
if [ "${writes:-0}" -gt 100 ] && same whole counted >/dev/null 2>&1; then
    ok "a run of $writes writes"
else
    not_ok "counting writes" "${writes:-none}"
fi
# the beginning, the end (results), and between: ENOSPC 28, EDQUOT 122, EIO 5
cases=0
stopped=0
number=0
for at in 1 2 3 6 11 $((writes / 7)) $((writes / 4)) $((writes / 2)) $((writes * 3 / 4)) $((writes * 7 / 8)) $((writes - 30)) \
    $((writes - 12)) $((writes - 5)) $((writes - 2)); do
    for fault in '28 No space left on device' '122 Disk quota exceeded' '5 Input/output error'; do
        number=$((number + 1))
        once=1000000000
        [ $((number % 4)) -ne 0 ] || once=1
        rm -rf out
        what="write $at of $writes, $([ $once -eq 1 ] && echo only that || echo and all later): ${fault#* }"
        FAIL_AT=$at FAIL_FOR=$once FAIL_ERROR=${fault%% *} LD_PRELOAD=$failing "$selas" -q paper.nml output%directory=out \
            output%checkpoint_every=5 >err 2>&1
        status=$?
        cases=$((cases + 1))
        if ! said=$(sound out); then
            not_ok "$what" "$said"
        elif [ $status -eq 0 ]; then
            same whole out >differs 2>&1 || not_ok "$what" "exit status 0, but not the same: $(cat differs)"
        elif [ $status -ne 1 ] || ! grep -q "^error: .*${fault#* }" err; then
            not_ok "$what" "exit status $status, or no message"
        else
            stopped=$((stopped + 1))
            said=$(completed out) || not_ok "$what" "does not go on: $said"
        fi
    done
done
if [ $stopped -gt $((cases / 2)) ]; then
    ok "$cases disks that fail: $stopped runs stopped with a message and went on to the same bits, $((cases - stopped)) did not mind"
else
    not_ok "$cases disks that fail" "only $stopped stopped"
fi

# refused WHAT MESSAGE FOLDER: the run ends with exit status 1 and the message, and leaves nothing half.
refused() {
    "$selas" -q paper.nml output%directory="$3" output%checkpoint_every=5 >err 2>&1
    status=$?
    if [ $status -eq 1 ] && grep -q "^error: .*$2" err && sound "$3" >said; then
        ok "$1"
    else
        not_ok "$1" "exit status $status, $(cat said 2>/dev/null)"
    fi
}
if [ "$(id -u)" -eq 0 ] && mkdir ro && mount -t tmpfs -o size=3m tmpfs ro 2>/dev/null; then
    cp -r whole ro/old
    mount -o remount,ro ro
    refused "a disk that is mounted to be read only" "ro/out.*Read-only file system" ro/out
    refused "the same, with results of an earlier run" "ro/old.*Read-only file system" ro/old
    if diff -r whole ro/old >differs 2>&1; then ok "... which stay as they are"; else not_ok "... which stay" "$(cat differs)"; fi
    umount ro
fi
mkdir locked
if [ "$(id -u)" -ne 0 ]; then
    chmod 555 locked
    refused "a folder without permission" "locked/out.*Permission denied" locked/out
    chmod 755 locked
elif command -v setpriv >/dev/null && setpriv --reuid=65534 --clear-groups test -r "$work/paper.nml" 2>/dev/null ||
    { chmod 755 "$work" && command -v setpriv >/dev/null && setpriv --reuid=65534 --clear-groups test -x "$selas"; }; then
    if setpriv --reuid=65534 --clear-groups "$selas" -q paper.nml output%directory=locked/out >err 2>&1; then status=0; else status=$?; fi
    if [ $status -eq 1 ] && grep -q "^error: .*locked/out.*Permission denied" err; then
        ok "a folder without permission"
    else
        not_ok "a folder without permission" "exit status $status"
    fi
fi
: >file
refused "a file where the folder should be" "file/out.*Not a directory" file/out
"$selas" -q nowhere/paper.nml >err 2>&1
if [ $? -eq 2 ] && grep -q "nowhere/paper.nml.*No such file" err; then ok "a deck in no folder"; else not_ok "a deck in no folder" ""; fi
if "$selas" -q paper.nml output%directory=not/there/yet >err 2>&1 && same whole not/there/yet >differs 2>&1; then
    ok "a folder that is not there is made"
else
    not_ok "a folder that is not there is made" "$(cat differs)"
fi

# Results that cannot be replaced: the state is kept, and with the way free the restart writes them.
blocked() { # blocked WHAT MESSAGE UNBLOCK: results in `out` are blocked until UNBLOCK
    refused "$1" "$2" out
    if grep -q "state is kept.*restart out/unfinished/checkpoint.h5" err; then ok "... the state is kept"; else not_ok "... the state is kept" ""; fi
    eval "$3"
    if said=$(completed out); then ok "... and goes on to the same bits"; else not_ok "... and goes on" "$said"; fi
    rm -rf out
}
rm -rf out
cp -r whole out
rm out/r1.dat
mkdir -p out/r1.dat/full
blocked "a folder in a history's place" "out/r1.dat.*Is a directory" "rm -r out/r1.dat"
mkdir -p out/run.h5/full
refused "a folder in the place of run.h5" "out/run.h5' is no result of selas" out
rm -rf out
cp -r whole out
if chattr +i out/report.txt 2>/dev/null; then
    blocked "a report that may not be changed" "out/report.txt.*Operation not permitted" "chattr -i out/report.txt"
fi
rm -rf out
cp -r whole out
exec 8<out/run.h5 9<out/r1.dat
command -v flock >/dev/null && flock 8 && flock 9
"$selas" -q paper.nml output%directory=out >err 2>&1
status=$?
if [ $status -eq 0 ] && same whole out >differs 2>&1; then
    ok "results that are open and locked elsewhere are replaced"
else
    not_ok "results that are open elsewhere" "exit status $status $(cat differs)"
fi
if cmp -s - whole/r1.dat <&9 && cmp -s - whole/run.h5 <&8; then ok "... and who reads them reads on"; else not_ok "... who reads them" "other bytes"; fi
exec 8<&- 9<&-
exit $failures
