/*
 * What kernels of elements load and store for a block, as many elements as a vector has lanes:
 * rows of their state, places and motion of their corners.
 */
#ifndef TREMIE_PHYSICS_SOLID_ELEMENT_ROWS_H
#define TREMIE_PHYSICS_SOLID_ELEMENT_ROWS_H

#include <stddef.h>

#include "physics/lanes_rows.h"
#include "physics/solid_element.h"

#if LANES_WIDTH > 1
/* A row of the state of a block's elements. */
LANES_INLINE void solid_element_take_state(const struct solid_element_work *work,
                                           const int *elements, int row, lanes into[8])
{
    const double *at[LANES_WIDTH];
#pragma GCC unroll 8
    for (int l = 0; l < LANES_WIDTH; l++)
        at[l] = (const double *)&work->state[elements[l]] + (ptrdiff_t)8 * row;
    lanes_take_rows(at, into);
}

LANES_INLINE void solid_element_give_state(const struct solid_element_work *work,
                                           const int *elements, int row, lanes from[8])
{
    double *at[LANES_WIDTH];
#pragma GCC unroll 8
    for (int l = 0; l < LANES_WIDTH; l++)
        at[l] = (double *)&work->state[elements[l]] + (ptrdiff_t)8 * row;
    lanes_give_rows(at, from);
}

/* Places of the corners, and their motion since the last step. */
LANES_INLINE void solid_element_take_corners(const struct solid_element_work *work,
                                             const int *elements, int n_corners, lanes x[][3],
                                             lanes moved[][3])
{
    const lanes since = lanes_all(work->since);
#pragma GCC unroll 8
    for (int c = 0; c < n_corners; c++) {
        const double *at[LANES_WIDTH];
        lanes row[8];
#pragma GCC unroll 8
        for (int l = 0; l < LANES_WIDTH; l++)
            at[l] = work->nodes[work->corners[elements[l]][c]].lane;
        lanes_take_rows(at, row);
#pragma GCC unroll 3
        for (int i = 0; i < 3; i++) {
            x[c][i] = row[i];
            moved[c][i] = row[4 + i] * since;
        }
    }
}

/* Half way back.  (12.3) */
LANES_INLINE void solid_element_midway(int n_corners, lanes x[][3], lanes moved[][3],
                                       lanes middle[][3])
{
#pragma GCC unroll 8
    for (int c = 0; c < n_corners; c++)
#pragma GCC unroll 3
        for (int i = 0; i < 3; i++)
            middle[c][i] = x[c][i] - moved[c][i] * lanes_all(0.5);
}
#endif

#endif
