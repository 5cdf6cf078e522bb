/*
 * Oblique impacts of a sphere on a rigid plane.
 *
 * Where the contact slides throughout, momentum alone gives the answer; below the sliding
 * limit only published results of other laws are there to compare with.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "impact.h"
#include "verify.h"

static const double DEGREE = M_PI / 180.0;

/* A sphere and what happens where it touches. */
struct sphere {
    struct impact_solid solid;
    double radius, friction, restitution;
};

static const struct sphere oxide = {{380e9, 0.23, 4000.0}, 2.5e-3, 0.092, 0.98},
                           steel = {{208e9, 0.3, 7850.0}, 10e-6, 0.3, 1.0},
                           alloy = {{70e9, 0.33, 2700.0}, 0.1, 0.4, 0.5};

/* The impact on a rigid plane at these speeds, at 1000 steps a contact. */
static struct impact_result strike(const struct sphere *sphere, double v_n, double v_t,
                                   double spin)
{
    struct impact impact = {.solid = {&sphere->solid, &impact_rigid},
                            .friction = sphere->friction,
                            .restitution = sphere->restitution,
                            .radius = {sphere->radius, 0.0},
                            .velocity = {{v_t, 0.0, -v_n}},
                            .spin = {{0.0, spin, 0.0}},
                            .phase = 0.5};
    impact.dt = impact_hertz(&impact).duration / 1000.0;
    return impact_run(&impact);
}

static const char LEAPFROG[] = "(pi/1000)^2, 1e-5: leapfrog at 1000 steps a contact";

/* Constant speed, rising angle. */
static void case_4(void)
{
    /* angle from the normal, tangential restitution, angular velocity, rebound angle */
    static const double table[][4] = {
        {20, 0.616, 511, -7.54}, {25, 0.634, 599, -7.54}, {30, 0.684, 617, -3.55},
        {35, 0.737, 582, 3.43},  {40, 0.781, 545, 11.57}, {50, 0.845, 457, 29.35},
        {60, 0.893, 357, 47.79}, {70, 0.932, 246, 64.58}, {80, 0.966, 126, 78.70}};
    const double speed = 3.9, mu = oxide.friction, e = oxide.restitution;
    for (int k = 0; k < 9; k++) {
        const double angle = table[k][0] * DEGREE, v_n = speed * cos(angle),
                     v_t = speed * sin(angle);
        const struct impact_result result = strike(&oxide, v_n, v_t, 0.0);
        const double spin = result.spin[0].y, out = result.velocity[0].x;
        const double rebound =
            atan((out - spin * oxide.radius) / result.velocity[0].z) / DEGREE;
        const bool slides = tan(angle) > 3.5 * mu * (1.0 + e);
        char name[3][128];
        static const char *const what[] = {
            "tangential restitution", "angular velocity after",
            "rebound angle of the contact patch, a small difference of the two above"};
        for (int q = 0; q < 3; q++)
            snprintf(name[q], sizeof name[q], "%g degrees from the normal: %s", table[k][0],
                     what[q]);
        if (slides) {
            const double expected[3] = {1.0 - mu * (1.0 + e) / tan(angle),
                                        2.5 * mu * (1.0 + e) * v_n / oxide.radius,
                                        atan((tan(angle) - 3.5 * mu * (1.0 + e)) / e) / DEGREE};
            verify_source("momentum, sliding throughout; set-up: Chung and Ooi 2011, case 4");
            verify_row(name[0], "", expected[0], out / v_t, 1e-5, VERIFY_RELATIVE, LEAPFROG);
            verify_row(name[1], "rad/s", expected[1], spin, 1e-5, VERIFY_RELATIVE, LEAPFROG);
            verify_row(name[2], "deg", expected[2], rebound, 6e-4, VERIFY_ABSOLUTE,
                       "1e-5 radians");
        } else {
            /* The published angle is not met within 3 % of itself but at 30 degrees: that
             * small a difference of two large speeds is not what 3 % in each determines. */
            const double patch =
                table[k][1] * v_t + table[k][2] * oxide.radius; /* both, by size [m/s] */
            const double differ = 0.03 * patch / (e * v_n) / DEGREE;
            verify_source("table published for Chung and Ooi 2011, case 4");
            verify_row(name[0], "", table[k][1], out / v_t, 0.03, VERIFY_RELATIVE,
                       "published laws differ by this");
            verify_row(name[1], "rad/s", table[k][2], spin, 0.03, VERIFY_RELATIVE,
                       "published laws differ by this");
            verify_row(name[2], "deg", table[k][3], rebound, differ, VERIFY_ABSOLUTE,
                       "3 % in both of the rows above; of the angle itself it is more");
        }
    }
}

