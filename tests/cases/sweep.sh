#!/bin/bash
# timeout: 900
# Studies: a variant has the bits of the same job written by hand, on other ranks and after kills; what is
# bad is said where it stands; `status` and `stop` know studies; the numbers of tremie-study are those of
# the runs.
set -uo pipefail
# shellcheck source=tests/cases/common.sh
. "$(dirname "$0")/common.sh"
python=/usr/bin/python3 # Debian's h5py is for it
heap=$scenes/heap.yaml
scenes=$PWD

# say_sweep FILE: the job with the sweep that stands on standard input.
say_sweep()
{
    cat "$heap" - > "$1"
}

say_sweep study.yaml << 'END'
sweep:
  - {key: contact.pairs.0.friction, values: [0.3, 0.5]}
  - together:
      - {key: spheres.0.velocity.2, name: fall, from: -2, to: -4, count: 2}
      - {key: contact.pairs.1.friction, name: wall, values: [0.4, 0.2]}
END
names=(friction_0.3_fall_-2_wall_0.4 friction_0.3_fall_-4_wall_0.2
    friction_0.5_fall_-2_wall_0.4 friction_0.5_fall_-4_wall_0.2)
# The first and the last of these, written by hand.
sed 's/friction: 0.5, restitution: 0.5/friction: 0.3, restitution: 0.5/' "$heap" > first.yaml
sed 's/friction: 0.4, restitution: 0.6/friction: 0.2, restitution: 0.6/; s/-0.5, -2]/-0.5, -4]/' "$heap" > last.yaml

# lists TEXT...: the last output holds these texts.
lists() { local text; for text in "$@"; do says "$text"; done; }

# slowly RANKS OUT: the study in the background, slow enough to be disturbed.
slow="--set testing.search=all-pairs --set testing.search_every=1 --set checkpoint.every.steps=25"
slowly()
{
    # shellcheck disable=SC2086 # words
    start "$1" "$2" study $slow
}

# ------------------------------------------------------------------------------ what there is

tremie 1 check study.yaml || why+=" check ends with status $?;"
lists "variant 1: friction 0.3, fall -2, wall 0.4; 600 steps of 0.0002 s, in runs/study/${names[0]}" \
    "variant 4: friction 0.5, fall -4, wall 0.2; 600 steps" "4 variants; check --variant N"
tremie 1 check last.yaml && sed 1d said > by_hand
tremie 1 check study.yaml --variant 4 || why+=" check of one ends with status $?;"
sed 1d said | cmp -s - by_hand || why+=" check of one shows another scene;"
[ ! -e runs ] || why+=" check leaves a folder;"
result "check lists the variants"

# --------------------------------------------------------------------- the bits of a job by hand

run 2 reference study
lists "variant 4 of 4: friction 0.5, fall -4, wall 0.2" "4 of 4 variants have ended"
run 1 first first
run 3 last last
same_run first "reference/${names[0]}"
same_run last "reference/${names[3]}"
cmp -s first/job.yaml "reference/${names[0]}/job.yaml" || why+=" the job as used is another;"
"$bin/tremie-compare" "reference/${names[0]}" "reference/${names[1]}" > /dev/null &&
    why+=" variants do not differ;"
result "a variant is the job written by hand, bit for bit"

tremie 2 run study.yaml --out single --variant 4 || why+=" it ends with status $?;"
same_run last "single/${names[3]}"
[ "$(ls single)" = "$(printf '%s\n' "${names[3]}" study.yaml)" ] || why+=" there is more: $(ls single);"
"$bin/tremie" status single > said
lists "variant 1: not started; friction 0.3" "variant 4: finished, step 600 of 600" \
    "3 not started, 1 finished of 4 variants"
"$bin/tremie" status "single/${names[3]}" > said
says "state: finished"
result "one variant"

run 1 plain study --set 'sweep=[]' --set contact.pairs.0.friction=0.3
same_run first plain
result "without its sweep the job is one like any other"

# ------------------------------------------------------------------ killed, stopped, gone on with

slowly 2 study
wait_until_after "study/${names[1]}" 25
kill_ranks
"$bin/tremie" status study --json > json
"$python" -c "
import json
s = json.load(open('json'))
states = [v['status']['state'] for v in s['variants']]
assert states == ['finished', 'killed', 'not started', 'not started'], states
assert s['variants'][1]['values'] == {'friction': '0.3', 'fall': '-4', 'wall': '0.2'}
assert 0 < s['variants'][1]['status']['checkpoint']['step'] < 600
" 2> said || why+=" status is not so: $(tail -n 1 said);"
result "killed in the midst of the second of four"

slowly 3 study
wait_until_after "study/${names[2]}" 25
"$bin/tremie" stop study > told 2>&1 || why+=" stop ends with status $?;"
grep -qF "asked the run in study/${names[2]} to stop" told || why+=" stop says '$(cat told)';"
status=0
wait_for_end || status=$?
[ "$status" = 75 ] || why+=" exit status $status, not 75;"
lists "nothing to do: the run has reached its end" "resumes at step" \
    "2 of 4 variants have ended; the same command goes on"
