#!/bin/sh
# The public headers alone, in every C and C++ they promise, and the names the shared libraries export.
set -u
build=${BUILD:-build}
status=0
trap 'rm -rf "$dir"' EXIT
dir=$(mktemp -d)

verdict() { # name, then a command whose output is shown when it fails
    name=$1
    shift
    if "$@" >"$dir/log" 2>&1; then echo "PASS $name"; else
        cat "$dir/log"
        echo "FAIL $name"
        status=1
    fi
}

only_gno() { # library: at least one name, and none without the prefix
    nm -D --defined-only "$1" >"$dir/names" || return 1
    grep -q ' gno_' "$dir/names" || { echo "no gno_ name exported"; return 1; }
    ! awk '{ print $NF }' "$dir/names" | grep -v '^gno_'
}

for header in include/gnomon/*.h; do
    base=gnomon/$(basename "$header")
    printf '#include <%s>\n' "$base" >"$dir/alone.c"
    cp "$dir/alone.c" "$dir/alone.cpp"
    tried=
    for cc in "${CC:-gcc}" gcc clang; do
        command -v "${cc%% *}" >/dev/null || { echo "SKIP $base $cc: not installed"; continue; }
        case " $tried " in *" $cc "*) continue ;; esac
        tried="$tried $cc"
        for std in c89 c99 c11; do
            # shellcheck disable=SC2086
            verdict "$base $cc $std" $cc -std=$std -pedantic-errors -Wall -Wextra -Werror -Iinclude -fsyntax-only "$dir/alone.c"
        done
    done
    for cxx in g++ clang++; do
        # clang++ without the C++ library cannot even find <stddef.h>'s C++ face on some systems; a trial tells.
        if ! command -v $cxx >/dev/null || ! echo '#include <stddef.h>' | $cxx -x c++ -fsyntax-only - 2>/dev/null; then
            echo "SKIP $base $cxx: no working C++ compiler of this name"
            continue
        fi
        for std in c++98 c++17; do
            verdict "$base $cxx $std" $cxx -std=$std -pedantic-errors -Wall -Wextra -Werror -Iinclude -fsyntax-only "$dir/alone.cpp"
        done
    done
done

for lib in libgnomon libgnomon-io; do
    verdict "$lib exports only gno_ names" only_gno "$build/$lib.so"
done
exit $status
