#!/bin/bash
# make install into a folder of its own, as a package is made: what is there, pkg-config's word for it, a program compiled and run
# against it, and make uninstall leaving nothing. Prints a PASS, FAIL or SKIP line a check.
set -u
build=${BUILD:-build}
root=$PWD
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
failures=0
version=$(sed -n 's/^.define GNO_VERSION_[A-Z]* \([0-9]*\)/\1/p' include/gnomon/gnomon.h | paste -sd.)
major=${version%%.*}
prefix=$work/prefix

verdict() { # name, then a command
    local name=$1
    shift
    if "$@" >"$work/log" 2>&1; then echo "PASS install: $name"; else
        cat "$work/log"
        echo "FAIL install: $name"
        failures=1
    fi
}

# Called from make, other flags come along in MAKEFLAGS, so that nothing is built anew.
make_with() { make -s BUILD="$build" CC="${CC:-gcc}" "$@"; }

installs() { make_with install PREFIX="$prefix" DESTDIR=; }
everything_there() {
    for file in bin/gnomon include/gnomon/gnomon.h include/gnomon/gnomon_io.h lib/libgnomon.a lib/libgnomon-io.a \
        lib/libgnomon.so."$version" lib/libgnomon-io.so."$version" lib/pkgconfig/gnomon.pc lib/pkgconfig/gnomon-io.pc \
        share/man/man1/gnomon.1 share/bash-completion/completions/gnomon; do
        [ -f "$prefix/$file" ] || { echo "no $file"; return 1; }
    done
    for header in include/gnomon/*.h; do [ -f "$prefix/$header" ] || { echo "no $header"; return 1; }; done
}
versions() { # the chain of links, and the name that programs ask for
    for lib in libgnomon libgnomon-io; do
        [ "$(readlink "$prefix/lib/$lib.so")" = "$lib.so.$major" ] && [ "$(readlink "$prefix/lib/$lib.so.$major")" = "$lib.so.$version" ] &&
            readelf -d "$prefix/lib/$lib.so" | grep -q "SONAME.*\[$lib.so.$major\]" || return 1
    done
}
pc() { PKG_CONFIG_PATH=$prefix/lib/pkgconfig pkg-config "$@"; }
compiles() {
    # shellcheck disable=SC2046
    ${CC:-gcc} -std=c89 -pedantic-errors docs/examples/spans.c -o "$work/spans" $(pc --cflags --libs gnomon) &&
        LD_LIBRARY_PATH=$prefix/lib ldd "$work/spans" | grep -q "$prefix/lib/libgnomon.so.$major"
}
runs() { LD_LIBRARY_PATH=$prefix/lib "$work/spans" | grep -q 'is lit'; }
compiles_io() {
    # shellcheck disable=SC2046
    ${CC:-gcc} -std=c89 -pedantic-errors docs/examples/files.c -o "$work/files" $(pc --cflags --libs gnomon-io gnomon) &&
        LD_LIBRARY_PATH=$prefix/lib "$work/files" scenes/crossing.yaml "$work/a.png" && [ -s "$work/a.png" ]
}
tool_runs() { [ "$("$prefix/bin/gnomon" --version)" = "gnomon $version" ]; }
staged() { # a package: files under DESTDIR, their own paths without it
    make_with install PREFIX=/opt/gnomon DESTDIR="$work/stage" && [ -f "$work/stage/opt/gnomon/lib/libgnomon.so.$version" ] &&
        grep -qx 'prefix=/opt/gnomon' "$work/stage/opt/gnomon/lib/pkgconfig/gnomon.pc"
}
uninstalls() { make_with uninstall PREFIX="$prefix" && [ -z "$(find "$prefix" -name '*gnomon*' ! -type d)" ]; }

verdict 'make install PREFIX=' installs
verdict 'all files are there' everything_there
verdict 'shared library versions' versions
verdict 'the tool runs' tool_runs
if command -v pkg-config >/dev/null; then
    verdict 'pkg-config knows the version' test "$(pc --modversion gnomon)" = "$version"
    verdict 'a program compiles by pkg-config' compiles
    verdict 'and runs with the shared library' runs
    verdict 'so does one with files' compiles_io
else
    echo 'SKIP install: no pkg-config'
fi
verdict 'make install DESTDIR=' staged
verdict 'make uninstall' uninstalls
cd "$root" && make_with "$build/gnomon.pc" "$build/gnomon-io.pc" >/dev/null 2>&1 # with the default prefix again
exit $failures
