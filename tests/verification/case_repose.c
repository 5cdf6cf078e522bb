/* long */
/*
 * Spheres settle in a narrow box, then its gate is drawn up and they slide and roll out, over
 * the floor's edge, until a slope remains: the angle of repose, that of the wedge with the same
 * centre of mass.  It has no exact answer; what must hold is that neither it nor the height of
 * the settled bed depends on the step, from the automatic one down, and that both grow with
 * friction and rolling friction.  The box's sides are smooth, so they hold nothing up.
 *
 * Grains come to rest one way or another: the angle of one slope scatters by a degree or two,
 * and a step that differs may be another throw of the dice.  So some beds, which differ in
 * where and how they start, are each compared with themselves, and the mean of these
 * differences is judged by their scatter.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "model/sphere.h"
#include "run/simulation.h"
#include "verify.h"

enum { BEDS = 8, POINTS = 4 };

/* 99 % of Student's distribution with BEDS - 1 degrees of freedom. */
static const double STUDENT = 3.50;

#define RADIUS 0.01
static const double LENGTH = 0.28, SETTLED = 0.35, END = 1.25; /* [m], [s] */

struct beds {
    double height[BEDS]; /* twice that of the centres before the gate opens [mm] */
    double angle[BEDS];  /* of the slope that remains [degrees] */
    double step;         /* [s] */
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
        friction, rolling, RADIUS, 0.1 + 0.002 * bed, shift, SETTLED);
}

static double bed_height(const struct simulation *sim)
{
    double sum = 0.0;
    for (int i = 0; i < sim->spheres.n_owned; i++)
        sum += sphere_position(&sim->spheres, i)[2];
    return 2.0 * sum / sim->spheres.n_owned;
}

/* Slope of the wedge between floor and back that has the same centre of mass [degrees]. */
static double slope(const struct simulation *sim)
{
    double sx = 0.0, sz = 0.0;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double *x = sphere_position(&sim->spheres, i);
        const bool lies = x[0] < LENGTH && x[2] > 0.0; /* not on its way out */
        sx += lies ? x[0] : 0.0;
        sz += lies ? x[2] : 0.0;
    }
    return atan2(sz, sx) * 180.0 / M_PI;
}

/* Beds at this share of the automatic step. */
static struct beds settle_and_open(double friction, double rolling, double share)
{
    struct beds beds = {.step = 0.0};
    for (int k = 0; k < BEDS; k++) {
        char *text = describe(friction, rolling, k);
        beds.step = share * verify_automatic_step(text);
        struct simulation *sim = verify_scene(beds.step, "%s", text);
        free(text);
        verify_steps(sim, (int64_t)(SETTLED / beds.step + 0.5));
        beds.height[k] = 1e3 * bed_height(sim);
        verify_steps(sim, (int64_t)((END - SETTLED) / beds.step + 0.5));
        beds.angle[k] = slope(sim);
        verify_scene_free(sim);
    }
    return beds;
}

static double mean_of(const double values[BEDS])
{
    double sum = 0.0;
    for (int k = 0; k < BEDS; k++)
        sum += values[k];
    return sum / BEDS;
}

/* By how much the mean of the beds' differences may be off by chance. */
static double chance(const double a[BEDS], const double b[BEDS])
{
    const double mean = mean_of(b) - mean_of(a);
    double squares = 0.0;
    for (int k = 0; k < BEDS; k++)
        squares += (b[k] - a[k] - mean) * (b[k] - a[k] - mean);
    return STUDENT * sqrt(squares / (BEDS - 1) / BEDS);
}

static const char SCATTER[] =
    "99 % of Student's distribution, by the scatter of eight beds' differences";

