/*
 * Bodies that forces move, among spheres: a loaded piston comes to rest on a bed, spheres fly
 * at a free block and keep their common momentum, a free plate falls on spheres that are held
 * by a floor, a sphere bounces on a body of its own mass.
 */
#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "model/rigid.h"
#include "run/simulation.h"
#include "verify.h"

static const char MATERIALS[] =
    "materials:\n  ore: {density: 2500, young: 5.0e+7, poisson: 0.25}\n"
    "domain: {leavers: ignore}\nwatch: {overlap: 0.3}\n";

static const struct rigid *rigid_of(const struct simulation *sim, int body)
{
    return sim->bodies.list[body].rigid;
}

static void piston(void)
{
    struct simulation *sim = verify_scene(
        2e-5,
        "%sgravity: [0, 0, -9.81]\ndamping: 20\noutput: {series: {every: 0.002}}\n"
        "contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.3}]}\n"
        "spheres:\n  - {name: bed, material: ore, radius: 0.01, packing: {kind: lattice, "
        "count: 100, spacing: 0.0205, corner: [0, 0, 0], size: [0.104, 0.104]}}\n"
        "bodies:\n"
        "  - {name: box, material: ore, geometry: {kind: box, min: [0, 0, 0], max: [0.104, "
        "0.104, 0.4], open: top}}\n"
        "  - {name: piston, material: ore, geometry: {kind: plane, point: [0.052, 0.052, "
        "0.085], normal: [0, 0, -1], extent: 0.103}, driven: {kind: slide, axis: [0, 0, -1], "
        "mass: 0.5, force: 20, damping: 20}}\n",
        MATERIALS);
    verify_steps(sim, 60001);
    const double load = 20.0 + 0.5 * 9.81;
    verify_row("piston of 0.5 kg under 20 N at rest on 100 spheres: force on it, mean of 100 "
               "steps",
               "N", load, verify_series(sim, "piston.force_z"), 1e-6, VERIFY_RELATIVE,
               "balance of forces; what is left after 1.2 s of damping");
    verify_row("its speed", "m/s", 0.0, fabs(rigid_of(sim, 1)->state.speed), 1e-5,
               VERIFY_AT_MOST, "at rest");
    const double weight = 100.0 * verify_mass(sim, 0) * 9.81;
    verify_row("force on the box", "N", -(load + weight), verify_series(sim, "box.force_z"),
               1e-6, VERIFY_RELATIVE, "balance of forces");
    verify_scene_free(sim);
}

/* Momenta of spheres and the free block together. */
static void add_momenta(const struct simulation *sim, int n, struct vec3 *linear,
                        struct vec3 *angular)
{
    const struct rigid *rigid = rigid_of(sim, 0);
    *linear = vec3_scale(rigid->mass, rigid->state.velocity);
    *angular = vec3_add(rigid->state.momentum, vec3_cross(rigid->state.centre, *linear));
    for (int i = 0; i < n; i++) {
        const double mass = verify_mass(sim, i),
                     r = sphere_radius(&sim->spheres, verify_index(sim, i));
        const struct vec3 p = vec3_scale(mass, verify_velocity(sim, i));
        *linear = vec3_add(*linear, p);
        *angular = vec3_add(*angular, vec3_cross(verify_position(sim, i), p));
        *angular = vec3_axpy(*angular, 0.4 * mass * r * r, verify_spin(sim, i));
    }
}

static void collision(void)
{
    enum { N = 27 };
    struct simulation *sim = verify_scene(
        1e-5,
        "%sgravity: [0, 0, 0]\noutput: {series: {every: 1.0e-3}}\n"
        "contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.7}]}\n"
        "spheres:\n  - {name: swarm, material: ore, radius: 0.01, velocity: [0, 0.2, -2], "
        "spin: [5, 0, 30], packing: {kind: lattice, count: 27, spacing: 0.021, corner: [0, 0, "
        "0.1], size: [0.063, 0.063]}}\n"
        "bodies:\n  - {name: block, material: ore, geometry: {kind: box, min: [-0.01, 0.02, "
        "0], max: [0.05, 0.06, 0.09]}, free: {density: 800, spin: [4, 0, 9], velocity: [0, 0, "
        "0.5]}}\n",
        MATERIALS);
    struct vec3 p, l, p_now, l_now;
    double linear = 0.0, angular = 0.0;
    add_momenta(sim, N, &p, &l);
    for (int k = 0; k < 100; k++) {
        verify_steps(sim, 50);
        add_momenta(sim, N, &p_now, &l_now);
        const double dp = vec3_norm(vec3_sub(p_now, p)) / vec3_norm(p);
        const double dl = vec3_norm(vec3_sub(l_now, l)) / vec3_norm(l);
        linear = dp > linear ? dp : linear;
        angular = dl > angular ? dl : angular;
    }
    verify_row("27 spheres and a free block: momentum, largest change", "", 0.0, linear, 1e-12,
               VERIFY_AT_MOST, "5e3 steps of rounding, 1e-16 each");
    verify_row(
        "angular momentum, largest change", "", 0.0, angular, 1e-3, VERIFY_AT_MOST,
        "a sphere's torque has the arm R, the body's reaches to the surface: overlap over "
        "radius, some 0.01, of what friction turns");
    verify_row("energy balance over the energy at the start", "", 0.0,
               fabs(verify_series(sim, "balance")) /
                   (0.5 * 27.0 * verify_mass(sim, 0) * (4.04)),
               3e-3, VERIFY_AT_MOST, "time integration: of the first order in the step");
    verify_row("spin of the block, over that at the start, so that they did meet", "rad/s", 1.0,
               fabs(rigid_of(sim, 0)->state.spin.z / 9.0 - 1.0) > 0.05 ? 1.0 : 0.0, 0.0,
               VERIFY_ABSOLUTE, "a guard of the rows above");
    verify_scene_free(sim);
}

