/* Counter-based random numbers: published answers, and statistics with critical values. */
#include "base/random.h"

#include <math.h>
#include <stdlib.h>

#include "check.h"

enum { MANY = 100000 };

/* Philox 4x32-10 as its authors give it (Random123, kat_vectors): the first two words. */
TEST(known_answers)
{
    EXPECT(random_bits(0, 0, 0) == UINT64_C(0xe169c58d6627e8d5));
    EXPECT(random_bits(UINT64_MAX, UINT64_MAX, UINT64_MAX) == UINT64_C(0x41c83b0e408f276d));
    EXPECT(random_bits(UINT64_C(0x299f31d0a4093822), UINT64_C(0x0370734413198a2e),
                       UINT64_C(0x85a308d3243f6a88)) == UINT64_C(0x94fdccebd16cfe09));
}

TEST(units_are_the_upper_bits)
{
    EXPECT(random_unit(0, 0, 0) == (double)(UINT64_C(0xe169c58d6627e8d5) >> 11) * 0x1p-53);
    for (uint64_t k = 0; k < MANY; k++) {
        const double u = random_unit(7, 3, k);
        EXPECT(u >= 0.0 && u < 1.0);
    }
}

TEST(streams_of_purposes_and_items_differ)
{
    EXPECT(random_stream(RANDOM_PACKING_SIZES, 1) != random_stream(RANDOM_PACKING_SIZES, 2));
    EXPECT(random_stream(RANDOM_PACKING_SIZES, 1) != random_stream(RANDOM_PACKING_PLACES, 1));
}

/* Chi-square of 100 equal classes with 99 degrees of freedom exceeds 148.23 once in 1000 draws,
 * and once falls below 61.1: too even. */
TEST(units_are_even)
{
    double square = 0.0;
    int counts[100] = {0};
    for (uint64_t k = 0; k < MANY; k++)
        counts[(int)(100.0 * random_unit(11, 5, k))]++;
    for (int c = 0; c < 100; c++)
        square += (counts[c] - MANY / 100.0) * (counts[c] - MANY / 100.0) / (MANY / 100.0);
    EXPECT(square > 61.1 && square < 148.23);
}

/* Successive numbers, streams and seeds are uncorrelated: the mean of n products of deviates
 * scatters by 1/sqrt(n) of their variance. */
TEST(neighbours_are_independent)
{
    double sums[3] = {0.0};
    for (uint64_t k = 0; k < MANY; k++) {
        const double u = random_unit(11, 5, k) - 0.5;
        sums[0] += u * (random_unit(11, 5, k + 1) - 0.5);
        sums[1] += u * (random_unit(11, 6, k) - 0.5);
        sums[2] += u * (random_unit(12, 5, k) - 0.5);
    }
    for (int i = 0; i < 3; i++)
        EXPECT(fabs(sums[i] * 12.0 / sqrt((double)MANY)) < 3.3);
}

static int compare(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

/* Kolmogorov and Smirnov: sqrt(n) times the largest distance exceeds 1.95 once in 1000. */
TEST(normals_are_normal)
{
    static double x[MANY];
    double worst = 0.0;
    for (uint64_t k = 0; k < MANY; k++)
        x[k] = random_normal(3, 1, k);
    qsort(x, MANY, sizeof *x, compare);
    for (int i = 0; i < MANY; i++) {
        const double f = 0.5 * erfc(-x[i] / sqrt(2.0));
        worst = fmax(worst, fmax(f - (double)i / MANY, (i + 1.0) / MANY - f));
    }
    EXPECT(worst * sqrt((double)MANY) < 1.95);
    EXPECT(x[0] > -8.7 && x[MANY - 1] < 8.7);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
