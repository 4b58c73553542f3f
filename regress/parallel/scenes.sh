# shellcheck shell=sh
# What the parts of regress/parallel/check share: each compares scenes alone and on ranks and prints TAP. To be read in the
# repository's root with $build, the folder of the programs.
. regress/parallel/mpirun.sh
work=$(mktemp -d) || exit 2
trap 'rm -rf "$work"' EXIT
passed=0 failed=0
verdict() { # verdict STATUS WHAT
    if [ "$1" = 0 ]; then
        passed=$((passed + 1))
        echo "ok - $2"
    else
        failed=$((failed + 1))
        echo "not ok - $2"
    fi
    [ "$1" = 0 ]
}
on_grid() { # on_grid RANKS: sets $ranks; 2x3: blocks, two over y and three over depth
    ranks=$1
    unset SELAS_RANK_GRID
    case $1 in *x*) export SELAS_RANK_GRID="$1" && ranks=$((${1%x*} * ${1#*x})) ;; esac
}
quiet() { # quiet RANKS WORDS...: the program on ranks; its words in $work/log
    on_grid "$1"
    shift
    timeout "${REGRESS_TIMEOUT:-120}" $mpirun -n "$ranks" "$build/selas-mpi" -q "$@" >"$work/log" 2>&1
}
numbers() { grep -v '^# deck ' "$1"; }
same_fields() { # same_fields FOLDER: what run.h5 and the XDMF files show, alone and there
    for file in "$work"/alone/*.xdmf; do
        cmp -s "$file" "$work/$1/$(basename "$file")" || return 1
    done
    h5ls -r "$work/alone/run.h5" | grep '^/[ps][on]' >"$work/one"
    h5ls -r "$work/$1/run.h5" | grep '^/[ps][on]' | cmp -s - "$work/one" && [ -s "$work/one" ] &&
        h5diff -q "$work/alone/run.h5" "$work/$1/run.h5" /snapshots && h5diff -q "$work/alone/run.h5" "$work/$1/run.h5" /points
}
figures() { # figures REPORT: what is the same for any number of ranks; where `cloud` would be right, ranks are told what they have
    grep -vE '^(date|ranks|halo bytes|planned|estimated|exact CPU|energy|work|threads|set-up|stepping|load balance|waiting|peak memory|bytes per point|model memory|point-steps|memory variables|passes of layers|layers skipped|operator skipped|ground values|efficiency expected|warning: of )' "$1" | sed "s/variant = 'c[a-z]*' would be right/another &/; s/'c[a-z]*' would/would/"
}
planned_halo() { # planned_halo REPORT: its bytes sent in the last step are those planned, for each operator call
    awk -F ': ' '/^halo bytes a step/ { planned = $2 + 0 } /^halo bytes sent/ { sent = $2 + 0 } /^scheme/ { one = $2 == "leapfrog" || $2 == "euler" }
        END { exit !(sent == planned || (!one && planned > 0 && 2 * sent % planned == 0)) }' "$1"
}
same_energies() { # same_energies FOLDER: those that its report tells, to the rounding of sums over ranks
    sed -n 's/^\(energy [^:]*\): \([^ ]*\).*/\1:\2/p; s/^\(work [^:]*\): \([^ ]*\).*/\1:\2/p' "$work/$1/report.txt" | grep -v '^energy balance' >"$work/one"
    sed -n 's/^\(energy [^:]*\): \([^ ]*\).*/\1:\2/p; s/^\(work [^:]*\): \([^ ]*\).*/\1:\2/p' "$work/alone/report.txt" |
        awk -F : 'NR == FNR { alone[$1] = $2; if ($2 > most) most = $2; next }
            { d = $2 - alone[$1]; if (d * d > 1e-10 * most * most) exit 1; found++ } END { if (found < 3) exit 1 }' - "$work/one"
}
same() { # same "RANKS..." WHAT WORDS...: histories and energies alone and on ranks, all of which have work unless FEW is set; MEET: they send more in some steps
    counts=$1 what=$2
    shift 2
    rm -rf "$work/alone"
    "$build/selas" -q "$@" output%plots=F output%directory="$work/alone" >"$work/log" 2>&1 || { verdict 1 "$what, alone"; sed 's/^/#   /' "$work/log"; return; }
    for n in $counts; do
        rm -rf "$work/ranks"
        quiet "$n" "$@" output%plots=F output%directory="$work/ranks"
        bad=$?
        [ -n "${FEW:-}" ] || ! grep -q 'ranks [0-9]* can work' "$work/log" || bad=few
        for file in "$work"/alone/*.dat; do
            numbers "$file" >"$work/one"
            numbers "$work/ranks/$(basename "$file")" 2>/dev/null | cmp -s - "$work/one" || bad="$bad $(basename "$file")"
        done
        [ ! -e "$work/alone/run.xdmf" ] || same_fields ranks || bad="$bad run.h5"
        same_energies ranks || bad="$bad energies"
        figures "$work/alone/report.txt" >"$work/one"
        figures "$work/ranks/report.txt" | cmp -s - "$work/one" || bad="$bad figures"
        [ -n "${MEET:-}" ] || planned_halo "$work/ranks/report.txt" || bad="$bad halo"
        case $n in 1x*) ;; *x*) grep -q "^ranks: ${n%x*} x ${n#*x} blocks" "$work/ranks/report.txt" || bad="$bad grid" ;; esac
        [ "$bad" = 0 ]
        verdict $? "$what on $n ranks: same histories and energies"
        [ "$bad" = 0 ] || { echo "#   $bad"; sed 's/^/#   /' "$work/log" | head -5; }
    done
}
as_planned() { # as_planned WHAT FOLDER: halo bytes counted against the plan's
    predicted=$(sed -n 's/^halo bytes a step: \([0-9]*\) .*/\1/p' "$work/$2/report.txt")
    sent=$(sed -n 's/^halo bytes sent in the last step: //p' "$work/$2/report.txt")
    [ -n "$sent" ] && [ "$sent" = "$predicted" ]
    verdict $? "$1: $predicted"
}
one_line() { # one_line WHAT PATTERN RANKS WORDS...: exit status 2 and one line of error
    what=$1 pattern=$2
    shift 2
    quiet "$@"
    [ $? = 2 ] && [ "$(grep -c 'error: ' "$work/log")" = 1 ] && grep -q "error: .*$pattern" "$work/log"
    verdict $? "$what: one line on $ranks ranks"
}
ranks_of() { # processes of the program under the launcher, in their order
    ps -eo pid=,ppid=,comm= | awk -v top="$launcher" '
        { parent[$1] = $2; if ($3 == "selas-mpi") rank[++count] = $1 }
        END { for (i = 1; i <= count; i++) { for (at = rank[i]; at in parent && at != top; at = parent[at]) { } if (at == top) print rank[i] } }'
}
last_rank() { ranks_of | tail -1; }
leg() { # leg SIGNAL RANKS WORDS...: a run in the folder `chain` whose last rank gets the signal behind a new checkpoint
    signal=$1
    on_grid "$2"
    shift 2
    rm -rf "$work/before"
    [ ! -e "$work/chain" ] || cp -r "$work/chain" "$work/before"
    for _ in 1 2 3 4 5 6 7 8 9 10; do
        rm -rf "$work/chain"
        [ ! -e "$work/before" ] || cp -r "$work/before" "$work/chain"
        touch "$work/mark"
        timeout 60 $mpirun -n "$ranks" "$build/selas-mpi" -q "$@" >"$work/log" 2>&1 &
        launcher=$! there=
        while kill -0 $launcher 2>/dev/null && ! [ "$work/chain/unfinished/checkpoint.h5" -nt "$work/mark" ]; do
            if [ "$(echo "$there" | wc -w)" -lt "$ranks" ]; then there=$(ranks_of); else sleep .02; fi
        done
        kill "-$signal" "${there##*[!0-9]}" 2>/dev/null
        wait $launcher && continue # over before the signal,
        [ "$work/chain/unfinished/checkpoint.h5" -nt "$work/mark" ] || continue # or as good as over
        [ "$signal" = KILL ] || grep -q '^stopped by .* the state is kept' "$work/log" || continue # or writing its results
        return
    done
    echo "the run was always over before the signal" >>"$work/log"
    return 1
}
chain() { # chain WHAT WORDS...: one process to $one ranks, to $two, killed, to one process
    what=$1
    shift
    rm -rf "$work/alone" "$work/chain"
    "$build/selas" -q "$@" output%checkpoint_every=10 output%plots=F output%directory="$work/alone" >"$work/log" 2>&1
    on="restart $work/chain/unfinished/checkpoint.h5"
    # shellcheck disable=SC2086
    leg TERM 1 "$@" output%checkpoint_every=10 output%plots=F output%directory="$work/chain" && leg TERM "$one" $on && leg KILL "$two" $on && "$build/selas" -q $on >"$work/log" 2>&1
    bad=$?
    for file in "$work"/alone/*.dat; do
        cmp -s "$file" "$work/chain/$(basename "$file")" || bad="$bad $(basename "$file")"
    done
    [ ! -e "$work/alone/run.xdmf" ] || same_fields chain || bad="$bad run.h5"
    [ "$bad" = 0 ]
    verdict $? "$what: one process, $one ranks, $two, killed, one process: same bits"
    [ "$bad" = 0 ] || { echo "#   $bad"; sed 's/^/#   /' "$work/log" | head -20; }
}
kills() { # kills HOW_MANY WORDS...: a rank, or each third time all, of a run that goes on each time, killed at times drawn by chance
    wanted=$1 killed=0 worst=0 legs=0 bad=0
    shift
    rm -rf "$work/alone" "$work/chain"
    began=$(date +%s%N)
    quiet 2 "$@" output%checkpoint_every=5 output%plots=F output%directory="$work/alone" || bad=alone
    whole=$((($(date +%s%N) - began) / 1000000)) # ms
    while [ $killed -lt "$wanted" ] && [ $legs -lt $((8 * wanted)) ] && [ "$bad" = 0 ]; do
        legs=$((legs + 1)) ranks=$((2 + legs % 2))
        if [ -e "$work/chain/unfinished/checkpoint.h5" ]; then
            timeout 100 $mpirun -n $ranks "$build/selas-mpi" -q restart "$work/chain/unfinished/checkpoint.h5" >"$work/log" 2>&1 &
        else
            rm -rf "$work/chain"
            timeout 100 $mpirun -n $ranks "$build/selas-mpi" -q "$@" output%checkpoint_every=5 output%plots=F output%directory="$work/chain" >"$work/log" 2>&1 &
        fi
        launcher=$!
        sleep "$(awk -v whole=$whole -v seed="$(date +%N)" 'BEGIN { srand(seed); print whole / 1000 * rand() }')"
        victim=
        for rank in $(ranks_of | awk -v n=$((legs % ranks + 1)) -v all=$((killed % 3 == 2)) 'all || NR == n'); do
            ! kill -KILL "$rank" 2>/dev/null || victim=$rank
        done
        struck=$(date +%s)
        if wait $launcher; then
            same_run || bad=differs # over before it was struck
        elif [ -z "$victim" ]; then
            bad=failed
        else
            killed=$((killed + 1)) took=$(($(date +%s) - struck))
            [ $took -le $worst ] || worst=$took
        fi
    done
    [ ! -e "$work/chain/unfinished/checkpoint.h5" ] || "$build/selas" -q restart "$work/chain/unfinished/checkpoint.h5" >"$work/log" 2>&1 || bad=restart
    [ "$bad" != 0 ] || [ ! -e "$work/chain/report.txt" ] || same_run || bad=differs
    [ "$bad" = 0 ] && [ $killed = "$wanted" ] && [ $worst -le 10 ]
    verdict $? "$killed kills at times drawn by chance, each third of all ranks, in $legs runs: all ended within 10 s ($worst s), the run goes on, same bits"
    [ "$bad" = 0 ] || { echo "#   $bad"; sed 's/^/#   /' "$work/log" | head -20; }
}
same_run() { # what is in the folder `chain` against `alone`
    for file in "$work"/alone/*.dat; do
        cmp -s "$file" "$work/chain/$(basename "$file")" || return 1
    done
    [ ! -e "$work/alone/run.xdmf" ] || same_fields chain
}

linked="-Lbuild_ -lselas-mpi -Wl,-rpath,build_ ${LDFLAGS:-}"
linked=$(echo "$linked" | sed "s#build_#$(realpath "$build")#g")
make_host() { # make_host NAME: a host of regress/hosts in C, into the work folder
    # shellcheck disable=SC2086
    "$mpicc" -std=c17 -Wall -Werror -Isrc -o "$work/$1" "regress/hosts/$1.c" $linked
}
host() { # host WHAT RANKS PROGRAM DECK: all ranks see what one alone sees
    for n in 1 $2; do
        timeout 60 $mpirun -n "$n" "$3" "$4" >"$work/host$n" 2>"$work/log" || break
    done
    [ "$(grep -c . "$work/host$2")" = "$2" ] && [ "$(sed 's/^rank [0-9]*://' "$work/host1" "$work/host$2" | sort -u | wc -l)" = 1 ]
    verdict $? "$1: $2 ranks see what one sees" || sed 's/^/#   /' "$work/log" | head -5
}

# Scenes: sources early, so that they act on all parts of a body in few steps
early='scene%end_time=1.5 load(1)%delay=.6 load(2)%delay=.6'
shown='regress/parallel/tall-shown.nml scene%end_time=1.4 load(1)%delay=.6 load(2)%delay=.6 snapshot(1)%every=.6 snapshot(2)%times=.51,1.32'
hill='regress/parallel/tall-hill.nml scene%end_time=1 load(1)%delay=.5 load(2)%delay=.5 profile%times=.5,.9 snapshot%every=.5'
layers='boundary(1)%face=x-,y+,z+ boundary(1)%kind=transmitting boundary(1)%layer=pml boundary(1)%layer_points=4 boundary(1)%always=T'
quality='material(1)%q_p=40 material(1)%q_s=25'
points="regress/parallel/tall-sph.nml $early profile%times=1 snapshot(1)%every=.7 snapshot(2)%times=1.02"
column='regress/parallel/column-sph.nml scene%end_time=.8 load(1)%delay=.3 load(2)%delay=.3 load(3)%delay=.3 profile%times=.7 snapshot(1)%every=.4 snapshot(2)%times=.62'
long="regress/parallel/long-sph.nml $early profile%times=1 snapshot(1)%every=.7 snapshot(2)%times=1.02"
moving='regress/parallel/moving-particles.nml scene%end_time=.8 load(1)%delay=.3 load(2)%delay=.3 profile%times=.7 snapshot%every=.4'
