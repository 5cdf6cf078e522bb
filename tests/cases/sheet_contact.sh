#!/bin/bash
# Spheres on shells: at rest on both sides and on an edge against theory, rolling over seams and a rim, momentum of what
# nothing else acts on, and one that is forced through is called by its name.
set -uo pipefail
readers=$PWD/tests/cases
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

run 1 rest sheet_rest
run 1 turned sheet_rest --set gravity=[0,0,9.81]
run 1 roll sheet_roll
run 1 free sheet_free
run 1 smooth sheet_free --set contact.pairs.1.friction=0
result "spheres on shells"
if /usr/bin/python3 -c 'import h5py, numpy' 2> /dev/null; then
    /usr/bin/python3 "$readers/sheet_contact.py" rest turned roll free smooth
else
    echo "skip what happens: python3-h5py is not installed"
fi

# through LIMIT TEXT: with that watch.overlap the run fails and says so; on three ranks the same.
through()
{
    local ranks status
    for ranks in 1 3; do
        status=0
        rm -rf through
        tremie "$ranks" run "$scenes/through.yaml" --out through --set "watch.overlap=$1" || status=$?
        [ "$status" = 3 ] || why+=" exit status $status on $ranks ranks, not 3;"
        says "$2"
        [ "$(newest through)" = "$3" ] || why+=" the newest checkpoint is $(newest through), not $3;"
        grep '^error:' said > "said-$ranks"
    done
    [ "$(wc -l < said-3)" = 1 ] && diff said-1 said-3 > /dev/null || why+=" 3 ranks say something else;"
}
through 0.1 "sphere 1 at (0.113, 0.021, 0.01825) m and body 'sheet' overlap by 0.109 of a radius, more than watch.overlap = 0.1, and" 320
result "a sphere goes into a thin shell"
through 0.9 "and body 'sheet' overlap by 0.509 of a radius, more than the body is thick, so that the sphere goes through; use a" 420
result "a sphere goes through it"
