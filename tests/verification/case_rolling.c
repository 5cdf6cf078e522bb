/*
 * Resistance to rolling and twisting, and friction that is greater at rest, on a plane.
 *
 * A torque M against rolling of a ball that rolls on a plane slows it by 5/7 M/(m R): with M =
 * mu_r R m g by 5/7 mu_r g, so it stops after 7 u/(5 mu_r g).  Twisting is slowed by 5/2 mu_t
 * g/R.  On an incline the spring holds the ball up to tan = mu_r; a torque of constant size
 * holds nothing, but near rest it is a dashpot of .2 m/dt: the ball creeps at 5 g dt
 * sin(angle).
 */
#include <math.h>
#include <stdio.h>

#include "resting.h"
#include "run/simulation.h"
#include "verify.h"

static const double DEGREE = M_PI / 180.0;

/* The laws that a row is for, with further keys. */
struct law {
    const char *name, *more;
    double stiffness;
};

static const struct law laws[] = {{"Hertz", "", 0.0},
                                  {"linear", ", law: linear, stiffness: 1.0e+5", 1e5}};

static double rolls(const struct simulation *sim)
{
    return verify_velocity(sim, 0).x;
}

static double turns(const struct simulation *sim)
{
    return verify_spin(sim, 0).z;
}

/* A speed that falls evenly to nothing: how fast in the middle, and when all but gone. */
static void fade(struct simulation *sim, const char *which,
                 double (*speed)(const struct simulation *), double slowing, const char *unit)
{
    char name[128];
    const double first = speed(sim), stops = first / slowing;
    const int quarter = (int)(0.25 * stops / resting_step);
    verify_steps(sim, quarter);
    const double before = speed(sim);
    verify_steps(sim, 2 * quarter);
    snprintf(name, sizeof name, "%s: deceleration", which);
    verify_row(name, unit, slowing, (before - speed(sim)) / (2.0 * quarter * resting_step),
               1e-6, VERIFY_RELATIVE, "uniform; what is left of the first swing");
    for (int k = 0; k < 2 * quarter && speed(sim) > 0.01 * first; k++)
        verify_steps(sim, 1);
    snprintf(name, sizeof name, "%s: time to a hundredth of the speed", which);
    verify_row(name, "s", 0.99 * stops, (double)sim->step * resting_step, 1e-3, VERIFY_RELATIVE,
               "the first swing of the springs, 1 ms");
}

/* Deceleration in the middle of rolling to a stop, when it stops, and what moves then. */
static void roll_out(const struct law *law, const char *kind, double mu_r)
{
    char more[160], name[128];
    const double speed = 0.2;
    snprintf(more, sizeof more, "%s, rolling_friction: %.17g, rolling: %s", law->more, mu_r,
             kind);
    struct simulation *sim =
        resting_scene(&(struct resting){.friction = 0.5,
                                        .more = more,
                                        .stiffness = law->stiffness,
                                        .speed = speed,
                                        .spin = {0.0, speed / resting_radius, 0.0}});
    snprintf(name, sizeof name, "%s, %s, mu_r %g", law->name, kind, mu_r);
    fade(sim, name, rolls, 5.0 / 7.0 * mu_r * resting_gravity, "m/s2");
    verify_steps(sim, 20000);
    const double x = verify_position(sim, 0).x;
    verify_steps(sim, 100000);
    snprintf(name, sizeof name, "%s, %s, mu_r %g: way from .1 to .6 s after it stopped",
             law->name, kind, mu_r);
    verify_row(name, "m", 0.0, fabs(verify_position(sim, 0).x - x), 1e-12, VERIFY_AT_MOST,
               "rest; what is left of swings, a millionth of the overlap");
    verify_scene_free(sim);
}

static void incline(const struct law *law, double mu_r, double degrees)
{
    char more[160], name[128];
    const double angle = degrees * DEGREE, g = resting_gravity;
    snprintf(more, sizeof more, "%s, rolling_friction: %.17g", law->more, mu_r);
    struct simulation *sim = resting_scene(&(struct resting){
        .friction = 0.8, .more = more, .stiffness = law->stiffness, .angle = angle});
    verify_steps(sim, 40000);
    const double u = verify_velocity(sim, 0).x, x = verify_position(sim, 0).x;
    const int n = 100000;
    verify_steps(sim, n);
    if (tan(angle) < mu_r) {
        snprintf(name, sizeof name, "%s, spring, mu_r %g, %g degrees: creep in 1e5 steps",
                 law->name, mu_r, degrees);
        verify_row(name, "m", 0.0, fabs(verify_position(sim, 0).x - x), 1e-12, VERIFY_AT_MOST,
                   "held; a millionth of the overlap");
    } else {
        snprintf(name, sizeof name, "%s, spring, mu_r %g, %g degrees: acceleration", law->name,
                 mu_r, degrees);
        verify_row(name, "m/s2", 5.0 / 7.0 * g * (sin(angle) - mu_r * cos(angle)),
                   (verify_velocity(sim, 0).x - u) / (n * resting_step), 1e-6, VERIFY_RELATIVE,
                   "uniform; what is left of the first swing");
    }
    verify_scene_free(sim);
}

