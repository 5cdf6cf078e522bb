/*
 * See packings.h.  The radii of a random group are drawn first, so that their distribution is
 * the one asked for whatever finds room; then the spheres are placed, the largest first, each
 * at the first of its attempts that is free.  An attempt is three numbers of the counter
 * (sphere, attempt), so nothing depends on what other groups or ranks do.
 *
 * Attempts are wasted as space fills up: 60 000 equal spheres take half a second for 25 % by
 * volume, 72 000 two seconds for 30 %, and no number of attempts leads beyond 38 %.
 */
#include "model/packings.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/random.h"
#include "base/report.h"
#include "job/job.h"
#include "model/body.h"
#include "model/crowd.h"
#include "model/periodic.h"
#include "model/region.h"

enum { SPHERES_MOST = 50000000 };

static const double SPHERE = 4.18879020478639098461685784437267; /* 4/3 pi */

struct builder {
    const struct job *job;
    const struct bodies *bodies;
    struct crowd crowd;
    struct periodic periodic;
    double radius, gap;               /* the greatest of all [m] */
    struct region_surface **surfaces; /* of bodies; NULL where there is nothing to avoid */
};

static double volume_of(double radius)
{
    return SPHERE * radius * radius * radius;
}

/* A packing says "file:line:column: what"; the place goes where places go. */
static void file_mistake(struct mistakes *mistakes, const char *file, const char *why)
{
    int line = 0, column = 0, begin = 0;
    const char *rest = why + strlen(file);
    if (sscanf(rest, ":%d:%d: %n", &line, &column, &begin) < 2)
        begin = 2; /* "file: what" */
    mistakes_add(mistakes, file, line, column, "%s", rest + begin);
}

/* ------------------------------------------------------------------------------- radii */

/* The volume that a random group is to have [m3]; 0: it has a count. */
static double volume_asked(const struct job *job, const struct job_spheres *group,
                           const struct region *region)
{
    if (group->mass > 0.0)
        return group->mass / job->materials[group->material].density;
    return group->fraction * region->volume;
}

/* Draws radii until there are as many, or as much of them, as asked for: the last one only if
 * that comes nearer.  Returns their volume, or 0 where they would be too many. */
static double draw_radii(struct packing *packing, double asked)
{
    const struct packing_sphere standard = {.velocity = packing->group->velocity,
                                            .angular_velocity = packing->group->spin,
                                            .material = packing->group->material};
    int64_t capacity = 0;
    double volume = 0.0;
    for (int64_t k = 0; asked > 0.0 ? volume < asked : k < packing->group->count; k++) {
        const double radius =
            sizes_draw(&packing->sizes, packing->seed, packing->sizes_stream, k);
        const double more = volume_of(radius);
        if (k >= SPHERES_MOST)
            return 0.0;
        if (asked > 0.0 && k > 0 && volume + 0.5 * more > asked)
            break;
        ARRAY_GROW(packing->rows, k + 1, capacity);
        packing->rows[k] = standard;
        packing->rows[k].radius = radius;
        packing->n = k + 1;
        volume += more;
    }
    return volume;
}

/* ------------------------------------------------------------------------------- places */

struct place_order {
    double radius;
    int64_t k;
};

static int compare_orders(const void *a, const void *b)
{
    const struct place_order *p = a, *q = b;
    if (p->radius != q->radius)
        return p->radius > q->radius ? -1 : 1;
    return (p->k > q->k) - (p->k < q->k);
}

/* The order in which spheres are placed: the largest first. */
static struct place_order *order_of(const struct packing *packing)
{
    struct place_order *order = array_allocate((size_t)packing->n, sizeof *order);
    for (int64_t k = 0; k < packing->n; k++)
        order[k] = (struct place_order){packing->rows[k].radius, k};
    qsort(order, (size_t)packing->n, sizeof *order, compare_orders);
    return order;
}

static bool is_clear_of_bodies(const struct builder *builder, const struct job_spheres *group,
                               struct vec3 x, double margin)
{
    for (int b = 0; group->avoid_bodies && b < builder->bodies->n; b++)
        if (builder->surfaces[b] != NULL &&
            region_surface_is_near(builder->surfaces[b], x, margin))
            return false;
    return true;
}

