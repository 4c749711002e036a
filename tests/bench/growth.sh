#!/usr/bin/env bash
# How the time of `gnomon render` grows with polygons, pixels and lights; prints the Markdown tables of docs/growth.md.
#
# usage: tests/bench/growth.sh [polygons|pixels|lights]...        all three
# The scene is the generated town of tests/bench/town.c: the same view and the same square of ground for any number of polygons.
#   GNOMON   the tool (build/gnomon)      REPEATS  runs of each (3), the least total counts     CC  compiler (cc)
#   LARGEST  polygons of the largest town (1000000)      THREADS  threads (1)
# Seconds leave loading and writing out. Exit status 1 when a step grows by more than N log N (its share over 1).
set -euo pipefail
cd "$(dirname "$0")/../.."
gnomon=${GNOMON:-build/gnomon}
repeats=${REPEATS:-3} largest=${LARGEST:-1000000} threads=${THREADS:-1}
[ -x "$gnomon" ] || { echo "SKIP growth: $gnomon is missing: run make first"; exit 0; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
${CC:-cc} -std=c11 -O2 -D_POSIX_C_SOURCE=200809L tests/bench/town.c -o "$work/town" -lm

json() { sed -n "s/.*\"$1\": *\([0-9.e+-]*\).*/\1/p" "$work/stats.json" | head -1; }

# The stages of the fastest of the runs, as "prepare shadow project scan render megabytes".
measure() {
    local size=$1 i
    for ((i = 0; i < repeats; i++)); do
        "$gnomon" render "$work/town.yaml" -o "$work/out.pfm" --size "$size" --threads "$threads" --quiet --stats "$work/stats.json"
        rm -f "$work/out.pfm"
        echo "$(json prepare) $(json shadow) $(json project) $(json scan) $(json render) $(json peak_memory)"
    done | sort -g -k5 | head -1 | awk '{ $6 = sprintf("%.0f", $6 / 1e6); print }'
}

table() {
    echo
    echo "### Time against $1 ($2)"
    echo
    echo "| $1 | prepare | shadow | project | scan | render | MB | growth | of N log N |"
    echo '|---|---|---|---|---|---|---|---|---|'
    before=''
}

# row NAME N: N is what the growth is held to. Fixed costs make small towns relatively dear, so only growth is judged.
row() {
    local seconds=($3) growth='-' share='-'
    if [ -n "$before" ]; then
        growth=$(awk -v a="$before_time" -v b="${seconds[4]}" 'BEGIN { printf "%.2f", b / a }')
        share=$(awk -v a="$before_time" -v b="${seconds[4]}" -v m="$before" -v n="$2" \
            'BEGIN { printf "%.2f", b / a / (n * log(n + 1) / (m * log(m + 1))) }')
        awk -v s="$share" 'BEGIN { exit !(s > 1) }' && worse=1
    fi
    echo "| $1 | ${seconds[0]} | ${seconds[1]} | ${seconds[2]} | ${seconds[3]} | ${seconds[4]} | ${seconds[5]} | $growth | $share |"
    before=$2 before_time=${seconds[4]}
}

worse=0
for what in ${*:-polygons pixels lights}; do
    case $what in
    polygons)
        table polygons "1920x1080, two point lights and a sun, $threads thread(s)"
        for ((n = 1000; n <= largest; n *= 10)); do
            "$work/town" "$n" 3 "$work"
            row "$n" "$n" "$(measure 1920x1080)"
        done
        ;;
    pixels)
        table pixels "town of 10,000 polygons, two point lights and a sun, $threads thread(s)"
        "$work/town" 10000 3 "$work"
        for size in 480x270 960x540 1920x1080 3840x2160; do
            row "$size" $((${size%x*} * ${size#*x})) "$(measure "$size")"
        done
        ;;
    lights)
        table lights "town of 10,000 polygons, 1920x1080, $threads thread(s)"
        for n in 1 2 4 8 16; do
            "$work/town" 10000 "$n" "$work"
            row "$n" "$n" "$(measure 1920x1080)"
        done
        ;;
    *) echo "growth.sh: $what is not one of polygons, pixels, lights" >&2 && exit 2 ;;
    esac
done
exit $worse
