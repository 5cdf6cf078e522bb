/*
 * See crowd.h.  Spheres stand in a hierarchy of grids: each in the finest whose cells are as
 * wide as it is, so that a cell holds few of them, whatever their sizes.  Cells are found by
 * hashing.  A query looks at 27 cells of each level as wide as the sphere or wider, and at more
 * of finer ones: build a scene with the large spheres first.
 */
#include "model/crowd.h"

#include <stdint.h>
#include <stdlib.h>

#include "base/array.h"
#include "model/periodic.h"

enum { BUCKETS_AT_FIRST = 1024 };

static void empty_buckets(struct crowd *crowd, int n)
{
    free(crowd->buckets);
    crowd->n_buckets = n;
    crowd->buckets = array_allocate((size_t)n, sizeof *crowd->buckets);
    for (int b = 0; b < n; b++)
        crowd->buckets[b] = -1;
}

void crowd_init(struct crowd *crowd, double radius)
{
    *crowd = (struct crowd){.n = 0};
    for (int level = 0; level < CROWD_LEVELS; level++, radius *= 0.5)
        crowd->edges[level] = 2.0 * radius;
    empty_buckets(crowd, BUCKETS_AT_FIRST);
}

void crowd_clear(struct crowd *crowd)
{
    free(crowd->spheres);
    free(crowd->buckets);
    *crowd = (struct crowd){.n = 0};
}

struct cell {
    int64_t i, j, k;
};

static int64_t cell_along(double x, double edge)
{
    const double k = x / edge;
    const int64_t whole = (int64_t)k;
    return (double)whole > k ? whole - 1 : whole;
}

static struct cell cell_of(struct vec3 x, double edge)
{
    return (struct cell){cell_along(x.x, edge), cell_along(x.y, edge), cell_along(x.z, edge)};
}

static int bucket_of(const struct crowd *crowd, int level, int64_t i, int64_t j, int64_t k)
{
    uint64_t h = (uint64_t)i * UINT64_C(0x9e3779b97f4a7c15) ^
                 (uint64_t)j * UINT64_C(0xc2b2ae3d27d4eb4f) ^
                 (uint64_t)k * UINT64_C(0x165667b19e3779f9) ^ (uint64_t)level;
    h ^= h >> 29;
    h *= UINT64_C(0xbf58476d1ce4e5b9);
    return (int)(h >> 32 & (uint64_t)(crowd->n_buckets - 1));
}

static void enter(struct crowd *crowd, int s)
{
    struct crowd_sphere *sphere = &crowd->spheres[s];
    const struct cell c = cell_of(sphere->position, crowd->edges[sphere->level]);
    int *bucket = &crowd->buckets[bucket_of(crowd, sphere->level, c.i, c.j, c.k)];
    sphere->next = *bucket;
    *bucket = s;
}

void crowd_add(struct crowd *crowd, struct vec3 x, double radius)
{
    int level = 0;
    while (level + 1 < CROWD_LEVELS && crowd->edges[level + 1] >= 2.0 * radius)
        level++;
    ARRAY_GROW(crowd->spheres, crowd->n + 1, crowd->capacity);
    crowd->spheres[crowd->n++] =
        (struct crowd_sphere){.position = x, .radius = radius, .level = level};
    crowd->used[level] = true;
    if (crowd->n <= crowd->n_buckets / 2) {
        enter(crowd, crowd->n - 1);
        return;
    }
    empty_buckets(crowd, 4 * crowd->n_buckets);
    for (int s = 0; s < crowd->n; s++)
        enter(crowd, s);
}

static bool is_near_domain(const struct periodic *p, struct vec3 x, double reach)
{
    const double at[3] = {x.x, x.y, x.z};
    for (int c = 0; c < 3; c++)
        if (p->along[c] && !(at[c] >= p->low[c] - reach && at[c] <= p->high[c] + reach))
            return false;
    return true;
}

void crowd_add_repeated(struct crowd *crowd, const struct periodic *periodic, struct vec3 x,
                        double radius, double reach)
{
    double shifts[PERIODIC_IMAGES][3];
    const int n = periodic_shifts(periodic, shifts);
    for (int s = 0; s < n; s++) {
        const struct vec3 shift = {shifts[s][0], shifts[s][1], shifts[s][2]};
        const struct vec3 image = vec3_add(x, shift);
        if (s == 0 || is_near_domain(periodic, image, reach))
            crowd_add(crowd, image, radius);
    }
}

