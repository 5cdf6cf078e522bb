/*
 * The linear law: a contact is an oscillator, so all is known.
 *
 * With k_n the stiffness, m the effective mass, w = sqrt(k_n/m) and the damping ratio zeta,
 * the contact that cannot pull returns e = exp(-zeta/sqrt(1 - zeta^2) (pi - 2 asin zeta)) and
 * lets go after w t = (pi - 2 asin zeta)/sqrt(1 - zeta^2); what it is then still pressed in, 2
 * zeta e v/w, it comes out by itself.  The restitution that is asked for here is that e, for
 * the zeta that would return .9, .8, .5 and .2 if contacts pulled.
 *
 * Without damping or sliding the tangential spring is an oscillator too, with 7/2 k_t/m on a
 * plane: the patch comes back at -cos(pi sqrt(3.5 k_t/k_n)) of the speed it came with.
 */
#include <math.h>
#include <stdio.h>

#include "impact.h"
#include "verify.h"

enum { STEPS = 2000, PHASES = 16 };

static const struct impact_solid stone = {7e10, 0.25, 2500.0}; /* the density matters alone */
static const double RADIUS = 0.01, STIFFNESS = 1e6, SPEED = 0.01;
static const char LEAPFROG[] = "(pi/2000)^2, 2.5e-6: leapfrog at 2000 steps a contact";

/* An impact on a plane, `steps` to an undamped one; *rate becomes w [1/s]. */
static struct impact_result strike(double friction, double restitution, double ratio,
                                   double v_t, int steps, double phase, double *rate)
{
    char more[128];
    snprintf(more, sizeof more, ", law: linear, stiffness: %.17g, tangential_ratio: %.17g",
             STIFFNESS, ratio);
    *rate = sqrt(STIFFNESS / impact_mass(&stone, RADIUS));
    const struct impact impact = {.solid = {&stone, &stone},
                                  .friction = friction,
                                  .restitution = restitution,
                                  .more = more,
                                  .radius = {RADIUS, 0.0},
                                  .velocity = {{v_t, 0.0, -SPEED}},
                                  .dt = M_PI / *rate / (steps + 0.3), /* no whole number */
                                  .phase = phase};
    return impact_run(&impact);
}

static void compare_damped(void)
{
    static const double pulling[] = {1.0, 0.9, 0.8, 0.5, 0.2};
    for (int k = 0; k < 5; k++) {
        const double loss = log(1.0 / pulling[k]);
        const double zeta = loss / sqrt(M_PI * M_PI + loss * loss);
        const double turned = sqrt(1.0 - zeta * zeta);
        const double lets_go = (M_PI - 2.0 * asin(zeta)) / turned;
        const double e = exp(-zeta * lets_go), deepest = exp(-zeta / turned * acos(zeta));
        double out = 0.0, depth = 0.0, pushed = 0.0, touched = 0.0, rate = 0.0;
        char name[96];
        for (int p = 0; p < PHASES; p++) {
            const struct impact_result result =
                strike(0.0, e, 2.0 / 7.0, 0.0, STEPS, (p + 0.5) / PHASES, &rate);
            out += result.velocity[0].z / SPEED / PHASES;
            depth += result.overlap_max * rate / SPEED / PHASES;
            pushed += result.pushed * rate / PHASES;
            touched += result.duration * rate / PHASES;
        }
        snprintf(name, sizeof name, "asked for %.4f (zeta %.6f): restitution", e, zeta);
        verify_row(name, "", e, out, 1e-5, VERIFY_ABSOLUTE, LEAPFROG);
        snprintf(name, sizeof name, "asked for %.4f: largest overlap, w/v", e);
        verify_row(name, "", deepest, depth, 1e-5, VERIFY_RELATIVE, LEAPFROG);
        snprintf(name, sizeof name, "asked for %.4f: force ends at w t", e);
        verify_row(name, "", lets_go, pushed, M_PI / STEPS, VERIFY_ABSOLUTE,
                   "one step, pi/2000");
        snprintf(name, sizeof name, "asked for %.4f: surfaces part at w t", e);
        verify_row(name, "", lets_go + 2.0 * zeta, touched, 1e-4, VERIFY_RELATIVE,
                   "as the restitution, by which it drifts out");
    }
}

