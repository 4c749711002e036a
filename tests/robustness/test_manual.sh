#!/bin/bash
# The manual page and the completion know every command and option of the tool. Prints a PASS, FAIL or SKIP line a check.
set -u
gnomon=${GNOMON:-$PWD/build/gnomon}
page=docs/man/gnomon.1
failures=0
commands=$("$gnomon" --help | sed -n '/^commands:/,/^$/s/^  \([a-z]*\).*/\1/p')

verdict() { # name, then a command
    local name=$1
    shift
    if "$@"; then echo "PASS manual: $name"; else
        echo "FAIL manual: $name"
        failures=1
    fi
}

options_of() { "$gnomon" "$1" --help | sed -n 's/^ \{2,6\}\(-[a-z], \)\{0,1\}\(--[a-z-]*\).*/\2/p'; }
section_of() { sed -n "/^.SH GNOMON ${1^^}/,/^.SH/p" "$page" | sed '$d' | tr -d '\\'; }
documented() {
    local option
    for option in $(options_of "$1"); do
        section_of "$1" | grep -q "^\.B.*$option\( \|$\)" || { echo "no $option of $1"; return 1; }
    done
    [ -n "$(options_of "$1")" ]
}
clean() { [ -z "$(groff -ww -man -Tutf8 "$page" 2>&1 >/dev/null)" ]; }
completes() { # words before, wanted
    (
        PATH=$(dirname "$gnomon"):$PATH
        # shellcheck disable=SC1091
        . src/cli/completion/gnomon
        # shellcheck disable=SC2206
        COMP_WORDS=($1)
        COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
        _gnomon
        [ "${COMPREPLY[*]}" = "$2" ]
    )
}

[ -n "$commands" ] || failures=1
for command in $commands; do
    verdict "options of $command" documented "$command"
    verdict "--help of $command has examples" eval '"$gnomon" $command --help | grep -A1 "^examples:" | grep -q "  gnomon $command"'
done
verdict 'options without a command' eval 'grep -q "^\.B .*version$" "$page" && grep -q "^\.B .*help$" "$page"'
verdict 'version' grep -q "\"$("$gnomon" --version)\"" "$page"
if command -v groff >/dev/null; then verdict 'groff has no warning' clean; else echo 'SKIP manual: groff: not installed'; fi
verdict 'completion of a command' completes 'gnomon ren' render
verdict 'completion of an option' completes 'gnomon render --eng' --engine
verdict 'completion of a value' completes 'gnomon render --engine w' weiler-atherton
verdict 'completion of a file' completes 'gnomon info READ' README.md
exit $failures
