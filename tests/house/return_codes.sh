#!/bin/bash
# Calls that can fail are looked at: MPI, HDF5 and the system.  The rule:
#
# - MPI: every communicator returns errors (base/comm, comm_world), so each call stands within
#   COMM_CHECK(), assigns or compares its status.  Free of it are calls that cannot fail or come when
#   nothing can be done: MPI_Initialized, MPI_Finalized, MPI_Error_string, MPI_Abort, and MPI_Comm_rank
#   on the way to the end (base/report).
# - HDF5: what opens, creates, reads, writes, links or closes a file or looks into one has its result
#   used.  Free are calls that give back what is in memory (H5Pclose, H5Sclose, H5Tclose, H5Dclose,
#   H5Aclose, H5Gclose; H5Fclose of a file opened for looking at its size), that set properties of it
#   (H5Pset..., H5Tset_...), and those about errors (H5E...); a property that was not set or an object
#   that is none lets the call fail that uses it.
# - System: what writes, forces to the disk, names, removes, reserves or allots has its result used, or is
#   cast to void, which says that a failure does not matter.  Free is close() of what was only read or
#   whose content was forced to the disk before, and unlink() of a temporary name.
#
# A statement that begins with such a call uses nothing of it; so statements are looked at, comments and
# strings aside.
set -euo pipefail

mpi='MPI_[A-Z][A-Za-z_]+'
mpi_free='MPI_(Initialized|Finalized|Error_string|Abort)'
hdf5='H5[A-Z][A-Z]?[a-z][A-Za-z0-9_]*'
hdf5_free='H5((P|S|T|D|A|G)close|Fclose|E[a-z][a-z0-9_]*|Pset_[a-z0-9_]+|Tset_[a-z]+|PLset_loading_state)'
system='(write|pwrite|read|pread|fsync|fdatasync|ftruncate|rename|link|symlink|mkdir|open|dup2|fwrite|fread|posix_fallocate|malloc|calloc|realloc|posix_memalign|getrandom|pthread_create|fseek|stat|fstat|setrlimit|system|chdir)'

# loose FILES: `file:line: call` for each statement that begins with a call whose result is not used.
loose()
{
    awk -v mpi="^($mpi)\\\\(" -v mpi_free="^($mpi_free)\\\\(" -v hdf5="^($hdf5)\\\\(" -v hdf5_free="^($hdf5_free)\\\\(" \
        -v system_calls="^($system)\\\\(" '
    function judge(text, where) {
        sub(/^((if|while|for|switch) *\(.*\)|else|do) +/, "", text)
        if ((text ~ mpi && text !~ mpi_free) || (text ~ hdf5 && text !~ hdf5_free) || text ~ system_calls)
            print where ": " substr(text, 1, index(text, "(") - 1)
    }
    FNR == 1 { begins = 1; within = 0 }
    {
        line = $0
        gsub(/"([^"\\]|\\.)*"/, "\"\"", line)
        sub(/\/\/.*/, "", line)
        gsub(/\/\*([^*]|\*[^\/])*\*\//, "", line)
        if (within) { if (line !~ /\*\//) next; sub(/.*\*\//, "", line); within = 0 }
        if (line ~ /\/\*/) { sub(/\/\*.*/, "", line); within = 1 }
        sub(/^[ \t]+/, "", line)
        sub(/[ \t]+$/, "", line)
        if (line == "" || line ~ /^#/) next
        if (begins) judge(line, FILENAME ":" FNR)
        # The next line begins a statement where this one ends one, opens or closes a block, or is all
        # of a condition.
        begins = line ~ /[;{}:]$/ || line ~ /^(if|while|for|else if) *\(.*\)$/ || line ~ /^(else|do)$/
    }' "$@"
}

found=$(loose src/*/*.c postproc/*.c | grep -v '^src/base/report\.c:[0-9]*: MPI_Comm_rank$' || true)
[ -z "$found" ] && echo "ok results are used" || echo "FAIL results are used: ${found//$'\n'/; }"

# Only comm_world() makes one of the world; what is split off inherits its handler.  (MPI_COMM_SELF keeps
# MPI's own, which ends the program.)
found=$(grep -nE '\{.*MPI_COMM_WORLD' src/*/*.c postproc/*.c | grep -v '^src/base/comm\.c:' || true)
grep -q 'MPI_Comm_set_errhandler(comm.mpi, MPI_ERRORS_RETURN)' src/base/comm.c || found+=" comm_world() sets no handler"
[ -z "$found" ] && echo "ok communicators return errors" || echo "FAIL communicators return errors: ${found//$'\n'/; }"

# It does find such calls.
why=
for planted in '    MPI_Barrier(comm->mpi);' '    if (comm->rank == 0)
        MPI_Barrier(comm->mpi);' '    H5Dwrite(0, 0, 0, 0, 0, NULL);' '    H5Fflush(0, H5F_SCOPE_LOCAL);' '    rename("a", "b");' \
    '    fsync(3);' '    if (n > 0) write(1, "(", 1);'; do
    { sed '/^void comm_barrier/,$d' src/base/comm.c; printf 'void planted(void)\n{\n%s\n}\n' "$planted"; } > "$SCRATCH/planted.c"
    [ "$(loose "$SCRATCH/planted.c" | wc -l)" = 1 ] || why+=" not '$planted';"
done
[ -z "$why" ] && echo "ok planted ones are found" || echo "FAIL planted ones are found:$why"
