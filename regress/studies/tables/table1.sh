# Table 1: the bar. Sourced by regress/studies/tables/run.

# bar_errors FOLDER: L1 and L2 of the velocity over the particles against d'Alembert's step at t = .12 ms
bar_errors() {
    awk '/^#/ || NF < 5 { next }
        { exact = $2 < sqrt(45e9 / 1738) * .12e-3 ? 1 : 0; e = $5 - exact; s += e < 0 ? -e : e; q += e * e; all += exact }
        END { printf "%.4f %.4f", s / all, sqrt(q / all) }' "$out/$1/along.dat"
}
# closed_form NP: L1 and L2 of the smearing D = alpha c h / 4
closed_form() {
    awk -v np="$1" 'BEGIN { c = sqrt(45e9 / 1738); t = .12e-3; w = sqrt(2.5 * c * 1.5 / np / 4 * t); pi = 3.14159265358979
        printf "%.4f %.4f", 2 * w / (sqrt(pi) * c * t), sqrt((2 - sqrt(2)) * w / (sqrt(pi) * c * t)) }'
}
bar_row() { # bar_row NP NAME PAPER_L1 PAPER_L2 PAPER_CPU DT OVERRIDES...
    np=$1 name=$2 paper1=$3 paper2=$4 paper_cpu=$5 dt=$6
    shift 6
    run bar input/bar.nml "body%spacing=$(ratio "1 / $np")" "profile%points=$np" "profile%from=$(ratio ".5 / $np")" \
        "profile%to=$(ratio "1 - .5 / $np")" stepping%force=.true. "$@"
    set -- $(closed_form "$np")
    if [ -e "$out/bar/along.dat" ]; then
        stages=$(value bar stages)
        [ "$stages" != 0 ] && name="$name($stages)"
        closed1=$1 closed2=$2
        set -- $(bar_errors bar)
        echo "| $np | $dt | $name | $paper1 | $1 | $closed1 | $paper2 | $2 | $closed2 | $paper_cpu | $(cpu bar) | $(evaluations bar) |"
    else
        echo "| $np | $dt | $name | $paper1 | unstable | $1 | $paper2 | unstable | $2 | $paper_cpu | | |"
    fi
}
table1() {
    echo '## Table 1: the bar, errors of the velocity at t = .12 ms'
    echo
    echo '"-" marks what the paper found unstable. "closed form" is the smearing by alpha = 2.5 alone, without any time scheme'
    echo '(doc/theory/sph-updated-lagrangian.md). Stages by the paper'"'"'s Eq 28; `stepping%force` beyond'
    echo 'the limit.'
    echo
    echo '| NP | step | scheme | L1 paper | L1 ours | L1 closed form | L2 paper | L2 ours | L2 closed form | CPU paper | CPU ours | particle evaluations |'
    echo '|---|---|---|---|---|---|---|---|---|---|---|---|'
    grep -v '^#' regress/studies/tables/table1.txt | while read -r np dt scheme l1 l2 seconds; do
        bar_row "$np" "$scheme" "$l1" "$l2" "$seconds" "$dt" "stepping%scheme=$scheme" "stepping%time_step=$dt" stepping%rule=paper
    done
    echo
    echo 'The same bar with viscosity .5, steps chosen by the program (the closed form is that of 2.5):'
    echo
    echo '| NP | step | scheme | L1 paper | L1 ours | L1 closed form | L2 paper | L2 ours | L2 closed form | CPU paper | CPU ours | particle evaluations |'
    echo '|---|---|---|---|---|---|---|---|---|---|---|---|'
    weak='method%viscosity_alpha=.5 method%viscosity_beta=.5'
    for scheme in rkc rk4 lsrk54; do
        # shellcheck disable=SC2086
        bar_row 250 "updated, $scheme" - - - chosen $weak "stepping%scheme=$scheme"
    done
    # shellcheck disable=SC2086
    bar_row 250 'total Lagrangian, leapfrog' - - - chosen $weak method%variant=total-lagrangian method%gradient=linear \
        stepping%scheme=leapfrog
}
