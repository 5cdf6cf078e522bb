/* See exact_sum.h.  Rounding to a multiple of a power of two u is adding and taking away 1.5
 * 2^52 u: exact for |x| < 2^51 u with the processor's ordinary rounding. */
#include "base/exact_sum.h"

#include <math.h>
#include <string.h>

#include "base/comm.h"

enum { LIMB_BITS = 40, TERMS_MAX = 1 << 22 };

static const double LIMIT = 0x1p60;
static const double UNIT[3] = {0x1p10, 0x1p-30, 0x1p-70};
static const double PER_UNIT[3] = {0x1p-10, 0x1p30, 0x1p70};

double exact_sum_add(struct exact_sum *sum, double term)
{
    if (!(term < LIMIT && term > -LIMIT)) {
        sum->overflow++;
        return 0.0;
    }
    double rest = term, rounded = 0.0;
    for (int k = 0; k < 3; k++) {
        const double magic = 0x1.8p52 * UNIT[k];
        const double part = (rest + magic) - magic;
        rest -= part;
        rounded += part;
        sum->limb[k] += (int64_t)(part * PER_UNIT[k]);
    }
    if (++sum->n_terms >= TERMS_MAX)
        exact_sum_normalise(sum);
    return rounded;
}

void exact_sum_merge(struct exact_sum *sum, const struct exact_sum *other)
{
    for (int k = 0; k < 3; k++)
        sum->limb[k] += other->limb[k];
    sum->overflow += other->overflow;
    sum->n_terms += other->n_terms + 1;
    if (sum->n_terms >= TERMS_MAX)
        exact_sum_normalise(sum);
}

void exact_sum_normalise(struct exact_sum *sum)
{
    for (int k = 2; k > 0; k--) {
        const int64_t low = sum->limb[k] & (((int64_t)1 << LIMB_BITS) - 1);
        sum->limb[k - 1] += (sum->limb[k] - low) / ((int64_t)1 << LIMB_BITS);
        sum->limb[k] = low;
    }
    sum->n_terms = 0;
}

double exact_sum_value(const struct exact_sum *sum)
{
    if (sum->overflow > 0)
        return (double)NAN;
    struct exact_sum normal = *sum;
    exact_sum_normalise(&normal);
    /* A small negative total has limbs -1, 2^40 - 1, ..: nearly all would cancel, and with it
     * the value.  Its opposite has small limbs, all of one sign. */
    const double sign = normal.limb[0] < 0 ? -1.0 : 1.0;
    if (normal.limb[0] < 0) {
        for (int k = 0; k < 3; k++)
            normal.limb[k] = -normal.limb[k];
        exact_sum_normalise(&normal);
    }
    const double low = (double)normal.limb[1] * UNIT[1] + (double)normal.limb[2] * UNIT[2];
    return sign * ((double)normal.limb[0] * UNIT[0] + low);
}

void exact_sum_reduce(const struct comm *comm, struct exact_sum *sums, int n)
{
    enum { WORDS = sizeof(struct exact_sum) / sizeof(int64_t) };
    for (int i = 0; i < n; i++)
        exact_sum_normalise(&sums[i]);
    _Static_assert(sizeof(struct exact_sum) == WORDS * sizeof(int64_t), "no padding");
    comm_sum_int(comm, &sums[0].limb[0], n * WORDS);
    for (int i = 0; i < n; i++)
        exact_sum_normalise(&sums[i]);
}
