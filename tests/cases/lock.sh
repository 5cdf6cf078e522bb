#!/bin/bash
# timeout: 900
# One owner of a run's folder at a time, whatever became of the one before: dead, on another host,
# stopped and awake again.
# shellcheck disable=SC2086 # options are words
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# Runs that go on until somebody stops them; and what makes them end at step 600.
long="--set time.end=1000 --set checkpoint.every.steps=0"
short="--set checkpoint.every.steps=0"
run 1 reference heap $short

# begin OUT OPTIONS...: a run on one process, without mpirun, in the background; its id is `job`.
begin()
{
    local out=$1
    shift
    "$bin/tremie" run "$scenes/heap.yaml" --out "$out" "$@" > "$out.said" 2>&1 < /dev/null &
    job=$!
}

# wait_until COMMAND...: until it succeeds.
wait_until()
{
    local tries=0
    until "$@" 2> /dev/null; do
        sleep 0.02
        tries=$((tries + 1))
        [ $tries -le $((patience * 30)) ] || { why+=" '$*' does not come true;"; return; }
    done
}

# finished NAME: the run in `run` is taken up, comes to the right end, and leaves no lock.
finished()
{
    run 1 run heap $short "${@:2}"
    equal {reference,run}/checkpoints/step_000000000600.h5
    [ ! -e run/lock ] || why+=" it leaves its lock;"
    result "$1"
    rm -rf run
}

# forge HOST INTERVAL: a lock of a process on that host.
forge()
{
    mkdir -p run
    printf '%s\n' "token: 00000000deadbeef" "host: $1" "place: nowhere" "process: 4711" "started: 1" \
        "job: slurm 12" "since: 2020-01-01 00:00:00" "interval: $2" "heartbeat: 000000000000" > run/lock
}

# ------------------------------------------------------------------ many starters
for k in 1 2 3 4 5 6; do
    "$bin/tremie" run "$scenes/heap.yaml" --out run $long > said_$k 2>&1 < /dev/null &
    starters[k]=$!
done
wait_until grep -q '^state: running' run/status
alive=0
sleep 1
for k in 1 2 3 4 5 6; do
    if kill -0 ${starters[k]} 2> /dev/null; then
        alive=$((alive + 1)) job=${starters[k]}
    else
        status=0
        wait ${starters[k]} || status=$?
        [ $status = 2 ] || why+=" one that was not let in ends with status $status;"
        grep -q 'is in use by process' said_$k || why+=" one was not told why;"
    fi
done
[ $alive = 1 ] || why+=" $alive of 6 run;"
grep -q "^process: $job$" run/lock || why+=" the lock names another one;"
result "six starters at once: one runs"

# ------------------------------------------------------------------ the dead
kill -KILL "$job"
wait_for_end
[ -e run/lock ] || why+=" no lock is left to test with;"
for k in 1 2 3 4 5 6; do
    "$bin/tremie" run "$scenes/heap.yaml" --out run $long --wall 0:04 > said_$k 2>&1 < /dev/null &
    starters[k]=$!
done
ran=0
for k in 1 2 3 4 5 6; do
    status=0
    wait ${starters[k]} || status=$?
    [ $status != 75 ] || ran=$((ran + 1))
done
[ $ran = 1 ] || why+=" $ran of 6 ran;"
[ ! -e run/lock ] || why+=" a lock is left;"
result "six starters after one was killed: one runs"
rm -rf run

begin run $long
wait_until grep -q '^state: running' run/status
kill -KILL "$job"
wait_for_end
finished "killed with its lock: the next one goes on"

begin run $long
wait_until grep -q '^state: running' run/status
sed -i "s/^started: .*/started: 1/" run/lock # as if its number had been given to another process
run 1 run heap $short
grep -q "is in use" said && why+=" a process that only has the same number is taken for the owner;"
kill -KILL "$job"
wait_for_end
result "a dead owner's number given anew"
rm -rf run

# ------------------------------------------------------------------ another host
forge elsewhere 0.3
finished "another host's lock whose heart stands still"

forge elsewhere 0.5
(
    for n in {1..1000}; do
        sleep 0.1
        printf '%012d' "$n" 1<> run/lock
    done
) &
heart=$!
status=0
tremie 1 run "$scenes/heap.yaml" --out run $short || status=$?
[ $status = 2 ] || why+=" exit status $status, not 2;"
says "is in use by process 4711 on elsewhere, job slurm 12 since"
says "--take-over"
[ ! -e run/checkpoints ] || why+=" it wrote;"
result "another host's lock whose heart beats"
kill $heart
wait $heart 2> /dev/null
forge elsewhere 3600
finished "--take-over asks no heart" --take-over

# ------------------------------------------------------------------ stopped, robbed, awake again
digest() { find run -type f -exec sha256sum {} + | sort -k 2; }
for every in 0 1; do # the owner awakes between checkpoints, or in the midst of one
    begin run --set time.end=1000 --set checkpoint.every.steps=$every --set checkpoint.keep=3
    owner=$job
    wait_until grep -q '^state: running' run/status
    kill -STOP $owner
    tremie 1 run "$scenes/heap.yaml" --out run $short && why+=" the owner is only stopped, and yet robbed;"
    says "is in use by process $owner"
    job=
    status=0
    tremie 1 run "$scenes/heap.yaml" --out run $long --set checkpoint.keep=3 --take-over --wall 0:05 || status=$?
    [ $status = 75 ] || why+=" the robber ends with status $status;"
    says "is taken over from process $owner"
    digest > before
    kill -CONT $owner
    job=$owner
    status=0
    wait_for_end || status=$?
    [ $status = 4 ] || why+=" the robbed one ends with status $status;"
    grep -q 'this one leaves\|this process leaves' run.said || why+=" it does not say why it leaves;"
    digest | cmp -s before - || why+=" it changed: $(digest | diff before - | head -n 3);"
    result "stopped, robbed and awake: it writes nothing (checkpoint.every.steps=$every)"
    rm -rf run
done

begin run $long
owner=$job
wait_until grep -q '^state: running' run/status
run 1 run heap $short --take-over
job=$owner
status=0
wait_for_end || status=$?
[ $status = 4 ] || why+=" it ends with status $status;"
equal {reference,run}/checkpoints/step_000000000600.h5
result "--take-over from one that runs"
