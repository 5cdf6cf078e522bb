/* long */
/*
 * Spheres settle in a narrow box, then its gate is drawn up and they slide and roll out until a
 * slope remains: the angle of repose.  It has no exact answer; what must hold is that neither
 * it nor the height of the settled bed depends on the step, from the automatic one down, and
 * that both grow with friction and rolling friction.  The box's sides are smooth, so they hold
 * nothing up.
 *
 * Grains come to rest one way or another: the angle of one slope scatters by a degree or two,
 * and a step that differs is another throw of the dice.  So means over some beds, which differ
 * in where they start, are compared by how much the beds scatter.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "model/sphere.h"
#include "run/simulation.h"
#include "verify.h"

enum { BINS = 10, LANES = 4, BEDS = 12 };

/* 99 % of Student's distribution with 2 (BEDS - 1) degrees of freedom. */
static const double STUDENT = 2.82;

#define RADIUS 0.01
static const double LENGTH = 0.28, WIDTH = 0.088, SETTLED = 0.35, END = 1.4; /* [m], [s] */

/* A quantity's mean over the beds and the variance of that mean. */
struct mean {
    double value, variance;
};

struct beds {
    struct mean height; /* twice that of the centres before the gate opens [m] */
    struct mean angle;  /* of the slope that remains [degrees] */
    double step;        /* [s] */
};

static char *describe(double friction, double rolling, int bed)
{
    const double shift = 0.0003 * (bed + 1);
    return array_format(
        "domain: {min: [-0.1, -0.1, -0.1], max: [0.5, 0.2, 0.6], leavers: remove}\n"
        "materials:\n  grain: {density: 2500, young: 4.0e+6, poisson: 0.25}\n"
        "  smooth: {density: 2500, young: 4.0e+6, poisson: 0.25}\n"
        "contact:\n  pairs:\n"
        "    - {between: [grain, grain], friction: %g, restitution: 0.4, rolling_friction: %g}\n"
        "    - {between: [grain, smooth], friction: 0, restitution: 0.4}\n"
        "spheres:\n"
        "  - {name: grains, material: grain, radius: %g, velocity: [%g, 0.07, 0], packing: "
        "{kind: lattice, count: 450, spacing: 0.0212, corner: [%g, 0.001, 0.001], "
        "size: [0.276, 0.0866]}}\n"
        "bodies:\n"
        "  - {name: floor, material: grain, geometry: {kind: plane, point: [0.14, 0.044, 0], "
        "normal: [0, 0, 1], extent: 0.28}}\n"
        "  - {name: back, material: grain, geometry: {kind: plane, point: [0, 0.044, 0.4], "
        "normal: [1, 0, 0], extent: 0.8}}\n"
        "  - {name: sides, material: smooth, geometry: {kind: box, open: [top, bottom, x_min, "
        "x_max], min: [-0.05, 0, -0.1], max: [0.6, 0.088, 0.8]}}\n"
        "  - {name: gate, material: smooth, geometry: {kind: plane, point: [0.28, 0.044, 0.39], "
        "normal: [1, 0, 0], extent: 0.8}, motion: {velocity: [0, 0, 2], start: %g}}\n",
        friction, rolling, RADIUS, 0.01 * bed, shift, SETTLED);
}

static double bed_height(const struct simulation *sim)
{
    double sum = 0.0;
    for (int i = 0; i < sim->spheres.n_owned; i++)
        sum += sphere_position(&sim->spheres, i)[2];
    return 2.0 * sum / sim->spheres.n_owned;
}

/* Slope of the straight line through the highest spheres of columns over the floor, as far as
 * more than two layers lie there [degrees]. */
static double slope(const struct simulation *sim)
{
    double height[BINS * LANES] = {0.0}, n = 0.0, sx = 0.0, sz = 0.0, sxx = 0.0, sxz = 0.0;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double *x = sphere_position(&sim->spheres, i);
        const int b = (int)(x[0] / LENGTH * BINS), lane = (int)(x[1] / WIDTH * LANES);
        if (b < 0 || b >= BINS || lane < 0 || lane >= LANES)
            continue;
        double *top = &height[b * LANES + lane];
        *top = x[2] + RADIUS > *top ? x[2] + RADIUS : *top;
    }
    for (int k = 0; k < BINS * LANES; k++) {
        const double x = (k / LANES + 0.5) * LENGTH / BINS, z = height[k];
        if (z < 5.0 * RADIUS)
            continue;
        n += 1.0;
        sx += x;
        sz += z;
        sxx += x * x;
        sxz += x * z;
    }
    return n < 9.0 ? 0.0 : -atan((n * sxz - sx * sz) / (n * sxx - sx * sx)) * 180.0 / M_PI;
}

static struct mean mean_of(const double values[BEDS])
{
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < BEDS; k++)
        sum += values[k];
    for (int k = 0; k < BEDS; k++)
        squares += (values[k] - sum / BEDS) * (values[k] - sum / BEDS);
    return (struct mean){sum / BEDS, squares / (BEDS - 1) / BEDS};
}

