/* See balance.h. */
#include "domain/balance.h"

#include <string.h>

#include "base/comm.h"
#include "contact/candidates.h"
#include "contact/contact_set.h"
#include "contact/facet_contact.h"
#include "domain/rcb.h"
#include "model/sphere.h"
#include "solid/solid.h"

/* Measured costs [ns a step]: moving a sphere; a listed pair, half to each; a listed facet;
 * moving a node; an element's corner. */
enum { COST_SPHERE = 8, COST_PAIR = 5, COST_FACET = 30, COST_NODE = 35, COST_CORNER = 9 };

/* Less work than this is noise [s]. */
static const double BUSY_LEAST = 0.1;

bool balance_is_lost(struct balance *balance, const struct comm *comm, double limit)
{
    enum { MICROSECONDS = 1000000 };
    if (comm->n_ranks == 1)
        return false;
    int64_t sum = (int64_t)(balance->busy * MICROSECONDS), largest = sum;
    comm_sum_int(comm, &sum, 1);
    comm_max_int(comm, &largest, 1);
    const double mean = (double)sum / comm->n_ranks;
    if (!(mean > BUSY_LEAST * MICROSECONDS))
        return false;
    balance->busy = 0.0;
    balance->imbalance = (double)largest / mean;
    return balance->imbalance > limit;
}

static void add_cost(struct rcb_point *points, const struct spheres *spheres, int i, int j)
{
    if (i < spheres->n_owned)
        points[i].weight += COST_PAIR;
    if (j < spheres->n_owned)
        points[j].weight += COST_PAIR;
}

static void add_candidates(struct rcb_point *points, const struct spheres *spheres,
                           const struct candidates *candidates)
{
    for (int place = 0, k = 0; k < candidates->n; place++)
        for (; k < candidates->row_end[place]; k++)
            add_cost(points, spheres, candidates->at[place], candidates->second[k]);
}

void balance_spheres(struct rcb_point *points, const struct spheres *spheres,
                     enum job_weights kind, const struct contact_list *contacts,
                     const struct candidates *candidates, const struct facet_contacts *facets)
{
    for (int i = 0; i < spheres->n_owned; i++) {
        memcpy(points[i].place, sphere_position(spheres, i), sizeof points[i].place);
        points[i].weight = COST_SPHERE;
    }
    if (kind == JOB_WEIGHTS_CANDIDATES)
        add_candidates(points, spheres, candidates);
    else
        for (int k = 0; k < contacts->n; k++)
            add_cost(points, spheres, contacts->first[k], contacts->second[k]);
    for (int k = 0; k < facets->n; k++)
        points[facets->list[k].sphere].weight += COST_FACET;
}

int balance_nodes(struct rcb_point *points, const struct solid *solid)
{
    int n = 0;
    for (int k = 0; k < solid->n_here; k++) {
        const int i = solid->here[k];
        if (!solid->moves[i])
            continue;
        memcpy(points[n].place, solid_place(solid, i), sizeof points[n].place);
        points[n++].weight = COST_NODE + COST_CORNER * (solid->first[i + 1] - solid->first[i]);
    }
    return n;
}
