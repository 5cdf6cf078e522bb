/* Wall time by phase.  Local; nothing of it may feed a result. */
#ifndef TREMIE_BASE_TIMER_H
#define TREMIE_BASE_TIMER_H

#include <time.h>

/* Seconds of a clock that never goes back. */
static inline double timer_now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

#endif
