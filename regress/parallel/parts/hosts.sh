# shellcheck shell=sh disable=SC2086,SC2154
# Hosts on ranks; checkpoints that they write.
sed 's/use mpi_f08/use mpi/; s/%mpi_val//' regress/hosts/coupled_ranks.f90 >"$work/coupled_mpi.f90"
# shellcheck disable=SC2086
"$mpifc" -std=f2018 -Wall -Wno-compare-reals -I"$build" -o "$work/coupled_f08" regress/hosts/coupled_ranks.f90 "$build/libselas_fortran.a" $linked &&
    "$mpifc" -I"$build" -o "$work/coupled_mpi" "$work/coupled_mpi.f90" "$build/libselas_fortran.a" $linked &&
    make_host shared_column && make_host shared_checkpoint && make_host wrong_communicators
verdict $? "hosts on ranks compile (mpi_f08, mpi, C)"
make -s -o mpi -o all BUILD="$build" PREFIX=/usr DESTDIR="$work/root" install-mpi >"$work/log" 2>&1 &&
    "$mpicc" -std=c17 -I"$work/root/usr/include" -o "$work/installed" regress/hosts/shared_column.c -L"$work/root/usr/lib" -lselas-mpi -Wl,-rpath,"$work/root/usr/lib" ${LDFLAGS:-} 2>>"$work/log"
verdict $? "a host compiles with what make install-mpi has put there"
host_saves() { # host_saves RANKS TO FROM STEPS WORDS...
    ranks=$1
    shift
    timeout 60 $mpirun -n "$ranks" "$work/shared_checkpoint" "$@" >"$work/log" 2>&1
}
same_sets() { # same_sets ONE OTHER: what checkpoints hold but for times, energies, and accelerations that steps in one pass do not read
    h5ls "$1" | cut -d' ' -f1 >"$work/one"
    h5ls "$2" | cut -d' ' -f1 | cmp -s - "$work/one" && grep -qx y "$work/one" || return 1
    h5diff --exclude-path /a --exclude-path /figures --exclude-path /watch --exclude-path /before "$1" "$2" >>"$work/log" 2>&1
}
saves() { # saves WHAT WORDS...: the same file by 1, 2 and 3 ranks, and after each restart
    what=$1 bad=0
    shift
    for n in 1 2 3; do
        host_saves $n "$work/saved$n.h5" - 10 "$@" && same_sets "$work/saved1.h5" "$work/saved$n.h5" || bad="$bad $n"
    done
    for n in 1 2 3; do
        host_saves $n "$work/again$n.h5" "$work/saved$((n % 3 + 1)).h5" 10 "$@" && same_sets "$work/again1.h5" "$work/again$n.h5" || bad="$bad again $n"
    done
    SELAS_SPARE=1 && export SELAS_SPARE
    host_saves 3 "$work/spare.h5" - 10 "$@" && same_sets "$work/saved1.h5" "$work/spare.h5" || bad="$bad spare"
    unset SELAS_SPARE
    [ "$bad" = 0 ]
    verdict $? "$what: 1, 2, 3 ranks and 2 of a host's 3 write the same checkpoint, again after restarts"
    [ "$bad" = 0 ] || { echo "#   $bad"; sed 's/^/#   /' "$work/log" | head -5; }
}
saves "layers in single precision" regress/parallel/tall.nml method%precision=single
saves "points" $points
tall=regress/parallel/tall.nml
host "a coupled host, mpi_f08" 3 "$work/coupled_f08" $tall
host "a coupled host, mpi" 2 "$work/coupled_mpi" $tall
host "a host of the installed library" 2 "$work/installed" $tall
host "a host in C" 3 "$work/shared_column" $tall
timeout 60 $mpirun -n 3 "$work/shared_column" regress/cases/half-space-pml/deck.nml >"$work/log" 2>&1
[ "$(grep -c '^error: 1 of the .* open it with as many' "$work/log")" = 1 ]
verdict $? "a host with too many ranks: one line"
spoils() { # spoils VALUE PATTERN WHAT: a load whose value is another on the last of 3 ranks
    timeout 60 $mpirun -n 3 "$work/shared_column" regress/parallel/tall.nml "$1" >"$work/log" 2>&1
    [ $? = 1 ] && [ "$(grep -c '^error: ' "$work/log")" = 1 ] && grep -q "^error: $2" "$work/log"
    verdict $? "$3: one line on 3 ranks" || sed 's/^/#   /' "$work/log" | head -5
}
spoils nan "the value of load '1' is not a finite number" "a host that sets a load to no number on one rank"
spoils 0.1 "ranks give load '1' values from 0 to 0.1" "a host whose ranks set a load to different values"
timeout 60 $mpirun -n 3 "$work/wrong_communicators" $tall >"$work/log" 2>&1 && [ "$(grep -c '^error: ' "$work/log")" = 3 ]
verdict $? "communicators that cannot share: each is refused in a line, and another one taken" || sed 's/^/#   /' "$work/log" | head -5
