#!/bin/sh
# The program's own words: help, version, usage errors and their exit status; nothing on standard output when quiet.
build=${1:-build}
selas=$build/selas
ok() { # ok TITLE COMMAND...: the command succeeds
    title=$1
    shift
    if "$@" >/dev/null 2>&1; then echo "ok - $title"; else echo "not ok - $title"; fi
}
status() { # status WANTED TITLE COMMAND...
    wanted=$1
    title=$2
    shift 2
    "$@" >/dev/null 2>&1
    got=$?
    if [ $got -eq "$wanted" ]; then echo "ok - $title"; else echo "not ok - $title: exit status $got, wanted $wanted"; fi
}
status 0 "--help" "$selas" --help
status 0 "--version" "$selas" --version
ok "the version is the header's" sh -c "'$selas' --version | grep -q \"\$(sed -n 's/.*SELAS_VERSION \"\\(.*\\)\"/\\1/p' src/selas.h)\""
ok "no line of the help is longer than 80" sh -c "! '$selas' --help | grep -q '.\{81\}'"
for word in check exact diff words experts GROUP%NAME=VALUE 'Exit status' OMP_NUM_THREADS; do
    ok "the help tells of $word" sh -c "'$selas' --help | grep -q '$word'"
done
status 2 "no deck" "$selas"
status 2 "check without a deck" "$selas" check
ok "a word that is no command says which there are" sh -c "'$selas' wrods 2>&1 | grep -q 'neither a command nor a deck'"
ok "restart without a checkpoint" sh -c "'$selas' -q restart 2>&1 | grep -q 'no checkpoint was named'"
ok "rerun without a run" sh -c "'$selas' rerun 2>&1 | grep -q 'no run was named'"
status 2 "unknown option" "$selas" --fast input/halfspace.nml
status 2 "a deck that is not there" "$selas" nothere.nml
status 0 "check of each deck" sh -c "for deck in input/*.nml; do '$selas' check \$deck >/dev/null 2>&1 || exit 1; done"
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
ok "a quiet run prints nothing" sh -c "[ -z \"\$('$selas' -q input/halfspace.nml body%spacing=1 output%plots=F output%low_pass=0 output%directory='$out' 2>&1)\" ]"
ok "and leaves its report" test -s "$out/report.txt"
ok "options may stand before a command" "$selas" -q diff "$out" "$out"

# selas words
ok "words lists every group of the deck reference" sh -c "for group in \$(sed -n 's/^### .&\(.*\)\`/\1/p' doc/reference/deck.md); do '$selas' words | grep -q \"^  \$group \" || exit 1; done"
ok "words of a group: type, values, default, meaning" sh -c "'$selas' words scene | grep -A1 -Fx \"  plane (text): 'strain', 'stress'; default 'strain'\" | grep -q across"
ok "what must be given is said" sh -c "'$selas' words '&scene' | grep -Fqx '  end_time (real): (0, inf); must be given'"
ok "words for experts come last" sh -c "'$selas' words method | sed '1,/^For experts:/d' | grep -q '^  quiet ' && '$selas' words method | sed '/^For experts:/,\$d' | grep -q '^  degree '"
ok "and not before" sh -c "! '$selas' words method | sed '/^For experts:/,\$d' | grep -q '^  quiet '"
ok "each word of the reference is printed" sh -c "
    for group in \$(sed -n 's/^### .&\(.*\)\`/\1/p' doc/reference/deck.md); do '$selas' words \$group || exit 1; done | sed -n 's/^  \([a-z_]*\) (.*/\1/p' | sort >'$out/printed'
    sed -n '/tables: made/,/end of tables/{s/^As of [^:]*: \(.*\)\./\1/p;s/^| \(.[a-z][^|]*\) |.*/\1/p}' doc/reference/deck.md | tr ',' '\n' | sed -n 's/^ *[^a-z]\([a-z_]*\)[^a-z] *\$/\1/p' | sort >'$out/listed'
    [ -s '$out/printed' ] && cmp '$out/printed' '$out/listed'"
ok "no line is longer than 80" sh -c "! for group in method boundary load; do '$selas' words \$group; done | grep -q '.\{81\}'"
status 2 "an unknown group" "$selas" words stepng
ok "and what may have been meant" sh -c "'$selas' words stepng 2>&1 >/dev/null | grep -Fqx \"error: unknown group 'stepng'; did you mean 'stepping'?\""
status 2 "two groups" "$selas" words scene body
