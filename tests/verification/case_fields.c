/*
 * What acts on spheres from outside and changes in time or space: gravity that turns or follows
 * a table, parts of space with damping of their own, a plug that goes.
 */
#include <math.h>

#include "run/simulation.h"
#include "verify.h"

static const char BALL[] =
    "domain: {leavers: ignore}\noutput: {series: {every: 1.0e-3}}\nwatch: {overlap: 0.3}\n"
    "materials:\n  ore: {density: 2500, young: 5.0e+7, poisson: 0.25}\n"
    "contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.7}]}\n";

static const char AT_ORIGIN[] =
    "spheres:\n  - {name: ball, material: ore, radius: 0.01, velocity: [0.3, 0, 0.4], spin: "
    "[0, 5, 0], packing: {kind: lattice, count: 1, spacing: 0.02, corner: [-0.01, -0.01, "
    "-0.01], size: [0.02, 0.02]}}\n";

static void turning(void)
{
    const double dt = 1e-4, omega = 5.0, g = 10.0, t = 1.0 - 0.2;
    struct simulation *sim =
        verify_scene(dt,
                     "%s%sgravity: [0, 0, -10]\n"
                     "gravity_turn: {axis: [0, 1, 0], rate: 5, start: 0.2, stop: 2}\n",
                     BALL, AT_ORIGIN);
    verify_steps(sim, 10001);
    /* Velocity half a step after the last place: 10000.5 steps less the first half. */
    const struct vec3 x = verify_position(sim, 0);
    const double after = t + dt; /* 10001 steps done */
    const double v_x = 0.3 - g / omega * (1.0 - cos(omega * after));
    const double v_z = 0.4 - g * 0.2 - g / omega * sin(omega * after);
    const double x_x = 0.3 * (1.0 + dt) - g / omega * (after - sin(omega * after) / omega);
    const struct vec3 v = verify_velocity(sim, 0);
    verify_row("gravity turned by 4 rad: speed along x", "m/s", v_x, v.x, 0.5 * g * dt * 3.0,
               VERIFY_ABSOLUTE, "velocities are of half a step before");
    verify_row("speed along z", "m/s", v_z, v.z, 0.5 * g * dt * 3.0, VERIFY_ABSOLUTE,
               "velocities are of half a step before");
    verify_row("place along x", "m", x_x, x.x, g * dt, VERIFY_ABSOLUTE,
               "the first kick is a whole one: half a step of g");
    const double kinetic = verify_series(sim, "kinetic_translation");
    verify_row("energy balance over the kinetic energy", "", 0.0,
               fabs(verify_series(sim, "balance")) / kinetic, 1e-9, VERIFY_AT_MOST,
               "work of turning by the trapezoidal rule, as the kicks are: exact but for "
               "rounding of sums");
    verify_scene_free(sim);
}

static void table(void)
{
    const double dt = 1e-4;
    struct simulation *sim =
        verify_scene(dt,
                     "%s%sgravity_table:\n  - {time: 0.1, gravity: [0, 0, 0]}\n"
                     "  - {time: 0.5, gravity: [0, 8, 0]}\n",
                     BALL, AT_ORIGIN);
    verify_steps(sim, 10000);
    verify_row("gravity that grows to 8 m/s2 from 0.1 to 0.5 s: speed at 1 s", "m/s",
               0.5 * 8.0 * 0.4 + 8.0 * 0.5, verify_velocity(sim, 0).y, 8.0 * dt,
               VERIFY_ABSOLUTE, "half a step of g");
    verify_scene_free(sim);
}

static void damped(void)
{
    const double dt = 1e-4;
    struct simulation *sim = verify_scene(
        dt,
        "%s%sgravity: [0, 0, 0]\ndamping: 2\ndamping_regions:\n"
        "  - {region: {kind: sphere, centre: [0, 0, 0], radius: 1}, damping: 3}\n"
        "  - {region: {kind: box, min: [-1, -1, -1], max: [1, 1, 1]}, damping: 5}\n"
        "  - {region: {kind: box, min: [5, 5, 5], max: [6, 6, 6]}, damping: 100}\n",
        BALL, AT_ORIGIN);
    verify_steps(sim, 3001);
    double left = 1.0;
    for (int k = 0; k < 3001; k++)
        left *= (1.0 - 5.0 * dt) / (1.0 + 5.0 * dt);
    verify_row("damping of 2/s and of two regions, 3/s and 5/s: speed left", "", left,
               vec3_norm(verify_velocity(sim, 0)) / 0.5, 1e-11, VERIFY_RELATIVE, "rounding");
    verify_row("spin left", "", left, verify_spin(sim, 0).y / 5.0, 1e-11, VERIFY_RELATIVE,
               "rounding");
    verify_row("energy balance over the energy at the start", "", 0.0,
               fabs(verify_series(sim, "balance")) / (0.5 * verify_mass(sim, 0) * 0.25), 1e-6,
               VERIFY_AT_MOST, "(c dt)^2: losses by the trapezoidal rule");
    verify_scene_free(sim);
}

static void plug(double dt)
{
    struct simulation *sim = verify_scene(
        dt,
        "%sgravity: [0, 0, -9.81]\nspheres:\n  - {name: bed, material: ore, radius: 0.02, "
        "packing: {kind: lattice, count: 50, spacing: 0.0402, corner: [-0.1, -0.1, 0.1], size: "
        "[0.202, 0.202]}}\nbodies:\n  - {name: plug, material: ore, geometry: {kind: plane, "
        "point: [0, 0, 0.1], normal: [0, 0, 1], extent: 0.3}, active: [0, 0.0301]}\n",
        BALL);
    verify_steps(sim, (int64_t)(0.029 / dt + 0.5) + 1);
    const double before = verify_series(sim, "balance");
    verify_steps(sim, (int64_t)(0.003 / dt + 0.5));
    const double held = verify_series(sim, "removed_energy");
    verify_row("a plug goes: force on it", "N", 0.0, verify_series(sim, "plug.force_z"), 0.0,
               VERIFY_ABSOLUTE, "it is not there");
    verify_row("what its contacts held, over the energy at the start, so that they did", "",
               1.0, held > 1e-4 ? 1.0 : 0.0, 0.0, VERIFY_ABSOLUTE, "a guard of the next row");
    verify_row("change of the energy balance over what they held", "", 0.0,
               fabs(verify_series(sim, "balance") - before) / held, 0.01, VERIFY_AT_MOST,
               "of the second order in the step over a contact's duration");
    verify_scene_free(sim);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Gravity over time, damping by place, a plug that goes", "Newton");
    turning();
    table();
    damped();
    plug(2e-5);
    return verify_end();
}
