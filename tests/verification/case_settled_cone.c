/* long */
/*
 * A heap at rest in a smooth cone, once of 10 000 triangles and once of ten times as many: the
 * same weight on the wall, as many contacts with it and pressed as hard. Every heap lies
 * differently, so means over some are compared, by what they scatter.
 */
#include <math.h>
#include <stdlib.h>

#include "run/simulation.h"
#include "surface.h"
#include "verify.h"

enum { HEAPS = 6, SPHERES = 120, STEPS = 40000 };

static const double pi = 3.14159265358979323846;
static const double radius = 0.05, density = 2400.0, young = 2e8, poisson = 0.25, g = 9.81;
static const double dt = 1e-4;

/* Means over the heaps in one mesh, and the scatter of one heap about them. */
struct settled {
    double worst_weight;   /* |force on the cone / weight - 1| */
    double contacts, push; /* number; sum of elastic normal forces over weight */
    double contacts_square, push_square;
};

static void settle(struct settled *settled, int heap, const char *cone)
{
    const double turn = 2.4 * (double)heap;
    struct simulation *sim = verify_scene(
        dt,
        "materials:\n  ore: {density: %g, young: %g, poisson: %g}\n"
        "  wall: {density: 7850, young: 1e15, poisson: 0.3}\n"
        "contact:\n  pairs:\n    - {between: [ore, ore], friction: 0.4, restitution: 0.3}\n"
        "    - {between: [ore, wall], friction: 0.4, restitution: 0.3}\n"
        "gravity: [0, 0, %g]\ndamping: 4\ndomain: {leavers: ignore}\nwatch: {overlap: 0.5}\n"
        "decomposition: {buffer: 0.002}\n"
        "output: {series: {every: 0.1}}\nspheres:\n"
        "  - {name: heap, material: ore, radius: %g, velocity: [%g, %g, -1], packing: {kind: "
        "lattice, count: %d, spacing: 0.105, corner: [-0.27, -0.27, 0.42], size: [0.54, 0.54]}}"
        "\nbodies:\n%s",
        density, young, poisson, -g, radius, 0.3 * cos(turn), 0.3 * sin(turn), SPHERES, cone);
    verify_steps(sim, STEPS + 1);
    const double weight =
        (double)SPHERES * density * 4.0 / 3.0 * pi * radius * radius * radius * g;
    const double modulus = young / (1.0 - poisson * poisson);
    double push = 0.0;
    for (int k = 0; k < sim->facets.n; k++) {
        const double a = sim->facets.list[k].history[CONTACT_RADIUS_LANE];
        push += 4.0 / 3.0 * modulus * a * a * a / radius / weight; /* (1.4), (1.5) */
    }
    const double contacts = verify_series(sim, "n_facet_contacts");
    const double off = fabs(verify_series(sim, "cone.force_z") / weight + 1.0);
    settled->worst_weight = off > settled->worst_weight ? off : settled->worst_weight;
    settled->contacts += contacts / HEAPS;
    settled->contacts_square += contacts * contacts / HEAPS;
    settled->push += push / HEAPS;
    settled->push_square += push * push / HEAPS;
    verify_scene_free(sim);
}

/* Three standard errors of the difference of two means, but no more than 5 % of the second. */
static double three_errors(double mean_a, double square_a, double mean_b, double square_b)
{
    const double variances = square_a - mean_a * mean_a + square_b - mean_b * mean_b;
    return fmin(3.0 * sqrt(variances / (double)(HEAPS - 1)), 0.05 * mean_b);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "A heap at rest in a cone of triangles",
                 "equilibrium; a mesh ten times finer");
    struct settled settled[2] = {{.worst_weight = 0.0}};
    for (int mesh = 0; mesh < 2; mesh++) {
        const struct surface surface = {.radius = {0.1, 1.0},
                                        .z = {0.0, 1.2},
                                        .n_around = mesh == 0 ? 100 : 316,
                                        .n_rings = mesh == 0 ? 50 : 158,
                                        .has_floor = true};
        char *cone = surface_body("cone", "wall", &surface);
        for (int heap = 0; heap < HEAPS; heap++)
            settle(&settled[mesh], heap, cone);
        free(cone);
    }
    const struct settled *coarse = &settled[0], *fine = &settled[1];
    static const char rest[] = "what still moves: accelerations below 1e-3 g";
    verify_row("10 100 triangles: force on the cone over weight, off by", "", 0.0,
               coarse->worst_weight, 1e-3, VERIFY_AT_MOST, rest);
    verify_row("100 172 triangles: force on the cone over weight, off by", "", 0.0,
               fine->worst_weight, 1e-3, VERIFY_AT_MOST, rest);
    static const char scatter[] =
        "three standard errors of the means of six heaps each; 5 % at most";
    verify_row("contacts with 10 100 triangles, expected: with 100 172", "", fine->contacts,
               coarse->contacts,
               three_errors(coarse->contacts, coarse->contacts_square, fine->contacts,
                            fine->contacts_square),
               VERIFY_ABSOLUTE, scatter);
    verify_row("normal forces over weight, the same", "", fine->push, coarse->push,
               three_errors(coarse->push, coarse->push_square, fine->push, fine->push_square),
               VERIFY_ABSOLUTE, scatter);
    return verify_end();
}
