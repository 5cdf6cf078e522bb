/*
 * A smooth cylinder that is cut into triangles, seen from within: as stiff at a seam as in the
 * middle of a facet, and nearer to the smooth one with the square of the number of segments.
 *
 * With r the circle of the sphere's centre and a = 2 pi / n the segment, a facet's middle is
 * deeper than its border by the sagitta r (1 - cos(a/2)), about r a^2 / 8.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "impact.h"
#include "run/simulation.h"
#include "surface.h"
#include "verify.h"

enum { PLACES = 97 };

static const double pi = 3.14159265358979323846;
static const double radius = 0.05, drum = 0.25; /* [m] */
static const struct impact_solid ore = {.young = 5e7, .poisson = 0.25, .density = 2400.0};

static double hertz(double overlap)
{
    return 4.0 / 3.0 * impact_modulus(&ore, &impact_rigid) * sqrt(radius) * overlap *
           sqrt(overlap);
}

/* A scene without gravity of spheres in a drum of n segments about the z axis. */
static struct simulation *scene(double dt, int n, double length, double friction,
                                const char *spheres)
{
    const struct surface surface = {
        .radius = {drum, drum}, .z = {-length, length}, .n_around = n, .n_rings = 1};
    char *body = surface_body("drum", "wall", &surface);
    struct simulation *sim = verify_scene(
        dt,
        "materials:\n  ore: {density: %g, young: %g, poisson: %g}\n"
        "  wall: {density: %g, young: %g, poisson: %g}\n"
        "contact:\n  pairs:\n    - {between: [ore, ore], friction: 0, restitution: 1}\n"
        "    - {between: [ore, wall], friction: %g, restitution: 1}\n"
        "gravity: [0, 0, 0]\ndomain: {leavers: ignore}\nwatch: {overlap: 0.5}\n"
        "spheres:\n%sbodies:\n%s",
        ore.density, ore.young, ore.poisson, impact_rigid.density, impact_rigid.young,
        impact_rigid.poisson, friction, spheres, body);
    free(body);
    return sim;
}

/* Smallest and largest of some forces, over an expected one, and how far the direction turns
 * between two places at most. */
struct range {
    double low, high, turn_max;
};

/* The forces of one step on spheres at rest, each at its own angle over one segment: all as
 * deep in the nearest facet, or all as far from the axis. */
static struct range press(int n, double overlap, bool deepest)
{
    const double segment = 2.0 * pi / (double)n, facet = drum * cos(0.5 * segment), dt = 1e-7;
    const struct vec3 zero = {0.0, 0.0, 0.0};
    char *spheres = array_string("");
    for (int k = 0; k < PLACES; k++) {
        const double angle = segment * (double)k / (double)(PLACES - 1);
        const double from_axis =
            (facet - radius + overlap) / (deepest ? cos(angle - 0.5 * segment) : 1.0);
        char name[32];
        snprintf(name, sizeof name, "s%d", k);
        const struct vec3 place = {from_axis * cos(angle), from_axis * sin(angle),
                                   0.12 * (double)k};
        char *sphere = verify_sphere(name, "ore", radius, place, zero, zero);
        char *longer = array_format("%s%s", spheres, sphere);
        free(spheres);
        free(sphere);
        spheres = longer;
    }
    struct simulation *sim = scene(dt, n, 0.12 * (double)PLACES, 0.0, spheres);
    free(spheres);
    verify_steps(sim, 1);
    struct range range = {INFINITY, 0.0, 0.0};
    double before = 0.0;
    for (int k = 0; k < PLACES; k++) {
        const struct vec3 v = verify_velocity(sim, k);
        const double force = verify_mass(sim, k) / dt * vec3_norm(v) / hertz(overlap);
        const double direction = atan2(-v.y, -v.x);
        range.low = fmin(range.low, force);
        range.high = fmax(range.high, force);
        range.turn_max = fmax(range.turn_max, k > 0 ? fabs(direction - before) : 0.0);
        before = direction;
    }
    verify_scene_free(sim);
    return range;
}

