/*
 * Sums that do not depend on the order of their terms, so that ranks may share them out as they
 * like.
 *
 * A term is rounded once to a multiple of 2^-70 and split into three integers ("limbs") whose
 * units are 2^10, 2^-30 and 2^-70; the limbs are added as integers, which is exact and
 * associative.  A limb holds 40 bits of a term, so 2^22 terms fit before it must be normalised;
 * adding does that by itself.  Terms and totals must stay below 2^60 in magnitude (SI units:
 * 1e18 N, J, kg); larger or NaN terms set `overflow`, which the watch reports.  Draws back: a
 * term loses what lies below 2^-70 (8e-22).
 */
#ifndef TREMIE_BASE_EXACT_SUM_H
#define TREMIE_BASE_EXACT_SUM_H

#include <stdint.h>

struct comm;

struct exact_sum {
    int64_t limb[3];  /* units 2^10, 2^-30, 2^-70 */
    int64_t n_terms;  /* since the last normalisation */
    int64_t overflow; /* terms that did not fit */
};

/* Adds a term and returns it as rounded: its counterpart elsewhere is minus this value.
 * Local. */
double exact_sum_add(struct exact_sum *sum, double term);
/* Adds another sum.  Local. */
void exact_sum_merge(struct exact_sum *sum, const struct exact_sum *other);
/* Brings the limbs into their unique normal form: equal sums then have equal bytes.  Local. */
void exact_sum_normalise(struct exact_sum *sum);
/* The total rounded to a double; NaN when a term did not fit.  Local. */
double exact_sum_value(const struct exact_sum *sum);
/* Replaces each of n sums by its total over all ranks, normalised.  Collective. */
void exact_sum_reduce(const struct comm *comm, struct exact_sum *sums, int n);

#endif
