# shellcheck shell=sh disable=SC2086,SC2154
# What is refused; how runs end that go wrong.
one_line "the variant cloud" "on one rank" 3 input/halfspace-cloud.nml
one_line "a wrong word" "number" 3 regress/parallel/tall.nml body%spacing=wide
thin="regress/parallel/tall-sph.nml body%spacing=.5 body%high=2,1.5,3 load(2)%centre=1,.7,1.5 receiver(2)%position=1,.7,1 receiver(3)%position=1,.7,2 profile%to=1,.75,3 snapshot(2)%region=.5,.4,.5,1.5,1.4,2.6"
one_line "layers of points behind a damper, a plane a rank" "take fewer ranks" 7 check $thin "boundary(1)%kind=transmitting" "boundary(1)%layer=lysmer"
[ "$(grep -c '^warning: of 7 ranks' "$work/log")" = 1 ] && [ "$(grep -c '^on rank [0-9] of 6:' "$work/log")" = 1 ]
verdict $? "and what all ranks warn of is told once"
wrong_words() { # wrong_words PATTERN WORDS...: a command that is wrong is told as in one process, and nothing is run
    pattern=$1
    shift
    quiet 3 "$@"
    [ $? = 2 ] && [ "$(grep -c '^selas-mpi: ' "$work/log")" = 1 ] && grep -q "^selas-mpi: .*$pattern" "$work/log" && ! grep -q 'error: ' "$work/log"
    verdict $? "a wrong command on 3 ranks: $pattern"
}
wrong_words "neither a command nor a deck" nodeck
wrong_words "a restart takes no overrides" restart no.h5 scene%end_time=2
wrong_words "plot goes with check" --plot regress/parallel/tall.nml scene%end_time=.1 output%directory="$work/command"
telling() { # telling WHAT WORDS...: as many lines as in one process
    what=$1
    shift
    timeout 60 $mpirun -n 3 "$build/selas-mpi" "$@" >"$work/log" 2>&1 && [ "$(grep -c . "$work/log")" = "$("$build/selas" "$@" | grep -c .)" ]
    verdict $? "$what"
}
telling "the version is told once" --version
telling "help is told once" --help
telling "words are told once" words scene
quiet 7 regress/cases/half-space-pml/deck.nml scene%end_time=.1 output%directory="$work/few" && grep -q '^warning: of 7 ranks 1 can work' "$work/log"
verdict $? "a body of few planes takes fewer ranks and says so"
quiet 2 regress/parallel/tall.nml scene%end_time=1.2 "load(1)%amplitude=0" "load(2)%amplitude=1e41" "snapshot(1)%times=1.2" output%directory="$work/vast" &&
    grep -q "^warning: numbers of the snapshots' field 'velocity' lie beyond" "$work/vast/report.txt"
