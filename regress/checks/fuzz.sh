#!/bin/sh
# Every input that the fuzzing keeps (regress/hardening/fuzz/corpus: seeds, and what once went wrong) through its target, without
# libFuzzer and with any compiler. `make fuzz` looks for new ones.
build=${1:-build}
log=$(mktemp) || exit 1
trap 'rm -f "$log"' EXIT
export OMP_NUM_THREADS=1
if ! make --no-print-directory BUILD="$build" fuzz-replay >"$log" 2>&1; then
    echo "not ok - the fuzz targets do not build: $(tail -2 "$log")"
    exit 1
fi
for target in deck tables points points_hdf5 checkpoint results; do
    inputs=regress/hardening/fuzz/corpus/$target
    [ $target = deck ] && inputs="$inputs input"
    # shellcheck disable=SC2046,SC2086
    if timeout 100 "$build/replay/fuzz_$target" $(find $inputs -type f) >"$log" 2>&1; then
        echo "ok - $(grep -c "^regress/hardening/fuzz\|^input/" "$log") inputs to fuzz_$target"
    else
        echo "not ok - fuzz_$target: $(tail -3 "$log")"
    fi
done
