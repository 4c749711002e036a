#!/bin/bash
# The fuzz targets on their corpora and on random changes of them, 300 each: the same ones every time. Prints a PASS or FAIL line a target.
set -u
build=${BUILD:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export FUZZ_FOLDER=$work
failures=0
for source in tests/fuzz/fuzz_*.c; do
    name=$(basename "$source" .c)
    if "$build/tests/fuzz/$name" x300 1 "tests/fuzz/corpus/${name#fuzz_}" "$work" >"$work/log" 2>&1; then
        echo "PASS $(tail -1 "$work/log")"
    else
        cat "$work/log"
        echo "FAIL $name"
        failures=1
    fi
done
exit $failures
