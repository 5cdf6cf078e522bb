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

#if LANES_WIDTH == 8
typedef double lanes_half __attribute__((vector_size(32), aligned(8), may_alias));

/* Halves of two rows side by side: memory puts them there, so that rows lie transposed after
 * two shuffles instead of three. */
LANES_INLINE lanes lanes_load_halves(const double *low, const double *high)
{
    return LANES_SHUFFLE(*(const lanes_half *)low, *(const lanes_half *)high, 0, 1, 2, 3, 4, 5,
                         6, 7);
}

/* Pairs of rows become pairs of components, in neighbours. */
LANES_INLINE void lanes_pair(const lanes r[4], lanes pair[4])
{
#pragma GCC unroll 2
    for (int k = 0; k < 4; k += 2) {
        pair[k] = LANES_SHUFFLE(r[k], r[k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
        pair[k + 1] = LANES_SHUFFLE(r[k], r[k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
    }
}

/* Four doubles from `at` of each of eight rows, as four components; and back. */
LANES_INLINE void lanes_take_halves(const double *const at[], int from, lanes c[4])
{
    const lanes r[4] = {lanes_load_halves(at[0] + from, at[2] + from),
                        lanes_load_halves(at[1] + from, at[3] + from),
                        lanes_load_halves(at[4] + from, at[6] + from),
                        lanes_load_halves(at[5] + from, at[7] + from)};
    lanes pair[4];
    lanes_pair(r, pair);
#pragma GCC unroll 2
    for (int k = 0; k < 2; k++) {
        c[k] = LANES_SHUFFLE(pair[k], pair[2 + k], 0, 1, 4, 5, 8, 9, 12, 13);
        c[2 + k] = LANES_SHUFFLE(pair[k], pair[2 + k], 2, 3, 6, 7, 10, 11, 14, 15);
    }
}

LANES_INLINE void lanes_give_halves(double *const at[], int from, const lanes c[4])
{
    lanes pair[4], r[4]; /* halves of rows 0 and 4, 1 and 5, 2 and 6, 3 and 7 */
    lanes_pair(c, pair);
#pragma GCC unroll 2
    for (int k = 0; k < 2; k++) {
        r[k] = LANES_SHUFFLE(pair[k], pair[2 + k], 0, 1, 8, 9, 4, 5, 12, 13);
        r[2 + k] = LANES_SHUFFLE(pair[k], pair[2 + k], 2, 3, 10, 11, 6, 7, 14, 15);
    }
#pragma GCC unroll 4
    for (int l = 0; l < 4; l++) {
        *(lanes_half *)(at[l] + from) = LANES_SHUFFLE(r[l], r[l], 0, 1, 2, 3);
        *(lanes_half *)(at[l + 4] + from) = LANES_SHUFFLE(r[l], r[l], 4, 5, 6, 7);
    }
}
#endif

/* Rows of as many elements, 8 doubles from `at` of each, as 8 components; and back. */
LANES_INLINE void lanes_take_rows(const double *const at[], lanes row[8])
{
#if LANES_WIDTH == 8
    lanes_take_halves(at, 0, row);
    lanes_take_halves(at, 4, row + 4);
#else
#pragma GCC unroll 8
    for (int l = 0; l < LANES_WIDTH; l++)
#pragma GCC unroll 4
        for (int p = 0; p < LANES_PARTS; p++)
            row[LANES_WIDTH * p + l] = lanes_load(at[l] + LANES_WIDTH * p);
    lanes_transpose(row);
#endif
}

LANES_INLINE void lanes_give_rows(double *const at[], lanes row[8])
{
#if LANES_WIDTH == 8
    lanes_give_halves(at, 0, row);
    lanes_give_halves(at, 4, row + 4);
#else
    lanes_transpose(row);
#pragma GCC unroll 8
    for (int l = 0; l < LANES_WIDTH; l++)
#pragma GCC unroll 4
        for (int p = 0; p < LANES_PARTS; p++)
            lanes_store(at[l] + LANES_WIDTH * p, row[LANES_WIDTH * p + l]);
#endif
}

/* The same of rows of four. */
LANES_INLINE void lanes_take_fours(const double *const at[], lanes four[4])
{
#if LANES_WIDTH == 8
    lanes_take_halves(at, 0, four);
#else
#pragma GCC unroll 2
    for (int from = 0; from < 4; from += LANES_WIDTH) {
#pragma GCC unroll 4
        for (int l = 0; l < LANES_WIDTH; l++)
            four[from + l] = lanes_load(at[l] + from);
        lanes_transpose_square(four + from);
    }
#endif
}

#endif

#endif
