#!/bin/sh
# Renders every scene in scenes/ to docs/gallery/*.png and writes docs/gallery.md: `make gallery`.
# Each picture has the scene's own shape and $WIDTH pixels; what stands below it is the comment on top of the scene file.
set -eu
cd "$(dirname "$0")/.."
gnomon=${GNOMON:-build/gnomon}
width=${WIDTH:-440}
page=docs/gallery.md
mkdir -p docs/gallery

# The number behind a key of the scene's `image:` line, or a default.
number() { sed -n "/^image:/s/.*$1: *\([0-9]*\).*/\1/p" "$2" | grep . || echo "$3"; }

{
    echo '# Gallery'
    echo
    echo 'Every scene of `scenes/`, made by `make gallery`. A picture alone: `gnomon render scenes/NAME.yaml`.'
} >"$page.new"

for scene in scenes/*.yaml; do
    name=$(basename "$scene" .yaml)
    w=$(number width "$scene" 1280)
    h=$(number height "$scene" 720)
    "$gnomon" render "$scene" --quiet --size "${width}x$((h * width / w))" -o "docs/gallery/$name.png"
    text=$(awk '/^#/ { if ($0 !~ /Written by/) { sub(/^# */, ""); print } next } { exit }' "$scene")
    {
        echo
        echo "## $name"
        echo
        echo "![$name](gallery/$name.png)"
        echo
        echo "$text"
        echo
        echo "[scenes/$name.yaml](../scenes/$name.yaml)"
    } >>"$page.new"
    echo "docs/gallery/$name.png"
done

# Pictures of scenes that went away.
for picture in docs/gallery/*.png; do
    [ -f "scenes/$(basename "$picture" .png).yaml" ] || rm -f "$picture"
done
mv "$page.new" "$page"
echo "$page"
