/*
 * Room: is there place for one more ball among others?
 *
 * Balls are hashed by the cell of a grid that their centres are in, so that adding one and
 * asking for room cost the same however many there are.  Local, all of it.
 */
#ifndef TREMIE_RUN_ROOM_H
#define TREMIE_RUN_ROOM_H

#include <stdbool.h>

#include "base/vec3.h"

struct room_ball {
    struct vec3 centre; /* [m] */
    double radius;      /* [m] */
    int next;           /* in the same bucket; -1: none */
};

struct room {
    double inverse_width; /* of the cells [1/m] */
    double radius_max;    /* of the balls so far [m] */
    int n, capacity, n_buckets;
    struct room_ball *balls;
    int *buckets; /* first ball of each; -1: none */
};

/* Empties it, for cells of this width, about the largest distance of centres that touch. */
void room_begin(struct room *room, double width);
void room_clear(struct room *room);
void room_add(struct room *room, struct vec3 centre, double radius);
/* Does a ball there overlap none of them? */
bool room_is_free(const struct room *room, struct vec3 centre, double radius);
/* Do two balls overlap? */
bool room_overlap(struct vec3 a, double radius_a, struct vec3 b, double radius_b);

#endif
