#!/bin/bash
# Checkpoints and series as a stranger reads them: with h5py, by their documented layout alone.
set -uo pipefail

root=$PWD
cd "$SCRATCH" || exit 1

if ! /usr/bin/python3 -c 'import h5py' 2> /dev/null; then
    echo "skip h5py: python3-h5py is not installed"
    exit 0
fi

cat > heap.yaml << 'END'
title: A heap to be read back
time: {end: 0.2, step: 1.0e-4}
gravity: [0, 0, -9.81]
materials:
  ore: {density: 2500, young: 1.0e8, poisson: 0.2}
contact:
  pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]
spheres:
  - name: heap
    material: ore
    radius: 0.05
    packing: {kind: lattice, count: 600, spacing: 0.105, corner: [-0.4, -0.4, 0.001], size: [0.85, 0.85]}
bodies:
  - name: bin
    material: ore
    geometry: {kind: box, open: top, min: [-0.41, -0.41, 0], max: [0.44, 0.44, 1]}
sections: [{name: middle, point: [0, 0, 0.2], normal: [0, 0, -1]}]
checkpoint: {every: {steps: 700}, keep: 2}
output: {series: {every: 0.01}}
END

if ! timeout 120 mpirun -n 2 "$BIN/tremie" run heap.yaml --out run > out 2>&1; then
    echo "FAIL run: $(tail -n 1 out)"
    exit 1
fi
/usr/bin/python3 "$root/tests/cases/read_back.py" run 600 1e-4 0.01
