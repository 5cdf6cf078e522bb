/*
 * Spheres that stand in the way of others: is there room for one more?  For scenes that are
 * built sphere by sphere.  Local, all of it.
 */
#ifndef TREMIE_MODEL_CROWD_H
#define TREMIE_MODEL_CROWD_H

#include <stdbool.h>

#include "base/vec3.h"

struct periodic;

enum { CROWD_LEVELS = 16 };

struct crowd_sphere {
    struct vec3 position; /* [m] */
    double radius;        /* [m] */
    int next;             /* in the same bucket; -1: none */
    int level;
};

struct crowd {
    double edges[CROWD_LEVELS]; /* of a level's cells [m] */
    bool used[CROWD_LEVELS];
    int n, capacity;
    struct crowd_sphere *spheres;
    int n_buckets; /* a power of 2 */
    int *buckets;  /* the last sphere entered; -1: none */
};

/* `radius` is the greatest there will be [m]. */
void crowd_init(struct crowd *crowd, double radius);
void crowd_clear(struct crowd *crowd);
void crowd_add(struct crowd *crowd, struct vec3 x, double radius);
/* The same, and then those of its images over periodic boundaries that are nearer than `reach`
 * to the domain. */
void crowd_add_repeated(struct crowd *crowd, const struct periodic *periodic, struct vec3 x,
                        double radius, double reach);
/* Is every sphere's surface at least `gap` [m] from that of a sphere here? */
bool crowd_has_room(const struct crowd *crowd, struct vec3 x, double radius, double gap);
/* A sphere whose surface is nearer than `reach` [m] to all of this box, which may be a point;
 * -1: none. */
int crowd_covering(const struct crowd *crowd, struct vec3 centre, struct vec3 half,
                   double reach);
/* Is sphere s one? */
bool crowd_covers(const struct crowd *crowd, int s, struct vec3 centre, struct vec3 half,
                  double reach);
/* The overlap of two spheres here over their radii, as it is watched: the mean of both shares;
 * negative where they are apart. */
double crowd_overlap(const struct crowd *crowd, int a, int b);
/* The first that overlaps sphere s by more than this, of those on coarser grids and of those on
 * the same grid that were entered before; -1: none.  So of a pair one finds the other. */
int crowd_overlapping(const struct crowd *crowd, int s, double share);

#endif
