/*
 * Which rank owned what a checkpoint holds.
 *
 * A checkpoint does not say: it is the same on any number of ranks.  The run's series do: with
 * each save go the boxes of all ranks.  A sphere is given to the rank in whose box it lies; the
 * run may have left it to the neighbour until its next redistribution, when it has gone past
 * the cut by less than its allowance.
 */
#ifndef TREMIE_POSTPROC_OWNERS_H
#define TREMIE_POSTPROC_OWNERS_H

#include <stdint.h>

struct series;
struct spheres;

/* Gives owner[i] of the n_owned spheres, for a checkpoint of this step; `path` is the file or
 * the folder of its run.  Returns a REPORT_ status, the reason said. */
int owners_find(int *owner, const struct spheres *spheres, const char *path, int64_t step);

/* The same from the rows of a run's table "subdomains": the newest that are not above the step.
 * Returns the step of these rows; -1 when there are none, -2 when they leave a sphere out. */
int64_t owners_of_rows(int *owner, const struct spheres *spheres, const struct series *series,
                       int64_t step);

#endif
