#!/bin/sh
# How soon every kind of long work answers a wish to stop; see cancel.c.
# usage: tests/bench/cancel.sh [SCENE [WIDTH HEIGHT THREADS TRIES]]    without: the reference dragon, 1920 1080 2 60
# WHAT: the kinds of work (render lit matrix visible info clip). BUILD: where make put the libraries (build).
# GNOMON_DATA: the data folder (../shared/data beside the repository).
set -eu
cd "$(dirname "$0")/../.."
build=${BUILD:-build} data=${GNOMON_DATA:-../shared/data}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
pkg() { pkg-config "$@" 2>/dev/null || true; }
# shellcheck disable=SC2046
${CC:-cc} -std=c11 -O2 -pthread -D_POSIX_C_SOURCE=200809L -Iinclude tests/bench/cancel.c "$build/libgnomon-io.a" "$build/libgnomon.a" \
    $(pkg --libs yaml-0.1 assimp libpng libdeflate cairo-pdf) -lOpenEXRCore -lm -o "$work/cancel"
if [ $# -eq 0 ]; then
    [ -f "$data/reference/dragon.obj.xz" ] || { echo "cancel.sh: no $data/reference/dragon.obj.xz" >&2; exit 1; }
    xz -dc "$data/reference/dragon.obj.xz" >"$work/dragon.obj"
    set -- "$work/dragon.obj"
fi
status=0
for what in ${WHAT:-render lit matrix visible info clip}; do
    "$work/cancel" "$what" "$1" "${2:-1920}" "${3:-1080}" "${4:-2}" "${5:-60}" || status=1
done
exit $status
