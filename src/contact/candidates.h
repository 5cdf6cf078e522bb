/*
 * Global search: the pairs of spheres that may touch before the next search.
 *
 * A pair is a candidate when its distance is below the sum of both radii and both allowances;
 * at least one of the two is owned.  Spheres are filed in levels by reach (radius + allowance),
 * each level in a grid whose cells fit its largest reach: spheres of a level meet each other in
 * their own grid, and a sphere of a higher level looks into all lower grids with its own reach.
 * So neither a few fast spheres nor a few large ones widen the cells of all the rest.  Pairs
 * come out sorted by canonical order over owned spheres and ghosts together, the first before
 * the second.
 * Drawback: a continuous size distribution pays for looking into several grids.
 */
#ifndef TREMIE_CONTACT_CANDIDATES_H
#define TREMIE_CONTACT_CANDIDATES_H

#include <stdbool.h>

#include "contact/cell_grid.h"

struct spheres;

enum {
    CANDIDATES_LEVELS = 8,
    CANDIDATES_AHEAD = 32, /* valid indices behind the last candidate, to be fetched ahead */
};

/* Upper bound of each level's reach, in least reaches; the last takes the rest. */
extern const double candidates_level_bound[CANDIDATES_LEVELS];

struct candidates {
    int n;
    int *second;  /* storage indices, row by row, sorted by their places */
    int *place;   /* place in canonical order of a storage index */
    int *at;      /* storage index at a place */
    int *row_end; /* end in the lists of the row of a place */
    int place_capacity;
    /* During a search: */
    int found_capacity;
    int *found_low, *found_high; /* places, unsorted */
    int *members;                /* storage indices of a level's spheres */
    int *tags;                   /* theirs, in the grid */
    struct cell_grid grid[CANDIDATES_LEVELS];
};

void candidates_clear(struct candidates *candidates);
/* Searches among all spheres here with their present allowances.  all_pairs: every pair is a
 * candidate, for comparison.  Local. */
void candidates_search(struct candidates *candidates, const struct spheres *spheres,
                       bool all_pairs);

#endif
