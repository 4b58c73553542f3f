# The wrong calls and the checkpoints of the library (build/test/test_api*) leave no memory behind: LeakSanitizer. The same
# under valgrind, which also sees reads of what was never written: `make check-leaks`. Argument: the build folder.
build=${1:-build}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=1
# shellcheck disable=SC2046
sanitized() { # sanitized SOURCE PROGRAM
    ${CC:-cc} -std=c17 -D_GNU_SOURCE -Isrc -Iregress/unit -g -fopenmp -fsanitize=leak "$1" "$build/libselas.a" \
        $(pkg-config --cflags --libs gsl fftw3 hdf5) -lm -lcmocka -o "$2"
}
# a leak of one's own is seen, or this machine does not let the sanitizer look
cat >"$work/planted.c" <<'C'
#include "selas.h"
int main(void)
{
    selas_simulation *lost[2] = {0};
    selas_open_text("lost", "", &lost[0]);
    lost[0] = lost[1];
    return selas_open_text("kept", "", &lost[1]) == SELAS_OK;
}
C
if ! sanitized "$work/planted.c" "$work/planted" >"$work/log" 2>&1; then
    echo "not ok - a host links with the sanitizer"
    sed 's/^/# /' "$work/log" | head -20
    exit 1
fi
"$work/planted" >"$work/log" 2>&1
if grep -q 'fatal error' "$work/log"; then
    echo "ok - LeakSanitizer # skip: it cannot trace processes here"
    exit 0
fi
if grep -q 'detected memory leaks' "$work/log"; then echo "ok - a planted leak is seen"; else echo "not ok - a planted leak is seen"; fi
for test in test_api_wrong test_api_checkpoint test_api; do
    if sanitized "regress/unit/$test.c" "$work/$test" >"$work/log" 2>&1 && "$work/$test" >"$work/log" 2>&1; then
        echo "ok - $test leaves no memory behind"
    else
        echo "not ok - $test leaves no memory behind"
        sed 's/^/# /' "$work/log" | head -20
    fi
done
