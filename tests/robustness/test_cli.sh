#!/bin/bash
# The tool's contract with shells: exit statuses, messages, standard output, files that appear whole or not at all.
# Prints a PASS, FAIL or SKIP line a check; GNOMON names the tool.
set -u
gnomon=${GNOMON:-$PWD/build/gnomon}
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
objects:
  - {name: floor, polygon: [[-2,-2,0],[2,-2,0],[2,2,0],[-2,2,0]]}
  - {name: sign, polygon: [[-0.5,0,0.5],[0.5,0,0.5],[0.5,0,1],[-0.5,0,1]]}
S
printf 'gnomon: 1\nimage: {width: 64, heigth: 48}\n' >typo.yaml

verdict() { # name, then a test command
    local name=$1
    shift
    if "$@"; then
        echo "PASS cli: $name"
    else
        echo "FAIL cli: $name"
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
done_well() { [ $status -eq 0 ] && [ ! -s err ]; }
clean_folder() { [ -z "$(find . -name '*.tmp*' -o -name '.gnomon*')" ]; }
is_png() { [ "$(head -c 8 "$1" | od -An -tx1 | tr -d ' \n')" = 89504e470d0a1a0a ]; }

# ---- help and wrong usage
run --help; verdict 'help' eval 'done_well && grep -q "^usage: gnomon" out && grep -q render out'
run render --help; verdict 'help of render' eval 'done_well && grep -q -- --size out'
run help info; verdict 'help of info' eval 'done_well && grep -q -- --json out'
run --version; verdict 'version' eval 'done_well && grep -Eq "^gnomon [0-9]+\.[0-9]+\.[0-9]+$" out'
run render scene.yaml -o memory.pfm --memory 20K; verdict 'a memory ceiling' eval 'refused "memory ceiling of" && [ ! -e memory.pfm ]'
run render scene.yaml -o memory.pfm --memory 0.5G; verdict 'a memory ceiling high enough' eval 'done_well && [ -s memory.pfm ]'
run render scene.yaml -o memory.pfm --memory 5X; verdict 'a memory ceiling that is none' wrong_usage
run; verdict 'no command' wrong_usage
run rendr scene.yaml; verdict 'misspelt command' eval 'wrong_usage && grep -q "did you mean \"render\"" err'
run render scene.yaml --sizes 3x3; verdict 'misspelt option' eval 'wrong_usage && grep -q "did you mean \"--size\"" err'
run render; verdict 'no scene' wrong_usage
run render scene.yaml scene.yaml; verdict 'two scenes' wrong_usage
run render scene.yaml --size; verdict 'option without its value' wrong_usage
run render scene.yaml --quiet=yes; verdict 'value for an option that takes none' wrong_usage
for wrong in '--size 0x5' '--size 5' '--size 5x5x' '--size 70000x1' '--size -5x5' '--lines 0' '--lines 257' '--lines 4:8' '--lines 3:2' \
    '--lines x' '--threads -1' '--threads 1.5' '--exposure -1' '--exposure nan' '--exposure 1x' '--depth 12' '--terminator soft' \
    '--engine raycast' '--set camera' '--set =3' '-o x.jpg' '-o png' '-o x.png --depth 32' '-o x.pfm --depth 16' '-o - -o -' \
    '-o - --stats -' '-x'; do
    # shellcheck disable=SC2086
    run render scene.yaml $wrong
    verdict "wrong usage: $wrong" eval 'wrong_usage && [ ! -e x.png ] && [ ! -e x.pfm ]'
done

# ---- what cannot be done
run render missing.yaml; verdict 'scene that is not there' eval 'refused missing.yaml && [ ! -e missing.png ]'
run render typo.yaml; verdict 'wrong key' eval 'refused "typo.yaml:2" && [ ! -e typo.png ]'
run info typo.yaml; verdict 'wrong key, info' refused typo.yaml:2
run render scene.yaml -o nowhere/x.png; verdict 'folder that is not there' refused nowhere
mkdir folder.png; run render scene.yaml -o folder.png; verdict 'output is a folder' refused folder.png
run render scene.yaml --set camera.eyes=[0,0,1]; verdict 'setting of an unknown key' refused eyes

# ---- pictures
run render scene.yaml; verdict 'default output' eval 'done_well && is_png scene.png && [ ! -s out ]'
run render scene.yaml -o a.png -oa.exr --output=a.pfm --lines 5 --threads 2 -q
verdict 'three formats at once' eval 'done_well && is_png a.png && [ -s a.exr ] && [ "$(head -n 1 a.pfm)" = PF ]'
run render --size 31x17 -o a.pfm -- scene.yaml; verdict 'size' eval 'done_well && [ "$(sed -n 2p a.pfm | head -c 5)" = "31 17" ]'
"$gnomon" render scene.yaml -o - >b.png 2>err; status=$?; verdict 'standard output' eval 'done_well && cmp -s b.png scene.png'
run render scene.yaml --stats s.json; verdict 'stats in a file' eval 'done_well && grep -q "\"scan\":" s.json && grep -q peak_memory s.json'
run render scene.yaml --stats -; verdict 'stats on standard output' eval 'done_well && grep -q "\"total\":" out'
run render scene.yaml -o c.png --set image.width=20 --set 'image.background=[1,1,1]'; verdict 'settings' eval 'done_well && ! cmp -s c.png scene.png'
run render scene.yaml -o d.png -o d.exr --depth 32; verdict 'depth for the format that has it' eval 'done_well && is_png d.png'
run info scene.yaml; verdict 'info' eval 'done_well && grep -q "2 polygons" out && grep -q lamp out'
run info --json scene.yaml; verdict 'info as JSON' eval 'done_well && grep -q "\"polygons\": 2" out'
# A tetrahedron with a turned face, a lost one, one given twice and one without area; the ground under it has four edges more.
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 4 2\nf 2 3 4\nf 4 3 2\nf 2 2 2\n' >bad.obj
run info bad.obj; verdict 'info names problems' eval 'done_well && grep -q "1 polygon without area, skipped: 4$" out &&
    grep -q "1 polygon given before: 3 (as 2)" out && grep -q "1 polygon wound against neighbours: 1$" out && grep -q "7 edges open.*, 4 of them where flat parts end: 0 (0-2)" out'
run info --json bad.obj; verdict 'info names problems in JSON' eval 'done_well && grep -q "\"degenerate\": 1, \"non_planar\": 0, \"duplicate\": 1, \"flipped\": 1, \"open_edges\": 7, \"crowded_edges\": 0, \"border_edges\": 4," out &&
    grep -q "\"flipped\": \[1\]" out && grep -q "{\"polygon\": 3, \"of\": 2}" out'

# ---- whole or not at all
if [ -w /dev/full ]; then
    for option in '-o -' '-o -  --size 900x900'; do
        # shellcheck disable=SC2086
        "$gnomon" render scene.yaml $option >/dev/full 2>err; status=$?
        verdict "full standard output: $option" refused 'standard output'
    done
    ln -s /dev/full full.png; run render scene.yaml -o full.png; verdict 'full device' eval 'refused full.png && [ -L full.png ]'
    ln -s /dev/full full.exr; run render scene.yaml -o full.exr; verdict 'full device, EXR' refused full.exr
    run render scene.yaml --stats /dev/full; verdict 'full device, stats' refused /dev/full
    "$gnomon" info scene.yaml >/dev/full 2>err; status=$?; verdict 'full standard output, info' refused 'standard output'
    "$gnomon" --help >/dev/full 2>err; status=$?; verdict 'full standard output, help' refused 'standard output'
else
    echo 'SKIP cli: full device: no /dev/full here'
fi
ln -s /dev/null null.exr; run render scene.yaml -o null.exr; verdict 'device stays a device' eval 'done_well && [ -c /dev/null ] && [ -L null.exr ]'
"$gnomon" render scene.yaml -o - 2>err >&-; status=$?; verdict 'closed standard output' refused 'standard output'
"$gnomon" render scene.yaml -o e.png 2>&-; status=$?; : >err; verdict 'closed standard error' is_png e.png
"$gnomon" render scene.yaml -o - --size 1500x1500 --depth 16 --set 'image.background=[0.3,0.1,0]' 2>err | head -c 10 >/dev/null
status=${PIPESTATUS[0]}; verdict 'reader that goes away' eval '[ $status -eq 0 ] || refused "standard output"'
( ulimit -f 8; trap '' XFSZ; "$gnomon" render scene.yaml -o scene.pfm 2>err; echo $? >rc ); status=$(cat rc)
verdict 'file that gets too large' eval 'refused scene.pfm && [ ! -e scene.pfm ]'
ln -s real.png link.png; : >real.png; run render scene.yaml -o link.png
verdict 'link stays a link' eval 'done_well && [ -L link.png ] && is_png real.png'
chmod 600 real.png; run render scene.yaml -o real.png; verdict 'mode of a replaced file' [ "$(stat -c %a real.png)" = 600 ]
( umask 027; "$gnomon" render scene.yaml -o new.png 2>err ); status=$?; verdict 'mode of a new file' [ "$(stat -c %a new.png)" = 640 ]
long=$(printf 'n%.0s' $(seq 251)); run render scene.yaml -o "$long.png"; verdict 'longest file name' eval 'done_well && is_png "$long.png"'
if [ "$(id -u)" -ne 0 ]; then
    mkdir locked; cp scene.png locked/x.png; chmod 555 locked
    run render scene.yaml -o locked/x.png; verdict 'folder without write permission' eval 'refused locked && is_png locked/x.png'
    chmod 755 locked; chmod 444 locked/x.png
    run render scene.yaml -o locked/x.png; verdict 'file without write permission' refused locked
else
    echo 'SKIP cli: write permissions: root may write everywhere'
fi

# ---- signals: a rendering that takes long is stopped; a pipe nobody reads does not hold the program
if command -v timeout >/dev/null; then
    for signal in INT TERM; do
        : >old.png
        timeout --preserve-status -s $signal 0.7 "$gnomon" render scene.yaml -o old.png --size 6000x4000 --lines 255 --threads 1 2>err
        status=$?
        [ $signal = INT ] && wanted=130 || wanted=143
        verdict "SIG$signal while rendering" eval '[ $status -eq $wanted ] && [ ! -s old.png ] && grep -q interrupted err'
    done
    mkfifo pipe.pfm
    ( exec 3<pipe.pfm; sleep 3 ) &
    timeout --preserve-status -s INT -k 5 1 "$gnomon" render scene.yaml -o pipe.pfm --size 500x500 2>err
    status=$?
    kill $! 2>/dev/null
    wait 2>/dev/null
    verdict 'SIGINT while a pipe is stuck' [ $status -eq 130 ]
else
    echo 'SKIP cli: signals: no timeout command'
fi
status=0
verdict 'no temporary file left' clean_folder
exit $failures
