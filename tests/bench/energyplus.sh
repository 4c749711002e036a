#!/usr/bin/env bash
# Lit fractions of three real buildings over all their sun positions, beside dense sampling and beside EnergyPlus's own.
# usage: tests/bench/energyplus.sh [BUILDING]...      (after make)
# Environment: GNOMON_DATA, the folder of the data (../shared/data). Exit status 1 when a bound of energyplus.c is missed.
set -u
cd "$(dirname "$0")/../.." || exit 1
data=${GNOMON_DATA:-../shared/data}/energyplus
build=${BUILD:-build}
if [ ! -d "$data" ]; then echo "SKIP energyplus: no folder $data"; exit 0; fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
${CC:-gcc} -O2 -Iinclude tests/bench/energyplus.c "$build/libgnomon.a" -lm -pthread -o "$work/energyplus" || exit 1
unpack() { if [ -f "$1" ]; then cat "$1"; else xz -dc "$1.xz"; fi; }
status=0
printf '%-17s %-22s %6s %9s %9s %8s %8s\n' building difference values largest mean '>0.0001' '>0.001'
for building in ${*:-small_office secondary_school urban_office}; do
    for file in surfaces.json sun.csv fraction_sampled.csv fraction_sh.csv; do unpack "$data/$building/$file" >"$work/$file"; done
    "$work/energyplus" "$building" "$work/surfaces.json" "$work/sun.csv" "$work/fraction_sampled.csv" "$work/fraction_sh.csv" || status=1
done
exit $status
