#!/bin/bash
# A share of the faults of `make faults`, the same ones every time.
exec bash tests/faults/faults.sh quick
