#!/bin/sh
# The manual holds together: every link between its pages, to files and to headings leads somewhere, every page is in the
# contents (doc/README.md), every page that the source or a script names is there, and every file that a page names, every
# command and option of --help is in the man page; messages and warnings of the source and doc/howto/troubleshooting.md fit, no sum looks like a list
# to Markdown, no average like a tag. Argument: the build folder. Prints TAP.
selas=$(cd "${1:-build}" && pwd)/selas
cd "$(dirname "$0")/../.." || exit 1
texts=$(mktemp) || exit 1
trap 'rm -f "$texts"' EXIT
pages="README.md $(find doc regress/README.md -name '*.md' | sort | tr '\n' ' ')"

anchors() { # anchors PAGE: the names that GitHub gives to its headings
    sed -n '/^```/,/^```/d; s/^##* //p' "$1" | tr '[:upper:]' '[:lower:]' | sed 's/\[\([^]]*\)\]([^)]*)/\1/g; s/[^a-z0-9 _-]//g; s/ /-/g'
}
for page in $pages; do
    grep -oE '\]\([^) ]+\)' "$page" | sed 's/^](//; s/)$//' | while read -r link; do
        case $link in *://* | mailto:*) continue ;; esac
        file=${link%%#*}
        to=$page
        [ -z "$file" ] || to=$(dirname "$page")/$file
        if [ ! -e "$to" ]; then echo "$page: $link"; continue; fi
        case $link in *'#'*) anchors "$to" | grep -qxF -e "${link#*#}" || echo "$page: $link: no such heading" ;; esac
    done
done >"$texts"
broken=$(cat "$texts")
verdict() { # verdict WHAT OFFENDERS
    if [ -z "$2" ]; then echo "ok - $1"; else
        echo "not ok - $1"
        echo "$2" | sed 's/^/#   /'
    fi
}
verdict 'every link of the manual leads somewhere' "$broken"
verdict 'every page of the manual is in its contents' "$(
    for page in $pages; do
        case $page in README.md | doc/README.md | regress/README.md) continue ;; esac
        grep -qF "](${page#doc/})" doc/README.md || echo "$page"
    done
)"
verdict 'every page that source and scripts name is there' "$(
    grep -rhoE '\bdoc/[a-z0-9/-]+\.(md|1)\b' src regress input Makefile README.md doc/selas.1 | sort -u | while read -r page; do
        [ -e "$page" ] || echo "$page"
    done
)"
verdict 'every file of the source that the manual names is there' "$(
    # shellcheck disable=SC2086 # the pages are several words
    grep -hoE '`(src|input|regress/(checks|studies|unit))/[a-z0-9_/*.-]+`' $pages | tr -d '`' | sort -u | while read -r path; do
        ls -d $path >/dev/null 2>&1 || echo "$path"
    done
)"
verdict 'no line of a paragraph or an equation begins like an item of a list' "$(
    # shellcheck disable=SC2086 # the pages are several words
    awk 'FNR == 1 { list = math = code = 0; before = "" }
        /^```/ { code = !code }
        !code && /^ *([-+*]|[0-9]+\.) / && (math || (before != "" && !list)) { print FILENAME ": " FNR ": " $0 }
        { list = $0 != "" && (list || /^ *([-+*]|[0-9]+\.) /); math = (math + gsub(/\$\$/, "")) % 2; before = $0 }' $pages
)"
verdict 'nothing outside code and equations looks like an HTML tag, which nobody would see' "$(
    # shellcheck disable=SC2086 # the pages are several words
    awk '/^```/ { code = !code }
        code || /^    / { next }
        { gsub(/`[^`]*`/, ""); if (/<[A-Za-z\/][^>]*>/) print FILENAME ": " FNR ": " $0 }' $pages
)"
verdict 'every message of doc/howto/troubleshooting.md is one of the source' "$(
    find src -name '*.[ch]' -exec cat {} + | tr '\n' ' ' | sed "s/\" *\"//g; s/%%/%/g; s/\\\\'/'/g" >"$texts"
    sed -n 's/^| \(`[^|]*`\) |.*/\1/p' doc/howto/troubleshooting.md | grep -o '`[^`]*`' | tr -d '`' |
        sed "s/'*\.\.\.'*/\n/g" | sed "s/^[ ,']*//; s/[ ,']*$//" | while read -r text; do
        [ -z "$text" ] || grep -qF -e "$text" "$texts" || echo "$text"
    done
)"
verdict 'every warning of the source has a row in doc/howto/troubleshooting.md' "$(
    sed -n 's/^| \(`[^|]*`\).*|.*/\1/p' doc/howto/troubleshooting.md | grep -o '`[^`]*`' | tr -d '`' |
        sed "s/'*\.\.\.'*/\n/g" | sed "s/^[ ,']*//; s/[ ,']*$//" | grep ' ' >"$texts.rows"
    tr '\n' ' ' <"$texts" | grep -oE '\b(warn|deck_warning|advise)\(([^";]|"[^"]*")*;' | grep '" *[^"]* [^"]*"' | grep -vF -f "$texts.rows"
)"
rm -f "$texts.rows"
verdict 'the man page has every command and option' "$(
    { "$selas" --help; "$selas" diff --help; } | grep -oE -e '--[a-z]+(-[a-z]+)*|^ +selas [a-z]+' | sort -u | while read -r what; do
        sed 's/\\-/-/g' doc/selas.1 | grep -qE -e "${what#selas }" || echo "$what"
    done
)"
