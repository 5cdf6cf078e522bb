#!/bin/bash
# timeout: 600
# Jobs, meshes, tables, checkpoints and folders from somebody who means no good: nothing is written outside
# the run's folder, nothing is run, and what asks for more memory than it deserves is told so.  All of it
# with a limit on memory, and a watched folder beside.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

limit=1500000 # kB; an empty run takes a third of it as address space
quick=20      # seconds
# With sanitizers address space is used otherwise.
[ -n "$thorough" ] || limit=unlimited quick=200

victim=$PWD/victim untouched=$PWD/untouched
mkdir victim
echo precious > victim/file
digest() { find "$victim" -exec ls -ld --time-style=full-iso {} +; }
digest > "$untouched"

cat > base.yaml << 'EOF'
title: plain
time: {end: 0.002, step: 1.0e-5}
materials: {ore: {density: 2367, young: 1.0e+7, poisson: 0.2}}
contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]}
spheres:
  - {name: a, material: ore, radius: 0.1, packing: {kind: lattice, count: 64, spacing: 0.201, corner: [0, 0, 0.001], size: [0.81, 0.81]}}
bodies:
  - {name: floor, material: ore, geometry: {kind: plane, point: [0, 0, 0], normal: [0, 0, 1], extent: 2}}
checkpoint: {every: {steps: 50}}
EOF

# with PATTERN REPLACEMENT...: base.yaml as job.yaml, lines changed by sed.
with()
{
    local script=()
    while [ $# -gt 1 ]; do
        script+=(-e "s|$1|$2|")
        shift 2
    done
    sed "${script[@]}" base.yaml > job.yaml
}

# limited STATUS COMMAND...: one process, little memory, little time.
limited()
{
    local expected=$1 status=0
    shift
    (
        ulimit -v $limit
        exec timeout -k 5 $quick "$@"
    ) > said 2>&1 < /dev/null || status=$?
    case " $expected " in
    *" $status "*) ;;
    *) why+=" status $status, not $expected;" ;;
    esac
    ! grep -q 'bug in tremie' said || why+=" a bug is reported;"
    digest | cmp -s - "$untouched" || why+=" it wrote outside its folder;"
}

# refused TEXT: the job is refused, by check and by run, which says so.
refused()
{
    limited "2 4" "$bin/tremie" run job.yaml --out run --fresh
    says "$1"
    limited "2 4" "$bin/tremie" check job.yaml
    says "$1"
}

# ------------------------------------------------------------------ numbers that promise much
with 'count: 64' 'count: 1e12'
refused "spheres.0.packing.count is '1e12'; a whole number between 1 and 2e+09 is expected"
result "a lattice of 1e12"

with 'count: 64' 'count: 100000000'
limited 4 "$bin/tremie" run job.yaml --out run --fresh
[ -z "$thorough" ] || says "times the memory that this machine has for 1 ranks; use more machines, or fewer spheres"
result "a lattice for which there is no memory"

with 'kind: lattice.*}}' 'kind: random, count: 2000000000, region: {kind: box, min: [0, 0, 0], max: [1e4, 1e4, 1e4]}}}'
refused "spheres 'a' would be more than 50000000; fewer or larger ones are expected"
with 'radius: 0.1' 'radius: 1e-4' 'kind: lattice.*}}' 'kind: random, fraction: 0.3, region: {kind: box, min: [0, 0, 0], max: [1e6, 1e6, 1e6]}}}'
refused "spheres 'a' would be more than 50000000; fewer or larger ones are expected"
result "random spheres without number"

with 'packing: {.*}}' 'packing: {kind: csv, file: far.csv}}' 'radius: 0.1' 'radius: 1 um'
printf 'x_m,y_m,z_m\n0,0,1\n1e6,1e6,1e6\n-1e6,1e6,1e6\n' > far.csv
limited "0 2 3 4" "$bin/tremie" run job.yaml --out run --fresh
result "three small spheres far apart"

with '^time:.*' 'time: {end: 1e12, step: 1e-9}'
limited "124 2" "$bin/tremie" check job.yaml # it says what it costs or that it cannot be
grep -qE 'cost|is expected' said || why+=" it says nothing;"
result "1e21 steps"

