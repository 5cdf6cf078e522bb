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
    free(removals->near);
    *removals = (struct removals){0};
}

static bool is_at_work(const struct removals *removals, int r, double time)
{
    return time >= removals->asked[r].start && time <= removals->asked[r].stop;
}

/* Is the place, or an image of it over periodic boundaries, nearer to the region's box than
 * `reach`? */
static bool is_near(const struct region *region, const struct periodic *periodic,
                    struct vec3 place, double reach)
{
    const struct vec3 low = region->low, high = region->high;
    double shifts[PERIODIC_IMAGES][3];
    const int n_shifts = periodic_shifts(periodic, shifts);
    bool near = false;
    for (int s = 0; s < n_shifts && !near; s++) {
        const double x = place.x + shifts[s][0], y = place.y + shifts[s][1],
                     z = place.z + shifts[s][2];
        near = x > low.x - reach && y > low.y - reach && z > low.z - reach &&
               x < high.x + reach && y < high.y + reach && z < high.z + reach;
    }
    return near;
}

void removals_search(struct removals *removals, const struct spheres *spheres)
{
    removals->n_near = 0;
    for (int i = 0; removals->n > 0 && i < spheres->n_owned; i++) {
        /* Twice the allowance: room for rounding. */
        const double reach = 2.0 * spheres->allowance[i];
        const struct vec3 place = sphere_place(spheres, i);
        for (int r = 0; r < removals->n && spheres->caught[i] == 0; r++) {
            if (!is_near(&removals->list[r].region, &spheres->periodic, place, reach))
                continue;
            ARRAY_GROW(removals->near, removals->n_near + 1, removals->near_capacity);
            removals->near[removals->n_near++] = (struct removal_near){i, r};
        }
    }
}

/* Does the way of the step that has just ended meet the region?  One that crossed a periodic
 * boundary is looked at from both of its ends. */
static bool has_met(const struct region *region, const struct spheres *spheres, int i,
                    struct vec3 way)
{
    const struct vec3 x = sphere_place(spheres, i), from = vec3_sub(x, way);
    if (region_is_met(region, x, way))
        return true;
    if (!spheres->periodic.any)
        return false;
    const struct vec3 began =
        periodic_place(&spheres->periodic, (double[3]){from.x, from.y, from.z});
    return region_is_met(region, vec3_add(began, way), way);
}

void removals_catch(struct removals *removals, struct spheres *spheres, double time, double dt)
{
    for (int k = 0; k < removals->n_near; k++) {
        const int i = removals->near[k].sphere, r = removals->near[k].removal;
        if (spheres->caught[i] != 0 || !is_at_work(removals, r, time))
            continue;
        const double *v = sphere_velocity(spheres, i);
        const struct vec3 way = {v[0] * dt, v[1] * dt, v[2] * dt};
        if (has_met(&removals->list[r].region, spheres, i, way))
            spheres->caught[i] = 1 + r;
    }
}

/* The first region that is at work and holds the place; -1: none. */
static int taker(const struct removals *removals, struct vec3 x, double time)
{
    for (int r = 0; r < removals->n; r++)
        if (is_at_work(removals, r, time) && region_contains(&removals->list[r].region, x, 0.0))
            return r;
    return -1;
}

int64_t removals_mark(struct removals *removals, const struct spheres *spheres, double time,
                      unsigned char *removed)
{
    int64_t n = 0;
    for (int i = 0; removals->n > 0 && i < spheres->n_owned; i++) {
        const int r = spheres->caught[i] > 0 ? spheres->caught[i] - 1
                                             : taker(removals, sphere_place(spheres, i), time);
        if (r < 0)
            continue;
        tally_add(&removals->list[r].taken, spheres, i);
        removed[i] = 1;
        n++;
    }
    return n;
}
