/*
 * Three exact sums side by side, limb by limb, so that a kernel adds a vector in three
 * additions.  For sums that are cleared before they have 2^22 terms: they are not normalised.
 */
#ifndef TREMIE_BASE_EXACT_VECTOR_H
#define TREMIE_BASE_EXACT_VECTOR_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/exact_sum.h"

enum { EXACT_VECTOR_LIMBS = 3, EXACT_VECTOR_COUNT = 3 };

struct exact_vector {
    /* Of x, y, z; of each row the last counts: terms; those that did not fit; nothing. */
    int64_t limb[EXACT_VECTOR_LIMBS][4];
} __attribute__((aligned(32)));

/* Adds a term to component x and returns it as rounded.  Local. */
static inline double exact_vector_add(struct exact_vector *vector, int x, double term)
{
    struct exact_sum one = {{0, 0, 0}, 0, 0};
    const double rounded = exact_sum_add(&one, term);
    for (int k = 0; k < EXACT_VECTOR_LIMBS; k++)
        vector->limb[k][x] += one.limb[k];
    vector->limb[0][EXACT_VECTOR_COUNT] += one.n_terms;
    vector->limb[1][EXACT_VECTOR_COUNT] += one.overflow;
    return rounded;
}

/* Adds another one.  Local. */
static inline void exact_vector_merge(struct exact_vector *vector,
                                      const struct exact_vector *other)
{
    for (int k = 0; k < EXACT_VECTOR_LIMBS; k++)
        for (int x = 0; x < 4; x++)
            vector->limb[k][x] += other->limb[k][x];
}

/* The three totals rounded; NaN when a term did not fit.  Limbs do not depend on the order of
 * terms. */
static inline void exact_vector_value(const struct exact_vector *vector, double value[3])
{
    const bool fits = vector->limb[1][EXACT_VECTOR_COUNT] == 0;
    for (int x = 0; x < 3; x++) {
        const double low =
            (double)vector->limb[1][x] * 0x1p-30 + (double)vector->limb[2][x] * 0x1p-70;
        value[x] = fits ? (double)vector->limb[0][x] * 0x1p10 + low : (double)NAN;
    }
}

#endif
