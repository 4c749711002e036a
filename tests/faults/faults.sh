#!/bin/bash
# Faults of every kind, counted: allocations of every public call and command, calls for files of every command, full disks, closed
# pipes, files that vanish, signals at random moments. Prints a PASS, FAIL or SKIP line for each, and the sums.
# usage: faults.sh quick|places|full    BUILD: where the programs are (build)
#   full: each allocation and call for a file by count; places: of commands, each place of the program that makes them, once, and fewer
#   signals, which do not depend on sanitizers; quick: a few
set -u
root=$PWD
build=$(cd "${BUILD:-build}" && pwd)
calls=$build/tests/faults/call_faults commands=$build/tests/faults/command_faults gnomon=$build/gnomon
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp "$root"/scenes/house.yaml "$root"/scenes/town.yaml "$root"/scenes/*.obj "$root"/scenes/*.mtl "$work"
cp -r "$root"/scenes/textures "$work"
cd "$work" || exit 1
mode=${1:-quick}
case $mode in
full) each_call=1 each_allocation=1 each_file=1 signals=200 ;;
places) each_call=1 each_allocation=1 each_file=1 signals=10 ;;
*) each_call=13 each_allocation=61 each_file=9 signals=3 ;;
esac
export ASAN_OPTIONS=exitcode=77:${ASAN_OPTIONS:-} UBSAN_OPTIONS=exitcode=77:print_stacktrace=1:${UBSAN_OPTIONS:-}

cat >small.yaml <<'S'
gnomon: 1
image: {width: 40, height: 30}
camera: {type: perspective, eye: [3, -6, 4], target: [0, 0, 0.5], up: [0, 0, 1], fov: 40}
lights:
  - {name: sun, type: directional, direction: [-0.4, 0.3, -1]}
  - {name: lamp, type: point, position: [2, -3, 4]}
materials:
  tiles: {diffuse: [1, 1, 1], texture: {image: textures/TEXTURE, map: planar}}
  glass: {transmission: 0.5}
objects:
  - {name: floor, polygon: [[-2,-2,0],[2,-2,0],[2,2,0],[-2,2,0]], material: tiles}
  - {mesh: cube.obj, transform: [{scale: 0.5}, {translate: [0, 0, 0.6]}]}
  - {name: pane, polygon: [[-1,-1,2],[1,-1,2],[1,1,2],[-1,1,2]], holes: [[[-0.5,-0.5,2],[0.5,-0.5,2],[0.5,0.5,2]]], material: glass}
S
texture=$(cd textures && ls -- *.png | head -1)
sed -i "s/TEXTURE/$texture/" small.yaml

# Every kind of output: KIND OF OUTPUT, FILE, ARGUMENTS.
outputs=(
    'picture.png render small.yaml -o picture.png --threads 1'
    'picture.exr render small.yaml -o picture.exr --aov depth,polygon --threads 1'
    'picture.pfm render small.yaml -o picture.pfm --engine weiler-atherton --threads 1'
    '- render small.yaml -o - --threads 1'
    'lit.csv lit small.yaml -q -o lit.csv --threads 1'
    'lit.obj lit small.yaml -q -o rest.csv --pieces lit.obj --threads 1'
    'lit.geojson lit small.yaml -q -o rest.csv --pieces lit.geojson --threads 1'
    'drawing.svg vector small.yaml -o drawing.svg --edges all --threads 1'
    'drawing.pdf vector small.yaml -o drawing.pdf --threads 1'
    'matrix.mtx matrix small.yaml -o matrix.mtx --threads 1'
    'matrix.csv matrix small.yaml -o matrix.csv --threads 1'
    'matrix.png matrix small.yaml -o matrix.png --check --threads 1'
    '- info small.yaml --json --threads 1'
    '- info cube.obj --threads 1'
)

failures=0 total=0
count() { # adds the faults of the lines it passes on
    while IFS= read -r line; do
        echo "$line"
        n=$(echo "$line" | sed -n 's/^[A-Z]* faults: .*: \([0-9]*\) faults.*/\1/p')
        total=$((total + ${n:-0}))
        case $line in FAIL*) failures=$((failures + 1)) ;; esac
    done
}
kind() { # name, STEP
    local before=$total
    for output in "${outputs[@]}"; do
        read -r file arguments <<<"$output"
        # shellcheck disable=SC2086
        [ "$mode" != places ] || export FAULT_PLACES=$work/places.$1
        count < <("$commands" "$1" "$2" "$file" -- $arguments 2>&1 || echo "FAIL faults: $1 of gnomon $arguments")
    done
    echo "faults: $1 of commands: $((total - before))"
}
verdict() { # name, then a test command
    local name=$1
    shift
    total=$((total + 1))
    if "$@"; then echo "PASS faults: $name"; else
        echo "FAIL faults: $name (status $status): $(head -c 300 err)"
        failures=$((failures + 1))
    fi
}
refused() { [ "$status" -eq 1 ] && grep -q '^gnomon: ' err; }

