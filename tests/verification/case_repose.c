/* long */
/*
 * Spheres settle in a narrow box, then its gate is drawn up and they slide and roll out until a
 * slope remains: the angle of repose.  It has no exact answer; what must hold is that neither
 * it nor the height of the settled bed depends on the step, and that friction and rolling
 * friction make it steeper.  The box's sides are smooth, so they hold nothing up.
 *
 * Grains come to rest one way or another: the angle of one slope scatters by a degree or two,
 * and a step that differs is another throw of the dice.  Three beds, which differ in a tenth of
 * a radius of where they start, are averaged.
 */
#include <math.h>
#include <stdio.h>

#include "model/sphere.h"
#include "run/simulation.h"
#include "verify.h"

enum { BINS = 12, BEDS = 3 };

#define RADIUS 0.01
static const double LENGTH = 0.36, SETTLED = 0.4, END = 1.6; /* [m], [s] */

struct bed {
    double height; /* mean of the surface before the gate opens [m] */
    double angle;  /* of the slope that remains [degrees] */
};

static struct simulation *box(double dt, double friction, double rolling, double shift)
{
    return verify_scene(
        dt,
        "domain: {min: [-0.1, -0.1, -0.1], max: [0.5, 0.2, 1], leavers: remove}\n"
        "materials:\n  grain: {density: 2500, young: 4.0e+7, poisson: 0.25}\n"
        "  smooth: {density: 2500, young: 4.0e+7, poisson: 0.25}\n"
        "contact:\n  pairs:\n"
        "    - {between: [grain, grain], friction: %g, restitution: 0.4, rolling_friction: %g}\n"
        "    - {between: [grain, smooth], friction: 0, restitution: 0.4}\n"
        "spheres:\n"
        "  - {name: grains, material: grain, radius: %g, velocity: [0.1, 0.07, 0], packing: "
        "{kind: lattice, count: 900, spacing: 0.0215, corner: [%g, 0.001, 0.001], "
        "size: [0.35, 0.087]}}\n"
        "bodies:\n"
        "  - {name: floor, material: grain, geometry: {kind: plane, point: [0.18, 0.044, 0], "
        "normal: [0, 0, 1], extent: 0.36}}\n"
        "  - {name: back, material: grain, geometry: {kind: plane, point: [0, 0.044, 0.4], "
        "normal: [1, 0, 0], extent: 0.8}}\n"
        "  - {name: sides, material: smooth, geometry: {kind: box, open: [top, bottom, x_min, "
        "x_max], min: [-0.05, 0, -0.1], max: [0.6, 0.088, 0.8]}}\n"
        "  - {name: gate, material: smooth, geometry: {kind: plane, point: [0.36, 0.044, 0.39], "
        "normal: [1, 0, 0], extent: 0.8}, motion: {velocity: [0, 0, 2], start: %g}}\n",
        friction, rolling, RADIUS, shift, SETTLED);
}

/* Height of the surface over stretches of the box's length [m]. */
static void surface(const struct simulation *sim, double height[BINS])
{
    for (int b = 0; b < BINS; b++)
        height[b] = 0.0;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double *x = sphere_position(&sim->spheres, i);
        const int b = (int)(x[0] / LENGTH * BINS);
        const double top = x[2] + RADIUS;
        if (b >= 0 && b < BINS && top > height[b])
            height[b] = top;
    }
}

/* Slope of the straight line through the surface where more than two layers lie [degrees]. */
static double slope(const double height[BINS])
{
    double n = 0.0, sx = 0.0, sz = 0.0, sxx = 0.0, sxz = 0.0;
    for (int b = 0; b < BINS; b++) {
        const double x = (b + 0.5) * LENGTH / BINS, z = height[b];
        if (z < 5.0 * RADIUS)
            continue;
        n += 1.0;
        sx += x;
        sz += z;
        sxx += x * x;
        sxz += x * z;
    }
    return n < 3.0 ? 0.0 : -atan((n * sxz - sx * sz) / (n * sxx - sx * sx)) * 180.0 / M_PI;
}

static struct bed settle_and_open(double dt, double friction, double rolling)
{
    struct bed mean = {0.0, 0.0};
    for (int k = 0; k < BEDS; k++) {
        double height[BINS];
        struct simulation *sim = box(dt, friction, rolling, 0.002 + 0.001 * k);
        verify_steps(sim, (int64_t)(SETTLED / dt + 0.5));
        surface(sim, height);
        for (int b = 0; b < BINS; b++)
            mean.height += height[b] / BINS / BEDS;
        verify_steps(sim, (int64_t)((END - SETTLED) / dt + 0.5));
        surface(sim, height);
        mean.angle += slope(height) / BEDS;
        verify_scene_free(sim);
    }
    return mean;
}

static void compare_steps(const struct bed *fine, const struct bed *other, double dt)
{
    char name[128];
    snprintf(name, sizeof name, "height of the bed, steps of %g us", 1e6 * dt);
    verify_row(name, "m", fine->height, other->height, 0.02, VERIFY_RELATIVE,
               "a third of a layer: the surface is read off single spheres");
    snprintf(name, sizeof name, "angle of repose, steps of %g us", 1e6 * dt);
    verify_row(name, "deg", fine->angle, other->angle, 3.0, VERIFY_ABSOLUTE,
               "scatter of a mean of three slopes");
}

static void compare_friction(const char *name, const struct bed *less, const struct bed *more)
{
    verify_row(name, "deg", -3.0, less->angle - more->angle, 0.0, VERIFY_AT_MOST,
               "known direction, by more than the scatter");
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Settled bed and angle of repose", "fine step, known direction");
    const struct bed fine = settle_and_open(2e-5, 0.5, 0.1);
    const struct bed half = settle_and_open(4e-5, 0.5, 0.1);
    const struct bed automatic = settle_and_open(8e-5, 0.5, 0.1);
    compare_steps(&fine, &half, 4e-5);
    compare_steps(&fine, &automatic, 8e-5);
    const struct bed slippery = settle_and_open(8e-5, 0.1, 0.1);
    const struct bed round = settle_and_open(8e-5, 0.5, 0.0);
    const struct bed rough = settle_and_open(8e-5, 0.5, 0.3);
    compare_friction("angle at friction .1 less that at .5", &slippery, &automatic);
    compare_friction("angle without rolling friction less that at .1", &round, &automatic);
    compare_friction("angle at rolling friction 0 less that at .3", &round, &rough);
    verify_row("height of the bed at friction .1 less that at .5", "m", 0.0,
               slippery.height - automatic.height, 0.0, VERIFY_AT_MOST,
               "known direction: friction keeps pores open");
    return verify_end();
}
