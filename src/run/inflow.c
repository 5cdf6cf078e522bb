/* See inflow.h. */
#include "run/inflow.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/body.h"
#include "model/gravity.h"
#include "model/packing.h"
#include "model/periodic.h"
#include "model/region.h"
#include "model/sizes.h"
#include "run/insertion.h"
#include "run/limits.h"
#include "run/simulation.h"

/* ------------------------------------------------------------------------------- regions */

/* Notes where a region lies; false, its mistake listed, where it cannot be built. */
static bool add_region(const struct job *job, const char *list, const char *name,
                       struct job_place place, const struct job_region *asked,
                       const struct bodies *bodies, struct region *region,
                       struct mistakes *mistakes)
{
    char *why = NULL;
    const bool fine = region_build(region, asked, bodies, &why);
    if (!fine)
        mistakes_add(mistakes, job->path, place.line, place.column,
                     "%s: the region of '%s': %s", list, name, why);
    free(why);
    return fine;
}

/* Does it lie in the domain, along directions that do not repeat? */
static bool region_is_in_domain(const struct job *job, const struct region *region)
{
    const struct vec3 low = job->domain.min, high = job->domain.max;
    const bool along[3] = {region->low.x >= low.x && region->high.x <= high.x,
                           region->low.y >= low.y && region->high.y <= high.y,
                           region->low.z >= low.z && region->high.z <= high.z};
    bool inside = true;
    for (int k = 0; k < 3; k++)
        inside = inside && (along[k] || (job->domain.periodic & 1 << k) != 0);
    return inside;
}

/* Does the region hold a sphere of this radius anywhere, as far as many attempts tell? */
static bool region_holds(const struct region *region, double radius)
{
    enum { ATTEMPTS = 10000 };
    for (uint64_t a = 0; a < ATTEMPTS; a++)
        if (region_contains(region, region_point(region, radius, 0, 0, a), radius))
            return true;
    return false;
}

static double lesser(double a, double b)
{
    return a < b ? a : b;
}

static double greater(double a, double b)
{
    return a > b ? a : b;
}

/* Grows the box from low to high by a region. */
static void include(struct vec3 *low, struct vec3 *high, const struct region *region)
{
    *low = (struct vec3){lesser(low->x, region->low.x), lesser(low->y, region->low.y),
                         lesser(low->z, region->low.z)};
    *high = (struct vec3){greater(high->x, region->high.x), greater(high->y, region->high.y),
                          greater(high->z, region->high.z)};
}

static void check_insertion(const struct job *job, const struct job_insertion *insertion,
                            const struct bodies *bodies, struct vec3 *low, struct vec3 *high,
                            struct mistakes *mistakes)
{
    struct region region;
    struct sizes sizes;
    if (!add_region(job, "insert", insertion->name, insertion->place, &insertion->region,
                    bodies, &region, mistakes))
        return;
    sizes_build(&sizes, &insertion->sizes, insertion->radius);
    include(low, high, &region);
    if (job->domain.given && !region_is_in_domain(job, &region))
        mistakes_add(
            mistakes, job->path, insertion->place.line, insertion->place.column,
            "insert: the region of '%s' reaches beyond the domain; one inside domain.min "
            "and domain.max is expected",
            insertion->name);
    if (!region_holds(&region, sizes.max))
        mistakes_add(
            mistakes, job->path, insertion->place.line, insertion->place.column,
            "insert: the region of '%s' holds no sphere of radius %.4g m; a larger one "
            "is expected",
            insertion->name, sizes.max);
    sizes_clear(&sizes);
    region_clear(&region);
}

void inflow_check(const struct job *job, const struct bodies *bodies, struct vec3 *low,
                  struct vec3 *high, struct mistakes *mistakes)
{
    const struct job_place nowhere = {0, 0};
    struct region region;
    for (int k = 0; k < job->n_insertions; k++)
        check_insertion(job, &job->insertions[k], bodies, low, high, mistakes);
    for (int k = 0; k < job->n_removals; k++)
        if (add_region(job, "remove", job->removals[k].name, nowhere, &job->removals[k].region,
                       bodies, &region, mistakes))
            region_clear(&region);
    for (int k = 0; k < job->n_contents; k++)
        if (add_region(job, "contents", job->contents[k].name, nowhere,
                       &job->contents[k].region, bodies, &region, mistakes))
            region_clear(&region);
}

