#!/bin/sh
# Every command of README.md and of the tutorial is run as it stands there, from the pages themselves. A block of
# ```sh holds commands (`# exit status N` behind one: how it ends, else 0); a block whose first line is a comment with a
# file's name is that file; a block of ```text is what the commands before it print: each of its lines has to be
# printed, numbers within 2 %. `make` of targets that set up, build or test is tried with -n. Argument: the build folder.
# Prints TAP.
root=$PWD
build=$(cd "${1:-build}" && pwd)
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
ln -s "$build" "$work/build"
ln -s "$root/input" "$work/input"
cd "$work" || exit 1
export HOME="$work" OMP_NUM_THREADS=1 OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

make() { # installs are made, of all else make only says what it would do
    case " $* " in
    *' install '*) command make -s -C "$root" BUILD="$build" "$@" ;;
    *) command make -n -C "$root" BUILD="$build" "$@" >/dev/null ;;
    esac
}
matches() { # matches WANTED PRINTED: prints the lines of WANTED of which none like it is in PRINTED
    awk 'function number(s) { return s ~ /^[-+]?[0-9.]+([eE][-+]?[0-9]+)?$/ }
        function alike(a, b, i, n, m, x, y) {
            n = split(a, x, /[ ,();:]+/); m = split(b, y, /[ ,();:]+/)
            if (n != m) return 0
            for (i = 1; i <= n; i++) {
                if (x[i] == y[i]) continue
                if (!number(x[i]) || !number(y[i])) return 0
                d = x[i] - y[i]; s = x[i] + 0
                if (d * d > 4e-4 * s * s) return 0
            }
            return 1
        }
        { sub(/^ +/, ""); sub(/ +$/, "") }
        FNR == NR { printed[++lines] = $0; next }
        $0 != "" {
            found = 0
            for (i = 1; i <= lines && !found; i++) found = alike($0, printed[i])
            if (!found) print
        }' "$2" "$1"
}
finish_commands() { # what a block of commands printed is held against the block of text behind it
    missing=$(matches wanted printed)
    if [ -z "$missing" ]; then echo "ok - $page: prints what the page says: $(head -1 wanted | cut -c1-50)"; else
        echo "not ok - $page: prints what the page says"
        echo "$missing" | sed 's/^/#   not printed: /'
        tail -20 printed | sed 's/^/#   printed: /'
    fi
}
run_line() { # run_line COMMAND
    command=$1
    want=$(echo "$command" | sed -n 's/.*# *exit status \([0-9]\).*/\1/p')
    case $command in
    *mpirun* | *output/ranks*) if [ ! -x build/selas-mpi ] || ! which mpirun >/dev/null; then echo "ok - $page: $command # SKIP no ranks here"; return; fi ;;
    esac
    eval "$command" >said 2>&1 </dev/null
    status=$?
    cat said >>printed
    if [ $status -eq "${want:-0}" ]; then echo "ok - $page: $command"; else
        echo "not ok - $page: $command: exit status $status"
        tail -5 said | sed 's/^/#   /'
    fi
}
follow() { # follow PAGE
    page=${1#"$root"/}
    kind='' file=''
    : >printed
    while IFS= read -r line; do
        case $kind,$line in
        ,'```sh') kind='sh'; : >>printed; [ "$last" = text ] && : >printed ;;
        ,'```text') kind='text'; : >wanted ;;
        ,'```'*) kind='file' file='' ;;
        *,'```')
            [ $kind = text ] && finish_commands
            last=$kind kind='' ;;
        sh,?*) case $line in '#'*) ;; *) run_line "$line" ;; esac ;;
        text,*) echo "$line" >>wanted ;;
        file,*)
            if [ -z "$file" ]; then file=$(echo "$line" | sed -n 's/^[!/* ]* \([a-z]*\.[a-z0-9]*\)\( \*\/\)*$/\1/p'); file=${file:-nothing}; : >"$file"; fi
            echo "$line" >>"$file" ;;
        esac
    done <"$1"
}
last=''
for page in "$root/README.md" "$root/doc/tutorial/first-run.md" "$root/doc/tutorial/ground.md" "$root/doc/tutorial/more.md"; do follow "$page"; done

# A wrong figure, a wrong word and a line that is not printed are seen
printf 'error far: 1.50e-02\npoints: 100\n' >printed
for wrong in 'error far: 1.60e-02' 'error near: 1.5e-02' 'steps: 5'; do
    echo "$wrong" >wanted
    if [ "$(matches wanted printed)" = "$wrong" ]; then echo "ok - seen: $wrong"; else echo "not ok - seen: $wrong"; fi
done
