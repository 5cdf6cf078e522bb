#!/bin/bash
# timeout: 1800
# Runs that are killed, stopped and taken up again on other numbers of ranks end with the bits
# of one that nothing disturbed.
# shellcheck disable=SC2046,SC2086 # options are words
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

pause_at_random() { sleep "0.$(printf %03d $((RANDOM % 300)))"; }

# end_with SIGNAL STATUS: sends it to mpirun, which is to end so.
end_with()
{
    local status=0
    kill -"$1" "$job" 2> /dev/null || why+=" it ended before SIG$1;"
    wait_for_end || status=$?
    [ "$status" = "$2" ] || why+=" after SIG$1 the status is $status, not $2;"
}

# digest RUN: of all that a run has kept, its messages aside.
digest()
{
    (cd "$1" && find . -type f ! -name log ! -name lock | sort | xargs sha256sum)
}

slow="--set testing.search=all-pairs --set testing.search_every=1"
every=25 # steps between checkpoints

# ------------------------------------------------------------------ killed on 3, stopped on 2, ended on 5
# relay NAME SCENE OPTIONS...
relay()
{
    local name=$1 scene=$2 at file
    shift 2
    set -- "$@" --set checkpoint.every.steps=$every
    run 1 reference "$scene" "$@"
    set -- "$@" --set checkpoint.keep=3
    start 3 relay "$scene" "$@" $slow
    wait_until_after relay 0
    pause_at_random
    kill_ranks
    result "$name, killed on 3 ranks"
    at=$(newest relay)
    start 2 relay "$scene" "$@" $slow --set testing.repartition_every=3
    wait_until_after relay "$at"
    pause_at_random
    end_with USR1 75
    says "the same command resumes"
    [ "$(newest relay)" -gt "$at" ] || why+=" there is no new checkpoint;"
    result "$name, resumed on 2 ranks, stopped by SIGUSR1"
    at=$(newest relay)
    run 5 relay "$scene" "$@"
    says "resumes at step $at "
    [ "$(find relay/checkpoints -name '*.h5' | wc -l)" = 3 ] || why+=" not 3 checkpoints are kept;"
    for file in reference/checkpoints/*.h5; do # those that were not kept
        [ -e "relay/checkpoints/${file##*/}" ] || rm "$file"
    done
    same_run reference relay
    result "$name, resumed on 5 ranks: the same state and series"
    rm -rf reference relay
}

relay heap heap
relay mixed mixed
relay machines machines
relay periodic periodic
relay feed feed
[ -z "$thorough" ] || relay "heap with friction 10" heap --set contact.pairs.0.friction=10
relay "mixed with friction 10, no ledger" mixed --set contact.pairs.0.friction=10 \
    --set contact.ledger=false

# ------------------------------------------------------------------ an end that is an end
set -- --set checkpoint.every.steps=$every
run 1 reference mixed "$@"
run 3 run mixed "$@"
digest run > before
run 2 run mixed "$@"
says "nothing to do"
digest run | cmp -s before - || why+=" it changed what was there;"
result "the same command after the end does nothing"

# As if killed between the last checkpoint and the rows of the last instant.
rm "$(find run/series -name 'step_*.h5' | sort | tail -n 1)"
run 2 run mixed "$@"
same_run reference run
result "killed before the last rows: the same command adds them"
rm -rf run

run 2 run mixed "$@" --set time.end=0.0637
run 3 run mixed "$@"
rm run/checkpoints/step_000000000637.h5
same_run reference run
result "a longer end: the same as in one go"

# ------------------------------------------------------------------ from a checkpoint of choice
run 3 run mixed "$@" --restart run/checkpoints/step_000000000400.h5
says "resumes at step 400 "
says "files of steps after 400 are now in run/set_aside_"
same_run reference run
result "--restart FILE goes back to that state"
run 4 other mixed "$@" --restart run/checkpoints/step_000000000600.h5
equal reference/checkpoints/step_000000001000.h5 other/checkpoints/step_000000001000.h5
result "--restart FILE of another folder"
run 2 run mixed "$@" --fresh
says "starting over: what was in run is now in run/set_aside_"
same_run reference run
ls run/set_aside_*/checkpoints/step_000000001000.h5 > /dev/null 2>&1 || why+=" what was there is gone;"
result "--fresh starts over and sets aside"
rm -rf run other

# ------------------------------------------------------------------ ways to stop
# stopped NAME: after a run in `run` has stopped, the same command comes to the same end.
stopped()
{
    [ -n "$why" ] || run 3 run mixed "${options[@]}"
    rm -f run/checkpoints/*[!05].h5 # of the stop, which the reference does not have
    [ -n "$why" ] || equal reference run
    [ -n "$why" ] || equal {reference,run}/checkpoints/step_000000001000.h5
    result "$1"
    rm -rf run
}
options=("$@")

start 2 run mixed "$@" $slow
wait_until_after run 0
end_with USR2 75
stopped "SIGUSR2"

start 2 run mixed "$@" $slow
wait_until_after run 0
ranks=$(pgrep -P "$job")
kill -STOP $ranks # it must not end before it has been asked
tremie 1 run "$scenes/mixed.yaml" --out run "$@" && why+=" a second run in its folder is let in;"
says "is in use by process"
"$bin/tremie" stop run > said 2>&1 || why+=" stop gives status $?;"
kill -CONT $ranks
end_with CONT 75 # which does nothing to it
stopped "tremie stop, and no second run in a folder in use"

for signal in TERM INT; do
    # A program that is started without mpirun meets this setting in a way that confuses LeakSanitizer.
    "$bin/tremie" run "$scenes/mixed.yaml" --out run "$@" $slow > said 2>&1 < /dev/null &
    job=$!
    wait_until_after run 0
    end_with $signal 75
    stopped "SIG$signal to a rank itself"
done
