/* See candidates.h. */
#include "contact/candidates.h"

#include <stdlib.h>

#include "base/array.h"
#include "model/order.h"
#include "model/sphere.h"

const double candidates_level_bound[CANDIDATES_LEVELS] = {1.3,  2.6,  5.2,  10.4,
                                                          20.8, 41.6, 83.2, 1e300};

/* Give back what only a search needs. */
static void forget_found(struct candidates *candidates)
{
    free(candidates->found_low);
    free(candidates->found_high);
    candidates->found_low = candidates->found_high = NULL;
    candidates->found_capacity = 0;
}

static void forget_members(struct candidates *candidates)
{
    free(candidates->members);
    free(candidates->tags);
    candidates->members = candidates->tags = NULL;
}

static void forget_grids(struct candidates *candidates)
{
    for (int l = 0; l < CANDIDATES_LEVELS; l++)
        cell_grid_clear(&candidates->grid[l]);
}

void candidates_clear(struct candidates *candidates)
{
    free(candidates->second);
    free(candidates->place);
    free(candidates->at);
    free(candidates->row_end);
    forget_found(candidates);
    forget_members(candidates);
    forget_grids(candidates);
    *candidates = (struct candidates){0};
}

/* Canonical places: owned spheres and ghosts are each in order; merge them. */
static void number_places(struct candidates *candidates, const struct spheres *spheres)
{
    const int n_owned = spheres->n_owned, n_all = spheres->n_all;
    if (n_all > candidates->place_capacity) {
        const int capacity =
            (int)array_capacity((size_t)candidates->place_capacity, (size_t)n_all);
        free(candidates->place);
        free(candidates->at);
        free(candidates->row_end);
        candidates->place = array_allocate_rows((size_t)capacity, sizeof(int));
        candidates->at = array_allocate_rows((size_t)capacity, sizeof(int));
        candidates->row_end = array_allocate_rows((size_t)capacity, sizeof(int));
        candidates->place_capacity = capacity;
    }
    int owned = 0, ghost = n_owned;
    for (int place = 0; place < n_all; place++) {
        const bool take_owned =
            ghost >= n_all ||
            (owned < n_owned && order_before(spheres->order_cell[owned], spheres->id[owned],
                                             spheres->order_cell[ghost], spheres->id[ghost]));
        const int i = take_owned ? owned++ : ghost++;
        candidates->place[i] = place;
        candidates->at[place] = i;
    }
}

static void reserve_found(struct candidates *candidates, int needed)
{
    if (needed <= candidates->found_capacity)
        return;
    const size_t old = (size_t)candidates->found_capacity;
    const size_t capacity = array_capacity(old, (size_t)needed);
    candidates->found_low =
        array_resize_rows(candidates->found_low, old, capacity, sizeof(int));
    candidates->found_high =
        array_resize_rows(candidates->found_high, old, capacity, sizeof(int));
    candidates->found_capacity = (int)capacity;
}

/* A point that looks for partners. */
struct seeker {
    double x, y, z, reach;
    int tag;
};

/* Tags hold the canonical place and, in the lowest bit, whether the sphere is a ghost. */
static inline int tag_of(int place, bool ghost)
{
    return place * 2 + (ghost ? 1 : 0);
}

/* Appends the pairs of the seeker with the run [begin, end) of the grid; returns the new
 * number. */
static inline int scan(struct candidates *candidates, const struct cell_grid *grid,
                       const struct seeker *seeker, int begin, int end, int n)
{
    reserve_found(candidates, n + (end - begin));
    int *low = candidates->found_low, *high = candidates->found_high;
    const double x = seeker->x, y = seeker->y, z = seeker->z, reach = seeker->reach;
    const int tag = seeker->tag, place = tag >> 1;
    for (int k = begin; k < end; k++) {
        const double dx = grid->x[k] - x, dy = grid->y[k] - y, dz = grid->z[k] - z;
        const double sum = grid->reach[k] + reach;
        const int other = grid->tag[k] >> 1;
        low[n] = other < place ? other : place;
        high[n] = other < place ? place : other;
        n += (dx * dx + dy * dy + dz * dz < sum * sum) & !(grid->tag[k] & tag & 1);
    }
    return n;
}

/* Pairs within one level: each cell with itself and the half of its neighbours that follow
 * it. */
static int scan_within(struct candidates *candidates, const struct cell_grid *grid, int n)
{
    const int nx = grid->size[0], nxy = grid->size[0] * grid->size[1];
    const int offsets[4] = {nx, nxy - nx, nxy, nxy + nx};
    for (int k = 0; k < grid->n; k++) {
        const struct seeker seeker = {grid->x[k], grid->y[k], grid->z[k], grid->reach[k],
                                      grid->tag[k]};
        const int cell = grid->cell[k];
        n = scan(candidates, grid, &seeker, k + 1, grid->begin[cell + 2], n);
        for (int o = 0; o < 4; o++) {
            const int row = cell + offsets[o];
            n = scan(candidates, grid, &seeker, grid->begin[row - 1], grid->begin[row + 2], n);
        }
    }
    return n;
}

