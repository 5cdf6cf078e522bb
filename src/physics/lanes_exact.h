/*
 * Exact sums (base/exact_sum.h) whose terms come in lanes.
 *
 * The same limbs from the same rounding, held in columns that are merged into an ordinary sum
 * at the end, so that which of the two was used shows nowhere.  The integer in a part is read
 * from its bits: after adding 1.5 2^52 units the mantissa counts them.
 */
#ifndef TREMIE_PHYSICS_LANES_EXACT_H
#define TREMIE_PHYSICS_LANES_EXACT_H

#include <stdint.h>
#include <string.h>

#include "base/exact_sum.h"
#include "base/exact_vector.h"
#include "physics/lanes.h"

enum {
    LANES_EXACT_COLUMNS = 8,
    LANES_EXACT_TERMS = 1 << 18 /* a column holds at most; merge before */
};

/* Terms must be below this in magnitude. */
#define LANES_EXACT_LIMIT 0x1p59

/* A term may go to any column. */
struct lanes_exact {
    int64_t limb[3][LANES_EXACT_COLUMNS]; /* units 2^10, 2^-30, 2^-70 */
} __attribute__((aligned(64)));

/* Moves a sum, of n_terms terms a column at most, into an ordinary one.  Local. */
static inline void lanes_exact_merge(struct lanes_exact *sum, int64_t n_terms,
                                     struct exact_sum *into)
{
    struct exact_sum all = {{0, 0, 0}, n_terms * LANES_EXACT_COLUMNS, 0};
    for (int k = 0; k < 3; k++)
        for (int c = 0; c < LANES_EXACT_COLUMNS; c++)
            all.limb[k] += sum->limb[k][c];
    exact_sum_merge(into, &all);
    memset(sum, 0, sizeof *sum);
}

#if LANES_WIDTH > 1
/* What makes mantissas count units, 1.5 2^52 of each. */
static const double LANES_EXACT_OFFSET[3] = {0x1.8p52 * 0x1p10, 0x1.8p52 * 0x1p-30,
                                             0x1.8p52 * 0x1p-70};

LANES_INLINE lanes_mask lanes_exact_fits(lanes term)
{
    return (lanes)((lanes_mask)term & INT64_MAX) < lanes_all(LANES_EXACT_LIMIT);
}

/* A term in limbs; returns it as rounded. */
LANES_INLINE lanes lanes_exact_round(lanes term, lanes_mask limbs[3])
{
    lanes taken = lanes_all(0.0);

#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const lanes offset = lanes_all(LANES_EXACT_OFFSET[k]);
        const lanes counted = term + offset, part = counted - offset;
        term -= part;
        taken += part;
        limbs[k] = (lanes_mask)counted - (lanes_mask)offset;
    }
    return taken;
}

/* Four lanes, whatever the width: a vector and nothing. */
typedef double lanes_four __attribute__((vector_size(32)));
typedef int64_t lanes_four_mask __attribute__((vector_size(32)));

/* Adds a vector, below the limit, as a term. */
LANES_INLINE void lanes_exact_add_vector(struct exact_vector *sum, lanes_four term)
{
    lanes_four_mask one_more = {0, 0, 0, 1};

#pragma GCC unroll 3
    for (int k = 0; k < EXACT_VECTOR_LIMBS; k++) {
        const lanes_four offset = LANES_EXACT_OFFSET[k] - (lanes_four){0},
                         counted = term + offset;
        lanes_four_mask limb;
        term -= counted - offset;
        memcpy(&limb, sum->limb[k], sizeof limb);
        limb += ((lanes_four_mask)counted - (lanes_four_mask)offset) + one_more;
        memcpy(sum->limb[k], &limb, sizeof limb);
        one_more = (lanes_four_mask){0};
    }
}

/* Adds a term in limbs to a sum, each lane to its column. */
LANES_INLINE void lanes_exact_add(struct lanes_exact *sum, const lanes_mask limbs[3])
{
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        double *column = (double *)(void *)sum->limb[k];
        lanes_store(column, (lanes)((lanes_mask)lanes_load(column) + limbs[k]));
    }
}
#endif

#endif
