#!/usr/bin/env bash
# Drawings beside pictures: gnomon vector's SVG as rsvg-convert draws it and its PDF as pdftoppm does, beside gnomon render's PNG.
# usage: tests/bench/vector.sh [SCENE...]        all of scenes/ with flat shading and no area light by default
#   GNOMON  the tool (build/gnomon)     SIZE  of the pictures (1280x720)     KEEP  a folder to leave drawings and pictures in
# For each: mean and greatest difference of encoded values, pixels that differ by more than 0.01 away from edges, shapes in the drawing, its
# kilobytes, seconds. Then a scene of one colour in many pieces: a viewer that shows seams has pixels of another colour. Held to none.
set -u
cd "$(dirname "$0")/../.." || exit 1
gnomon=${GNOMON:-build/gnomon}
size=${SIZE:-1280x720}
[ -x "$gnomon" ] || { echo "SKIP drawings: $gnomon is missing: run make first"; exit 0; }
for viewer in rsvg-convert pdftoppm; do
    command -v $viewer >/dev/null || { echo "SKIP drawings: $viewer is missing (librsvg2-bin, poppler-utils)"; exit 0; }
done
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
out=${KEEP:-$work}
# shellcheck disable=SC2046
${CC:-cc} -std=c11 -O2 tests/bench/same.c -o "$work/same" $(pkg-config --cflags --libs libpng) -lm || exit 1
failures=0

draw() { # scene name: NAME.png, NAME.svg.png, NAME.pdf.png, and seconds of the drawing
    "$gnomon" render "$1" --size "$size" --lines 16 -o "$out/$2.png" --quiet || return 1
    begun=$(date +%s.%N)
    "$gnomon" vector "$1" --size "$size" -o "$out/$2.svg" --quiet || return 1
    seconds=$(awk "BEGIN { printf \"%.2f\", $(date +%s.%N) - $begun }")
    "$gnomon" vector "$1" --size "$size" -o "$out/$2.pdf" --quiet || return 1
    rsvg-convert "$out/$2.svg" -o "$out/$2.svg.png" && pdftoppm -r 96 -png -singlefile "$out/$2.pdf" "$out/$2.pdf"
}

printf '%-24s %-8s %10s %9s %9s %8s %8s %8s\n' scene viewer mean greatest off-edge shapes KB seconds
scenes=("$@")
[ $# -gt 0 ] || scenes=(scenes/crossing.yaml scenes/house.yaml scenes/town.yaml scenes/sundial.yaml)
for scene in "${scenes[@]}"; do
    name=$(basename "$scene" .yaml)
    draw "$scene" "$name" || { failures=1; continue; }
    for kind in svg pdf; do
        read -r mean worst off < <("$work/same" "$out/$name.png" "$out/$name.$kind.png")
        printf '%-24s %-8s %10s %9s %9s %8s %8s %8s\n' "$name" $kind "$mean" "$worst" "$off" "$(grep -c data-polygon "$out/$name.svg")" \
            "$(($(wc -c <"$out/$name.$kind") / 1024))" "$seconds"
    done
done

# 40 x 30 tilted quadrilaterals of one colour, which fill the picture, before a background of another.
awk 'BEGIN {
    print "gnomon: 1\nimage: {background: [1, 0, 0]}\ncamera: {type: orthographic, eye: [0,0,5], target: [0,0,0], up: [0,1,0], height: 6}"
    print "ambient: [1,1,1]\nmaterials: {grey: {ambient: [0.3,0.3,0.3], diffuse: [0,0,0]}}\nobjects:"
    for (i = -20; i < 20; i++) for (j = -15; j < 15; j++) {
        printf "  - {material: grey, polygon: [";
        split("0 0 1 0 1 1 0 1", c, " ");
        for (k = 0; k < 4; k++) printf "%s[%.6f,%.6f,0]", k ? "," : "", (i+c[2*k+1])*0.431+(j+c[2*k+2])*0.113, (j+c[2*k+2])*0.397-(i+c[2*k+1])*0.071;
        print "]}" } }' >"$work/seams.yaml"
draw "$work/seams.yaml" seams || exit 1
for kind in svg pdf; do
    read -r mean worst off < <("$work/same" "$out/seams.png" "$out/seams.$kind.png")
    verdict=
    awk "BEGIN { exit !($worst < 0.006) }" || { verdict=' SEAMS'; failures=1; }
    printf '%-24s %-8s %10s %9s%s\n' 'one colour, 1,200 pieces' $kind "$mean" "$worst" "$verdict"
done
exit $failures
