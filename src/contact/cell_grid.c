/* See cell_grid.h. */
#include "contact/cell_grid.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "model/sphere.h"

void cell_grid_clear(struct cell_grid *grid)
{
    free(grid->x);
    free(grid->y);
    free(grid->z);
    free(grid->reach);
    free(grid->tag);
    free(grid->cell);
    free(grid->begin);
    *grid = (struct cell_grid){0};
}

static void allocate(struct cell_grid *grid, int n)
{
    grid->n = n;
    grid->x = array_allocate_rows((size_t)n, sizeof(double));
    grid->y = array_allocate_rows((size_t)n, sizeof(double));
    grid->z = array_allocate_rows((size_t)n, sizeof(double));
    grid->reach = array_allocate_rows((size_t)n, sizeof(double));
    grid->tag = array_allocate_rows((size_t)n, sizeof(int));
    grid->cell = array_allocate_rows((size_t)n, sizeof(int));
}

/* Chooses cells for the extent [low, high]: a few stray points far away must not make
 * millions. */
static void choose_cells(struct cell_grid *grid, const double low[3], const double high[3],
                         double width)
{
    const double cells_max = 8.0 * grid->n + 64.0;
    double count[3];
    for (;; width *= 1.5) {
        double product = 1.0;
        for (int k = 0; k < 3; k++) {
            count[k] = (high[k] - low[k]) / width;
            product *= count[k] + 3.0;
        }
        if (!(product > cells_max))
            break;
    }
    grid->width = width;
    grid->n_cells = 1;
    for (int k = 0; k < 3; k++) {
        grid->low[k] = low[k];
        grid->size[k] = (int)count[k] + 3;
        grid->n_cells *= grid->size[k];
    }
    grid->begin = array_allocate_rows((size_t)grid->n_cells + 2, sizeof(int));
}

int cell_grid_along(const struct cell_grid *grid, int k, double x)
{
    const double cell = (x - grid->low[k]) / grid->width + 1.0;
    if (!(cell > 0.0))
        return 0;
    return cell < (double)grid->size[k] - 1.0 ? (int)cell : grid->size[k] - 1;
}

void cell_grid_fill(struct cell_grid *grid, const struct spheres *spheres, int n,
                    const int *members, const int *tags, double width)
{
    allocate(grid, n);
    double low[3] = {0.0, 0.0, 0.0}, high[3] = {0.0, 0.0, 0.0};
    grid->reach_max = 0.0;
    for (int p = 0; p < n; p++) {
        const double *x = sphere_position(spheres, members[p]);
        const double reach = sphere_reach(spheres, members[p]);
        for (int k = 0; k < 3; k++) {
            low[k] = p > 0 && low[k] < x[k] ? low[k] : x[k];
            high[k] = p > 0 && high[k] > x[k] ? high[k] : x[k];
        }
        grid->reach_max = reach > grid->reach_max ? reach : grid->reach_max;
    }
    choose_cells(grid, low, high, width);
    int *begin = grid->begin;
    int *cells = array_allocate_rows((size_t)n, sizeof *cells); /* in the caller's order */
    for (int p = 0; p < n; p++) {
        const double *x = sphere_position(spheres, members[p]);
        const int cx = cell_grid_along(grid, 0, x[0]), cy = cell_grid_along(grid, 1, x[1]);
        const int cz = cell_grid_along(grid, 2, x[2]);
        cells[p] = (cz * grid->size[1] + cy) * grid->size[0] + cx;
        begin[cells[p]]++;
    }
    for (int c = 0, sum = 0; c <= grid->n_cells; c++) {
        const int count = c < grid->n_cells ? begin[c] : 0;
        begin[c] = sum;
        sum += count;
    }
    for (int p = 0; p < n; p++) {
        const int place = begin[cells[p]]++;
        const double *x = sphere_position(spheres, members[p]);
        grid->x[place] = x[0];
        grid->y[place] = x[1];
        grid->z[place] = x[2];
        grid->reach[place] = sphere_reach(spheres, members[p]);
        grid->tag[place] = tags[p];
        grid->cell[place] = cells[p];
    }
    free(cells);
    memmove(begin + 1, begin, (size_t)grid->n_cells * sizeof *begin);
    begin[0] = 0;
}
