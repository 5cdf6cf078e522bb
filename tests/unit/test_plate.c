/* Plates' closed forms against published tables and theory. */
#include "physics/plate.h"

#include <math.h>

#include "check.h"

/* 1 m wide, thin; ratio and load are the test's. */
static struct plate steel(double ratio)
{
    return (struct plate){.thickness = 1e-2,
                          .young = 2.1e11,
                          .poisson = 0.3,
                          .density = 7850.0,
                          .span = 1.0,
                          .ratio = ratio};
}

struct row {
    double other_side, clamped, hinged; /* over the span; w D / p a^4 or w D / F a^2 */
};

/* Timoshenko and Woinowsky-Krieger, tables 35 and 8. */
TEST(under_pressure)
{
    static const struct row rows[] = {{1.0, 0.00126, 0.00406},
                                      {1.2, 0.00172, 0.00564},
                                      {1.5, 0.00220, 0.00772},
                                      {2.0, 0.00254, 0.01013}};
    for (int k = 0; k < 4; k++) {
        const struct plate plate = steel(1.0 / rows[k].other_side);
        const double unit = 1.0 / plate_stiffness(&plate); /* at 1 Pa, so little stretches */
        EXPECT_NEAR(plate_under_pressure(&plate, 1.0, false).deflection / unit, rows[k].clamped,
                    0.05 * rows[k].clamped);
        EXPECT_NEAR(plate_under_pressure(&plate, 1.0, true).deflection / unit, rows[k].hinged,
                    0.05 * rows[k].hinged);
    }
}

/* Tables 37 and 23. */
TEST(under_a_force)
{
    static const struct row rows[] = {{1.0, 0.00560, 0.01160},
                                      {1.2, 0.00647, 0.01353},
                                      {1.4, 0.00691, 0.01484},
                                      {2.0, 0.00722, 0.01651}};
    for (int k = 0; k < 4; k++) {
        const struct plate plate = steel(1.0 / rows[k].other_side);
        const double unit = 1.0 / plate_stiffness(&plate);
        EXPECT_NEAR(plate_under_force(&plate, 1.0, false).deflection / unit, rows[k].clamped,
                    0.05 * rows[k].clamped);
        EXPECT_NEAR(plate_under_force(&plate, 1.0, true).deflection / unit, rows[k].hinged,
                    0.05 * rows[k].hinged);
    }
}

/* A square membrane rises by 0.318 a (p a / E t)^(1/3), and bending bears nothing. */
TEST(what_is_thin_stretches)
{
    struct plate skin = steel(1.0);
    skin.thickness = 1e-6;
    const struct plate_sag sag = plate_under_pressure(&skin, 100.0, false);
    EXPECT_NEAR(sag.deflection, 0.318 * cbrt(100.0 / (2.1e11 * 1e-6)), 1e-4);
    EXPECT(sag.bending < 1e-4);
    const struct plate thick = steel(1.0);
    EXPECT(plate_under_pressure(&thick, 1.0, false).bending > 0.999);
}

/* Of a long pipe p R^2 / E t; under a force F R sqrt(12 (1 - nu^2)) / 8 E t^2, as Reissner
 * found of spheres. */
TEST(what_is_curved_holds)
{
    struct plate pipe = steel(1.0);
    pipe.span = 0.0;
    pipe.curvature = 2.0;
    EXPECT_NEAR(plate_under_pressure(&pipe, 1e5, true).deflection, 1e5 * 0.25 / 2.1e9, 1e-12);
    EXPECT_NEAR(plate_under_force(&pipe, 1e3, true).deflection,
                1e3 * 0.5 * sqrt(12.0 * 0.91) / (8.0 * 2.1e11 * 1e-4), 1e-12);
    EXPECT_NEAR(plate_under_force(&pipe, 1e3, true).bending, 0.5, 1e-12);
    EXPECT(plate_under_pressure(&pipe, 1e5, true).bending < 1e-12);
    pipe.curvature = 0.0;
    EXPECT(isinf(plate_under_force(&pipe, 1e3, true).deflection));
}

/* Zener's equation, integrated: restitution, and force over that on a wall that does not yield,
 * 1.14326 m v / T. */
TEST(zener)
{
    static const double rows[][3] = {{0.05, 0.91777, 1.08680}, {0.1, 0.84334, 1.03555},
                                     {0.2, 0.71404, 0.94606},  {0.3, 0.60595, 0.87057},
                                     {0.5, 0.43690, 0.75023},  {1.0, 0.18412, 0.55616}};
    for (int k = 0; k < 6; k++) {
        EXPECT_NEAR(plate_restitution(rows[k][0]), rows[k][1], 0.015);
        EXPECT_NEAR(plate_blow(rows[k][0]), rows[k][2] / 1.14326, 0.01);
    }
    /* Steel of 10 mm, a ball of 10 mm at 1 m/s that would go 23.505 um deep: 0.1556. */
    const struct plate plate = steel(1.0);
    EXPECT_NEAR(plate_zener(&plate, 0.032882, 2.3505e-5, 1.0), 0.1556, 1e-4);
    /* Waves get sqrt(t sqrt(D / rho h)) far. */
    EXPECT_NEAR(plate_reach(&plate, 1e-4 / 2.943, 1.0),
                sqrt(1e-4 * sqrt(plate_stiffness(&plate) / 78.5)), 1e-9);
}

/* Energy is shared: x^(5/3) + 5/4 y x^2 = 1. */
TEST(on_a_spring)
{
    EXPECT_NEAR(plate_blow_on_spring(0.0), 1.0, 1e-12);
    for (double y = 0.01; y < 200.0; y *= 3.0) {
        const double x = plate_blow_on_spring(y);
        EXPECT_NEAR(pow(x, 5.0 / 3.0) + 1.25 * y * x * x, 1.0, 1e-9);
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
