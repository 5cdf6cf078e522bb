/*
 * A sphere on a plane under gravity: it slides until it rolls; on an incline it slides, rolls,
 * or, where it cannot turn, stays.
 *
 * The incline is a level plane under tilted gravity.  A job has no means to keep a sphere from
 * turning, so the last scene clears its angular velocity after each step.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "impact.h"
#include "run/simulation.h"
#include "verify.h"

static const struct impact_solid stone = {1e9, 0.25, 2500.0};
static const double RADIUS = 0.01, G = 9.81, STEP = 5e-6, DEGREE = M_PI / 180.0;

/* A sphere that rests on the plane, moving at `speed` along x. */
static struct simulation *rest(double friction, double angle, double speed)
{
    const double weight = impact_mass(&stone, RADIUS) * G * cos(angle);
    const double modulus = impact_modulus(&stone, &stone);
    const double overlap = pow(0.75 * weight / (modulus * sqrt(RADIUS)), 2.0 / 3.0); /* (1.5) */
    char *sphere =
        verify_sphere("ball", "stone", RADIUS, (struct vec3){0.0, 0.0, RADIUS - overlap},
                      (struct vec3){speed, 0.0, 0.0}, (struct vec3){0.0, 0.0, 0.0});
    struct simulation *sim =
        verify_scene(STEP,
                     "gravity: [%.17g, 0, %.17g]\ndomain: {leavers: ignore}\n"
                     "output: {series: {every: 1.0e+9}}\n"
                     "materials:\n  stone: {density: %g, young: %g, poisson: %g}\n"
                     "contact:\n  pairs:\n"
                     "    - {between: [stone, stone], friction: %g, restitution: 0.5}\n"
                     "spheres:\n%sbodies:\n  - {name: plane, material: stone, geometry: "
                     "{kind: plane, point: [0, 0, 0], normal: [0, 0, 1], extent: 100}}\n",
                     G * sin(angle), -G * cos(angle), stone.density, stone.young, stone.poisson,
                     friction, sphere);
    free(sphere);
    return sim;
}

static void slide_to_rolling(double mu, double speed)
{
    struct simulation *sim = rest(mu, 0.0, speed);
    char name[96];
    const double slip_ends = 2.0 * speed / (7.0 * mu * G);
    double before = speed, ended = 0.0;
    while (ended == 0.0) {
        verify_steps(sim, 1);
        const double now = verify_velocity(sim, 0).x;
        /* Friction is mu m g as long as it slips, then falls to nothing. */
        if ((before - now) / STEP < 0.5 * mu * G)
            ended = (double)(sim->step - 1) * STEP;
        before = now;
    }
    verify_steps(sim, (int64_t)(0.5 * slip_ends / STEP));
    const double u = verify_velocity(sim, 0).x, w = verify_spin(sim, 0).y;
    const double kept = (u * u + 0.4 * RADIUS * RADIUS * w * w) / (speed * speed);
    snprintf(name, sizeof name, "mu %g: slip ends after", mu);
    verify_row(
        name, "s", slip_ends, ended, 1e-4, VERIFY_ABSOLUTE,
        "slip turns into a swing of the tangential spring, period 1.1 ms; a twelfth of it later friction is half");
    snprintf(name, sizeof name, "mu %g: speed then, over the first", mu);
    verify_row(name, "", 5.0 / 7.0, u / speed, 1e-9, VERIFY_RELATIVE,
               "momentum about the point of contact: rounding, what is left of the swing");
    snprintf(name, sizeof name, "mu %g: share of the energy lost", mu);
    verify_row(name, "", 2.0 / 7.0, 1.0 - kept, 1e-8, VERIFY_RELATIVE, "twice that over 2/7");
    snprintf(name, sizeof name, "mu %g: R w / u", mu);
    verify_row(name, "", 1.0, RADIUS * w / u, 1e-9, VERIFY_RELATIVE, "as above");
    verify_scene_free(sim);
}

