#!/bin/bash
# The examples of docs/examples: they compile as strict C89 and as C++98 against the libraries as built, run, and do what
# the documentation says; the README shows draw.c as it is. Prints a PASS or FAIL line a check.
set -u
root=$PWD
build=$(cd "${BUILD:-build}" && pwd) || exit 1
examples=$root/docs/examples
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

verdict() { # name, then a command
    local name=$1
    shift
    if "$@" >log 2>&1; then echo "PASS examples: $name"; else
        cat log
        echo "FAIL examples: $name"
        failures=1
    fi
}

io_libs=$(pkg-config --libs yaml-0.1 assimp libpng libdeflate 2>/dev/null || echo -lyaml -lassimp -lpng -ldeflate)
strict='-pedantic-errors -Wall -Wextra -Werror'

c89() { # name, libraries
    local name=$1
    shift
    # shellcheck disable=SC2086
    ${CC:-gcc} -std=c89 $strict -I"$root/include" "$examples/$name.c" -o "$name" "$@" -lm -pthread
}

cxx98() {
    # shellcheck disable=SC2086
    ${CXX:-g++} -std=c++98 -x c++ $strict -I"$root/include" "$examples/$1.c" -x none -o "$1-cxx" "$build/libgnomon.a" -lm -pthread
}

splits() {
    ./"$1" >out && printf '%s\n' '[0, 2) light 1 1 1' '[2, 5) light 0 0 0' '[5, 7) light 1 1 1' '[7, 10) light 0.2 0.9 0.2' | diff - out
}

clips() {
    ./"$1" >out && printf '%s\n' 'polygon (0, 0) (8, 0) (8, 2) (4, 2) (4, 1) (1, 1) (1, 4) (4, 4) (4, 3) (8, 3) (8, 6) (0, 6)' \
        '   hole (5, 4) (6, 5) (6, 4)' 'lit: 34.5 of 48' | diff - out
}

draws() { # program: a picture of the right size with light, shadow and background in it
    rm -f draw.ppm
    ./"$1" && [ "$(head -n 2 draw.ppm | tr '\n' ' ')" = 'P6 480 270 ' ] && [ "$(wc -c <draw.ppm)" -eq $((15 + 3 * 480 * 270)) ] &&
        [ "$(tail -c +16 draw.ppm | od -An -v -tu1 -w3 | sort -u | wc -l)" -ge 3 ]
}

loads() {
    ./files "$root/scenes/crossing.yaml" out.png && [ -s out.png ] && ! ./files missing.yaml out.png
}

asks() { # the wall's lit height is that below the overhang's shadow, 3.5 less the sun's slope; at sun 0 it ends where the wall does
    ./"$1" >out && printf '%s\n' "sun 0: 12.000000 of the wall's 12, proof holds" "sun 1: 10.000000 of the wall's 12, proof holds" \
        "sun 2: 8.000000 of the wall's 12, proof holds" "sun 3: 4.000000 of the wall's 12, proof holds" | diff - out
}

same_picture() {
    ./draw && mv draw.ppm c.ppm && ./draw-cxx && cmp c.ppm draw.ppm
}

row_by_row() { # a picture with at least the background, lit and dark stone in it
    ./rows && [ "$(head -n 2 rows.ppm | tr '\n' ' ')" = 'P6 320 200 ' ] && [ "$(wc -c <rows.ppm)" -eq $((15 + 3 * 320 * 200)) ] &&
        [ "$(tail -c +16 rows.ppm | od -An -v -tu1 -w3 | sort -u | wc -l)" -ge 3 ]
}

streams() {
    ./"$1" >out && printf '%s\n' '[0.00, 42.36) polygon 0, depth 8.02 to 8.02: [0.00, 42.36) lit' \
        '[42.36, 61.40) polygon 1, depth 4.82 to 8.02: [42.36, 61.40) dark' \
        '[61.40, 100.00) polygon 0, depth 8.02 to 8.02: [61.40, 72.90) dark [72.90, 100.00) lit' \
        'of all that is seen 83.93 % is lit' | diff - out
}

tower() {
    # shellcheck disable=SC2086
    ${CXX:-g++} -std=c++98 $strict -I"$root/include" "$examples/tower.cpp" -o tower "$build/libgnomon.a" -lm -pthread &&
        ./tower >out && grep -qx 'depth in the middle: 7.317' out
}

# The block of the README that begins with draw.c's first line.
shown() {
    awk 'on && /^```/ { exit } on || /^\/\* draw\.c/ { on = 1; print }' "$root/README.md" | diff "$examples/draw.c" -
}

verdict 'draw.c is C89' c89 draw "$build/libgnomon.a"
verdict 'draw.c draws' draws draw
verdict 'split.c is C89' c89 split "$build/libgnomon.a"
verdict 'split.c splits' splits split
verdict 'clip.c is C89' c89 clip "$build/libgnomon.a"
verdict 'clip.c clips' clips clip
verdict 'lit.c is C89' c89 lit "$build/libgnomon.a"
verdict 'lit.c finds lit areas' asks lit
verdict 'files.c is C89' c89 files "$build/libgnomon-io.a" "$build/libgnomon.a" $io_libs -lOpenEXRCore
verdict 'files.c loads and writes' loads
verdict 'rows.c is C89' c89 rows "$build/libgnomon.a"
verdict 'rows.c draws row by row' row_by_row
verdict 'spans.c is C89' c89 spans "$build/libgnomon.a"
verdict 'spans.c streams' streams spans
if command -v "${CXX:-g++}" >/dev/null; then
    verdict 'tower.cpp is C++98 and sees' tower
    verdict 'spans.c is C++98' cxx98 spans
    verdict 'spans.c streams from C++' streams spans-cxx
    verdict 'draw.c is C++98' cxx98 draw
    verdict 'draw.c draws the same from C++' same_picture
    verdict 'split.c is C++98' cxx98 split
    verdict 'split.c splits from C++' splits split-cxx
    verdict 'clip.c is C++98' cxx98 clip
    verdict 'clip.c clips from C++' clips clip-cxx
else
    echo "SKIP examples in C++: no ${CXX:-g++}"
fi
verdict 'README shows draw.c as it is' shown
exit $failures
