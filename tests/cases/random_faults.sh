#!/bin/bash
# timeout: 600
# Twenty faults of every kind from fixed seeds (tests/faults/run); `make soak` has hundreds.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
[ "${FLAVOUR:-release}" = release ] || { echo "skip random faults: their library has to be loaded before the sanitizers'"; exit 0; }
"$here/../faults/run" --seed 28 --faults 20 --scenes "heap feed" > "$SCRATCH/said" 2>&1 < /dev/null
status=$?
sed "s/^\([0-9]* faults struck\)/note: \1/" "$SCRATCH/said"
[ $status = 0 ]
