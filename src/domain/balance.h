/*
 * When to repartition (the paper's low level), and with which weights.
 *
 * Ranks measure the time that they spend on contact laws of their own spheres and on elements
 * of their own nodes; waiting does not count.  At a search the largest is compared with the
 * mean; above the job's limit the boxes are cut anew.  Clocks decide here, and may: nothing of
 * it changes a result.
 */
#ifndef TREMIE_DOMAIN_BALANCE_H
#define TREMIE_DOMAIN_BALANCE_H

#include <stdbool.h>
#include <stdint.h>

#include "job/job.h"

struct candidates;
struct comm;
struct contact_list;
struct facet_contacts;
struct rcb_point;
struct solid;
struct spheres;

struct balance {
    double busy;      /* own work since the last verdict [s] */
    double imbalance; /* largest over mean at the last verdict [-] */
};

/* Compares the ranks' work since the last verdict; true when boxes should be cut anew.  Too
 * short a time gives no verdict.  Collective. */
bool balance_is_lost(struct balance *balance, const struct comm *comm, double limit);

/* The owned spheres with their costs, in units of about a nanosecond a step: a constant, their
 * contacts (or candidates) and their facet contacts.  Local. */
void balance_spheres(struct rcb_point *points, const struct spheres *spheres,
                     enum job_weights kind, const struct contact_list *contacts,
                     const struct candidates *candidates, const struct facet_contacts *facets);
/* The nodes of a solid that are moved here, likewise: a constant, and each element's cost in
 * equal shares to its corners; returns how many.  Local. */
int balance_nodes(struct rcb_point *points, const struct solid *solid);

#endif
