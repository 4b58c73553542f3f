#!/bin/sh
# No word of &method and &stepping is taken in silence: each word of `selas words` is added, with legal values, to a small
# deck of each method. The run has to refuse it, to warn, or to leave other results; what may change nothing stands
# below with the reason. Argument: the build folder. Prints TAP.
build=$(cd "${1:-build}" && pwd)
selas=$build/selas
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-words-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export OMP_NUM_THREADS=1

# Words of which no value needs to change anything here, and why
cat >idle <<'END_OF_LIST'
method%symmetry half of a body is computed to the same results
method%fused the default wherever it can be
method%quiet nothing is at rest in so small a body
stepping%force the step is stable
END_OF_LIST

rock="&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /"
box="&body material = 'rock', low = 0, 0, 0, high = 4, 4, 3, spacing = 0.5 /"
push="&load face = 'z-', shape = 'square', centre = 2, 2, 0, size = 1, 1, direction = 0.2, 0, 1, history = 'gaussian', width = 0.1, delay = 0.4 /"
seen="&receiver name = 'r', position = 2.5, 1.2, 0.5 /
&output plots = .false., history_step = 0.1 /"
deck() { # deck NAME METHOD [STEPPING] [OTHERS]
    printf '&scene dimension = 3, end_time = 0.3 /\n%s\n%s\n%s\n%s\n%s\n%s\n%s\n' "&method $2 /" "&stepping $3 /" "$rock" "$box" "$push" "$seen" "${4:-}" >"$1.nml"
    decks="$decks $1"
}
decks=
deck sweeps "" ""
deck exact "mass = 'exact'" ""
deck fourth "degree = 3, mass = 'exact'" "scheme = 'modified-equation'"
deck paper "variant = 'paper'" ""
deck cloud "variant = 'cloud'" ""
deck total "name = 'sph', variant = 'total-lagrangian'" ""
deck central "name = 'sph', variant = 'total-lagrangian', gradient = 'central'" ""
deck updated "name = 'sph', variant = 'updated-lagrangian'" "scheme = 'rk4'"

values() { # values GROUP: lines WORD VALUE...
    "$selas" words "$1" | awk '
        function flush(   type, rest) {
            if (word == "") return
            rest = text
            if (type_of ~ /^logical/) print word, "T", "F"
            else if (type_of ~ /^text/) {
                values = ""
                while (match(rest, /\047[^\047]*\047/)) {
                    values = values " " substr(rest, RSTART + 1, RLENGTH - 2)
                    rest = substr(rest, RSTART + RLENGTH)
                }
                if (values != "") print word values
            } else if (type_of ~ /^integer/) print word, "2", "3"
            else if (type_of ~ /^real/) print word, "0.7", "0.3"
        }
        /^  [a-z_]+ \(/ { flush(); word = $1; type_of = substr($2, 2); text = $0; sub(/^[^:]*:?/, "", text); head = 1; next }
        /^      [^ ]/ && head && text ~ /,$/ { text = text $0; next }
        { head = 0 }
        END { flush() }'
}
of() { grep -v '^#' "$1/r.dat"; }
run() { # run DECK OVERRIDE...: status; results in out/, words in said
    rm -rf out
    name=$1
    shift
    timeout 20 "$selas" -q "$name.nml" output%directory=out "$@" >said 2>&1 || return
    grep '^warning' out/report.txt >>said
    return 0
}

tried=0 silent=0
for deck in $decks; do
    run "$deck" || { echo "not ok - $deck runs: $(tail -1 said)"; continue; }
    of out >base
    cp said base.said
    for group in method stepping; do
        values "$group" >list
        while read -r word those; do
            [ "$group%$word" = method%name ] && continue
            [ "$group%$word" = method%variant ] && continue
            grep -q "^$group%$word " idle && continue
            taken='' heard=''
            for value in $those; do
                tried=$((tried + 1))
                if ! run "$deck" "$group%$word=$value"; then
                    heard=yes
                    grep -q 'has no use for' said && break
                    continue
                fi
                of out >now
                if ! cmp -s base now || ! cmp -s base.said said; then heard=yes; break; fi
                taken="$taken $value"
            done
            [ -n "$heard" ] && continue
            [ -n "$taken" ] || continue
            silent=$((silent + 1))
            echo "not ok - $deck: $group%$word =$taken changes nothing and nothing is said"
        done <list
    done
done
[ $silent -gt 0 ] || echo "ok - no word is taken in silence ($tried runs)"
