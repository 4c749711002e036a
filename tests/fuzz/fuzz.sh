#!/bin/bash
# Runs every fuzz target for SECONDS and prints its executions and failures; inputs that fail are kept in BUILD/fuzz-failures.
# usage: fuzz.sh SECONDS TARGET.c...   FUZZ_SEED: another order of things (1)
set -u
build=${BUILD:-build} seconds=$1 seed=${FUZZ_SEED:-1} status=0 total=0
shift
kept=$build/fuzz-failures
mkdir -p "$kept"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export FUZZ_FOLDER=$work
export ASAN_OPTIONS=allocator_may_return_null=1:${ASAN_OPTIONS:-}

for source in "$@"; do
    name=$(basename "$source" .c)
    program=$build/tests/fuzz/$name
    corpus=tests/fuzz/corpus/${name#fuzz_}
    if grep -q LLVMFuzzerRunDriver "$program"; then
        mkdir -p "$work/$name"
        "$program" -seed="$seed" -max_total_time="$seconds" -max_len=65536 -rss_limit_mb=2048 -timeout=20 -print_final_stats=1 \
            -artifact_prefix="$kept/$name-" "$work/$name" "$corpus" >"$work/log" 2>&1
        failures=$(($? != 0))
        executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/log")
        [ $failures -eq 0 ] || { grep -v '^#' "$work/log" | tail -40; }
        echo "$name: ${executions:-0} executions, $failures failures"
    else
        "$program" "$seconds" "$seed" "$corpus" "$kept" >"$work/log" 2>"$work/err"
        failures=$(($? != 0))
        [ $failures -eq 0 ] || tail -40 "$work/err"
        cat "$work/log"
        executions=$(sed -n "s/^$name: \([0-9]*\) executions.*/\1/p" "$work/log")
    fi
    total=$((total + ${executions:-0}))
    [ $failures -eq 0 ] || status=1
done
echo "fuzzing: $total executions in all"
exit $status