/* The normal forces over one turn of a sphere that is pressed by the force of its orbit. */
static struct range orbit(int n, double friction)
{
    const double segment = 2.0 * pi / (double)n, overlap = 0.01 * radius, dt = 1e-5;
    const double r = drum * cos(0.5 * segment) - radius + overlap,
                 mass = impact_mass(&ore, radius);
    const double speed = sqrt(hertz(overlap) * r / mass), angle = 0.5 * segment;
    const double earlier = angle - 0.5 * speed / r * dt; /* velocities are half a step late */
    const struct vec3 place = {r * cos(angle), r * sin(angle), 0.123},
                      velocity = {-speed * sin(earlier), speed * cos(earlier), 0.0},
                      spin = {0.0, 0.0, friction > 0.0 ? -speed / radius : 0.0};
    char *sphere = verify_sphere("s", "ore", radius, place, velocity, spin);
    struct simulation *sim = scene(dt, n, 0.5, friction, sphere);
    free(sphere);
    struct range range = {INFINITY, 0.0, 0.0};
    struct vec3 before = verify_velocity(sim, 0);
    for (int64_t k = 0; k < (int64_t)(2.0 * pi * r / speed / dt); k++) {
        verify_steps(sim, 1);
        const struct vec3 now = verify_velocity(sim, 0);
        const double force = mass / dt * vec3_norm(vec3_sub(now, before)) / hertz(overlap);
        range.low = fmin(range.low, force);
        range.high = fmax(range.high, force);
        before = now;
    }
    verify_scene_free(sim);
    return range;
}

/* How far the direction turns between two places of press() by (2.2), the spheres as deep in
 * the nearest facet: neighbours that a sphere projects into turn it while they are nearly as
 * deep. */
static double turn_expected(int n, double overlap)
{
    const double segment = 2.0 * pi / (double)n, facet = drum * cos(0.5 * segment),
                 nearest = radius - overlap;
    double most = 0.0, before = 0.0;
    for (int k = 0; k < PLACES; k++) {
        const double angle =
            segment * ((double)k / (double)(PLACES - 1) - 0.5); /* off the middle */
        const double from_axis = (facet - nearest) / cos(angle);
        const double other = facet - from_axis * cos(segment - fabs(angle));
        const double reach = fmin(0.1 * overlap, (1.0 - cos(segment)) * other);
        const double weight = fmax(0.0, 1.0 - (other - nearest) / reach);
        const double turn = atan2(weight * sin(segment), 1.0 + weight * cos(segment));
        const double direction = angle < 0.0 ? -turn : turn;
        most = fmax(most, k > 0 ? fabs(direction - before) : 0.0);
        before = direction;
    }
    return most;
}

static void compare_stiffness(void)
{
    char name[160];
    verify_source("the same overlap, the same force: Hertz (1.5)");
    for (int n = 32; n <= 1024; n *= 2) {
        const struct range range = press(n, 0.02 * radius, true);
        snprintf(name, sizeof name,
                 "%d segments: largest force over smallest less one, seam and facet as deep",
                 n);
        verify_row(name, "", 0.0, range.high / range.low - 1.0, 1e-9, VERIFY_AT_MOST,
                   "seams are no stiffer and no softer");
    }
    verify_source("(2.2)");
    for (int n = 32; n <= 512; n *= 4) {
        const double overlap = 0.02 * radius;
        const struct range range = press(n, overlap, true);
        snprintf(name, sizeof name, "%d segments: largest turn of the force in 1/96 of one", n);
        verify_row(name, "segments", turn_expected(n, overlap) * (double)n / (2.0 * pi),
                   range.turn_max * (double)n / (2.0 * pi), 1e-7, VERIFY_ABSOLUTE,
                   "exact geometry, rounding of the depths' difference");
    }
}

static void compare_ripple(void)
{
    char name[160];
    verify_source("Hertz (1.5) and the sagitta");
    for (int n = 64; n <= 1024; n *= 4) {
        const double overlap = 0.02 * radius, segment = 2.0 * pi / (double)n;
        const double r = drum * cos(0.5 * segment) - radius + overlap;
        const double least = overlap - r * (1.0 - cos(0.5 * segment));
        const struct range range = press(n, overlap, false);
        snprintf(name, sizeof name, "%d segments: least force on a circle over the largest", n);
        verify_row(name, "", hertz(least) / hertz(overlap), range.low / range.high, 1e-9,
                   VERIFY_RELATIVE, "exact geometry, rounding of an overlap");
    }
    verify_source("second order in the segment");
    for (int rolls = 0; rolls < 2; rolls++) {
        double before = 0.0;
        for (int n = 128; n <= 1024; n *= 2) {
            const struct range range = orbit(n, rolls == 1 ? 0.5 : 0.0);
            const double ripple = range.high - range.low;
            snprintf(name, sizeof name,
                     "%s in %d segments: ripple of the force over that in %d",
                     rolls == 1 ? "rolling" : "sliding", n, n / 2);
            if (n > 128)
                verify_row(name, "", 0.25, ripple / before, 0.03, VERIFY_ABSOLUTE,
                           "the next order: ripple before of .3, .08, .02 times a half");
            before = ripple;
        }
    }
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "A sphere in a cylinder of triangles", "");
    compare_stiffness();
    compare_ripple();
    return verify_end();
}