result "gone on with, and stopped in the third"

run 1 study study
lists "4 of 4 variants have ended"
[ "$(grep -c 'nothing to do' said)" = 2 ] || why+=" not two had ended;"
[ "$(grep -c 'resumes at step' said)" = 3 ] || why+=" not three were resumed;"
for name in "${names[@]}"; do
    equal {reference,study}/"$name/checkpoints/step_000000000600.h5"
    equal {reference,study}/"$name"
done
result "the same bits after a kill and a stop"

cp study.yaml kept.yaml
slowly 1 changing
wait_until_after "changing/${names[0]}" 25
echo '# changed' >> study.yaml
status=0
wait_for_end || status=$?
cp kept.yaml study.yaml
[ "$status" = 4 ] || why+=" exit status $status, not 4;"
lists "study.yaml has changed since the study began; give the same command again" "1 of 4 variants have ended"
result "a job file that changes under the study"

# -------------------------------------------------------------------------- what is in the way

sed 's/values: \[0.3, 0.5\]/values: [0.3, 0.4, 0.5]/' study.yaml > longer.yaml
cp longer.yaml study.yaml
run 1 study study
says "6 of 6 variants have ended"
[ "$(grep -c 'nothing to do' said)" = 4 ] || why+=" runs that had ended are not left as they are;"
cp kept.yaml study.yaml
result "a value is added"

tremie 1 run study.yaml --out first && why+=" it runs in a run's folder;"
says "error: first holds a run and no study; name another folder with --out"
tremie 1 run first.yaml --out study && why+=" a run takes a study's folder;"
says "error: study holds other things than a run"
sed 's/name: fall/name: speed/' study.yaml > other.yaml
tremie 1 run other.yaml --out study && why+=" another study takes its folder;"
says "error: study belongs to another study, of job 'study' or other keys"
tremie 1 run study.yaml --out study --set time.step=1e-4 && why+=" another job goes on with its runs;"
lists "study/${names[0]} belongs to another job: time.step: was 0.0002, now 0.0001" "0 of 4 variants have ended"
result "folders of others"

say_sweep fast.yaml << 'END'
sweep: [{key: spheres.0.velocity.2, values: [-2, -500, -3]}]
END
status=0
tremie 2 run fast.yaml --out fast || status=$?
[ "$status" = 3 ] || why+=" exit status $status, not 3;"
lists "error: " "2 of 3 variants have ended"
"$bin/tremie" status fast > said
lists "variant 2: failed" "variant 3: finished" "2 finished, 1 failed of 3 variants"
result "one that fails does not hold up the others"

# --------------------------------------------------------------------------------- bad input