/* Beds at this share of the automatic step. */
static struct beds settle_and_open(double friction, double rolling, double share)
{
    double height[BEDS], angle[BEDS];
    struct beds beds = {.step = 0.0};
    for (int k = 0; k < BEDS; k++) {
        char *text = describe(friction, rolling, k);
        beds.step = share * verify_automatic_step(text);
        struct simulation *sim = verify_scene(beds.step, "%s", text);
        free(text);
        verify_steps(sim, (int64_t)(SETTLED / beds.step + 0.5));
        height[k] = bed_height(sim);
        verify_steps(sim, (int64_t)((END - SETTLED) / beds.step + 0.5));
        angle[k] = slope(sim);
        verify_scene_free(sim);
    }
    beds.height = mean_of(height);
    beds.angle = mean_of(angle);
    return beds;
}

/* By how much two means may differ by chance. */
static double chance(const struct mean *a, const struct mean *b)
{
    return STUDENT * sqrt(a->variance + b->variance);
}

static const char SCATTER[] =
    "99 % of Student's distribution, by the scatter of twelve beds each";

/* Against the beds of the least step. */
static void compare_steps(const struct beds *fine, const struct beds *other, const char *share)
{
    char name[128];
    snprintf(name, sizeof name, "%s, %.3g us: height of the bed", share, 1e6 * other->step);
    verify_row(name, "mm", 1e3 * fine->height.value, 1e3 * other->height.value,
               1e3 * chance(&fine->height, &other->height), VERIFY_ABSOLUTE, SCATTER);
    snprintf(name, sizeof name, "%s, %.3g us: angle of repose", share, 1e6 * other->step);
    verify_row(name, "deg", fine->angle.value, other->angle.value,
               chance(&fine->angle, &other->angle), VERIFY_ABSOLUTE, SCATTER);
}

/* A curve: no point below the one before, and the last above the first. */
static void compare_curve(const char *what, int n, const double *x, const struct beds *const *y)
{
    static const struct beds nothing = {.step = 0.0};
    char name[128];
    for (int k = 0; k < n; k++) {
        const struct beds *before = k > 0 ? y[k - 1] : &nothing;
        const char *why = k > 0 ? SCATTER : "no answer: where the curve begins";
        snprintf(name, sizeof name, "%s %g: height of the bed", what, x[k]);
        verify_row(name, "mm", 1e3 * before->height.value, 1e3 * y[k]->height.value,
                   k > 0 ? 1e3 * chance(&before->height, &y[k]->height) : 0.0, VERIFY_AT_LEAST,
                   why);
        snprintf(name, sizeof name, "%s %g: angle of repose", what, x[k]);
        verify_row(name, "deg", before->angle.value, y[k]->angle.value,
                   k > 0 ? chance(&before->angle, &y[k]->angle) : 0.0, VERIFY_AT_LEAST, why);
    }
    const struct beds *first = y[0], *last = y[n - 1];
    snprintf(name, sizeof name, "%s %g less %g: height of the bed", what, x[n - 1], x[0]);
    verify_row(name, "mm", 1e3 * chance(&first->height, &last->height),
               1e3 * (last->height.value - first->height.value), 0.0, VERIFY_AT_LEAST,
               "more than by chance, see above");
    snprintf(name, sizeof name, "%s %g less %g: angle of repose", what, x[n - 1], x[0]);
    verify_row(name, "deg", chance(&first->angle, &last->angle),
               last->angle.value - first->angle.value, 0.0, VERIFY_AT_LEAST,
               "more than by chance, see above");
}

int main(int argc, char **argv)
{
    static const double frictions[] = {0.1, 0.3, 0.5, 0.8}, rollings[] = {0.0, 0.05, 0.1, 0.2};
    verify_begin(argc, argv, "Settled bed and angle of repose",
                 "the same at a quarter of the automatic step");
    const struct beds automatic = settle_and_open(0.5, 0.1, 1.0);
    const struct beds half = settle_and_open(0.5, 0.1, 0.5);
    const struct beds quarter = settle_and_open(0.5, 0.1, 0.25);
    compare_steps(&quarter, &automatic, "automatic step");
    compare_steps(&quarter, &half, "half of it");
    verify_row("half a per cent of the height against what chance may do to two means", "mm",
               5.0 * quarter.height.value, 1e3 * chance(&quarter.height, &automatic.height),
               0.0, VERIFY_AT_MOST, "a guard: the rows above are sharp");
    verify_row("three degrees against what chance may do to two means", "deg", 3.0,
               chance(&quarter.angle, &automatic.angle), 0.0, VERIFY_AT_MOST,
               "a guard: the rows above are sharp");
    verify_source("known direction: at least that of the point before");
    const struct beds at_1 = settle_and_open(frictions[0], 0.1, 1.0),
                      at_3 = settle_and_open(frictions[1], 0.1, 1.0),
                      at_8 = settle_and_open(frictions[3], 0.1, 1.0);
    compare_curve("rolling friction .1, friction", 4, frictions,
                  (const struct beds *[]){&at_1, &at_3, &automatic, &at_8});
    const struct beds round = settle_and_open(0.5, rollings[0], 1.0),
                      little = settle_and_open(0.5, rollings[1], 1.0),
                      rough = settle_and_open(0.5, rollings[3], 1.0);
    compare_curve("friction .5, rolling friction", 4, rollings,
                  (const struct beds *[]){&round, &little, &automatic, &rough});
    return verify_end();
}
