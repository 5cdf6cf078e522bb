/*
 * Linked into every program of the sanitize flavour, so that leaks reported are leaks of ours.
 *
 * Open MPI unloads its plug-ins before the leak check, which then cannot name who allocated;
 * with a dlclose that does nothing they stay.  What Open MPI itself never frees, and HDF5 when
 * it meets a damaged file, is suppressed by name.
 */
int dlclose(void *handle);
const char *__asan_default_options(void);
const char *__lsan_default_suppressions(void);

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
