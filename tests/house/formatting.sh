#!/bin/bash
# C is laid out as .clang-format says, and lines end where they should.  `clang-format -i FILE` mends it.
set -euo pipefail

sources=$(ls src/*/*.[ch] postproc/*.[ch] tests/unit/*.[ch] tests/verification/*.[ch] tests/stability/*.[ch] tests/faults/*.c tests/fuzz/*.[ch] charts/*.[ch] config/compiler/*.c 2> /dev/null || true)

version=$(clang-format --version 2> /dev/null | sed -n 's/.*version \([0-9]*\)\..*/\1/p')
if [ "$version" = 14 ]; then
    badly=$(for file in $sources; do
        clang-format "$file" | cmp -s - "$file" || echo "$file"
    done)
    [ -z "$badly" ] && echo "ok clang-format" || echo "FAIL clang-format: ${badly//$'\n'/ }"
else
    echo "skip clang-format: version 14 decides, others lay out differently"
fi

# A string may run on; code and comments may not.
# shellcheck disable=SC2086 # one word a file
long=$(awk 'length > 96 && !/"[^"]*"/ { print FILENAME ":" FNR }' $sources)
[ -z "$long" ] && echo "ok 96 columns" || echo "FAIL 96 columns: $(head -n 20 <<< "$long" | tr '\n' ' ')"

files=$(git ls-files 2> /dev/null || find . -path ./build -prune -o -path ./bin -prune -o -path ./runs -prune -o -type f -print)
found=$(for file in $files; do
    case $file in
    *.png | *.h5 | *.csv | tests/cases/bad/*) continue ;;
    esac
    [ -s "$file" ] || continue
    ! grep -qE '[[:space:]]$' "$file" || echo "$file has blanks at the end of lines;"
    [ -z "$(tail -c 1 "$file")" ] || echo "$file does not end with a newline;"
    case $file in
    Makefile | *.mk) ;;
    *) ! grep -q $'\t' "$file" || echo "$file has tabs;" ;;
    esac
done)
[ -z "$found" ] && echo "ok blanks" || echo "FAIL blanks: ${found//$'\n'/ }"
