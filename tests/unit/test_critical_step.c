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

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
