/* See wall_limit.h. */
#include "run/wall_limit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/process.h"
#include "base/units.h"

/* Hours, minutes and seconds, or minutes and seconds. */
static bool read_clock(const char *text, double *seconds)
{
    double parts[3];
    int n = 0;
    for (;;) {
        char *end;
        if (n == 3 || strspn(text, "0123456789") == 0)
            return false;
        parts[n++] = strtod(text, &end);
        if (*end == '\0')
            break;
        if (*end != ':')
            return false;
        text = end + 1;
    }
    *seconds = 0.0;
    for (int k = 0; k < n; k++)
        *seconds = 60.0 * *seconds + parts[k];
    return *seconds > 0.0;
}

bool wall_limit_read(const char *text, double *seconds)
{
    char what[256];
    if (strchr(text, ':') != NULL)
        return read_clock(text, seconds);
    return units_read(text, "s", seconds, what, sizeof what) && *seconds > 0.0;
}

/* A variable that holds a number above 0; else 0. */
static double number_in(const char *variable)
{
    const char *text = getenv(variable);
    char *end;
    const double value = text != NULL ? strtod(text, &end) : 0.0;
    return value > 0.0 && *end == '\0' ? value : 0.0;
}

static void shorten(double *left, const char **whose, double to, const char *by)
{
    if (to < *left) {
        *left = to;
        *whose = by;
    }
}

double wall_limit_left(double asked, const char **whose)
{
    double left = INFINITY;
    *whose = "nobody";
    const double end = number_in("SLURM_JOB_END_TIME"), allotted = number_in("PBS_WALLTIME");
    const double age = process_age(getpid());
    if (asked > 0.0)
        shorten(&left, whose, asked - (age > 0.0 ? age : 0.0), "--wall");
    if (end > 0.0)
        shorten(&left, whose, end - (double)time(NULL), "SLURM_JOB_END_TIME");
    if (allotted > 0.0) {
        const double taken = process_age(getsid(0));
        shorten(&left, whose, allotted - (taken > age ? taken : age), "PBS_WALLTIME");
    }
    return left;
}