static double square(double x)
{
    return x * x;
}

static double farther(double offset, double half)
{
    return offset < 0.0 ? half - offset : half + offset;
}

/* It reaches to the farthest corner. */
bool crowd_covers(const struct crowd *crowd, int s, struct vec3 centre, struct vec3 half,
                  double reach)
{
    const struct vec3 apart = vec3_sub(crowd->spheres[s].position, centre);
    const double least = crowd->spheres[s].radius + reach;
    return square(farther(apart.x, half.x)) + square(farther(apart.y, half.y)) +
               square(farther(apart.z, half.z)) <
           least * least;
}

static int bucket_covering(const struct crowd *crowd, int bucket, struct vec3 centre,
                           struct vec3 half, double reach)
{
    int s = crowd->buckets[bucket];
    while (s >= 0 && !crowd_covers(crowd, s, centre, half, reach))
        s = crowd->spheres[s].next;
    return s;
}

/* The cells of a level in which spheres stand that reach x. */
struct cells {
    struct cell low, high;
};

static struct cells cells_near(const struct crowd *crowd, int level, struct vec3 x,
                               double reach)
{
    const double edge = crowd->edges[level], far = reach + 0.5 * edge;
    const struct vec3 grow = {far, far, far};
    return (struct cells){cell_of(vec3_sub(x, grow), edge), cell_of(vec3_add(x, grow), edge)};
}

static int level_covering(const struct crowd *crowd, int level, struct vec3 centre,
                          struct vec3 half, double reach)
{
    const struct cells near = cells_near(crowd, level, centre, reach);
    int s = -1;
    for (int64_t i = near.low.i; i <= near.high.i && s < 0; i++)
        for (int64_t j = near.low.j; j <= near.high.j && s < 0; j++)
            for (int64_t k = near.low.k; k <= near.high.k && s < 0; k++)
                s = bucket_covering(crowd, bucket_of(crowd, level, i, j, k), centre, half,
                                    reach);
    return s;
}

int crowd_covering(const struct crowd *crowd, struct vec3 centre, struct vec3 half,
                   double reach)
{
    int s = -1;
    for (int level = 0; level < CROWD_LEVELS && s < 0; level++)
        if (crowd->used[level])
            s = level_covering(crowd, level, centre, half, reach);
    return s;
}

bool crowd_has_room(const struct crowd *crowd, struct vec3 x, double radius, double gap)
{
    return crowd_covering(crowd, x, (struct vec3){0.0, 0.0, 0.0}, radius + gap) < 0;
}

double crowd_overlap(const struct crowd *crowd, int a, int b)
{
    const struct crowd_sphere *p = &crowd->spheres[a], *q = &crowd->spheres[b];
    const double apart = vec3_norm(vec3_sub(p->position, q->position));
    return 0.5 * (p->radius + q->radius - apart) * (1.0 / p->radius + 1.0 / q->radius);
}

/* The first entered that overlaps s in a bucket, before `found` if there is one. */
static int bucket_overlapping(const struct crowd *crowd, int bucket, int s, double share,
                              int found)
{
    const int level = crowd->spheres[s].level;
    for (int t = crowd->buckets[bucket]; t >= 0; t = crowd->spheres[t].next)
        if ((crowd->spheres[t].level < level || t < s) && (found < 0 || t < found) &&
            crowd_overlap(crowd, s, t) > share)
            found = t;
    return found;
}

int crowd_overlapping(const struct crowd *crowd, int s, double share)
{
    const struct crowd_sphere *sphere = &crowd->spheres[s];
    int found = -1;
    for (int level = 0; level <= sphere->level; level++) {
        if (!crowd->used[level])
            continue;
        const struct cells near = cells_near(crowd, level, sphere->position, sphere->radius);
        for (int64_t i = near.low.i; i <= near.high.i; i++)
            for (int64_t j = near.low.j; j <= near.high.j; j++)
                for (int64_t k = near.low.k; k <= near.high.k; k++)
                    found = bucket_overlapping(crowd, bucket_of(crowd, level, i, j, k), s,
                                               share, found);
    }
    return found;
}