/* Constant normal speed, rising tangential speed. */
static void case_5(void)
{
    static const double ratios[] = {7.5, 10.0, 14.0, 20.0};
    const double v_n = 5.0, mu = steel.friction;
    verify_source("momentum, sliding throughout; set-up: Chung and Ooi 2011, case 5");
    for (int k = 0; k < 4; k++) {
        char name[96];
        const struct impact_result result = strike(&steel, v_n, ratios[k] * mu * v_n, 0.0);
        snprintf(name, sizeof name, "v_t/(mu v_n) = %g: R w/(mu v_n) after", ratios[k]);
        verify_row(name, "", 5.0, result.spin[0].y * steel.radius / (mu * v_n), 1e-5,
                   VERIFY_RELATIVE, LEAPFROG);
    }
}

/* Spin into a wall. */
static void case_6(void)
{
    static const double x[] = {0.95, 0.75, 0.5, 0.25};
    const double v_n = 0.2;
    verify_source("momentum, sliding throughout; set-up: Chung and Ooi 2011, case 6");
    for (int k = 0; k < 4; k++) {
        char name[96];
        const double slip = 3.5 * alloy.friction * (1.0 + alloy.restitution) * v_n / x[k];
        const struct impact_result result = strike(&alloy, v_n, 0.0, slip / alloy.radius);
        const double after = result.velocity[0].x - result.spin[0].y * alloy.radius;
        snprintf(name, sizeof name, "3.5 mu (1 + e) v_n/v_s = %g: tangential restitution",
                 x[k]);
        verify_row(name, "", x[k] - 1.0, after / slip, 1e-4, VERIFY_ABSOLUTE,
                   "restitution .5 to 1e-4 at 1000 steps");
    }
}

/* Two equal spheres, slowly, so that their normal hardly turns meanwhile. */
static void spheres(double degrees)
{
    const double speed = 0.1, mu = oxide.friction, e = oxide.restitution;
    const double v_n = speed * cos(degrees * DEGREE), v_t = speed * sin(degrees * DEGREE);
    char name[2][96];
    struct impact impact = {
        .solid = {&oxide.solid, &oxide.solid},
        .friction = mu,
        .restitution = e,
        .radius = {oxide.radius, oxide.radius},
        .velocity = {{0.5 * v_t, 0.0, -0.5 * v_n}, {-0.5 * v_t, 0.0, 0.5 * v_n}},
        .phase = 0.5};
    const struct impact_hertz hertz = impact_hertz(&impact);
    impact.dt = hertz.duration / 1000.0;
    const struct impact_result result = impact_run(&impact);
    /* How far the line of centres turns, times what it mixes into each. */
    const double turned = 0.5 * v_t * hertz.duration / oxide.radius;
    snprintf(name[0], sizeof name[0],
             "two spheres, %g degrees from the normal: tangential restitution", degrees);
    verify_row(name[0], "", 1.0 - mu * (1.0 + e) / tan(degrees * DEGREE),
               (result.velocity[0].x - result.velocity[1].x) / v_t,
               2.0 * turned / tan(degrees * DEGREE) + 1e-5, VERIFY_RELATIVE,
               "the line of centres turns by v_t T/2R");
    snprintf(name[1], sizeof name[1],
             "two spheres, %g degrees from the normal: angular velocity", degrees);
    verify_row(name[1], "rad/s", 1.25 * mu * (1.0 + e) * v_n / oxide.radius, result.spin[0].y,
               turned * (1.0 + tan(degrees * DEGREE)) + 0.5 * hertz.overlap / oxide.radius,
               VERIFY_RELATIVE, "turning mixes v_t into v_n; the lever arm is R - overlap/2");
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Oblique impact", "");
    case_4();
    case_5();
    case_6();
    verify_source("momentum, sliding throughout");
    spheres(45.0);
    spheres(70.0);
    return verify_end();
}
