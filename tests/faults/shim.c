/*
 * Faults, loaded before the C library (LD_PRELOAD): the n-th call of a process that touches the
 * run's folder, or the n-th look at the clock of its program, does what FAULT says.  Counting
 * calls instead of waiting puts a fault really inside a checkpoint's write, and there again
 * when the same seed is given.
 *
 *   FAULT=WHAT:ON:N:RANK  WHAT: kill (this process), kill_all (all ranks), kill_mpirun, stop
 *                         (SIGSTOP), short (half is written), fail=ERROR (that call),
 *                         break=ERROR (all calls from then on), jump=SECONDS (clocks, as if
 *                         somebody had set them; forwards also those that are never set: the
 *                         machine has slept)
 *                         ON: write (calls that change files), read, tick (the clock)
 *   FAULT_FOLDER=PATH     the run's folder
 *   FAULT_NOTES=FILE      gets a line for the strike, for each checkpoint that has got its
 *                         name, and at the end for the numbers of calls
 *
 * Calls of the main thread alone are counted: the lock's heart beats by the clock.
 */
#include <dirent.h>
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <signal.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

enum on { WRITE, READ, TICK, N_ON };
static const char *const ONS[N_ON] = {"write", "read", "tick"};

static struct {
    bool ready, struck, mine;
    char what[32];
    long value; /* error or seconds */
    long n, counts[N_ON];
    enum on on;
    long rank;
    const char *folder, *notes;
    uintptr_t begin, end; /* of the program itself */
} shim;

#define REAL(type, name, ...)                                                                  \
    static type (*real)(__VA_ARGS__);                                                          \
    if (real == NULL)                                                                          \
    *(void **)&real = dlsym(RTLD_NEXT, name)

static void note(const char *format, ...) __attribute__((format(printf, 1, 2)));
static void note(const char *format, ...)
{
    char line[4608];
    va_list arguments;
    va_start(arguments, format);
    const int length = vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    const long file = shim.notes != NULL ? syscall(SYS_openat, AT_FDCWD, shim.notes,
                                                   O_WRONLY | O_APPEND | O_CREAT, 0666)
                                         : -1;
    if (file < 0)
        return;
    syscall(SYS_write, file, line, (size_t)length);
    syscall(SYS_close, file);
}

static int find_program(struct dl_phdr_info *info, size_t size, void *unused)
{
    (void)size;
    (void)unused;
    for (int k = 0; k < info->dlpi_phnum; k++)
        if (info->dlpi_phdr[k].p_type == PT_LOAD && (info->dlpi_phdr[k].p_flags & PF_X) != 0) {
            shim.begin = info->dlpi_addr + info->dlpi_phdr[k].p_vaddr;
            shim.end = shim.begin + info->dlpi_phdr[k].p_memsz;
        }
    return 1; /* the program is the first */
}

static void set_up(void)
{
    char on[16] = "";
    const char *fault = getenv("FAULT"), *rank = getenv("OMPI_COMM_WORLD_RANK");
    shim.ready = true;
    if (strcmp(program_invocation_short_name, "tremie") != 0)
        return; /* helpers of MPI */
    shim.folder = getenv("FAULT_FOLDER");
    shim.notes = getenv("FAULT_NOTES");
    shim.rank = rank != NULL ? strtol(rank, NULL, 10) : 0;
    dl_iterate_phdr(find_program, NULL);
    long struck_rank = -1;
    if (fault != NULL &&
        sscanf(fault, "%31[^:]:%15[^:]:%ld:%ld", shim.what, on, &shim.n, &struck_rank) == 4) {
        char *equals = strchr(shim.what, '=');
        if (equals != NULL) {
            *equals = '\0';
            shim.value = strtol(equals + 1, NULL, 10);
        }
        for (int k = 0; k < N_ON; k++)
            if (strcmp(on, ONS[k]) == 0)
                shim.on = (enum on)k;
        shim.mine = struck_rank == shim.rank;
    }
}

static void __attribute__((destructor)) tell_numbers(void)
{
    if (shim.ready)
        note("end rank %ld write %ld read %ld tick %ld\n", shim.rank, shim.counts[WRITE],
             shim.counts[READ], shim.counts[TICK]);
}

static bool is(const char *what)
{
    return strcmp(shim.what, what) == 0;
}

