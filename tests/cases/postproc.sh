#!/bin/bash
# The tools on small runs: what they show, what they write, what they say of damaged files.
set -uo pipefail

cd "$(dirname "$0")/../.." || exit 1
root=$PWD
bin=$(cd "$BIN" && pwd)
python=/usr/bin/python3 # Debian's h5py is for it
cd "$SCRATCH" || exit 1

# try STATUS COMMAND...: output to `said`; a reason when the status is another.
try()
{
    local expected=$1 status=0
    shift
    timeout 120 "$@" > said 2>&1 < /dev/null || status=$?
    [ "$status" = "$expected" ] || why+=" $(basename "$1") gives status $status, not $expected;"
}

# says TEXT...: the output holds each of these texts.
says()
{
    local text
    for text in "$@"; do
        grep -qF -- "$text" said || why+=" does not say '$text';"
    done
}

# result NAME: ok, or FAIL with the reasons.
result()
{
    if [ -z "$why" ]; then
        echo "ok $1"
    else
        echo "FAIL $1:$why"
        tail -n 15 said
    fi
    why=
}

why=
cat > small.yaml << 'END'
title: A small heap
time: {end: 0.2, step: 2.0e-5}
gravity: [0, 0, -9.81]
materials:
  ore:   {density: 2367, young: 1.0e8, poisson: 0.2}
  steel: {density: 7860, young: 2.1e8, poisson: 0.29}
contact:
  pairs:
    - {between: [ore, ore], friction: 0.5, restitution: 0.5}
    - {between: [ore, steel], friction: 0.4, restitution: 0.5}
spheres:
  - name: heap
    material: ore
    radius: 0.01
    packing: {kind: lattice, count: 300, spacing: 0.022, corner: [-0.055, -0.055, 0.1], size: [0.11, 0.11]}
bodies:
  - {name: bin, material: steel, geometry: {kind: box, open: top, min: [-0.1, -0.1, 0], max: [0.1, 0.1, 0.2]}}
sections:
  - {name: middle, point: [0, 0, 0.09], normal: [0, 0, -1], by: [material, size], classes: [0.01]}
checkpoint: {every: {steps: 5000}, keep: 3}
output: {series: {every: 0.002}}
END
sed '/^sections:/,/middle/d' small.yaml > bare.yaml

try 0 mpirun -n 1 "$bin/tremie" run small.yaml --out one
try 0 mpirun -n 2 "$bin/tremie" run small.yaml --out two
try 0 mpirun -n 1 "$bin/tremie" run small.yaml --out duller --set contact.pairs.1.restitution=0.4
try 0 mpirun -n 1 "$bin/tremie" run bare.yaml --out bare --set time.end=0.002
result "small runs"
one=$(find one/checkpoints -name '*.h5' | sort | tail -n 1)
two=$(find two/checkpoints -name '*.h5' | sort | tail -n 1)
duller=$(find duller/checkpoints -name '*.h5' | sort | tail -n 1)

# ------------------------------------------------------------------------- command lines

for tool in discharge runstats compare info render chart study; do
    try 0 "$bin/tremie-$tool" --help
    says "usage: tremie-$tool" "Exit status"
    try 2 "$bin/tremie-$tool"
    says "error: "
    try 2 "$bin/tremie-$tool" one --no-such-option
    says "error: there is no option --no-such-option; see tremie-$tool --help"
done
for tool in discharge runstats info render; do
    try 2 "$bin/tremie-$tool" nowhere -o x.png
    try 2 "$bin/tremie-$tool" nowhere
    says "error: "
done
try 2 "$bin/tremie-render" one
says "error: there is no name for the picture; give -o FILE.png"
try 2 "$bin/tremie-render" one -o x.png --size 10x10
try 2 "$bin/tremie-render" one -o x.png --color mood
says "choose one of speed, size, material, group, rank, id"
try 4 "$bin/tremie-render" one -o nowhere/x.png
says "error: cannot write nowhere/x.png: No such file or directory; check the folder"
result "command lines"

