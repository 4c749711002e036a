#!/bin/bash
# The cases of `make hostile` in sizes that take a moment.
exec "${BUILD:-build}/tests/hostile/hostile" quick