/* Could a sphere here come near one that is in the domain? */
static bool is_near_domain(const struct builder *builder, struct vec3 x, double reach)
{
    const double at[3] = {x.x, x.y, x.z};
    const struct periodic *p = &builder->periodic;
    for (int c = 0; c < 3; c++)
        if (p->along[c] && !(at[c] >= p->low[c] - reach && at[c] <= p->high[c] + reach))
            return false;
    return true;
}

/* A sphere stands in the way where it is, and where it appears across periodic boundaries. */
static void enter(struct builder *builder, struct vec3 x, double radius, double gap)
{
    double shifts[PERIODIC_IMAGES][3];
    const double reach = radius + builder->radius + gap;
    const int n = periodic_shifts(&builder->periodic, shifts);
    for (int s = 0; s < n; s++) {
        const struct vec3 shift = {shifts[s][0], shifts[s][1], shifts[s][2]};
        const struct vec3 image = vec3_add(x, shift);
        if (s == 0 || is_near_domain(builder, image, reach))
            crowd_add(&builder->crowd, image, radius);
    }
}

/* Finds a place for a sphere and enters it. */
static bool place_sphere(struct builder *builder, const struct region *region,
                         const struct job_spheres *group, struct packing_sphere *sphere,
                         int64_t k)
{
    const uint64_t seed = (uint64_t)builder->job->seed;
    const uint64_t stream =
        random_stream(RANDOM_PACKING_PLACES, (int)(group - builder->job->spheres));
    for (int64_t attempt = 0; attempt < group->attempts; attempt++) {
        const uint64_t counter = (uint64_t)k * (uint64_t)group->attempts + (uint64_t)attempt;
        const struct vec3 x = region_point(region, sphere->radius, seed, stream, counter);
        /* The cheapest question first. */
        if (crowd_has_room(&builder->crowd, x, sphere->radius, group->gap) &&
            region_contains(region, x, sphere->radius) &&
            is_clear_of_bodies(builder, group, x, sphere->radius + group->gap)) {
            sphere->position = x;
            enter(builder, x, sphere->radius, group->gap);
            return true;
        }
    }
    return false;
}

/* Says how far the addition came. */
static void say_no_room(const struct builder *builder, const struct packing *packing,
                        const struct region *region, double asked, double reached,
                        int64_t n_placed, struct mistakes *mistakes)
{
    const struct job_spheres *group = packing->group;
    mistakes_add(mistakes, builder->job->path, 0, 0,
                 "spheres '%s': random addition was asked for %.3g %% of the region's volume "
                 "(%lld spheres) and reached %.3g %% (%lld) after %lld attempts for the next; "
                 "less, a lattice, or letting them settle is expected",
                 group->name, 100.0 * asked / region->volume, (long long)packing->n,
                 100.0 * reached / region->volume, (long long)n_placed,
                 (long long)group->attempts);
}

static bool place_all(struct builder *builder, struct packing *packing,
                      const struct region *region, double asked, struct mistakes *mistakes)
{
    struct place_order *order = order_of(packing);
    double reached = 0.0;
    int64_t done = 0;
    while (done < packing->n && place_sphere(builder, region, packing->group,
                                             &packing->rows[order[done].k], order[done].k)) {
        reached += volume_of(order[done].radius);
        done++;
    }
    if (done < packing->n)
        say_no_room(builder, packing, region, asked, reached, done, mistakes);
    free(order);
    return done == packing->n;
}

static bool fill(struct builder *builder, struct packing *packing, struct mistakes *mistakes)
{
    const struct job_spheres *group = packing->group;
    struct region region;
    char *why;
    if (!region_build(&region, &group->region, builder->bodies, &why)) {
        mistakes_add(mistakes, builder->job->path, 0, 0, "spheres '%s': the region: %s",
                     group->name, why);
        free(why);
        return false;
    }
    const double volume = draw_radii(packing, volume_asked(builder->job, group, &region));
    bool fine = volume > 0.0;
    if (!fine)
        mistakes_add(mistakes, builder->job->path, 0, 0,
                     "spheres '%s' would be more than %d; fewer or larger ones are expected",
                     group->name, (int)SPHERES_MOST);
    else
        fine = place_all(builder, packing, &region, volume, mistakes);
    region_clear(&region);
    return fine;
}

/* ------------------------------------------------------------------------------- groups */

