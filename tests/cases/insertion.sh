#!/bin/bash
# What a user meets of insertion, removal and contents: what `check` foresees, how a full region is
# called, the tool that shows them, a stream that stops and starts from nothing.
set -uo pipefail
root=$PWD
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"

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
sed 's/when_full: stop, //; s/end: 1.0/end: 0.005/' "$root/tests/cases/bad/insert_full.yaml" > waits.yaml
run 2 waits waits
says "warning: insert 'burst': of 1e+05 spheres a second, "
says "it will fall behind: enlarge the region, "
grep -q "insert 'fine'" said && why+=" warns of one that is fine;"
result "a region too full, foreseen"