static void kill_siblings(void)
{
    char path[64], text[4096] = "";
    snprintf(path, sizeof path, "/proc/%d/task/%d/children", getppid(), getppid());
    const long file = getenv("OMPI_COMM_WORLD_RANK") != NULL
                          ? syscall(SYS_openat, AT_FDCWD, path, O_RDONLY)
                          : -1;
    if (file >= 0 && syscall(SYS_read, file, text, sizeof text - 1) > 0)
        for (char *at = text, *next; *at != '\0'; at = next) {
            const long id = strtol(at, &next, 10);
            if (next == at)
                break;
            if (id > 1 && id != getpid())
                kill((pid_t)id, SIGKILL);
        }
    kill(getpid(), SIGKILL);
}

static void strike(const char *call, const char *path)
{
    shim.struck = true;
    note("struck rank %ld %s on %s %ld: %s %s\n", shim.rank, shim.what, ONS[shim.on], shim.n,
         call, path);
    if (is("kill"))
        kill(getpid(), SIGKILL);
    else if (is("kill_all"))
        kill_siblings();
    else if (is("kill_mpirun"))
        kill(getppid(), SIGKILL);
    else if (is("stop"))
        kill(getpid(), SIGSTOP);
}

/* Counts a call; true when it is to fail (errno is set) or, for `short`, to do half. */
static bool counts(enum on on, const char *call, const char *path)
{
    if (!shim.ready)
        set_up();
    if (gettid() != getpid())
        return false;
    const bool now = ++shim.counts[on] == shim.n && on == shim.on && shim.mine;
    if (now)
        strike(call, path);
    const bool fails =
        on == shim.on && ((now && (is("fail") || is("short"))) || (shim.struck && is("break")));
    if (fails)
        errno = (int)shim.value;
    return fails;
}

static bool in_folder(const char *path)
{
    if (!shim.ready)
        set_up();
    const size_t length = shim.folder != NULL ? strlen(shim.folder) : 0;
    return length > 0 && strncmp(path, shim.folder, length) == 0;
}

/* As counts(), for a call on an open file. */
static bool counts_file(enum on on, const char *call, int file)
{
    char link[64], path[4096] = "";
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    return readlink(link, path, sizeof path - 1) > 0 && in_folder(path) &&
           counts(on, call, path);
}

static bool counts_path(enum on on, const char *call, const char *path)
{
    return in_folder(path) && counts(on, call, path);
}

/* ------------------------------------------------------------------------------ open files */

static bool fails_open(const char *path, int flags)
{
    const bool writes = (flags & (O_WRONLY | O_RDWR | O_CREAT | O_TRUNC)) != 0;
    return counts_path(writes ? WRITE : READ, "open", path) && !is("short");
}

