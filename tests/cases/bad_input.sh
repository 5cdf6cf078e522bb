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
