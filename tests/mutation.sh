#!/bin/bash
# Deliberate one-line breakages of the source, each of which a test has to catch: mutations.txt, whose entries are
#
#   src/clip/grid.c unit/test_clip        the file, and the test program to try first
#   -    the line as it is                (it has to be in the file exactly once)
#   +    the line broken
#
# All happens in a copy of the tree under BUILD; the tree itself is never changed. A breakage is caught when a test fails, crashes or
# does not end; what the first program does not see is tried with all the others until one fails.
# Prints a line for each breakage and the tally; fails when one is not caught, does not compile or is stale: its line has changed. Needs what
# the tests need, and awk.
# usage: mutation.sh BUILD LIST [WORD: only breakages of files with this word]
# MUTATION_SECONDS: of processor time for one program (120). MUTATION_FIRST=1: only the program named first.
set -u
unset MAKEFLAGS MFLAGS MAKELEVEL # as they are when make calls
build=$1 list=$2 word=${3:-}
root=$PWD
limit=${MUTATION_SECONDS:-120}
ulimit -v 4000000 # KiB: what grows without end must not take the machine with it
tree=$build/tree
jobs=$(nproc 2>/dev/null || echo 1)

rm -rf "$tree"
mkdir -p "$tree" || exit 1
cp -r src include tests docs scenes Makefile README.md "$tree" || exit 1
[ ! -d "$root/../shared" ] || ln -sfn "$(cd "$root/../shared" && pwd)" "$build/shared" # where tests look for data
cd "$tree" || exit 1
make_here() { make -s -j"$jobs" CC="${CC:-gcc}" BUILD=build CFLAGS=-O1 COUNTERS= SANITIZE= "$@" >log 2>&1; }
make_here all tests || { cat log; echo 'FAIL mutation: the tree does not build'; exit 1; }
programs=$(cd build/tests && find unit property pictures robustness -type f -name 'test_*' | sort)

# Runs a program; true when it fails. `by` then tells what failed, and in which way.
fails() {
    local status
    (ulimit -t "$limit" && exec timeout 3600 "build/tests/$1") >log 2>&1
    status=$?
    [ $status -ne 0 ] || return 1
    by="$1: $({ sed -n 's/^\[  FAILED  \] \([a-z]*:* *test_[a-zA-Z_0-9]*\).*/\1/p; s/^FAIL //p' log; echo failed; } | head -n 1)"
    case $status in
    124 | 137 | 152) by="$1: no end" ;;
    134 | 136 | 139) by="$1: crash" ;;
    esac
}

# The program named first, then all others.
caught() {
    local program
    make_here "build/tests/$1" || return 2
    ! fails "$1" || return 0
    [ -z "${MUTATION_FIRST:-}" ] || return 1
    make_here all tests || return 2
    for program in $programs; do
        [ "$program" != "$1" ] || continue
        ! fails "$program" || return 0
    done
    return 1
}

exec 2>/dev/null # where the shell would report each crash
total=0 good=0 stale=0
while read -r file first <&3; do
    IFS= read -r old <&3 && IFS= read -r new <&3 || break
    old=${old#?} new=${new#?}
    case $file in *"$word"*) ;; *) continue ;; esac
    cp "$file" whole
    line=$(OLD=$old awk '$0 == ENVIRON["OLD"] { print FNR; n++ } END { exit n != 1 }' whole) ||
        { echo "STALE   $file: not there once:$old"; stale=$((stale + 1)); continue; }
    total=$((total + 1))
    OLD=$old NEW=$new awk '{ print $0 == ENVIRON["OLD"] ? ENVIRON["NEW"] : $0 }' whole >"$file"
    caught "$first"
    case $? in
    0) good=$((good + 1)) && echo "caught  $file:$line by $by" ;;
    1) echo "MISSED  $file:$line:${new}" ;;
    *) echo "BROKEN  $file:$line: does not compile" ;;
    esac
    cp whole "$file"
done 3< <(grep -v '^#' "$root/$list" | grep -v '^$')
echo "mutation: $good of $total breakages caught, $stale stale"
[ "$total" -gt 0 ] && [ "$good" -eq "$total" ] && [ "$stale" -eq 0 ]
