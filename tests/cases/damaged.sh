#!/bin/bash
# Damaged checkpoints: each is named with what is wrong with it, the newest good one is used, the
# run ends with the same bits, and nothing is deleted.
set -uo pipefail

cd "$SCRATCH" || exit 1

cat > heap.yaml << 'END'
title: A heap whose checkpoints suffer
time: {end: 0.1, step: 1.0e-4}
gravity: [0, 0, -9.81]
materials:
  ore: {density: 2500, young: 1.0e8, poisson: 0.2}
contact:
  pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]
spheres:
  - name: heap
    material: ore
    radius: 0.05
    packing: {kind: lattice, count: 400, spacing: 0.105, corner: [-0.4, -0.4, 0.001], size: [0.85, 0.85]}
bodies:
  - name: bin
    material: ore
    geometry: {kind: box, open: top, min: [-0.41, -0.41, 0], max: [0.44, 0.44, 1]}
checkpoint: {every: {steps: 300}, keep: 9}
END
last=checkpoints/step_000000001000.h5
newest=checkpoints/step_000000000900.h5
before=checkpoints/step_000000000600.h5

run()
{
    timeout 60 mpirun -n "$1" "$BIN/tremie" run heap.yaml --out "$2" > said 2>&1
    echo $?
}

expect()
{
    local name=$1
    shift
    if "$@"; then
        echo "ok $name"
    else
        echo "FAIL $name: $*"
        grep -v '^-' said | head -n 5
    fi
}

# flip FILE BYTE: turns one bit of it.
flip()
{
    local byte
    byte=$(od -An -tu1 -j "$2" -N 1 "$1")
    printf "\\x$(printf %x $((byte ^ 8)))" | dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}

# again: a copy of the whole run as if it had been stopped after step 900.
again()
{
    rm -rf run
    cp -r reference run
    rm "run/$last"
}

# recovers NAME WORDS: the run says WORDS of the newest checkpoint and comes to the same end.
recovers()
{
    status=$(run 2 run)
    expect "$1: finishes" [ "$status" = 0 ]
    expect "$1: says so" grep -qE "cannot use the checkpoint run/$newest: .*$2" said
    expect "$1: goes on from the one before" grep -q 'resumes at step 600' said
    expect "$1: the same bits" cmp -s "reference/$last" "run/$last"
    expect "$1: nothing is deleted" [ -e run/set_aside_1/"$newest" ]
}

status=$(run 3 reference)
expect 'reference run' [ "$status" = 0 ]
size=$(stat -c %s "reference/$newest")

again
truncate -s $((size / 2)) "run/$newest"
recovers truncated "truncated file"
again
flip "run/$newest" $((size - 100))
recovers 'flipped bit in rows' 'checksum'
again
flip "run/$newest" 20
recovers 'flipped bit in the superblock' 'checksum'
again
: > "run/$newest"
recovers 'empty file' 'signature'

again
if /usr/bin/python3 - "run/$newest" 2> /dev/null << 'END'
import sys, zlib, h5py
with h5py.File(sys.argv[1], "r+") as file:
    first, second = file["contacts/first_id"][()], file["contacts/second_id"]
    last = file["spheres/id"][()].max()
    row = [k for k in range(255) if first[k] != first[k + 1] and first[k] < last / 2][0]
    second[row] = last
    file["checksums/contacts/second_id"][0] = zlib.crc32(second[:256].tobytes())
END
then
    recovers 'a contact across the scene' 'far apart'
else
    echo "skip a contact across the scene: python3-h5py is not installed"
fi

again
for file in "run/$newest" "run/$before" run/checkpoints/step_000000000300.h5; do
    truncate -s 1000 "$file"
done
status=$(run 2 run)
expect 'none is good: exit status 4' [ "$status" = 4 ]
expect 'none is good: says what to do' grep -q -- '--fresh' said
expect 'none is good: nothing is deleted' [ -e "run/$newest" ]