verdict $? "numbers beyond single precision on the last rank alone are told"
quiet 3 regress/parallel/tall.nml scene%end_time=60 stepping%time_step=.3 stepping%force=T output%directory="$work/wild"
[ $? = 1 ] && [ "$(grep -c '^error: the run went unstable at .* (rank [0-2]), .*' "$work/log")" = 1 ]
verdict $? "an unstable run ends all ranks, with place and time"
planted() { # planted WHAT WORDS...: a force so large that numbers end where the last of 3 ranks alone has it
    what=$1
    shift
    rm -rf "$work/spoilt"
    timeout "${REGRESS_TIMEOUT:-60}" $mpirun -n 3 "$build/selas-mpi" -q "$@" output%checkpoint_every=50 output%directory="$work/spoilt" >"$work/log" 2>&1 &
    launcher=$!
    while kill -0 $launcher 2>/dev/null && ! [ -e "$work/spoilt/unfinished/checkpoint.h5" ]; do sleep .1; done
    began=$(date +%s)
    wait $launcher
    bad=$?
    took=$(($(date +%s) - began))
    [ $bad = 1 ] && [ $took -le 10 ] && [ "$(grep -c '^error: ' "$work/log")" = 1 ] && [ "$(grep -c '^the last good checkpoint' "$work/log")" = 1 ] &&
        grep -qE "^error: the run went unstable at t = .* \(step [0-9]+\): the (state overflows|(state|energy) is not finite); it began about .*$place; likely: " "$work/log"
    verdict $? "$what: numbers that end on the last of 3 ranks alone end all, with place and time ($took s)" || sed 's/^/#   /' "$work/log" | head -8
}
place=' \(rank 2\), by now at [1-9][0-9]? points of that rank'
planted "a lattice" regress/parallel/tall.nml "load(2)%amplitude=1e157"
planted "the exact mass" regress/parallel/tall-exact.nml "load(3)%amplitude=1e157" "load(3)%centre=.9,47" "load(3)%delay=1.6"
planted "general ground" regress/parallel/tall-plane.nml load%amplitude=1e157 load%centre=2.1,14.2
place=' \(rank 2\), by now at [1-9][0-9]* points of that rank'
planted "points" regress/parallel/tall-sph.nml "load(2)%moment=1e200,0,0,0,0,0" "load(2)%centre=1.1,.7,8" "load(2)%width=.02" "load(2)%delay=1"
planted "particles" regress/parallel/moving-particles.nml "load(1)%amplitude=1e200" "load(1)%width=.02" "load(1)%delay=1"
leg TERM 2 regress/parallel/tall.nml scene%end_time=5000 output%checkpoint_every=20 output%directory="$work/chain"
printf x | dd of="$work/chain/unfinished/checkpoint.h5" bs=1 seek=5000 conv=notrunc 2>/dev/null
quiet 3 restart "$work/chain/unfinished/checkpoint.h5"
[ $? = 1 ] && [ "$(grep -c '^error: ' "$work/log")" = 1 ] && grep -q '^error: .*its checksum is wrong' "$work/log"
verdict $? "a damaged checkpoint: one line on 3 ranks"
cat >"$work/last" <<'EOF'
[ "${OMPI_COMM_WORLD_RANK:-${PMI_RANK:-}}" != 2 ] || eval "$1"
shift
exec "$@"
EOF
apart() { # apart FIRST WORDS...: the last of 3 ranks runs FIRST before
    first=$1 here=$PWD program=$(realpath "$build/selas-mpi")
    shift
    rm -rf "$work/apart"
    mkdir -p "$work/apart/elsewhere"
    (cd "$work/apart" && timeout "${REGRESS_TIMEOUT:-100}" $mpirun -n 3 sh "$work/last" "$first" "$program" -q "$here/regress/parallel/tall.nml" output%plots=F output%directory=out "$@") >"$work/log" 2>&1
    bad=$?
}
told() { # told STATUS COUNT PATTERN WHAT: it ended so, with as many errors, the pattern's on rank 2, and nothing in half
    [ "$bad" = "$1" ] && [ "$(grep -c '^error: ' "$work/log")" = "$2" ] && [ "$(grep -c '^on rank 2 of 3:' "$work/log")" = "$2" ] &&
        grep -q "^error: cannot write $3" "$work/log" && ! find "$work/apart" -name '*.part' | grep -q .
    verdict $? "$4" || sed 's/^/#   /' "$work/log" | head -8
}
apart "cd elsewhere"
told 1 1 "into the folder 'out': No such file" "a folder that one rank has not: one line"
others() { # others PATTERN WHAT: the last of 3 ranks has another file
    (cd "$work/apart" && timeout 60 $mpirun -n 3 sh "$work/last" "cd elsewhere" "$program" -q tall.nml output%directory="$work/apart/out") >"$work/log" 2>&1
    [ $? = "$3" ] && [ "$(grep -c 'error: ' "$work/log")" = 1 ] && grep -q "^error: $1" "$work/log"
    verdict $? "$2: one line" || sed 's/^/#   /' "$work/log" | head -8
}
cp regress/parallel/tall.nml "$work/apart"
sed 's/spacing = 0.25/spacing = 0.2/' regress/parallel/tall.nml >"$work/apart/elsewhere/tall.nml"
others "ranks have read different decks 'tall.nml'" "a rank with another deck" 2
differ() { # differ WORDS...: those of the third rank
    timeout 60 $mpirun -n 2 "$build/selas-mpi" -q regress/parallel/tall.nml : -n 1 "$build/selas-mpi" "$@" >"$work/log" 2>&1
    [ $? = 2 ] && [ "$(grep -c '^selas-mpi: ranks were given different commands' "$work/log")" = 1 ] && ! grep -q 'error: ' "$work/log"
    verdict $? "a rank with another command, $*: one line"
}
differ -q regress/parallel/tall.nml body%spacing=.2
differ words scene
sed "s/history = 'gaussian', width = 0.4, delay = 1.6/history = 'table', file = 'pulse.txt'/" regress/parallel/tall.nml | tee "$work/apart/elsewhere/tall.nml" >"$work/apart/tall.nml"
printf '0 0\n1 1\n2 0\n' | tee "$work/apart/pulse.txt" | sed 's/2/3/' >"$work/apart/elsewhere/pulse.txt"
others "ranks have read different files" "a rank with another table of a load" 1
apart "ulimit -f 30000" output%checkpoint_every=8 body%high=8,8,60 scene%end_time=.5
told 0 1 "the checkpoint .*: File too large" "a disk that is full for a checkpoint of one rank: one line, the run ends well"
[ -e "$work/apart/out/run.h5" ]
verdict $? "and has its results"
apart "ulimit -f 24000" body%high=8,8,60 scene%end_time=.1 "snapshot(1)%times=.05" "snapshot(1)%fields='velocity','stress','strain'"
told 1 2 "'out/unfinished/snapshot_0000.h5': File too large" "a disk that is full for a snapshot of one rank: one line, one of the checkpoint"
apart "ulimit -f 24000" body%high=8,8,60 scene%end_time=.05 "snapshot(1)%times=.05" "snapshot(1)%fields='velocity','displacement'" "snapshot(2)%times=.05" "snapshot(2)%fields='strain'"
told 1 2 "'out/run.h5'" "a disk that is full for one rank at the end: one line, one of the checkpoint"
end() { # end SIGNAL [WORDS...]: sent to the last rank of a long run, or with words to all ranks, the last one first
    signal=$1
    shift
    rm -rf "$work/long"
    timeout 60 $mpirun -n 3 "$build/selas-mpi" -q "${@:-regress/parallel/tall.nml}" scene%end_time=5000 output%checkpoint_every=20 output%directory="$work/long" >"$work/log" 2>&1 &
    launcher=$!
    while kill -0 $launcher 2>/dev/null && ! [ -e "$work/long/unfinished/checkpoint_before.h5" ]; do sleep .1; done
    if [ $# = 0 ]; then kill "-$signal" "$(last_rank)"; else for rank in $(ranks_of | sort -rn); do kill "-$signal" "$rank" && sleep .3; done; fi
    began=$(date +%s)
    wait $launcher
    status=$?
    took=$(($(date +%s) - began))
}
end KILL
[ $status != 0 ] && [ $took -le 10 ]
verdict $? "a killed rank ends all within 10 s ($took s)"
end TERM
[ $status = 1 ] && [ $took -le 10 ] && grep -q '^stopped by .* at step .* the state is kept' "$work/log"
verdict $? "a signal to one rank stops all ($took s)"
end TERM regress/parallel/tall-mirrors.nml body%high=4,4,4 "receiver(2)%position=2.6,1.7,3.1"
[ $status = 1 ] && [ $took -le 10 ] && grep -q '^stopped by .* at step .* the state is kept' "$work/log"
verdict $? "a signal to all ranks stops those that work, also where others have nothing to do ($took s)"
kills "${KILLS:-10}" regress/parallel/tall-shown.nml
