#!/bin/bash
# timeout: 1800
# Folders that are not the run's, places that cannot be written, files that are damaged: a clear
# message, the right exit status, nothing lost, and what is good is used.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# refused STATUS OUT OPTIONS...: a run on two ranks that is to be refused with that status.
refused()
{
    local expected=$1 out=$2 status=0
    shift 2
    tremie 2 run "$scenes/heap.yaml" --out "$out" "$@" || status=$?
    [ "$status" = "$expected" ] || why+=" exit status $status, not $expected;"
    grep -q '^error: ' said || why+=" no error is told;"
}

# keeps FOLDER: nothing in it is other than `remember FOLDER` saw it.
look_at() { find "$1" ! -name log ! -name lock -exec ls -ld --time-style=full-iso {} +; }
remember() { look_at "$1" > remembered; }
keeps() { look_at "$1" | cmp -s - remembered || why+=" $1 has changed;"; }

set -- --set checkpoint.every.steps=100
run 1 reference heap "$@"
result "reference run"
last=checkpoints/step_000000000600.h5

# ------------------------------------------------------------------ folders
cp -r reference other
remember other/checkpoints
refused 2 other "$@" --set contact.pairs.1.friction=0.3
says "other belongs to another job: "
says "friction"
says "--out"
says "--fresh"
keeps other/checkpoints
result "folder of another job"

refused 2 new "$@" --set spheres.0.radius=0.09 --restart "reference/$last"
says "was written by another job"
[ ! -e new/checkpoints/step_000000000600.h5 ] || why+=" it has a checkpoint;"
result "checkpoint of another job"

refused 2 missing "$@" --restart nowhere.h5
says "cannot use the checkpoint nowhere.h5: No such file"
[ ! -e missing ] || why+=" a folder was made for it;"
result "missing checkpoint"

refused 2 strange "$@" --restart "$scenes/heap.yaml"
says "cannot use the checkpoint"
result "something else for a checkpoint"

mkdir foreign
echo precious > foreign/thesis.tex
remember foreign
refused 2 foreign "$@"
says "foreign holds other things than a run (thesis.tex)"
refused 2 foreign "$@" --fresh
keeps foreign
result "folder with other things"

echo precious > file
refused 2 file "$@"
says "file"
[ "$(cat file)" = precious ] || why+=" the file has changed;"
result "a file in the folder's place"

refused 2 file/below "$@"
result "a folder below a file"

refused 4 /proc/tremie "$@"
says "cannot make the folder /proc/tremie"
says "--out"
result "where nothing can be made"

# A file system that only reads, in a name space of its own.
cat > read_only.sh << 'END'
mount --bind "$1" "$1" && mount -o remount,bind,ro "$1" || exit 99
shift
"$@"
END
cp -r reference fixed
status=0
timeout "$patience" unshare -m bash read_only.sh fixed \
    "$bin/tremie" run "$scenes/heap.yaml" --out fixed "$@" > said 2>&1 || status=$?
if [ "$status" = 99 ] || ! grep -q '^error: ' said; then
    echo "skip read-only folder: no mounting here"
else
    [ "$status" = 4 ] || why+=" exit status $status, not 4;"
    says "Read-only file system"
    says "--out"
    result "read-only folder"
fi

# ------------------------------------------------------------------ a limit on the size of files
# (Open MPI's shared memory is files too, so the limit would hit that first.)
status=0
timeout "$patience" mpirun --oversubscribe --bind-to none -q --mca btl self,tcp -n 2 \
    bash -c 'ulimit -f 100; exec "$@"' - "$bin/tremie" run "$scenes/heap.yaml" --out limited "$@" \
    > said 2>&1 || status=$?
[ "$status" = 4 ] || why+=" exit status $status, not 4;"
says ": File too large; "
says "free some space"
[ -z "$(find limited/checkpoints -type f)" ] || why+=" something half-written is left;"
result "a limit on the size of files"
run 3 limited heap "$@"
same_run reference limited
result "the limit is gone: the same command goes on"

# ------------------------------------------------------------------ damaged files
options=("$@")
newest=checkpoints/step_000000000500.h5
size=$(stat -c %s "reference/$newest")

# stopped: `run` as if it had been stopped after step 500.
stopped()
{
    rm -rf run
    cp -r reference run
    rm "run/$last" run/series/step_00000000060?.h5
}

# flip FILE BYTE BIT: turns that bit.
flip()
{
    local byte
    byte=$(od -An -tu1 -j "$2" -N 1 "$1")
    # shellcheck disable=SC2059 # the format is the byte
    printf "\\x$(printf %x $((byte ^ (1 << $3))))" |
        dd of="$1" bs=1 seek="$2" conv=notrunc status=none
}

# survives RANKS: the run comes to the right end whatever has happened to its newest checkpoint;
# when that is not used it is named and kept.
survives()
{
    run "$1" run heap "${options[@]}"
    if ! grep -q 'resumes at step 500 ' said; then
        says "cannot use the checkpoint run/$newest: "
        says "resumes at step 400 "
        [ -e "run/set_aside_1/$newest" ] || why+=" the damaged file is gone;"
    fi
    equal "reference/$last" "run/$last"
    equal reference run
}

RANDOM=7
for place in 0 8 40 100 1000 5000 $((size / 2)) $((size - 1)) {1..6}th; do
    [ -n "$thorough" ] || [[ $place != *th ]] || continue
    [[ $place != *th ]] || place=$(((RANDOM * 32768 + RANDOM) % size))
    bit=$((RANDOM % 8))
    stopped
    flip "run/$newest" "$place" $bit
    survives 1
    result "bit $bit of byte $place of the newest checkpoint flipped"
done
for length in 0 1 100 $((size / 3)) $((size - 1)); do
    stopped
    truncate -s $length "run/$newest"
    survives 1
    grep -q 'resumes at step 400 ' said || why+=" it is used;"
    result "the newest checkpoint cut to $length of $size bytes"
done

stopped
for file in run/checkpoints/*.h5; do
    truncate -s 2000 "$file"
done
remember run/checkpoints
refused 4 run "$@"
says "start over with --fresh"
keeps run/checkpoints
result "no checkpoint is good"

stopped
echo half > run/checkpoints/.step_000000000600.h5.part
cp "run/$newest" run/checkpoints/.step_000000000700.h5.part
survives 2
[ -z "$(find run -name '.*.part')" ] || why+=" something half-written is left;"
result "killed while it wrote a checkpoint"

stopped
truncate -s 3000 run/series/step_000000000300.h5
run 1 run heap "$@"
equal "reference/$last" "run/$last"
"$bin/tremie-compare" reference run > said 2>&1 && why+=" series that lack rows are called equal;"
says "run/series/step_000000000300.h5"
result "damaged series: the run goes on, readers are told"

stopped
rm run/job.yaml
remember run/checkpoints
refused 2 run "$@"
says "run holds checkpoints but no job.yaml"
says "--fresh"
keeps run/checkpoints
result "job.yaml is missing"

stopped
head -c 200 reference/job.yaml > run/job.yaml
remember run/checkpoints
status=0
tremie 2 run "$scenes/heap.yaml" --out run "$@" || status=$?
[ "$status" = 2 ] || [ "$status" = 4 ] || why+=" exit status $status, not 2 or 4;"
says "error: "
says "--fresh"
keeps run/checkpoints
result "job.yaml is damaged"
