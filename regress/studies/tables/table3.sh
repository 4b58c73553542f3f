# Table 3: the plate with a hole, arrangements of points. Sourced by regress/studies/tables/run.
. regress/studies/tables/plate.sh

table3() {
    echo '## Table 3: the plate with a hole, R = .3, arrangements of about 900 points'
    echo
    echo 'Errors of the stress yy on y = 0 at 61 even points, the far stress fitted: against the infinite plate, as the paper'
    echo 'does, and against the finite plate (two finite-element programs, `regress/reference/hole`). "as published": pushed at'
    echo '.2 m/s for 995 microseconds, updated Lagrangian, published switches. "settled": a slow ramp, the plate at rest.'
    echo
    echo '| arrangement | run | paper L1 | paper L2 | points | L1 infinite | L2 infinite | L1 finite | L2 finite | CPU | particle evaluations |'
    echo '|---|---|---|---|---|---|---|---|---|---|---|'
    for row in 'lattice .1811 .3320 .0322' 'radial .2102 .2570 .0304' 'equally-radial .0307 .0375 .0318' 'conformal - - .0334'; do
        # shellcheck disable=SC2086
        set -- $row
        # shellcheck disable=SC2086
        echo "| $1 | updated, as published | $2 | $3 | $(plate plate .3 "body%arrangement=$1" "body%spacing=$4" $published)"
        # shellcheck disable=SC2086
        echo "| $1 | updated, settled | | | $(plate plate .3 "body%arrangement=$1" "body%spacing=$4" $settled)"
        echo "| $1 | total (quadratic), settled | | | $(plate plate .3 "body%arrangement=$1" "body%spacing=$4")"
    done
}