/* Acceleration along and about, between two times. */
static void incline(double mu, double degrees)
{
    const double angle = degrees * DEGREE;
    const bool slides = tan(angle) > 3.5 * mu;
    struct simulation *sim = rest(mu, angle, 0.0);
    char name[96];
    verify_steps(sim, 20000); /* 0.1 s */
    const double u0 = verify_velocity(sim, 0).x, w0 = verify_spin(sim, 0).y;
    verify_steps(sim, 40000);
    const double time = 40000.0 * STEP;
    const double a = (verify_velocity(sim, 0).x - u0) / time,
                 b = (verify_spin(sim, 0).y - w0) / time;
    snprintf(name, sizeof name, "%g degrees, mu %g, %s: acceleration", degrees, mu,
             slides ? "slides" : "rolls");
    verify_row(
        name, "m/s2", slides ? G * (sin(angle) - mu * cos(angle)) : 5.0 / 7.0 * G * sin(angle),
        a, 1e-9, VERIFY_RELATIVE, "uniform, so exact but for what is left of the first touch");
    snprintf(name, sizeof name, "%g degrees, mu %g, %s: angular acceleration", degrees, mu,
             slides ? "slides" : "rolls");
    verify_row(name, "rad/s2",
               slides ? 2.5 * mu * G * cos(angle) / RADIUS
                      : 5.0 / 7.0 * G * sin(angle) / RADIUS,
               b, 1e-9, VERIFY_RELATIVE, "the same");
    verify_scene_free(sim);
}

/* n steps without turning. */
static void steps_unturned(struct simulation *sim, int n)
{
    for (int k = 0; k < n; k++) {
        verify_steps(sim, 1);
        double *spin = sim->spheres.spin[verify_index(sim, 0)].lane;
        spin[0] = spin[1] = spin[2] = spin[4] = spin[5] = spin[6] = 0.0;
    }
}

static void creep(double mu, double degrees)
{
    struct simulation *sim = rest(mu, degrees * DEGREE, 0.0);
    char name[96];
    steps_unturned(sim, 100000);
    const double x0 = verify_position(sim, 0).x;
    steps_unturned(sim, 900000);
    snprintf(name, sizeof name, "%g degrees, mu %g, cannot turn: creep from step 1e5 to 1e6",
             degrees, mu);
    verify_row(name, "m", 0.0, fabs(verify_position(sim, 0).x - x0), 1e-14, VERIFY_AT_MOST,
               "rounding of a place: 1e-16 R a step, at random 1e-15; a thousandth of the "
               "overlap is 1e-9");
    verify_scene_free(sim);
}

static void slide_unturned(double mu, double degrees)
{
    const double angle = degrees * DEGREE;
    struct simulation *sim = rest(mu, angle, 0.0);
    char name[96];
    steps_unturned(sim, 20000);
    const double u0 = verify_velocity(sim, 0).x;
    steps_unturned(sim, 40000);
    snprintf(name, sizeof name, "%g degrees, mu %g, cannot turn, slides: acceleration", degrees,
             mu);
    verify_row(name, "m/s2", G * (sin(angle) - mu * cos(angle)),
               (verify_velocity(sim, 0).x - u0) / (40000.0 * STEP), 1e-8, VERIFY_RELATIVE,
               "a small difference of the two, ten times less exact");
    verify_scene_free(sim);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Sphere on a plane, level and inclined", "Coulomb, Newton");
    slide_to_rolling(0.3, 1.0);
    slide_to_rolling(0.1, 0.5);
    incline(0.1, 25.0);
    incline(0.1, 45.0);
    incline(0.1, 15.0);
    incline(0.5, 30.0);
    incline(0.5, 55.0);
    creep(0.5, 26.0);
    creep(0.3, 10.0);
    slide_unturned(0.5, 27.0);
    return verify_end();
}
