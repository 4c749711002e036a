#!/usr/bin/env bash
# Error and time of `gnomon render` on the reference views, beside Embree (shared/peers/embree_peer.c) at 4 samples a pixel.
#
# usage: tests/bench/reference.sh [VIEW...]        views: cornell bunny dragon (all)
# Needs, beside the repository or where GNOMON_SHARED says, the folder `shared` with data/reference and peers, and Debian's
# libembree-dev, libopenexr-dev and xz-utils; without them it says so and measures what it can.
#   GNOMON    the tool (build/gnomon)       REPEATS  runs of each, alternating (3)       CC  compiler (cc)
# Times are seconds on one thread, least and median. gnomon's leave loading out; "all" has everything else in it, writing the
# picture too, which the peer does not do. The peer's are its BVH and its tracing. Ratios are of the least times.
# Exit status 1 when a bound is missed.
set -euo pipefail
cd "$(dirname "$0")/../.."
shared=${GNOMON_SHARED:-../shared}
gnomon=${GNOMON:-build/gnomon}
repeats=${REPEATS:-3}
data=$shared/data/reference

skip() { echo "SKIP reference views: $1"; exit 0; }
[ -x "$gnomon" ] || skip "$gnomon is missing: run make first"
[ -d "$data" ] || skip "$data is missing (set GNOMON_SHARED)"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# ---- tools -----------------------------------------------------------------------------------------------------------
# OpenEXRCore alone is linked; its include path is the only thing wanted from OpenEXR's module.
include=$(pkg-config --cflags OpenEXR 2>/dev/null | tr ' ' '\n' | grep '^-I' || echo "-I/usr/include/OpenEXR -I/usr/include/Imath")
# shellcheck disable=SC2086
${CC:-cc} -std=c11 -O2 -D_POSIX_C_SOURCE=200809L -Itests $include tests/bench/compare.c tests/support/compare.c \
    -o "$work/compare" -lOpenEXRCore -lm || skip "tests/bench/compare.c does not build (libopenexr-dev?)"

peer=$work/embree_peer
if [ ! -f "$shared/peers/embree_peer.c" ]; then
    peer='' && echo "SKIP the peer: $shared/peers/embree_peer.c is missing"
# it includes itself by name, so it wants its full path
elif ! ${CC:-cc} -std=gnu11 -O3 -march=native -mprefer-vector-width=512 -ffast-math -fopenmp \
    "$(realpath "$shared/peers/embree_peer.c")" -o "$peer" -lembree3 -lm 2>"$work/peer.log"; then
    peer='' && echo "SKIP the peer: it does not build (libembree-dev?): $(head -1 "$work/peer.log")"
fi

# ---- measuring ---------------------------------------------------------------------------------------------------------
json() { sed -n "s/.*\"$1\": *\([0-9.e+-]*\).*/\1/p" "$2" | head -1; }
least() { sort -g "$1" | head -1; }
median() { sort -g "$1" | awk '{ v[NR] = $1 } END { print NR % 2 ? v[(NR + 1) / 2] : (v[NR / 2] + v[NR / 2 + 1]) / 2 }'; }
verdict() { awk -v a="$1" -v b="$2" 'BEGIN { print (a + 0 <= b + 0) ? "PASS" : "FAIL" }'; }

# RMS error of the peer at 64 samples a pixel, from the README beside the views.
bound() { case $1 in cornell) echo .00036 ;; bunny) echo .00017 ;; dragon) echo .00024 ;; *) echo 0 ;; esac; }

prepare() {
    for file in "$data/$1".*; do
        case $file in
        *.obj.xz) xz -dc "$file" >"$work/$1.obj" ;;
        *) ln -sf "$(realpath "$file")" "$work/" ;;
        esac
    done
}

measure() {
    local view=$1 i t
    rm -f "$work"/{all,draw,peer}.times
    for ((i = 0; i < repeats; i++)); do
        "$gnomon" render "$work/$view.yaml" -o "$work/out.pfm" --threads 1 --quiet --stats "$work/stats.json"
        t=$(json total "$work/stats.json")
        awk -v t="$t" -v l="$(json load "$work/stats.json")" 'BEGIN { print t - l }' >>"$work/all.times"
        awk -v t="$t" -v l="$(json load "$work/stats.json")" -v w="$(json write "$work/stats.json")" \
            'BEGIN { print t - l - w }' >>"$work/draw.times"
        [ -z "$peer" ] && continue
        "$peer" "$work/$view.json" -s 4 -t 1 >"$work/peer.json"
        awk -v b="$(json build_s "$work/peer.json")" -v t="$(json trace_best_s "$work/peer.json")" 'BEGIN { print b + t }' \
            >>"$work/peer.times"
    done
}

failed=0
printf '| view | RMS error | bound | | gnomon all | without writing | Embree, 4 samples | ratio | |\n'
printf '|---|---|---|---|---|---|---|---|---|\n'
for view in ${*:-cornell bunny dragon}; do
    [ -f "$data/$view.yaml" ] || { echo "SKIP $view: no $view.yaml in $data"; continue; }
    prepare "$view"
    measure "$view"
    rms=$("$work/compare" "$work/out.pfm" "$data/$view.exr" | cut -d' ' -f1)
    good=$(verdict "$rms" "$(bound "$view")")
    all=$(least "$work/all.times")
    their='-' ratio='-' fast='-'
    if [ -n "$peer" ]; then
        their="$(least "$work/peer.times") / $(median "$work/peer.times")"
        ratio=$(awk -v a="$all" -v b="$(least "$work/peer.times")" 'BEGIN { printf "%.2f", a / b }')
        fast=$(verdict "$ratio" 1)
    fi
    printf '| %s | %s | %s | %s | %s / %s | %s / %s | %s | %s | %s |\n' "$view" "$rms" "$(bound "$view")" "$good" \
        "$all" "$(median "$work/all.times")" "$(least "$work/draw.times")" "$(median "$work/draw.times")" "$their" "$ratio" "$fast"
    case $good$fast in *FAIL*) failed=1 ;; esac
    rm -f "$work/$view.obj"
done
exit $failed
