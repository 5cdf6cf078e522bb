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

static const double STIFFNESS = 1e6; /* of the linear law [N/m] */
static const char LINEAR[] = ", law: linear, stiffness: 1.0e+6, tangential_ratio: 0.7";

/* An impact on a plane. */
struct setup {
    double friction, restitution;
    double degrees;   /* from the normal */
    const char *more; /* keys of the pair; NULL: none */
    struct vec3 spin; /* [rad/s] */
};

/* It at COARSEST steps a contact, twice and four times as many: over the phase, */
struct levels {
    double mean[LEVELS], scatter[LEVELS]; /* of the error of the restitution [-] */
    double spin[LEVELS];                  /* mean of R w over the speed of impact [-] */
    double balance[LEVELS];               /* mean of the ledger's [-] */
};

static struct levels run_levels(const struct setup *setup)
{
    const double v_n = SPEED * cos(setup->degrees * DEGREE),
                 v_t = SPEED * sin(setup->degrees * DEGREE);
    struct impact impact = {.solid = {&stone, &stone},
                            .friction = setup->friction,
                            .restitution = setup->restitution,
                            .more = setup->more,
                            .radius = {RADIUS, 0.0},
                            .velocity = {{v_t, 0.0, -v_n}},
                            .spin = {setup->spin}};
    const double duration = setup->more == LINEAR
                                ? M_PI * sqrt(impact_mass(&stone, RADIUS) / STIFFNESS)
                                : impact_hertz(&impact).duration;
    struct levels levels = {{0.0}, {0.0}, {0.0}, {0.0}};
    for (int l = 0; l < LEVELS; l++) {
        double squares = 0.0;
        impact.dt = duration / ((COARSEST << l) + 0.3); /* no whole number */
        for (int p = 0; p < PHASES; p++) {
            impact.phase = (p + 0.5) / PHASES;
            const struct impact_result result = impact_run(&impact);
            const double error = result.velocity[0].z / v_n - setup->restitution;
            levels.mean[l] += error / PHASES;
            squares += error * error / PHASES;
            levels.spin[l] += (result.spin[0].y + result.spin[0].z) * RADIUS / SPEED / PHASES;
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

/* Spin after an impact that resists turning: what slips throughout is as exact as the normal
 * force; what sticks has a dashpot that is late by half a step. */
static void compare_turning(void)
{
    static const struct {
        const char *name;
        struct setup setup;
        double order;
    } rows[] = {
        {"linear, slides, 70 degrees, mu .3, e .5",
         {0.3, 0.5, 70.0, LINEAR, {0.0, 0.0, 0.0}},
         2.0},
        {"linear, sticks, 20 degrees, mu 10, e .5",
         {10.0, 0.5, 20.0, LINEAR, {0.0, 0.0, 0.0}},
         1.0},
        {"Hertz, rolling spring slips, e .5",
         {0.0, 0.5, 0.0, ", rolling_friction: 0.05", {0.0, 100.0, 0.0}},
         2.0},
        {"Hertz, rolling of constant torque slips, e .5",
         {0.0, 0.5, 0.0, ", rolling_friction: 0.05, rolling: constant", {0.0, 100.0, 0.0}},
         2.0},
        {"Hertz, rolling spring sticks, e .5",
         {0.0, 0.5, 0.0, ", rolling_friction: 10", {0.0, 30.0, 0.0}},
         1.0},
        {"Hertz, twisting slips, e .5",
         {0.0, 0.5, 0.0, ", twisting_friction: 0.05", {0.0, 0.0, 100.0}},
         2.0},
        {"Hertz, twisting sticks, e .5",
         {0.0, 0.5, 0.0, ", twisting_friction: 10", {0.0, 0.0, 30.0}},
         1.0},
    };
    for (size_t k = 0; k < sizeof rows / sizeof rows[0]; k++) {
        const struct levels levels = run_levels(&rows[k].setup);
        char name[128];
        verify_source(rows[k].order > 1.5 ? "the limit follows the normal force, (1.7), (1.13)"
                                          : "(1.12): a dashpot that is late by half a step");
        snprintf(name, sizeof name, "%s: mean angular velocity after", rows[k].name);
        verify_row(name, "", rows[k].order, richardson(levels.spin),
                   rows[k].order > 1.5 ? 0.1 : 0.2, VERIFY_ABSOLUTE,
                   "the next order at a hundred steps a contact");
    }
}

int main(int argc, char **argv)
{
    static const char why[] = "the next order at a hundred steps a contact";
    verify_begin(argc, argv, "Order of convergence, impacts at 100, 200, 400 steps a contact",
                 "p + 1 for a force that begins as overlap^p");
    const struct levels elastic =
        run_levels(&(struct setup){0.0, 1.0, 0.0, NULL, {0.0, 0.0, 0.0}});
    const struct levels damped =
        run_levels(&(struct setup){0.0, 0.5, 0.0, NULL, {0.0, 0.0, 0.0}});
    const struct levels sliding =
        run_levels(&(struct setup){0.3, 0.5, 70.0, NULL, {0.0, 0.0, 0.0}});
    const struct levels sticking =
        run_levels(&(struct setup){10.0, 1.0, 20.0, NULL, {0.0, 0.0, 0.0}});
    const struct levels gripping =
        run_levels(&(struct setup){10.0, 0.5, 20.0, NULL, {0.0, 0.0, 0.0}});
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
    compare_turning();
    return verify_end();
}
