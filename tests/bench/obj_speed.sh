#!/bin/sh
# How fast OBJ files are read, from path to scene, in MB/s of file size; best of RUNS (5) runs, one CSV line a file.
# usage: tests/bench/obj_speed.sh [FILE.obj...]      without files: the reference dragon and the large test scenes
# BUILD: where make put the libraries (build). GNOMON_DATA: the data folder (../shared/data beside the repository).
set -eu
cd "$(dirname "$0")/../.."
build=${BUILD:-build} data=${GNOMON_DATA:-../shared/data}
for library in "$build/libgnomon-io.a" "$build/libgnomon.a"; do
    [ -f "$library" ] || { echo "obj_speed.sh: $library is missing: run make first" >&2; exit 1; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
pkg() { pkg-config "$@" 2>/dev/null || true; }
# shellcheck disable=SC2046
${CC:-cc} -std=c11 -O2 -pthread -D_POSIX_C_SOURCE=200809L -Iinclude -Isrc tests/bench/obj_speed.c \
    "$build/libgnomon-io.a" "$build/libgnomon.a" $(pkg --libs yaml-0.1 assimp libpng libdeflate) -lOpenEXRCore -lm -o "$work/obj_speed"
if [ $# -eq 0 ]; then
    if [ -f "$data/reference/dragon.obj.xz" ]; then
        xz -dc "$data/reference/dragon.obj.xz" >"$work/dragon.obj"
        set -- "$work/dragon.obj"
    fi
    for file in "$data"/scenes/sponza_dabrovic/sponza.obj "$data"/scenes/city/*.obj "$data"/reference/bunny.obj; do
        [ -f "$file" ] && set -- "$@" "$file"
    done
    [ $# -gt 0 ] || { echo "obj_speed.sh: no files under $data" >&2; exit 1; }
fi
"$work/obj_speed" "${RUNS:-5}" "$@"
