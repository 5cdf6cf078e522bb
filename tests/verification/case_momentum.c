/*
 * Twenty spheres of mixed sizes and two materials fly at each other, spin, rub and part;
 * nothing acts on them from outside, so momentum and angular momentum stay what they were.
 * Forces on the two sides of a contact are equal to the last bit and act at one point, so only
 * rounding remains.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "run/simulation.h"
#include "verify.h"

enum { N = 20, STEPS = 20000 };

static struct simulation *cluster(double friction, double restitution, const char *more)
{
    uint64_t random = 7;
    char *list = array_string("");
    for (int i = 0; i < N; i++) {
        const int layer = i / 9, row = i / 3 % 3, column = i % 3;
        const struct vec3 place = {0.03 * (column - 1), 0.03 * (row - 1), 0.03 * (layer - 1)};
        const struct vec3 stray = {verify_random(&random), verify_random(&random),
                                   verify_random(&random)};
        const struct vec3 spin = {100.0 * verify_random(&random),
                                  100.0 * verify_random(&random),
                                  100.0 * verify_random(&random)};
        char name[16];
        snprintf(name, sizeof name, "ball_%d", i);
        char *one = verify_sphere(name, i % 3 == 0 ? "heavy" : "light",
                                  0.009 + 0.005 * verify_random(&random), place,
                                  vec3_axpy(stray, -50.0, place), spin);
        char *longer = array_format("%s%s", list, one);
        free(one);
        free(list);
        list = longer;
    }
    struct simulation *sim = verify_scene(
        2e-6,
        "gravity: [0, 0, 0]\ndomain: {leavers: ignore}\noutput: {series: {every: 1.0e+9}}\n"
        "materials:\n  heavy: {density: 7850, young: 2.0e+9, poisson: 0.3}\n"
        "  light: {density: 2500, young: 5.0e+8, poisson: 0.2}\n"
        "contact:\n  pairs:\n"
        "    - {between: [heavy, heavy], friction: %g, restitution: %g%s}\n"
        "    - {between: [heavy, light], friction: %g, restitution: %g%s}\n"
        "    - {between: [light, light], friction: %g, restitution: %g%s}\n"
        "spheres:\n%s",
        friction, restitution, more, friction, restitution, more, friction, restitution, more,
        list);
    free(list);
    return sim;
}

struct momenta {
    struct vec3 linear, angular;      /* [kg m/s], [kg m2/s] about the origin */
    double linear_size, angular_size; /* sums of the terms' sizes */
    double kinetic;                   /* [J] */
};

static struct momenta momenta_of(const struct simulation *sim)
{
    struct momenta sum = {.linear_size = 0.0};
    for (int i = 0; i < N; i++) {
        const double mass = verify_mass(sim, i),
                     r = sphere_radius(&sim->spheres, verify_index(sim, i));
        const struct vec3 p = vec3_scale(mass, verify_velocity(sim, i));
        const struct vec3 orbit = vec3_cross(verify_position(sim, i), p);
        const struct vec3 spin = vec3_scale(0.4 * mass * r * r, verify_spin(sim, i));
        sum.linear = vec3_add(sum.linear, p);
        sum.angular = vec3_add(sum.angular, vec3_add(orbit, spin));
        sum.linear_size += vec3_norm(p);
        sum.angular_size += vec3_norm(orbit) + vec3_norm(spin);
        sum.kinetic += 0.5 * vec3_dot(p, p) / mass + 0.5 * vec3_dot(spin, verify_spin(sim, i));
    }
    return sum;
}

static void compare(const char *law, double friction, double restitution, const char *more)
{
    struct simulation *sim = cluster(friction, restitution, more);
    const struct momenta before = momenta_of(sim);
    double linear = 0.0, angular = 0.0;
    char name[128];
    static const char why[] = "2e4 steps of rounding, 1e-16 each, all to one side: 2e-12";
    for (int k = 0; k < 100; k++) {
        verify_steps(sim, STEPS / 100);
        const struct momenta now = momenta_of(sim);
        const double p = vec3_norm(vec3_sub(now.linear, before.linear)) / before.linear_size;
        const double l = vec3_norm(vec3_sub(now.angular, before.angular)) / before.angular_size;
        linear = p > linear ? p : linear;
        angular = l > angular ? l : angular;
    }
    const struct momenta after = momenta_of(sim);
    snprintf(name, sizeof name,
             "%s, mu %g, e %g: momentum, largest change over the sum of sizes", law, friction,
             restitution);
    verify_row(name, "", 0.0, linear, 2e-12, VERIFY_AT_MOST, why);
    snprintf(name, sizeof name,
             "%s, mu %g, e %g: angular momentum, largest change over the sum of sizes", law,
             friction, restitution);
    verify_row(name, "", 0.0, angular, 2e-12, VERIFY_AT_MOST, why);
    snprintf(name, sizeof name, "%s, mu %g, e %g: kinetic energy left, so that they did meet",
             law, friction, restitution);
    verify_row(name, "", 0.9, after.kinetic / before.kinetic, 0.0, VERIFY_AT_MOST,
               "no answer: a guard of the two rows above");
    verify_scene_free(sim);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Momentum of twenty spheres by themselves", "Newton");
    static const char *const linear = ", law: linear, stiffness: 1.0e+6";
    compare("Hertz", 0.5, 0.6, "");
    compare("Hertz", 10.0, 0.9, "");
    compare("linear", 0.5, 0.6, linear);
    compare("Hertz, rolling spring", 0.5, 0.6, ", rolling_friction: 0.2");
    compare("Hertz, rolling of constant torque", 0.5, 0.6,
            ", rolling_friction: 0.2, rolling: constant");
    compare("Hertz, twisting", 0.5, 0.6, ", twisting_friction: 0.2");
    compare("Hertz, static friction .9", 0.5, 0.6, ", static_friction: 0.9");
    compare("linear, all of these", 0.5, 0.6,
            ", law: linear, stiffness: 1.0e+6, rolling_friction: 0.2, twisting_friction: 0.2, "
            "static_friction: 0.9");
    return verify_end();
}
