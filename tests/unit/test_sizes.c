/*
 * Radii drawn from every kind of distribution, by number and by mass.
 *
 * Draws are compared with formulas of their own (Kolmogorov and Smirnov: the largest distance
 * between the distributions times sqrt(n) exceeds 1.95 once in 1000 times), at fixed seeds. By
 * mass each draw counts with its cube; the spread of such a weighted distribution grows by the
 * square root of mean(w^2)/mean(w)^2.
 */
#include "model/sizes.h"

#include <math.h>
#include <stdlib.h>

#include "check.h"
#include "job/job.h"

enum { MANY = 50000 };

static const double CRITICAL = 1.95;

static double drawn[MANY];

static int compare(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

static double weight(double radius, bool by_mass)
{
    return by_mass ? radius * radius * radius : 1.0;
}

/* The critical distance's multiple that the draws are off from a cumulative distribution. */
static double distance(const struct job_sizes *asked, double (*below)(double))
{
    const bool by_mass = asked->by == JOB_SIZES_BY_MASS;
    struct sizes sizes;
    double total = 0.0, squares = 0.0, sum = 0.0, worst = 0.0, volume = 0.0;
    sizes_build(&sizes, asked, 0.0);
    for (int k = 0; k < MANY; k++) {
        drawn[k] = sizes_draw(&sizes, 17, 4, k);
        EXPECT(drawn[k] >= sizes.min && drawn[k] <= sizes.max);
        total += weight(drawn[k], by_mass);
        squares += weight(drawn[k], by_mass) * weight(drawn[k], by_mass);
        volume += 4.0 / 3.0 * acos(-1.0) * weight(drawn[k], true) / MANY;
    }
    EXPECT_NEAR(volume, sizes.mean_volume, 0.03 * sizes.mean_volume);
    qsort(drawn, MANY, sizeof *drawn, compare);
    for (int k = 0; k < MANY; k++) {
        const double f = below(drawn[k]);
        worst = fmax(worst, fabs(f - sum));
        sum += weight(drawn[k], by_mass) / total;
        worst = fmax(worst, fabs(sum - f));
    }
    sizes_clear(&sizes);
    return worst * total / sqrt(squares) / CRITICAL;
}

static double phi(double z)
{
    return 0.5 * erfc(-z / sqrt(2.0));
}

/* ------------------------------------------------------------------------------- densities */

static double below_uniform(double r)
{
    return (r - 0.001) / 0.003;
}

TEST(uniform_by_number_and_by_mass)
{
    struct job_sizes asked = {
        .given = true, .kind = JOB_SIZES_UNIFORM, .min = 0.001, .max = 0.004};
    EXPECT(distance(&asked, below_uniform) < 1.0);
    asked.by = JOB_SIZES_BY_MASS;
    EXPECT(distance(&asked, below_uniform) < 1.0);
}

static double below_normal(double r)
{
    const double low = phi((0.5 - 1.0) / 0.3), high = phi((1.2 - 1.0) / 0.3);
    return (phi((r - 1.0) / 0.3) - low) / (high - low);
}

TEST(normal_cut_off_on_both_sides)
{
    struct job_sizes asked = {.given = true,
                              .kind = JOB_SIZES_NORMAL,
                              .min = 0.5,
                              .max = 1.2,
                              .mean = 1.0,
                              .deviation = 0.3};
    EXPECT(distance(&asked, below_normal) < 1.0);
    asked.by = JOB_SIZES_BY_MASS;
    EXPECT(distance(&asked, below_normal) < 1.0);
}

static double below_tail(double r)
{
    return (phi(-30.0 * (1.15 - 1.0)) - phi(-30.0 * (r - 1.0))) /
           (phi(-30.0 * (1.15 - 1.0)) - phi(-30.0 * (1.18 - 1.0)));
}

TEST(only_the_tail_of_a_normal_one)
{
    const struct job_sizes asked = {.given = true,
                                    .kind = JOB_SIZES_NORMAL,
                                    .min = 1.15,
                                    .max = 1.18,
                                    .mean = 1.0,
                                    .deviation = 1.0 / 30.0};
    EXPECT(distance(&asked, below_tail) < 1.0);
}

static double below_lognormal(double r)
{
    const double variance = log(1.0 + 0.25), mean = log(2e-3) - 0.5 * variance;
    const double s = sqrt(variance);
    const double low = phi((log(5e-4) - mean) / s), high = phi((log(1e-2) - mean) / s);
    return (phi((log(r) - mean) / s) - low) / (high - low);
}

/* Twenty to one; by mass the greatest spheres weigh 8000 times the least. */
TEST(lognormal_by_number_and_by_mass)
{
    struct job_sizes asked = {.given = true,
                              .kind = JOB_SIZES_LOGNORMAL,
                              .min = 5e-4,
                              .max = 1e-2,
                              .mean = 2e-3,
                              .deviation = 1e-3};
    EXPECT(distance(&asked, below_lognormal) < 1.0);
    asked.by = JOB_SIZES_BY_MASS;
    EXPECT(distance(&asked, below_lognormal) < 1.0);
}

/* The test can fail: draws by mass are far from the distribution by number. */
TEST(a_wrong_distribution_is_found)
{
    struct job_sizes asked = {
        .given = true, .kind = JOB_SIZES_UNIFORM, .min = 0.0011, .max = 0.004};
    EXPECT(distance(&asked, below_uniform) > 1.0);
}

/* ------------------------------------------------------------------------ tables and lists */

static const struct job_size curve[5] = {
    {0.5e-3, 0.0}, {0.8e-3, 0.1}, {1.0e-3, 0.5}, {1.5e-3, 0.5}, {2.5e-3, 1.0}};

static double below_curve(double r)
{
    for (int k = 1; k < 5; k++)
        if (r <= curve[k].radius)
            return curve[k - 1].share + (curve[k].share - curve[k - 1].share) *
                                            (r - curve[k - 1].radius) /
                                            (curve[k].radius - curve[k - 1].radius);
    return 1.0;
}

/* A sieve curve with a gap: nothing between 1 and 1.5 mm. */
TEST(tables_by_number_and_by_mass)
{
    struct job_size points[5];
    struct job_sizes asked = {.given = true, .kind = JOB_SIZES_TABLE, .n = 5, .list = points};
    memcpy(points, curve, sizeof points);
    EXPECT(distance(&asked, below_curve) < 1.0);
    asked.by = JOB_SIZES_BY_MASS;
    EXPECT(distance(&asked, below_curve) < 1.0);
    for (int k = 0; k < MANY; k++)
        EXPECT(!(drawn[k] > 1.0000001e-3 && drawn[k] < 1.4999999e-3));
}

/* Chi-square with 2 degrees of freedom exceeds 13.82 once in 1000. */
static double list_square(enum job_sizes_by by, const double share[3])
{
    struct job_size radii[3] = {{3e-3, 2.0}, {1e-3, 1.0}, {2e-3, 1.0}};
    const struct job_sizes asked = {
        .given = true, .kind = JOB_SIZES_LIST, .by = by, .n = 3, .list = radii};
    int counts[3] = {0};
    double square = 0.0;
    struct sizes sizes;
    sizes_build(&sizes, &asked, 0.0);
    EXPECT(sizes.min == 1e-3 && sizes.max == 3e-3);
    for (int k = 0; k < MANY; k++) {
        const double radius = sizes_draw(&sizes, 5, 9, k);
        for (int i = 0; i < 3; i++)
            counts[i] += radius == radii[i].radius;
    }
    EXPECT(counts[0] + counts[1] + counts[2] == MANY);
    for (int i = 0; i < 3; i++)
        square +=
            (counts[i] - MANY * share[i]) * (counts[i] - MANY * share[i]) / (MANY * share[i]);
    sizes_clear(&sizes);
    return square;
}

TEST(lists_by_number_and_by_mass)
{
    /* by mass: 2/27, 1/1, 1/8 of their sum 259/216 */
    const double number[3] = {0.5, 0.25, 0.25};
    const double mass[3] = {16.0 / 259.0, 216.0 / 259.0, 27.0 / 259.0};
    EXPECT(list_square(JOB_SIZES_BY_NUMBER, number) < 13.82);
    EXPECT(list_square(JOB_SIZES_BY_MASS, mass) < 13.82);
    EXPECT(list_square(JOB_SIZES_BY_MASS, number) > 13.82);
}

TEST(one_radius)
{
    const struct job_sizes none = {.given = false};
    struct sizes sizes;
    sizes_build(&sizes, &none, 0.1);
    EXPECT(sizes.min == 0.1 && sizes.max == 0.1 && sizes_draw(&sizes, 1, 2, 3) == 0.1);
    EXPECT_NEAR(sizes.mean_volume, 4.0 / 3.0 * acos(-1.0) * 1e-3, 1e-15);
    sizes_clear(&sizes);
}

/* What the table says of itself is what was asked, to its stated error. */
TEST(shares_below_a_radius)
{
    const struct job_sizes asked = {.given = true,
                                    .kind = JOB_SIZES_LOGNORMAL,
                                    .min = 5e-4,
                                    .max = 1e-2,
                                    .mean = 2e-3,
                                    .deviation = 1e-3};
    struct sizes sizes;
    sizes_build(&sizes, &asked, 0.0);
    for (double r = 5e-4; r < 1e-2; r *= 1.1)
        EXPECT_NEAR(sizes_share_below(&sizes, r), below_lognormal(r), 1e-5);
    EXPECT(sizes_share_below(&sizes, 1e-4) == 0.0);
    EXPECT_NEAR(sizes_share_below(&sizes, 1.0), 1.0, 1e-12);
    sizes_clear(&sizes);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