# ------------------------------------------------------------------------------ discharge

try 0 "$bin/tremie-discharge" one --csv discharge.csv --svg discharge.svg
says "section middle" "total: " "time [s]"
grep -qE '^(steady: from|no steady window: )' said || why+=" says nothing of a steady window;"
total=$(sed -n 's/^total: \([0-9]*\) spheres net.*/\1/p' said)
[ "${total:-0}" -gt 0 ] || why+=" nothing passed;"
[ "$(tail -n 1 discharge.csv | cut -d , -f 2)" = "$(tail -n 1 discharge.csv | awk -F , -v t="$total" '{ print t + $3 }')" ] ||
    why+=" the last line of the CSV has another count;"
[ "$(wc -l < discharge.csv)" = 102 ] || why+=" $(wc -l < discharge.csv) lines in the CSV, not 102;"
"$python" -c 'import sys, xml.etree.ElementTree as t; t.parse(sys.argv[1])' discharge.svg 2>> said ||
    why+=" the SVG is not well-formed;"
try 1 "$bin/tremie-discharge" bare
says "has no section"
result discharge

try 0 "$bin/tremie-discharge" one --by all --csv parts.csv --svg parts.svg
says "section middle" "section middle.material_ore" "section middle.class_2"
# Nothing of steel and nothing below 0.01 m has passed.
grep -qE 'middle.(material_steel|class_1)' said && why+=" shows what never passed;"
awk -F , 'NR > 1 && ($2 != $6 || $4 != $8 || $2 != $10) { bad = 1 } END { exit bad }' parts.csv ||
    why+=" parts are not the whole;"
try 0 "$bin/tremie-discharge" one --by size
grep -q material said && why+=" shows materials, too;"
result "discharge by material and size"

# ------------------------------------------------------------------------------- runstats

try 0 "$bin/tremie-runstats" two one --csv runstats.csv
says "rate: " "pairs" "redistribute" "redistributions, high level" "redistributions, low level" "memory" \
    "speed-up, the run on 1 rank counted as 1" "efficiency"
[ "$(wc -l < runstats.csv)" = 3 ] || why+=" $(wc -l < runstats.csv) lines in the CSV, not 3;"
[ "$(awk -F , '{ print NF }' runstats.csv | sort -u | wc -l)" = 1 ] || why+=" lines of unequal length in the CSV;"
result runstats

# All work is one rank's: the largest time is twice the mean, all but what an idle rank takes.
try 0 mpirun -q -n 2 "$bin/tremie" run small.yaml --out apart --set time.end=0.02 --set 'decomposition.grid=[2, 1, 1]' \
    --set 'domain.min=[-1, -1, -1]' --set 'domain.max=[9, 1, 1]' --set testing.search=all-pairs --set testing.search_every=50
try 0 "$bin/tremie-runstats" apart
awk '/^imbalance of/ { most[$3] = $6 } END { exit !(most["computing"] > 1.7 && most["computing"] <= 2 && most["weights"] == 2) }' said ||
    why+=" imbalances of what is all on one rank;"
result "imbalance of work"

# -------------------------------------------------------------------------------- compare

try 0 "$bin/tremie-compare" "$one" "$two"
says "equal: 0 of"
try 0 "$bin/tremie-compare" one two
try 0 "$bin/tremie-compare" "$one" "$two" --all
try 1 "$bin/tremie-compare" "$one" "$duller"
says "/spheres/position id " "ulp" "different: "
try 1 "$bin/tremie-compare" one duller
try 2 "$bin/tremie-compare" "$one" small.yaml
says "is not a whole HDF5 file"
try 2 "$bin/tremie-compare" "$one" two
cp "$one" changed.h5
"$python" - << 'END' 2>> said || why+=" cannot change a file;"
import h5py, numpy
with h5py.File("changed.h5", "r+") as f:
    z = f["spheres/position"][17, 2]
    f["spheres/position"][17, 2] = numpy.nextafter(z, 1)
    f["spheres/radius"][3] = -0.01
    f["run"].attrs["title"] = numpy.bytes_("another")
    del f["spheres/group"]
