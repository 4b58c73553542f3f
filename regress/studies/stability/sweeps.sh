# Sweeps of regress/studies/stability/run: the largest CFL = c0 dt / spacing that stays bounded on the bar (125 particles, t = .12 ms), found by
# bisection with stepping%force, beside the limit that the program measures beforehand.

bounded() { # bounded ALPHA CFL SCHEME STAGES: true if the run ends with no more than 1.5 times the energy given
    step=$(awk "BEGIN { print $2 * .008 / 5088.4 }")
    run sweep input/bar.nml body%spacing=.008 "method%viscosity_alpha=$1" "method%viscosity_beta=$1" "stepping%scheme=$3" \
        ${4:+"stepping%stages=$4"} "stepping%time_step=$step" stepping%force=T
    awk -v s="$(value sweep status)" -v e="$(value sweep energy)" 'BEGIN { exit !(s == "SELAS_OK" && e == e + 0 && e < 1600) }'
}

largest() { # largest ALPHA SCHEME STAGES: measured CFL
    low=.05
    high=12
    bounded "$1" $low "$2" "$3" || { echo 0; return; }
    for _ in 1 2 3 4 5 6 7; do
        middle=$(awk "BEGIN { print sqrt($low * $high) }")
        if bounded "$1" "$middle" "$2" "$3"; then low=$middle; else high=$middle; fi
    done
    echo "$low"
}

limit_of() { # limit_of ALPHA SCHEME STAGES: the program's own limit as CFL
    run limit input/bar.nml body%spacing=.008 "method%viscosity_alpha=$1" "method%viscosity_beta=$1" "stepping%scheme=$2" \
        ${3:+"stepping%stages=$3"} scene%end_time=1e-7 "profile%times=1e-7"
    awk -v l="$(value limit limit)" 'BEGIN { print l == "-" ? 0 : l * 5088.4 / .008 }'
}

sweeps() {
    : >"$out/sweep.txt"
    for alpha in 2.5 .5 0; do
        for scheme in euler pc2 rk4 lsrk54 rkc-2 rkc-3 rkc-4 rkc-5 rkc-6 rkc-8 rkc-10 rkc-15 rkc-20 rkc-30; do
            stages=
            case $scheme in rkc-*) stages=${scheme#rkc-} ;; esac
            echo "$alpha ${scheme%-*} ${stages:--} $(limit_of $alpha "${scheme%-*}" "$stages") $(largest $alpha "${scheme%-*}" "$stages")" >>"$out/sweep.txt"
        done
    done
    worst=$(awk '$5 > 0 && $4 / $5 > w { w = $4 / $5 } $5 == 0 && $4 > .05 { w = 9 } END { print w + 0 }' "$out/sweep.txt")
    if awk "BEGIN { exit !($worst < 1.05) }"; then
        echo "ok - stability: the program's limit is below every step that stayed bounded (at most $worst of it)" >>"$out/verdicts"
    else
        failures=$((failures + 1))
        echo "not ok - stability: the program's limit is $worst of a largest bounded step" >>"$out/verdicts"
    fi
    tail -1 "$out/verdicts"
    {
        echo '| alpha | scheme | stages | limit of the program | largest bounded CFL | per call |'
        echo '|---|---|---|---|---|---|'
        awk '{ n["euler"] = 1; n["pc2"] = 2; n["rk4"] = 4; n["lsrk54"] = 5; calls = $3 == "-" ? n[$2] : $3
            printf "| %s | %s | %s | %.2f | %.2f | %.2f |\n", $1, $2, $3, $4, $5, $5 / calls }' "$out/sweep.txt"
    } >"$out/sweep.md"
}
