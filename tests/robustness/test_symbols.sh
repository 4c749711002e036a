#!/bin/bash
# What the libraries bring into a program and what they take from it, by nm: names, no way to print, to end the process or to catch
# signals, no state. Prints a PASS or FAIL line a check.
set -u
build=${BUILD:-build}
log=$(mktemp)
trap 'rm -f "$log"' EXIT
failures=0

verdict() { # name, then a command
    local name=$1
    shift
    if "$@" >"$log" 2>&1; then echo "PASS symbols: $name"; else
        cat "$log"
        echo "FAIL symbols: $name"
        failures=1
    fi
}

# Exported by the shared library: gno_ only. Defined in the static one, where hidden names are still seen by the linker: gno_ and gnoi_.
exports() { ! nm -D --defined-only "$build/$1.so" | awk '{ print $NF }' | grep -v '^gno_' && nm -D --defined-only "$build/$1.so" | grep -q ' gno_'; }
defines() { ! nm -g --defined-only "$build/$1.a" 2>/dev/null | awk 'NF == 3 { print $3 }' | grep -vE '^gnoi?_'; }

# Undefined in the static library, that is, taken from libc or others.
takes_none() { # library, then names
    local lib=$1 pattern
    shift
    pattern=$(printf '%s|' "$@")
    ! nm -u "$build/$lib.a" 2>/dev/null | awk '{ print $NF }' | sort -u | grep -xE "(${pattern%|})(@.*)?"
}
ends=(exit _exit _Exit abort quick_exit atexit raise kill pthread_exit longjmp __longjmp_chk)
signals=(signal sigaction sigprocmask pthread_sigmask alarm setitimer)
prints=(printf puts putchar fprintf vprintf vfprintf fputs fputc putc fwrite perror stdout stderr __printf_chk __fprintf_chk __vfprintf_chk)
state=(setlocale srand rand random setenv putenv umask chdir fork system getenv strtok localtime gmtime)

# Writable data would be state shared by all contexts; constants that hold addresses lie in .data.rel.ro, which is none.
no_data() { size -A "$build/$1.a" | awk '($1 ~ /^\.(data|bss|tdata|tbss)$/ || $1 ~ /^\.(data|bss)\.[^r]/) && $2 > 0 { print; bad = 1 } END { exit bad }'; }

for lib in libgnomon libgnomon-io; do
    verdict "$lib.so exports gno_ names only" exports $lib
    verdict "$lib.a defines gno_ and gnoi_ names only" defines $lib
    verdict "$lib catches no signal" takes_none $lib "${signals[@]}"
    verdict "$lib prints nothing" takes_none $lib "${prints[@]}"
done
verdict 'libgnomon ends no process' takes_none libgnomon "${ends[@]}"
verdict 'libgnomon-io ends no process' takes_none libgnomon-io "${ends[@]:0:9}" # png_longjmp ends in our own setjmp
verdict 'libgnomon changes no state of the process' takes_none libgnomon "${state[@]}"
verdict 'libgnomon-io changes no state of the process' takes_none libgnomon-io "${state[@]:0:10}" # TMPDIR is read
verdict 'libgnomon has no writable data' no_data libgnomon
verdict 'libgnomon-io has no writable data' no_data libgnomon-io
exit $failures
