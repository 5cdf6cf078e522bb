/* Principal values of tensors that are known. */
#include "physics/principal.h"

#include <math.h>
#include <stdint.h>

#include "check.h"
#include "solid_block.h"

static void expect_values(const double matrix[6], double a, double b, double c, double error)
{
    double values[3];
    principal_values(matrix, values);
    EXPECT_NEAR(values[0], a, error);
    EXPECT_NEAR(values[1], b, error);
    EXPECT_NEAR(values[2], c, error);
}

TEST(simple_states)
{
    expect_values((double[6]){0.0, 0.0, 0.0, 0.0, 0.0, 0.0}, 0.0, 0.0, 0.0, 0.0);
    expect_values((double[6]){-3.0, 5.0, 1.0, 0.0, 0.0, 0.0}, 5.0, 1.0, -3.0, 0.0);
    expect_values((double[6]){-2.0, -2.0, -2.0, 0.0, 0.0, 0.0}, -2.0, -2.0, -2.0, 0.0);
    for (int k = 3; k < 6; k++) { /* shear in each plane */
        double shear[6] = {0.0};
        shear[k] = 7.0;
        expect_values(shear, 7.0, 0.0, -7.0, 1e-14);
    }
    /* Mohr's circle about 50 of radius 50. */
    expect_values((double[6]){80.0, 20.0, 0.0, 40.0, 0.0, 0.0}, 100.0, 0.0, 0.0, 1e-13);
    expect_values((double[6]){1.0, 1.0, 1.0, 1.0, 1.0, 1.0}, 3.0, 0.0, 0.0, 1e-14);
}

/* q diag(values) q^t with q from a random quaternion. */
static void turned(const double values[3], uint64_t *seed, double matrix[6])
{
    static const int at[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    double p[4], norm = 0.0;
    for (int k = 0; k < 4; k++) {
        p[k] = solid_block_random(seed);
        norm += p[k] * p[k];
    }
    for (int k = 0; k < 4; k++)
        p[k] /= sqrt(norm);
    const double q[3][3] = {{1 - 2 * (p[2] * p[2] + p[3] * p[3]),
                             2 * (p[1] * p[2] - p[0] * p[3]), 2 * (p[1] * p[3] + p[0] * p[2])},
                            {2 * (p[1] * p[2] + p[0] * p[3]),
                             1 - 2 * (p[1] * p[1] + p[3] * p[3]),
                             2 * (p[2] * p[3] - p[0] * p[1])},
                            {2 * (p[1] * p[3] - p[0] * p[2]), 2 * (p[2] * p[3] + p[0] * p[1]),
                             1 - 2 * (p[1] * p[1] + p[2] * p[2])}};
    for (int m = 0; m < 6; m++) {
        matrix[m] = 0.0;
        for (int k = 0; k < 3; k++)
            matrix[m] += q[at[m][0]][k] * values[k] * q[at[m][1]][k];
    }
}

TEST(turned_tensors_keep_their_values)
{
    static const double cases[][3] = {{3.0, 2.0, -1.0}, {1.0, 1.0, -2.0},  {1e9, 1.0, -1.0},
                                      {4.0, 4.0, 4.0},  {1e-9, 0.0, -1e9}, {1e200, 0.0, 0.0}};
    uint64_t seed = 11;
    for (int round = 0; round < 200; round++)
        for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
            double matrix[6];
            const double size = fmax(fabs(cases[k][0]), fabs(cases[k][2]));
            turned(cases[k], &seed, matrix);
            expect_values(matrix, cases[k][0], cases[k][1], cases[k][2], 4e-15 * size);
        }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
