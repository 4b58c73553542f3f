#!/bin/sh
# Runs that are killed or stopped and go on: the same bits as without; damaged checkpoints, two runs in one folder, disks that are
# full or not there. Argument: the build folder. Prints TAP. Nothing here depends on how fast the machine is: a run that is
# over before the signal comes is made again.
build=${1:-build}
selas=$PWD/$build/selas
. "$PWD/regress/checks/parts/scenes.sh"
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-restart-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export OMP_NUM_THREADS=1
failures=0
check() { # check WHAT COMMAND...: ok if the command succeeds
    what=$1
    shift
    if "$@" >said 2>&1; then
        echo "ok - $what"
    else
        echo "not ok - $what"
        sed 's/^/# /' said
        failures=$((failures + 1))
    fi
}

# begun NAME SIGNAL FILE: begins the run, sends the signal when FILE is there in its folder `unfinished`; until that has worked.
begun() {
    for try in 1 2 3 4 5 6 7 8 9 10; do
        rm -rf "cut_$1"
        "$selas" -q "$1.nml" output%directory="cut_$1" output%checkpoint_every=1 2>cut.err &
        process=$!
        while [ ! -e "cut_$1/unfinished/$3" ] && kill -0 $process 2>/dev/null; do sleep .01; done
        kill "-$2" $process 2>/dev/null
        wait $process 2>/dev/null
        status=$?
        [ -e "cut_$1/unfinished/checkpoint.h5" ] && [ $status -ne 0 ] && return 0
    done
    echo "the run was always over before the signal (try $try)"
    return 1
}
number=0
for name in $scenes; do
    scene "$name"
    number=$((number + 1))
    threads=$((2 - number % 2))
    "$selas" -q "$name.nml" output%directory="whole_$name" output%checkpoint_every=1 2>whole.err || sed 's/^/# /' whole.err
    check "$name: killed" begun "$name" KILL "snapshot_000$((1 + number % 4)).h5"
    check "$name: goes on with $threads thread(s)" env OMP_NUM_THREADS=$threads "$selas" -q restart "cut_$name/unfinished/checkpoint.h5"
    check "$name: same bits" same "whole_$name" "cut_$name"
done

# --- Signals
begun paper TERM snapshot_0001.h5
check "SIGTERM: exit status 1" [ $status -eq 1 ]
check "SIGTERM: says how to go on" grep -q "stopped by SIGTERM at step .* selas restart cut_paper/unfinished/checkpoint.h5" cut.err
so_far() { # so_far WHOLE CUT NAME: the history so far is marked and begins as that of the whole run
    grep -q '^# UNFINISHED: the run was stopped at step' "$2/unfinished/$3.dat" || { echo "not marked"; return 1; }
    grep -v '^#' "$2/unfinished/$3.dat" >part
    rows=$(wc -l <part)
    [ "$rows" -gt 4 ] && grep -v '^#' "$1/$3.dat" | head -n "$rows" | cmp - part
}
check "SIGTERM: the histories so far are left, marked" so_far whole_paper cut_paper r1
check "SIGTERM: says where" grep -q "histories so far are in cut_paper/unfinished/" cut.err
check "SIGTERM: none among the results" sh -c "! ls cut_paper | grep -v unfinished"
check "SIGTERM: the profile so far is marked" grep -q UNFINISHED cut_paper/unfinished/line.dat
check "a restart from within the folder" sh -c "cd cut_paper/unfinished && '$selas' -q restart checkpoint.h5"
check "SIGTERM: same bits" same whole_paper cut_paper
check "SIGTERM: nothing is left of the histories so far" [ ! -e cut_paper/unfinished ]
begun modified INT snapshot_0003.h5
check "SIGINT: exit status 1" [ $status -eq 1 ]
check "SIGINT: the restart is stopped again, and goes on" sh -c "
    '$selas' -q restart cut_modified/unfinished/checkpoint.h5 & process=\$!; sleep .05; kill -INT \$process; wait \$process
    [ ! -e cut_modified/unfinished ] || '$selas' -q restart cut_modified/unfinished/checkpoint.h5"
