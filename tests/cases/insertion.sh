#!/bin/bash
# What a user meets of insertion, removal and contents: what `check` foresees, how a full region is
# called, the tool that shows them, a stream that stops and starts from nothing.
set -uo pipefail
root=$PWD
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

# forget RUN STEP: removes the checkpoints of later steps.
forget()
{
    local file
    for file in "$1"/checkpoints/step_*.h5; do
        [[ $file < "$1/checkpoints/step_$(printf %012d $(($2 + 1))).h5" ]] || rm "$file"
    done
}

tremie 1 check "$scenes/feed.yaml" || why+=" check gives status $?;"
says "insert    rain: 180 spheres, "
says "insert    jet: 44 spheres, 12 kg, "
says "every 7 steps, 0.0007 s: "
says "memory of the order of 0.67"
says "start     nothing touches"
result "what check foresees"

# ------------------------------------------------------------------ full
run 2 feed feed
says "warning: insertion 'jet': asked 1.44 kg so far, inserted 1.08573 kg at step 196 (0.0196 s); the region is full: it falls behind"
result "a region without room"

status=0
tremie 2 run "$scenes/feed.yaml" --out stops --set insert.1.when_full=stop || status=$?
[ "$status" = 3 ] || why+=" the status is $status, not 3;"
says "error: region full at step 197 (0.0197 s): insertion 'jet': asked 1.44 kg so far, inserted 1.08573 kg; enlarge it, "
result "a region without room that stops the run"

# ------------------------------------------------------------------ the tool
"$bin/tremie-contents" feed --materials --csv contents.csv --svg contents.svg > said 2>&1 || why+=" it ends with status $?;"
says "content below"
says "content inside"
says "came in by rain: 180 spheres"
says "taken out by drain.material_rubber: "
says "left the domain: "
says "came in by jet: "
grep -q steel said && why+=" shows a material of bodies;"
[ "$(wc -l < contents.csv)" = 102 ] || why+=" $(wc -l < contents.csv) lines in the CSV, not 102;"
grep -q '<svg' contents.svg || why+=" there is no SVG;"
# What came in is what is there and what went; materials add up.
"$bin/tremie-info" "$(find feed/checkpoints -name '*.h5' | sort | tail -n 1)" >> said
awk '/^came in by [a-z]*:/ { n += $5 } /^taken out by [a-z]*:/ { n -= $5 } /^left the domain:/ { n -= $4 }
    /^came in by rain.material/ { rain += $5 } /^came in by rain:/ { rain -= $5 }
    /^spheres / { n -= $2; seen = 1 }
    END { exit !(n == 0 && rain == 0 && seen) }' said || why+=" numbers do not add up;"
result "tremie-contents"

status=0
"$bin/tremie-contents" nowhere > said 2>&1 || status=$?
[ "$status" = 2 ] || why+=" the status is $status, not 2;"
result "tremie-contents of nothing"

# ------------------------------------------------------------------ the last occasion

# By number and by mass, rates times durations: 33.3, 36.44 of a stream that ends with the run, 12.3 of
# one that has no other occasion, 31.83, and 44.8 by the last multiple of 64 of the one without an end.
cat > counts.yaml << 'END'
time: {end: 0.05, step: 1.0e-4}
gravity: [0, 0, 0]
materials:
  ore: {density: 2400, young: 5.0e7, poisson: 0.2}
contact:
  pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]
insert:
  - {name: early, material: ore, radius: 5 mm, region: {kind: box, min: [0, 0, 0], max: [1, 1, 1]},
     rate: {number: 1000}, until: {time: 0.0333}}
  - {name: late, material: ore, radius: 5 mm, region: {kind: box, min: [1, 0, 0], max: [2, 1, 1]},
     rate: {number: 777}, start: 0.0031, every: 50, until: {time: 0.05}}
  - {name: once, material: ore, radius: 5 mm, region: {kind: box, min: [2, 0, 0], max: [3, 1, 1]},
     rate: {number: 1000}, every: 1000, until: {time: 0.0123}}
  - {name: mass, material: ore, radius: 5 mm, region: {kind: box, min: [3, 0, 0], max: [4, 1, 1]},
     rate: {mass: 1}, every: 7, until: {time: 0.04}}
  - {name: open, material: ore, radius: 5 mm, region: {kind: box, min: [4, 0, 0], max: [5, 1, 1]},
     rate: {number: 1000}}
checkpoint: {every: {wall: 0, steps: 150}, keep: 100}
output: {series: {every: 0.01}}
END
feed_scenes=$scenes scenes=$PWD
run 1 counts counts
"$bin/tremie-contents" counts > came
"$bin/tremie-info" counts/checkpoints/step_000000000500.h5 >> came
tremie 1 check counts.yaml
for count in "early 33" "late 36" "once 12" "mass 31" "open 44"; do
    grep -q "came in by ${count% *}: ${count#* } spheres" came || why+=" by ${count% *} came not ${count#* };"
    grep -Eq "^  group ${count% *} +${count#* } of ore" came || why+=" of ${count% *} are not ${count#* };"
    [ "${count% *}" = mass ] || says "insert    ${count% *}: ${count#* } spheres, "
done
result "all that is due by until.time comes in"

run 3 other counts --set time.end=0.0332 # between the last two steps of the first stream
run 2 other counts
same_run counts other
says "resumes at step 332 "
start 2 killed counts --set time.end=50
wait_until_after killed 200
kill_ranks
forget killed 300
run 3 killed counts
says "resumes at step 300 "
same_run counts killed
rm -rf counts other killed
scenes=$feed_scenes
result "and also if the run is killed or made longer"