static void compare_tangential(void)
{
    static const double ratios[] = {2.0 / 7.0, 0.5, 0.7, 0.8, 1.0};
    for (int k = 0; k < 5; k++) {
        double out = 0.0, rate;
        char name[96];
        /* So little that mu 100 holds it for all but 1e-5 of the contact. */
        const double v_t = 1e-3 * SPEED;
        const double turn = M_PI * sqrt(3.5 * ratios[k]) / STEPS; /* of the patch, a step */
        for (int p = 0; p < PHASES; p++) {
            const struct impact_result result =
                strike(100.0, 1.0, ratios[k], v_t, STEPS, (p + 0.5) / PHASES, &rate);
            out += (result.velocity[0].x - RADIUS * result.spin[0].y) / v_t / PHASES;
        }
        snprintf(name, sizeof name, "k_t/k_n %.4f: patch speed after over before", ratios[k]);
        verify_row(
            name, "", cos(M_PI * sqrt(3.5 * ratios[k])), out, turn * turn + 5e-5,
            VERIFY_ABSOLUTE,
            "second order in what a step turns the patch's phase, and sliding at the ends");
    }
}

/* Mean and scatter over the phase, at 100 steps a contact, twice and four times as many. */
static void compare_orders(void)
{
    double elastic[3], damped[3], mean[3], patch[3];
    for (int l = 0; l < 3; l++) {
        double rate, sums[4] = {0.0, 0.0, 0.0, 0.0};
        patch[l] = 0.0;
        for (int p = 0; p < PHASES; p++) {
            const double phase = (p + 0.5) / PHASES;
            const struct impact_result whole =
                strike(100.0, 1.0, 0.7, 1e-3 * SPEED, 100 << l, phase, &rate);
            const struct impact_result half =
                strike(0.0, 0.5, 0.7, 0.0, 100 << l, phase, &rate);
            const double e = whole.velocity[0].z / SPEED - 1.0,
                         d = half.velocity[0].z / SPEED - 0.5;
            sums[0] += e / PHASES;
            sums[1] += e * e / PHASES;
            sums[2] += d / PHASES;
            sums[3] += d * d / PHASES;
            patch[l] += (whole.velocity[0].x - RADIUS * whole.spin[0].y) / PHASES;
        }
        elastic[l] = sqrt(sums[1] - sums[0] * sums[0]);
        damped[l] = sqrt(sums[3] - sums[2] * sums[2]);
        mean[l] = fabs(sums[2]);
    }
    static const char why[] = "the next order at a hundred steps a contact";
    verify_source("p + 1 for a force that begins as overlap^p");
    verify_row("order: elastic, scatter of the restitution over the phase", "", 2.0,
               0.5 * log2(elastic[0] / elastic[2]), 0.1, VERIFY_ABSOLUTE, why);
    verify_row("order: restitution .5, scatter over the phase", "", 1.0,
               0.5 * log2(damped[0] / damped[2]), 0.1, VERIFY_ABSOLUTE, why);
    verify_source("central differences");
    verify_row("order: restitution .5, mean error", "", 2.0, 0.5 * log2(mean[0] / mean[2]), 0.1,
               VERIFY_ABSOLUTE, why);
    verify_source("the tangential spring lets go within a step");
    verify_row("one less the order: patch speed, k_t/k_n .7, no sliding", "", 0.0,
               1.0 - log2(fabs((patch[1] - patch[0]) / (patch[2] - patch[1]))), 0.1,
               VERIFY_AT_MOST, "first order at the least");
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Linear law", "oscillator that cannot pull");
    compare_damped();
    verify_source("-cos(pi sqrt(3.5 k_t/k_n)), as a rebound");
    compare_tangential();
    compare_orders();
    return verify_end();
}