check "SIGINT: same bits" same whole_modified cut_modified
usr1() { # a checkpoint on demand in a run without any
    "$selas" -q flying.nml output%directory=usr1 output%checkpoint_minutes=0 &
    process=$!
    while [ ! -e usr1/unfinished/snapshot_0001.h5 ] && kill -0 $process 2>/dev/null; do sleep .01; done
    while [ ! -e usr1/unfinished/checkpoint.h5 ] && kill -USR1 $process 2>/dev/null; do sleep .01; done
    seen=$(ls usr1/unfinished/checkpoint.h5 2>/dev/null)
    wait $process && [ -n "$seen" ]
}
check "SIGUSR1: a checkpoint, and the run goes on to its end" usr1
check "SIGUSR1: same bits" same whole_flying usr1
mkfifo late.nml
early() { # while the deck is read
    "$selas" -q late.nml output%directory=early output%checkpoint_minutes=0 &
    process=$!
    exec 3>late.nml && kill -USR1 $process && cat flying.nml >&3
    exec 3>&-
    wait $process && [ ! -e early/unfinished ]
}
check "SIGUSR1 during the set-up: the run goes on to its end" early
check "nothing is left of a finished run" sh -c "! ls -A usr1 | grep -E 'unfinished|running|part'"

# --- Checkpoints that must not be used
begun paper KILL snapshot_0002.h5
good=cut_paper/unfinished/checkpoint.h5
size=$(wc -c <$good)
refused() { # refused WHAT REASON: the file `unfinished/bad.h5` is refused with the reason
    if "$selas" -q restart cut_paper/unfinished/bad.h5 >said 2>&1; then status=0; else status=$?; fi
    if [ $status -eq 1 ] && grep -q "$2" said; then
        echo "ok - refused: $1"
    else
        echo "not ok - refused: $1 (exit status $status)"
        sed 's/^/# /' said
        failures=$((failures + 1))
    fi
}
bad=cut_paper/unfinished/bad.h5
refused "not there" "No such file"
cp cut_paper/unfinished/points.h5 $bad
refused "another HDF5 file" "no checkpoint of selas"
: >$bad
refused "empty" "no checkpoint of selas"
rm $bad && mkdir $bad
refused "a folder" "it is a folder; .* unfinished/checkpoint.h5"
rmdir $bad
for part in 100 600 $((size / 2)) $((size - 1)); do
    head -c "$part" $good >$bad
    refused "cut to $part bytes of $size" "cut short"
done
flip() { # flip BYTE: one bit of that byte
    cp $good $bad
    old=$(od -An -tu1 -j"$1" -N1 $good | tr -d ' ')
    # shellcheck disable=SC2059
    printf "\\$(printf %o $((old ^ 16)))" | dd of=$bad bs=1 seek="$1" conv=notrunc 2>/dev/null
}
for byte in 30 511 512 700 $((size / 3)) $((size / 2)) $((size - 9)); do
    flip "$byte"
    refused "a bit flipped in byte $byte" "damaged"
done
echo "x" | cat $good - >$bad
refused "a byte too many" "damaged"
reworded() { # reworded OLD NEW: other words in the head, its checksum made right: as another program would write it
    python3 - "$good" "$bad" "$1" "$2" <<'END'
import sys
good, bad, old, new = sys.argv[1:5]
data = open(good, 'rb').read()
head = data[:512].rstrip(b'\0').decode()
lines = head[:head.index('\nhead ') + 1].replace(old, new)
table = []
for i in range(256):
    for _ in range(8):
        i = i >> 1 ^ (0xC96C5795D7870F42 if i & 1 else 0)
    table.append(i)
crc = 2**64 - 1
for byte in lines.encode():
    crc = crc >> 8 ^ table[(crc ^ byte) & 255]
head = lines + 'head %016x\n' % (crc ^ 2**64 - 1)
open(bad, 'wb').write(head.encode().ljust(512, b'\0') + data[512:])
END
}
if command -v python3 >/dev/null; then
    version=$("$selas" --version | cut -d' ' -f2)
    reworded "version $version" "version 9.9.9" && refused "of another version" "written by version 9.9.9, this is $version"
    reworded "little-endian" "big-endian" && refused "of another byte order" "written by a big-endian machine"
    reworded "format 7" "format 8" && refused "of another format" "format 8"
    reworded "commit " "commit 0" && cp -a cut_paper other && mv other/unfinished/bad.h5 other/unfinished/checkpoint.h5
    check "of another commit: told, and goes on" sh -c "'$selas' -q restart other/unfinished/checkpoint.h5 2>err && grep -q 'was written by commit 0' err"
    check "and same bits" same whole_paper other
    reworded "little" "little" && cmp -s $good $bad && echo "ok - the checksum of the head is CRC-64"
