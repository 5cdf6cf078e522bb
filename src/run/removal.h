/*
 * Removal: spheres that leave the run, through regions that take them out or out of the domain,
 * counted by number and mass.
 *
 * They leave at steps that are multiples of REMOVAL_EVERY, whoever owns them; when is part of
 * the result.  Energy that they carry away is booked by run/observe.h.
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

struct removals {
    int n;
    const struct job_removal *asked;
    struct removal {
        struct region region;
        struct tally taken; /* this rank's share, since step 0 */
    } * list;
    struct tally leavers; /* out of the domain, likewise */
};

void removals_init(struct removals *removals, const struct job *job,
                   const struct bodies *bodies);
void removals_clear(struct removals *removals);
/* Marks (1) and counts the owned spheres that are in a region at this time; returns how many
 * there are on this rank.  Local. */
int64_t removals_mark(struct removals *removals, const struct spheres *spheres, double time,
                      unsigned char *removed);

#endif