static bool is_random(const struct packing *packing)
{
    return packing->group->packing == JOB_PACKING_RANDOM;
}

/* The greatest radius of a group. */
static double greatest_radius(const struct packing *packing)
{
    double most = packing->sizes.max;
    for (int64_t k = 0; packing->rows != NULL && k < packing->n; k++)
        most = packing->rows[k].radius > most ? packing->rows[k].radius : most;
    return most;
}

/* Surfaces of the bodies that some group keeps clear of. */
static void builder_init(struct builder *builder, const struct packings *packings,
                         const struct job *job, const struct bodies *bodies,
                         const struct packing *before)
{
    const size_t n = (size_t)bodies->n;
    double radius = greatest_radius(before);
    bool avoid = false;
    *builder = (struct builder){
        .job = job, .bodies = bodies, .surfaces = array_allocate(n, sizeof(void *))};
    for (int g = 0; g < packings->n; g++) {
        const double most = greatest_radius(&packings->groups[g]);
        radius = most > radius ? most : radius;
        builder->gap = job->spheres[g].gap > builder->gap ? job->spheres[g].gap : builder->gap;
        avoid = avoid || (is_random(&packings->groups[g]) && job->spheres[g].avoid_bodies);
    }
    for (int b = 0; avoid && b < bodies->n; b++)
        builder->surfaces[b] = region_surface_build(&bodies->list[b].mesh);
    builder->radius = radius;
    periodic_init(&builder->periodic, job);
    crowd_init(&builder->crowd, radius);
}

static void builder_clear(struct builder *builder)
{
    for (int b = 0; b < builder->bodies->n; b++)
        region_surface_destroy(builder->surfaces[b]);
    free(builder->surfaces);
    crowd_clear(&builder->crowd);
}

static void add_group(struct builder *builder, const struct packing *packing)
{
    for (int64_t k = 0; k < packing->n; k++) {
        const struct packing_sphere sphere = packing_get(packing, k);
        enter(builder, sphere.position, sphere.radius, builder->gap);
    }
}

/* Places the random groups, each among those before it. */
static bool place_groups(struct packings *packings, const struct job *job,
                         const struct bodies *bodies, const struct packing *before,
                         struct mistakes *mistakes)
{
    struct builder builder;
    int last = -1;
    bool fine = true;
    for (int g = 0; g < packings->n; g++)
        last = is_random(&packings->groups[g]) ? g : last;
    if (last < 0)
        return true;
    builder_init(&builder, packings, job, bodies, before);
    add_group(&builder, before);
    for (int g = 0; g <= last; g++) {
        struct packing *packing = &packings->groups[g];
        if (is_random(packing))
            fine = fill(&builder, packing, mistakes) && fine;
        else
            add_group(&builder, packing);
    }
    builder_clear(&builder);
    return fine;
}

static char *read_file(struct packing *packing, packings_reader *reader)
{
    const struct job_spheres *group = packing->group;
    const struct packing_sphere standard = {.velocity = group->velocity,
                                            .angular_velocity = group->spin,
                                            .radius = group->radius,
                                            .material = group->material};
    return reader(group->file, &standard, &packing->n, &packing->rows);
}

bool packings_open(struct packings *packings, const struct job *job,
                   const struct bodies *bodies, const struct packing *before,
                   packings_reader *reader, struct mistakes *mistakes)
{
    bool fine = true;
    *packings = (struct packings){.n = job->n_spheres};
    packings->groups = array_allocate((size_t)job->n_spheres, sizeof *packings->groups);
    for (int g = 0; g < packings->n; g++) {
        char *why;
        if (packing_open(&packings->groups[g], job, g, &why) &&
            job->spheres[g].packing == JOB_PACKING_HDF5)
            why = read_file(&packings->groups[g], reader);
        if (why != NULL)
            file_mistake(mistakes, job->spheres[g].file, why);
        fine = fine && why == NULL;
        free(why);
    }
    fine = fine && place_groups(packings, job, bodies, before, mistakes);
    if (!fine)
        packings_close(packings);
    return fine;
}

void packings_close(struct packings *packings)
{
    for (int g = 0; g < packings->n; g++)
        packing_close(&packings->groups[g]);
    free(packings->groups);
    *packings = (struct packings){0, NULL};
}