fi
cp cut_paper/unfinished/snapshot_0001.h5 kept.h5
cp $good $bad
head -c 900 kept.h5 >cut_paper/unfinished/snapshot_0001.h5
refused "a damaged snapshot beside it" "snapshot_NNNN.h5"
mv kept.h5 cut_paper/unfinished/snapshot_0001.h5
cp $good elsewhere.h5
check "refused: in another folder" sh -c "! '$selas' -q restart elsewhere.h5 2>err && grep -q 'in no folder' err"
check "refused: overrides" sh -c "'$selas' -q restart $good body%spacing=1 2>err; [ \$? -eq 2 ] && grep -q 'no overrides' err"
rm -f $bad
cp -a cut_paper edited
cp paper.nml kept.nml
echo '! another deck by now' >>paper.nml
check "the deck has changed: told, and goes on as it was" sh -c "'$selas' -q restart edited/unfinished/checkpoint.h5 2>err &&
    grep -q 'paper.nml. has changed since this run was begun' err"
check "and to the same bits" same whole_paper edited
mv kept.nml paper.nml
cp -a cut_paper edited_not
check "the deck has not changed: nothing is told" sh -c "'$selas' -q restart edited_not/unfinished/checkpoint.h5 2>err; ! grep 'has changed' err"
cp -a cut_paper rounded
check "processors that round otherwise: told where this one has two kinds" sh -c "'$selas' -V >/dev/null;
    if ! grep -q ' fma ' /proc/cpuinfo || [ -n '${SELAS_PROCESSOR:-}' ]; then exit 0; fi
    SELAS_PROCESSOR=x86-64 '$selas' -q restart rounded/unfinished/checkpoint.h5 2>err && grep -q 'this run rounds otherwise' err"
check "what was refused harmed nothing" sh -c "'$selas' -q restart $good"
check "same bits" same whole_paper cut_paper

# --- A new run does not destroy an unfinished one
begun paper KILL snapshot_0002.h5
check "a new run in its folder" sh -c "'$selas' -q paper.nml output%directory=cut_paper 2>err && grep -q 'unfinished run' err"
check "the unfinished one goes on" "$selas" -q restart cut_paper/unfinished-old/checkpoint.h5
check "same bits" same whole_paper cut_paper

# --- Disks and folders
limited() { # limited BLOCKS: no file may become longer than so many blocks of 512 bytes or 1024
    (ulimit -f "$1" && "$selas" -q paper.nml output%directory=full output%checkpoint_every=5) 2>full.err
    [ $? -eq 1 ] && grep -q 'File too large' full.err && ! find full -name '*.part' | grep . && ! ls -A full | grep running
}
for blocks in 8 20 100; do
    rm -rf full
    check "files too long ($blocks blocks): a message, exit status 1, no half files" limited $blocks
done
check "files too long: says that the state is kept" grep -q 'state is kept' full.err
check "files too long: with room again it goes on" "$selas" -q restart full/unfinished/checkpoint.h5
check "same bits" same whole_paper full
if [ "$(id -u)" -eq 0 ] && mkdir small && mount -t tmpfs -o size=320k tmpfs small 2>/dev/null; then
    check "a full disk: a message, exit status 1" sh -c "'$selas' -q paper.nml output%directory=small/out 2>err; [ \$? -eq 1 ] && grep -q 'No space left on device' err"
    check "a full disk: no half files" sh -c "! find small -name '*.part' | grep ."
    mount -o remount,size=3m small
    check "a full disk: with room again it goes on" "$selas" -q restart small/out/unfinished/checkpoint.h5
    check "same bits" same whole_paper small/out
    umount small
