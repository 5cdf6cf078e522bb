/*
 * A sphere on a plane under gravity: it slides until it rolls; on an incline it slides, rolls,
 * or, where it cannot turn, stays.
 */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>

#include "impact.h"
#include "model/restitution.h"
#include "resting.h"
#include "run/simulation.h"
#include "verify.h"

static const double DEGREE = M_PI / 180.0;

/* When friction has fallen to half, since slip ended [s].  Up to then the spring held all of
 * mu m g and the dashpot nothing; then the two are an oscillator of 7/2 k_t/m: with the
 * share z of critical damping and the spring's force h in units of mu m g, h'' + 2 z w h' +
 * w^2 h = 0 from h = 1, h' = 0, and friction is h + 2 z h'/w. */
static double half_after_slip(const struct resting *resting)
{
    const struct impact_solid *s = &resting_solid;
    const double a = sqrt(resting_radius * resting_overlap(resting)),
                 mass = impact_mass(s, resting_radius), stiff = 2.0 * impact_modulus(s, s) * a;
    const double k_t = 8.0 * s->young / (4.0 * (2.0 - s->poisson) * (1.0 + s->poisson)) * a;
    const double c_n = 2.0 * sqrt(5.0 / 6.0) * restitution_damping(0.5) * sqrt(stiff * mass);
    const double w = sqrt(3.5 * k_t / mass), z = 1.75 * c_n * sqrt(k_t / stiff) / (mass * w);
    const double dt = 1e-5 / w;
    double h = 1.0, rate = 0.0, t = 0.0;
    while (h + 2.0 * z * rate / w > 0.5) {
        rate -= dt * (2.0 * z * w * rate + w * w * h);
        h += dt * rate;
        t += dt;
    }
    return t;
}

static void slide_to_rolling(double mu, double speed)
{
    const struct resting resting = {.friction = mu, .speed = speed};
    struct simulation *sim = resting_scene(&resting);
    char name[96];
    const double slip_ends = 2.0 * speed / (7.0 * mu * resting_gravity);
    double before = speed, ended = 0.0;
    while (ended == 0.0) {
        verify_steps(sim, 1);
        const double now = verify_velocity(sim, 0).x;
        /* Friction is mu m g as long as it slips, then falls to nothing. */
        if ((before - now) / resting_step < 0.5 * mu * resting_gravity)
            ended = (double)(sim->step - 1) * resting_step;
        before = now;
    }
    verify_steps(sim, (int64_t)(0.5 * slip_ends / resting_step));
    const double u = verify_velocity(sim, 0).x, w = verify_spin(sim, 0).y;
    const double kept =
        (u * u + 0.4 * resting_radius * resting_radius * w * w) / (speed * speed);
    snprintf(name, sizeof name, "mu %g: after slip, friction is half of mu m g at", mu);
    verify_row(name, "s", slip_ends + half_after_slip(&resting), ended, 2.0 * resting_step,
               VERIFY_ABSOLUTE,
               "2 u/(7 mu g) and the first swing of spring and dashpot; two steps");
    snprintf(name, sizeof name, "mu %g: speed then, over the first", mu);
    verify_row(name, "", 5.0 / 7.0, u / speed, 1e-9, VERIFY_RELATIVE,
               "momentum about the point of contact: rounding, what is left of the swing");
    snprintf(name, sizeof name, "mu %g: share of the energy lost", mu);
    verify_row(name, "", 2.0 / 7.0, 1.0 - kept, 1e-8, VERIFY_RELATIVE, "twice that over 2/7");
    snprintf(name, sizeof name, "mu %g: R w / u", mu);
    verify_row(name, "", 1.0, resting_radius * w / u, 1e-9, VERIFY_RELATIVE, "as above");
    verify_scene_free(sim);
}

/* Acceleration along and about, between two times. */
static void incline(double mu, double degrees)
{
    const double angle = degrees * DEGREE;
    const bool slides = tan(angle) > 3.5 * mu;
    struct simulation *sim = resting_scene(&(struct resting){.friction = mu, .angle = angle});
    char name[96];
    verify_steps(sim, 20000); /* 0.1 s */
    const double u0 = verify_velocity(sim, 0).x, w0 = verify_spin(sim, 0).y;
    verify_steps(sim, 40000);
    const double time = 40000.0 * resting_step;
    const double a = (verify_velocity(sim, 0).x - u0) / time,
                 b = (verify_spin(sim, 0).y - w0) / time;
    snprintf(name, sizeof name, "%g degrees, mu %g, %s: acceleration", degrees, mu,
             slides ? "slides" : "rolls");
    verify_row(name, "m/s2",
               slides ? resting_gravity * (sin(angle) - mu * cos(angle))
                      : 5.0 / 7.0 * resting_gravity * sin(angle),
               a, 1e-9, VERIFY_RELATIVE,
               "uniform, so exact but for what is left of the first touch");
    snprintf(name, sizeof name, "%g degrees, mu %g, %s: angular acceleration", degrees, mu,
             slides ? "slides" : "rolls");
    verify_row(name, "rad/s2",
               slides ? 2.5 * mu * resting_gravity * cos(angle) / resting_radius
                      : 5.0 / 7.0 * resting_gravity * sin(angle) / resting_radius,
               b, 1e-9, VERIFY_RELATIVE, "the same");
    verify_scene_free(sim);
}

static void creep(const char *law, const char *more, double stiffness, double mu,
                  double degrees)
{
    struct simulation *sim = resting_scene(&(struct resting){
        .friction = mu, .more = more, .stiffness = stiffness, .angle = degrees * DEGREE});
    char name[96];
    resting_slide(sim, 100000);
    const double x0 = verify_position(sim, 0).x;
    resting_slide(sim, 900000);
    snprintf(name, sizeof name,
             "%s, %g degrees, mu %g, cannot turn: creep from step 1e5 to 1e6", law, degrees,
             mu);
    verify_row(name, "m", 0.0, fabs(verify_position(sim, 0).x - x0), 1e-14, VERIFY_AT_MOST,
               "rounding of a place: 1e-16 R a step, at random 1e-15; a thousandth of the "
               "overlap is 1e-9");
    verify_scene_free(sim);
}

static void slide_unturned(double mu, double degrees)
{
    const double angle = degrees * DEGREE;
    struct simulation *sim = resting_scene(&(struct resting){.friction = mu, .angle = angle});
    char name[96];
    resting_slide(sim, 20000);
    const double u0 = verify_velocity(sim, 0).x;
    resting_slide(sim, 40000);
    snprintf(name, sizeof name, "%g degrees, mu %g, cannot turn, slides: acceleration", degrees,
             mu);
    verify_row(name, "m/s2", resting_gravity * (sin(angle) - mu * cos(angle)),
               (verify_velocity(sim, 0).x - u0) / (40000.0 * resting_step), 1e-8,
               VERIFY_RELATIVE, "a small difference of the two, ten times less exact");
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
    creep("Hertz", NULL, 0.0, 0.5, 26.0);
    creep("Hertz", NULL, 0.0, 0.3, 10.0);
    creep("linear", ", law: linear, stiffness: 1.0e+5", 1e5, 0.5, 26.0);
    slide_unturned(0.5, 27.0);
    return verify_end();
}
