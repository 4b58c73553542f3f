#!/bin/sh
# Kernels for each kind of processor that this machine has (src/base/processor.h) on small scenes of every method: kinds with
# fused multiplication give the same bits, the plain one differs by rounding. A kind that is not there is refused.
# Argument: the build folder. Prints TAP.
build=${1:-build}
selas=$PWD/$build/selas
input=$PWD/input
. "$PWD/regress/checks/parts/scenes.sh"
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-processors-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export OMP_NUM_THREADS=1
failures=0
told() { # told STATUS WHAT
    [ "$1" -eq 0 ] && echo "ok - $2" && return
    echo "not ok - $2"
    failures=$((failures + 1))
}

cat >cloud.nml <<END
&scene dimension = 3, end_time = 1.0 /
$rock
&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 3.5, 3.5, 3.5, spacing = 0.5, jitter = 0.2 /
&load face = 'z-', shape = 'square', centre = 1.5, 1.5, 0, size = 1, 1, direction = 0, 0.3, 1, history = 'gaussian', width = 0.3, delay = 1.2 /
&receiver name = 'r1', position = 2, 1.5, 0.5 /
&output plots = .false. /
END
sed -e "s/'total-lagrangian'.*/'updated-lagrangian'/" -e '/^  gradient/d' -e '/^  hourglass/d' "$input/beam-3d.nml" >particles.nml
cp "$input/beam-3d.nml" solid.nml
cp "$input/../regress/cases/hill/deck.nml" hill.nml
for name in layers damped relaxing relaxing-single pass sweep sweep-layers sweep-damped single modified plate flying moving; do
    scene $name
    sed -i '/^&profile/d' $name.nml # their times are later than the short runs here
done

# each NAME OVERRIDE...: the scene with every kind, into NAME_KIND
scenes=
each() {
    deck=$1 name=$2
    shift 2
    scenes="$scenes $name"
    for kind in $kinds; do
        SELAS_PROCESSOR=$kind "$selas" -q "$deck.nml" output%directory="${name}_$kind" "$@" >log 2>&1 && continue
        sed 's/^/# /' log
        told 1 "$name runs with $kind"
    done
}
same() { # same A B: histories and profiles of both runs bit for bit
    for file in "$1"/*.dat; do
        [ -e "$file" ] && cmp -s "$file" "$2/${file##*/}" || return 1
    done
}

kinds=
for kind in x86-64 x86-64-v3 x86-64-v4 plain; do
    said=$(SELAS_PROCESSOR=$kind "$selas" check pass.nml 2>&1)
    case $said in
    *"processor: $kind "*) kinds="$kinds $kind" ;;
    *"SELAS_PROCESSOR = '$kind'"*) echo "# $kind: $(echo "$said" | head -1)" ;;
    *) told 1 "$kind is taken or refused" ;;
    esac
done
SELAS_PROCESSOR=z80 "$selas" check pass.nml >log 2>&1
[ $? -ne 0 ] && grep -q "SELAS_PROCESSOR = 'z80' is no kind of processor here; expected" log
told $? "a kind that does not exist is refused"

each layers layers scene%end_time=3.0
each hill hill scene%end_time=2.0
each damped damped
each relaxing relaxing
each relaxing-single relaxing-single
each pass pass scene%end_time=2.0
each sweep sweep scene%end_time=2.0
each sweep sweep-single scene%end_time=2.0 method%precision=single
each sweep-layers sweep-layers scene%end_time=3.0
each sweep-layers sweep-layers-single scene%end_time=3.0 method%precision=single
each sweep-damped sweep-damped scene%end_time=3.0
each sweep-damped sweep-damped-single scene%end_time=3.0 method%precision=single
each single single scene%end_time=2.5
each modified modified
each modified ground method%degree=4 method%mass=exact stepping%scheme=leapfrog scene%end_time=2.0
each plate plate scene%end_time=1.5
each flying flying scene%end_time=0.3
each flying disorder scene%end_time=0.2 body%jitter=0.2
each moving moving
each cloud cloud
each solid solid body%spacing=.02 scene%end_time=.0003
each solid scattered body%spacing=.02 scene%end_time=.0003 body%jitter=.2
each particles particles body%spacing=.02 scene%end_time=.0003
each particles mixed body%spacing=.02 scene%end_time=.0002 body%jitter=.2
first= fused=
for kind in $kinds; do
    case $kind in *-v*) ;; *) first=$kind && continue ;; esac
    [ -n "$fused" ] || { fused=$kind && continue; }
    bad=
    for name in $scenes; do same "${name}_$fused" "${name}_$kind" || bad="$bad $name"; done
    [ -z "$bad" ]
    told $? "$fused and $kind give the same bits${bad:+ but in$bad}"
done
if [ -n "$first" ] && [ -n "$fused" ]; then
    for name in $scenes; do
        "$selas" diff --no-plots "${name}_$first" "${name}_$fused" | awk -v name="$name" '
            $2 ~ /^[uva][xyz]$/ && $3 + 0 > worst { worst = $3 + 0; seen = 1 }
            $2 ~ /^[uva][xyz]$/ { seen = 1 }
            END {
                good = seen && worst < (name ~ /single$/ ? 1e-5 : 1e-9)
                printf "%s - %s: the plain kind differs by %.1e\n", good ? "ok" : "not ok", name, worst
                exit !good
            }' || failures=$((failures + 1))
    done
fi
exit $failures
