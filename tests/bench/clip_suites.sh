#!/usr/bin/env bash
# Public suites of polygon operations through the clipper: see clip_suites.c. usage: tests/bench/clip_suites.sh FILE...
# GEOS's files are tests/xmltester/tests/*/*.xml of its source, Clipper2's is Tests/Polygons.txt; none of them are kept here.
# Environment: BUILD, CC. Debian's libgeos-dev is installed if missing.
set -u
[ $# -gt 0 ] || { echo "usage: clip_suites.sh FILE..." >&2; exit 2; }
files=()
for file in "$@"; do files+=("$(realpath "$file")"); done
cd "$(dirname "$0")/../.." || exit 1
build=${BUILD:-build}
out=$build/bench
if ! dpkg-query -W -f='${Status}' libgeos-dev 2>/dev/null | grep -q '^install ok installed'; then
    apt-get install -y -q --no-install-recommends libgeos-dev >/dev/null || { echo "clip_suites.sh: needs libgeos-dev" >&2; exit 1; }
fi
mkdir -p "$out"
make -s "$build/libgnomon.a" || exit 1
${CC:-gcc} -D_GNU_SOURCE -O2 -Wall -Wextra -Iinclude -Itests tests/bench/clip_suites.c tests/support/shapes.c tests/support/slabs.c \
    "$build/libgnomon.a" -lgeos_c -lm -pthread -o "$out/clip_suites" || exit 1
"$out/clip_suites" "${files[@]}"
