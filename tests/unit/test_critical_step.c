/* Critical steps and durations of contacts, against numbers worked out by hand. */
#include "physics/critical_step.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "check.h"

/* Glass: rho 2500, E 70 GPa, nu .25, so G = 28 GPa and sqrt(rho / G) = 2.988072e-4 s/m; a
 * radius of 1 mm gives pi x 1e-3 x 2.988072e-4 / .917375 = 1.023278e-6 s. */
TEST(rayleigh_step)
{
    EXPECT_NEAR(critical_step_rayleigh(1e-3, 2500.0, 70e9, 0.25), 1.023278e-6, 1e-12);
    /* The hopper's ore: 0.1 m, 2367 kg/m3, 62.5 GPa, .2: 1.0417e-4 s. */
    EXPECT_NEAR(critical_step_rayleigh(0.1, 2367.0, 6.25e10, 0.2), 1.0417e-4, 1e-8);
}

TEST(rayleigh_step_scales)
{
    const double step = critical_step_rayleigh(0.01, 2000.0, 1e9, 0.3);
    EXPECT_NEAR(critical_step_rayleigh(0.02, 2000.0, 1e9, 0.3) / step, 2.0, 1e-14);
    EXPECT_NEAR(critical_step_rayleigh(0.01, 8000.0, 1e9, 0.3) / step, 2.0, 1e-14);
    EXPECT_NEAR(critical_step_rayleigh(0.01, 2000.0, 4e9, 0.3) / step, 0.5, 1e-14);
}

/* 2.87 (m*^2 / (R* E*^2 v))^(1/5). */
TEST(duration_of_an_impact)
{
    EXPECT_NEAR(critical_step_hertz_duration(1.0, 1.0, 1.0, 1.0), 2.87, 1e-12);
    const double t = critical_step_hertz_duration(0.004, 0.005, 3e9, 2.0);
    EXPECT_NEAR(t / (2.87 * pow(0.004 * 0.004 / (0.005 * 9e18 * 2.0), 0.2)), 1.0, 1e-13);
    EXPECT_NEAR(critical_step_hertz_duration(0.004, 0.005, 3e9, 64.0) / t, 0.5, 1e-13);
}

TEST(rounding_down)
{
    EXPECT(critical_step_round_down(2.0834e-5) == 2.0e-5);
    EXPECT(critical_step_round_down(1.999e-7) == 1.9e-7);
    EXPECT(critical_step_round_down(9.999) == 9.9);
    EXPECT(critical_step_round_down(123456.0) == 120000.0);
}

/* What has two digits already stays as it is. */
TEST(two_digits_stay)
{
    for (int digits = 10; digits < 100; digits++) {
        for (int power = -12; power <= 3; power++) {
            char text[32];
            (void)snprintf(text, sizeof text, "%de%d", digits, power);
            const double x = strtod(text, NULL);
            if (critical_step_round_down(x) != x)
                CHECK_FAIL("%s becomes %.17g", text, critical_step_round_down(x));
            EXPECT(critical_step_round_down(nextafter(x, 1e9)) == x);
            EXPECT(critical_step_round_down(nextafter(x, 0.0)) < x);
        }
    }
}

/* A sphere of 2 kg on one wall: stiffness across 200 N/m, dashpot 5 kg/s. */
static const struct critical_step_contact contact = {{200.0, 0.0, 0.0}, {4.0 * 5.0, 0.0, 0.0}};
static const double z[3] = {0.0, 0.0, 1.0};

/* dt = 2/w (sqrt(1 + 4 xi^2) - 2 xi), w = 10/s, xi = 5/(2 x 20) = .125. */
TEST(one_contact_across)
{
    const struct critical_step_side side = critical_step_side(0.5, 10.0, 0.0);
    struct critical_step_sums sums = {0.0, 0.0};
    struct critical_step_matrix matrix = {0};
    const double expected = 0.2 * (sqrt(1.0 + 4.0 * 0.125 * 0.125) - 0.25);
    EXPECT_NEAR(side.share, 0.5, 1e-15);
    EXPECT_NEAR(side.arm, 1.0, 1e-15);
    critical_step_add(&sums, &contact, &side);
    critical_step_add_matrix(&matrix, &contact, &side, z);
    EXPECT_NEAR(critical_step_of_sums(&sums), expected, 1e-15);
    EXPECT_NEAR(critical_step_of_matrix(&matrix), expected, 1e-11);
    EXPECT_NEAR(critical_step_load(&matrix, expected), 1.0, 1e-12);
}

/* Along the contact of one wall: place and turn together have 7/2 k_t. */
TEST(one_contact_along)
{
    const struct critical_step_contact grip = {{0.0, 200.0, 0.0}, {0.0, 0.0, 0.0}};
    const struct critical_step_side side = critical_step_side(0.5, 10.0, 0.0);
    struct critical_step_matrix matrix = {0};
    critical_step_add_matrix(&matrix, &grip, &side, z);
    /* Two directions have it, so the root of the trace is 2^(1/32) too large. */
    EXPECT_NEAR(critical_step_load(&matrix, 2.0 / sqrt(350.0)), pow(2.0, 1.0 / 32.0), 1e-12);
}

/* Between spheres of 1 and 3 m: R* is 3/4 m, and the smaller has 4/3 of the contact. */
TEST(sides_of_a_contact)
{
    const struct critical_step_side small = critical_step_side(0.5, 1.0, 1.0 / 3.0),
                                    large = critical_step_side(0.25, 1.0 / 3.0, 1.0);
    EXPECT_NEAR(small.share, 0.5 * 4.0 / 3.0, 1e-15);
    EXPECT_NEAR(large.share, 0.25 * 4.0, 1e-15);
    EXPECT_NEAR(small.arm, 0.5625, 1e-15);
    EXPECT_NEAR(large.arm, 0.0625, 1e-15);
}

/* Six contacts along the axes are on all sides alike: what (6.7) says
 * of n = 6 is what their matrix has. */
TEST(contacts_on_all_sides)
{
    const struct critical_step_contact full = {{200.0, 90.0, 90.0}, {7.0, 3.0, 3.0}};
    const struct critical_step_side side = critical_step_side(0.5, 10.0, 10.0);
    struct critical_step_matrix matrix = {0};
    for (int k = 0; k < 6; k++) {
        double n[3] = {0.0, 0.0, 0.0};
        n[k / 2] = k % 2 == 0 ? 1.0 : -1.0;
        critical_step_add_matrix(&matrix, &full, &side, n);
    }
    const struct critical_step_sums sums = critical_step_amid(&full, 0.5, 6);
    const double exact = critical_step_of_sums(&sums);
    /* Three equal eigenvalues, or six. */
    EXPECT(critical_step_of_matrix(&matrix) <= exact * (1.0 + 1e-9));
    EXPECT(critical_step_of_matrix(&matrix) >= exact / pow(6.0, 1.0 / 32.0));
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
