#!/usr/bin/env bash
# Lit and visible pieces of towns of 1k, 10k, 60k and 100k polygons (boxes on a ground, one sun), one thread. A part of `make bench`.
set -euo pipefail
cd "$(dirname "$0")/../.."
build=${BUILD:-build}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
[ -f "$build/libgnomon-io.a" ] || { echo "SKIP pieces: $build/libgnomon-io.a is missing: run make first"; exit 0; }
libs=$(pkg-config --libs yaml-0.1 assimp libpng libdeflate cairo)
${CC:-cc} -std=c11 -O2 -D_POSIX_C_SOURCE=200809L tests/bench/town.c -o "$work/town" -lm
# shellcheck disable=SC2086
${CC:-cc} -std=c11 -O2 -D_POSIX_C_SOURCE=200809L -Iinclude tests/bench/pieces.c "$build/libgnomon-io.a" "$build/libgnomon.a" \
    $libs -lOpenEXRCore -lm -pthread -o "$work/pieces"
scenes=()
for n in ${TOWNS:-1000 10000 60000 100000}; do
    mkdir "$work/$n"
    "$work/town" "$n" 1 "$work/$n"
    scenes+=("$work/$n/town.yaml")
done
"$work/pieces" "${scenes[@]}"
