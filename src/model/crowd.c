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

static bool is_free(const struct crowd *crowd, int bucket, struct vec3 x, double reach)
{
    for (int s = crowd->buckets[bucket]; s >= 0; s = crowd->spheres[s].next) {
        const struct vec3 apart = vec3_sub(crowd->spheres[s].position, x);
        const double least = crowd->spheres[s].radius + reach;
        if (vec3_dot(apart, apart) < least * least)
            return false;
    }
    return true;
}

static bool level_has_room(const struct crowd *crowd, int level, struct vec3 x, double reach)
{
    const double edge = crowd->edges[level], far = reach + 0.5 * edge;
    const struct vec3 grow = {far, far, far};
    const struct cell low = cell_of(vec3_sub(x, grow), edge);
    const struct cell high = cell_of(vec3_add(x, grow), edge);
    for (int64_t i = low.i; i <= high.i; i++)
        for (int64_t j = low.j; j <= high.j; j++)
            for (int64_t k = low.k; k <= high.k; k++)
                if (!is_free(crowd, bucket_of(crowd, level, i, j, k), x, reach))
                    return false;
    return true;
}

bool crowd_has_room(const struct crowd *crowd, struct vec3 x, double radius, double gap)
{
    for (int level = 0; level < CROWD_LEVELS; level++)
        if (crowd->used[level] && !level_has_room(crowd, level, x, radius + gap))
            return false;
    return true;
}