# refused PLACE_AND_TEXT...: the study bad.yaml is, on 3 ranks, with these messages and no others.
refused()
{
    local status=0 text
    tremie 3 run bad.yaml --out bad || status=$?
    [ "$status" = 2 ] || why+=" exit status $status, not 2;"
    [ ! -e bad ] || why+=" left a folder;"
    for text in "$@"; do
        says "bad.yaml:$text"
    done
    [ "$(grep -c '^bad.yaml:' said)" = $# ] || why+=" not $# messages;"
}

line=$(wc -l < "$heap")
say_sweep bad.yaml << 'END'
sweep:
  - key: contact.pairs.0.friction
    values: [0.3, -1, 0.5, much]
  - {key: spheres.0.radius, from: 0.1 m, to: 0.2 kg, count: 2}
END
refused "$((line + 4)):46: sweep.1.to is in another unit than sweep.1.from; the same is expected"
say_sweep bad.yaml << 'END'
sweep:
  - key: contact.pairs.0.friction
    values: [0.3, -1, 0.5, much]
  - {key: spheres.0.radios, values: [0.1]}
END
refused "$((line + 3)):19: contact.pairs.0.friction is '-1'; a number" "$((line + 3)):28: contact.pairs.0.friction: 'much' is not a finite number" \
    "$((line + 4)):11: unknown key spheres.0.radios; 'radius' is expected"
says "is expected (variant 2)"
sed -i 's/radios/radius/' bad.yaml
refused_alone=$(tremie 1 run bad.yaml --out bad --variant 2; echo $?)
[ "$refused_alone" = 2 ] || why+=" one alone: exit status $refused_alone, not 2;"
[ ! -e bad ] || why+=" one alone left a folder;"
says "contact.pairs.0.friction is '-1'"
say_sweep bad.yaml << 'END'
sweep: [{key: spheres.0.packing.spacing, values: [0.203, 0.19, 0.18]}]
END
sed -i 's/^title:/titel:/' bad.yaml
refused "3:1: unknown key titel; 'title' is expected" "$((line + 1)):58: spheres.0.packing.spacing makes spheres overlap" \
    "$((line + 1)):64: spheres.0.packing.spacing makes spheres overlap"
sed -i 's/^titel:/title:/' bad.yaml
status=0
tremie 2 check bad.yaml || status=$?
[ "$status" = 2 ] || why+=" exit status $status, not 2;"
lists "variant 1: spacing 0.203; 600 steps" "variant 2: spacing 0.19; not in order" "(variant 2)" "(variant 3)"
result "mistakes are named where they stand, each once"

for options in "--variant 5" "--variant 0" "--variant x" "--restart $PWD/first/checkpoints/step_000000000600.h5" \
    "--set contact.pairs.0.friction=0.1"; do
    status=0
    # shellcheck disable=SC2086 # words
    tremie 1 run study.yaml --out nothing $options || status=$?
    cat said >> all
    [ "$status" = 2 ] && [ ! -e nothing ] || why+=" $options gives status $status;"
done
mv all said
lists "error: there is no variant 5: the sweep of study.yaml has 4, from 1 on" "error: --variant 0 is no number of one" \
    "error: --variant x is no number of one" "error: --restart is for one run and study.yaml is a study" \
    "--set:1:1: 'contact.pairs.0.friction' varies in the sweep; another key is expected"
tremie 1 run first.yaml --out nothing --variant 1 && why+=" a job without a sweep has a variant;"
says "error: first.yaml has no sweep; leave out --variant"
result "options that do not fit"

# ----------------------------------------------------------------------------------- the table

"$bin/tremie-study" reference --csv table.csv --from 0.04 --to 0.1 \
    --results 'bin.force_z:mean,middle.mass_forward,overlap_max:max,overlap_max:min,middle.count_forward:rate,*_rotation' \
    > said 2>&1 || why+=" tremie-study ends with status $?;"
lists "study reference: 4 variants" "million_particle_steps_s"
for name in "${names[@]}"; do
    "$bin/tremie-info" "reference/$name" --csv "$name.csv" > /dev/null || why+=" no series of $name;"
done
"$python" - "${names[@]}" << 'END' 2> said || why+=" the table is wrong: $(tail -n 1 said);"
import csv, sys
table = list(csv.DictReader(open("table.csv")))
assert len(table) == 4
for number, (row, name) in enumerate(zip(table, sys.argv[1:]), 1):
    of = name.split("_")
    assert [row["variant"], row["friction"], row["fall"], row["wall"]] == [str(number), of[1], of[3], of[5]], row
    assert row["state"] == "finished" and row["steps"] == "600" and float(row["time_s"]) == 0.12
    assert float(row["wall_s"]) > 0 and float(row["million_particle_steps_s"]) > 0
    rows = [{k: float(v) for k, v in r.items()} for r in csv.DictReader(open(name + ".csv"))]
    rows = [r for r in rows if 0.04 <= r["time_s"] <= 0.1]
    assert 29 <= len(rows) <= 31
    column = lambda c: [r[c] for r in rows]
    passed = column("middle.count_forward")
    expected = {
        "bin.force_z.mean_N": sum(column("bin.force_z_N")) / len(rows),
        "middle.mass_forward_kg": rows[-1]["middle.mass_forward_kg"],
        "overlap_max.max": max(column("overlap_max")),
        "overlap_max.min": min(column("overlap_max")),
        "middle.count_forward.rate_1_s": (passed[-1] - passed[0]) / (rows[-1]["time_s"] - rows[0]["time_s"]),
        "kinetic_rotation_J": rows[-1]["kinetic_rotation_J"],
    }
    for key, value in expected.items():
        assert abs(float(row[key]) - value) <= 1e-9 * abs(value), (key, row[key], value)
assert len({row["overlap_max.max"] for row in table}) > 1, "nothing depends on the parameters"
END
result "the numbers of tremie-study are those of the samples"

"$bin/tremie-chart" table.csv -o table.svg --x fall --y bin.force_z.mean_N --group friction --markers > said 2>&1 ||
    why+=" tremie-chart ends with status $?;"
# Two curves of two points, and two in the legend.
[ "$(grep -o '<circle' table.svg | wc -l)" = 6 ] || why+=" $(grep -o '<circle' table.svg | wc -l) dots, not 6;"
"$bin/tremie-study" single --csv single.csv > said || why+=" of a study that has not ended: status $?;"
says "not started"
[ "$(sed -n 2p single.csv)" = "1,0.3,-2,0.4,not started,,,,,,," ] || why+=" $(sed -n 2p single.csv);"
"$bin/tremie-study" fast > said || why+=" of a study with a failure: status $?;"
says "failed"
for bad in "first" "reference --results moo" "reference --results overlap_max:median"; do
    status=0
    # shellcheck disable=SC2086 # words
    "$bin/tremie-study" $bad > said 2>&1 || status=$?
    [ "$status" = 2 ] || why+=" tremie-study $bad: status $status, not 2;"
    says "error: "
done
mkdir empty && cp reference/study.yaml empty
status=0
"$bin/tremie-study" empty > said 2>&1 || status=$?
[ "$status" = 1 ] || why+=" of a study that has not begun: status $status, not 1;"
head -c 100 reference/study.yaml > empty/study.yaml
status=0
"$bin/tremie-study" empty > said 2>&1 || status=$?
[ "$status" = 4 ] || why+=" of a damaged list: status $status, not 4;"
says "error: cannot make sense of empty/study.yaml"
result "the table of what has not ended, and a chart"
