/* See process.h. */
#include "base/process.h"

#include <inttypes.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>
#include <unistd.h>

bool process_lives(int64_t id, int64_t *started)
{
    enum { STATE = 3, STARTED = 22 }; /* columns, counted from 1 */
    char path[64], line[1024] = "";
    snprintf(path, sizeof path, "/proc/%" PRId64 "/stat", id);
    FILE *stream = fopen(path, "re");
    if (stream == NULL)
        return false;
    const bool is_read = fgets(line, sizeof line, stream) != NULL;
    fclose(stream);
    /* The second column is a name in brackets, with anything in it. */
    const char *rest = is_read ? strrchr(line, ')') : NULL;
    if (rest == NULL || strlen(rest) < 3 || strchr("ZXx", rest[2]) != NULL)
        return false;
    for (int column = STATE - 1; column < STARTED && rest != NULL; column++)
        rest = strchr(rest + 1, ' ');
    return rest != NULL && sscanf(rest, " %" SCNd64, started) == 1;
}

double process_age(int64_t id)
{
    int64_t started;
    struct timespec now;
    const long ticks = sysconf(_SC_CLK_TCK);
    if (ticks <= 0 || !process_lives(id, &started) || clock_gettime(CLOCK_BOOTTIME, &now) != 0)
        return -1.0;
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec - (double)started / (double)ticks;
}

double process_memory(void)
{
    struct rlimit limit;
    const double machine = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return machine;
    return (double)limit.rlim_cur < machine ? (double)limit.rlim_cur : machine;
}

void process_return_memory(void)
{
    enum { LARGE = 1 << 20, HEAP_END = 1 << 24 /* that is kept, for what comes and goes */ };
    (void)mallopt(M_MMAP_THRESHOLD, LARGE); /* at worst all stays as it is */
    (void)mallopt(M_TRIM_THRESHOLD, HEAP_END);
}

void process_job(char *text, size_t size)
{
    static const char *const schedulers[][2] = {
        {"slurm", "SLURM_JOB_ID"}, {"pbs", "PBS_JOBID"}, {"lsf", "LSB_JOBID"}};
    text[0] = '\0';
    for (size_t k = 0; k < sizeof schedulers / sizeof *schedulers && text[0] == '\0'; k++) {
        const char *id = getenv(schedulers[k][1]);
        if (id != NULL)
            snprintf(text, size, "%s %s", schedulers[k][0], id);
    }
}
