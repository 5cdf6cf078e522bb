/* Exact sums: the same bits whatever the order and the grouping of the terms.
 *
 * ranks: 1 3
 */
#include "base/exact_sum.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/comm.h"
#include "check.h"

enum { N_TERMS = 2000 };

static uint64_t state = 0x9e3779b97f4a7c15u;

/* Any 64 bits will do here, as long as they are the same on every rank. */
static uint64_t next_bits(void)
{
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    return state;
}

/* Terms of either sign whose magnitudes run from far below the least bit kept to 2^50. */
static void fill(double *terms, int n)
{
    state = 0x9e3779b97f4a7c15u;
    for (int i = 0; i < n; i++) {
        const double mantissa = 1.0 + (double)(next_bits() >> 12) * 0x1p-52;
        const int exponent = (int)(next_bits() % 141) - 90;
        terms[i] = ldexp(next_bits() & 1 ? mantissa : -mantissa, exponent);
    }
}

static struct exact_sum sum_of(const double *terms, int n)
{
    struct exact_sum sum = {0};
    for (int i = 0; i < n; i++)
        (void)exact_sum_add(&sum, terms[i]);
    exact_sum_normalise(&sum);
    return sum;
}

static bool equal(const struct exact_sum *a, const struct exact_sum *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

TEST(does_not_depend_on_the_order_of_terms)
{
    double terms[N_TERMS];
    fill(terms, N_TERMS);
    const struct exact_sum sum = sum_of(terms, N_TERMS);
    for (int trial = 0; trial < 20; trial++) {
        for (int i = N_TERMS - 1; i > 0; i--) {
            const int j = (int)(next_bits() % (uint64_t)(i + 1));
            const double swap = terms[i];
            terms[i] = terms[j];
            terms[j] = swap;
        }
        const struct exact_sum shuffled = sum_of(terms, N_TERMS);
        EXPECT(equal(&sum, &shuffled));
    }
}

TEST(merges_are_associative)
{
    double terms[N_TERMS];
    fill(terms, N_TERMS);
    const struct exact_sum whole = sum_of(terms, N_TERMS);
    for (int cut = 1; cut < N_TERMS - 1; cut += 97) {
        const int rest = N_TERMS - cut, half = rest / 2;
        struct exact_sum a = sum_of(terms, cut), a_too = a, b = sum_of(terms + cut, half);
        const struct exact_sum c = sum_of(terms + cut + half, rest - half);
        exact_sum_merge(&a, &b); /* (a + b) + c */
        exact_sum_merge(&a, &c);
        exact_sum_normalise(&a);
        exact_sum_merge(&b, &c); /* a + (b + c) */
        exact_sum_merge(&a_too, &b);
        exact_sum_normalise(&a_too);
        EXPECT(equal(&a, &whole));
        EXPECT(equal(&a_too, &whole));
    }
}

TEST(a_term_is_rounded_once_to_the_least_bit)
{
    double terms[N_TERMS];
    fill(terms, N_TERMS);
    for (int i = 0; i < N_TERMS; i++) {
        struct exact_sum sum = {0};
        const double rounded = exact_sum_add(&sum, terms[i]);
        const double units = rounded * 0x1p70;
        EXPECT(units == rint(units));
        EXPECT(fabs(rounded - terms[i]) <= 0x1p-71);
        EXPECT(exact_sum_value(&sum) == rounded);
    }
}

TEST(what_is_representable_is_kept_whole)
{
    const double terms[] = {0.0, 1.0,        -1.0,     0x1p-70, -0x1p-70,
                            0.1, -12345.678, 0x1.8p59, 0x1p-20, 0x1p10};
    for (size_t i = 0; i < sizeof terms / sizeof terms[0]; i++) {
        struct exact_sum sum = {0};
        const double rounded = exact_sum_add(&sum, terms[i]);
        EXPECT(rounded == terms[i]);
        EXPECT(exact_sum_value(&sum) == terms[i]);
    }
}

TEST(opposite_terms_leave_nothing)
{
    double terms[N_TERMS];
    const struct exact_sum zero = {0};
    fill(terms, N_TERMS / 2);
    for (int i = 0; i < N_TERMS / 2; i++)
        terms[N_TERMS - 1 - i] = -terms[i];
    const struct exact_sum sum = sum_of(terms, N_TERMS);
    EXPECT(equal(&sum, &zero));
    EXPECT(exact_sum_value(&sum) == 0.0);
}

TEST(small_terms_survive_large_ones)
{
    struct exact_sum sum = {0};
    (void)exact_sum_add(&sum, 0x1p58);
    (void)exact_sum_add(&sum, 0x1p-70);
    (void)exact_sum_add(&sum, -0x1p58);
    EXPECT(exact_sum_value(&sum) == 0x1p-70);
}

TEST(negative_totals_are_accurate)
{
    struct exact_sum sum = {0};
    for (int i = 0; i < 1000; i++)
        (void)exact_sum_add(&sum, -0.1);
    EXPECT_NEAR(exact_sum_value(&sum), -100.0, 1e-13);
    /* What is left is 1000 times what the double .1 has too much. */
    (void)exact_sum_add(&sum, 100.0);
    EXPECT_NEAR(exact_sum_value(&sum), -1000.0 * 5.551115123125783e-18, 1e-29);
}

TEST(the_value_is_within_a_unit_of_the_true_total)
{
    double terms[N_TERMS];
    fill(terms, N_TERMS);
    struct exact_sum sum = {0};
    for (int i = 0; i < N_TERMS; i++) {
        __extension__ typedef __int128 wide;
        static wide total; /* of multiples of 2^-70, exact */
        if (i == 0)
            total = 0;
        total += (wide)(exact_sum_add(&sum, terms[i]) * 0x1p70);
        const double expected = (double)total * 0x1p-70;
        const double magnitude = expected < 0.0 ? -expected : expected;
        EXPECT_NEAR(exact_sum_value(&sum), expected, magnitude * 0x1p-52);
    }
}

TEST(many_terms_do_not_overflow_a_limb)
{
    enum { MANY = 5 * 1000 * 1000 }; /* more than fit before carries must be taken */
    struct exact_sum sum = {0};
    const double term = 0x1.fffffffffp49;
    for (int i = 0; i < MANY; i++)
        (void)exact_sum_add(&sum, term);
    EXPECT(sum.overflow == 0);
    EXPECT(exact_sum_value(&sum) == (double)MANY * term);
}

TEST(terms_that_do_not_fit_show)
{
    const double terms[] = {0x1p60,           -0x1p60,           1e300,
                            (double)INFINITY, (double)-INFINITY, (double)NAN};
    for (size_t i = 0; i < sizeof terms / sizeof terms[0]; i++) {
        struct exact_sum sum = {0}, total = {0};
        (void)exact_sum_add(&sum, 1.0);
        EXPECT(exact_sum_add(&sum, terms[i]) == 0.0);
        EXPECT(sum.overflow == 1);
        EXPECT(isnan(exact_sum_value(&sum)));
        (void)exact_sum_add(&total, 2.0);
        exact_sum_merge(&total, &sum);
        EXPECT(isnan(exact_sum_value(&total)));
    }
}

TEST(ranks_share_the_terms_as_they_like)
{
    const struct comm comm = comm_world();
    double terms[N_TERMS];
    fill(terms, N_TERMS);
    const struct exact_sum whole = sum_of(terms, N_TERMS);
    for (int deal = 1; deal <= 3; deal++) {
        struct exact_sum sums[2] = {{.n_terms = 0}, {.n_terms = 0}};
        for (int i = 0; i < N_TERMS; i++)
            if ((i / deal) % comm.n_ranks == comm.rank)
                (void)exact_sum_add(&sums[i % 2], terms[i]);
        exact_sum_reduce(&comm, sums, 2);
        exact_sum_merge(&sums[0], &sums[1]);
        exact_sum_normalise(&sums[0]);
        EXPECT(equal(&sums[0], &whole));
    }
}

TEST(one_rank_that_overflows_shows_on_all)
{
    const struct comm comm = comm_world();
    struct exact_sum sum = {0};
    (void)exact_sum_add(&sum, comm.rank == comm.n_ranks - 1 ? 0x1p61 : 1.0);
    exact_sum_reduce(&comm, &sum, 1);
    EXPECT(sum.overflow == 1);
    EXPECT(isnan(exact_sum_value(&sum)));
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const int status = check_run(argc, argv);
    MPI_Finalize();
    return status;
}
