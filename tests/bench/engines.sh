#!/usr/bin/env bash
# Two engines, one picture: scanline at 16 lines beside weiler-atherton, over every scene in scenes/ and the city, building and bunny
# models of the data folder. usage: tests/bench/engines.sh [SCENE...]
#   GNOMON  the tool (build/gnomon)     GNOMON_SHARED  the folder with data/ (../shared)     SIZE  of the pictures (1280x720)
# For each: mean absolute difference (held below 0.0005), greatest difference, pixels that differ by more than 0.01 away from edges
# (held to 0), seconds of both engines without loading and writing, all threads. Exit status 1 when a bound is missed.
set -u
cd "$(dirname "$0")/../.." || exit 1
gnomon=${GNOMON:-build/gnomon}
shared=${GNOMON_SHARED:-../shared}
size=${SIZE:-1280x720}
[ -x "$gnomon" ] || { echo "SKIP engines: $gnomon is missing: run make first"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# shellcheck disable=SC2046
${CC:-cc} -std=c11 -O2 tests/bench/same.c -o "$work/same" $(pkg-config --cflags --libs libpng) -lm || exit 1

models=("$@")
if [ $# -eq 0 ]; then
    models=(scenes/*.yaml)
    if [ -d "$shared/data/scenes" ]; then
        models+=("$shared"/data/scenes/{city,building,bunny}/*.obj "$shared"/data/reference/bunny.yaml)
    else
        echo "SKIP the city, the buildings and the bunny: $shared/data is missing (set GNOMON_SHARED)"
    fi
fi
seconds() { sed -n 's/.*"render": \([0-9.]*\).*/\1/p' "$1"; }
failures=0
printf '%-44s %10s %8s %8s %10s %10s\n' scene mean greatest off-edge scanline pieces
for model in "${models[@]}"; do
    "$gnomon" render "$model" --size "$size" --lines 16 -o "$work/a.pfm" --quiet --stats "$work/a.json" || { failures=1; continue; }
    "$gnomon" render "$model" --size "$size" --engine weiler-atherton -o "$work/b.pfm" --quiet --stats "$work/b.json" || { failures=1; continue; }
    read -r mean worst off < <("$work/same" "$work/a.pfm" "$work/b.pfm")
    verdict=
    awk "BEGIN { exit !($mean < 0.0005 && $off == 0) }" || { verdict=' MISSED'; failures=1; }
    printf '%-44s %10s %8s %8s %10s %10s%s\n' "$(basename "$model")" "$mean" "$worst" "$off" "$(seconds "$work/a.json")" "$(seconds "$work/b.json")" "$verdict"
done
exit $failures
