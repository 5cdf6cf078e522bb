#!/bin/bash
# timeout: 600
# What `tremie status` tells of a run while it runs, after it was killed, stopped and finished, for
# people and for programs, and what became of each of its processes.
# shellcheck disable=SC2086 # options are words
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

slow="--set testing.search=all-pairs --set testing.search_every=1 --set checkpoint.every.steps=25"
set -- --set time.end=2.4 # 12000 steps

# expect EXPRESSION: of the status as JSON, a Python object `s`, is true; h are its history's events.
expect()
{
    "$bin/tremie" status run --json > json || why+=" status gives $?;"
    /usr/bin/python3 -c "
import json, sys
s = json.load(open('json'))
h = [e['event'] for e in s['history']]
assert $1" 2> said || why+=" not so: $1; $(tr -d '\n' < json)"
}

"$bin/tremie" status nowhere > said 2>&1 && why+=" it succeeds;"
says "error: there is no run in nowhere"
result "no run"

start 2 run heap "$@" $slow
wait_until_after run 25
sleep 1.1 # it is told once a second
expect "s['state'] == 'running' and 0 < s['step'] < 12000 and s['n_steps'] == 12000"
expect "s['ranks'] == 2 and s['spheres'] == 180 and s['rate'] > 0 and s['seconds_left'] > 0"
expect "abs(s['time'] - 2e-4 * s['step']) < 1e-9 and abs(s['end'] - 2.4) < 1e-9"
expect "s['checkpoint']['step'] >= 25 and s['owner']['process'] in [$(pgrep -d , -P "$job")]"
expect "h == ['start'] and s['history'][0]['step'] == 0"
"$bin/tremie" status run > said
says "state: running"
says "remaining: "
result "running"

kill_ranks
expect "s['state'] == 'killed' and h == ['start']"
"$bin/tremie" status run > said
[ "$(tail -n 1 said | tr -d ' ')" = killed ] || why+=" the history does not end with it;"
"$bin/tremie" stop run > said 2>&1 || why+=" stop gives $?;"
says "nothing runs in run"
result "killed"

start 3 run heap "$@" $slow
export SLURM_JOB_ID=4711
at=$(newest run)
wait_until_after run "$at"
"$bin/tremie" stop run > said 2>&1
status=0
wait_for_end || status=$?
[ "$status" = 75 ] || why+=" exit status $status, not 75;"
expect "s['state'] == 'stopped' and h == ['start', 'start', 'end'] and s['owner'] is None"
expect "s['history'][1]['step'] == $at and s['history'][1]['job'] == ''"
expect "s['history'][2]['status'] == 75 and s['history'][2]['why'] == 'stopped as asked'"
result "stopped"

run 1 run heap "$@"
expect "s['state'] == 'finished' and s['step'] == 12000 and s['checkpoint']['step'] == 12000"
expect "h == ['start', 'start', 'end', 'start', 'end'] and s['history'][3]['job'] == 'slurm 4711'"
expect "s['history'][4]['status'] == 0 and s['history'][4]['why'] == 'finished'"
"$bin/tremie" status run > said
says ", job slurm 4711"
[ "$(grep -c ' killed$' said)" = 1 ] || why+=" not one was killed;"
result "finished"

run 1 run heap --fresh
expect "h == ['start', 'end']"
result "started over: a new history"
