#!/bin/bash
# render --aov: layers in EXR files, refused where there is none to hold them. Prints a PASS or FAIL line a check.
set -u
gnomon=${GNOMON:-$PWD/build/gnomon}
scene=$PWD/scenes/crossing.yaml
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
failures=0

verdict() { # name, then a test command
    local name=$1
    shift
    if "$@" 2>log; then echo "PASS layers: $name"; else
        cat log
        echo "FAIL layers: $name"
        failures=1
    fi
}

refuses() { # what the message says, then arguments
    local text=$1
    shift
    "$gnomon" render "$scene" --size 64x48 "$@" >out 2>err
    [ $? -eq 2 ] && grep -q -- "$text" err
}

writes() {
    "$gnomon" render "$scene" --size 64x48 -o a.exr -o a.pfm --aov depth,normal,uv,coverage --aov shadow,polygon,object,material &&
        for part in depth.Z normal.Y uv.U coverage.A shadow. polygon.id CryptoObject02.A cryptomatte/ MurmurHash3_32; do
            grep -qa "$part" a.exr || { echo "no $part in the file" >&2; return 1; }
        done
}

same_picture() {
    "$gnomon" render "$scene" --size 64x48 -o b.pfm && cmp a.pfm b.pfm
}

few_ranks() {
    "$gnomon" render "$scene" --size 64x48 -o c.exr --aov object --ranks 2 && grep -qa CryptoObject00.A c.exr &&
        ! grep -qa CryptoObject01 c.exr && ! grep -qa depth.Z c.exr
}

verdict 'all of them in one file' writes
verdict 'the picture is the same without' same_picture
verdict 'as many ranks as asked for' few_ranks
verdict 'a wrong name' refuses '"dpeth" is not one of depth' -o a.exr --aov normal,dpeth
verdict 'an empty name' refuses '"" is not one of' -o a.exr --aov normal,
verdict 'no EXR to hold them' refuses 'need an output in .exr' -o a.png --aov depth
verdict 'ranks without a layer that has them' refuses 'goes with --aov' -o a.exr --aov depth --ranks 3
verdict 'a wrong number of ranks' refuses '--ranks 0' -o a.exr --ranks 0
exit $failures
