#!/bin/bash
# gnomon render --frames: numbered files, each the same bytes as a single picture from the same place, shadows paid for once.
# Prints PASS, FAIL or SKIP lines; GNOMON names the tool.
set -u
gnomon=${GNOMON:-$PWD/build/gnomon}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

scene() { # file, path
    cat >"$1" <<S
gnomon: 1
image: {width: 64, height: 48, background: [0.1, 0.2, 0.3]}
camera: {eye: [0, -6, 2], target: [0, 0, 0.5], fov: 40$2}
ambient: 0.2
lights: [{type: point, position: [1, -2, 4]}]
objects:
  - {polygon: [[-2,-2,0],[2,-2,0],[2,2,0],[-2,2,0]]}
  - {sphere: {center: [0,0,1], radius: 0.5}}
S
}
scene still.yaml ''
scene turn.yaml ', path: {frames: 4}'
scene keys.yaml ', path: {keys: [{frame: 1}, {frame: 3, eye: [4, -6, 4], fov: 50}]}'

verdict() { # name, then a test command
    local name=$1
    shift
    if "$@"; then
        echo "PASS frames: $name"
    else
        echo "FAIL frames: $name"
        failures=1
        echo "  status $status; standard error:"
        sed 's/^/  | /' err
    fi
}
run() { "$gnomon" render "$@" >out 2>err; status=$?; }
done_well() { [ $status -eq 0 ] && [ ! -s err ]; }
wrong_usage() { [ $status -eq 2 ] && grep -q '^gnomon: ' err; }
refused() { [ $status -eq 1 ] && grep -q "$1" err; }
count() { find . -name "$1" | wc -l; }

run turn.yaml -o 't%03d.png'; verdict 'a number in the name means all frames' eval 'done_well && [ $(count "t???.png") = 4 ] && [ -s t000.png ] && [ -s t003.png ]'
run still.yaml -o s.png; verdict 'first frame of a turntable is the camera' cmp -s s.png t000.png
run still.yaml -o s.png --set camera.eye=[6,0,2]; verdict 'a quarter turn later' cmp -s s.png t001.png
run turn.yaml -o one.png --frames 2; cp t002.png two.png; verdict 'one frame alone' cmp -s one.png two.png
run keys.yaml -o 'k%d.png' -o 'k%d.pfm' --frames all --threads 1; verdict 'frames between keys, two formats' eval 'done_well && [ $(count "k?.png") = 4 ] && [ $(count "k?.pfm") = 4 ]'
run still.yaml -o s.pfm --set camera.eye=[2,-6,3] --set camera.fov=45; verdict 'half-way between two keys' cmp -s s.pfm k2.pfm
run still.yaml -o s.pfm; verdict 'before the first key' cmp -s s.pfm k0.pfm
run keys.yaml -o k.pfm; verdict 'without a number: the first frame' cmp -s k.pfm k0.pfm
run turn.yaml -o 'r%d.png' --frames 1:2; verdict 'a range' eval 'done_well && [ ! -e r0.png ] && [ -s r1.png ] && [ -s r2.png ] && [ ! -e r3.png ]'
run turn.yaml --frames all; verdict 'default names' eval 'done_well && [ -s turn_0000.png ] && [ -s turn_0003.png ]'
run turn.yaml -o 'u%d.png' --stats -
verdict 'shadows are paid for once' eval 'done_well && [ $(grep -c "\"shadows_built\": 0" out) = 3 ] && grep -q "\"frame\": 0.*\"shadows_built\": 1" out'
if command -v python3 >/dev/null; then
    verdict 'statistics are JSON with frames and totals' python3 -c '
import json
s = json.load(open("out"))
f = s["frames"]
assert [x["frame"] for x in f] == [0, 1, 2, 3]
assert s["counts"]["spans"] == sum(x["counts"]["spans"] for x in f)
assert s["seconds"]["total"] > 0'
else
    echo 'SKIP frames: statistics as JSON: no python3'
fi
run still.yaml -o 'x%d.png' --frames all; verdict 'a scene without a path' refused 'no camera.path'
run turn.yaml -o 'x%d.png' --frames 2:4; verdict 'a frame beyond the path' refused '0 to 3'
run turn.yaml -o x.png --frames all; verdict 'no place for the number' eval 'wrong_usage && [ ! -e x.png ]'
for wrong in 'some' '-1' '3:1' '1:' ':1' '1:2:3' '99999999999'; do
    run turn.yaml -o 'x%d.png' --frames "$wrong"
    verdict "wrong usage: --frames $wrong" wrong_usage
done
exit $failures