#define OPEN(name)                                                                             \
    int name(const char *path, int flags, ...)                                                 \
    {                                                                                          \
        REAL(int, #name, const char *, int, ...);                                              \
        va_list arguments;                                                                     \
        va_start(arguments, flags);                                                            \
        const mode_t mode =                                                                    \
            (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;              \
        va_end(arguments);                                                                     \
        return fails_open(path, flags) ? -1 : real(path, flags, mode);                         \
    }
OPEN(open)
OPEN(open64)

#define FOPEN(name)                                                                            \
    FILE *name(const char *path, const char *mode)                                             \
    {                                                                                          \
        REAL(FILE *, #name, const char *, const char *);                                       \
        return fails_open(path, *mode == 'r' ? O_RDONLY : O_WRONLY) ? NULL : real(path, mode); \
    }
FOPEN(fopen)
FOPEN(fopen64)

DIR *opendir(const char *path)
{
    REAL(DIR *, "opendir", const char *);
    return counts_path(READ, "opendir", path) && !is("short") ? NULL : real(path);
}

ssize_t write(int file, const void *bytes, size_t n)
{
    REAL(ssize_t, "write", int, const void *, size_t);
    if (counts_file(WRITE, "write", file)) {
        if (!is("short"))
            return -1;
        n = (n + 1) / 2;
    }
    return real(file, bytes, n);
}

#define PWRITE(name, offset_type)                                                              \
    ssize_t name(int file, const void *bytes, size_t n, offset_type offset)                    \
    {                                                                                          \
        REAL(ssize_t, #name, int, const void *, size_t, offset_type);                          \
        if (counts_file(WRITE, "pwrite", file)) {                                              \
            if (!is("short"))                                                                  \
                return -1;                                                                     \
            n = (n + 1) / 2;                                                                   \
        }                                                                                      \
        return real(file, bytes, n, offset);                                                   \
    }
PWRITE(pwrite, off_t)
PWRITE(pwrite64, off64_t)

ssize_t read(int file, void *bytes, size_t n)
{
    REAL(ssize_t, "read", int, void *, size_t);
    if (counts_file(READ, "read", file)) {
        if (!is("short"))
            return -1;
        n = (n + 1) / 2;
    }
    return real(file, bytes, n);
}

#define PREAD(name, offset_type)                                                               \
    ssize_t name(int file, void *bytes, size_t n, offset_type offset)                          \
    {                                                                                          \
        REAL(ssize_t, #name, int, void *, size_t, offset_type);                                \
        if (counts_file(READ, "pread", file)) {                                                \
            if (!is("short"))                                                                  \
                return -1;                                                                     \
            n = (n + 1) / 2;                                                                   \
        }                                                                                      \
        return real(file, bytes, n, offset);                                                   \
    }
PREAD(pread, off_t)
PREAD(pread64, off64_t)

#define ON_FILE(name, parameters, values, ...)                                                 \
    int name parameters                                                                        \
    {                                                                                          \
        REAL(int, #name, __VA_ARGS__);                                                         \
        return counts_file(WRITE, #name, file) && !is("short") ? -1 : real values;             \
    }
ON_FILE(fsync, (int file), (file), int)
ON_FILE(fdatasync, (int file), (file), int)
ON_FILE(ftruncate, (int file, off_t n), (file, n), int, off_t)
ON_FILE(ftruncate64, (int file, off64_t n), (file, n), int, off64_t)

#define FALLOCATE(name, offset_type)                                                           \
    int name(int file, offset_type begin, offset_type n)                                       \
    {                                                                                          \
        REAL(int, #name, int, offset_type, offset_type);                                       \
        return counts_file(WRITE, #name, file) && !is("short") ? (int)shim.value               \
                                                               : real(file, begin, n);         \
    }
FALLOCATE(posix_fallocate, off_t)
FALLOCATE(posix_fallocate64, off64_t)

/* ----------------------------------------------------------------------------------- names */

int rename(const char *from, const char *to)
{
    REAL(int, "rename", const char *, const char *);
    if (counts_path(WRITE, "rename", to) && !is("short"))
        return -1;
    const int status = real(from, to);
    if (status == 0 && in_folder(to) && strstr(to, "/checkpoints/step_") != NULL &&
        strstr(to, "set_aside") == NULL)
        note("published %s\n", to);
    return status;
}

#define ON_PATH(name, parameters, path, values, ...)                                           \
    int name parameters                                                                        \
    {                                                                                          \
        REAL(int, #name, __VA_ARGS__);                                                         \
        return counts_path(WRITE, #name, path) && !is("short") ? -1 : real values;             \
    }
ON_PATH(link, (const char *from, const char *to), to, (from, to), const char *, const char *)
ON_PATH(unlink, (const char *path), path, (path), const char *)
ON_PATH(mkdir, (const char *path, mode_t mode), path, (path, mode), const char *, mode_t)

/* ----------------------------------------------------------------------------------- clocks */

static void tick(const void *caller)
{
    if (!shim.ready)
        set_up();
    if ((uintptr_t)caller >= shim.begin && (uintptr_t)caller < shim.end)
        (void)counts(TICK, "clock", "");
}

static time_t jumped(bool settable)
{
    return shim.struck && is("jump") && (settable || shim.value > 0) ? shim.value : 0;
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    REAL(int, "clock_gettime", clockid_t, struct timespec *);
    tick(__builtin_return_address(0));
    const int status = real(clock, now);
    now->tv_sec += jumped(clock == CLOCK_REALTIME);
    return status;
}

time_t time(time_t *place)
{
    REAL(time_t, "time", time_t *);
    const time_t now = real(NULL) + jumped(true);
    if (place != NULL)
        *place = now;
    return now;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone)
{
    REAL(int, "gettimeofday", struct timeval *, void *);
    const int status = real(now, zone);
    now->tv_sec += jumped(true);
    return status;
}