END
try 1 "$bin/tremie-compare" "$one" changed.h5
says "/spheres/position id 17[2]:" ", 1 ulp" "/spheres/radius id 3: 0.01 and -0.01" \
    "/spheres/group: only in the first" "different: 3 of"
try 1 "$bin/tremie-compare" "$one" changed.h5 --all
says "/run@title: the texts differ" "different: 4 of"
result compare

# ----------------------------------------------------------------------------------- info

try 0 "$bin/tremie-info" "$one"
says "A small heap" "300" "all checksums are right" "group heap" "body bin"
try 0 "$bin/tremie-info" one
says "checkpoints " "all checksums are right" "kinetic_translation" "middle.mass_forward"
try 0 "$bin/tremie-info" one --csv series.csv
head -n 1 series.csv | grep -q '^step,time_s,n_spheres,.*,speed_max_m_s,.*bin.torque_x_N_m' || why+=" headings of the series;"
[ "$(tail -n 1 series.csv | cut -d , -f 1-3)" = "$(sed -n 's/^  \(step\|time\|n_spheres\)  *\([^ ]*\).*/\2/p' said | paste -sd ,)" ] ||
    why+=" the series ends otherwise than it says;"
try 0 "$bin/tremie-info" two --csv runtime.csv --table runtime
ratios=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) at[$i] = i; next }
    { sum += ratio = $at["weight.max_ns"] / $at["weight.mean_ns"]; most = ratio > most ? ratio : most }
    END { printf "%.6g (mean), %.6g (most)", sum / (NR - 1), most }' runtime.csv)
try 0 "$bin/tremie-runstats" two
says "imbalance of weights         $ratios"
try 4 "$bin/tremie-info" one --csv none.csv --table mood
says "no none.csv is written: one has no series"
try 2 "$bin/tremie-info" "$one" --csv series.csv
says "--csv goes with a run"
try 0 "$bin/tremie-info" "$(find one/series -name '*.h5' | sort | head -n 1)"
says "/series/time" "/runtime/wall"
try 4 "$bin/tremie-info" changed.h5
says "error: "
head -c 20000 "$one" > cut.h5
try 4 "$bin/tremie-info" cut.h5
says "error: "
try 2 "$bin/tremie-info" /
try 4 "$bin/tremie-info" small.yaml
result info

# --------------------------------------------------------------------------------- render

# size_of FILE.png: width and height
size_of()
{
    od -An -t u1 -j 16 -N 8 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8 }'
}

for by in speed size material group rank id; do
    try 0 "$bin/tremie-render" "$one" -o "$by.png" --color "$by" --size 320x240
    [ "$(size_of "$by.png")" = 320x240 ] || why+=" $by.png is $(size_of "$by.png");"
done
for view in corner front back left right top bottom; do
    try 0 "$bin/tremie-render" one --out "$view.png" --view "$view" --size 160x120 --no-bodies
done
cmp -s front.png top.png && why+=" another view shows the same;"
try 0 "$bin/tremie-render" one -o near.png --azimuth 40 --elevation 30 --zoom 2 --range 0:1 --size 320x240
try 4 "$bin/tremie-render" cut.h5 -o cut.png
[ ! -e cut.png ] || why+=" a picture of a damaged file;"
try 0 "$bin/tremie-render" two -o ranks.png --color rank --size 320x240
try 0 "$bin/tremie-render" "$two" -o same.png --color rank --size 320x240
cmp -s ranks.png same.png || why+=" the run and its newest checkpoint show different ranks;"
cmp -s ranks.png rank.png && why+=" two ranks look like one;"
# A body that has gone is not shown: of one body alone, its plug, nothing is left.
sed '/name: bin,/d' "$root/tests/cases/scenes/plug.yaml" > lone.yaml
for end in 0.02 0.05; do
    try 0 "$bin/tremie" run lone.yaml --out "lone_$end" --set time.end=$end
    try 0 "$bin/tremie-render" "lone_$end" -o "with_$end.png" --size 160x120
    try 0 "$bin/tremie-render" "lone_$end" -o "bare_$end.png" --size 160x120 --no-bodies
