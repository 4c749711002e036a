#!/bin/sh
# How much of src/ the tests reach, from what gcc's counters left in BUILD/obj: lines and branches (each way a condition can go, short
# circuits too) of each folder, of the engine folders together, and the files with most lines never run. A line or branch of a header
# counts once, however many objects it is in. What was not reached is listed in BUILD/uncovered.txt.
# Fails when the engine folders have less than 95 % of lines or 85 % of branches.
# Needs awk and the gcov of the compiler (GCOV; gcov). usage: coverage.sh BUILD
set -u
build=$1 gcov=${GCOV:-gcov}
command -v "$gcov" >/dev/null || { echo "SKIP coverage: $gcov: not installed (it comes with gcc)"; exit 0; }
[ -n "$(find "$build/obj/src" -name '*.gcda' | head -n 1)" ] || { echo "FAIL coverage: no counters in $build/obj/src"; exit 1; }

find "$build/obj/src" -name '*.gcno' | sort | while read -r notes; do
    "$gcov" -b -c -t "$notes" 2>/dev/null
done | awk -v list="$build/uncovered.txt" '
function share(part, whole) { return whole ? sprintf("%6.2f %%", 100 * part / whole) : "     - " }
function row(name, lines, hit, ways, taken) {
    printf "%-8s %7d %7d %s %9d %7d %s\n", name, lines, lines - hit, share(hit, lines), ways, ways - taken, share(taken, ways)
}
/^ +-: +0:Source:/ {
    file = $0
    sub(/^ +-: +0:Source:/, "", file)
    ours = file ~ /(^|\/)src\/[a-z]+\/[^\/]*$/
    sub(/^.*\/src\//, "src/", file)
    next
}
!ours { next }
/^branch/ {
    key = file ":" at ":" ways_here++
    if (!(key in branch)) branch[key] = 0
    if ($0 ~ /taken [1-9]/) branch[key] = 1
    next
}
/^ *[-0-9#=*]+: *[0-9]+:/ {
    split($0, part, ":")
    at = part[2] + 0
    ways_here = 0
    if (part[1] ~ /-/ || at == 0) next
    key = file ":" at
    if (!(key in line)) line[key] = 0
    if (part[1] ~ /[1-9]/) line[key] = 1
}
END {
    for (key in line) {
        split(key, part, ":")
        split(part[1], name, "/")
        lines[name[2]]++
        hit[name[2]] += line[key]
        missed[part[1]] += !line[key]
        if (!line[key]) print key ": line never run" >list
    }
    for (key in branch) {
        split(key, part, ":")
        split(part[1], name, "/")
        ways[name[2]]++
        taken[name[2]] += branch[key]
        if (!branch[key] && line[part[1] ":" part[2]]) print part[1] ":" part[2] ": branch " part[3] " never taken" >list
    }
    close(list)
    printf "%-8s %7s %7s %8s %9s %7s %8s\n", "folder", "lines", "missed", "reached", "branches", "missed", "reached"
    count = split("base scene project clip shadow scan shade engine io cli", folder, " ")
    for (i = 1; i <= count; i++) {
        f = folder[i]
        row(f, lines[f], hit[f], ways[f], taken[f])
        if (f ~ /^(scene|project|clip|shadow|scan|shade|engine)$/) {
            all_lines += lines[f]; all_hit += hit[f]; all_ways += ways[f]; all_taken += taken[f]
        }
    }
    row("engines", all_lines, all_hit, all_ways, all_taken)
    print "engines: scene, project, clip, shadow, scan, shade and engine together. Most lines never run:"
    for (i = 0; i < 10; i++) {
        worst = ""
        for (f in missed) if (missed[f] > 0 && (worst == "" || missed[f] > missed[worst])) worst = f
        if (worst == "") break
        printf "  %4d %s\n", missed[worst], worst
        missed[worst] = 0
    }
    exit !(all_hit >= 0.95 * all_lines && all_taken >= 0.85 * all_ways)
}'
status=$?
if [ -f "$build/uncovered.txt" ]; then sort -t: -k1,1 -k2,2n -o "$build/uncovered.txt" "$build/uncovered.txt"; fi
exit $status
