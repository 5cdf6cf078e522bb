/*
 * Contents: what is in a region at an instant: number, mass and mean velocity of the spheres
 * whose centre is there, in all and, where asked, of each material.  A region may move with a
 * rigid body.
 *
 * Nothing of it is state: each sample counts anew, in exact sums, so that rows do not depend on
 * who owned what.  The mean velocity is that of the mass, momentum over mass; not a number
 * where there is nothing.
 */
#ifndef TREMIE_RUN_CONTENTS_H
#define TREMIE_RUN_CONTENTS_H

#include "base/exact_sum.h"
#include "model/body.h"
#include "model/region.h"
#include "run/tally.h"

struct comm;
struct job;
struct series;
struct spheres;

struct contents {
    int n;
    struct content {
        struct region region;
        int follows;             /* body that it moves with; -1: none */
        struct body_frame frame; /* of that body, at the sample */
        struct tally tally;
        struct exact_sum *momentum[3]; /* one a part of the tally [kg m/s] */
    } * list;
};

void contents_init(struct contents *contents, const struct job *job,
                   const struct bodies *bodies);
void contents_clear(struct contents *contents);
void contents_add_columns(const struct contents *contents, const struct job *job,
                          struct series *table);

/* A sample: begin with the bodies at its time, add every owned sphere with its velocity, then
 * take the values into row[n..], which returns the new n. */
void contents_begin(struct contents *contents, const struct bodies *bodies, double time);
/* Local. */
void contents_add(struct contents *contents, const struct spheres *spheres, int i,
                  const double velocity[3]);
/* Collective. */
int contents_values(const struct contents *contents, const struct comm *comm, double *row,
                    int n);

#endif
