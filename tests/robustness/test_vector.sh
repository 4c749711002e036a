#!/bin/bash
# gnomon vector and its contract with shells: exit statuses, messages, standard output, files whole or not at all; that other
# programs take what it writes. Prints a PASS, FAIL or SKIP line a check; GNOMON names the tool.
set -u
gnomon=${GNOMON:-$PWD/build/gnomon}
scenes=$PWD/scenes
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

cat >scene.yaml <<'S'
gnomon: 1
image: {width: 64, height: 48, background: [0.1, 0.2, 0.3]}
camera: {type: perspective, eye: [0, -5, 2], target: [0, 0, 0], up: [0, 0, 1], fov: 40}
lights:
  - {name: lamp, type: point, position: [1, -2, 4], intensity: [0.8, 0.8, 0.8]}
materials:
  stone: {diffuse: [0.5, 0.5, 0.5]}
objects:
  - {name: floor, polygon: [[-2,-2,0],[2,-2,0],[2,2,0],[-2,2,0]], material: stone}
  - {name: sign, polygon: [[-0.5,0,0.5],[0.5,0,0.5],[0.5,0,1],[-0.5,0,1]]}
S

verdict() { # name, then a test command
    local name=$1
    shift
    if "$@"; then
        echo "PASS vector: $name"
    else
        echo "FAIL vector: $name"
        failures=1
        echo "  status $status; standard error:"
        sed 's/^/  | /' err
    fi
}

run() { # runs the tool; leaves status, files out and err
    "$gnomon" vector "$@" >out 2>err
    status=$?
}

wrong_usage() { [ $status -eq 2 ] && grep -q '^gnomon: ' err && grep -q -- '--help' err && [ ! -s out ]; }
refused() { [ $status -eq 1 ] && grep -q '^gnomon: ' err && grep -q "$1" err; }
done_well() { [ $status -eq 0 ] && [ ! -s err ]; }
clean_folder() { [ -z "$(find . -name '*.tmp*' -o -name '.gnomon*')" ]; }

# ---- help and wrong usage
run --help; verdict 'help' eval 'done_well && grep -q -- --edges out'
run; verdict 'no scene' wrong_usage
run scene.yaml scene.yaml; verdict 'two scenes' wrong_usage
run scene.yaml -o a.png; verdict 'a picture extension' wrong_usage
run scene.yaml -o -; verdict 'standard output without a format' wrong_usage
for wrong in '--edges some' '--edge-width 0' '--edge-width x' '--edge-colour 1,2' '--edge-colour 1,2,3,4' '--edge-colour 1,2,-3' \
    '--crease 181' '--background blue' '--underlay some' '--digits 10' '--format png' '--size 5' '--exposure -1' '--threads 1.5' '--set x' \
    '--edgse all'; do
    # shellcheck disable=SC2086
    run scene.yaml -o a.svg $wrong; verdict "$wrong" eval 'wrong_usage && [ ! -e a.svg ]'
done

# ---- failures leave nothing
run missing.yaml -o a.svg; verdict 'missing scene' eval 'refused missing.yaml && [ ! -e a.svg ]'
run scene.yaml -o nowhere/a.svg; verdict 'missing folder' refused nowhere
mkdir taken.svg; run scene.yaml -o taken.svg; verdict 'a folder of that name' refused taken.svg
verdict 'no half files' clean_folder
if [ -w /dev/full ]; then
    "$gnomon" vector scene.yaml --format svg -o - >/dev/full 2>err; status=$?
    verdict 'a full disk' refused 'standard output'
else
    echo 'SKIP vector: a full disk: no /dev/full'
fi

# ---- what comes out
run scene.yaml; verdict 'named after the scene' eval 'done_well && [ -s scene.svg ]'
run scene.yaml --format svg -o -; verdict 'standard output, the same bytes' eval 'done_well && cmp -s out scene.svg'
run scene.yaml --threads 1 -o b.svg -o b.pdf; verdict 'two files; one thread' eval 'done_well && cmp -s b.svg scene.svg && [ -s b.pdf ]'
verdict 'floor lit and dark, sign: three shapes' eval '[ "$(grep -c data-polygon scene.svg)" -eq 3 ]'
verdict 'names of object, material and light' eval 'grep -q "data-object=\"floor\" data-material=\"stone\" data-lights=\"lamp\"" scene.svg'
run scene.yaml --size 320x200 --title 'A & B' -o c.svg; verdict 'size and title' \
    eval 'done_well && grep -q "width=\"320\" height=\"200\"" c.svg && grep -q "<title>A &amp; B</title>" c.svg'
run scene.yaml --edges all --edge-width 2 --edge-colour 1,0,0 -o d.svg; verdict 'edges' \
    eval 'done_well && grep -q "stroke=\"#ff0000\" stroke-width=\"2\"" d.svg'
LC_ALL=de_DE.UTF-8 "$gnomon" vector scene.yaml -o e.svg 2>err; status=$?
verdict 'another locale, the same bytes' cmp -s e.svg scene.svg
run "$scenes/town.yaml" --size 320x180 -o town.svg; verdict 'a whole scene' done_well

# ---- other programs
if command -v xmllint >/dev/null; then
    xmllint --noout town.svg d.svg 2>err; status=$?
    verdict 'xmllint takes them' [ $status -eq 0 ]
else
    echo 'SKIP vector: xmllint: not installed'
fi
if command -v rsvg-convert >/dev/null; then
    rsvg-convert town.svg -o town.png 2>err; status=$?
    verdict 'rsvg-convert draws it' eval '[ $status -eq 0 ] && [ -s town.png ]'
else
    echo 'SKIP vector: rsvg-convert: not installed (librsvg2-bin)'
fi
if command -v pdftoppm >/dev/null; then
    pdftoppm -r 96 b.pdf b 2>err; status=$?
    verdict 'pdftoppm draws the PDF at its size' eval '[ $status -eq 0 ] && [ "$(head -c 9 b-1.ppm | tr "\n" " ")" = "P6 64 48 " ]'
else
    echo 'SKIP vector: pdftoppm: not installed (poppler-utils)'
fi
exit $failures
