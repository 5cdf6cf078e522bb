/*
 * Restitution that is asked for comes out, and a damped contact goes as deep as the oscillator
 * of THEORY.md (1.21) does.
 *
 * Where within a step surfaces first touch is chance in a run, and changes what a damped
 * impact returns; so what is compared is the mean over that phase, and the spread is a row of
 * its own.
 */
#include <math.h>
#include <stdio.h>

#include "impact.h"
#include "model/restitution.h"
#include "verify.h"

enum { PHASES = 16, STEPS = 500 };

static const struct impact_solid oxide = {380e9, 0.23, 4000.0}, iron = {100e9, 0.25, 7000.0};
static const double RADIUS = 2.5e-3, SPEED = 3.9;

struct spread {
    double mean, least, most, deepest;
};

/* Impacts on a rigid plane at PHASES phases, `steps` to an elastic one. */
static struct spread impacts(const struct impact_solid *solid, double restitution, int steps)
{
    struct impact impact = {.solid = {solid, &impact_rigid},
                            .restitution = restitution,
                            .radius = {RADIUS, 0.0},
                            .velocity = {{0.0, 0.0, -SPEED}}};
    const struct impact_hertz hertz = impact_hertz(&impact);
    impact.dt = hertz.duration / steps;
    struct spread spread = {0.0, 1e300, -1e300, 0.0};
    for (int p = 0; p < PHASES; p++) {
        impact.phase = (p + 0.5) / PHASES;
        const struct impact_result result = impact_run(&impact);
        const double out = result.velocity[0].z / SPEED;
        spread.mean += out / PHASES;
        spread.deepest += result.overlap_max / hertz.overlap / PHASES;
        spread.least = out < spread.least ? out : spread.least;
        spread.most = out > spread.most ? out : spread.most;
    }
    return spread;
}

static void compare(const struct impact_solid *solid, const char *name)
{
    static const double asked[] = {0.2, 0.4, 0.6, 0.8, 1.0};
    for (int k = 0; k < 5; k++) {
        char quantity[128];
        const struct spread spread = impacts(solid, asked[k], STEPS);
        snprintf(quantity, sizeof quantity, "%s, asked for %g: restitution", name, asked[k]);
        verify_row(quantity, "", asked[k], spread.mean, 1e-3, VERIFY_ABSOLUTE,
                   "published at 500 steps a contact");
    }
}

/* Two spheres of unlike materials and sizes, at PHASES phases. */
static void compare_pair(double radius_0, double radius_1, double restitution)
{
    char quantity[128];
    struct impact impact = {.solid = {&oxide, &iron},
                            .restitution = restitution,
                            .radius = {radius_0, radius_1},
                            .velocity = {{0.0, 0.0, -0.75 * SPEED}, {0.0, 0.0, 0.25 * SPEED}}};
    impact.dt = impact_hertz(&impact).duration / STEPS;
    double out = 0.0;
    for (int p = 0; p < PHASES; p++) {
        impact.phase = (p + 0.5) / PHASES;
        const struct impact_result result = impact_run(&impact);
        out += (result.velocity[0].z - result.velocity[1].z) / SPEED / PHASES;
    }
    snprintf(quantity, sizeof quantity,
             "oxide of %g mm on iron of %g mm, asked for %g: restitution", 1e3 * radius_0,
             1e3 * radius_1, restitution);
    verify_row(quantity, "", restitution, out, 1e-3, VERIFY_ABSOLUTE,
               "published at 500 steps a contact");
}

static void compare_depth(void)
{
    static const double asked[] = {0.2, 0.5, 0.8};
    for (int k = 0; k < 3; k++) {
        char quantity[128];
        const double beta = restitution_damping(asked[k]);
        const double deepest = exp(-0.8 * beta / sqrt(1.0 - beta * beta) * acos(beta));
        const struct spread spread = impacts(&oxide, asked[k], STEPS);
        snprintf(quantity, sizeof quantity,
                 "aluminium oxide, asked for %g: largest overlap over the elastic one",
                 asked[k]);
        verify_row(quantity, "", deepest, spread.deepest, 1e-3, VERIFY_RELATIVE,
                   "as the restitution's");
    }
}

static void compare_spread(void)
{
    static const int steps[] = {20, 40, 80};
    static const double most[] = {0.007, 0.003, 0.001};
    for (int k = 0; k < 3; k++) {
        double widest = 0.0, bias = 0.0;
        char quantity[128];
        for (int e = 2; e <= 10; e += 2) {
            const struct spread spread = impacts(&oxide, 0.1 * e, steps[k]);
            const double half = 0.5 * (spread.most - spread.least);
            widest = half > widest ? half : widest;
            bias = fabs(spread.mean - 0.1 * e) > bias ? fabs(spread.mean - 0.1 * e) : bias;
        }
        snprintf(quantity, sizeof quantity,
                 "%d steps a contact, asked for .2 to 1: half the spread over the phase",
                 steps[k]);
        verify_row(quantity, "", most[k], widest, 0.0005, VERIFY_AT_MOST,
                   "stated in THEORY.md to one digit");
        snprintf(quantity, sizeof quantity,
                 "%d steps a contact, asked for .2 to 1: largest error of the mean", steps[k]);
        verify_row(quantity, "", most[k], bias, 0.0, VERIFY_AT_MOST, "less than the spread");
    }
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Restitution",
                 "set-up: Chung and Ooi 2011, case 3; the job's restitution");
    compare(&oxide, "aluminium oxide");
    compare(&iron, "cast iron");
    compare_pair(RADIUS, RADIUS, 0.5);
    compare_pair(RADIUS, 20.0 * RADIUS, 0.3);
    compare_pair(20.0 * RADIUS, RADIUS, 0.8);
    verify_source("closed form of (1.21)");
    compare_depth();
    verify_source("THEORY.md, section 1.2");
    compare_spread();
    return verify_end();
}
