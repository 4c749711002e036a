#!/bin/bash
# gnomon matrix on the command line: formats, names, lights, statistics, wrong usage. Prints PASS, FAIL or SKIP lines; GNOMON names the tool.
set -u
gnomon=${GNOMON:-$PWD/build/gnomon}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

cat >scene.yaml <<'S'
gnomon: 1
lights:
  - {name: sun, type: directional, direction: [0, 0, -1]}
  - {name: a/b, type: point, position: [0, 0, 0.5]}
objects:
  - {name: floor, polygon: [[-2,-2,0],[2,-2,0],[2,2,0],[-2,2,0]]}
  - {name: plate, polygon: [[-1,-1,1],[1,-1,1],[1,1,1],[-1,1,1]]}
S
printf 'gnomon: 1\nobjects:\n  - {polygon: [[-2,-2,0],[2,-2,0],[2,2,0]]}\n' >dark.yaml

verdict() { # name, then a test command
    local name=$1
    shift
    if "$@"; then
        echo "PASS matrix: $name"
    else
        echo "FAIL matrix: $name"
        failures=1
        echo "  status $status; standard error:"
        sed 's/^/  | /' err
    fi
}
run() { "$gnomon" matrix "$@" >out 2>err; status=$?; }
wrong_usage() { [ $status -eq 2 ] && grep -q '^gnomon: ' err && grep -q -- '--help' err && [ ! -s out ]; }
refused() { [ $status -eq 1 ] && grep -q '^gnomon: ' err && grep -q "$1" err; }
done_well() { [ $status -eq 0 ] && [ ! -s err ]; }
entries() { grep -v '^%' "$1" | tr '\n' ';'; }

run --help; verdict 'help' eval 'done_well && grep -q -- --light out'
run scene.yaml; verdict 'standard output' eval 'done_well && [ "$(entries out)" = "2 2 1;2 1;" ] && [ "$(head -c 14 out)" = "%%MatrixMarket" ]'
run scene.yaml -o m.mtx; verdict 'file' eval 'done_well && [ "$(entries m.mtx)" = "2 2 1;2 1;" ] && [ ! -s out ]'
run scene.yaml --light a/b -o m.mtx; verdict 'another light' eval 'done_well && [ "$(entries m.mtx)" = "2 2 1;2 2;" ]'
run scene.yaml -o m.csv; verdict 'csv' eval 'done_well && [ "$(tr "\n" ";" <m.csv)" = "caster,receiver;1,0;" ]'
run scene.yaml -o m.png; verdict 'picture' eval 'done_well && [ "$(head -c 4 m.png | tail -c 3)" = PNG ]'
run scene.yaml -o 'm_%s.mtx'; verdict 'a file for each light' eval 'done_well && [ -s m_sun.mtx ] && [ -s m_a_b.mtx ]'
run scene.yaml -o 'n_%s.mtx' --light sun; verdict 'a file for one light' eval 'done_well && [ -s n_sun.mtx ] && [ ! -e n_a_b.mtx ]'
run scene.yaml -o m.mtx --stats -
verdict 'statistics' eval 'done_well && grep -q "\"false_ones\": {\"judged\": 1, \"false\": 0, \"share\": 0}" out && grep -q "\"ones\": 1" out'
"$gnomon" matrix scene.yaml --threads 1 -o one.mtx && "$gnomon" matrix scene.yaml --threads 3 -o three.mtx
verdict 'threads' cmp -s one.mtx three.mtx
run scene.yaml --light son; verdict 'misspelt light' refused 'did you mean "sun"'
run dark.yaml; verdict 'no light' refused 'no light'
run missing.yaml -o x.mtx; verdict 'scene that is not there' eval 'refused missing.yaml && [ ! -e x.mtx ]'
run scene.yaml -o nowhere/x.mtx; verdict 'folder that is not there' refused nowhere
run; verdict 'no scene' wrong_usage
for wrong in '-o m.jpg' '-o m' '-o m_%d.mtx' '-o m_%s_%s.mtx' '--threads -1' '--threads x' '--stats -' '--set x' '--lights sun'; do
    # shellcheck disable=SC2086
    run scene.yaml $wrong
    verdict "wrong usage: $wrong" wrong_usage
done
exit $failures