count < <("$calls" "$each_call" 2>&1 || echo 'FAIL faults: allocations of calls')
kind memory "$each_allocation"
kind files "$each_file"
kind signals "$signals"

# ---- the disk itself: a device that is full, a limit of file sizes, standard output full or closed
for output in "${outputs[@]}"; do
    read -r file arguments <<<"$output"
    if [ "$file" = - ]; then
        # shellcheck disable=SC2086
        "$gnomon" $arguments >/dev/full 2>err; status=$?
        verdict "full standard output: $arguments" refused
        # shellcheck disable=SC2086
        { "$gnomon" $arguments 2>err; echo $? >status; } | true; status=$(cat status)
        verdict "closed pipe: $arguments" eval 'refused || [ $status -eq 0 ]' # a short output fits into the pipe
        continue
    fi
    ln -sf /dev/full "full.${file##*.}"
    # shellcheck disable=SC2086
    "$gnomon" ${arguments//$file/full.${file##*.}} 2>err; status=$?
    verdict "full device: $arguments" refused
    rm -f "$file" "full.${file##*.}"
    # shellcheck disable=SC2086
    ( trap '' XFSZ; ulimit -f 0; exec "$gnomon" $arguments 2>/dev/null ); status=$?
    : >err; verdict "no room for a byte: $arguments" eval '[ $status -eq 1 ] && [ ! -e $file ] && [ -z "$(ls -A | grep "^.gnomon")" ]'
done

# ---- files that cannot be read, or vanish
for missing in small.yaml cube.obj; do
    mv $missing away
    "$gnomon" info small.yaml >out 2>err; status=$?
    verdict "no $missing" eval 'refused && grep -q "$missing" err'
    mkdir $missing
    "$gnomon" info small.yaml >out 2>err; status=$?
    verdict "$missing is a folder" refused
    rmdir $missing
    : >$missing
    "$gnomon" info small.yaml >out 2>err; status=$?
    verdict "$missing is empty" refused
    mv away $missing
done
mkdir gone
( cd gone && rmdir ../gone && "$gnomon" render ../small.yaml -o picture.png 2>../err ); status=$?
verdict 'the present folder is gone' refused

# ---- a reader that does not read: a signal ends the program all the same
if command -v mkfifo >/dev/null && command -v timeout >/dev/null; then
    cp small.yaml many.yaml
    for i in $(seq 900); do
        echo "  - {polygon: [[$i,0,0],[$i.5,0,0],[$i.5,1,0.3]]}"
    done >>many.yaml
    stuck=('render many.yaml --size 300x300 -o pipe.pfm' 'lit many.yaml -q -o pipe.csv' 'matrix town.yaml -o pipe.csv'
        'vector house.yaml -o pipe.svg' 'lit many.yaml -q -o rest.csv --pieces pipe.obj')
    for i in "${!stuck[@]}"; do
        ( # all at once: each waits for its signal
            pipe=pipes$i/pipe.${stuck[i]##*.}
            mkdir "pipes$i" && mkfifo "$pipe"
            ( exec 3<"$pipe"; sleep 10 ) &
            reader=$!
            # shellcheck disable=SC2086
            timeout --preserve-status -s TERM -k 5 3 "$gnomon" ${stuck[i]/pipe./pipes$i/pipe.} 2>/dev/null
            echo $? >"pipes$i/status"
            kill $reader
            wait $reader
        ) 2>/dev/null &
    done
    wait
    for i in "${!stuck[@]}"; do
        status=$(cat "pipes$i/status")
        verdict "a pipe that no one reads: ${stuck[i]}" [ "$status" -eq 143 ]
    done
else
    echo 'SKIP faults: pipes: no mkfifo or timeout'
fi

echo "faults: $total in all, $failures failures"
[ $failures -eq 0 ]