static void incline_constant(double mu_r, double degrees)
{
    char more[160], name[128];
    const double angle = degrees * DEGREE;
    snprintf(more, sizeof more, ", rolling_friction: %.17g, rolling: constant", mu_r);
    struct simulation *sim =
        resting_scene(&(struct resting){.friction = 0.8, .more = more, .angle = angle});
    verify_steps(sim, 40000);
    snprintf(name, sizeof name, "Hertz, constant, mu_r %g, %g degrees: creep", mu_r, degrees);
    verify_row(name, "m/s", 5.0 * resting_gravity * resting_step * sin(angle),
               verify_velocity(sim, 0).x, 1e-3, VERIFY_RELATIVE, "a steady state");
    verify_scene_free(sim);
}

static void twist(const struct law *law, double mu_t)
{
    char more[160], name[128];
    const double spin = 50.0;
    snprintf(more, sizeof more, "%s, twisting_friction: %.17g", law->more, mu_t);
    struct simulation *sim = resting_scene(&(struct resting){
        .friction = 0.5, .more = more, .stiffness = law->stiffness, .spin = {0.0, 0.0, spin}});
    snprintf(name, sizeof name, "%s, mu_t %g", law->name, mu_t);
    fade(sim, name, turns, 2.5 * mu_t * resting_gravity / resting_radius, "rad/s2");
    verify_steps(sim, 40000);
    snprintf(name, sizeof name, "%s, mu_t %g: spin .2 s after it stopped", law->name, mu_t);
    verify_row(name, "rad/s", 0.0, fabs(verify_spin(sim, 0).z), 1e-9 * spin, VERIFY_AT_MOST,
               "rest; what is left of swings");
    verify_scene_free(sim);
}

/* The weight comes on the spring at once, so it swings to half as much again; it holds where
 * that is less than friction at rest. */
static void static_friction(const struct law *law, double degrees, double speed)
{
    static const double still = 1.0, sliding = 0.4;
    char more[160], name[128];
    const double angle = degrees * DEGREE, g = resting_gravity;
    snprintf(more, sizeof more, "%s, static_friction: %.17g", law->more, still);
    struct simulation *sim = resting_scene(&(struct resting){.friction = sliding,
                                                             .more = more,
                                                             .stiffness = law->stiffness,
                                                             .angle = angle,
                                                             .speed = speed});
    resting_slide(sim, 40000);
    const double u = verify_velocity(sim, 0).x, x = verify_position(sim, 0).x;
    const int n = 60000;
    resting_slide(sim, n);
    if (tan(angle) < still && speed == 0.0) {
        snprintf(name, sizeof name, "%s, mu 1 at rest, .4 sliding, %g degrees: creep in 0.3 s",
                 law->name, degrees);
        verify_row(name, "m", 0.0, fabs(verify_position(sim, 0).x - x), 1e-12, VERIFY_AT_MOST,
                   "held; a millionth of the overlap");
    } else {
        snprintf(name, sizeof name,
                 "%s, mu 1 at rest, .4 sliding, %g degrees, at first %g m/s: acceleration",
                 law->name, degrees, speed);
        verify_row(name, "m/s2", g * (sin(angle) - sliding * cos(angle)),
                   (verify_velocity(sim, 0).x - u) / (n * resting_step), 1e-8, VERIFY_RELATIVE,
                   "uniform, so exact but for rounding");
    }
    verify_scene_free(sim);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Rolling, twisting and static friction", "5/7 mu_r g");
    for (int l = 0; l < 2; l++) {
        roll_out(&laws[l], "spring", 0.1);
        roll_out(&laws[l], "constant", 0.05);
    }
    verify_source("held below tan = mu_r; 5/7 g (sin - mu_r cos) above");
    for (int l = 0; l < 2; l++) {
        incline(&laws[l], 0.2, 11.0);
        incline(&laws[l], 0.2, 12.0);
    }
    verify_source("5 g dt sin, (1.28)");
    incline_constant(0.2, 5.0);
    verify_source("5/2 mu_t g/R");
    for (int l = 0; l < 2; l++)
        twist(&laws[l], 0.05);
    verify_source("held below tan = mu at rest; g (sin - mu cos) sliding");
    for (int l = 0; l < 2; l++) {
        static_friction(&laws[l], 30.0, 0.0);
        static_friction(&laws[l], 46.0, 0.0);
        static_friction(&laws[l], 30.0, 0.1);
    }
    return verify_end();
}