# ------------------------------------------------------------------ gates thinner than a step

run 1 gates gates
"$bin/tremie-contents" gates > said 2>&1
says "taken out by sheet: 6 spheres"
says "taken out by disc: 10 spheres"
says "taken out by ball: 10 spheres"
says "taken out by edge: 10 spheres"
run 3 other gates --set testing.search_every=7 --set testing.repartition_every=30
same_run gates other
result "no gate is passed unseen"

# At step 150 spheres are noted that leave at 192.
forget other 150
run 2 other gates
says "resumes at step 150 "
same_run gates other
rm -rf gates other
result "what is noted between is kept"

# ------------------------------------------------------------------ nothing, something, nothing
cat > brief.yaml << 'END'
time: {end: 0.2, step: 1.0e-4}
materials:
  ore: {density: 2400, young: 5.0e7, poisson: 0.2}
contact:
  pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]
insert:
  - {name: puff, material: ore, radius: 0.01, region: {kind: sphere, centre: [0, 0, 0], radius: 0.1},
     rate: {number: 1000}, start: 0.03, until: {count: 10}}
  - {name: later, material: ore, radius: 0.01, region: {kind: sphere, centre: [0, 0, 0], radius: 0.1},
     rate: {number: 1000}, start: 0.15, until: {count: 10}}
remove: [{name: all, region: {kind: sphere, centre: [0, 0, 0], radius: 1}, start: 0.05, stop: 0.1}]
domain: {min: [-2, -2, -2], max: [2, 2, 2]}
checkpoint: {every: {wall: 0, steps: 200}, keep: 100}
output: {series: {every: 0.01}}
END
scenes=$PWD
run 1 one brief
run 3 three brief
same_run one three
result "a run that is empty at times"
rm three/checkpoints/step_00000000[12]*.h5 # resumes from an empty state
rm three/checkpoints/step_000000002000.h5 2> /dev/null
run 2 three brief
says "resumes at step 800 "
equal one three
equal {one,three}/checkpoints/step_000000002000.h5
"$bin/tremie-contents" three > said 2>&1
says "came in by later: 10 spheres"
says "taken out by all: 10 spheres"
result "resumed when it was empty"

# ------------------------------------------------------------------ bodies and boundaries in the way
cat > solids.yaml << 'END_OF_JOB'
time: {end: 0.02, step: 1.0e-4}
materials:
  ore: {density: 2400, young: 5.0e7, poisson: 0.2}
contact:
  pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]
insert:
  - {name: fog, material: ore, radius: 0.01, region: {kind: box, min: [0, 0, 0], max: [1, 0.5, 0.5]}, rate: {number: 1.0e5}, every: 10}
bodies:
  - {name: rock, material: ore, geometry: {kind: box, min: [0.6, 0.1, 0.1], max: [0.9, 0.4, 0.4]}}
  - name: roll
    material: ore
    geometry: {kind: cylinder, from: [0.3, 0.1, 0.25], to: [0.3, 0.4, 0.25], radius: 0.2, caps: [from, to]}
    motion: {rotation: {point: [0.3, 0, 0.25], axis: [0, 1, 0], rate: 20}}
contents:
  - {name: rock_inside, region: {kind: inside, body: rock}}
  - {name: roll_inside, region: {kind: inside, body: roll}}
  - {name: low_edge, region: {kind: box, min: [0, 0, 0], max: [0.009, 0.5, 0.5]}}
  - {name: high_edge, region: {kind: box, min: [0.991, 0, 0], max: [1, 0.5, 0.5]}}
domain: {min: [0, -1, -1], max: [1, 1, 1], periodic: x}
checkpoint: {every: {wall: 0, steps: 50}, keep: 100}
END_OF_JOB
run 1 still solids
run 3 likewise solids
same_run still likewise
"$bin/tremie-contents" still --csv contents.csv > said 2>&1 || why+=" tremie-contents gives status $?;"
awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) column[$k] = k }
    END { low = $column["low_edge.count"]; high = $column["high_edge.count"]
          exit !(column["rock_inside.count"] && column["roll_inside.count"] && $column["rock_inside.count"] == 0 &&
              $column["roll_inside.count"] == 0 && low > 10 && high > 10) }' \
    contents.csv || why+=" $(tail -n 1 contents.csv);"
result "none comes in inside a closed body, and some at a periodic boundary"

# ------------------------------------------------------------------ room, before the run
sed '/^domain:/i remove: [{name: all, region: {kind: box, min: [0, 0, 0.08], max: [0.2, 0.2, 0.1]}}]' \
    "$root/tests/cases/bad/insert_full.yaml" > likely.yaml
tremie 1 check likely.yaml || why+=" check gives status $?;"
says "warning: insert 'jam': of 2e+04 spheres a second, which stay in the region for 0.0496 s"
says "991.2 would be there at a time, 104 % of its volume, where at most 38.4 % find room at random; it will stop the run: "
sed 's/when_full: stop, //; s/end: 1.0/end: 0.0065/' "$root/tests/cases/bad/insert_full.yaml" > waits.yaml
run 2 waits waits
says "warning: insert 'burst': of 1e+05 spheres a second, "
says "it will fall behind: enlarge the region, "
grep -q "insert 'fine'" said && why+=" warns of one that is fine;"
result "a region too full, foreseen"
