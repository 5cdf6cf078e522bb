#!/bin/bash
# timeout: 1800
# The bits are a function of the job alone: complete states at the end and in between, and
# series, are equal for any number of ranks, any subdomains, any search and redistribution, any
# kernel.
# shellcheck disable=SC2046,SC2086,SC2102 # options are words
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# reference NAME SCENE OPTIONS...: an undisturbed run on one rank.
reference()
{
    local name=$1
    shift
    run 1 "$name" "$@"
    result "$name on 1 rank"
}

counts="2 3 4 5 8" seeds="1 2 3 4"
[ -n "$thorough" ] || counts=5 seeds=1
every() { echo "--set testing.search_every=$1"; }
both_levels() { echo "--set testing.redistribute_every=$1 --set testing.repartition_every=$2"; }
all_pairs="--set testing.search=all-pairs"

# ------------------------------------------------------------------ numbers of ranks, moments of search
for scene in heap mixed; do
    reference $scene $scene
    for ranks in $counts; do
        like $scene $ranks "$scene on $ranks ranks" $scene
    done
    like $scene 1 "$scene, search every step" $scene $(every 1)
    like $scene 3 "$scene on 3 ranks, search every 7 steps" $scene $(every 7)
    like $scene 1 "$scene, all pairs" $scene $all_pairs
    like $scene 2 "$scene on 2 ranks, all pairs, checkpoints by the clock" $scene $all_pairs \
        --set checkpoint.every.wall=0.2 --set checkpoint.keep=10000
    like $scene 3 "$scene on 3 ranks, both levels at odd moments" $scene $(both_levels 13 11)
    like $scene 4 "$scene on 4 ranks, cut anew every step" $scene $(both_levels 0 1) \
        --set decomposition.weights=candidates
    like $scene 2 "$scene on 2 ranks, narrow buffer" $scene --set decomposition.buffer=0.0005
    like $scene 5 "$scene on 5 ranks, wide buffer" $scene --set decomposition.buffer=0.5 \
        --set decomposition.imbalance=1
    rm -rf $scene
done

# ------------------------------------------------------------------ cuts through spheres and walls
reference cuts cuts
cut() { like cuts "$1" "cuts, $3 grid$4" cuts --set "decomposition.grid=$2" "${@:5}"; }
cut 2 [2,1,1] 2x1x1 ", wall half a radius beyond the cut"
cut 3 [3,1,1] 3x1x1 ", cuts anew every 9 steps" $(both_levels 9 9)
cut 4 [1,2,2] 1x2x2 ", search every 7 steps" $(every 7)
cut 5 [1,5,1] 1x5x1 ", subdomains thinner than a radius"
cut 8 [2,2,2] 2x2x2 ", a sphere larger than a subdomain"
cut 8 [8,1,1] 8x1x1 ", subdomains half a radius thin"
rm -rf cuts

# ------------------------------------------------------------------ seams and folds on cuts
reference seams seams
seam() { like seams "$1" "seams, $3 grid$4" seams --set "decomposition.grid=$2" "${@:5}"; }
seam 2 [2,1,1] 2x1x1 ", an edge on the cut, search every 3 steps" $(every 3)
seam 4 [2,2,1] 2x2x1 ", a vertex on both cuts, cuts anew every 9 steps" $(both_levels 9 9)
like seams 3 "seams on 3 ranks" seams
seam 8 [2,2,2] 2x2x2 ", a vertex on three cuts"
like seams 1 "seams, all pairs" seams $all_pairs
rm -rf seams

# ------------------------------------------------------------------ bodies that run into rest
reference bucket bucket
like bucket 1 "bucket, search every step" bucket $(every 1)
like bucket 1 "bucket, all pairs" bucket $all_pairs
like bucket 3 "bucket on 3 ranks" bucket
rm -rf bucket

# ------------------------------------------------------------------ space that repeats
reference periodic periodic
for ranks in $counts; do
    like periodic "$ranks" "periodic on $ranks ranks" periodic
done
like periodic 1 "periodic, search every step" periodic $(every 1)
like periodic 2 "periodic on 2 ranks, all pairs" periodic $all_pairs
like periodic 3 "periodic on 3 ranks, both levels at odd moments" periodic $(both_levels 13 11)
like periodic 8 "periodic, 4x1x2 grid, search every 7 steps" periodic $(every 7) \
    --set decomposition.grid=[4,1,2]
rm -rf periodic
# ------------------------------------------------------------------ what comes and goes
reference feed feed
for ranks in 2 3 8; do
    like feed $ranks "feed on $ranks ranks" feed
done
like feed 1 "feed, search every step, all pairs" feed $(every 1) $all_pairs
like feed 3 "feed on 3 ranks, both levels at odd moments" feed $(both_levels 13 11)
like feed 4 "feed, 2x2x1 grid" feed --set decomposition.grid=[2,2,1]
rm -rf feed

# ------------------------------------------------------------------ bodies that move in every way
reference machines machines
like machines 2 "machines on 2 ranks, search every 7 steps" machines $(every 7)
like machines 3 "machines on 3 ranks" machines
like machines 8 "machines on 8 ranks, both levels at odd moments" machines $(both_levels 13 11)
like machines 1 "machines, all pairs" machines $all_pairs
rm -rf machines

# ------------------------------------------------------------------ physics and kernels
# variants NAME SCENE OPTIONS...: another physics on one rank, three and eight.
variants()
{
    local name=$1 scene=$2
    shift 2
    reference "$name" "$scene" "$@"
    like "$name" 3 "$name on 3 ranks, search every 7 steps" "$scene" "$@" $(every 7)
    like "$name" 8 "$name on 8 ranks, both levels at odd moments" "$scene" "$@" $(both_levels 17 23)
}
for scene in heap mixed; do
    sticky="--set contact.pairs.0.friction=10 --set contact.pairs.1.friction=10"
    variants "$scene, friction 10" $scene $sticky
    variants "$scene, no ledger" $scene --set contact.ledger=false
    reference "$scene, best kernel" $scene
    for isa in generic v2 v3 v4; do
        if tremie 1 check "$scenes/$scene.yaml" --isa $isa; then
            like "$scene, best kernel" 2 "$scene, kernel $isa on 2 ranks" $scene --isa $isa
            like "$scene, no ledger" 1 "$scene, no ledger, kernel $isa" $scene --isa $isa \
                --set contact.ledger=false
        else
            grep -q "isa $isa does not run" said || echo "FAIL kernel $isa: $(head -n 1 said)"
        fi
    done
    rm -rf ./"$scene,"*
done

# ------------------------------------------------------------------ random scenes against all pairs
cp "$scenes/random.yaml" .
scenes=.
for seed in $seeds; do
    random_spheres $seed 200 > random.csv
    run 1 random random $all_pairs
    result "random scene $seed, all pairs"
    like random 1 "random scene $seed" random
    like random 3 "random scene $seed on 3 ranks" random
    rm -rf random
done
