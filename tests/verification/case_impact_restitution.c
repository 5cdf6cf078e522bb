/*
 * Restitution that is asked for comes out, and a damped contact goes as deep as the oscillator
 * of THEORY.md (1.21) does.
 *
 * Where within a step surfaces first touch is chance in a run, and changes what a damped
 * impact returns; so restitution is compared at the worst phase. By how much it scatters at few
 * steps a contact follows from the scheme alone: that is integrated here once more, as a mass
 * point in units that make Hertz's force over the mass d^1.5, (1.20).
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "impact.h"
#include "model/restitution.h"
#include "verify.h"

enum { PHASES = 16, STEPS = 500 };

static const struct impact_solid oxide = {380e9, 0.23, 4000.0}, iron = {100e9, 0.25, 7000.0};
static const double RADIUS = 2.5e-3, SPEED = 3.9;

/* Over the phase: */
struct spread {
    double mean, least, most; /* of the restitution */
    double deepest;           /* mean of the largest overlap over the elastic one */
};

static double worst_of(const struct spread *spread, double asked)
{
    const bool below = fabs(spread->least - asked) > fabs(spread->most - asked);
    return below ? spread->least : spread->most;
}

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
        snprintf(quantity, sizeof quantity, "%s, asked for %g: restitution, at the worst phase",
                 name, asked[k]);
        verify_row(quantity, "", asked[k], worst_of(&spread, asked[k]), 1e-3, VERIFY_ABSOLUTE,
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
    double worst = restitution;
    for (int p = 0; p < PHASES; p++) {
        impact.phase = (p + 0.5) / PHASES;
        const struct impact_result result = impact_run(&impact);
        const double out = (result.velocity[0].z - result.velocity[1].z) / SPEED;
        worst = fabs(out - restitution) > fabs(worst - restitution) ? out : worst;
    }
    snprintf(quantity, sizeof quantity,
             "oxide of %g mm on iron of %g mm, asked for %g: restitution, at the worst phase",
             1e3 * radius_0, 1e3 * radius_1, restitution);
    verify_row(quantity, "", restitution, worst, 1e-3, VERIFY_ABSOLUTE,
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

/* What a mass point of speed 1 returns by leapfrog, (5.1), whose dashpot is extrapolated,
 * (1.7), and cut off, (1.8), in steps of which the elastic contact lasts so many. */
static double point_returns(double restitution, int steps, double phase)
{
    const double damping = sqrt(5.0) * restitution_damping(restitution);
    /* (1.25) in these units, v = 1: d_max^2.5 = 5/4 */
    const double dt = 2.943275 * pow(1.25, 0.4) / steps;
    double place = -phase * dt, v = 1.0, v_before = 1.0;
    bool touched = false;
    while (place > 0.0 || !touched) {
        double push = 0.0;
        if (place > 0.0) {
            const double ahead = touched ? 1.5 * v - 0.5 * v_before : v;
            push = fmax(pow(place, 1.5) + damping * pow(place, 0.25) * ahead, 0.0);
            touched = true;
        }
        v_before = v;
        v -= push * dt;
        place += v * dt;
    }
    return -v;
}

static void compare_spread(void)
{
    static const int steps[] = {20, 40, 80};
    for (int k = 0; k < 3; k++) {
        double spreads[2] = {0.0, 0.0}, biases[2] = {0.0, 0.0};
        char quantity[128];
        for (int e = 2; e <= 10; e += 2) {
            const double asked = 0.1 * e;
            struct spread point = {0.0, 1e300, -1e300, 0.0};
            for (int p = 0; p < PHASES; p++) {
                const double out = point_returns(asked, steps[k], (p + 0.5) / PHASES);
                point.mean += out / PHASES;
                point.least = fmin(point.least, out);
                point.most = fmax(point.most, out);
            }
            const struct spread both[2] = {impacts(&oxide, asked, steps[k]), point};
            for (int b = 0; b < 2; b++) {
                spreads[b] = fmax(spreads[b], 0.5 * (both[b].most - both[b].least));
                biases[b] = fmax(biases[b], fabs(both[b].mean - asked));
            }
        }
        static const char why[] =
            "the same scheme for a mass point; Gamma functions to 7 digits";
        snprintf(quantity, sizeof quantity,
                 "%d steps a contact, asked for .2 to 1: half the spread over the phase",
                 steps[k]);
        verify_row(quantity, "", spreads[1], spreads[0], 1e-4, VERIFY_RELATIVE, why);
        snprintf(quantity, sizeof quantity,
                 "%d steps a contact, asked for .2 to 1: largest error of the mean", steps[k]);
        verify_row(quantity, "", biases[1], biases[0], 1e-4, VERIFY_RELATIVE, why);
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
    verify_source("leapfrog of (1.20), integrated in the case");
    compare_spread();
    return verify_end();
}
