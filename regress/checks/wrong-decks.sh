#!/bin/sh
# Wrong decks end in their message and exit status 2 at once, and nothing is written.
selas=$(realpath "${1:-build}")/selas
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
mkdir "$work/decks" && cd "$work/decks" || exit 1

# A deck that is right, from which the wrong ones are made by one change each.
cat >right.nml <<'DECK'
&scene end_time = 1.0 /
&material name = 'rock', density = 1.0, young = 2.5, poisson = 0.25 /
&body
  material = 'rock', shape = 'box', spacing = 0.5
  low = 0.0, 0.0, 0.0, high = 7.0, 7.0, 7.0
/
&load
  face = 'z-', shape = 'square', centre = 3.5, 3.5, 0.0, size = 1.0, 1.0
  direction = 0.0, 0.0, 1.0, history = 'triangle', duration = 2.0
/
&receiver name = 'centre', position = 3.5, 3.5, 0.0 /
DECK

# refused TITLE DECK MESSAGE [OVERRIDE ...]: MESSAGE is a regular expression for a whole line.
refused() {
    title=$1 deck=$2 message=$3
    shift 3
    before=$(ls -R)
    timeout 20 "$selas" "$deck" "$@" >../text 2>&1
    status=$?
    lines=$(cat ../text)
    if [ $status -ne 2 ]; then
        echo "not ok - $title: exit status $status in place of 2"
    elif ! printf '%s\n' "$lines" | grep -qx -e "$message"; then
        echo "not ok - $title: no line '$message'"
    elif [ "$before" != "$(ls -R)" ]; then
        echo "not ok - $title: something was written"
    else
        echo "ok - $title"
        return
    fi
    printf '%s\n' "$lines" | head -5 | cut -c1-300
}

# changed TITLE SED MESSAGE: the right deck changed by a sed expression.
changed() {
    sed -e "$2" right.nml >wrong.nml
    refused "$1" wrong.nml "wrong.nml:$3"
    rm -f wrong.nml
}

if timeout 20 "$selas" check right.nml >../text 2>&1; then
    echo "ok - the right deck passes"
else
    echo "not ok - the right deck is refused: $(head -3 ../text)"
fi
rm -rf output

changed "missing /" '6d' "3:1: error: &body is not closed: expected '/' before line 6"
changed "missing / at the end" '$s,/,,' "11:1: error: &receiver is not closed: .*"
changed "unknown key" 's/spacing/spcaing/' "4:37: error: unknown name 'spcaing' in &body; did you mean 'spacing'?"
changed "a word like no other" 's/centre = 3.5/whereabouts = 3.5/' "8:[0-9]*: error: unknown name 'whereabouts' in &load"
changed "a word of another group" 's/centre = 3.5/position = 3.5/' \
    "8:[0-9]*: error: unknown name 'position' in &load; it is a word of &receiver"
changed "a fraction" 's/spacing = 0.5/spacing = 1\/2/' "4:48: error: this '/' ends &body, and '2' behind it is not read; .*"
changed "a group that ends too early" 's/1.0, 1.0$/1.0, 1.0 \//' "9:3: error: this stands outside of a group .*"
changed "no equals sign" 's/spacing = 0.5/spacing 0.5/' "4:37: error: no '=' behind 'spacing' of &body"
changed "a receiver above a hill" "s/^&receiver.*/\\&topography shape = 'gaussian', height = 1, centre = 3.5, 3.5, width = 1 \\/\n\\&receiver name = 'top', position = 3.5, 3.5, -1.1 \\//" \
    "12:[0-9]*: error: .* lies above the surface, which is at z = -1 there; position = 3.5, 3.5, depth = 0 is on it"
changed "unknown group" 's/&load/\&laod/' "7:1: error: unknown group '&laod'; did you mean '&load'?"
changed "wrong type" "s/spacing = 0.5/spacing = 'fine'/" "4:47: error: expected a real number, found ''fine''"
changed "wrong choice" "s/'square'/'sqare'/" ".*error: 'sqare' for 'shape'.*did you mean 'square'?"
changed "negative density" 's/density = 1.0/density = -1.0/' "2:36: error: -1 for 'density'.*"
changed "Poisson's ratio .5" 's/poisson = 0.25/poisson = 0.5/' "2:[0-9]*: error: .*oisson.*"
changed "missing density" 's/density = 1.0,//' "2:1: error: 'density' is missing in &material.*"
changed "name twice" 's/low = 0.0/spacing = 0.25, low = 0.0/' "5:3: error: 'spacing' is given twice.*first on line 4.*"
changed "too many values" 's/0.0, high/0.0, 0.0, high/' "5:[0-9]*: error: too many values for 'low'.*"
changed "receiver outside" '$s/3.5, 3.5, 0.0/3.5, 3.5, 9.0/' "11:[0-9]*: error: .*"
changed "undefined material" "3,6s/'rock'/'rokc'/" "4:3: error: .*rokc.*"
changed "two materials of one name" '2{p;}' "3:[0-9]*: error: .*rock.*"
changed "two bodies" '3,6{H;};7{x;s/^\n//;G;}' "7:1: error: &body is given twice.*"
refused "negative spacing by an override" right.nml "override: error: -1 for 'spacing'.*" body%spacing=-1
refused "unknown name in an override" right.nml "override: error: unknown name 'spcing'.*" body%spcing=1
refused "a filter with a Runge-Kutta scheme" right.nml \
    "error: a filter (method%filter > 0) needs scheme 'leapfrog' or 'modified-equation', not 'rk4'" \
    method%variant=paper stepping%scheme=rk4
sed '1i &boundary face = "x-", kind = "displacement", direction = 0, 0, 1, slip = T, amplitude = 0, history = "step" /' right.nml >slip.nml
refused "a support along one of a face's two axes" slip.nml \
    "error: face x- prescribes motion along z and leaves it free along y, .*; method%mass = 'exact' would be right" method%mass=vc3
rm slip.nml
refused "single precision of another method" right.nml "override: error: method '.*', variant '.*', has no state in single precision; expected 'double'" \
    method%precision=single method%variant=paper
refused "single precision without the fused operator" right.nml "error: method%precision = 'single' needs the fused operator.*" \
    method%precision=single
refused "single precision with another scheme" right.nml "error: method%precision = 'single' needs scheme 'leapfrog'.*" \
    method%precision=single method%variant=consistent body%spacing=0.2 stepping%scheme=rk4
refused "no file" none.nml "none.nml:1:1: error: cannot be opened: .*"
refused "directory" . ".:1:1: error: is a directory, not a deck"

: >empty.nml
refused "empty file" empty.nml "empty.nml:1:1: error: no group of a deck is in this file.*"
head -c 100000 "$selas" >binary.nml
refused "binary file" binary.nml "binary.nml:1:[0-9]*: error: a byte 0: this is not a text file"
head -c 10000000 /dev/urandom | tr '\000' '&' >junk.nml
refused "10 MB of junk" junk.nml "junk.nml:.* error: .*"
head -c 20000000 /dev/zero | tr '\000' 'x' >large.nml
refused "20 MB" large.nml "large.nml:1:1: error: 20000000 bytes: a deck has at most 16777216"
