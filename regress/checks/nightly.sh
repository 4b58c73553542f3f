#!/bin/sh
# The nightly regression itself, on a copy with a handful of cases: a good night, a changed history, a broken case, a
# night that is killed, two at once, accepting. Argument: the build folder. Prints TAP.
build=$(cd "${1:-build}" && pwd)
export build
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-nightly-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
check() { # check WHAT COMMAND...
    what=$1
    shift
    if "$@" >"$work/said" 2>&1; then echo "ok - $what"; else echo "not ok - $what"; sed 's/^/# /' "$work/said" | head -20; fi
}
check 'make regress OUT=' sh -c "make -n regress OUT='some where' | grep -q \"run -q -o 'some where'\""
mkdir -p "$work/regress/cases" "$work/regress/studies" "$work/output"
cp -r regress/nightly "$work/regress/"
cp -r input "$work/"
for name in pulse-fixed pulse-transmitting bar-rk4; do cp -r "regress/cases/$name" "$work/regress/cases/"; done
cd "$work" || exit 1
page=output/regress/index.html
summary=output/regress/summary.txt
night() { regress/nightly/run -q -b "$build" "$@" >night.log 2>&1; }
last() { tail -n 1 "$summary"; }

check 'a good night ends with status 0' night
check 'its page is green' grep -q '<header class="green">' $page
check 'its summary ends N passed, 0 failed' sh -c "tail -n 1 $summary | grep -qxE '[1-9][0-9]* passed, 0 failed'"
check 'every receiver is drawn' test "$(grep -o 'data:image/png;base64,iVBOR' $page | wc -l)" -ge 5
check 'the page needs nothing from outside' sh -c "! grep -oE '(src|href)=\"[^\"]{0,12}' $page | grep -vE 'src=\"data:image/p'"
check 'the page suits a phone' grep -q 'name="viewport" content="width=device-width' $page
check 'every element that is opened is closed' sh -c "
    for tag in details summary figure ul pre svg header body html; do
        [ \$(grep -oE \"<\$tag[ >]\" $page | wc -l) -eq \$(grep -o \"</\$tag>\" $page | wc -l) ] || { echo \$tag; exit 1; }
    done"
check 'every case shows a small plot without a click' test "$(grep -c 'aria-label="[^"]*"><polyline' $page)" -eq 3
check 'the first line is fit for the subject of a mail' sh -c "head -n 1 $summary | grep -qxE 'selas GREEN, [0-9]+ passed; commit [^ ;]+; [0-9]+ minutes; since last night: the first night'"
check 'errors and CPU time are in the log' sh -c "[ \$(wc -l <output/regress/log.txt) -eq 4 ]"

# one number of one history, by 1e-5 of it; a case that is refused
awk '!/^#/ && $5 > 1 && !done { $5 *= 1.00001; done = 1 } { print }' regress/cases/pulse-fixed/accepted/far.dat >changed
cp changed regress/cases/pulse-fixed/accepted/far.dat
mkdir regress/cases/aa-broken
printf 'what: refused\ndeck: input/plane-wave.nml\noverride: body%%spacing=-1\natol: 1e-7\nrtol: 1e-7\nhalf: quick\n' >regress/cases/aa-broken/case
check 'a changed number and a refused deck: status 1' sh -c "! regress/nightly/run -q -b \"\$build\" >night.log 2>&1"
check 'the heads of cases end as they should' sh -c "! grep -qE '[;,] *</small>' $page"
check 'the page is red' grep -q '<header class="red">' $page
check 'all other cases were run' sh -c "grep -q '^passed bar-rk4' $summary && grep -q '^passed pulse-transmitting' $summary"
check 'both failures are told' sh -c "grep -q '^FAILED aa-broken' $summary && grep -q 'not ok - pulse-fixed: histories as accepted' $summary"
check 'what is new stands in the first line' sh -c "head -n 1 $summary | grep -qE '^selas RED, 2 of 5 failed; .*: aa-broken: new, fails, pulse-fixed: fails$'"
check 'what is new stands on the page' grep -q '<li>pulse-fixed: fails</li>' $page
check 'failures stand first' sh -c "[ \$(grep -n 'id=\"pulse-fixed\"' $page | cut -d: -f1) -lt \$(grep -n 'id=\"bar-rk4\"' $page | cut -d: -f1) ]"
check 'the difference is drawn' grep -q 'differs from what was accepted: far_vx' $page

check 'accepting asks, takes no for an answer and exits with 1' sh -c "
    echo n | regress/nightly/accept -b \"\$build\" pulse-fixed >left && exit 1
    grep -q 'left as it was' left && cmp changed regress/cases/pulse-fixed/accepted/far.dat"
check 'accepting shows the difference' sh -c "echo n | regress/nightly/accept -b \"\$build\" pulse-fixed | grep -qE '^far +vx .* differs'"
check 'accepting with --yes' sh -c "regress/nightly/accept --yes -b \"\$build\" pulse-fixed | grep -q 'pulse-fixed: accepted'"
rm -rf regress/cases/aa-broken
check 'green again' night
check 'what passes again and what is gone are told' sh -c "head -n 1 $summary | grep -q 'pulse-fixed: passes again, aa-broken: gone$'"
night
check 'what is gone is told once' sh -c "head -n 1 $summary | grep -q 'since last night: nothing new$'"
check 'a changed figure of a record is red' sh -c "
    cp regress/cases/pulse-fixed/record kept
    awk '/^far.exact.dat: v/ { \$5 *= 1.0001 } { print }' kept >regress/cases/pulse-fixed/record
    ! regress/nightly/run -q -b \"\$build\" pulse-fixed >night.log 2>&1 && grep -q 'not ok - pulse-fixed: record as accepted: far.exact.dat: v' $summary
    status=\$?
    cp kept regress/cases/pulse-fixed/record
    exit \$status"
printf '#!/bin/sh\necho "ok - one"\necho "not ok - two <b>"\n' >regress/studies/absorption
check 'further checks count line by line, and a full night runs them' sh -c "
    ! regress/nightly/run -b \"\$build\" >night.log 2>&1 && grep -q '^    not ok - two <b>' $summary && grep -q 'two &lt;b&gt;' $page &&
    tail -n 1 $summary | grep -q ', 1 failed$'"
rm regress/studies/absorption
check 'from cron, with next to no environment' env -i PATH=/usr/bin:/bin sh -c "cd / && '$work/regress/nightly/run' -q -b '$build' pulse-fixed"
check 'an error 6 % above the recorded one is red' sh -c "
    cp regress/cases/pulse-fixed/errors kept
    awk -F': ' '{ printf \"%s: %.4e\\n\", \$1, \$2 / 1.06 }' kept >regress/cases/pulse-fixed/errors
    ! regress/nightly/run -q -b \"\$build\" pulse-fixed >night.log 2>&1 && grep -q 'not ok - pulse-fixed: error far velocity' $summary
    status=\$?
    cp kept regress/cases/pulse-fixed/errors
    exit \$status"

# a case of one's own: without receivers; one that lacks a line
mkdir regress/cases/own
cat >regress/cases/own/deck.nml <<'END'
&scene dimension = 2, end_time = 1.0 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body material = 'rock', shape = 'box', low = 0, 0, high = 2, 2, spacing = 0.25 /
&load face = 'y-', shape = 'face', direction = 0, 1, history = 'gaussian', width = 0.3, delay = 1.2 /
&snapshot every = 0.5, fields = 'velocity' /
END
printf 'what: own\ndeck: regress/cases/own/deck.nml\natol: 1e-7\nhalf: quick\n' >regress/cases/own/case
check 'accepting a case without rtol is refused' sh -c "
    ! regress/nightly/accept --yes -b \"\$build\" own 2>left && grep -q \"own/case needs one line 'rtol: ...'\" left && [ ! -d regress/cases/own/accepted ]"
echo 'rtol: 1e-7' >>regress/cases/own/case
check 'accepting a case of neither half, which no quick run would take, is refused' sh -c "
    cp regress/cases/own/case kept && sed 's/quick/quik/' kept >regress/cases/own/case &&
    ! regress/nightly/accept --yes -b \"\$build\" own 2>left && grep -q 'half is quick or night' left && cp kept regress/cases/own/case"
own() { regress/nightly/accept --yes -b "$build" own && regress/nightly/run -q -b "$build" own; }
check 'a case of snapshots alone is accepted and passes' own
echo "&profile name = 'line', from = 0, 1, to = 2, 1, points = 5, times = 0.6, fields = 'velocity' /" >>regress/cases/own/deck.nml
check 'and is no more what was accepted with a profile' sh -c "! regress/nightly/run -q -b \"\$build\" own >night.log 2>&1"
check 'with a profile it passes too' own
rm -rf regress/cases/own

# a program that hangs and hears no signal; a disk so full that no verdict is left
hangs() {
    mkdir -p hangs && printf '#!/bin/sh\n[ "$1" = --version ] && exit\ntrap "" TERM\nwhile :; do sleep 1; done\n' >hangs/selas && chmod +x hangs/selas &&
        ! REGRESS_TIMEOUT=1 timeout -s KILL 60 regress/nightly/run -q -b "$PWD/hangs" bar-rk4 >night.log 2>&1 &&
        grep -q 'not ok - bar-rk4: runs to the end (exit status 137): not done in 1 s' $summary
}
check 'a case that hangs is ended and fails' hangs
check 'a case of which nothing is judged has not passed' sh -c ". regress/nightly/common.sh && mkdir -p o/cases/x/run && tell_figures x 0 0 '- - -' o &&
    grep -q '^0 1 ' o/cases/x/figures && grep -q ' x FAIL ' o/log.txt"

# a night that takes long is killed: one that hears the signal, one that does not
mkdir regress/cases/slow
printf 'what: slow\ndeck: input/plane-wave.nml\noverride: body%%spacing=0.0005\noverride: scene%%end_time=60\natol: 1\nrtol: 1\nhalf: quick\n' >regress/cases/slow/case
begin() { # begin: starts a night in the background, waits until it is at the slow case alone
    rm -f $page
    regress/nightly/run -q -b "$build" >night.log 2>&1 &
    night=$!
    tries=0
    while [ $tries -lt 1200 ] && ! { [ -d output/regress/cases/slow ] && grep -q ' 4 of 5 ' $page 2>/dev/null; }; do
        sleep .1
        tries=$((tries + 1))
    done
}
begin
check 'a second night does not start beside it' sh -c "regress/nightly/run -q -b \"\$build\" 2>&1 | grep -q 'another one is at work'"
kill -TERM $night
wait $night 2>/dev/null
check 'killed: the page says so' grep -q 'NOT FINISHED: . of 5 done; killed by signal TERM at' $page
check 'killed: the page is red, with what was done' sh -c "grep -q '<header class=\"red\">' $page && grep -q 'id=\"bar-rk4\"' $page && tail -1 $page | grep -q '</html>'"
check 'killed: the summary counts it as failed' sh -c "tail -n 1 $summary | grep -qE ' passed, [1-9][0-9]* failed'"
tries=0
while [ $tries -lt 600 ] && ! flock -n output/regress/lock true; do sleep .1; tries=$((tries + 1)); done
check 'killed: the next night can begin' flock -n output/regress/lock true
begin
kill -KILL $night
wait $night 2>/dev/null
check 'killed without a word: the page says so' grep -q 'NOT FINISHED: . of 5 done; running, or killed without a word' $page
check 'killed without a word: the summary says so' sh -c "grep -q 'NOT FINISHED' $summary && tail -n 1 $summary | grep -qE ' passed, [1-9][0-9]* failed'"
check 'killed without a word: what it had started ends with it, the next night can begin' flock -w 60 output/regress/lock true
exit 0
