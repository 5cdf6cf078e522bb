#!/bin/bash
# Bad input: `tremie` says where and what is wrong and what is expected, exits 2 and leaves
# nothing behind, on one rank within a second, on several without hanging.  The first lines of
# bad/*.yaml, `# expect LINE:COLUMN: how the message begins`, name every message.
set -uo pipefail

root=$PWD
tremie=$BIN/tremie
quick=1 # seconds; with sanitizers nothing is quick
[ "${FLAVOUR:-release}" = release ] || quick=45
cd "$SCRATCH" || exit 1

# refused COMMAND...: status 2 and no run folder; the messages go to `said`.
refused()
{
    timeout 60 "$@" > out 2> said < /dev/null
    local status=$?
    why=
    [ "$status" = 2 ] || why+=" exit status $status, not 2;"
    [ ! -e runs ] || why+=" left a run folder;"
}

# refused_quickly COMMAND...: the same within a second of processor time (other tests run at the
# same time, so the clock says little).
refused_quickly()
{
    local TIMEFORMAT='%U %S' took
    { time refused "$@"; } 2> took
    took=$(awk '{ printf "%d", 1000 * ($1 + $2) }' took)
    [ "$took" -le $((quick * 1000)) ] || why+=" took $took ms;"
}

# result NAME: ok, or FAIL with the reasons.
result()
{
    if [ -z "$why" ]; then
        echo "ok $1"
    else
        echo "FAIL $1:$why"
        head -n 5 said
    fi
}

# says TEXT: the messages hold this text.
says()
{
    grep -qF -- "$1" said || why+=" does not say '$1';"
}

# ---------------------------------------------------------------- the files of bad/

