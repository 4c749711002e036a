#!/bin/bash
# gnomon lit: the table, the pieces, options, messages, files that appear whole or not at all. Prints a PASS or FAIL line a check.
set -u
gnomon=${GNOMON:-$PWD/build/gnomon}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

# A cube of side 2 on a floor of 100 x 100, a sun whose shadow of the top is moved by (2, 1), a panel of 2 x 2 lamps.
cat >cube.yaml <<'S'
gnomon: 1
lights:
  - {name: sun, type: directional, direction: [1, 0.5, -1], intensity: [1, 1, 1]}
  - {name: "lamp, \"left\"", type: area, position: [-9, -9, 30], edge1: [1, 0, 0], edge2: [0, 1, 0], samples: 2}
objects:
  - {name: floor, polygon: [[-50,-50,0],[50,-50,0],[50,50,0],[-50,50,0]]}
  - {name: "the, top", polygon: [[-1,-1,2],[1,-1,2],[1,1,2],[-1,1,2]]}
  - {name: west, polygon: [[-1,-1,0],[-1,-1,2],[-1,1,2],[-1,1,0]]}
  - {name: east, polygon: [[1,-1,0],[1,1,0],[1,1,2],[1,-1,2]]}
  - {name: south, polygon: [[-1,-1,0],[1,-1,0],[1,-1,2],[-1,-1,2]]}
  - {name: north, polygon: [[1,1,0],[-1,1,0],[-1,1,2],[1,1,2]]}
S
printf 'gnomon: 1\nobjects:\n  - {polygon: [[0,0,0],[1,0,0],[1,1,0]]}\n' >dark.yaml

verdict() { # name, then a test command
    local name=$1
    shift
    if "$@"; then
        echo "PASS lit: $name"
    else
        echo "FAIL lit: $name"
        failures=1
        echo "  status $status; standard error:"
        sed 's/^/  | /' err
    fi
}

run() { # runs the tool; leaves status, files out and err
    "$gnomon" "$@" >out 2>err
    status=$?
}

wrong_usage() { [ $status -eq 2 ] && grep -q '^gnomon: ' err && grep -q -- '--help' err && [ ! -s out ]; }
refused() { [ $status -eq 1 ] && grep -q '^gnomon: ' err && grep -q "$1" err; }
near() { awk -v a="$1" -v b="$2" 'BEGIN { d = a - b; if (d < 0) d = -d; exit !(d <= 1e-9 * (b < 0 ? -b : b)) }'; }
cell() { sed -n "$(($1 + 2))p" "$2" | sed 's/"[^"]*"/quoted/g' | cut -d, -f"$3"; }

# ---- the table
run lit cube.yaml --light sun -o cube.csv
verdict 'table' eval '[ $status -eq 0 ] && [ ! -s out ] && [ "$(wc -l <cube.csv)" -eq 7 ]'
verdict 'header' [ "$(head -n 1 cube.csv)" = polygon,object,light,sample,side,area,lit_area,lit_fraction,dimmed_area,centroid_x,centroid_y,centroid_z ]
verdict 'floor: all but footprint and shadow' near "$(cell 0 cube.csv 7)" 9990
verdict 'floor: fraction' near "$(cell 0 cube.csv 8)" 0.999
verdict 'top is lit' near "$(cell 1 cube.csv 7)" 4
verdict 'side turned away is not' eval '[ "$(cell 3 cube.csv 7)" = 0 ] && [ "$(cell 3 cube.csv 10)" = "" ]'
verdict 'name with a comma is quoted' grep -q '^1,"the, top",sun,0,1,4,4,1,0,0,0,2$' cube.csv
verdict 'certificate in the summary' eval 'grep -q "lit + shadowed = area: largest residual" err && grep -q "flux of all projected" err'
run lit cube.yaml -q; verdict 'standard output, all lights, quiet' eval '[ $status -eq 0 ] && [ ! -s err ] && [ "$(wc -l <out)" -eq 31 ]'
verdict 'points of an area light' eval '[ "$(grep -c "\"lamp, \"\"left\"\"\",3," out)" -eq 6 ]'
cp out all.csv
run lit cube.yaml -q --threads 1 -o one.csv; verdict 'threads change nothing' cmp -s one.csv all.csv
run lit cube.yaml -q --no-certificate -o -; verdict 'without certificate' cmp -s out all.csv
run lit cube.yaml --no-certificate -o x.csv; verdict 'no residuals then' eval '[ $status -eq 0 ] && ! grep -q residual err'
run lit cube.yaml -q --light sun --set 'lights[0].direction=[0,0,-1]' -o noon.csv; verdict 'setting' near "$(cell 0 noon.csv 7)" 9996

