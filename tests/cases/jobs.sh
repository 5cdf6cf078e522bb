#!/bin/bash
# timeout: 1800
# Every job of jobs/ at small size: it ends well, and its complete states and series are equal bit
# for bit on 1, 2, 3 and (but for three of them) 8 ranks and when it is killed half way and resumed
# on another number of ranks.  Two lines of a job file are for this test:
#
#   # small: OPTIONS    what makes it small: some hundred spheres and steps, half of which fall into
#                       what the job is about (motion, insertion, removal)
#   # after: NAME       it starts from what the small job NAME has left
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

scenes=$OLDPWD/jobs
saves=(--set checkpoint.every.wall=0 --set checkpoint.every.steps=50 --set checkpoint.keep=1000)
slow=(--set testing.search_every=1 --set checkpoint.every.steps=5) # waits for the disk: no load
alike="drum_soft hopper_empty silo_settle" # scenes of other jobs: not on 8 ranks as well
declare -A ran # jobs that have been run; their results are in NAME

# note NAME WORD: the rest of the line `# WORD: ...` of a job.
note() { sed -n "s/^# $2: *//p" "$scenes/$1.yaml" | head -n 1; }

# small NAME: all of the above.
small()
{
    local name=$1 after ranks counts="2 3" options=()
    [ -z "${ran[$name]-}" ] || return 0
    ran[$name]=yes
    after=$(note "$name" after)
    read -ra options <<< "$(note "$name" small)"
    [ "${#options[@]}" -gt 0 ] || why+=" the job has no line '# small: OPTIONS';"
    options+=("${saves[@]}")
    if [ -n "$after" ]; then
        small "$after"
        options+=(--set "start.from=$PWD/$after")
    fi
    [ -n "$why" ] || run 1 "$name" "$name" "${options[@]}"
    if [ -n "$why" ]; then
        result "$name"
        return
    fi
    result "$name on 1 rank"
    [[ " $alike " = *" $name "* ]] || counts+=" 8"
    [ -n "$thorough" ] || counts=3
    for ranks in $counts; do
        run "$ranks" this "$name" "${options[@]}"
        [ -n "$why" ] || same_run "$name" this
        result "$name on $ranks ranks"
        rm -rf this
    done
    start 3 this "$name" "${options[@]}" "${slow[@]}"
    wait_until_after this $(($(newest "$name") / 2 - 1))
    kill_ranks
    [ -n "$why" ] || run 2 this "$name" "${options[@]}"
    says "resumes at step "
    [ -n "$why" ] || same_run "$name" this
    result "$name killed half way on 3 ranks, resumed on 2"
    rm -rf this
}

for file in "$scenes"/*.yaml; do
    file=${file##*/}
    small "${file%.yaml}"
done
