/*
 * How fast errors fall with the step.
 *
 * Where within a step surfaces first touch decides what one impact's error is, so two things
 * are asked: the order of the mean over that phase, which is the scheme's own, and the order
 * of the root mean square about it, which is that of a force met within a step: a force that
 * begins as overlap^p is off by a share of dt^(p+1), whatever the scheme.  p is 3/2 for
 * Hertz's force and 1/4 for its dashpot.  Where the answer is not known, three steps, each
 * half of the one before, give the order (Richardson).
 */
#include <math.h>
#include <stdio.h>

#include "impact.h"
#include "verify.h"

enum { PHASES = 32, LEVELS = 3, COARSEST = 100 };

static const struct impact_solid stone = {7e10, 0.25, 2500.0};
static const double RADIUS = 0.01, SPEED = 1.0, DEGREE = M_PI / 180.0;

/* An impact on a plane at COARSEST steps a contact, twice and four times as many: over the
 * phase, */
struct levels {
    double mean[LEVELS], scatter[LEVELS]; /* of the error of the restitution [-] */
    double spin[LEVELS];                  /* mean of R w over the speed of impact [-] */
    double balance[LEVELS];               /* mean of the ledger's [-] */
};

static struct levels run_levels(double friction, double restitution, double degrees)
{
    const double v_n = SPEED * cos(degrees * DEGREE), v_t = SPEED * sin(degrees * DEGREE);
    struct impact impact = {.solid = {&stone, &stone},
                            .friction = friction,
                            .restitution = restitution,
                            .radius = {RADIUS, 0.0},
                            .velocity = {{v_t, 0.0, -v_n}}};
    const double duration = impact_hertz(&impact).duration;
    struct levels levels = {{0.0}, {0.0}, {0.0}, {0.0}};
    for (int l = 0; l < LEVELS; l++) {
        double squares = 0.0;
        impact.dt = duration / (COARSEST << l);
        for (int p = 0; p < PHASES; p++) {
            impact.phase = (p + 0.5) / PHASES;
            const struct impact_result result = impact_run(&impact);
            const double error = result.velocity[0].z / v_n - restitution;
            levels.mean[l] += error / PHASES;
            squares += error * error / PHASES;
            levels.spin[l] += result.spin[0].y * RADIUS / SPEED / PHASES;
            levels.balance[l] += result.balance / PHASES;
        }
        levels.scatter[l] = sqrt(squares - levels.mean[l] * levels.mean[l]);
    }
    return levels;
}

/* From the coarsest to the finest of errors. */
static double order_of(const double error[LEVELS])
{
    return log2(fabs(error[0] / error[LEVELS - 1])) / (LEVELS - 1);
}

static double richardson(const double value[LEVELS])
{
    return log2(fabs((value[1] - value[0]) / (value[2] - value[1])));
}

int main(int argc, char **argv)
{
    static const char why[] = "the next order at a hundred steps a contact";
    verify_begin(argc, argv, "Order of convergence, impacts at 100, 200, 400 steps a contact",
                 "p + 1 for a force that begins as overlap^p");
    const struct levels elastic = run_levels(0.0, 1.0, 0.0);
    const struct levels damped = run_levels(0.0, 0.5, 0.0);
    const struct levels sliding = run_levels(0.3, 0.5, 70.0);
    const struct levels sticking = run_levels(10.0, 1.0, 20.0);
    const struct levels gripping = run_levels(10.0, 0.5, 20.0);
    verify_row("elastic: scatter of the restitution over the phase", "", 2.5,
               order_of(elastic.scatter), 0.1, VERIFY_ABSOLUTE, why);
    verify_row("restitution .5: scatter over the phase", "", 1.25, order_of(damped.scatter),
               0.1, VERIFY_ABSOLUTE, why);
    verify_source("central differences; the dashpot extrapolated, (1.7)");
    verify_row("restitution .5: mean error of the restitution", "", 2.0, order_of(damped.mean),
               0.1, VERIFY_ABSOLUTE, why);
    verify_row("sliding, 70 degrees, mu .3, e .5: mean angular velocity after", "", 2.0,
               richardson(sliding.spin), 0.1, VERIFY_ABSOLUTE, why);
    verify_source("(1.11): the stiffness in a step's middle");
    verify_row("sticking, 20 degrees, mu 10, e 1: mean angular velocity after", "", 2.0,
               richardson(sticking.spin), 0.1, VERIFY_ABSOLUTE, why);
    verify_source("(1.11), (1.12): the tangential dashpot is late by half a step");
    verify_row("sticking, 20 degrees, mu 10, e .5: mean angular velocity after", "", 1.0,
               richardson(gripping.spin), 0.2, VERIFY_ABSOLUTE, why);
    verify_source("THEORY.md, section 1.4");
    verify_row("restitution .5: mean balance of the energy ledger", "", 2.0,
               order_of(damped.balance), 0.1, VERIFY_ABSOLUTE, why);
    verify_row("sliding, 70 degrees, mu .3, e .5: mean balance of the energy ledger", "", 2.0,
               order_of(sliding.balance), 0.1, VERIFY_ABSOLUTE, why);
    verify_row("sticking, 20 degrees, mu 10, e .5: mean balance of the energy ledger", "", 2.0,
               order_of(gripping.balance), 0.1, VERIFY_ABSOLUTE, why);
    return verify_end();
}
