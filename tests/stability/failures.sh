#!/bin/bash
# timeout: 600
# Every way in which a run of spheres and rigid bodies can fail, and a light node in a stiff
# contact, is provoked, is called by its name within a stated number of steps, ends with status 3, keeps the last good checkpoint and says what
# to do; next to each the nearest case that is fine runs without a false alarm.  With --table the
# rows of README.md.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/../cases/common.sh"

table=${1:-}
materials='materials:
  ore:   {density: 2500, young: 1.0e8, poisson: 0.2}
  steel: {density: 7850, young: 2.1e11, poisson: 0.3}
contact:
  pairs:
    - {between: [ore, ore], friction: 0.5, restitution: 0.8}
    - {between: [ore, steel], friction: 0.5, restitution: 0.8}
    - {between: [steel, steel], friction: 0.5, restitution: 0.8}
output: {series: {every: 1}}
domain: {leavers: ignore}
checkpoint: {every: {wall: 0, steps: 64}, keep: 2}'
floor='{name: floor, material: steel, geometry: {kind: plane, point: [0, 0, 0], normal: [0, 0, 1], extent: 2}}'

# alone WORDS...: runs the program without a launcher, which takes longer than most of these runs.
alone()
{
    timeout -k 5 $patience "$bin/tremie" "$@" > said 2>&1 < /dev/null
}

# sphere NAME RADIUS X Y Z VX VY VZ [MATERIAL]: an entry of the list of spheres.
sphere()
{
    awk -v n="$1" -v r="$2" -v x="$3" -v y="$4" -v z="$5" -v v="[$6, $7, $8]" -v m="${9:-ore}" 'BEGIN {
        printf "  - {name: %s, material: %s, radius: %.17g, velocity: %s, packing: {kind: lattice, count: 1, ", n, m, r, v
        printf "spacing: %.17g, corner: [%.17g, %.17g, %.17g], size: [%.17g, %.17g]}}\n", 2*r, x-r, y-r, z-r, 2*r, 2*r }'
}

# job FILE STEP N_STEPS GRAVITY SPHERES BODIES [EDIT]: writes a job, changed by a sed script.
job()
{
    {
        echo "title: $1"
        awk -v dt="$2" -v n="$3" 'BEGIN { printf "time: {end: %.17g, step: %s}\n", dt * n, dt }'
        echo "gravity: [0, 0, $4]"
        echo "$materials"
        echo "spheres:"
        echo "$5"
        [ -z "$6" ] || printf 'bodies:\n%s\n' "$6"
    } | sed "${7:-}" > "$1.yaml"
}

# fails NAME DETECTOR TEXT FROM WITHIN REMEDY: $NAME.yaml ends with status 3, says TEXT and REMEDY,
# at most WITHIN steps after step FROM, and what has been saved stays.
fails()
{
    local name=$1 detector=$2 text=$3 from=$4 within=$5 remedy=$6 status=0 step newest
    rm -rf "$name"
    alone run "$name.yaml" --out "$name" || status=$?
    [ "$status" = 3 ] || why+=" exit status $status, not 3;"
    says "error: $text"
    says "$remedy"
    step=$(sed -n 's/^state: failed//; s/^step: \([0-9]*\) of.*/\1/p' "$name/status")
    [ -n "$step" ] || { why+=" no step in its status;"; step=0; }
    [ $((step - from)) -le "$within" ] || why+=" rings at step $step, more than $within after $from;"
    newest=$(find "$name/checkpoints" -name 'step_*.h5' | sort | tail -n 1)
    if [ "$step" -gt 64 ]; then
        [ -n "$newest" ] || why+=" no checkpoint is kept;"
        [ "$((10#$(basename "${newest:-step_9.h5}" .h5 | tr -dc 0-9)))" -lt "$step" ] || why+=" the failure is saved;"
    fi
    took=$((step - from))
    row="| $text | $detector | $took of $within | ${remedy} |"
    result "$name: $text"
}

# refused NAME TEXT: `check` and `run` refuse $NAME.yaml with status 2, say TEXT and where the item
# stands, and leave no run.
refused()
{
    local name=$1 text=$2 command status
    for command in check run; do
        status=0
        alone $command "$name.yaml" --out "$name" || status=$?
        [ "$status" = 2 ] || why+=" $command: exit status $status, not 2;"
        grep -qE "^$name.yaml:[0-9]+:[0-9]+: .*$text" said || why+=" $command does not say $text;"
        [ ! -e "$name" ] || why+=" $command leaves a run;"
    done
    row="| $text | look at the scene, before the run | 0 of 0 | $(sed -n 's/.*; \(.*\) expected$/\1/p' said | head -n 1) expected |"
    result "$name: $text"
}

