/*
 * A grid of cells over spheres with a reach: the ground of global search.
 *
 * Places are copied in the order of their cells, row by row, so that a row of neighbouring
 * cells is one contiguous run.  A frame of empty cells surrounds the grid: neighbours need no
 * bounds checks.
 */
#ifndef TREMIE_CONTACT_CELL_GRID_H
#define TREMIE_CONTACT_CELL_GRID_H

struct spheres;

struct cell_grid {
    int n;
    double *x, *y, *z; /* [m], in cell order */
    double *reach;     /* [m] */
    int *tag;          /* the caller's number of the point */
    int *cell;         /* cell of the point at this place */
    int *begin;        /* first place of a cell; n_cells + 1 entries */
    int n_cells;
    int size[3];      /* cells a direction, frame included */
    double low[3];    /* corner of the first cell within the frame [m] */
    double width;     /* [m] */
    double reach_max; /* [m] */
};

void cell_grid_clear(struct cell_grid *grid);
/* Files in a cleared grid n spheres, members[] by storage index, with radius and allowance as
 * reach, in cells at least `width` wide (wider where that would give many more cells than
 * spheres). */
void cell_grid_fill(struct cell_grid *grid, const struct spheres *spheres, int n,
                    const int *members, const int *tags, double width);
/* Index of the cell (within the frame) along direction k; outside the grid it is the
 * frame's. */
int cell_grid_along(const struct cell_grid *grid, int k, double x);

#endif
