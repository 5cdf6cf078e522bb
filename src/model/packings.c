/*
 * See packings.h.  The radii of a random group are drawn first, so that their distribution is
 * the one asked for whatever finds room; then the spheres are placed, the largest first, each
 * at the first of its attempts that is free.  An attempt is a few numbers of the counter
 * (sphere, attempt), so nothing depends on what other groups or ranks do.
 *
 * A sphere's first attempts go to all of the region.  Where they fail, space is cut into cells
 * and the rest go to those that are not known to be taken for a sphere of this size
 * (model/vacancy), cut finer whenever about as many attempts have failed as there are cells: a
 * free place is as likely as any other to be found, and soon.  What is known holds for spheres
 * as large or larger, so cells serve a range of sizes and are made anew for the next.  When no
 * cell is left there is no room, which is thereby proved.
 */
#include "model/packings.h"

#include <stdio.h>
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
#include "model/vacancy.h"

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

/* A group while it is placed. */
struct filling {
    struct builder *builder;
    struct packing *packing;
    struct region region;
    bool *solid;            /* bodies whose inside is not for it */
    double radius;          /* that `vacancy` holds for, and for all greater ones [m] */
    struct vacancy vacancy; /* without cells: not begun, or used up */
    bool scarce;            /* it is in use */
    int64_t n_failed;       /* attempts since its cells were cut */
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

static double draw_radius(const struct packing *packing, int64_t k)
{
    return sizes_draw(&packing->sizes, packing->seed, packing->sizes_stream, k);
}

/* How many radii are as many, or as much of them, as asked for: the last one only if that comes
 * nearer.  *volume is theirs.  At most SPHERES_MOST + 1. */
static int64_t count_radii(const struct packing *packing, double asked, double *volume)
{
    const int64_t count = asked > 0.0 ? SPHERES_MOST + 1 : packing->group->count;
    int64_t k = 0;
    *volume = 0.0;
    if (count > SPHERES_MOST && asked <= 0.0)
        return count;
    for (; k < count && (asked <= 0.0 || *volume < asked); k++) {
        const double more = volume_of(draw_radius(packing, k));
        if (asked > 0.0 && k > 0 && *volume + 0.5 * more > asked)
            break;
        *volume += more;
    }
    return k;
}

/* Draws the radii.  Returns their volume, or 0 where they would be too many. */
static double draw_radii(struct packing *packing, double asked)
{
    const struct packing_sphere standard = {.velocity = packing->group->velocity,
                                            .angular_velocity = packing->group->spin,
                                            .material = packing->group->material};
    double volume;
    const int64_t n = count_radii(packing, asked, &volume);
    if (n > SPHERES_MOST)
        return 0.0;
    packing->rows = array_allocate((size_t)n, sizeof *packing->rows);
    packing->n = n;
    for (int64_t k = 0; k < n; k++) {
        packing->rows[k] = standard;
        packing->rows[k].radius = draw_radius(packing, k);
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

/* A sphere stands in the way where it is, and where it appears across periodic boundaries. */
static void enter(struct builder *builder, struct vec3 x, double radius, double gap)
{
    crowd_add_repeated(&builder->crowd, &builder->periodic, x, radius,
                       radius + builder->radius + gap);
}

/* Is no place left in a box for a centre, because of the surfaces or the insides of bodies? */
static bool bodies_take(const struct filling *filling, struct vec3 x, double far, double reach)
{
    const struct builder *builder = filling->builder;
    for (int b = 0; b < builder->bodies->n; b++) {
        const struct region_surface *surface = builder->surfaces[b];
        if (!filling->packing->group->avoid_bodies || surface == NULL)
            continue;
        if (reach > far && region_surface_is_near(surface, x, reach - far))
            return true;
        if (filling->solid[b] && region_surface_holds(surface, x) &&
            (far == 0.0 || !region_surface_is_near(surface, x, far)))
            return true;
    }
    return false;
}

/* Is all of a box taken for centres of spheres of the radius that the cells hold for?  Of the
 * box only its centre and the distance to its corners are looked at where shapes are in the
 * way; a hair less than all is asked, for rounding. */
static bool is_taken(const void *context, struct vec3 centre, struct vec3 half)
{
    static const double HAIR = 1e-9;
    const struct filling *filling = context;
    const double gap = filling->packing->group->gap;
    const double far = vec3_norm(half) * (1.0 + HAIR), radius = filling->radius * (1.0 - HAIR);
    const struct vec3 place = periodic_settled(&filling->builder->periodic, centre);
    return crowd_covering(&filling->builder->crowd, place, half, radius + gap) >= 0 ||
           (far < radius && !region_contains(&filling->region, centre, radius - far)) ||
           bodies_take(filling, place, far, radius + gap);
}

/* Is there room for a sphere?  Then it is entered; else *blocker is who is in the way, of the
 * crowd, or -1.  The cheapest question comes first. */
static bool try_place(struct filling *filling, struct packing_sphere *sphere, struct vec3 x,
                      int *blocker)
{
    static const struct vec3 POINT = {0.0, 0.0, 0.0};
    struct builder *builder = filling->builder;
    const double gap = filling->packing->group->gap, radius = sphere->radius;
    const struct vec3 place = periodic_settled(&builder->periodic, x);
    *blocker = crowd_covering(&builder->crowd, place, POINT, radius + gap);
    if (*blocker >= 0 || !region_contains(&filling->region, x, radius) ||
        bodies_take(filling, place, 0.0, radius + gap))
        return false;
    sphere->position = place;
    enter(builder, place, radius, gap);
    return true;
}

/* ------------------------------------------------------------------------------- scarcity */

/* Attempts at all of the region; so many in cells before these are cut in any case. */
enum { ATTEMPTS_ANYWHERE = 200, ATTEMPTS_UNCUT = 1000 };

/* Spheres down to this share of a radius use the same cells. */
static const double RANGE = 0.9;

/* Cells for this sphere and those after it in the order that are not much smaller. */
static void begin_scarcity(struct filling *filling, const struct place_order *order, int64_t o)
{
    const struct region *region = &filling->region;
    const int64_t n = filling->packing->n;
    const double least = RANGE * order[o].radius;
    int64_t last = o;
    for (int64_t low = o, high = n; low < high;) {
        const int64_t middle = low + (high - low) / 2;
        if (order[middle].radius >= least) {
            last = middle;
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    vacancy_close(&filling->vacancy);
    filling->scarce = true;
    filling->radius = order[last].radius;
    filling->n_failed = 0;
    vacancy_open(&filling->vacancy, region->low, region->high, filling->radius);
}

/* Drops a cell in which an attempt failed if it is known to be taken, by who was in the way
 * there if somebody was; false where no cell is left. */
static bool learn(struct filling *filling, int64_t cell, int blocker, int64_t attempt)
{
    const struct builder *builder = filling->builder;
    struct vacancy *vacancy = &filling->vacancy;
    struct vec3 half;
    const struct vec3 centre = vacancy_box(vacancy, cell, &half);
    const double reach = filling->radius + filling->packing->group->gap;
    const bool taken =
        blocker < 0 ? is_taken(filling, centre, half)
                    : crowd_covers(&builder->crowd, blocker,
                                   periodic_settled(&builder->periodic, centre), half, reach);
    if (taken)
        vacancy_drop(vacancy, cell);
    else
        filling->n_failed++;
    if (filling->n_failed > vacancy->n || (attempt + 1) % ATTEMPTS_UNCUT == 0) {
        vacancy_cut(vacancy, is_taken, filling);
        filling->n_failed = 0;
    }
    return vacancy->n > 0;
}

static bool place_among_cells(struct filling *filling, struct packing_sphere *sphere, int64_t k)
{
    const struct builder *builder = filling->builder;
    const uint64_t seed = (uint64_t)builder->job->seed;
    const uint64_t stream = random_stream(
        RANDOM_PACKING_VACANCIES, (int)(filling->packing->group - builder->job->spheres));
    const int64_t attempts = filling->packing->group->attempts;
    struct vacancy *vacancy = &filling->vacancy;
    for (int64_t attempt = 0; attempt < attempts && vacancy->n > 0; attempt++) {
        const uint64_t counter = 4 * ((uint64_t)k * (uint64_t)attempts + (uint64_t)attempt);
        double part[4];
        int blocker;
        for (int c = 0; c < 4; c++)
            part[c] = random_unit(seed, stream, counter + (uint64_t)c);
        const int64_t drawn = (int64_t)(part[3] * (double)vacancy->n);
        const int64_t cell = drawn < vacancy->n ? drawn : vacancy->n - 1;
        if (try_place(filling, sphere, vacancy_point(vacancy, cell, part), &blocker))
            return true;
        if (!learn(filling, cell, blocker, attempt))
            return false;
    }
    return false;
}

static bool place_anywhere(struct filling *filling, struct packing_sphere *sphere, int64_t k)
{
    const struct job_spheres *group = filling->packing->group;
    const struct job *job = filling->builder->job;
    const uint64_t stream = random_stream(RANDOM_PACKING_PLACES, (int)(group - job->spheres));
    for (int64_t attempt = 0; attempt < group->attempts && attempt < ATTEMPTS_ANYWHERE;
         attempt++) {
        const uint64_t counter = (uint64_t)k * (uint64_t)group->attempts + (uint64_t)attempt;
        int blocker;
        if (try_place(filling, sphere,
                      region_point(&filling->region, sphere->radius, (uint64_t)job->seed,
                                   stream, counter),
                      &blocker))
            return true;
    }
    return false;
}

/* Finds a place for the sphere that comes next in the order and enters it. */
static bool place_sphere(struct filling *filling, const struct place_order *order, int64_t o)
{
    const int64_t k = order[o].k;
    struct packing_sphere *sphere = &filling->packing->rows[k];
    if (filling->scarce && sphere->radius >= filling->radius)
        return place_among_cells(filling, sphere, k);
    if (place_anywhere(filling, sphere, k))
        return true;
    begin_scarcity(filling, order, o);
    return place_among_cells(filling, sphere, k);
}

/* ------------------------------------------------------------------------------- filling */

/* Says how far the addition came. */
static void say_no_room(const struct filling *filling, double asked, double reached,
                        int64_t n_placed, struct mistakes *mistakes)
{
    const struct packing *packing = filling->packing;
    const struct job_spheres *group = packing->group;
    char tried[64] = "no room is left for the next";
    if (filling->vacancy.n > 0)
        snprintf(tried, sizeof tried, "%lld attempts found none for the next",
                 (long long)group->attempts);
    mistakes_add(mistakes, filling->builder->job->path, group->place.line, group->place.column,
                 "spheres '%s': random addition was asked for %.3g %% of the region's volume "
                 "(%lld spheres) and reached %.3g %% (%lld): %s; less, a lattice, or letting "
                 "them settle is expected",
                 group->name, 100.0 * asked / filling->region.volume, (long long)packing->n,
                 100.0 * reached / filling->region.volume, (long long)n_placed, tried);
}

static bool place_all(struct filling *filling, double asked, struct mistakes *mistakes)
{
    const struct packing *packing = filling->packing;
    struct place_order *order = order_of(packing);
    double reached = 0.0;
    int64_t done = 0;
    while (done < packing->n && place_sphere(filling, order, done))
        reached += volume_of(order[done++].radius);
    if (done < packing->n)
        say_no_room(filling, asked, reached, done, mistakes);
    free(order);
    return done == packing->n;
}

/* Builds the region of a group and what is solid to it; false, the mistake listed, where there
 * is none. */
static bool filling_begin(struct filling *filling, struct builder *builder,
                          struct packing *packing, struct mistakes *mistakes)
{
    const struct job_spheres *group = packing->group;
    const struct bodies *bodies = builder->bodies;
    char *why;
    *filling = (struct filling){.builder = builder, .packing = packing};
    if (!region_build(&filling->region, &group->region, bodies, &why)) {
        mistakes_add(mistakes, builder->job->path, group->place.line, group->place.column,
                     "spheres '%s': the region: %s", group->name, why);
        free(why);
        return false;
    }
    region_repeat(&filling->region, &builder->periodic);
    filling->solid = array_allocate((size_t)bodies->n, sizeof *filling->solid);
    for (int b = 0; group->avoid_bodies && b < bodies->n; b++)
        filling->solid[b] = region_meets_solid(&filling->region, &bodies->list[b]);
    return true;
}

static bool fill(struct builder *builder, struct packing *packing, struct mistakes *mistakes)
{
    const struct job_spheres *group = packing->group;
    struct filling filling;
    if (!filling_begin(&filling, builder, packing, mistakes))
        return false;
    const double volume =
        draw_radii(packing, volume_asked(builder->job, group, &filling.region));
    bool fine = volume > 0.0;
    if (!fine)
        mistakes_add(mistakes, builder->job->path, group->place.line, group->place.column,
                     "spheres '%s' would be more than %d; fewer or larger ones are expected",
                     group->name, (int)SPHERES_MOST);
    else
        fine = place_all(&filling, volume, mistakes);
    vacancy_close(&filling.vacancy);
    region_clear(&filling.region);
    free(filling.solid);
    return fine;
}

/* ------------------------------------------------------------------------------- groups */

static bool is_random(const struct packing *packing)
{
    return packing->group->packing == JOB_PACKING_RANDOM;
}

/* Surfaces of the bodies that some group keeps clear of: of those that are there. */
static void builder_init(struct builder *builder, const struct packings *packings,
                         const struct job *job, const struct bodies *bodies,
                         const struct packing *before)
{
    const size_t n = (size_t)bodies->n;
    double radius = packing_greatest(before);
    bool avoid = false;
    *builder = (struct builder){
        .job = job, .bodies = bodies, .surfaces = array_allocate(n, sizeof(void *))};
    for (int g = 0; g < packings->n; g++) {
        const double most = packing_greatest(&packings->groups[g]);
        radius = most > radius ? most : radius;
        builder->gap = job->spheres[g].gap > builder->gap ? job->spheres[g].gap : builder->gap;
        avoid = avoid || (is_random(&packings->groups[g]) && job->spheres[g].avoid_bodies);
    }
    for (int b = 0; avoid && b < bodies->n; b++) {
        const struct body *body = &bodies->list[b];
        if (!body->comes_and_goes || body->active[0] <= 0.0)
            builder->surfaces[b] = region_surface_build(&body->mesh, body->mesh.reference);
    }
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
        enter(builder, periodic_settled(&builder->periodic, sphere.position), sphere.radius,
              builder->gap);
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
