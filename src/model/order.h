/*
 * Canonical order: the order in which contributions are added, a function of the job alone.
 *
 * Every sphere carries order_cell, the cell of a grid in which it was at its birth or at the
 * last step that is a multiple of M; canonical order is ascending (order_cell, id).  Cells are
 * numbered row by row, so that the order is also good for the cache.  The grid's cell is 2.2
 * times the largest radius in the run at that step, its origin the coordinates' origin; cells
 * beyond a million from it are joined.
 */
#ifndef TREMIE_MODEL_ORDER_H
#define TREMIE_MODEL_ORDER_H

#include <stdbool.h>
#include <stdint.h>

struct comm;
struct spheres;

struct order_key {
    int64_t cell, id;
    int index; /* whose key it is: for the caller */
};

static inline bool order_before(int64_t cell_a, int64_t id_a, int64_t cell_b, int64_t id_b)
{
    return cell_a != cell_b ? cell_a < cell_b : id_a < id_b;
}

/* The cell that a place is in where the largest radius in the run is this.  Local. */
int64_t order_cell_at(const double x[3], double radius_max);

/* Gives every owned sphere the cell in which it is now.  Collective. */
void order_renew(struct spheres *spheres, const struct comm *comm);

/* Sorts n keys; `scratch` has room for n.  Natural merge sort: linear where few runs are out of
 * place, as after an ordinary migration.  Local. */
void order_sort(struct order_key *keys, int n, struct order_key *scratch);

/* Sorts n keys and brings the spheres from storage index `begin` on into their order, field by
 * field: keys[k].index is where sphere begin + k was.  Local. */
void order_arrange(struct spheres *spheres, int begin, struct order_key *keys, int n);

#endif
