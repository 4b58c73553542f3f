#!/bin/sh
# Every input that the fuzzing keeps (regress/fuzz/corpus: seeds, and what once went wrong) through its target, without
# libFuzzer and with any compiler. `make fuzz` looks for new ones.
build=${1:-build}
export OMP_NUM_THREADS=1
if ! make --no-print-directory BUILD="$build" fuzz-replay >"$build/test/replay.log" 2>&1; then
    echo "not ok - the fuzz targets do not build: $(tail -2 "$build/test/replay.log")"
    exit 1
fi
for target in deck tables points points_hdf5 checkpoint results; do
    inputs=regress/fuzz/corpus/$target
    [ $target = deck ] && inputs="$inputs input"
    # shellcheck disable=SC2046,SC2086
    if timeout 100 "$build/replay/fuzz_$target" $(find $inputs -type f) >"$build/test/replay.log" 2>&1; then
        echo "ok - $(grep -c "^regress/fuzz\|^input/" "$build/test/replay.log") inputs to fuzz_$target"
    else
        echo "not ok - fuzz_$target: $(tail -3 "$build/test/replay.log")"
    fi
done
