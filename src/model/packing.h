/*
 * Where a group's spheres are at the start: the k-th place of a lattice, or the k-th row of a
 * file or of what random addition found (model/packings).
 */
#ifndef TREMIE_MODEL_PACKING_H
#define TREMIE_MODEL_PACKING_H

#include <stdbool.h>
#include <stdint.h>

#include "base/vec3.h"
#include "model/sizes.h"

struct job;
struct job_spheres;

struct packing_sphere {
    struct vec3 position;         /* [m] */
    struct vec3 velocity;         /* [m/s] */
    struct vec3 angular_velocity; /* [rad/s] */
    double radius;                /* [m] */
    int material;
};

struct packing {
    const struct job_spheres *group;
    int64_t n;
    uint64_t seed, sizes_stream;
    struct sizes sizes;
    struct packing_sphere *rows; /* NULL for a lattice */
};

/* Reads what a group needs; a random one and one of an HDF5 file have no spheres yet: see
 * packings_open.  Returns false with the reason in *why (caller frees):
 * "file:line:column: what; what is expected".  Local. */
bool packing_open(struct packing *packing, const struct job *job, int group, char **why);
void packing_close(struct packing *packing);
/* The k-th sphere, k from 0 to n - 1. */
struct packing_sphere packing_get(const struct packing *packing, int64_t k);
/* No sphere is or will be greater [m]. */
double packing_greatest(const struct packing *packing);

#endif
