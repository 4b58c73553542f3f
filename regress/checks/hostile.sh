#!/bin/sh
# Sizes that no machine has, in decks and in files that a deck names: each ends in a message and exit status 2 or 1
# within seconds, and before memory is taken (the program has 700 MB of addresses and no more).
build=$(realpath "${1:-build}")
selas=$build/selas
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export OMP_NUM_THREADS=1
room=700000
[ -n "${SELAS_SANITIZED:-}" ] && room=unlimited # a sanitizer's shadow is larger than any limit

cat >right.nml <<'DECK'
&scene end_time = 1.0 /
&material name = 'rock', density = 1.0, young = 2.5, poisson = 0.25 /
&body material = 'rock', shape = 'box', spacing = 0.5, low = 0.0, 0.0, 0.0, high = 4.0, 4.0, 4.0 /
&load face = 'z-', shape = 'square', centre = 2.0, 2.0, 0.0, size = 1.0, 1.0, direction = 0.0, 0.0, 1.0,
  history = 'triangle', duration = 2.0 /
&receiver name = 'centre', position = 2.0, 2.0, 0.0 /
DECK

sed 's/triangle/table/; s/, duration = 2.0//' right.nml >table.nml

# refused STATUS TITLE MESSAGE WORDS...: `selas WORDS` ends with the status and a line that matches MESSAGE.
refused() {
    wanted=$1 title=$2 message=$3
    shift 3
    (
        ulimit -v $room
        timeout 60 "$selas" "$@" >text 2>&1
    )
    status=$?
    if [ $status -ne "$wanted" ]; then
        echo "not ok - $title: exit status $status in place of $wanted: $(head -2 text | cut -c1-200)"
    elif ! grep -q -e "$message" text; then
        echo "not ok - $title: no line '$message': $(head -2 text | cut -c1-200)"
    else
        echo "ok - $title"
    fi
}
# deck TITLE MESSAGE OVERRIDE...: the right deck with overrides.
deck() {
    title=$1 message=$2
    shift 2
    refused 2 "$title" "$message" -q right.nml "$@"
}
# table TITLE MESSAGE FILE: a load's history from this file.
table() {
    refused 2 "$1" "$2" -q table.nml "load%file=$3"
}

deck "10^12 points" "error: .* points need at least" body%spacing=0.0004
deck "spacing 1e-300" "error: .* points need at least" body%spacing=1e-300
deck "spacing 1e-300, SPH" "error: .* points need at least" body%spacing=1e-300 method%name=sph
deck "a body as wide as numbers go" "error: " body%high=3*1e308 body%low=3*-1e308
deck "a body 1e300 wide" "error: .* points need at least" body%high=3*1e300
deck "time step 1e-300" "steps of 1e-300 .* are too many" stepping%time_step=1e-300
deck "end_time 1e300" "are too many\|error: " scene%end_time=1e300
deck "history rows 1e-300 apart" "history_step = 1e-300 asks for" output%history_step=1e-300

# What receivers cost grows as their number: 50,000 in a plan take 2 s of a processor.
{
    sed /receiver/d right.nml
    awk 'BEGIN { for (i = 0; i < 50000; i++) printf "&receiver name = \"r%d\", position = %.4f, %.4f, 0 /\n", i, i % 200 / 50, i / 12500 }' | tr '"' "'"
} >many.nml
[ -n "${SELAS_SANITIZED:-}" ] && seconds=unlimited || seconds=6
if (ulimit -t $seconds && "$selas" check many.nml body%spacing=.25 >text 2>&1); then
    echo "ok - 50,000 receivers"
else
    echo "not ok - 50,000 receivers: $(tail -1 text)"
fi
rm many.nml
deck "a nested repeat" "error: " 'receiver%position=1000000000*1000000000*1.0'
deck "10^9 values" "error: " 'body%low=1000000000*1.0'
deck "more values than integers go" "error: " 'body%low=99999999999999999999999*1.0'
deck "more seeds than integers go" "error: " 'body%seed=99999999999999999999999'

[ "$room" = unlimited ] || refused 1 "10^8 rows of histories" "no memory for 1000000.. rows" -q right.nml output%history_step=1e-8
for method in "method%variant=paper" "method%variant=cloud" "method%name=sph" "method%name=sph method%variant=updated-lagrangian" \
    "method%name=sph body%jitter=0.1"; do
    # shellcheck disable=SC2086
    deck "6e10 points, $method" "error: .* points need at least" body%spacing=0.001 $method
done
deck "more stages than there are" "expected a number in" stepping%max_stages=1000000000000
deck "a degree of 10^9" "expected a number in" method%degree=1000000000
refused 1 "a checkpoint without end" "no checkpoint of selas" -q restart /dev/zero
refused 1 "a run.h5 without end" "cannot read" -q rerun /dev/zero
refused 1 "a history without end" "a byte 0" diff /dev/zero right.nml
refused 2 "a deck without end" "too long for a deck" -q /dev/urandom
refused 2 "a folder for a deck" "is a directory" -q .

# a deck and a table of one line that has no end
head -c 1000000000 /dev/zero | tr '\000' '1' >long.txt
refused 2 "a deck that is one line of 1 GB" "1000000000 bytes: a deck has at most" long.txt
table "a table that is one line of 1 GB" "line is too long" long.txt
sed 's/young/\n! /' right.nml | tr '\n' ' ' >one.nml
refused 2 "a deck in one line" "error: " one.nml
rm -f long.txt
table "a table of zeros without end" "a byte 0" /dev/zero
table "random bytes without end as a table" "error: " /dev/urandom

# points files
points="method%name=sph body%shape=points body%file=points"
head -c 300000000 /dev/zero | tr '\000' '1' >points
# shellcheck disable=SC2086
refused 1 "a points file that is one line of 300 MB" "line is too long" -q right.nml $points
echo '0.25 0.25 0.25 inf' >points
# shellcheck disable=SC2086
refused 2 "a point of infinite volume" "finite volume above 0" -q right.nml $points
echo '0.25 0.25 0.25 0.125 0 0 1 nan' >points
# shellcheck disable=SC2086
refused 2 "a surface of no area" "finite area" -q right.nml $points

# huge extents, links to elsewhere, virtual sets and raw files in HDF5, in as little room
stored=$build/test/test_stored
if [ -x "$stored" ]; then
    if (ulimit -v $room && "$stored") >text 2>&1; then
        echo "ok - files in HDF5 whose extents and links are hostile, in 700 MB"
    else
        echo "not ok - files in HDF5 whose extents and links are hostile: $(grep -i error text | head -3)"
    fi
fi
