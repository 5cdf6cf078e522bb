/*
 * Weighted recursive coordinate bisection (the paper's low-level decomposition), in parallel.
 *
 * All groups of ranks are halved at once, level by level: the extent of each group's points is
 * reduced, the longest side is cut where the weight below it is the group's share, found by
 * histograms of integer weights refined three times.  No point is gathered anywhere; memory
 * beside the tree is one histogram a group.  Drawback: a cut is placed to 2^-24 of the extent,
 * so points in one plane stay on one side.
 */
#ifndef TREMIE_DOMAIN_RCB_H
#define TREMIE_DOMAIN_RCB_H

#include <stdint.h>

struct boxes;
struct comm;

/* What is to be shared out, with its cost. */
struct rcb_point {
    double place[3]; /* [m] */
    int64_t weight;
};

/* Fills `boxes` (initialised for all ranks) from the n points that this rank has.
 * Collective. */
void rcb_partition(struct boxes *boxes, const struct comm *comm, int n,
                   const struct rcb_point *points);

#endif
