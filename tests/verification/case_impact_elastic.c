/*
 * Elastic impacts, head on: Hertz's closed forms for the largest overlap, its force and how
 * long surfaces touch, for two spheres and for a sphere on a plane, also of unlike materials
 * and sizes.
 */
#include <stdio.h>

#include "impact.h"
#include "verify.h"

static const struct impact_solid glass = {48e9, 0.20, 2800.0}, limestone = {20e9, 0.25, 2500.0},
                                 aluminium = {70e9, 0.30, 2699.0},
                                 magnesium = {40e9, 0.35, 1800.0},
                                 oxide = {380e9, 0.23, 4000.0};

/* Aluminium oxide on a rigid plane, against numbers that others computed from Hertz's forms. */
static void compare_numbers(void)
{
    static const char why[] =
        "five digits; the plane's 1e15 Pa instead of none yields, .4 of 3.6e-4";
    struct impact impact = {.solid = {&oxide, &impact_rigid},
                            .restitution = 1.0,
                            .radius = {2.5e-3, 0.0},
                            .velocity = {{0.0, 0.0, -3.9}},
                            .phase = 0.5};
    impact.dt = impact_hertz(&impact).duration / 2000.0;
    const struct impact_result result = impact_run(&impact);
    verify_row("aluminium oxide on a rigid plane: largest overlap", "um", 8.0888,
               1e6 * result.overlap_max, 1.6e-4, VERIFY_RELATIVE, why);
    verify_row("aluminium oxide on a rigid plane: largest force", "N", 615.35, result.force_max,
               1.6e-4, VERIFY_RELATIVE, why);
    verify_row("aluminium oxide on a rigid plane: duration", "us", 6.1045,
               1e6 * result.duration, 1.6e-4, VERIFY_RELATIVE, why);
}

/* One impact at `speed` between the two surfaces; radius_b 0: a plane. */
static void compare(const char *name, const struct impact_solid *a, double radius_a,
                    const struct impact_solid *b, double radius_b, double speed)
{
    char quantity[128];
    static const char why[] = "leapfrog at 2000 steps a contact: (pi/2000)^2, 2.5e-6, twice "
                              "for the entry";
    const double share = radius_b > 0.0 ? 0.5 : 0.0; /* of the speed that the second has */
    struct impact impact = {
        .solid = {a, b},
        .restitution = 1.0,
        .radius = {radius_a, radius_b},
        .velocity = {{0.0, 0.0, -(1.0 - share) * speed}, {0.0, 0.0, share * speed}},
        .phase = 0.5};
    const struct impact_hertz hertz = impact_hertz(&impact);
    impact.dt = hertz.duration / 2000.0;
    const struct impact_result result = impact_run(&impact);
    snprintf(quantity, sizeof quantity, "%s: largest overlap", name);
    verify_row(quantity, "um", 1e6 * hertz.overlap, 1e6 * result.overlap_max, 5e-6,
               VERIFY_RELATIVE, why);
    snprintf(quantity, sizeof quantity, "%s: largest force", name);
    verify_row(quantity, "N", hertz.force, result.force_max, 5e-6, VERIFY_RELATIVE, why);
    snprintf(quantity, sizeof quantity, "%s: duration", name);
    verify_row(quantity, "us", 1e6 * hertz.duration, 1e6 * result.duration, 5e-6,
               VERIFY_RELATIVE, why);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Elastic impact, head on",
                 "Hertz, (1.25); set-up: Chung and Ooi 2011, case 1");
    compare("glass on glass", &glass, 0.01, &glass, 0.01, 20.0);
    compare("limestone on limestone", &limestone, 0.01, &limestone, 0.01, 20.0);
    verify_source("Hertz, (1.25); set-up: Chung and Ooi 2011, case 2");
    compare("aluminium alloy on a rigid plane", &aluminium, 0.1, &impact_rigid, 0.0, 0.2);
    compare("magnesium alloy on a rigid plane", &magnesium, 0.1, &impact_rigid, 0.0, 0.2);
    verify_source("Hertz, numbers of Chung and Ooi 2011, case 3");
    compare_numbers();
    verify_source("Hertz, (1.25)");
    compare("glass on limestone", &glass, 0.01, &limestone, 0.01, 2.0);
    compare("glass on a sphere of limestone 20 times as large", &glass, 0.001, &limestone, 0.02,
            2.0);
    compare("limestone on a sphere of glass 20 times as small", &limestone, 0.02, &glass, 0.001,
            2.0);
    compare("glass on a plane of aluminium alloy", &glass, 0.01, &aluminium, 0.0, 2.0);
    return verify_end();
}
