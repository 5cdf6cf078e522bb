/*
 * Elastic impacts, head on: Hertz's closed forms for the largest overlap, its force and how
 * long surfaces touch, for two spheres and for a sphere on a plane, also of unlike materials
 * and sizes.
 */
#include <stdio.h>

#include "impact.h"
#include "verify.h"

struct solid {
    const char *name;
    double young, poisson, density;
};

static const struct solid glass = {"glass", 48e9, 0.20, 2800.0},
                          limestone = {"limestone", 20e9, 0.25, 2500.0},
                          aluminium = {"aluminium", 70e9, 0.30, 2699.0},
                          magnesium = {"magnesium", 40e9, 0.35, 1800.0},
                          rigid = {"rigid", 1e15, 0.30, 7850.0}; /* as stiff as jobs may say */

/* Materials and all pairs of them: as far as the job knows, spheres of one kind may meet. */
static const char *materials_of(char *text, size_t size, const struct solid *a,
                                const struct solid *b)
{
    static const char material[] = "  %s: {density: %.17g, young: %.17g, poisson: %g}\n";
    static const char pair[] = "    - {between: [%s, %s], friction: 0, restitution: 1}\n";
    char *end = text + size, *at = text;
    at += snprintf(at, (size_t)(end - at), "materials:\n");
    at += snprintf(at, (size_t)(end - at), material, a->name, a->density, a->young, a->poisson);
    if (a != b)
        at += snprintf(at, (size_t)(end - at), material, b->name, b->density, b->young,
                       b->poisson);
    at += snprintf(at, (size_t)(end - at), "contact:\n  pairs:\n");
    at += snprintf(at, (size_t)(end - at), pair, a->name, b->name);
    if (a != b) {
        at += snprintf(at, (size_t)(end - at), pair, a->name, a->name);
        snprintf(at, (size_t)(end - at), pair, b->name, b->name);
    }
    return text;
}

/* One impact at `speed` between the two surfaces; radius_b 0: a plane. */
static void compare(const char *name, const struct solid *a, double radius_a,
                    const struct solid *b, double radius_b, double speed)
{
    char text[1024], quantity[128];
    static const char why[] = "leapfrog at 2000 steps a contact: (pi/2000)^2, 2.5e-6, twice "
                              "for the entry";
    const double mass_a = impact_mass(a->density, radius_a);
    const double inverse_mass =
        1.0 / mass_a + (radius_b > 0.0 ? 1.0 / impact_mass(b->density, radius_b) : 0.0);
    const double radius = 1.0 / (1.0 / radius_a + (radius_b > 0.0 ? 1.0 / radius_b : 0.0));
    const struct impact_hertz hertz =
        impact_hertz(impact_modulus(a->young, a->poisson, b->young, b->poisson), radius,
                     1.0 / inverse_mass, speed);
    const double share = radius_b > 0.0 ? 0.5 : 0.0; /* of the speed that the second has */
    const struct impact impact = {
        .rest = materials_of(text, sizeof text, a, b),
        .material = {a->name, b->name},
        .radius = {radius_a, radius_b},
        .velocity = {{0.0, 0.0, -(1.0 - share) * speed}, {0.0, 0.0, share * speed}},
        .dt = hertz.duration / 2000.0,
        .phase = 0.5};
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
    compare("aluminium alloy on a rigid plane", &aluminium, 0.1, &rigid, 0.0, 0.2);
    compare("magnesium alloy on a rigid plane", &magnesium, 0.1, &rigid, 0.0, 0.2);
    verify_source("Hertz, (1.25)");
    compare("glass on limestone", &glass, 0.01, &limestone, 0.01, 2.0);
    compare("glass on a sphere of limestone 20 times as large", &glass, 0.001, &limestone, 0.02,
            2.0);
    compare("limestone on a sphere of glass 20 times as small", &limestone, 0.02, &glass, 0.001,
            2.0);
    compare("glass on a plane of aluminium alloy", &glass, 0.01, &aluminium, 0.0, 2.0);
    return verify_end();
}
