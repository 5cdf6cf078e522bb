#!/bin/bash
# timeout: 1800
# Every job of jobs/: `tremie check` warns of nothing but what its header says, and at small size
# it ends well, does what it is about, and its complete states and series are equal bit for bit on
# 1, 2 and 3 ranks, when lists are made at other moments, and when it is killed on 8 half way, in
# the midst of what it is about, and resumed on 3.  Some lines of a job file are for this test:
#
#   # small: OPTIONS    what makes it small: some hundred spheres and steps, half of which fall into
#                       what the job is about (motion, insertion, removal)
#   # reaches: COLUMNS  of its series (as `tremie-info --csv` names them): what the job is about
#                       happens when these change, before it is killed as well as after
#   # after: NAME       it starts from what the small job NAME has left
#   # warns: TEXT       a warning of `tremie check` that holds this text is in order
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

scenes=$OLDPWD/jobs
saves=(--set checkpoint.every.wall=0 --set checkpoint.every.steps=200 --set checkpoint.keep=1000)
declare -A ran # jobs that have been run; their results are in NAME

# note NAME WORD: the rest of every line `# WORD: ...` of a job.
note() { sed -n "s/^# $2: *//p" "$scenes/$1.yaml"; }

# warnings NAME OPTIONS...: of `check` at full size, though of fewer spheres, which are placed sooner;
# each is expected, and each that is expected comes.
warnings()
{
    local name=$1 text count
    shift
    for count in $(note "$name" small | grep -o 'spheres[.0-9]*packing.count=[0-9]*'); do
        set -- "$@" --set "$count"
    done
    "$bin/tremie" check "$scenes/$name.yaml" "$@" > said 2> errors || why+=" check ends with status $?;"
    grep -E "^(warning|error):" errors > warned # MPI may say more
    note "$name" warns > expected
    why+=$(grep -vFf expected warned | sed 's/$/;/')
    while read -r text; do
        grep -qF -- "$text" warned || why+=" does not warn of '$text';"
    done < expected
    result "$name, what check warns of"
}

# reaches NAME STEP: what the job is about happens before and after that step.
reaches()
{
    "$bin/tremie-info" "$1" --csv series.csv > said 2>&1 || why+=" tremie-info ends with status $?;"
    why+=$(awk -F, -v step="$2" -v columns="$(note "$1" reaches)" '
        NR == 1 {
            for (i = 1; i <= NF; i++)
                place[$i] = i
            n = split(columns, column, " ")
            next
        }
        {
            for (k = 1; k <= n; k++) {
                value = $place[column[k]]
                if (NR > 2 && value != last[k])
                    changes[k, $1 > step]++
                last[k] = value
            }
        }
        END {
            if (n == 0)
                printf " the job has no line \"# reaches: COLUMNS\";"
            for (k = 1; k <= n; k++) {
                if (!(column[k] in place))
                    printf " its series has no %s;", column[k]
                else if (!changes[k, 0] || !changes[k, 1])
                    printf " %s changes %d times until step %d, %d times after;", column[k],
                        changes[k, 0], step, changes[k, 1]
            }
        }' series.csv)
}

# killed NAME OPTIONS...: half way on 8 ranks, resumed on 3.
killed()
{
    local name=$1 at
    shift
    start 8 this "$name" "$@" --set checkpoint.every.steps=50
    wait_until_after this $(($(newest "$name") / 2 - 1))
    kill_ranks
    [ -n "$why" ] || run 3 this "$name" "$@"
    at=$(sed -n 's/.*resumes at step \([0-9]*\).*/\1/p' said)
    [ -n "$at" ] || why+=" it is not resumed;"
    [ -n "$why" ] || same_run "$name" this
    [ -n "$why" ] || reaches "$name" "$at"
    result "$name killed half way on 8 ranks, resumed on 3"
    rm -rf this
}

# small NAME: all of the above.
small()
{
    local name=$1 after ranks counts="2 3" options=() from=()
    [ -z "${ran[$name]-}" ] || return 0
    ran[$name]=yes
    after=$(note "$name" after)
    read -ra options <<< "$(note "$name" small)"
    if [ -n "$after" ]; then
        small "$after"
        from=(--set "start.from=$PWD/$after")
    fi
    warnings "$name" "${from[@]}"
    [ "${#options[@]}" -gt 0 ] || why+=" the job has no line '# small: OPTIONS';"
    options+=("${saves[@]}" "${from[@]}")
    [ -n "$why" ] || run 1 "$name" "$name" "${options[@]}"
    if [ -n "$why" ]; then
        result "$name"
        return
    fi
    result "$name on 1 rank"
    [ -n "$thorough" ] || counts=3
    for ranks in $counts; do
        run "$ranks" this "$name" "${options[@]}"
        [ -n "$why" ] || same_run "$name" this
        result "$name on $ranks ranks"
        rm -rf this
    done
    run 1 this "$name" "${options[@]}" --set testing.search_every=31
    [ -n "$why" ] || same_run "$name" this
    result "$name with a search every 31 steps"
    rm -rf this
    killed "$name" "${options[@]}"
}

for file in "$scenes"/*.yaml; do
    file=${file##*/}
    small "${file%.yaml}"
done
