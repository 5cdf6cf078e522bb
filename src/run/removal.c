/* See removal.h. */
#include "run/removal.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/sphere.h"

void removals_init(struct removals *removals, const struct job *job,
                   const struct bodies *bodies)
{
    const struct tally_split total = tally_split(job, 0, 0, NULL);
    *removals = (struct removals){.n = job->n_removals, .asked = job->removals};
    removals->list = array_allocate((size_t)removals->n, sizeof *removals->list);
    for (int r = 0; r < removals->n; r++) {
        const struct tally_split split = tally_split(job, job->removals[r].by, 0, NULL);
        char *why = NULL;
        CHECK(region_build(&removals->list[r].region, &job->removals[r].region, bodies, &why),
              "%s", why);
        tally_init(&removals->list[r].taken, &split);
    }
    tally_init(&removals->leavers, &total);
}

void removals_clear(struct removals *removals)
{
    for (int r = 0; r < removals->n; r++) {
        region_clear(&removals->list[r].region);
        tally_clear(&removals->list[r].taken);
    }
    tally_clear(&removals->leavers);
    free(removals->list);
    *removals = (struct removals){0};
}

/* The first region that is at work and holds the place; -1: none. */
static int taker(const struct removals *removals, struct vec3 x, double time)
{
    for (int r = 0; r < removals->n; r++) {
        const struct job_removal *asked = &removals->asked[r];
        if (time >= asked->start && time <= asked->stop &&
            region_contains(&removals->list[r].region, x, 0.0))
            return r;
    }
    return -1;
}

int64_t removals_mark(struct removals *removals, const struct spheres *spheres, double time,
                      unsigned char *removed)
{
    int64_t n = 0;
    for (int i = 0; removals->n > 0 && i < spheres->n_owned; i++) {
        const int r = taker(removals, sphere_place(spheres, i), time);
        if (r < 0)
            continue;
        tally_add(&removals->list[r].taken, spheres, i);
        removed[i] = 1;
        n++;
    }
    return n;
}
