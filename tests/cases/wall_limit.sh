#!/bin/bash
# timeout: 600
# Runs that are given less wall time than they need stop before it is over, with a checkpoint and
# the status that asks for another go, and lose nothing by it.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

long="--set time.end=1000 --set checkpoint.every.steps=0" # more than anybody waits for

# ended STATUS: of the run just made; it is to have stopped in time.
ended()
{
    [ "$1" = 75 ] || why+=" exit status $1, not 75;"
    says "stopped before the wall time ends with a checkpoint at step "
    [ "$(newest run)" -gt 0 ] || why+=" there is no checkpoint;"
}

began=$(date +%s%N) status=0
# shellcheck disable=SC2086 # options are words
"$bin/tremie" run "$scenes/heap.yaml" --out run $long --wall 0:05 > said 2>&1 < /dev/null || status=$?
took=$((($(date +%s%N) - began) / 1000000))
ended $status
[ $took -lt 5000 ] || why+=" it took $took ms;"
[ -z "$thorough" ] || [ $took -gt 1000 ] || why+=" it took only $took ms;"
result "--wall 0:05"

at=$(newest run) status=0
# shellcheck disable=SC2086
SLURM_JOB_END_TIME=$(($(date +%s) + 4)) tremie 2 run "$scenes/heap.yaml" --out run $long || status=$?
ended $status
says "resumes at step $at "
[ "$(newest run)" -gt "$at" ] || why+=" it has not moved on;"
grep -q 'of wall time are left (SLURM_JOB_END_TIME)' run/log || why+=" the log does not say whose limit;"
result "the end that Slurm names"

end=$(awk -v n="$(newest run)" 'BEGIN {printf "%.4f", n * 2e-4}')
run 1 reference heap --set "time.end=$end" --set checkpoint.every.steps=0
equal {reference,run}/checkpoints/"step_$(printf %012d "$(newest run)").h5"
result "stopped twice by the clock: the state of one that was not"

run 1 by_time heap --set checkpoint.every.steps=0 --set checkpoint.every.time=0.03
[ "$(ls by_time/checkpoints)" = "$(printf 'step_%012d.h5\n' 150 300 450 600)" ] || why+=" other checkpoints;"
result "checkpoints by simulated time"
run 1 often heap --set checkpoint.every.steps=0 --set checkpoint.every.mtbf=1e-12
[ "$(find often/checkpoints -name '*.h5' | wc -l)" = 100 ] || why+=" few checkpoints;"
equal {by_time,often}/checkpoints/step_000000000600.h5
result "checkpoints as often as failures ask for change nothing"

for wrong in 0 soon 1:; do
    "$bin/tremie" run "$scenes/heap.yaml" --wall $wrong > said 2>&1 && why+=" --wall $wrong is taken;"
    says "--wall $wrong is no time above 0"
done
result "what is no wall time"
