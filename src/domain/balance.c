/* See balance.h. */
#include "domain/balance.h"

#include "base/comm.h"
#include "contact/candidates.h"
#include "contact/contact_set.h"
#include "contact/facet_contact.h"
#include "model/sphere.h"

/* Measured costs [ns a step]: moving a sphere; a listed pair, half to each; a listed facet. */
enum { COST_SPHERE = 8, COST_PAIR = 5, COST_FACET = 30 };

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

void balance_weights(int64_t *weights, const struct spheres *spheres, enum job_weights kind,
                     const struct contact_list *contacts, const struct candidates *candidates,
                     const struct facet_contacts *facets)
{
    const bool by_candidates = kind == JOB_WEIGHTS_CANDIDATES;
    const int n = by_candidates ? candidates->n : contacts->n;
    const int *first = by_candidates ? candidates->first : contacts->first;
    const int *second = by_candidates ? candidates->second : contacts->second;
    for (int i = 0; i < spheres->n_owned; i++)
        weights[i] = COST_SPHERE;
    for (int k = 0; k < n; k++) {
        if (first[k] < spheres->n_owned)
            weights[first[k]] += COST_PAIR;
        if (second[k] < spheres->n_owned)
            weights[second[k]] += COST_PAIR;
    }
    for (int k = 0; k < facets->n; k++)
        weights[facets->list[k].sphere] += COST_FACET;
}
