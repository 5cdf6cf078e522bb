/*
 * Four exact sums side by side: exact_sum (base/exact_sum.h) where terms come four at a time
 * and often.
 *
 * The same limbs from the same rounding, held in vectors and merged into ordinary sums at the
 * end, so that which of the two was used shows nowhere. The integer in a part is read from its
 * bits: after adding 1.5 2^52 units the mantissa counts them.
 */
#ifndef TREMIE_BASE_EXACT_FOUR_H
#define TREMIE_BASE_EXACT_FOUR_H

#include <stdint.h>

#include "base/exact_sum.h"

typedef double exact_four_reals __attribute__((vector_size(16)));
typedef int64_t exact_four_whole __attribute__((vector_size(16)));

struct exact_four {
    exact_four_whole limb[3][2]; /* units 2^10, 2^-30, 2^-70 */
    int64_t n_terms;             /* since the last merge: below 2^21 */
};

/* Terms must be below this in magnitude; the caller sends others to exact_sum_add. */
#define EXACT_FOUR_LIMIT 0x1p59

/* Moves the whole units of two terms into a limb; magic is 1.5 2^52 units. */
static inline void exact_four_take(exact_four_whole *limb, double magic, exact_four_reals *rest,
                                   exact_four_reals *taken)
{
    const exact_four_reals offset = {magic, magic};
    const exact_four_reals counted = *rest + offset, part = counted - offset;
    *rest -= part;
    *taken += part;
    *limb += (exact_four_whole)counted - (exact_four_whole)offset;
}

/* Adds four terms; `taken` gets them as rounded.  The two may be the same.  Local. */
static inline void exact_four_add(struct exact_four *sums, const double terms[4],
                                  double taken[4])
{
    /* Element by element: a vector load of what was just stored as scalars would stall. */
    exact_four_reals low = {terms[0], terms[1]}, high = {terms[2], terms[3]};
    exact_four_reals taken_low = {0.0, 0.0}, taken_high = {0.0, 0.0};
    exact_four_take(&sums->limb[0][0], 0x1.8p52 * 0x1p10, &low, &taken_low);
    exact_four_take(&sums->limb[0][1], 0x1.8p52 * 0x1p10, &high, &taken_high);
    exact_four_take(&sums->limb[1][0], 0x1.8p52 * 0x1p-30, &low, &taken_low);
    exact_four_take(&sums->limb[1][1], 0x1.8p52 * 0x1p-30, &high, &taken_high);
    exact_four_take(&sums->limb[2][0], 0x1.8p52 * 0x1p-70, &low, &taken_low);
    exact_four_take(&sums->limb[2][1], 0x1.8p52 * 0x1p-70, &high, &taken_high);
    taken[0] = taken_low[0];
    taken[1] = taken_low[1];
    taken[2] = taken_high[0];
    taken[3] = taken_high[1];
    sums->n_terms++;
}

/* Adds the k-th of the four to an ordinary sum.  Local. */
static inline void exact_four_merge(const struct exact_four *sums, int k,
                                    struct exact_sum *into)
{
    struct exact_sum sum = {{0, 0, 0}, sums->n_terms, 0};
    for (int l = 0; l < 3; l++)
        sum.limb[l] = sums->limb[l][k / 2][k % 2];
    exact_sum_merge(into, &sum);
}

#endif
