/* long */
/*
 * What is at rest stays at rest.
 *
 * Twelve spheres of mixed sizes settle in a box and are watched for a million steps more: they
 * do not creep, and energy does not grow.
 *
 * A large sphere stands on three small ones on a plane.  A small one is pressed between plane
 * and large sphere, whose normals are an angle b apart (seen from its centre); as its own
 * weight is next to nothing, the two forces on it are one line, through both contacts, and so
 * off by b/2 from either normal: friction holds where mu > tan(b/2), at any ratio of sizes, and
 * below that the small ones are squeezed out.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "run/simulation.h"
#include "verify.h"

/* Largest way of a sphere since the places were taken [m]. */
static double way_since(const struct simulation *sim, int n, const struct vec3 *places)
{
    double most = 0.0;
    for (int id = 0; id < n; id++)
        most = fmax(most, vec3_norm(vec3_sub(verify_position(sim, id), places[id])));
    return most;
}

static void take_places(const struct simulation *sim, int n, struct vec3 *places)
{
    for (int id = 0; id < n; id++)
        places[id] = verify_position(sim, id);
}

static double motion_energy(const struct simulation *sim)
{
    return verify_series(sim, "kinetic_translation") + verify_series(sim, "kinetic_rotation");
}

static void settled_bed(const char *law, const char *more)
{
    enum { N = 12, BEFORE = 200000, WATCHED = 1000000 };
    char *text = array_format(
        "domain: {min: [-0.1, -0.1, -0.1], max: [0.1, 0.1, 0.2], leavers: ignore}\n"
        "output: {series: {every: 0.1}}\n"
        "materials:\n  stone: {density: 2500, young: 1.0e+7, poisson: 0.25}\n"
        "contact:\n  pairs:\n"
        "    - {between: [stone, stone], friction: 0.5, restitution: 0.5, rolling_friction: 0.05, "
        "twisting_friction: 0.05%s}\n"
        "spheres:\n"
        "  - {name: low, material: stone, radius: 0.01, velocity: [0.3, 0.2, 0], packing: "
        "{kind: lattice, count: 8, spacing: 0.021, corner: [-0.026, -0.026, 0], "
        "size: [0.043, 0.043]}}\n"
        "  - {name: high, material: stone, radius: 0.007, velocity: [-0.4, 0, -1], packing: "
        "{kind: lattice, count: 4, spacing: 0.021, corner: [-0.02, -0.021, 0.05], "
        "size: [0.043, 0.043]}}\n"
        "bodies:\n  - {name: box, material: stone, geometry: {kind: box, open: top, "
        "min: [-0.028, -0.028, 0], max: [0.028, 0.028, 0.2]}}\n",
        more);
    const double dt = verify_automatic_step(text);
    struct simulation *sim = verify_scene(dt, "%s", text);
    free(text);
    struct vec3 places[N];
    char name[128];
    sim->sample_every = 10000;
    verify_steps(sim, BEFORE);
    take_places(sim, N, places);
    const double weight = 2500.0 * 4.0 / 3.0 * M_PI * 1e-6 * 9.81;
    double moves = 0.0;
    for (int k = 0; k < WATCHED / 10000; k++) {
        verify_steps(sim, 10000);
        moves = fmax(moves, motion_energy(sim));
    }
    snprintf(name, sizeof name, "bed of %d, %s: creep in a million steps", N, law);
    verify_row(
        name, "m", 0.0, way_since(sim, N, places), 1e-13, VERIFY_AT_MOST,
        "rounding of a place, 1e-17 m a step, at random 1e-14, all spheres; overlaps are "
        "some 1e-6");
    snprintf(name, sizeof name,
             "bed of %d, %s: largest energy of motion then, over weight times radius", N, law);
    verify_row(name, "", 0.0, moves / (weight * 0.01), 1e-20, VERIFY_AT_MOST,
               "rest: speeds of 1e-16 R a step give 1e-22");
    verify_scene_free(sim);
}

/* The large sphere's fall in so many steps, and over as many more, over the gap under it. */
struct fall {
    double first, later;
};

static struct fall stand(double ratio, double angle, double friction)
{
    enum { STEPS = 200000 };
    const double small = 1e-3, large = ratio * small;
    const double out = (large + small) * sin(angle), up = small + (large + small) * cos(angle);
    const struct vec3 zero = {0.0, 0.0, 0.0};
    char *spheres =
        verify_sphere("large", "stone", large, (struct vec3){0.0, 0.0, up}, zero, zero);
    for (int k = 0; k < 3; k++) {
        const double turn = 2.0 * M_PI / 3.0 * k + 0.3;
        char name[16];
        snprintf(name, sizeof name, "small_%d", k);
        char *one =
            verify_sphere(name, "stone", small,
                          (struct vec3){out * cos(turn), out * sin(turn), small}, zero, zero);
        char *longer = array_format("%s%s", spheres, one);
        free(one);
        free(spheres);
        spheres = longer;
    }
    char *text = array_format(
        "domain: {min: [-0.1, -0.1, -0.01], max: [0.1, 0.1, 0.1], leavers: ignore}\n"
        "output: {series: {every: 1.0e+9}}\ndamping: 300\n"
        "materials:\n  stone: {density: 2500, young: 1.0e+9, poisson: 0.25}\n"
        "contact:\n  pairs:\n"
        "    - {between: [stone, stone], friction: %.17g, restitution: 0.5}\n"
        "spheres:\n%sbodies:\n  - {name: plane, material: stone, geometry: {kind: plane, "
        "point: [0, 0, 0], normal: [0, 0, 1], extent: 0.4}}\n",
        friction, spheres);
    free(spheres);
    struct simulation *sim = verify_scene(0.5 * verify_automatic_step(text), "%s", text);
    free(text);
    verify_steps(sim, STEPS);
    const double then = verify_position(sim, 0).z;
    verify_steps(sim, STEPS);
    const double gap = up - large;
    const struct fall fall = {(up - then) / gap, (then - verify_position(sim, 0).z) / gap};
    verify_scene_free(sim);
    return fall;
}

static void compare_stand(double ratio)
{
    const double angle = 20.0 * M_PI / 180.0, needed = tan(0.5 * angle);
    char name[128];
    const struct fall holds = stand(ratio, angle, 1.2 * needed),
                      slips = stand(ratio, angle, 0.85 * needed);
    snprintf(name, sizeof name,
             "1:%g, friction 1.2 of what holds: creep in 2e5 steps, over the gap under it",
             ratio);
    verify_row(name, "", 0.0, fabs(holds.later), 1e-9, VERIFY_AT_MOST,
               "held; a millionth of the overlap");
    snprintf(name, sizeof name,
             "1:%g, friction .85 of what holds: fall in as many steps, over the gap under it",
             ratio);
    verify_row(name, "", 1.0, slips.first + slips.later, 0.01, VERIFY_ABSOLUTE,
               "it lies on the plane; overlaps");
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "At rest", "equilibrium");
    settled_bed("Hertz", "");
    settled_bed("linear", ", law: linear, stiffness: 1.0e+4");
    verify_source("statics: mu > tan(b/2)");
    compare_stand(3.0);
    compare_stand(8.0);
    compare_stand(20.0);
    return verify_end();
}
