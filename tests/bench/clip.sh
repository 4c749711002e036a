#!/usr/bin/env bash
# The clipper beside GEOS (areas, validity) and beside Clipper 6 and GEOS (times). usage: tests/bench/clip.sh [CASES [RUNS]]
# CASES of each family are compared (default 2000), times are the least of RUNS (default 5). Exit status 1 when anything disagrees
# or a bound is missed. Environment: BUILD, CC, CXX; CLIPPER2, a Clipper2Lib folder (CPP/Clipper2Lib of its source) to be measured in
# the place of Clipper 6, which Debian 12 does not have. Debian's libgeos-dev, libpolyclipping-dev and g++ are installed if missing.
set -u
cd "$(dirname "$0")/../.." || exit 1
build=${BUILD:-build} cases=${1:-2000} runs=${2:-5}
out=$build/bench
missing=
for package in libgeos-dev libpolyclipping-dev g++; do
    dpkg-query -W -f='${Status}' $package 2>/dev/null | grep -q '^install ok installed' || missing="$missing $package"
done
if [ -n "$missing" ]; then
    # shellcheck disable=SC2086
    apt-get install -y -q --no-install-recommends $missing >/dev/null || { echo "clip.sh: needs$missing" >&2; exit 1; }
fi
mkdir -p "$out"
make -s "$build/libgnomon.a" || exit 1
${CC:-gcc} -O2 -Wall -Wextra -Iinclude -Itests tests/bench/clip_geos.c tests/support/shapes.c tests/support/slabs.c "$build/libgnomon.a" -lgeos_c -lm -pthread \
    -o "$out/clip_geos" || exit 1
peer=(tests/bench/clip_peer.cpp)
[ -n "${CLIPPER2:-}" ] && peer=(-std=c++17 -DPEER_CLIPPER2 "-I$CLIPPER2/include" tests/bench/clip_peer.cpp "$CLIPPER2/src/clipper.engine.cpp")
${CXX:-g++} -O3 -Iinclude -Itests -r -nostdlib "${peer[@]}" -o "$out/clip_peer.o" || exit 1
${CC:-gcc} -O3 -Wall -Wextra -Iinclude -Itests tests/bench/clip_speed.c tests/support/shapes.c "$out/clip_peer.o" "$build/libgnomon.a" \
    -lgeos_c -lpolyclipping -lstdc++ -lm -pthread -o "$out/clip_speed" || exit 1
status=0
"$out/clip_speed" "$runs" || status=1
"$out/clip_geos" "$cases" || status=1
exit $status
