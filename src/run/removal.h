/*
 * Removal: spheres that leave the run, through regions that take them out or out of the domain,
 * counted by number and mass.
 *
 * A region catches a sphere in the step in which its centre comes in, were it only to pass
 * through: the way of a step is straight, and that is what is looked at.  What is caught leaves
 * at the next step that is a multiple of REMOVAL_EVERY, whoever owns it, so that the searches
 * that follow stay rare; until then it takes part in everything.  When is part of the result.
 * Energy that spheres carry away is booked by run/observe.h.
 *
 * Only spheres that can be in a region before the next search are looked at each step.
 */
#ifndef TREMIE_RUN_REMOVAL_H
#define TREMIE_RUN_REMOVAL_H

#include <stdint.h>

#include "model/region.h"
#include "run/tally.h"

struct bodies;
struct job;
struct spheres;

enum { REMOVAL_EVERY = 64 };

/* A sphere that can be in a region before the next search. */
struct removal_near {
    int sphere, removal;
};

struct removals {
    int n;
    const struct job_removal *asked;
    struct removal {
        struct region region;
        struct tally taken; /* this rank's share, since step 0 */
    } * list;
    struct tally leavers; /* out of the domain, likewise */
    int n_near, near_capacity;
    struct removal_near *near; /* by sphere, then by region */
};

void removals_init(struct removals *removals, const struct job *job,
                   const struct bodies *bodies);
void removals_clear(struct removals *removals);
/* Finds who can be in a region before the next search.  Local. */
void removals_search(struct removals *removals, const struct spheres *spheres);
/* Notes who has come into a region that is at work at this time, in the step of length dt that
 * ends there.  Local. */
void removals_catch(struct removals *removals, struct spheres *spheres, double time, double dt);
/* Marks (1) and counts the owned spheres that were caught or are in a region at this time;
 * returns how many there are on this rank.  Local. */
int64_t removals_mark(struct removals *removals, const struct spheres *spheres, double time,
                      unsigned char *removed);

#endif
