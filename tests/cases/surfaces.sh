#!/bin/bash
# timeout: 1800
# Curved surfaces and surfaces from files: the same bits on any number of ranks and across a
# resume on another; a resume with another file is refused; bad files are told by name and place.
# shellcheck disable=SC2046,SC2086,SC2102 # options are words
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

run 1 reference round
result "round on 1 rank"
# contacts BODY: something touches it at the end.
contacts()
{
    "$bin/tremie-info" reference | grep -Eq "^body $1 .* [1-9][0-9]* contact" ||
        why+=" nothing touches the $1;"
}
contacts drum
contacts tube
contacts funnel
result "round, the curved surfaces are touched"

like reference 3 "round on 3 ranks, search every 7 steps" round --set testing.search_every=7
[ -z "$thorough" ] || like reference 1 "round, all pairs" round --set testing.search=all-pairs
[ -z "$thorough" ] || like reference 8 "round on 8 ranks" round --set testing.repartition_every=50

run 2 this round --set time.end=0.3
run 3 this round
same_run reference this
result "round, stopped on 2 ranks and resumed on 3"
rm -rf this

# ------------------------------------------------------------------ the file is part of the job
cp "$scenes"/round.yaml "$scenes"/wedge.stl "$scenes"/plate.msh .
scenes=.
cp wedge.stl whole.stl
run 1 this round --set time.end=0.02
sed -i 's/vertex 300 0 0/vertex 301 0 0/' wedge.stl
tremie 2 run round.yaml --out this
[ $? = 2 ] || why+=" is not refused;"
says "bodies.3.geometry.sum: was "
result "a resume with another file is refused"
rm -rf this

# ------------------------------------------------------------------ what is wrong with a file
# refused NAME TEXT: `tremie check` of the job ends with status 2 and says the text.
refused()
{
    tremie "${3:-1}" check round.yaml
    [ $? = 2 ] || why+=" is not refused;"
    says "$2"
    result "$1"
}
folder=$PWD
head -c 300 wedge.stl > whole && mv whole wedge.stl
refused "an STL file that ends early" "$folder/wedge.stl:23:7: 'norma' is not what belongs here; 'normal' and three numbers is expected" 3
: > wedge.stl
refused "an empty STL file" "$folder/wedge.stl: 0 bytes, which are no STL file;"
printf 'solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 2 0 0\nendloop\nendfacet\nendsolid\n' > wedge.stl
refused "an STL file without area" "$folder/wedge.stl: body 'wedge', wedge.stl: none of 1 facets has an area; a surface is expected"
printf 'solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1e200 0 0\nvertex 0 2 0\nendloop\nendfacet\nendsolid\n' > wedge.stl
refused "a vertex far out" "$folder/wedge.stl: vertex 2 at (1e+200, 0, 0) with scale 0.001; coordinates within 1e+06 m are expected"
rm wedge.stl && mkdir wedge.stl
refused "a folder" "bodies.3.geometry.file is '$folder/wedge.stl', which is a folder; a file with a surface is expected"
rmdir wedge.stl
refused "no file" "which cannot be read: No such file or directory; a file with a surface is expected"
truncate -s 1100M wedge.stl
refused "a file of a gigabyte" "$folder/wedge.stl: is 1.15 GB large; at most 1.07 GB are expected"
cp whole.stl wedge.stl
sed -i 's/group: upper/group: uper/' round.yaml
refused "a group that is not there" "there is no physical group 'uper' of surfaces; one of upper, lower is expected"
sed -i 's/group: uper/group: upper/' round.yaml

# ------------------------------------------------------------------ what looks like a mistake
warned()
{
    tremie 2 check round.yaml
    [ $? = 0 ] || why+=" is refused;"
    says "$2"
    result "$1"
}
sed -i '0,/vertex 300 0 0/s//vertex 300.0001 0 0/' wedge.stl
warned "vertices that nearly meet" "body 'wedge', wedge.stl: 4 open edges, the first at "
says "vertices nearly meet: merge: 0.004 would leave 0"
result "and how to join them"
warned "a border" "body 'plate', plate.msh: 4 open edges, the first at "
sed -i 's/scale: 0.001, //' round.yaml
sed -i 's/time: {end: 0.5/domain: {min: [-2000, -2000, -2000], max: [2000, 2000, 2000]}\ntime: {end: 0.5/' round.yaml
refused "a file in mm among the spheres" "overlaps body 'wedge', wedge.stl, 360 m wide, by "
sed -i 's/move: \[-0.5, 0.1, -0.2\]/move: [-0.5, 0.1, -900]/' round.yaml
warned "a file in mm" "body 'wedge', wedge.stl: is 360 m wide, 7.2e+03 radii"
sed -i 's/domain: .*/domain: {min: [-2000, -2000, -0.3], max: [2000, 2000, 2000], leavers: stop}/' round.yaml
warned "a body outside the domain" "body 'plate' lies outside the domain"
