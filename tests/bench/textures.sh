#!/usr/bin/env bash
# What textures cost: Sponza at 1920x1080 plain, with its pictures, and with its pictures as bumps too; user seconds of the whole run with one
# thread, the least of REPEATS runs, taken in turns. Prints a table.
#
# usage: tests/bench/textures.sh     or: make bench BENCH=textures
#   GNOMON  the tool (build/gnomon)     REPEATS  runs of each (3)     GNOMON_SHARED  the folder with data/ (../shared)
set -euo pipefail
cd "$(dirname "$0")/../.."
GNOMON=${GNOMON:-$PWD/build/gnomon}
MODEL=$(realpath -m "${GNOMON_SHARED:-../shared}/data/scenes/sponza_dabrovic")
[ -x "$GNOMON" ] || { echo "SKIP textures: $GNOMON is missing: run make first"; exit 0; }
[ -f "$MODEL/sponza.obj" ] || { echo "SKIP textures: $MODEL is missing"; exit 0; }
WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT

for kind in plain pictures bumps; do
    mkdir "$WORK/$kind"
    ln -s "$MODEL/sponza.obj" "$MODEL/textures" "$WORK/$kind/"
done
grep -v '^map_' "$MODEL/sponza.mtl" > "$WORK/plain/sponza.mtl"
grep -v '^map_bump' "$MODEL/sponza.mtl" > "$WORK/pictures/sponza.mtl"
cp "$MODEL/sponza.mtl" "$WORK/bumps/sponza.mtl"

seconds() {
    local TIMEFORMAT=%U
    { time "$GNOMON" render "$WORK/$1/sponza.obj" -o "$WORK/out.png" --size 1920x1080 --threads 1 --quiet \
        --set 'camera.eye=[0.150078,1.55762,-1.3782]' --set 'camera.target=[-1.74203,2.72296,-0.966935]' --set 'camera.up=[0,1,0]' \
        --set camera.fov=58 --set 'ambient=[0.3,0.32,0.36]' \
        --set 'lights=[{position: [-25.8,56.1,11.6], intensity: 0.9}, {position: [0.15,1.55,-1.37], intensity: 0.25}]' 2>/dev/null; } 2>&1
}

declare -A least
for ((i = 0; i < ${REPEATS:-3}; i++)); do
    for kind in plain pictures bumps; do
        now=$(seconds $kind)
        if [ -z "${least[$kind]:-}" ] || [ "$(echo "$now < ${least[$kind]}" | bc)" = 1 ]; then least[$kind]=$now; fi
    done
done
echo '| Sponza, 1920 x 1080, one thread | seconds | of plain |'
echo '|---|---|---|'
for kind in plain pictures bumps; do
    echo "| $kind | ${least[$kind]} | $(echo "scale=2; ${least[$kind]} / ${least[plain]}" | bc) |"
done
