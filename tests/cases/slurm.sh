#!/bin/bash
# timeout: 600
# The scripts of jobs/batch under a real Slurm: signalled, requeued, preempted, cancelled, in a chain and
# in an array, runs end with the bits of one that nothing disturbed.
set -uo pipefail
root=$PWD
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"
PATH=$PATH:/usr/sbin:/sbin

for program in slurmctld slurmd munged; do
    command -v $program > /dev/null || { echo "skip under Slurm: $program is not installed"; exit 0; }
done
[ "$(id -u)" = 0 ] || { echo "skip under Slurm: only root can start its daemons"; exit 0; }

# The folder that tremie is in, with these programs.
mkdir place
ln -s "$root/config" "$root/jobs" "$root/tests" place
ln -s "$bin" place/bin
cd place || exit 1
trap '"$root/tests/slurm" stop ../slurm' EXIT
if ! "$root/tests/slurm" start ../slurm > said 2>&1; then
    echo "skip under Slurm: it does not start here: $(tail -n 1 said)"
    exit 0
fi
export SLURM_CONF=$PWD/../slurm/slurm.conf
export OMPI_MCA_rmaps_base_oversubscribe=1 OMPI_MCA_hwloc_base_binding_policy=none

# A job that takes some seconds, more where tests are slow.
sed 's/^time: .*/time: {end: 12.8, step: 2.0e-4}/; s/steps: 150}, keep: 100/steps: 2000}, keep: 2/' \
    "$scenes/heap.yaml" > heap.yaml
last=checkpoints/step_000000064000.h5
{
    cat heap.yaml
    echo 'sweep: [{key: contact.pairs.0.friction, values: [0.3, 0.4, 0.5]}]'
} > study.yaml
export JOB=heap.yaml RUN
for friction in 0.3 0.5; do # 0.5 is the job's own
    tremie 1 run heap.yaml --out "friction_$friction" --set "contact.pairs.0.friction=$friction" ||
        why+=" the reference ends with status $?;"
done
result "reference runs"
reference=friction_0.5

# submit OPTIONS... SCRIPT: its id is `id`.
submit() { id=$(sbatch --parsable --ntasks=2 --time=5 --output=%x-%A_%a.out "$@" 2> said) || why+=" sbatch fails;"; }

# until_true COMMAND...: until it succeeds.
until_true()
{
    local tries=0
    until "$@" > /dev/null 2>&1; do
        sleep 0.05
        tries=$((tries + 1))
        [ $tries -le 600 ] || { why+=" '$*' does not come true;"; return; }
    done
}

state() { scontrol -o show job "$1" 2> /dev/null | sed -n 's/.* JobState=\([A-Z_]*\) .*/\1/p' | sort -u; }
is() { [ "$(state "$1")" = "$2" ]; }
events() { grep -c " $1 " "$RUN/history" 2> /dev/null; }
ended() { [ "$(events end)" = "$1" ]; }
started() { [ "$(events start)" = "$1" ] && [ "$(newest "$RUN")" -gt "$2" ]; }

# goes_on ID: a requeued job waits until it is told not to; started in the second in which it ended,
# it would be taken for the one that has ended.
goes_on()
{
    until_true is "$1" PENDING
    sleep 1.2
    scontrol update JobId="$1" StartTime=now || why+=" it cannot be started;"
}

# ------------------------------------------------------------------ signalled and requeued three times, preempted once
RUN=requeued
submit jobs/batch/slurm_requeue.sh
at=0
for k in 1 2 3; do
    until_true started $k "$at"
    at=$(newest $RUN)
    scancel --batch --signal=USR1 "$id"
    until_true ended $k
    goes_on "$id"
done
[ "$(events end)" = 3 ] || why+=" it was stopped $(events end) times, not 3;"
[ "$(grep -c 'status 75 .*by a signal' $RUN/history)" = 3 ] || why+=" not by signals with status 75;"
grep -q "job slurm $id" $RUN/history || why+=" the history does not name the job;"
result "signalled and requeued three times"

until_true started 4 "$at"
mine=$id
submit --partition=high --job-name=urgent --wrap=true
until_true is "$id" COMPLETED
[ "$(events end)" = 4 ] || why+=" preempted, it did not stop with a checkpoint;"
goes_on "$mine"
until_true is "$mine" COMPLETED
[ "$(scontrol -o show job "$mine" | sed -n 's/.* Restarts=\([0-9]*\) .*/\1/p')" = 4 ] || why+=" not 4 restarts;"
equal {$reference,$RUN}/$last
equal $reference $RUN
grep -q 'of wall time are left (SLURM_JOB_END_TIME)' $RUN/log || why+=" it did not know its time;"
result "preempted, requeued and finished: the same state and series"

# ------------------------------------------------------------------ cancelled
RUN=cancelled
submit jobs/batch/slurm_requeue.sh
until_true started 1 0
scancel "$id"
until_true is "$id" CANCELLED
until_true ended 1
sleep 0.5
is "$id" CANCELLED || why+=" it is $(state "$id");"
grep -q 'status 75' $RUN/history || why+=" it did not stop with a checkpoint;"
result "cancelled: a checkpoint, and it is not requeued"

# ------------------------------------------------------------------ a chain
RUN=chain
ids=()
for k in 1 2 3; do
    submit jobs/batch/slurm_chain.sh
    ids+=("$id")
done
until_true started 1 0
is "${ids[1]}" PENDING || why+=" the second does not wait for the first;"
scancel --batch --signal=USR1 "${ids[0]}"
until_true is "${ids[2]}" COMPLETED
is "${ids[1]}" COMPLETED || why+=" the second is $(state "${ids[1]}");"
[ "$(events start)" = 2 ] || why+=" $(events start) of the chain's jobs ran, not 2;"
equal {$reference,$RUN}/$last
equal $reference $RUN
result "a chain by singleton"

# ------------------------------------------------------------------ a study
export STUDY=study
mkdir reference && mv friction_* reference
JOB=study.yaml
submit --array=1,3 --ntasks=1 jobs/batch/slurm_array.sh
for value in 0.3 0.5; do
    RUN=study/friction_$value
    until_true [ -e "$RUN/series/step_000000064001.h5" ]
    equal {reference/friction_$value,$RUN}/$last
done
until_true is "$id" COMPLETED
"$bin/tremie" status study > said || why+=" status gives $?;"
says "variant 1: finished, step 64000 of 64000; friction 0.3, in friction_0.3"
says "variant 2: not started"
says "2 finished, 1 not started of 3 variants"
result "an array over the variants of a study"
