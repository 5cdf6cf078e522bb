#!/bin/bash
# timeout: 900
# Bodies that deform have the bits of the job: complete states and series are equal on any number of
# ranks, for any search, kernel and restart, with plastic flow, both kinds of elements, and spheres
# that roll over facets whose nodes other ranks move.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"
python=/usr/bin/python3

run 1 one deform
result "spheres on solids, on 1 rank"

counts="2 3 4 5 8"
[ -n "$thorough" ] || counts=3
for ranks in $counts; do
    like one "$ranks" "on $ranks ranks" deform
done
like one 2 "search every 7 steps" deform --set testing.search_every=7
like one 1 "all pairs" deform --set testing.search=all-pairs
like one 3 "other subdomains" deform --set decomposition.grid=[1,3,1] --set decomposition.buffer=0.02
for isa in generic v2 v3 v4; do
    if tremie 1 check "$scenes/deform.yaml" --isa $isa; then
        like one 1 "kernels of $isa" deform --isa $isa
    else
        grep -q "isa $isa does not run" said || echo "FAIL kernels of $isa: $(head -n 1 said)"
    fi
done

start 2 killed deform
wait_until_after killed 300
kill_ranks
run 3 killed deform
says "resumes at step"
same_run one killed
result "killed on 2 ranks, resumed on 3"

# What the scene is for must happen in it.
if "$python" - one << 'END' > seen 2>&1
import glob, sys
import h5py
series = [h5py.File(name)["series"] for name in sorted(glob.glob(sys.argv[1] + "/series/*.h5"))]
last = {name: series[-1][name][-1] for name in series[-1]}
turned = sum(abs(last[name]) for name in last if name.startswith(("kinetic", "elastic", "dissipated", "work")))
state = h5py.File(sorted(glob.glob(sys.argv[1] + "/checkpoints/*.h5"))[-1])
assert last["dissipated_plastic"] > 0.02 * turned, last["dissipated_plastic"]
assert abs(last["balance"]) < 2e-3 * turned, last["balance"]
assert (state["elements/plastic_strain"][()] > 0.0).sum() > 50
assert max(max(part["n_facet_contacts"][()]) for part in series) > 10
assert abs(state["nodes/velocity"][-1]).max() > 0.1  # of the brick
END
then
    result "plastic flow, the balance of energy, spheres on deforming facets"
elif grep -q "No module named" seen; then
    echo "skip what happens: python3-h5py is not installed"
else
    why=" $(tail -n 1 seen);"
    result "plastic flow, the balance of energy, spheres on deforming facets"
fi

# Balls on nodes in a face, on an edge and a corner press dents; what springs hold follows from where things are, so no
# energy comes of them. What is off comes and goes with the elements' strain.
run 1 dents dents
"$bin/tremie-info" dents --csv dents.csv > said 2>&1 || why+=" tremie-info ends with status $?;"
awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    NR == 2 { all = $at["kinetic_translation_J"] }
    { off = $at["balance_J"]; worst = off * off > worst * worst ? off : worst; last = off
      most = $at["elastic_J"] > most ? $at["elastic_J"] : most }
    END { if (!(most > 0.4 * all && worst * worst < (1e-3 * all) ^ 2 && last * last < (3e-4 * all) ^ 2)) print worst, last, most }
' dents.csv > off
[ ! -s off ] || why+=" of the energy $(cat off) J are found at most, at the end, in springs;"
result "no energy out of nodes, edges and corners"

# A column that bears (10 + 90) kg at rest, and a strip whose end cannot turn, so that half its period is
# pi sqrt((M + 13/35 m) (L^3 / 12 E I + L / k G A)); free to turn it were twice that.
run 1 masses masses
series masses
near "what bears the column" "$(columns 'END { print $at["column.z_max.reaction_z_N"] }')" 10 1e-3
near "half a period of the strip" "$(columns '{
    v = $at["tip.velocity_z_m_s"]
    if (NR > 3 && v * last < 0) {
        crossing = time + last / (last - v) * ($at["time_s"] - time)
        print crossing - before
        before = crossing
    }
    last = v
    time = $at["time_s"]
}' | tail -n 1)" 1.1154 0.01
result "masses at ends"
tremie 1 run "$scenes/masses.yaml" --out masses --set bodies.0.masses.0.mass=91 && why+=" resumes with another mass;"
says "belongs to another job: bodies.0.masses.0.mass: was 90, now 91"
result "another mass is another job"
run 1 short masses --set time.end=0.4
start 2 cut masses --set time.end=0.4
wait_until_after cut 900
kill_ranks
run 2 cut masses --set time.end=0.4
same_run short cut
result "masses on 2 ranks, killed and resumed"