/* ------------------------------------------------------------------------------- insertions */

static double mean_density(const struct job *job, const struct job_insertion *insertion)
{
    double sum = 0.0, shares = 0.0;
    for (int m = 0; m < insertion->n_mix; m++) {
        sum += insertion->mix[m].share * job->materials[insertion->mix[m].material].density;
        shares += insertion->mix[m].share;
    }
    return insertion->n_mix > 0 ? sum / shares : job->materials[insertion->material].density;
}

struct inflow inflow_of(const struct job *job, int number)
{
    const struct job_insertion *insertion = &job->insertions[number];
    struct sizes sizes;
    struct vec3 most = insertion->spread;
    sizes_build(&sizes, &insertion->sizes, insertion->radius);
    most.x += fabs(insertion->velocity.x);
    most.y += fabs(insertion->velocity.y);
    most.z += fabs(insertion->velocity.z);
    struct inflow inflow = {
        .mean_mass = sizes.mean_volume * mean_density(job, insertion),
        .radius_least = sizes.min,
        .radius_most = sizes.max,
        .speed = vec3_norm(most),
    };
    const int64_t n_steps =
        job->time.step > 0.0 ? simulation_steps(job->time.end, job->time.step) : 0;
    const double due = n_steps > 0 ? insertion_due_since(insertion, n_steps, job->time.step)
                                   : insertion_due(insertion, job->time.end);
    inflow.n = insertion->by_mass ? due / inflow.mean_mass : floor(due);
    if (insertion->until_count > 0 && inflow.n > (double)insertion->until_count)
        inflow.n = (double)insertion->until_count;
    if (inflow.n * inflow.mean_mass > insertion->until_mass)
        inflow.n = insertion->until_mass / inflow.mean_mass;
    inflow.mass = inflow.n * inflow.mean_mass;
    inflow.rate =
        insertion->by_mass ? insertion->mass_rate / inflow.mean_mass : insertion->number_rate;
    const double began = job->time.end - insertion->start, took = inflow.n / inflow.rate;
    if (began > 0.0)
        inflow.n_mean = inflow.n * (began - 0.5 * took) / job->time.end;
    sizes_clear(&sizes);
    return inflow;
}

void inflow_add_limits(struct limits *limits, const struct job *job,
                       const struct materials *materials, int number)
{
    const struct job_insertion *insertion = &job->insertions[number];
    const struct inflow inflow = inflow_of(job, number);
    const int n = insertion->n_mix > 0 ? insertion->n_mix : 1;
    for (int m = 0; m < n; m++) {
        struct packing_sphere sphere = {
            .material = insertion->n_mix > 0 ? insertion->mix[m].material : insertion->material,
            .radius = inflow.radius_least};
        limits_add(limits, job, materials, &sphere);
        sphere.radius = inflow.radius_most;
        limits_add(limits, job, materials, &sphere);
    }
}

/* ------------------------------------------------------------------------------- room */

/* What can be filled at random of a region without walls, more than of any with: by equal
 * spheres (THEORY.md 11.2), and by the most unequal ones that come in any order. */
static const double FULL = 0.384, FULL_UNEQUAL = 0.5;

/* How long a centre stays in the region that comes in at x; not beyond `most` [s]. */
static double time_inside(const struct region *region, struct vec3 x, struct vec3 velocity,
                          struct vec3 gravity, double most)
{
    enum { PARTS = 64, HALVINGS = 20 };
    double inside = 0.0, outside = most;
    for (int k = 0; k < PARTS + HALVINGS; k++) {
        const bool found = outside < most || k >= PARTS;
        const double t = found ? 0.5 * (inside + outside) : most * (k + 1.0) / PARTS;
        const struct vec3 fallen = vec3_axpy(vec3_scale(t, velocity), 0.5 * t * t, gravity);
        if (region_contains(region, vec3_add(x, fallen), 0.0))
            inside = t;
        else
            outside = t;
    }
    return inside;
}

