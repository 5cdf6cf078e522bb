#!/bin/bash
# The project speaks of itself: nothing in it depends on, or tells of, the place where it was written,
# and nothing is left half done.
set -euo pipefail

files=$(git ls-files 2> /dev/null || find . -path ./build -prune -o -path ./bin -prune -o -path ./runs -prune -o -type f -print)

# matches PATTERN: places in text files, this one aside.
matches()
{
    # shellcheck disable=SC2086 # one word a file
    for file in $files; do
        [ ! -f "$file" ] || echo "$file"
    done | grep -v '^tests/house/words.sh$' | xargs grep -nIE "$1" 2> /dev/null | cut -c 1-120 || true
}

found=$(matches '(^|[^A-Za-z0-9_./-])/(home|root|work|Users)/')
[ -z "$found" ] && echo "ok no paths of one machine" || echo "FAIL no paths of one machine: ${found//$'\n'/; }"

found=$(matches '\b(TODO|FIXME|XXX|HACK)\b')
[ -z "$found" ] && echo "ok nothing left to do" || echo "FAIL nothing left to do: ${found//$'\n'/; }"
