#!/bin/bash
# The engine on other kinds of machines: 32 bits (gcc -m32), and big endian (s390x by a cross compiler, run by qemu-user). Each draws the
# same scenes as this machine and must print the same numbers; a PFM file written there is read here. usage: make check-port
# Prints a PASS, FAIL or SKIP line a check. Packages: gcc-multilib; or, which Debian does not
# let be installed beside it, gcc-s390x-linux-gnu libc6-dev-s390x-cross qemu-user.
set -u
cd "$(dirname "$0")/../.." || exit 1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
status=0
flags='-std=c11 -O1 -ffp-contract=off -pthread -D_POSIX_C_SOURCE=200809L -D_FILE_OFFSET_BITS=64 -Iinclude -Isrc -Itests
    -fno-math-errno -fno-trapping-math -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror'
sources="$(ls src/{base,scene,project,clip,shadow,scan,shade,engine}/*.c) src/io/picture.c src/io/picture_pfm.c src/io/file_name.c src/io/atomic_file.c
    src/io/cryptomatte.c src/io/text_file.c"

build() { # name, then a compiler with its flags
    local name=$1
    shift
    mkdir "$work/$name"
    # shellcheck disable=SC2086
    printf '%s\n' $sources | xargs -P "$(nproc)" -I{} sh -c "$* $(echo $flags) -c {} -o $work/$name/\$(echo {} | tr / _).o" &&
        for file in tests/port/port_check.c tests/support/compare.c tests/support/random_scene.c; do
            "$@" ${flags/-Wconversion -Werror/} -c $file -o "$work/$name/$(basename $file).o" || return 1
        done && "$@" "$work/$name"/*.o -o "$work/$name/check" -lm -pthread
}

try() { # name, runner or empty, then the compiler
    local name=$1 runner=$2
    shift 2
    if ! printf '#include <errno.h>\nint main(void) { return 0; }\n' | "$@" -x c - -o "$work/trial" 2>/dev/null || ! $runner "$work/trial"; then
        echo "SKIP port: $name: no compiler, or nothing to run it"
        return
    fi
    if build "$name" "$@" >"$work/log" 2>&1 && $runner "$work/$name/check" write "$work/$name.pfm" >"$work/$name.txt" 2>&1 &&
        diff "$work/here.txt" "$work/$name.txt" >"$work/log"; then
        echo "PASS port: $name draws and streams the same"
    else
        cat "$work/log"
        echo "FAIL port: $name draws and streams the same"
        status=1
    fi
    if "$work/here/check" read "$work/$name.pfm" | diff "$work/picture.txt" - >"$work/log" 2>&1; then
        echo "PASS port: a PFM file of $name reads here"
    else
        cat "$work/log"
        echo "FAIL port: a PFM file of $name reads here"
        status=1
    fi
}

build here "${CC:-gcc}" || exit 1
"$work/here/check" write "$work/here.pfm" >"$work/here.txt" || exit 1
"$work/here/check" read "$work/here.pfm" >"$work/picture.txt" || exit 1
# Without SSE the old floating-point unit would keep more digits than a double has; s390x would take floats for doubles in between.
try m32 '' gcc -m32 -msse2 -mfpmath=sse
try s390x 'qemu-s390x -L /usr/s390x-linux-gnu' s390x-linux-gnu-gcc -fexcess-precision=fast
exit $status
