/* See room.h. */
#include "run/room.h"

#include <stdint.h>
#include <stdlib.h>

#include "base/array.h"

enum { BUCKETS_LEAST = 256 };

static int64_t cell_along(const struct room *room, double x)
{
    /* Truncation of a positive number; what its rounding does to a cell's border is the same
     * for whoever asks, and keeps the order. */
    return (int64_t)(x * room->inverse_width + 0x1p40);
}

static int bucket_of(const struct room *room, int64_t i, int64_t j, int64_t k)
{
    const uint64_t hash = (uint64_t)i * 0x9e3779b97f4a7c15u ^
                          (uint64_t)j * 0xc2b2ae3d27d4eb4fu ^ (uint64_t)k * 0x165667b19e3779f9u;
    return (int)((hash >> 20) % (uint64_t)room->n_buckets);
}

static int bucket_at(const struct room *room, struct vec3 x)
{
    return bucket_of(room, cell_along(room, x.x), cell_along(room, x.y), cell_along(room, x.z));
}

/* Files all balls in this many buckets. */
static void rehash(struct room *room, int n_buckets)
{
    free(room->buckets);
    room->n_buckets = n_buckets;
    room->buckets = array_allocate((size_t)n_buckets, sizeof *room->buckets);
    for (int b = 0; b < n_buckets; b++)
        room->buckets[b] = -1;
    for (int i = 0; i < room->n; i++) {
        int *bucket = &room->buckets[bucket_at(room, room->balls[i].centre)];
        room->balls[i].next = *bucket;
        *bucket = i;
    }
}

void room_begin(struct room *room, double width)
{
    room->inverse_width = 1.0 / width;
    room->radius_max = 0.0;
    room->n = 0;
    rehash(room, BUCKETS_LEAST);
}

void room_clear(struct room *room)
{
    free(room->balls);
    free(room->buckets);
    *room = (struct room){0};
}

void room_add(struct room *room, struct vec3 centre, double radius)
{
    ARRAY_GROW(room->balls, room->n + 1, room->capacity);
    if (room->n >= 2 * room->n_buckets)
        rehash(room, 4 * room->n_buckets);
    int *bucket = &room->buckets[bucket_at(room, centre)];
    room->balls[room->n] = (struct room_ball){centre, radius, *bucket};
    *bucket = room->n++;
    room->radius_max = radius > room->radius_max ? radius : room->radius_max;
}

bool room_overlap(struct vec3 a, double radius_a, struct vec3 b, double radius_b)
{
    const struct vec3 between = vec3_sub(b, a);
    const double reach = radius_a + radius_b;
    return vec3_dot(between, between) < reach * reach;
}

static bool bucket_is_free(const struct room *room, int bucket, struct vec3 centre,
                           double radius)
{
    for (int i = room->buckets[bucket]; i >= 0; i = room->balls[i].next)
        if (room_overlap(room->balls[i].centre, room->balls[i].radius, centre, radius))
            return false;
    return true;
}

bool room_is_free(const struct room *room, struct vec3 centre, double radius)
{
    const double reach = radius + room->radius_max;
    const double x[3] = {centre.x, centre.y, centre.z};
    int64_t low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = cell_along(room, x[k] - reach);
        high[k] = cell_along(room, x[k] + reach);
    }
    for (int64_t i = low[0]; i <= high[0]; i++)
        for (int64_t j = low[1]; j <= high[1]; j++)
            for (int64_t k = low[2]; k <= high[2]; k++)
                if (!bucket_is_free(room, bucket_of(room, i, j, k), centre, radius))
                    return false;
    return true;
}