# alike NAME: the job that just failed alone does so on three ranks, at the same step, said once.
alike()
{
    local name=$1 status=0
    grep '^error:' said > "$name.alone"
    rm -rf "$name"
    tremie 3 run "$name.yaml" --out "$name" || status=$?
    [ "$status" = 3 ] || why+=" exit status $status, not 3;"
    grep '^error:' said | diff "$name.alone" - > differs || why+=" says something else: $(tail -n 1 differs);"
    result "$name: the same on three ranks"
}

# said_number WORDS: the number that stands after WORDS in what was said.
said_number()
{
    sed -n "s/.*$1\([-+0-9.e]*\) s.*/\1/p" said | head -n 1
}

# fine NAME WORDS: $NAME.yaml runs to its end; what was different stands in the table.
fine()
{
    local name=$1 status=0
    rm -rf "$name"
    alone run "$name.yaml" --out "$name" || status=$?
    [ "$status" = 0 ] || why+=" a false alarm, status $status;"
    result "$name: no false alarm ($2)"
    [ -z "$table" ] || echo "$row $2 |" >> "$table"
}

# ------------------------------------------------------------------ step too large
# A ball lies on the floor.  At rest nothing shows until rounding has grown.
lies=$(sphere ball 0.01 0 0 0.0099963 0 0 0)
job heavy_step 3.6e-4 20000 -300 "$lies" "  - $floor"
fails heavy_step "matrix of the present contacts" "step too large at step" 0 257 "set time.step to"
critical=$(said_number 'present contacts, ')
job just_above "$(awk -v c="$critical" 'BEGIN { print 1.05 * c }')" 20000 -300 "$lies" "  - $floor"
fails just_above "matrix of the present contacts" "step too large at step" 0 257 "set time.step to"
job just_below "$(awk -v c="$critical" 'BEGIN { print 0.95 * c }')" 20000 -300 "$lies" "  - $floor" \
    '$a watch: {energy: 0}' # which rings from .9 on: what swings there swings wrongly
fine just_below ".95 of the bound instead of 1.05, the balance unwatched"
# A bed, beaten by its own step.
pile=
for k in {0..26}; do
    pile+=$(sphere "s$k" 0.01 "$((k % 3)).0e-9" 0 1 0 0 0 | sed "s/corner: [^]]*]/corner: [$(awk -v k=$k 'BEGIN {
        printf "%g, %g, %g", 0.0201*(k%3)+0.0003*(int(k/9)%2), 0.0201*(int(k/3)%3)+0.0002*int(k/9), 0.0203*int(k/9) }')]/")$'\n'
done
box='  - {name: box, material: steel, geometry: {kind: box, open: top, min: [-0.001, -0.001, -0.0001], max: [0.0625, 0.0625, 1]}}'
job heavy_bed 1.0e-3 20000 -50 "$pile" "$box"
fails heavy_bed "whatever rings first, with the matrix" "step too large at step" 0 400 "set time.step to"
advised=$(said_number 'set time.step to ')
alike heavy_bed
job light_bed "$advised" 4000 -50 "$pile" "$box"
fine light_bed "the step as advised"

# ------------------------------------------------------------------ a light node in a stiff contact
# A rod of ten cells, h/c = 5 us, on the springs of its end's nodes: gamma = 3 touches.stiffness of E A / h, two thirds of it
# on the last nodes.  Thrown at the floor it touches for some steps only; pressed on it by its weight it stays.
# rod NAME SPEED LOW GRAVITY STIFFNESS [EDIT]: LOW in mm.
rod()
{
    job "$1" 4.0e-6 300 "$4" "" "  - $floor
  - {name: rod, material: ore, model: solid, mesh: {kind: box, min: [0, 0, $3 mm], max: [1 mm, 1 mm, $(awk -v low="$3" 'BEGIN { print low + 10 }') mm], cells: [1, 1, 10]}, velocity: [0, 0, $2], touches: {what: bodies, stiffness: $5}}" \
        '/^spheres:/,/^bodies:/{/^bodies:/!d}; s/poisson: 0.2/poisson: 0/; s/friction: 0.5, restitution: 0.8/friction: 0, restitution: 1/'"${6:-}"
}
rod thrown_rod -1 0.3 0 2 "; s/steps: 64/steps: 16/"
fails thrown_rod "(12.13) as nodes touch" "step too large at step" 76 1 "set time.step to"
alike thrown_rod
rod thrown_softer -1 0.3 0 0.5
fine thrown_softer "a spring of a quarter: .89 of the bound instead of 1.4"
rod pressed_rod 0 -0.001 -6000 2
fails pressed_rod "(12.13) as nodes touch" "step too large at step" 0 1 "set time.step to"
rod pressed_softer 0 -0.001 -6000 0.5
fine pressed_softer "likewise"
# ------------------------------------------------------------------ too few steps for an impact
ball=$(sphere ball 0.01 0 0 0.0131 0 0 -3)
job few_steps 3.0e-4 20000 -9.81 "$ball" "  - $floor" \
    's/restitution: 0.8/restitution: 1/; s/friction: 0.5/friction: 0/'
