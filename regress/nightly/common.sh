# shellcheck shell=sh
# Functions that regress/nightly/run, regress/nightly/accept and their parts share. A case is a folder regress/cases/NAME with
#   case       key: value lines: what (one line for the page), deck, override (as often as wanted), atol and rtol of
#              `selas diff` against accepted/, half (quick or night), plots (yes: also the program's own PNGs)
#   accepted/  histories RECEIVER.dat and profiles PROFILE.dat, rounded to 11 digits
#   record     what else a run leaves, in digests: exact histories, run.h5, the report, the echo (regress/nightly/record)
#   errors     recorded errors against the exact solution, `NAME: VALUE`, where the deck has a &reference
LC_ALL=C
export LC_ALL
newline='
'

key() { sed -n "s/^$2: *//p" "regress/cases/$1/case"; } # key CASE NAME: its values, one a line

case_names() { # case_names [quick]: of all cases, or of the quick half
    for case_file in regress/cases/*/case; do
        name=${case_file#regress/cases/}
        name=${name%/case}
        [ "${1:-}" = quick ] && [ "$(key "$name" half)" != quick ] && continue
        echo "$name"
    done
}

command_of() { # command_of CASE: as a user would type it
    echo "build/selas $(key "$1" deck) $(key "$1" override | sed "s/.*[,(' ;].*/\"&\"/" | tr '\n' ' ')"
}

run_case() { # run_case CASE BUILD FOLDER [no-plots]: leaves the results in FOLDER, the program's words in FOLDER.log; RUN_UNDER: what runs it
    run_folder=$3
    run_deck=$(key "$1" deck)
    run_plots=$([ "$(key "$1" plots)" = yes ] && [ -z "${REGRESS_NO_PLOTS:-}${4:-}" ] && echo T || echo F)
    run_program=$2/selas
    rm -rf "$run_folder"
    run_words=$(key "$1" override)
    set -f
    IFS=$newline
    # shellcheck disable=SC2086
    set -- $run_words
    unset IFS
    set +f
    # shellcheck disable=SC2086
    timeout -k 10 "${REGRESS_TIMEOUT:-1800}" ${RUN_UNDER:-} "$run_program" -q "$run_deck" "$@" output%plots="$run_plots" \
        output%directory="$run_folder" >"$run_folder.log" 2>&1
}

errors_of() { # errors_of FOLDER: `NAME: VALUE` of every error of report.txt that is recorded
    awk -F': ' '
        /^error .* (velocity|displacement): L2/ { split($2, f, " "); print substr($1, 7) ": " f[2] }
        /^frequency error at / { print $1 ": " ($2 < 0 ? -$2 : $2 + 0) }' "$1/report.txt"
}

value_of() { # value_of FOLDER KEY: first number of a line of report.txt
    sed -n "s/^$2: \([^ ]*\).*/\1/p" "$1/report.txt" | head -1
}

# Profiles (columns s x y z FIELD_COMPONENT ...) by the rule of `selas diff`: |b - a| <= atol range + rtol |a|, the
# range of a column being at least 1e-3 of the largest one of its field. Prints what differs; status 1 if anything does.
diff_profile() { # diff_profile A B ATOL RTOL
    awk -v atol="$3" -v rtol="$4" -v nameb="$2" '
        function finite(x) { return x == x && x - x == 0 }
        /^# s x y z/ && NR == FNR { for (i = 6; i <= NF; i++) { field[i - 1] = $i; sub(/_.*/, "", field[i - 1]) } }
        /^#/ || NF == 0 { next }
        NR == FNR {
            rows++
            for (i = 1; i <= NF; i++) {
                a[rows, i] = $i + 0
                if (rows == 1 || $i < low[i]) low[i] = $i + 0
                if (rows == 1 || $i > high[i]) high[i] = $i + 0
            }
            columns = NF
            next
        }
        {
            n++
            if (NF != columns) { bad++; next }
            for (i = 1; i <= NF; i++) b[n, i] = $i
        }
        END {
            if (n != rows || bad || rows == 0) { print nameb ": " rows + 0 " rows accepted, " n + 0 " found"; exit 1 }
            for (i = 5; i <= columns; i++)
                if (high[i] - low[i] > widest[field[i]]) widest[field[i]] = high[i] - low[i]
            for (i = 1; i <= columns; i++) {
                range = high[i] - low[i]
                if (i > 4 && range < 1e-3 * widest[field[i]]) range = 1e-3 * widest[field[i]]
                for (k = 1; k <= rows; k++) {
                    d = b[k, i] - a[k, i]
                    allowed = atol * range + rtol * (a[k, i] < 0 ? -a[k, i] : a[k, i])
                    if (d < 0) d = -d
                    if (b[k, i] ~ /[nN][aA][nN]|[iI][nN][fF]/ || !(d <= allowed)) {
                        printf "%s: column %d (%s), row %d: %s for %s\n", nameb, i, field[i], k, b[k, i], a[k, i]
                        exit 1
                    }
                }
            }
        }' "$1" "$2"
}

record_differs() { # record_differs CASE NOW: prints what differs from the accepted record
    [ -f "regress/cases/$1/record" ] || { echo 'there is none; see regress/nightly/accept'; return 1; }
    regress/nightly/record diff "regress/cases/$1/record" "$2"
}

is_history() { grep -q '^# t ux uy uz vx vy vz' "$1"; }

has_histories() { # has_histories FOLDER...: is there a receiver's history in any of them?
    for has_folder; do
        for has_file in "$has_folder"/*.dat; do
            [ -f "$has_file" ] && is_history "$has_file" && return 0
        done
    done
    return 1
}

tell_figures() { # tell_figures NAME PASSED FAILED 'ERROR CPU INSTRUCTIONS' OUT: for the page, in the log, and as small plots
    [ $(($2 + $3)) -gt 0 ] || set -- "$1" 0 1 "$4" "$5" # nothing judged is nothing passed
    echo "$2 $3 $4" >"$5/cases/$1/figures"
    echo "$(date -u +%Y-%m-%dT%H:%M) ${REGRESS_COMMIT:--} $1 $([ "$3" -eq 0 ] && echo pass || echo FAIL) $4" >>"$5/log.txt"
    regress/nightly/small "$1" "$5/cases/$1/run" "$5/log.txt" >"$5/cases/$1/small.html"
}

html() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'; }

picture() { # picture FILE CAPTION: a PNG as a data URI
    printf '<figure><img alt="%s" src="data:image/png;base64,' "$2"
    base64 -w0 "$1"
    printf '"><figcaption>%s</figcaption></figure>\n' "$2"
}
