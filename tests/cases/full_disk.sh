#!/bin/bash
# Disks that fail a run: full, read-only, or broken in the midst of a checkpoint.  Each time the
# run ends with status 4 and says why, what was saved before stays good and nothing half-written
# is left; with room again the same command goes on to the same bits.
set -uo pipefail

cd "$SCRATCH" || exit 1

cat > heap.yaml << 'END'
title: A heap on a failing disk
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
checkpoint: {every: {steps: 300}, keep: 9}
output: {series: {every: 0.01}}
END
last=checkpoints/step_000000002000.h5

# run RANKS OUT [SHIM]: runs the job there; prints the exit status, messages go to `said`.
run()
{
    timeout 60 mpirun -n "$1" ${3:+-x LD_PRELOAD="$3"} "$BIN/tremie" run heap.yaml --out "$2" > out 2> said
    echo $?
}

# expect NAME CONDITION...: ok where the command succeeds.
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

# good_checkpoints RUN: there are some, all good, and nothing half-written lies about.
good_checkpoints()
{
    local file n=0
    for file in "$1"/checkpoints/step_*.h5; do
        "$BIN/tremie-info" "$file" > info 2>&1 || return 1
        n=$((n + 1))
    done
    [ "$n" -gt 0 ] && [ -z "$(find "$1" -name '.*.part')" ]
}

status=$(run 2 reference)
expect 'reference run' [ "$status" = 0 ]

# ------------------------------------------------------------------------------- a small disk
mkdir small
if mount -t tmpfs -o size=600k tmpfs small 2> /dev/null; then
    trap 'umount "$SCRATCH/small"' EXIT
    status=$(run 2 small/run)
    expect 'full disk: exit status 4' [ "$status" = 4 ]
    expect 'full disk: says why' grep -q 'No space left on device; .*free some space' said
    expect 'full disk: earlier checkpoints are good' good_checkpoints small/run
    mount -o remount,ro small
    status=$(run 2 small/run)
    expect 'read-only disk: exit status 4' [ "$status" = 4 ]
    expect 'read-only disk: says why' grep -q 'Read-only file system; name another folder' said
    mount -o remount,rw,size=4m small
    status=$(run 3 small/run)
    expect 'room again: finishes' [ "$status" = 0 ]
    expect 'room again: the same bits' cmp -s "reference/$last" "small/run/$last"
else
    echo 'skip full disk: mounting is not allowed here'
fi

# ------------------------------------------------------------------------------ a broken disk
# Writes to checkpoints fail on one rank, though space had been promised.
cat > broken.c << 'END'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static int breaks(int file)
{
    static int n_written;
    char link[64], path[4096] = "";
    const char *rank = getenv("OMPI_COMM_WORLD_RANK");
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    if (rank == NULL || strcmp(rank, RANK) != 0 || readlink(link, path, sizeof path - 1) < 0 ||
        strstr(path, "checkpoints/.step_000000000900") == NULL)
        return 0;
    return ++n_written > AFTER;
}

ssize_t pwrite(int file, const void *bytes, size_t n, off_t offset)
{
    ssize_t (*real)(int, const void *, size_t, off_t) = dlsym(RTLD_NEXT, "pwrite");
    if (!breaks(file))
        return real(file, bytes, n, offset);
    errno = EIO;
    return -1;
}

ssize_t pwrite64(int file, const void *bytes, size_t n, off64_t offset)
{
    return pwrite(file, bytes, n, offset);
}
END
# broken RANK AFTER: the first AFTER writes of RANK succeed.
broken()
{
    local name="broken disk of rank $1 after $2 writes"
    "${CC:-gcc}" -shared -fPIC -DRANK="\"$1\"" -DAFTER="$2" broken.c -o broken.so -ldl || exit 1
    rm -rf broken
    status=$(run 3 broken "$SCRATCH/broken.so")
    expect "$name: exit status 4" [ "$status" = 4 ]
    expect "$name: says why" grep -qi 'cannot write the checkpoint .*input/output error' said
    expect "$name: earlier checkpoints are good" good_checkpoints broken
}

if [ "${FLAVOUR:-release}" != sanitize ]; then # which wants to be loaded first
    broken 0 0
    broken 0 2
    broken 2 1
    status=$(run 2 broken)
    expect 'mended disk: finishes' [ "$status" = 0 ]
    expect 'mended disk: the same bits' cmp -s "reference/$last" "broken/$last"
fi