fails few_steps "energy balance" "energy balance at step" 0 4097 "time.step half as large"
job enough_steps 2.0e-5 40000 -9.81 "$ball" "  - $floor" \
    's/restitution: 0.8/restitution: 1/; s/friction: 0.5/friction: 0/'
fine enough_steps "a tenth of the step"

# ------------------------------------------------------------------ overlap
job start_deep 1.0e-5 200 0 "$(sphere a 0.01 0 0 0 0 0 0; sphere b 0.01 0.01895 0 0 0 0 0)" ""
refused start_deep "overlaps sphere 1 of 'a'"
job start_touching 1.0e-5 200 0 "$(sphere a 0.01 0 0 0 0 0 0; sphere b 0.01 0.01905 0 0 0 0 0)" ""
fine start_touching "9.5 % instead of 10.5 % of a radius"
job same_place 1.0e-5 200 0 "$(sphere a 0.01 0 0 0 0 0 0; sphere b 0.01 0 0 0 0 0 0)" ""
refused same_place "overlaps sphere 1 of 'a'"
job side_by_side 1.0e-5 200 0 "$(sphere a 0.01 0 0 0 0 0 0; sphere b 0.01 0.02 0 0 0 0 0)" ""
fine side_by_side "surfaces just meet"
job in_the_floor 1.0e-5 200 0 "$(sphere a 0.01 0 0 0.0089 0 0 0)" "  - $floor"
refused in_the_floor "overlaps body 'floor'"
job on_the_floor 1.0e-5 200 0 "$(sphere a 0.01 0 0 0.0091 0 0 0)" "  - $floor"
fine on_the_floor "9 % instead of 11 % of a radius"
block='  - {name: block, material: ore, model: solid, mesh: {kind: %s, cells: [4, 8, 4]}}'
# shellcheck disable=SC2059
job in_the_block 1.0e-6 200 0 "$(sphere a 0.01 0 0 0 0 0 0; sphere b 0.01 0 0 0.06 0 0 0)" \
    "$(printf "$block" "cylinder, from: [0, 0, -0.04], to: [0, 0, 0.04], radius: 0.03")"
refused in_the_block "is inside body 'block'"
# shellcheck disable=SC2059
job in_the_tube 1.0e-6 200 0 "$(sphere a 0.01 0 0 0 0 0 0)" \
    "$(printf "$block" "tube, from: [0, 0, -0.04], to: [0, 0, 0.04], inner: 0.02, outer: 0.03")"
fine in_the_tube "in a tube instead of a cylinder"
# What a state brings along is not judged before the run.
job deep_before 1.0e-5 1 0 "$(sphere a 0.01 0 0 0 0 0 0; sphere b 0.01 0.01895 0 0 0 0 0)" "" '$a watch: {overlap: 0.3}'
alone run deep_before.yaml --out deep_before || why+=" the run before ends with status $?;"
job deep_state 1.0e-5 200 0 "" "" 's/^spheres:/start: {from: deep_before}/'
fails deep_state "overlap, every step" "overlap at the start: spheres 0 and 1" 0 1 "place them farther apart"
job borne_state 1.0e-5 200 0 "" "" 's/^spheres:/start: {from: deep_before}/; $a watch: {overlap: 0.3}'
fine borne_state "watch.overlap as in the run before"

# ------------------------------------------------------------------ too soft
# The remedy that is said is the one that helps.
thin='  - {name: thin, material: steel, geometry: {kind: box, min: [-1, -1, -0.0001], max: [1, 1, 0]}}'
job too_soft 5.0e-6 2000 0 "$(sphere ball 0.01 0 0 0.0101 0 0 -9)" "$thin"
fails too_soft "overlap, every step" "contact too soft at step" 1 200 "use young at least"
alike too_soft
job hard_enough 5.0e-6 2000 0 "$(sphere ball 0.01 0 0 0.0101 0 0 -9)" "$thin" \
    's/young: 1.0e8/young: 2.3e8/'
