/*
 * Rows of eight doubles seen as lanes: as many rows as a vector has lanes are loaded whole and
 * transposed, so that each of the eight components lies in one vector, and back.
 */
#ifndef TREMIE_PHYSICS_LANES_ROWS_H
#define TREMIE_PHYSICS_LANES_ROWS_H

#include "physics/lanes.h"

#if LANES_WIDTH > 1
enum { LANES_PARTS = 8 / LANES_WIDTH /* vectors in a row */ };

#define LANES_SHUFFLE(a, b, ...) __builtin_shufflevector(a, b, __VA_ARGS__)

/* LANES_WIDTH rows or columns of a square, in place. */
LANES_INLINE void lanes_transpose_square(lanes *r)
{
#if LANES_WIDTH == 2
    const lanes a = LANES_SHUFFLE(r[0], r[1], 0, 2), b = LANES_SHUFFLE(r[0], r[1], 1, 3);
    r[0] = a;
    r[1] = b;
#elif LANES_WIDTH == 4
    const lanes a0 = LANES_SHUFFLE(r[0], r[1], 0, 4, 2, 6),
                a1 = LANES_SHUFFLE(r[0], r[1], 1, 5, 3, 7);
    const lanes a2 = LANES_SHUFFLE(r[2], r[3], 0, 4, 2, 6),
                a3 = LANES_SHUFFLE(r[2], r[3], 1, 5, 3, 7);
    r[0] = LANES_SHUFFLE(a0, a2, 0, 1, 4, 5);
    r[1] = LANES_SHUFFLE(a1, a3, 0, 1, 4, 5);
    r[2] = LANES_SHUFFLE(a0, a2, 2, 3, 6, 7);
    r[3] = LANES_SHUFFLE(a1, a3, 2, 3, 6, 7);
#else
    lanes a[8], b[8];
#pragma GCC unroll 8
    for (int k = 0; k < 8; k += 2) { /* squares of 1 x 1 change places */
        a[k] = LANES_SHUFFLE(r[k], r[k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        a[k + 1] = LANES_SHUFFLE(r[k], r[k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
#pragma GCC unroll 8
    for (int k = 0; k < 8; k++) /* of 2 x 2 */
        b[k] = k & 2 ? LANES_SHUFFLE(a[k - 2], a[k], 2, 3, 10, 11, 6, 7, 14, 15)
                     : LANES_SHUFFLE(a[k], a[k + 2], 0, 1, 8, 9, 4, 5, 12, 13);
#pragma GCC unroll 8
    for (int k = 0; k < 8; k++) /* of 4 x 4 */
        r[k] = k & 4 ? LANES_SHUFFLE(b[k - 4], b[k], 4, 5, 6, 7, 12, 13, 14, 15)
                     : LANES_SHUFFLE(b[k], b[k + 4], 0, 1, 2, 3, 8, 9, 10, 11);
#endif
}

/* From LANES_WIDTH rows, part p of row l at r[LANES_WIDTH p + l], to 8 components, component
 * c at r[c]; and back. */
LANES_INLINE void lanes_transpose(lanes r[8])
{
#pragma GCC unroll 4
    for (int part = 0; part < LANES_PARTS; part++)
        lanes_transpose_square(r + LANES_WIDTH * part);
}

/* Rows of as many elements, 8 doubles from `at` of each, as 8 components; and back. */
LANES_INLINE void lanes_take_rows(const double *const at[], lanes row[8])
{
#pragma GCC unroll 8
    for (int l = 0; l < LANES_WIDTH; l++)
#pragma GCC unroll 4
        for (int p = 0; p < LANES_PARTS; p++)
            row[LANES_WIDTH * p + l] = lanes_load(at[l] + LANES_WIDTH * p);
    lanes_transpose(row);
}

LANES_INLINE void lanes_give_rows(double *const at[], lanes row[8])
{
    lanes_transpose(row);
#pragma GCC unroll 8
    for (int l = 0; l < LANES_WIDTH; l++)
#pragma GCC unroll 4
        for (int p = 0; p < LANES_PARTS; p++)
            lanes_store(at[l] + LANES_WIDTH * p, row[LANES_WIDTH * p + l]);
}

#endif

#endif
