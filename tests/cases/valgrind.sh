#!/bin/bash
# timeout: 900
# A small run and its going on, on one rank and on two, without a wrong access or a leak of ours.
set -uo pipefail
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

command -v valgrind > /dev/null || { echo "skip valgrind: it is not installed"; exit 0; }
[ -n "$thorough" ] || { echo "skip valgrind: sanitizers look at the same"; exit 0; }

# Valgrind knows no instructions of 512 bits.
set -- --set time.end=0.002 --set checkpoint.every.steps=5 --isa v2 --set output.snapshots.every=0.001

# checked RANKS SCENE OPTIONS...: a run under valgrind, which is to finish without complaint.
checked()
{
    local ranks=$1 scene=$2 status=0
    shift 2
    timeout -k 5 600 mpirun --oversubscribe --bind-to none -q -n "$ranks" valgrind -q --error-exitcode=99 \
        --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite \
        --suppressions="$here/valgrind.supp" --gen-suppressions=all \
        "$bin/tremie" run "$scenes/$scene.yaml" --out "run_$scene" "$@" > said 2>&1 < /dev/null || status=$?
    [ "$status" = 0 ] || why+=" status $status;"
}

checked 1 feed "$@"
checked 2 feed "$@" --set time.end=0.003
result "insertion, removal, resumed on two ranks"
