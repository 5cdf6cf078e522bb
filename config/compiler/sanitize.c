/*
 * Linked into every program of the sanitize flavour, so that leaks reported are leaks of ours.
 *
 * Open MPI unloads its plug-ins before the leak check, which then cannot name who allocated;
 * with a dlclose that does nothing they stay.  What Open MPI itself never frees, and HDF5 when
 * it meets a damaged file, is suppressed by name.  A program that uses MPI but was not started
 * by mpirun is not checked for leaks: the checker itself crashes there, on the threads that
 * Open MPI then has.  What such runs do is also run under mpirun.
 */
#include <stdlib.h>

int MPI_Initialized(int *flag);
int dlclose(void *handle);
const char *__asan_default_options(void);
const char *__lsan_default_suppressions(void);
int __lsan_is_turned_off(void);

int dlclose(void *handle)
{
    (void)handle;
    return 0;
}

const char *__asan_default_options(void)
{
    return "fast_unwind_on_malloc=0";
}

const char *__lsan_default_suppressions(void)
{
    return "leak:libopen-pal\n"
           "leak:libopen-rte\n"
           "leak:libmpi.so\n"
           "leak:libhdf5\n"
           "leak:libpmix\n"
           "leak:libhwloc\n"
           "leak:libevent\n"
           "leak:/openmpi/lib/openmpi\n"
           "leak:mca_\n";
}

int __lsan_is_turned_off(void)
{
    int initialized = 0;

    MPI_Initialized(&initialized);
    return initialized && getenv("OMPI_COMM_WORLD_SIZE") == NULL;
}
