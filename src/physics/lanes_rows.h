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

/* Four components of eight rows, from halves of rows 0 and 2, 1 and 3, 4 and 6, 5 and 7; it is
 * its own inverse but for the order of its two steps. */
LANES_INLINE void lanes_transpose_halves(const lanes r[4], lanes c[4])
{
    const lanes a0 = LANES_SHUFFLE(r[0], r[1], 0, 8, 2, 10, 4, 12, 6, 14),
                a1 = LANES_SHUFFLE(r[0], r[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const lanes a2 = LANES_SHUFFLE(r[2], r[3], 0, 8, 2, 10, 4, 12, 6, 14),
                a3 = LANES_SHUFFLE(r[2], r[3], 1, 9, 3, 11, 5, 13, 7, 15);
    c[0] = LANES_SHUFFLE(a0, a2, 0, 1, 4, 5, 8, 9, 12, 13);
    c[1] = LANES_SHUFFLE(a1, a3, 0, 1, 4, 5, 8, 9, 12, 13);
    c[2] = LANES_SHUFFLE(a0, a2, 2, 3, 6, 7, 10, 11, 14, 15);
    c[3] = LANES_SHUFFLE(a1, a3, 2, 3, 6, 7, 10, 11, 14, 15);
}

/* Back: halves of rows 0 and 4, 1 and 5, 2 and 6, 3 and 7. */
LANES_INLINE void lanes_transpose_back(const lanes c[4], lanes r[4])
{
    const lanes a0 = LANES_SHUFFLE(c[0], c[1], 0, 8, 2, 10, 4, 12, 6, 14),
                a1 = LANES_SHUFFLE(c[0], c[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const lanes a2 = LANES_SHUFFLE(c[2], c[3], 0, 8, 2, 10, 4, 12, 6, 14),
                a3 = LANES_SHUFFLE(c[2], c[3], 1, 9, 3, 11, 5, 13, 7, 15);
    r[0] = LANES_SHUFFLE(a0, a2, 0, 1, 8, 9, 4, 5, 12, 13);
    r[1] = LANES_SHUFFLE(a1, a3, 0, 1, 8, 9, 4, 5, 12, 13);
    r[2] = LANES_SHUFFLE(a0, a2, 2, 3, 10, 11, 6, 7, 14, 15);
    r[3] = LANES_SHUFFLE(a1, a3, 2, 3, 10, 11, 6, 7, 14, 15);
}
#endif

/* Rows of as many elements, 8 doubles from `at` of each, as 8 components; and back. */
LANES_INLINE void lanes_take_rows(const double *const at[], lanes row[8])
{
#if LANES_WIDTH == 8
#pragma GCC unroll 2
    for (int half = 0; half < 8; half += 4) {
        const lanes r[4] = {lanes_load_halves(at[0] + half, at[2] + half),
                            lanes_load_halves(at[1] + half, at[3] + half),
                            lanes_load_halves(at[4] + half, at[6] + half),
                            lanes_load_halves(at[5] + half, at[7] + half)};
        lanes_transpose_halves(r, row + half);
    }
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
#pragma GCC unroll 2
    for (int half = 0; half < 8; half += 4) {
        lanes r[4];
        lanes_transpose_back(row + half, r);
#pragma GCC unroll 4
        for (int l = 0; l < 4; l++) {
            *(lanes_half *)(at[l] + half) = LANES_SHUFFLE(r[l], r[l], 0, 1, 2, 3);
            *(lanes_half *)(at[l + 4] + half) = LANES_SHUFFLE(r[l], r[l], 4, 5, 6, 7);
        }
    }
#else
    lanes_transpose(row);
#pragma GCC unroll 8
    for (int l = 0; l < LANES_WIDTH; l++)
#pragma GCC unroll 4
        for (int p = 0; p < LANES_PARTS; p++)
            lanes_store(at[l] + LANES_WIDTH * p, row[LANES_WIDTH * p + l]);
#endif
}

/* The first three of rows of four, of which the last is read as well. */
LANES_INLINE void lanes_take_vectors(const double *const at[], lanes vector[3])
{
#if LANES_WIDTH == 2
    lanes low[2] = {lanes_load(at[0]), lanes_load(at[1])};
    lanes high[2] = {lanes_load(at[0] + 2), lanes_load(at[1] + 2)};
    lanes_transpose_square(low);
    lanes_transpose_square(high);
    vector[0] = low[0];
    vector[1] = low[1];
    vector[2] = high[0];
#elif LANES_WIDTH == 4
    lanes row[4];
#pragma GCC unroll 4
    for (int l = 0; l < 4; l++)
        row[l] = lanes_load(at[l]);
    lanes_transpose_square(row);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        vector[x] = row[x];
#else
    lanes row[4];
#pragma GCC unroll 4
    for (int l = 0; l < 4; l++)
        row[l] = lanes_load_halves(at[l], at[l + 4]);
    const lanes a0 = LANES_SHUFFLE(row[0], row[1], 0, 8, 2, 10, 4, 12, 6, 14),
                a1 = LANES_SHUFFLE(row[0], row[1], 1, 9, 3, 11, 5, 13, 7, 15);
    const lanes a2 = LANES_SHUFFLE(row[2], row[3], 0, 8, 2, 10, 4, 12, 6, 14),
                a3 = LANES_SHUFFLE(row[2], row[3], 1, 9, 3, 11, 5, 13, 7, 15);
    vector[0] = LANES_SHUFFLE(a0, a2, 0, 1, 8, 9, 4, 5, 12, 13);
    vector[1] = LANES_SHUFFLE(a1, a3, 0, 1, 8, 9, 4, 5, 12, 13);
    vector[2] = LANES_SHUFFLE(a0, a2, 2, 3, 10, 11, 6, 7, 14, 15);
#endif
}

#endif

#endif