/* Pairs of the points of a higher level with those of a lower one. */
static int scan_across(struct candidates *candidates, const struct cell_grid *high,
                       const struct cell_grid *low, int n)
{
    for (int k = 0; k < high->n && low->n > 0; k++) {
        const struct seeker seeker = {high->x[k], high->y[k], high->z[k], high->reach[k],
                                      high->tag[k]};
        /* A little wider than needed, here too. */
        const double window = 1.0000001 * (seeker.reach + low->reach_max);
        const int x0 = cell_grid_along(low, 0, seeker.x - window),
                  x1 = cell_grid_along(low, 0, seeker.x + window);
        const int y0 = cell_grid_along(low, 1, seeker.y - window),
                  y1 = cell_grid_along(low, 1, seeker.y + window);
        const int z0 = cell_grid_along(low, 2, seeker.z - window),
                  z1 = cell_grid_along(low, 2, seeker.z + window);
        for (int z = z0; z <= z1; z++) {
            for (int y = y0; y <= y1; y++) {
                const int row = (z * low->size[1] + y) * low->size[0];
                n = scan(candidates, low, &seeker, low->begin[row + x0],
                         low->begin[row + x1 + 1], n);
            }
        }
    }
    return n;
}

/* Files the spheres in levels by reach. */
static void fill_levels(struct candidates *candidates, const struct spheres *spheres)
{
    double least = 1e300;
    candidates->members = array_allocate_rows((size_t)spheres->n_all, sizeof(int));
    candidates->tags = array_allocate_rows((size_t)spheres->n_all, sizeof(int));
    for (int i = 0; i < spheres->n_all; i++) {
        const double reach = sphere_reach(spheres, i);
        least = reach < least ? reach : least;
    }
    int n_filed = 0;
    double bound_before = 0.0;
    for (int l = 0; l < CANDIDATES_LEVELS; l++) {
        const double bound = least * candidates_level_bound[l];
        int n = 0;
        double reach_max = 0.0;
        for (int i = 0; i < spheres->n_all && n_filed < spheres->n_all; i++) {
            const double reach = sphere_reach(spheres, i);
            if (!(reach >= bound_before && reach < bound))
                continue;
            candidates->members[n] = i;
            candidates->tags[n++] = tag_of(candidates->place[i], i >= spheres->n_owned);
            reach_max = reach > reach_max ? reach : reach_max;
        }
        n_filed += n;
        /* A little wider than needed, so that rounding in the cell index loses nothing. */
        cell_grid_fill(&candidates->grid[l], spheres, n, candidates->members, candidates->tags,
                       n > 0 ? 2.0000001 * reach_max : 1.0);
        bound_before = bound;
    }
    forget_members(candidates);
}

static int find_by_grids(struct candidates *candidates, const struct spheres *spheres)
{
    int n = 0;
    fill_levels(candidates, spheres);
    for (int l = 0; l < CANDIDATES_LEVELS; l++) {
        n = scan_within(candidates, &candidates->grid[l], n);
        for (int lower = 0; lower < l; lower++)
            n = scan_across(candidates, &candidates->grid[l], &candidates->grid[lower], n);
    }
    forget_grids(candidates);
    return n;
}

static int find_all_pairs(struct candidates *candidates, const struct spheres *spheres)
{
    int n = 0;
    for (int a = 0; a < spheres->n_all; a++) {
        reserve_found(candidates, n + spheres->n_all);
        for (int b = a + 1; b < spheres->n_all; b++) {
            candidates->found_low[n] = a;
            candidates->found_high[n] = b;
            n += candidates->at[a] < spheres->n_owned || candidates->at[b] < spheres->n_owned;
        }
    }
    return n;
}

/* Sorts the found pairs: rows by counting, then each short row by insertion. */
static void sort_found(struct candidates *candidates, int n_found, int n_places)
{
    int *row_end = candidates->row_end;
    for (int p = 0; p < n_places; p++)
        row_end[p] = 0;
    for (int k = 0; k < n_found; k++)
        row_end[candidates->found_low[k]]++;
    for (int p = 0, sum = 0; p < n_places; p++) {
        const int count = row_end[p];
        row_end[p] = sum;
        sum += count;
    }
    for (int k = 0; k < n_found; k++)
        candidates->second[row_end[candidates->found_low[k]]++] = candidates->found_high[k];
    for (int p = 0, begin = 0; p < n_places; p++) {
        for (int k = begin; k < row_end[p]; k++) {
            const int partner = candidates->second[k];
            int slot = k;
            for (; slot > begin && candidates->second[slot - 1] > partner; slot--)
                candidates->second[slot] = candidates->second[slot - 1];
            candidates->second[slot] = partner;
        }
        begin = row_end[p];
    }
    for (int k = 0; k < n_found; k++)
        candidates->second[k] = candidates->at[candidates->second[k]];
    for (int k = 0; k < CANDIDATES_AHEAD; k++)
        candidates->second[n_found + k] = 0;
    candidates->n = n_found;
}

void candidates_search(struct candidates *candidates, const struct spheres *spheres,
                       bool all_pairs)
{
    number_places(candidates, spheres);
    free(candidates->second); /* before the search, whose greatest need of memory it adds to */
    candidates->second = NULL;
    reserve_found(candidates, candidates->n + candidates->n / 16); /* about as many as last */
    const int n_found =
        all_pairs ? find_all_pairs(candidates, spheres) : find_by_grids(candidates, spheres);
    candidates->second = array_allocate_rows((size_t)n_found + CANDIDATES_AHEAD, sizeof(int));
    sort_found(candidates, n_found, spheres->n_all);
    forget_found(candidates);
}
