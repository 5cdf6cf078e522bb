/*
 * When a run saves, and when its wall time is over: the clock of rank 0.
 *
 * What a checkpoint takes is estimated from those written so far.  With a mean time between
 * failures M the time between checkpoints of cost C follows Young (1974), sqrt(2 C M), the
 * first order of Daly (2006): saving more often costs more than failures would.  A run with a
 * limit stops early enough for its last checkpoint.  What the clock says becomes collective
 * with the step's one reduction (run/watch.h) and changes no bit.  All functions are local.
 */
#ifndef TREMIE_RUN_SCHEDULE_H
#define TREMIE_RUN_SCHEDULE_H

#include <stdbool.h>
#include <stdint.h>

struct job;

struct schedule {
    double wall; /* between checkpoints, as the job says [s]; 0: not by the clock */
    double mtbf; /* mean time between failures [s]; 0: unknown */
    double cost; /* what a checkpoint takes, estimated [s] */
    double saved_at, looked_at, end; /* on timer_now()'s clock [s]; no end: infinite */
    double grace;                    /* what else it takes to end [s] */
    double longest;                  /* step, of late [s] */
    int64_t every_steps;             /* steps between checkpoints; 0: not by steps */
    int64_t every_time;              /* the same, from simulated time */
};

void schedule_init(struct schedule *schedule, const struct job *job, double now);
/* Notes how large the scene is, for a first guess of what a checkpoint takes. */
void schedule_guess(struct schedule *schedule, int64_t n_spheres);
/* Notes that only `left` seconds are left from now on. */
void schedule_limit(struct schedule *schedule, double now, double left);
/* Notes that a checkpoint was written, and took so many seconds. */
void schedule_saved(struct schedule *schedule, double now, double took);

/* Seconds between checkpoints by the clock; infinite: never. */
double schedule_interval(const struct schedule *schedule);
/* Seconds before the end at which a run has to stop. */
double schedule_reserve(const struct schedule *schedule);

/* Once a step: is a checkpoint due by the clock, is the time over? */
bool schedule_is_due(const struct schedule *schedule, double now);
bool schedule_is_over(struct schedule *schedule, double now);
/* Is one due at this step, whatever the clock says?  The same on all ranks. */
bool schedule_has_step(const struct schedule *schedule, int64_t step);

#endif