# ---- pieces and statistics
run lit cube.yaml --light sun -o p.csv --pieces p.obj --pieces p.geojson --stats s.json
verdict 'three files' eval '[ $status -eq 0 ] && [ -s p.obj ] && [ -s p.geojson ] && cmp -s p.csv cube.csv'
verdict 'statistics' eval 'grep -q "\"area_residual\":" s.json && grep -q "\"flux_residual\":" s.json && grep -q "\"light\": \"sun\"" s.json'
run info p.obj; verdict 'OBJ can be read' [ $status -eq 0 ]
# The area of the OBJ's faces, each a fan around its first corner: the floor has a hole and is cut into faces without.
areas=$(awk '/^v / { x[++n] = $2; y[n] = $3; z[n] = $4 }
    /^f / { p = q = r = 0
            for (i = 3; i < NF; i++) {
                a = x[$i] - x[$2]; b = y[$i] - y[$2]; c = z[$i] - z[$2]; j = $(i + 1)
                d = x[j] - x[$2]; e = y[j] - y[$2]; f = z[j] - z[$2]
                p += b * f - c * e; q += c * d - a * f; r += a * e - b * d }
            s += sqrt(p * p + q * q + r * r) / 2 } END { printf "%.10f\n", s }' p.obj)
verdict 'OBJ holds the lit area' near "$areas" 10002
if command -v python3 >/dev/null; then
    verdict 'GeoJSON is well-formed' python3 -c '
import json
d = json.load(open("p.geojson"))
assert d["type"] == "FeatureCollection"
for f in d["features"]:
    for ring in f["geometry"]["coordinates"]:
        assert ring[0] == ring[-1] and len(ring) > 3 and all(len(p) == 3 for p in ring)
assert abs(sum(f["properties"]["area"] for f in d["features"]) - 10002) < 1e-8
assert {f["properties"]["polygon"] for f in d["features"]} == {0, 1, 2, 4}'
else
    echo 'SKIP lit: GeoJSON: no python3'
fi

# ---- what cannot be done
run lit --help; verdict 'help' eval '[ $status -eq 0 ] && grep -q -- --pieces out'
run lit; verdict 'no scene' wrong_usage
run lit cube.yaml cube.yaml; verdict 'two scenes' wrong_usage
for wrong in '-o x.png' '-o lit' '--pieces x.stl' '--pieces -' '--threads -1' '--threads 257' '--set 3' '--lights sun' '-o a.csv -o b.csv' '--stats -' '--light'; do
    # shellcheck disable=SC2086
    run lit cube.yaml $wrong
    verdict "wrong usage: $wrong" eval 'wrong_usage && [ ! -e a.csv ]'
done
run lit cube.yaml --light sum; verdict 'unknown light' refused 'did you mean "sun"'
run lit dark.yaml; verdict 'no lights' refused 'no lights'
run lit missing.yaml -o m.csv; verdict 'scene that is not there' eval 'refused missing.yaml && [ ! -e m.csv ]'
run lit cube.yaml -o nowhere/x.csv; verdict 'folder that is not there' refused nowhere
run lit cube.yaml -o y.csv --pieces nowhere/x.obj; verdict 'folder of the pieces' refused nowhere
if [ -w /dev/full ]; then
    "$gnomon" lit cube.yaml >/dev/full 2>err; status=$?; verdict 'full standard output' refused 'standard output'
    ln -s /dev/full full.obj; run lit cube.yaml -o z.csv --pieces full.obj; verdict 'full device' refused full.obj
fi
status=0; : >err
verdict 'no temporary file left' [ -z "$(find . -name '*.tmp*' -o -name '.gnomon*')" ]
exit $failures
