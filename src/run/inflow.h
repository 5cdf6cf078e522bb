/*
 * What can be known of insertions and regions before a run: where they are, how much will come
 * in, what its sizes allow of the time step.
 */
#ifndef TREMIE_RUN_INFLOW_H
#define TREMIE_RUN_INFLOW_H

#include "base/vec3.h"

struct bodies;
struct job;
struct limits;
struct materials;
struct mistakes;

/* An insertion that lacks no room, up to the end of the run. */
struct inflow {
    double n, mass;                   /* in all [-], [kg] */
    double n_mean;                    /* there in the mean over the run, if none leaves [-] */
    double rate;                      /* [1/s] */
    double mean_mass;                 /* of a sphere [kg] */
    double radius_least, radius_most; /* [m] */
    double speed;                     /* no sphere comes in faster [m/s] */
};

struct inflow inflow_of(const struct job *job, int number);
/* What the least and the greatest spheres of each material allow that an insertion brings. */
void inflow_add_limits(struct limits *limits, const struct job *job,
                       const struct materials *materials, int number);

/* Lists what is wrong with the regions of the job; grows the box from *low to *high by those of
 * insertions. */
void inflow_check(const struct job *job, const struct bodies *bodies, struct vec3 *low,
                  struct vec3 *high, struct mistakes *mistakes);

/* Lists insertions that are to stop the run when full and whose region cannot hold what comes
 * in while it stays there, or at one occasion.  The step is known. */
void inflow_check_room(const struct job *job, const struct bodies *bodies,
                       struct mistakes *mistakes);
/* Warns of those that would fall behind for the same reason, and of those of which it is no
 * more than likely because bodies move, regions take spheres out or gravity changes. */
void inflow_warn(const struct job *job, const struct bodies *bodies);

#endif
