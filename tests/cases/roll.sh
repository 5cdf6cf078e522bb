#!/bin/bash
# A ball that rolls over a mesh that gives way under it: no facet's edge is felt, nothing is made or
# lost of momentum and energy.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"
python=/usr/bin/python3

# bend: the largest change of the force's change from row to row of series.csv, over the largest force, while the ball is on.
bend()
{
    columns '{ f[n++] = $at["block.force_z_N"] ^ 2 } END {
        for (k = 0; k < n; k++) { f[k] = sqrt(f[k]); most = f[k] > most ? f[k] : most }
        for (k = 3; k < n - 3; k++) {
            b = f[k - 1] - 2 * f[k] + f[k + 1]
            if (f[k - 3] > 0 && f[k + 3] > 0 && b * b > worst) worst = b * b
        }
        print sqrt(worst) / most }'
}

run 1 ball roll
series ball
cp series.csv ball.csv
# It is on for 17.6 ms, 26 mm along x, and gives most of what it brought across to the block.
near "how long it was on" "$(columns '$at["block.force_z_N"] < 0 { n++ } END { print n * 0.02 }')" 17.6 0.02
near "its speed across, after" "$(columns 'END { print $at["ball.velocity_z_m_s"] }')" -0.0345 0.05
# Energy: 1e-3 of what the impact turns over, 3.8e-4 J.
near "what is found of it" "$(columns '{ off = $at["balance_J"] ^ 2; worst = off > worst ? off : worst } END { print 1 + sqrt(worst) / 3.8e-4 }')" 1 1e-3
result "a ball rolls over a dent"
# A seam would be a jump: a facet or its edge dropped or taken twice changes the force by a part of it, whatever the step.
# What bends does so less in a shorter step, by its square: in a quarter of the step a fourth of it at most, 6 times less here.
coarse=$(bend)
run 1 quarter roll --set time.step=5us --set output.series.every=5us --set checkpoint.every.steps=100000
series quarter
fine=$(bend)
awk -v coarse="$coarse" -v fine="$fine" 'BEGIN { exit !(coarse > 0 && coarse < 5e-4 && fine < coarse / 4) }' ||
    why+=" the force bends by $coarse of the largest in a step, $fine in a quarter of it;"
result "no seams in its force"
# With cells half as large: what the dent's facets do to the force, and that there are but four layers of cells, is 4.4 % of
# the largest force.
run 1 smooth roll --set time.step=10us --set bodies.0.mesh.cells=[40,16,8] --set checkpoint.every.steps=100000
series smooth
columns '{ print $at["block.force_z_N"] }' > smooth.force
cp ball.csv series.csv
columns '{ print $at["block.force_z_N"] }' > ball.force
near "the force beside that of a finer mesh" "$(paste -d, smooth.force ball.force | awk -F, '
    { off = ($1 - $2) ^ 2; worst = off > worst ? off : worst; most = -$2 > most ? -$2 : most }
    END { print (most > 0 ? 1 + sqrt(worst) / most : 2) }')" 1 0.06
result "a finer mesh says the same"
run 3 three roll
same_run ball three
result "the same on 3 ranks"

if "$python" - ball << 'END' > seen 2>&1
import glob, sys
import h5py, numpy
h, n, low = 2.5e-3, (20, 8, 4), (-25e-3, -10e-3, -10e-3)
ball = 8000 * 4 / 3 * numpy.pi * 1e-6
nodes, before = None, None
files = sorted(glob.glob(sys.argv[1] + "/checkpoints/*.h5"))
assert len(files) == 9, files
for name in files:
    state = h5py.File(name)
    x = (state["nodes/position"][()] - low) / h
    if nodes is None:  # in cells; the block has hardly moved
        nodes = numpy.rint(x)
        shares = [numpy.where((nodes[:, k] == 0) | (nodes[:, k] == n[k]), 0.5, 1.0) for k in range(3)]
        mass = 2000 * h**3 * numpy.prod(shares, axis=0)
        assert abs(mass.sum() - 0.02) < 1e-12, mass.sum()
    v = state["spheres/velocity"][0]
    momentum = (mass[:, None] * state["nodes/velocity"][()]).sum(axis=0) + ball * v
    before = momentum if before is None else before
    assert abs(momentum - before).max() < 1e-14 * numpy.linalg.norm(before), momentum - before
assert abs(momentum - ball * numpy.array((1.5, 0.2, -0.15))).max() < 1e-14
dents = [(h5py.File(name)["nodes/position"][:, 2] - low[2]) / h - nodes[:, 2] for name in files]
assert max(dent.max() - dent.min() for dent in dents) > 0.1, "it does not give way"
assert abs(v[2] + 0.15) > 0.1, "nothing was exchanged"
END
then
    result "momentum of ball and nodes"
elif grep -q "No module named" seen; then
    echo "skip momentum: python3-h5py is not installed"
else
    why=" $(tail -n 1 seen);"
    result "momentum of ball and nodes"
fi