/* The mean over the region [s]. */
static double mean_time_inside(const struct job *job, const struct job_insertion *insertion,
                               const struct region *region, double most)
{
    enum { POINTS = 400 };
    double sum = 0.0;
    int n = 0;
    for (uint64_t k = 0; k < POINTS; k++) {
        const struct vec3 x = region_point(region, 0.0, 0, 0, k);
        if (!region_contains(region, x, 0.0))
            continue;
        sum += time_inside(region, x, insertion->velocity, job->gravity, most);
        n++;
    }
    return n > 0 ? sum / n : 0.0;
}

/* Says why insertion k cannot go on as asked for, whatever is in its region; NULL: it may be
 * able to.  The caller frees it. */
static char *lack_of_room(const struct job *job, int k, const struct bodies *bodies)
{
    const struct job_insertion *insertion = &job->insertions[k];
    const struct inflow inflow = inflow_of(job, k);
    struct region region;
    struct periodic periodic;
    struct sizes sizes;
    char *why = NULL;
    periodic_init(&periodic, job);
    CHECK(region_build(&region, &insertion->region, bodies, &why), "%s", why);
    region_repeat(&region, &periodic);
    sizes_build(&sizes, &insertion->sizes, insertion->radius);
    const double lasts = inflow.n / inflow.rate;
    const double stay = mean_time_inside(job, insertion, &region, lasts);
    const double between = (double)insertion->every * job->time.step;
    const double at_once = lesser(inflow.n, inflow.rate * greater(stay, between));
    const double share = at_once * sizes.mean_volume / region.volume;
    const double most = sizes.max > sizes.min ? FULL_UNEQUAL : FULL;
    if (share > most)
        why = array_format(
            "insert '%s': of %.4g spheres a second, which stay in the region for %.3g s in the "
            "mean and come in every %.3g s, %.4g would be there at a time, %.3g %% of its "
            "volume, where at most %.3g %% find room at random",
            insertion->name, inflow.rate, stay, between, at_once, 100.0 * share, 100.0 * most);
    sizes_clear(&sizes);
    region_clear(&region);
    return why;
}

/* Does nothing but gravity take spheres out of a region?  Else it is no more than likely that
 * it fills up. */
static bool only_falls(const struct job *job, const struct bodies *bodies)
{
    bool still = job->n_removals == 0 && !gravity_varies(job);
    for (int b = 0; b < bodies->n && still; b++)
        still = !bodies->list[b].moves && bodies->list[b].surface == NULL;
    return still;
}

void inflow_check_room(const struct job *job, const struct bodies *bodies,
                       struct mistakes *mistakes)
{
    for (int k = 0; k < job->n_insertions; k++) {
        const struct job_insertion *insertion = &job->insertions[k];
        const bool stops = insertion->full == JOB_FULL_STOP && only_falls(job, bodies);
        char *why = stops ? lack_of_room(job, k, bodies) : NULL;
        if (why != NULL)
            mistakes_add(
                mistakes, job->path, insertion->place.line, insertion->place.column,
                "%s; a larger region, spheres that leave it faster or a lower rate are "
                "expected",
                why);
        free(why);
    }
}

void inflow_warn(const struct job *job, const struct bodies *bodies)
{
    for (int k = 0; k < job->n_insertions; k++) {
        const bool waits = job->insertions[k].full == JOB_FULL_WAIT;
        char *why = waits || !only_falls(job, bodies) ? lack_of_room(job, k, bodies) : NULL;
        if (why != NULL)
            report_warn("%s; it will %s: enlarge the region, let spheres leave it faster or "
                        "lower the rate",
                        why, waits ? "fall behind" : "stop the run");
        free(why);
    }
}
