/*
 * The spheres of all groups at the start (model/packing), and how random ones find their
 * places: random sequential addition (THEORY.md).  A group keeps clear of the groups before it,
 * of itself and, unless told otherwise, of bodies.  The same on every rank.  Local, all of it.
 */
#ifndef TREMIE_MODEL_PACKINGS_H
#define TREMIE_MODEL_PACKINGS_H

#include <stdbool.h>
#include <stdint.h>

#include "model/packing.h"

struct bodies;
struct job;
struct mistakes;

/* Reads the spheres of an HDF5 file; what it lacks they have from `standard`.  Returns why not
 * (caller frees), NULL when all is well.  Files are another floor's. */
typedef char *packings_reader(const char *path, const struct packing_sphere *standard,
                              int64_t *n, struct packing_sphere **rows);

struct packings {
    int n;
    struct packing *groups;
};

/* Opens all groups; `before` are spheres that are there already.  Returns false, with what is
 * wrong listed, where one cannot be opened or where there is no room; then there is nothing to
 * close. */
bool packings_open(struct packings *packings, const struct job *job,
                   const struct bodies *bodies, const struct packing *before,
                   packings_reader *reader, struct mistakes *mistakes);
void packings_close(struct packings *packings);

#endif
