/*
 * A ball dropped onto a plane again and again.  The heights it comes back to are
 * h_k = (h_0 - r) e^2k + r, as far as gravity does nothing while surfaces touch; in truth it
 * works over the depth of the contact, on the way in and on the way out.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "impact.h"
#include "verify.h"

enum { BOUNCES = 4 };
static const struct impact_solid stone = {1e9, 0.25, 2500.0};
static const double RADIUS = 0.01, G = 9.81, HEIGHT = 0.5;

static void bounce(double restitution)
{
    const double speed = sqrt(2.0 * G * (HEIGHT - RADIUS));
    const struct impact first = {
        .solid = {&stone, &stone}, .radius = {RADIUS, 0.0}, .velocity = {{0.0, 0.0, -speed}}};
    const struct impact_hertz hertz = impact_hertz(&first);
    const double dt = hertz.duration / 200.0;
    /* At rest at step 0, so half a step of gravity is behind it. */
    char *sphere =
        verify_sphere("ball", "stone", RADIUS, (struct vec3){0.0, 0.0, HEIGHT},
                      (struct vec3){0.0, 0.0, 0.5 * G * dt}, (struct vec3){0.0, 0.0, 0.0});
    struct simulation *sim =
        verify_scene(dt,
                     "gravity: [0, 0, %.17g]\ndomain: {leavers: ignore}\n"
                     "output: {series: {every: 1.0e+9}}\n"
                     "materials:\n  stone: {density: %g, young: %g, poisson: %g}\n"
                     "contact:\n  pairs:\n"
                     "    - {between: [stone, stone], friction: 0.3, restitution: %g}\n"
                     "spheres:\n%sbodies:\n  - {name: plane, material: stone, geometry: "
                     "{kind: plane, point: [0, 0, 0], normal: [0, 0, 1], extent: 10}}\n",
                     -G, stone.density, stone.young, stone.poisson, restitution, sphere);
    free(sphere);
    double drop = HEIGHT - RADIUS, slack = 0.0;
    verify_steps(sim, 1);
    double before = 0.0;
    for (int k = 1; k <= BOUNCES;) {
        const double now = verify_velocity(sim, 0).z;
        if (before > 0.0 && now <= 0.0) { /* at its highest: by the energy of a free flight */
            char name[96];
            const double top = verify_position(sim, 0).z - now * dt + 0.5 * before * before / G;
            const double depth = hertz.overlap * pow(drop / (HEIGHT - RADIUS), 0.4);
            const double share = restitution * restitution;
            slack = share * (slack + depth) + depth;
            drop *= share;
            snprintf(name, sizeof name, "restitution %g: height after bounce %d", restitution,
                     k++);
            verify_row(name, "m", drop + RADIUS, top, slack, VERIFY_ABSOLUTE,
                       "the depths of the contacts so far, on the way in and out");
        }
        before = now;
        verify_steps(sim, 1);
    }
    verify_scene_free(sim);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Bouncing ball", "h_k = (h_0 - r) e^2k + r");
    bounce(0.9);
    bounce(0.6);
    return verify_end();
}
