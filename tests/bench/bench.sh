#!/usr/bin/env bash
# gnomon and its peers side by side, on the same views, in one run: seconds by stage, error against converged references, the peers' curves,
# the shadow matrix, small scenes, second views. Prints Markdown; writes report.md, bench.csv and bench.svg into OUT.
#
# usage: tests/bench/bench.sh [WORD...]     or: make bench BENCH='WORD...'
#   full (default)   everything: takes about an hour, the first time longer for the references
#   quick            room, bunny and a small town at 1920x1080, a small matrix: some minutes
#   matrix, small, views, or a scene (room bunny sponza town-1k town-10k town-100k town-1m dragon): that alone
#   growth           the tables of docs/growth.md (growth.sh)
#   textures         what textures and bumps cost on Sponza (textures.sh)
#   clip             the clipper beside Clipper and GEOS (clip.sh)
#   pieces           lit and visible pieces of towns (pieces.sh)
# Embree and POV-Ray are installed from Debian when they are missing (INSTALL=0: not); what cannot be had is skipped and said so.
#   GNOMON  the tool (build/gnomon)     REPEATS  runs of each, alternating (3)     OUT  where files go and references are kept (build/bench)
#   GNOMON_SHARED  the folder with data/ and peers/ (../shared)     CC  compiler (cc)
# Times are wall-clock; the least and the median of the repeats are told. Exit status 1 when an error bound, the
# 15 ms or what the matrix is held to are missed.
set -euo pipefail
cd "$(dirname "$0")/../.."
export GNOMON=${GNOMON:-$PWD/build/gnomon} SHARED=${GNOMON_SHARED:-../shared} OUT=${OUT:-build/bench}
words=()
for word in "$@"; do
    case $word in
        growth | textures | clip | pieces) bash "tests/bench/$word.sh" || status=1 ;;
        *) words+=("$word") ;;
    esac
done
[ $# -gt 0 ] && [ ${#words[@]} -eq 0 ] && exit "${status:-0}"
[ -x "$GNOMON" ] || { echo "SKIP bench: $GNOMON is missing: run make first"; exit 0; }
command -v python3 >/dev/null || { echo "SKIP bench: python3 is missing"; exit 0; }
mkdir -p "$OUT"
OUT=$(realpath "$OUT") SHARED=$(realpath -m "$SHARED")

# ---- packages, for the benchmark only ------------------------------------------------------------------------------------
missing=''
[ -f /usr/include/embree3/rtcore.h ] || missing="$missing libembree-dev"
command -v povray >/dev/null || missing="$missing povray"
command -v xz >/dev/null || missing="$missing xz-utils"
if [ -n "$missing" ] && [ "${INSTALL:-1}" != 0 ] && command -v apt-get >/dev/null; then
    sudo=''
    [ "$(id -u)" = 0 ] || sudo='sudo -n'
    echo "installing for the benchmark:$missing" >&2
    # shellcheck disable=SC2086
    { $sudo apt-get update -q && $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing; } \
        >"$OUT/install.log" 2>&1 || echo "bench: they could not be installed: see $OUT/install.log" >&2
fi

# ---- programs ------------------------------------------------------------------------------------------------------------
include=$(pkg-config --cflags OpenEXR 2>/dev/null | tr ' ' '\n' | grep '^-I' || echo "-I/usr/include/OpenEXR -I/usr/include/Imath")
export COMPARE=$OUT/compare TOWN=$OUT/town PEER=$OUT/embree_peer POVRAY
# shellcheck disable=SC2086
${CC:-cc} -std=c11 -O2 -D_POSIX_C_SOURCE=200809L -Itests $include tests/bench/compare.c tests/support/compare.c -o "$COMPARE" -lOpenEXRCore -lm
${CC:-cc} -std=c11 -O2 -D_POSIX_C_SOURCE=200809L tests/bench/town.c -o "$TOWN" -lm
source=$SHARED/peers/embree_peer.c # it includes itself by name, so it wants its full path
if [ ! -f "$source" ]; then
    echo "SKIP Embree: $source is missing (set GNOMON_SHARED)" && PEER=
elif ! ${CC:-cc} -std=gnu11 -O3 -march=native -mprefer-vector-width=512 -ffast-math -fopenmp "$source" -o "$PEER" -lembree3 -lm 2>"$OUT/peer.log"; then
    echo "SKIP Embree: the peer does not build: $(head -1 "$OUT/peer.log")" && PEER=
fi
POVRAY=$(command -v povray || true)
PYTHONDONTWRITEBYTECODE=1 python3 tests/bench/bench.py "${words[@]}" || status=1
exit "${status:-0}"
