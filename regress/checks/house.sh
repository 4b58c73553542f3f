#!/bin/sh
# The house rules of src/ that can be counted: no C file over 400 lines, no function over 60 (its body begins with { and ends
# with } in the first column), no line over 120 characters. Prints TAP.
good_or_bad() { # good_or_bad WHAT OFFENDERS
    if [ -z "$2" ]; then echo "ok - $1"; else
        echo "not ok - $1"
        echo "$2" | sed 's/^/# /'
    fi
}
sources=$(find src -name '*.[ch]' | sort)
long_files() { # shellcheck disable=SC2086
    wc -l $1 | awk '$2 != "total" && $1 > 400 { print $2 ": " $1 " lines" }'
}
long_functions() { # shellcheck disable=SC2086
    awk 'FNR == 1 { begin = 0; head = "" }
        /^[a-zA-Z_].*\(/ { head = FNR; name = $0; sub(/\(.*/, "", name); sub(/.*[ *]/, "", name) }
        /^\{/ { begin = head }
        /^\}/ { if (begin && FNR - begin + 1 > 60) print FILENAME ":" begin ": " name "() has " FNR - begin + 1 " lines"; begin = 0 }' $1
}
long_lines() { # shellcheck disable=SC2086
    awk 'length($0) > 120 { print FILENAME ":" FNR ": " length($0) " characters" }' $1
}
good_or_bad 'no C file over 400 lines' "$(long_files "$sources")"
good_or_bad 'no function over 60 lines' "$(long_functions "$sources")"
good_or_bad 'no line over 120 characters' "$(long_lines "$sources $(find src -name '*.f90')")"

# The rules see what they should: a file that breaks each.
planted=$(mktemp) || exit 1
trap 'rm -f "$planted"' EXIT
awk 'BEGIN {
    print "static int long_one(int a,\n                    int b)\n{"
    for (i = 0; i < 58; i++) print "    a += b;"
    print "}"
    for (i = 0; i < 400; i++) print ""
    for (i = 0; i < 121; i++) printf "x"
    print "" }' >"$planted"
good_or_bad 'a long file, a long function and a long line are found' "$(
    [ "$(long_files "$planted")" = "$planted: 463 lines" ] || echo file
    [ "$(long_functions "$planted")" = "$planted:1: long_one() has 62 lines" ] || echo function
    [ "$(long_lines "$planted")" = "$planted:463: 121 characters" ] || echo line
)"