/* Head on, restitution e: a body of the mass of the sphere takes (1 + e)/2 of its speed. */
static void impact(double e)
{
    struct simulation *sim = verify_scene(
        1e-6,
        "%sgravity: [0, 0, 0]\noutput: {series: {every: 1.0e+3}}\n"
        "contact: {pairs: [{between: [ore, ore], friction: 0, restitution: %g}]}\n"
        "spheres:\n  - {name: ball, material: ore, radius: 0.01, velocity: [0, 0, -1], "
        "packing: {kind: lattice, count: 1, spacing: 0.02, corner: [-0.01, -0.01, 0.001], "
        "size: [0.02, 0.02]}}\n"
        "bodies:\n  - {name: plate, material: ore, geometry: {kind: plane, point: [0, 0, 0], "
        "normal: [0, 0, 1], extent: 0.2}, free: {mass: 0.010471975511965978, inertia: [1, 1, "
        "1.5, 0, 0, 0], centre: [0, 0, 0]}}\n",
        MATERIALS, e);
    verify_steps(sim, 10000);
    char *name =
        array_format("sphere on a free plate of its mass, e %g: speed of the plate", e);
    verify_row(name, "m/s", -0.5 * (1.0 + e), rigid_of(sim, 0)->state.velocity.z, 2e-3,
               VERIFY_RELATIVE, "the law with the mass of both: some 200 steps a contact");
    free(name);
    verify_scene_free(sim);
}

/* Four spheres on a floor carry a plate that falls on them. */
static void plate(void)
{
    struct simulation *sim = verify_scene(
        1e-5,
        "%sgravity: [0, 0, -9.81]\ndamping: 5\noutput: {series: {every: 0.001}}\n"
        "contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5, "
        "rolling_friction: 0.1}]}\n"
        "spheres:\n  - {name: feet, material: ore, radius: 0.02, packing: {kind: lattice, "
        "count: 4, spacing: 0.1, corner: [-0.1, -0.1, -0.031], size: [0.2, 0.2]}}\n"
        "bodies:\n  - {name: floor, material: ore, geometry: {kind: plane, point: [0, 0, 0], "
        "normal: [0, 0, 1], extent: 1}}\n"
        "  - {name: plate, material: ore, geometry: {kind: box, min: [-0.11, -0.1, 0.045], "
        "max: [0.1, 0.1, 0.055]}, free: {density: 1500, damping: 5}}\n",
        MATERIALS);
    verify_steps(sim, 150001);
    const struct rigid *rigid = rigid_of(sim, 1);
    const double weight = rigid->mass * 9.81;
    verify_row("free plate on four spheres: mass", "kg", 1500.0 * 0.21 * 0.2 * 0.01,
               rigid->mass, 1e-14, VERIFY_RELATIVE, "rounding");
    verify_row("force that carries it", "N", weight, verify_series(sim, "plate.force_z"), 1e-5,
               VERIFY_RELATIVE, "balance of forces; what is left of its rocking");
    verify_row("torque about its centre over weight times its length", "",
               weight * rigid->state.centre.y / (weight * 0.21),
               verify_series(sim, "plate.torque_x") / (weight * 0.21), 1e-5, VERIFY_ABSOLUTE,
               "balance of torques");
    verify_row("its middle's height above the floor", "m", 0.045, rigid->state.centre.z, 3e-3,
               VERIFY_RELATIVE,
               "diameter and half of its thickness, less two overlaps of 5e-5");
    verify_scene_free(sim);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Bodies that forces move, among spheres", "Newton, Euler");
    piston();
    collision();
    impact(1.0);
    impact(0.5);
    plate();
    return verify_end();
}