fine hard_enough "young as advised: 2.3 times"

# ------------------------------------------------------------------ tunnelling
# The public example: half a metre, ten kilometres a second.
job cannonball 1.0e-3 100 0 "$(sphere shot 0.5 0 0 5.3 0 0 -10000)" "  - $floor"
fails cannonball "motion, every step" "motion too fast at step" 0 1 "use time.step ="
job cannonball_slow 1.0e-3 90 0 "$(sphere shot 0.5 0 0 5.3 0 0 -49)" "  - $floor"
fine cannonball_slow "49 m/s: .098 of a radius in a step"
job bullet 1.0e-6 200 0 "$(sphere shot 0.001 0 0 0.0213 0 0 -105)" "  - $floor"
fails bullet "motion, every step" "motion too fast at step" 0 1 "use time.step ="
alike bullet
job bullet_fine 1.0e-6 200 0 "$(sphere shot 0.001 0 0 0.0213 0 0 -95)" "  - $floor"
fine bullet_fine "95 m/s instead of 105: .095 of a radius in a step"
ram='{name: ram, material: steel, geometry: {kind: plane, point: [-0.5, 0, 0], normal: [1, 0, 0], extent: 1}, motion: {velocity: [%s, 0, 0]}}'
# shellcheck disable=SC2059
job ram 1.0e-4 1000 0 "$(sphere rest 0.01 0 0 0 0 0 0)" "  - $(printf "$ram" 10.5)"
fails ram "motion of bodies, before the first step" "motion too fast at step 0" 0 0 "use time.step ="
alike ram
# shellcheck disable=SC2059
job ram_fine 1.0e-4 400 0 "$(sphere rest 0.01 0 0 0 0 0 0)" "  - $(printf "$ram" 9.5)"
fine ram_fine "9.5 m/s instead of 10.5"

# ------------------------------------------------------------------ far from the origin
job far 1.0e-5 600 -9.81 "$(sphere ball 0.001 1000000 0 1000000.00099 0 0 0)" "" \
    's/young: 1.0e8/young: 1.0e10/'
fails far "rounding of places" "too far from the origin at step" 0 1 "shift the scene towards the origin"
alike far
job near 1.0e-5 600 -9.81 "$(sphere ball 0.001 1000 0 1000.00099 0 0 0)" "" \
    's/young: 1.0e8/young: 1.0e10/'
fine near "a thousandth of the distance"
job flies_off 1.0e-5 2000 -9.81 "$(sphere ball 0.001 0 0 0 0 0 9)" "" \
    's/leavers: ignore/leavers: stop, min: [-0.1, -0.1, -0.1], max: [0.1, 0.1, 0.1]/'
fails flies_off "domain, every 64 steps" "sphere left the domain at step" 1111 64 "enlarge domain.min"
alike flies_off
job stays 1.0e-5 1100 -9.81 "$(sphere ball 0.001 0 0 0 0 0 9)" "" \
    's/leavers: ignore/leavers: stop, min: [-0.1, -0.1, -0.1], max: [0.1, 0.1, 0.1]/'
fine stays "ends a millimetre before"

# ------------------------------------------------------------------ beyond what sums hold
# A wrong unit: kilometres for millimetres.
job huge 1.0e-2 100 -9.81 "$(sphere moon 100000 0 0 1000 0 0 0)" ""
fails huge "exact sums, at samples" "a force or energy at step" 0 1 "check the units"
alike huge
job large 1.0e-2 100 -9.81 "$(sphere hill 10 0 0 1000 0 0 0)" ""
fine large "a ten-thousandth of the radius"

# ------------------------------------------------------------------ faster than the buffer
# Costs searches, never a contact: the same bits as with all pairs and no buffer.
job fast 1.0e-5 3000 0 "$(sphere shot 0.01 -0.3 0.003 0 20 0 0; sphere a 0.01 0 0 0 0 0 0; sphere b 0.01 0.03 0.004 0 0 0 0)" "  - $floor" \
    's/young: 1.0e8/young: 1.0e10/; s/restitution: 0.8/restitution: 0.9/; s/point: \[0, 0, 0\]/point: [0, 0, -0.0101]/'
for kind in "tiny decomposition.buffer=1e-6" "all testing.search=all-pairs"; do
    rm -rf "fast_${kind%% *}"
    alone run fast.yaml --out "fast_${kind%% *}" --set "${kind#* }" || why+=" $kind fails;"
done
equal fast_tiny fast_all
result "a sphere faster than a buffer of a micrometre: the same bits as without lists"
