#!/usr/bin/env bash
# All measurements: the reference views beside the ray-traced peer, then growth. usage: tests/bench/run.sh
# Environment: see reference.sh and growth.sh. Exit status 1 when a bound of either is missed.
set -u
folder=$(dirname "$0")
status=0
bash "$folder/reference.sh" || status=1
bash "$folder/growth.sh" || status=1
exit $status
