#!/bin/bash
# Nothing whose bits depend on the processor, the compiler or the number of ranks feeds the state.
set -euo pipefail

# Of the C library's mathematics only what is exact everywhere may be called: the square root and the
# functions that round to whole numbers or take floating-point numbers apart.  (The rest varies with
# the processor; fmax and fmin are exact, but lose NaN.)
exact="sqrt floor ceil trunc rint nearbyint fabs copysign ldexp scalbn frexp modf llround lround llrint lrint"

# Files that compute only what people read, never state, with the reason:
#   none so far
printers=""

compiler=${CC:-gcc}
library=$("$compiler" -print-file-name=libm.so.6)
mathematics=$(nm -D --defined-only "$library" | awk '{print $3}' | sed 's/@.*//' | sort -u)
allowed=$(tr ' ' '\n' <<< "$exact" | sort -u)
forbidden=$(comm -23 <(echo "$mathematics") <(echo "$allowed"))
why=
for object in "$BUILD"/src/*/*.o; do
    module=$(basename "${object%.o}")
    case " $printers " in *" $module "*) continue ;; esac
    called=$(nm --undefined-only "$object" | awk '{print $2}' | sed 's/@.*//' | sort -u |
        comm -12 - <(echo "$forbidden"))
    [ -z "$called" ] || why+=" $module calls $(tr '\n' ' ' <<< "$called");"
done
[ -z "$why" ] && echo "ok no mathematics of the C library" || echo "FAIL no mathematics of the C library:$why"

# Calls that the compiler may have replaced by instructions of its own.
found=$(grep -nE '\b(fmax|fmin|fma|fmaxf|fminf|fmaf|__builtin_fma|__builtin_fmax|__builtin_fmin)\(' \
    src/*/*.[ch] || true)
[ -z "$found" ] && echo "ok no fmax, fmin, fma" || echo "FAIL no fmax, fmin, fma: ${found//$'\n'/; }"

# Sums over ranks are of integers; the kind stands on the line of the operation.
found=$(grep -nE 'MPI_SUM|MPI_PROD|H5_.*SUM' src/*/*.[ch] postproc/*.[ch] 2> /dev/null |
    grep -vE 'MPI_(INT|INT64_T|UINT64_T|LONG)\b' || true)
[ -z "$found" ] && echo "ok sums over ranks are of integers" ||
    echo "FAIL sums over ranks are of integers: ${found//$'\n'/; }"

# Flags and pragmas that let a compiler reorder, contract or flush.
found=$(grep -nE -e '-(ffast-math|Ofast|funsafe-math|fassociative-math|ffinite-math|march=native|mfma\b|ffp-contract=(fast|on))' \
    -e 'FP_CONTRACT|_MM_SET_FLUSH|_MM_SET_DENORMALS|optimize *\(' \
    Makefile config/compiler/* src/*/*.[ch] || true)
[ -z "$found" ] && echo "ok arithmetic as written" || echo "FAIL arithmetic as written: ${found//$'\n'/; }"
