# Table 2: frequency of the clamped beam. Sourced by regress/studies/tables/run.

# off FREQUENCY OTHER: the frequency and how far it is off the other one
off() { awk -v ours="$1" -v other="$2" 'BEGIN { printf "%.2f (%+.1f %%)", ours, (ours / other - 1) * 100 }'; }
beam_row() { # beam_row WIDTH FACTOR PAPER TRUTH END
    run beam input/beam.nml method%variant=updated-lagrangian body%spacing=.00333333333333333 "body%high=.5,$1" \
        "receiver(1)%position=.5,$(ratio "$1 / 2")" "receiver(2)%position=.25,$(ratio "$1 / 2")" \
        "initial%amplitude=$2" "scene%end_time=$5" snapshot%every=1.0
    if [ -e "$out/beam/report.txt" ]; then
        updated="$(off "$(value beam 'frequency at tip')" "$3") | $(cpu beam) | $(evaluations beam)"
    else
        updated='unstable | | '
    fi
    run beam-total input/beam.nml body%spacing=.00333333333333333 "body%high=.5,$1" "initial%amplitude=$2" \
        "receiver(1)%position=.5,$(ratio "$1 / 2")" "receiver(2)%position=.25,$(ratio "$1 / 2")" \
        "scene%end_time=$5" snapshot%every=1.0
    if [ -e "$out/beam-total/report.txt" ]; then
        total="$(off "$(value beam-total 'frequency at tip')" "$4") | $(cpu beam-total) | $(evaluations beam-total)"
    else
        total='unstable | | '
    fi
    echo "| $1 | $2 | $3 | $updated | $total | $4 |"
}
table2() {
    echo '## Table 2: angular frequency of the clamped beam, spacing .0033 m'
    echo
    echo 'rad/s ("Hz" in the paper). Updated Lagrangian with the published switches and the measured step (RKC), total'
    echo 'Lagrangian with quadratic gradients and leapfrog, two periods each. The truth is two-dimensional plane stress at'
    echo 'small amplitude; the paper compares with 2066 and 1033 of Euler-Bernoulli. In brackets: the updated form against'
    echo "the paper's figure, the total form against the truth. The paper's figures cannot be reproduced by the method that"
    echo 'it describes: its operator is soft by O(spacing / W), and unstable where the tip moves far (at V_f = .05 by 1.3'
    echo 'and 5 widths: no linear truth).'
    echo
    echo '| W | V_f | paper | updated Lagrangian | CPU | particle evaluations | total Lagrangian | CPU | particle evaluations | truth |'
    echo '|---|---|---|---|---|---|---|---|---|---|'
    for row in '.05 1888' '.02 1929' '.01 1943' '.005 1943' '.002 1943' '.001 1943'; do
        # shellcheck disable=SC2086
        set -- $row
        beam_row .1 "$1" "$2" 2008.3 .0066
    done
    for row in '.05 982' '.02 983' '.01 1000' '.005 1007' '.002 1007' '.001 1007'; do
        # shellcheck disable=SC2086
        set -- $row
        beam_row .05 "$1" "$2" 1026.2 .0135
    done
}
