#!/bin/bash
# timeout: 600
# Random packings and runs that start from another one: the same bits on any number of ranks, and,
# with nothing changed, those of the run that went on by itself.
# shellcheck disable=SC2086 # options are words
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# refused TEXT SCENE OPTIONS...: `check` says the text and ends with status 2.
refused()
{
    local text=$1 scene=$2 status=0
    shift 2
    tremie 1 check "$scene" "$@" || status=$?
    [ "$status" = 2 ] || why+=" exit status $status, not 2;"
    says "$text"
}

# ---------------------------------------------------------------- random packings

run 1 settled settle
for ranks in 2 3; do
    run $ranks other settle
    same_run settled other
    rm -rf other
done
result "a random packing settles alike on 1, 2, 3 ranks"

# ---------------------------------------------------------------- chained runs

# The order of the spheres is renewed at step 2000, as at the start of a run.
sed '/^spheres:/,/^bodies:/{/^bodies:/!d}' "$scenes/settle.yaml" > same.yaml
echo "start: {from: settled/checkpoints/step_000000002000.h5}" >> same.yaml
tremie 3 run same.yaml --out same --set time.end=0.02 || why+=" ends with status $?;"
"$bin/tremie-compare" settled/checkpoints/step_000000003000.h5 \
    same/checkpoints/step_000000001000.h5 > compared 2>&1
grep -q "fields differ" compared || why+=" cannot be compared;"
grep '^/' compared | grep -v '^/monitors\|^/run@\|^/notes\|dissipated\|group' > differing &&
    why+=" differs in $(head -n 1 differing);"
result "a chained run goes on as the other one did"

from="--set start.from=$PWD/settled"
run 1 chained chain $from
for ranks in 2 3; do
    run $ranks other chain $from
    same_run chained other
    rm -rf other
done
result "a chained run is the same on 1, 2, 3 ranks"

run 1 stopped chain $from --set start.velocities=zero
"$bin/tremie-compare" chained stopped > compared 2>&1 && why+=" velocities are kept;"
run 2 other chain $from --set start.velocities=zero
same_run stopped other
rm -rf other
result "a chained run that starts at rest"

run 3 other chain $from --set time.end=0.01
mv settled gone
run 2 other chain $from
same_run chained other
refused "there is no such file, or no checkpoint in that folder" "$scenes/chain.yaml" $from
mv gone settled
rm -rf other
result "a chained run resumes without the other one"

# ---------------------------------------------------------------- killed before its first checkpoint

# killed OUT: a run from `source` that has begun and is gone before it has a checkpoint.
killed()
{
    local tries=0
    rm -rf "$1"
    start 2 "$1" chain $source --set time.end=1000 --set checkpoint.every.steps=0
    while [ ! -f "$1/status" ] && [ $tries -lt $((patience * 50)) ] && kill -0 "$job" 2> /dev/null; do
        sleep 0.02
        tries=$((tries + 1))
    done
    kill_ranks
    [ "$(newest "$1")" = 0 ] || why+=" it had a checkpoint;"
}

# unusable TEXT: the killed run does not go on, and says this.
unusable()
{
    local status=0
    tremie 2 run "$scenes/chain.yaml" --out other $source || status=$?
    [ "$status" = 2 ] || why+=" exit status $status, not 2;"
    says "start.from: $PWD/source: step_000000003000.h5 $1 since the run"
    says "or --fresh"
}

source="--set start.from=$PWD/source"
mkdir -p source/checkpoints
cp settled/checkpoints/step_000000002000.h5 source/checkpoints/
run 2 whole chain $source
killed other
cp settled/checkpoints/step_000000003000.h5 source/checkpoints/
grep -q '^  checkpoint: "*step_000000002000.h5"*$' other/job.yaml || why+=" the job as used does not say from which;"
run 3 other chain $source
says "starts from $PWD/source/checkpoints/step_000000002000.h5, step 2000 "
same_run whole other
run 1 named chain $source --set start.checkpoint=step_000000002000.h5
same_run whole named
run 3 again chain $source --restart other/checkpoints/step_000000000500.h5
equal {whole,again}/checkpoints/step_000000001000.h5
result "killed before its first checkpoint it starts from the same"

killed other
printf x >> source/checkpoints/step_000000003000.h5
unusable "has changed"
rm source/checkpoints/step_000000003000.h5
unusable "has gone"
run 2 other chain $source --fresh
says "starts from $PWD/source/checkpoints/step_000000002000.h5, step 2000 "
equal whole/checkpoints/step_000000001000.h5 other/checkpoints/step_000000001000.h5
rm -rf other
result "what it started from has changed or gone"

# ---------------------------------------------------------------- names of groups

tremie 1 check "$scenes/chain.yaml" $from || why+=" check ends with status $?;"
says "start     $PWD/settled/checkpoints/step_000000003000.h5, step 3000 (0.06 s)"
says "spheres   fill: 300 of ore, "
says "spheres   ball: "
"$bin/tremie-info" chained/checkpoints/step_000000001000.h5 > said
says "group fill        300 of "
says "group more        30 of "
# One of them has a group of the job's own, and goes on in it.
sed 's/name: more/name: fill/; s/from: settled/from: chained/' "$scenes/chain.yaml" > twice.yaml
tremie 2 run twice.yaml --out twice --set start.from="$PWD/chained" --set spheres.0.packing.count=5 \
    --set 'output.snapshots={every: 0.02, fields: [group]}' || why+=" twice ends with status $?;"
"$bin/tremie-info" twice/checkpoints/step_000000001000.h5 > said
says "group fill        305 of "
says "group more        30 of "
says "group ball        5 of ore, "
grep -aqx ball twice/snapshots/step_000000001000.h5 || why+=" the snapshot does not name them;"
result "groups keep their names"

# ---------------------------------------------------------------- spheres from HDF5

sed -e '/^start:/d' -e 's/^spheres:/&\n  - {name: old, material: ore, packing: {kind: hdf5, file: settled\/checkpoints\/step_000000003000.h5}}/' \
    "$scenes/chain.yaml" > packed.yaml
tremie 1 run packed.yaml --out packed || why+=" ends with status $?;"
tremie 2 run packed.yaml --out other || why+=" ends with status $?;"
same_run packed other
refused "spheres.0.radius" packed.yaml --set spheres.0.radius=x
echo "no HDF5" > text.h5
sed 's/file: [^}]*/file: text.h5/' packed.yaml > text.yaml
refused "text.h5: " text.yaml
says "an HDF5 file with /spheres/position and radius is expected"
result "spheres from HDF5"

# ---------------------------------------------------------------- what does not match

sed 's/\bore\b/dust/g' "$scenes/chain.yaml" > dust.yaml
refused "holds spheres of the material 'ore', which the job does not have; a material of" dust.yaml
result "a material that the job lacks"

sed '/ore, new/d' "$scenes/chain.yaml" > pair.yaml
refused "contact.pairs say nothing about ore, of the spheres of start, and new; {between:" pair.yaml
result "a pair that the job lacks"

sed 's/kind: box, /&open: top, /' "$scenes/chain.yaml" > open.yaml
refused "spheres 'more': the region: 'bin' is not closed: 4 of its edges are open, one at" open.yaml
result "the inside of an open body"

refused "spheres 'more': random addition was asked for" "$scenes/chain.yaml" $from --set spheres.0.packing.count=100000
says ": no room is left for the next; less, a lattice, or letting them settle is expected"
result "more spheres than find room"