# ------------------------------------------------------------------ YAML
{
    echo 'a: &a [x, x, x, x, x, x, x, x, x, x]'
    for k in {b..z}; do echo "$k: &$k [*a, *a, *a, *a, *a, *a, *a, *a, *a, *a]"; done
} > job.yaml
refused "anchor"
result "aliases"
{ printf 'title: '; head -c 1000000 /dev/zero | tr '\0' '['; } > job.yaml
refused "; "
{ printf 'title: '; head -c 1000000 /dev/zero | tr '\0' '{'; } > job.yaml
refused "; "
result "a million brackets"
for file in /dev/zero /dev/urandom; do
    limited 2 "$bin/tremie" check $file
    with '^title:.*' "title: x\ninclude: $file"
    refused "expected"
done
result "devices for jobs"

# ------------------------------------------------------------------ names
with '^title:.*' 'title: "../x\\n\\e[31m\\0y"'
limited 0 "$bin/tremie" run job.yaml --out run --fresh
limited 0 "$bin/tremie" status run
! grep -q $'\e' said run/log || why+=" a control character comes out;"
for name in '"../victim/x"' '"/tmp/x"' '".."' '"a\\nb"' '""' '"\\e[31m"'; do
    with 'name: a' "name: $name"
    refused "a name of letters, digits, - and _"
    with 'name: floor' "name: $name"
    refused "a name of letters, digits, - and _"
done
result "titles and names"

mkdir -p jobs/inner
cp base.yaml jobs/inner/...yaml
cp base.yaml jobs/inner/$'x\e[31m\n'.yaml
for file in ...yaml $'x\e[31m\n'.yaml; do
    (cd jobs/inner && limited 0 "$bin/tremie" run "$file" --set time.end=0.0001; mv said ../../said; [ -z "$why" ]) ||
        why+=" '$file' is not run;"
done
[ "$(cd jobs && find . -maxdepth 3 -mindepth 2 ! -name '*.yaml' | sort | tr '\n' ' ')" = "./inner/runs ./inner/runs/job ./inner/runs/x_[31m_ " ] ||
    why+=" it made $(find jobs | tr '\n' ' ');"
result "names of job files that lead elsewhere"

# ------------------------------------------------------------------ meshes
# body WORDS: the floor has another shape.
body() { with 'geometry: {.*}}' "geometry: {$1}}"; }
{ head -c 80 /dev/zero; printf '\xff\xff\xff\xee'; head -c 100 /dev/zero; } > many.stl
body 'kind: stl, file: many.stl'
refused "but its header says 4009754623 facets"
truncate -s 3G long.stl
body 'kind: stl, file: long.stl'
refused "at most 1.07 GB are expected"
body 'kind: stl, file: /dev/zero'
refused "which are no STL file"
cat > many.msh << 'EOF'
$MeshFormat
4.1 0 8
$EndMeshFormat
$Nodes
1 4000000000000 1 4000000000000
2 1 0 4000000000000
EOF
body 'kind: gmsh, file: many.msh'
refused "a count that fits the file is expected"
sed -e 's/4.1 0 8/2.2 0 8/' -e 's/^1 4000000000000 .*/4000000000000/' many.msh > many2.msh
body 'kind: gmsh, file: many2.msh'
refused "a count that fits the file is expected"
body 'kind: cylinder, from: [0, 0, 0], to: [0, 0, 1], radius: 1, segments: 2000000000'
refused "expected"
result "meshes that promise much"

# ------------------------------------------------------------------ tables
{ echo 'x_m,y_m,z_m'; head -c 300000000 /dev/zero | tr '\0' '1'; } > long.csv
{ echo 'x_m,y_m,z_m,material'; head -c 300000000 /dev/zero | tr '\0' '1'; } > long_material.csv
{ head -c 300000000 /dev/zero | tr '\0' 'x'; } > long_header.csv
for file in long.csv long_material.csv long_header.csv /dev/zero; do
    with 'packing: {.*}}' "packing: {kind: csv, file: $file}}"
    refused "expected"
done
{ echo 't_s,x_m'; head -c 300000000 /dev/zero | tr '\0' '1'; } > long_path.csv
with '2}}' '2}, motion: {path: {file: long_path.csv}}}'
refused "a line of more than 4094 bytes; shorter ones are expected"
with '2}}' '2}, motion: {path: {file: long_header.csv}}}'
refused "a line of more than 4094 bytes; shorter ones are expected"
rm -f long*.csv long.stl
result "lines of 300 MB"