done
cmp -s with_0.02.png bare_0.02.png && why+=" a body that is there is not shown;"
cmp -s with_0.05.png bare_0.05.png || why+=" a body that has gone is shown;"
cp "$two" lone.h5
try 4 "$bin/tremie-render" lone.h5 -o none.png --color rank
says "error: cannot tell whose spheres lone.h5 holds: there are no series in"
mkdir -p bare_copy && cp -r two/checkpoints bare_copy
try 4 "$bin/tremie-render" bare_copy -o none.png --color rank
says "error: cannot tell whose spheres bare_copy holds"
[ ! -e none.png ] || why+=" a picture of unknown ranks;"
result render

# ---------------------------------------------------------------------------------- chart

cat > points.csv << 'END'
# a comment
steps,law,"damping, how",error,low,high
10,hertz,late,0.1,0.05,0.2
20,hertz,late,0.04,0.02,0.08
20,hertz,ahead,0.01,0.005,0.02
40,linear,ahead,nan,0,0
80,linear,ahead,0.001,0,0.004
80,linear,never,,,
END
# marks FILE.svg: how many dots, curves and bands it has.
marks()
{
    "$python" - "$1" << 'END'
import sys, xml.etree.ElementTree as t
p = list(t.parse(sys.argv[1]).iter())
of = lambda tag, key, value: sum(e.tag.endswith(tag) and e.get(key) == value for e in p)
print(sum(e.tag.endswith("circle") for e in p), of("path", "stroke-width", "1.6"), of("path", "fill-opacity", "0.16"))
END
}
try 0 "$bin/tremie-chart" points.csv -o chart.svg --x steps --y error --low low --high high --group law \
    --log xy --markers --title 'Errors & <signs>'
# Dots: two curves of 3 and 1 points and their legends; a band each.
[ "$(marks chart.svg)" = "6 2 2" ] || why+=" dots, curves and bands: $(marks chart.svg);"
try 0 "$bin/tremie-chart" points.csv -o panels.svg --x steps --y 'error=E;low=L,high' --panel law \
    --points low --log 'xy;x' --mark-x 20=here --mark-y '0.01=there;' --x-range 5:100 --y-label 'axis E;axis L'
for word in '>axis E<' '>L<' '>high<' '>here<' '>there<' '>hertz<' '>linear<'; do
    grep -qF "$word" panels.svg || why+=" no $word in the picture;"
done
try 1 "$bin/tremie-chart" points.csv -o none.svg --x steps --y error --where law=cohesive
try 0 "$bin/tremie-chart" points.csv -o some.svg --x steps --y 'error=a;error=b' --points error --low ';low' --high ';high' \
    --where 'law=hertz|linear,steps=20'
[ "$(marks some.svg)" = "4 0 1" ] || why+=" dots, curves and bands of some rows: $(marks some.svg);"
try 2 "$bin/tremie-chart" points.csv -o none.svg --x steps --y mood
says 'error: points.csv has no column "mood"; see its first line'
try 2 "$bin/tremie-chart" points.csv -o none.svg --x law --y error
says 'error: points.csv: "hertz" is to be drawn; a number is expected'
try 2 "$bin/tremie-chart" points.csv -o none.svg --x steps --y error --x-range 5
try 2 "$bin/tremie-chart" points.csv --x steps --y error
try 4 "$bin/tremie-chart" nowhere.csv -o none.svg --x steps --y error
try 4 "$bin/tremie-chart" points.csv -o nowhere/x.svg --x steps --y error
echo '1,2' >> points.csv
try 4 "$bin/tremie-chart" points.csv -o none.svg --x steps --y error
says "error: points.csv:9: this row has another number of cells"
[ ! -e none.svg ] || why+=" a picture of nothing;"
result chart