for file in "$root"/tests/cases/bad/*.yaml; do
    refused_quickly "$tremie" check "$file"
    n=0
    while IFS= read -r expected; do
        says "$file:$expected"
        n=$((n + 1))
    done < <(sed -n 's/^# expect //p' "$file")
    [ "$n" -gt 0 ] || why+=" names no message;"
    [ "$(grep -c "^$file:" said)" = "$n" ] || why+=" does not give $n messages;"
    result "$(basename "$file" .yaml)"
done

# ---------------------------------------------------------------- what is no file of a job

refused_quickly "$tremie" check nowhere.yaml
says "nowhere.yaml:1:1: cannot be opened: No such file or directory; a readable"
result "missing file"

mkdir folder.yaml
refused_quickly "$tremie" check folder.yaml
says "folder.yaml:1:1: is a directory; a YAML file is expected"
result "a directory"

: > empty.yaml
refused_quickly "$tremie" check empty.yaml
says "empty.yaml:1:1: there is nothing in it; 'key: value' lines are expected"
result "an empty file"

yes 'title: x' | head -c 10000000 > large.yaml
refused_quickly "$tremie" check large.yaml
says "large.yaml:1:1: has 10000000 bytes; at most 4194304 (4 MiB) are expected"
result "10 MB"

{ printf 'title: ['; yes '1,' | head -n 1300000 | tr -d '\n'; echo ']'; } > many.yaml
refused_quickly "$tremie" check many.yaml
says "there are more than 1000000 values up to here; a smaller file is expected"
result "more than a million values"

seq -f 'key%.0f: 1' 300000 > keys.yaml
refused_quickly "$tremie" check keys.yaml
says "keys.yaml:1:1: unknown key key1;"
says "there may be more mistakes from here on"
result "300 000 unknown keys"

head -c 100000 /dev/zero > zeros.yaml
refused_quickly "$tremie" check zeros.yaml
says "zeros.yaml:1:1: there is a control character (0x00); text in UTF-8 is expected"
result "binary data"

# ---------------------------------------------------------------- the command line

refused_quickly "$tremie" check "$root/jobs/hopper.yaml" --set tiem.end=3 --set time.end=3kg \
    --set spheres.9.radius=1
says "--set:1:1: unknown key tiem; 'time' is expected"
says "--set:1:10: time.end: '3kg' is a mass; a time like 10 us is expected"
says "--set:1:1: 'spheres.9.radius' leads nowhere; a path like spheres.0.radius is expected"
result "overrides"

# ---------------------------------------------------------------- meshes of solids

# mesh NODES ELEMENTS: a Gmsh file of a cube and a job whose body it is.
cube="1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n15 0 0 1\n16 1 0 1\n17 1 1 1\n18 0 1 1\n"
mesh()
{
    # shellcheck disable=SC2059 # the texts have line ends
    printf "\$MeshFormat\n2.2 0 8\n\$EndMeshFormat\n\$PhysicalNames\n2\n2 5 \"lid\"\n3 6 \"block\"\n\$EndPhysicalNames\n\$Nodes\n$1\$EndNodes\n\$Elements\n$2\$EndElements\n" > mesh.msh
    sed -e '/^bodies:/q' "$root/tests/cases/bad/solid.yaml" | grep -v '^# expect\|hardening' > solid.yaml
    sed -i 's/^materials:/&\n  ore: {density: 2367, young: 2.0e7, poisson: 0.2}\n  tin: {density: 7310, young: 50 GPa, poisson: 0.3}/' solid.yaml
    echo "  - {name: block, material: tin, model: solid, mesh: {kind: gmsh, file: mesh.msh, move: [0, 0, 5]${3:-}}, boundary: [{set: lid, pressure: 1 MPa}]}" >> solid.yaml
}
hexahedron="2 5 2 6 1 1 2 3 4 15 16 17 18\n"

mesh "8\n$cube" "2\n1 3 2 5 1 15 16 17 18\n$hexahedron"
timeout 60 "$tremie" check solid.yaml > out 2> said || why+=" is refused;"
grep -q "body      block: solid, tin, 1 hexahedra, 8 nodes, mass 7310 kg" out || why+=" is not told;"
grep -q "set lid: 4 nodes, 1 sides, 0 elements" out || why+=" has no lid;"
result "a mesh without faults"

mesh "8\n$cube" "2\n1 3 2 5 1 15 16 17 18\n2 5 2 6 1 15 16 17 18 1 2 3 4\n"
refused_quickly "$tremie" check solid.yaml
says "mesh.msh: body 'block': element 2 at (0.5, 0.5, 5.5) m is flipped, its volume is -1 m3;"
result "a flipped element"

mesh "9\n${cube}99 3 0 0\n" "2\n1 3 2 5 1 15 16 17 18\n$hexahedron"
refused_quickly "$tremie" check solid.yaml
says "mesh.msh: body 'block': node 99 at (3, 0, 5) m belongs to no element;"
result "a loose node"
mesh "9\n${cube}99 3 0 0\n" "2\n1 3 2 5 1 15 16 17 18\n$hexahedron" ", group: block"
timeout 60 "$tremie" check solid.yaml > out 2> said || why+=" is refused;"
result "a group without the loose node"
mesh "8\n$cube" "1\n$hexahedron" ", group: blok"
refused_quickly "$tremie" check solid.yaml
says "mesh.msh: there is no physical volume 'blok'; one of block is expected"
result "a group that is not there"

mesh "8\n$cube" "2\n1 2 2 5 1 15 16 17\n$hexahedron"
refused_quickly "$tremie" check solid.yaml
says "bodies.0.boundary.0.set: set 'lid' has no sides on the surface that a pressure could act on; some are expected"
result "facets that are no sides"

mesh "8\n$cube" "2\n1 3 2 5 1 15 16 17 18\n2 6 2 6 1 1 2 3 15 16 17\n"
refused_quickly "$tremie" check solid.yaml
says "mesh.msh:23:3: elements of type 6, prisms;"
result "prisms"

# ---------------------------------------------------------------- several ranks

for name in several alias_bomb; do
    file=$root/tests/cases/bad/$name.yaml
    refused mpirun -n 3 "$tremie" run "$file"
    while IFS= read -r expected; do
        says "$file:$expected"
    done < <(sed -n 's/^# expect //p' "$file")
    n=$(grep -c '^# expect ' "$file")
    [ "$(grep -c "^$file:" said)" = "$n" ] || why+=" does not give $n messages;"
    result "$name on 3 ranks"
done

refused mpirun -n 3 "$tremie" run large.yaml
says "large.yaml:1:1: has 10000000 bytes"
result "10 MB on 3 ranks"