# ------------------------------------------------------------------ checkpoints
rm -rf run
limited 0 "$bin/tremie" run base.yaml --out run
# forged NAME: a checkpoint of that name, made by a program of Python's.
forged()
{
    cp run/checkpoints/step_000000000200.h5 "$1.h5"
    /usr/bin/python3 - "$1.h5" || why+=" no $1 can be forged;"
    limited "2 4" "$bin/tremie" run base.yaml --out new --restart "$1.h5"
    grep -q '^error: cannot use the checkpoint' said || why+=" $1 is taken;"
    [ ! -e new ] || rm -r new
    with 'packing: {.*}}' "packing: {kind: hdf5, file: $1.h5}}"
    limited "0 2" "$bin/tremie" check job.yaml
}
forged many_spheres << 'EOF'
import h5py, sys
f = h5py.File(sys.argv[1], "r+", libver="latest")
for name in list(f["spheres"]):
    shape = list(f["spheres"][name].shape)
    shape[0] = 10**15 // 256
    dtype = f["spheres"][name].dtype
    del f["spheres"][name]
    plist = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
    plist.set_alloc_time(h5py.h5d.ALLOC_TIME_LATE)
    h5py.h5d.create(f["spheres"].id, name.encode(), h5py.h5t.py_create(dtype), h5py.h5s.create_simple(tuple(shape)), plist)
f["run"].attrs["n_spheres"] = 10**15 // 256
EOF
forged large_piece << 'EOF'
import h5py, numpy, sys
f = h5py.File(sys.argv[1], "r+", libver="latest")
for name in list(f["spheres"]):
    old = f["spheres"][name][...]
    attributes = dict(f["spheres"][name].attrs)
    del f["spheres"][name]
    chunk = (2**28 // old.dtype.itemsize // (old.shape[1] if old.ndim > 1 else 1),) + old.shape[1:]
    new = f["spheres"].create_dataset(name, shape=old.shape, maxshape=(None,) + old.shape[1:], dtype=old.dtype, chunks=chunk)
    for key, value in attributes.items():
        new.attrs[key] = value
EOF
forged large_job << 'EOF'
import h5py, sys
f = h5py.File(sys.argv[1], "r+", libver="latest")
del f["run/job"]
kind = h5py.h5t.C_S1.copy()
kind.set_size(2**28)
plist = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
plist.set_alloc_time(h5py.h5d.ALLOC_TIME_LATE)
h5py.h5d.create(f["run"].id, b"job", kind, h5py.h5s.create(h5py.h5s.SCALAR), plist)
f["run/job"].attrs["checksum"] = 0
EOF
forged foreign_filter << 'EOF'
import h5py, sys
f = h5py.File(sys.argv[1], "r+", libver="latest")
n = len(f["spheres/position"])
del f["spheres/position"]
plist = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
plist.set_chunk((n, 3))
plist.set_filter(32004, h5py.h5z.FLAG_OPTIONAL)
h5py.h5d.create(f["spheres"].id, b"position", h5py.h5t.IEEE_F64LE, h5py.h5s.create_simple((n, 3)), plist)
EOF
result "checkpoints that promise much"

# ------------------------------------------------------------------ folders
# planted NAME TARGET: a run's folder with a link, which is refused and left alone.
planted()
{
    rm -rf trap
    cp -r run trap
    rm -rf "trap/$1"
    ln -s "$2" "trap/$1"
    limited 2 "$bin/tremie" run base.yaml --out trap --set time.end=0.004
    says "trap/$1 is no "
    limited 2 "$bin/tremie" run base.yaml --out trap --fresh
    says "trap/$1 is no "
    [ -L "trap/$1" ] || why+=" the link $1 is gone;"
}
for name in job.yaml log status history lock; do
    planted $name "$PWD/victim/file"
done
for name in checkpoints series snapshots; do
    planted $name "$PWD/victim"
done
rm -rf trap
cp -r run trap
rm -f trap/log
mkfifo trap/log
limited 2 "$bin/tremie" run base.yaml --out trap
says "trap/log is no plain file"
rm -rf trap
cp -r run trap
for name in .job.yaml .status .history .stop .lock; do
    ln -s "$PWD/victim/file" trap/$name.part
done
ln -s "$PWD/victim/new" trap/stop
ln -s "$PWD/victim" trap/set_aside_1
rm trap/checkpoints/step_000000000150.h5
ln -s "$PWD/victim/file" trap/checkpoints/step_000000000150.h5
ln -s "$PWD/victim/file" trap/checkpoints/step_000000000300.h5
limited 0 "$bin/tremie" run base.yaml --out trap --set time.end=0.004
ln -s "$PWD/victim/file" trap/.stop.part
limited "0 4" "$bin/tremie" stop trap
limited 0 "$bin/tremie" run base.yaml --out trap --fresh
result "links and pipes planted in a run's folder"
