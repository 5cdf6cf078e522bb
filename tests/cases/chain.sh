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