fi
: >in_the_way
check "a file in the folder's place" sh -c "'$selas' -q paper.nml output%directory=in_the_way/out 2>err; [ \$? -eq 1 ] && grep -q 'in_the_way' err"
if [ "$(id -u)" -ne 0 ]; then
    mkdir locked && chmod 555 locked
    check "a folder that cannot be written" sh -c "'$selas' -q paper.nml output%directory=locked/out 2>err; [ \$? -eq 1 ] && grep -q 'Permission denied' err"
fi
held() { # held FILE: begins a run and stops the clock for it when FILE is there
    for try in 1 2 3 4 5 6 7 8 9 10; do
        rm -rf held
        "$selas" -q flying.nml output%directory=held output%checkpoint_every=1 2>held.err &
        process=$!
        while [ ! -e "held/unfinished/$1" ] && kill -0 $process 2>/dev/null; do sleep .01; done
        kill -STOP $process 2>/dev/null && [ -e held/.running ] && return 0
        wait $process
    done
    echo "the run was always over (try $try)"
    return 1
}
held snapshot_0001.h5
check "two runs in one folder: the second is told who is there" sh -c "
    '$selas' -q paper.nml output%directory=held 2>err; [ \$? -eq 1 ] && grep -q 'another run writes into .held.: process $process on ' err"
kill -CONT $process
wait $process
check "two runs in one folder: the first ends well" same whole_flying held
held snapshot_0001.h5
rm -rf held/unfinished
kill -CONT $process
wait $process
check "the folder vanishes on the way: exit status 1" [ $? -eq 1 ]
check "the folder vanishes on the way: a message" grep -q 'No such file' held.err

# --- The deck in run.h5
check "rerun" "$selas" -q rerun whole_bar/run.h5
check "rerun: same bits" same whole_bar output/bar-rerun
check "rerun with overrides" "$selas" -q rerun whole_bar/run.h5 output%directory=finer body%spacing=0.005
check "rerun with overrides: they count" grep -q '^points: 200' finer/report.txt
awk 'BEGIN { for (t = 0; t < 21; t++) print t * 1e-5, t % 2 }' >table.dat
"$selas" -q bar.nml output%directory=tabled load%history=table load%file=table.dat 2>/dev/null
check "rerun: nothing to tell of files that are the same" sh -c "'$selas' -q rerun tabled/run.h5 2>err && ! grep 'has changed' err"
echo "1 0" >>table.dat
check "rerun: a file that has changed is told" sh -c "'$selas' -q rerun tabled/run.h5 2>err && grep -q 'names has changed since' err"
check "rerun: told beside the override of a profile, too" sh -c "
    '$selas' -q rerun tabled/run.h5 'profile(1)%points=7' 2>err && grep -q 'names has changed since' err"
check "rerun: not where another one is asked for" sh -c "
    '$selas' -q rerun tabled/run.h5 load%file=table.dat 2>err && ! grep 'has changed' err"
printf '0 0\n1 1\n2 0\n' >early.dat
printf '3 0\n4 1\n5 0\n' >late.dat
cat >two.nml <<'END'
&scene dimension = 1, end_time = 1 /
&material name = 'rock', density = 1, young = 1, poisson = 0 /
&body material = 'rock', low = 0, high = 1, spacing = .1 /
&load face = 'x-', direction = 1, history = 'table', file = 'early.dat' /
&load face = 'x+', direction = 1, history = 'table', file = 'late.dat' /
&receiver name = 'r', position = .5 /
&output directory = 'two', plots = .false. /
END
"$selas" -q two.nml 2>/dev/null
echo '3 0' >>early.dat
sed -i 1d late.dat
check "rerun: told of two files whose border moved" sh -c "
    '$selas' -q rerun two/run.h5 2>err && grep -q 'names has changed since' err"
check "rerun: told beside the override of another one" sh -c "
    '$selas' -q rerun two/run.h5 'load(1)%file=early.dat' 2>err && grep -q 'names has changed since' err"
check "rerun: not where both are asked for" sh -c "'$selas' -q rerun two/run.h5 'load(1)%file=early.dat' \\
    'load(2)%file=late.dat' 2>err && ! grep 'has changed' err"
check "rerun: no run.h5" sh -c "! '$selas' rerun cut_paper/p.dat 2>err && grep -q 'p.dat' err"
exit $failures
