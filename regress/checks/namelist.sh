#!/bin/sh
# Reads namelist text with our reader and with gfortran's own read (nml=...) and compares all values, bit for
# bit: the fragments of regress/namelist/fragments.txt, and every deck of input/ with its echo.
build=${1:-build}
here=regress/namelist
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT

# shellcheck disable=SC2046 # the words of pkg-config
${CC:-cc} -std=c17 -D_GNU_SOURCE -Isrc -o "$work/values" $here/values.c "$build/libselas.a" -fopenmp \
    $(pkg-config --libs gsl fftw3 hdf5) -lm || exit 1
for table in sample deck; do
    "$work/values" fortran $table >"$work/$table.f90"
    gfortran -J "$work" -o "$work/$table" $here/show.f90 "$work/$table.f90" || exit 1
done

# Splits the fragments into files NUMBER-KIND with their titles in NUMBER-KIND.title; two empty lines at the
# end because gfortran wants a line end after the group.
awk -v work="$work" '
    /^#: / {
        number++
        split($0, part, ": ")
        file = sprintf("%s/%03d-%s", work, number, part[2])
        title = $0
        sub(/^#: [a-z]*: /, "", title)
        print title >(file ".title")
        next
    }
    number { sub(/\\r$/, "\r"); print >file }
    END { for (i = 1; i <= number; i++) close(sprintf("%s/%03d", work, i)) }
' $here/fragments.txt
for title in "$work"/*.title; do
    file=${title%.title}
    printf '\n\n' >>"$file"
    "$work/sample" "$file" >"$file.gfortran"
    "$work/values" read sample "$file" >"$file.ours"
    theirs='read'
    grep -q '^refused' "$file.gfortran" && theirs=refused
    ours='read'
    grep -q '^refused' "$file.ours" && ours=refused
    same=different
    cmp -s "$file.gfortran" "$file.ours" && same=same
    case ${file##*-}/$theirs/$ours/$same in
    accepted/read/read/same | refused/refused/refused/* | stricter/read/refused/*)
        echo "ok - ${file##*-}: $(cat "$title")" ;;
    *)
        echo "not ok - ${file##*-}: $(cat "$title") (gfortran: $theirs, ours: $ours, values: $same)"
        diff "$file.gfortran" "$file.ours" ;;
    esac
done

# Every deck, and its echo, which holds every default and must not change when it is echoed again.
for deck in input/*.nml; do
    [ -e "$deck" ] || continue
    name=$(basename "$deck" .nml)
    echo=$work/$name.echo.nml
    "$work/values" echo deck "$deck" >"$echo" && "$work/values" echo deck "$echo" >"$echo.again"
    for file in "$deck" "$echo"; do
        "$work/deck" "$file" >"$work/$name.gfortran"
        "$work/values" read deck "$file" >"$work/$name.ours"
        if grep -q '^refused' "$work/$name.ours" || ! cmp "$work/$name.gfortran" "$work/$name.ours"; then
            echo "not ok - deck $file reads differently in gfortran"
        else
            echo "ok - deck $file reads the same in gfortran"
        fi
    done
    if cmp "$echo" "$echo.again"; then
        echo "ok - the echo of $deck is its own echo"
    else
        echo "not ok - the echo of $deck changes when it is echoed again"
    fi
done
