/* See schedule.h. */
#include "run/schedule.h"

#include <math.h>

#include "job/job.h"

/* Until one was written a checkpoint is taken to need this, and so much a sphere [s]. */
static const double COST_LEAST = 0.1, COST_A_SPHERE = 2e-5;
/* The last checkpoint may take this many times what the others took. */
static const double COST_MARGIN = 2.0;
/* Seconds for ranks and launcher to end, and their share of a short limit. */
static const double GRACE = 10.0, GRACE_SHARE = 0.1;

void schedule_init(struct schedule *schedule, const struct job *job, double now)
{
    const double steps = job->checkpoint.every_time / job->time.step;
    *schedule = (struct schedule){.wall = job->checkpoint.every_wall,
                                  .mtbf = job->checkpoint.mtbf,
                                  .cost = COST_LEAST,
                                  .saved_at = now,
                                  .looked_at = now,
                                  .end = INFINITY,
                                  .every_steps = job->checkpoint.every_steps,
                                  .every_time = (int64_t)(steps < 1e15 ? steps + 0.5 : 1e15)};
    if (steps > 0.0 && schedule->every_time == 0)
        schedule->every_time = 1;
}

void schedule_guess(struct schedule *schedule, int64_t n_spheres)
{
    schedule->cost = COST_LEAST + COST_A_SPHERE * (double)n_spheres;
}

void schedule_limit(struct schedule *schedule, double now, double left)
{
    const double share = GRACE_SHARE * left;
    schedule->end = now + left;
    schedule->grace = share < GRACE ? share : GRACE;
    schedule->looked_at = now;
}

void schedule_saved(struct schedule *schedule, double now, double took)
{
    /* A slow one counts at once, quick ones bit by bit. */
    const double blend = 0.5 * (schedule->cost + took);
    schedule->cost = took > blend ? took : blend;
    schedule->saved_at = schedule->looked_at = now;
}

double schedule_interval(const struct schedule *schedule)
{
    if (schedule->mtbf > 0.0)
        return sqrt(2.0 * schedule->cost * schedule->mtbf);
    return schedule->wall > 0.0 ? schedule->wall : (double)INFINITY;
}

double schedule_reserve(const struct schedule *schedule)
{
    return COST_MARGIN * (schedule->cost + schedule->longest) + schedule->grace;
}

bool schedule_is_due(const struct schedule *schedule, double now)
{
    return now - schedule->saved_at > schedule_interval(schedule);
}

bool schedule_is_over(struct schedule *schedule, double now)
{
    const double took = now - schedule->looked_at, faded = 0.999 * schedule->longest;
    schedule->longest = took > faded ? took : faded;
    schedule->looked_at = now;
    return now > schedule->end - schedule_reserve(schedule);
}

bool schedule_has_step(const struct schedule *schedule, int64_t step)
{
    return (schedule->every_steps > 0 && step % schedule->every_steps == 0) ||
           (schedule->every_time > 0 && step % schedule->every_time == 0);
}
