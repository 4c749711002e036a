#!/bin/sh
# Runs test programs and scripts one after the other and adds up their results.
# usage: run.sh LOGDIR PROGRAM...
# A program that is not a *.sh file is a cmocka program; a script prints "PASS name", "FAIL name" or "SKIP name: why" lines.
# Each one's whole output is kept in LOGDIR and shown when something in it fails. TEST_TIMEOUT: seconds for one program.
set -u
logs=$1
shift
mkdir -p "$logs"
passed=0 failed=0 skipped=0

# The numbers in cmocka's "[  PASSED  ] 3 test(s)." lines, added up; newer versions put the group's name before the number.
count() { sed -n "s/^\[ *$1 *\] \(.*: \)\{0,1\}\([0-9][0-9]*\) test(s).*/\2/p" "$log" | awk '{ n += $1 } END { print n + 0 }'; }
lines() { grep -c "^$1 " "$log"; }

for program in "$@"; do
    name=${program#"${BUILD:-build}"/}
    log=$logs/$(echo "$name" | tr / _).log
    case $program in
    *.sh) timeout "${TEST_TIMEOUT:-1200}" bash "$program" >"$log" 2>&1 ;;
    *) timeout "${TEST_TIMEOUT:-1200}" "$program" >"$log" 2>&1 ;;
    esac
    status=$?
    case $program in
    *.sh) p=$(lines PASS) f=$(lines FAIL) s=$(lines SKIP) ;;
    *) p=$(count PASSED) f=$(count FAILED) s=$(count SKIPPED) ;;
    esac
    # A crash, a failed set-up or a script that stopped half-way names no failed test, yet it is one; so is a silent program.
    if [ "$f" -eq 0 ] && { [ $status -ne 0 ] || [ $((p + s)) -eq 0 ]; }; then
        echo "$name: ended with status $status" >>"$log"
        f=1
    fi
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    if [ "$f" -ne 0 ]; then
        cat "$log"
        echo "FAILED $name: $p passed, $f failed, $s skipped"
    else
        grep '^SKIP ' "$log"
        echo "ok     $name: $p passed, $s skipped"
    fi
done

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