/* Against the beds of the least step. */
static void compare_steps(const char *share, double step, const char *what, const char *unit,
                          const double fine[BEDS], const double other[BEDS], double floor)
{
    char name[128];
    snprintf(name, sizeof name, "%s, %.3g us: %s", share, 1e6 * step, what);
    verify_row(name, unit, mean_of(fine), mean_of(other), chance(fine, other) + floor,
               VERIFY_ABSOLUTE,
               "99 % of Student's distribution, by the scatter of eight beds' differences; "
               "and .1 mm, .2 degrees, of no weight");
}

/* A curve: no point below the one before, and the last above the first. */
static void compare_curve(const char *curve, const char *what, const char *unit,
                          const double x[POINTS], const double *const y[POINTS])
{
    char name[128];
    for (int k = 0; k < POINTS; k++) {
        snprintf(name, sizeof name, "%s %g: %s", curve, x[k], what);
        if (k == 0)
            verify_row(name, unit, 0.0, mean_of(y[0]), 0.0, VERIFY_AT_LEAST,
                       "where the curve begins");
        else
            verify_row(name, unit, mean_of(y[k - 1]), mean_of(y[k]), chance(y[k - 1], y[k]),
                       VERIFY_AT_LEAST, SCATTER);
    }
    snprintf(name, sizeof name, "%s %g less %g: %s", curve, x[POINTS - 1], x[0], what);
    verify_row(name, unit, chance(y[0], y[POINTS - 1]), mean_of(y[POINTS - 1]) - mean_of(y[0]),
               0.0, VERIFY_AT_LEAST, "more than chance does, as above");
}

static void compare_curves(const char *curve, const double x[POINTS],
                           const struct beds *const beds[POINTS])
{
    const double *heights[POINTS], *angles[POINTS];
    for (int k = 0; k < POINTS; k++) {
        heights[k] = beds[k]->height;
        angles[k] = beds[k]->angle;
    }
    compare_curve(curve, "height of the bed", "mm", x, heights);
    compare_curve(curve, "angle of repose", "deg", x, angles);
}

int main(int argc, char **argv)
{
    static const double frictions[POINTS] = {0.1, 0.3, 0.5, 0.8},
                        rollings[POINTS] = {0.0, 0.05, 0.1, 0.2};
    verify_begin(argc, argv, "Settled bed and angle of repose",
                 "the same at a quarter of the automatic step");
    struct beds steps[3];
    for (int k = 0; k < 3; k++)
        steps[k] = settle_and_open(0.5, 0.1, 1.0 / (1 << k));
    const struct beds *fine = &steps[2];
    for (int k = 0; k < 2; k++) {
        const char *share = k == 0 ? "the automatic step" : "half of it";
        compare_steps(share, steps[k].step, "height of the bed", "mm", fine->height,
                      steps[k].height, 0.1);
        compare_steps(share, steps[k].step, "angle of repose", "deg", fine->angle,
                      steps[k].angle, 0.2);
    }
    verify_row("what chance may do to the rows of height", "mm", 0.01 * mean_of(fine->height),
               chance(fine->height, steps[0].height), 0.0, VERIFY_AT_MOST,
               "a guard: a per cent is told from nothing");
    verify_row("what chance may do to the rows of the angle", "deg", 2.0,
               chance(fine->angle, steps[0].angle), 0.0, VERIFY_AT_MOST,
               "a guard: two degrees are told from nothing");
    verify_source("known direction: at least that of the point before");
    struct beds curve[2][POINTS];
    for (int k = 0; k < POINTS; k++) {
        curve[0][k] = k == 2 ? steps[0] : settle_and_open(frictions[k], 0.1, 1.0);
        curve[1][k] = k == 2 ? steps[0] : settle_and_open(0.5, rollings[k], 1.0);
    }
    compare_curves(
        "rolling friction .1, friction", frictions,
        (const struct beds *[]){&curve[0][0], &curve[0][1], &curve[0][2], &curve[0][3]});
    compare_curves(
        "friction .5, rolling friction", rollings,
        (const struct beds *[]){&curve[1][0], &curve[1][1], &curve[1][2], &curve[1][3]});
    return verify_end();
}
