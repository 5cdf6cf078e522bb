/*
 * Patch tests of distorted hexahedra and tetrahedra (MacNeal and Harder): nodes displaced by a
 * linear field, or only those of the surface while those inside find their places, must give
 * uniform stress.  E 1e6, nu .25 and gradients of 1e-3 give direct stress 2000, shear 400.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/solid_block.h"
#include "specimen.h"
#include "verify.h"

enum { CELLS = 3 };
static const struct solid_material stuff = {1000.0, 1e6, 0.25, 0.0, 0.1, 0.0, 0, NULL, 0.0};

/* u = g/2 (2x + y + z), v = g/2 (x + 2y + z), w = g/2 (x + y + 2z). */
static double field(const double x[3], int d, double g)
{
    return 0.5 * g * (x[0] + x[1] + x[2] + x[d]);
}

static void make(struct solid_block *block, bool tetrahedra)
{
    uint64_t seed = 11;
    solid_block_build(block, CELLS, CELLS, CELLS, (const double[3]){1.0, 1.0, 1.0}, tetrahedra);
    solid_block_distort(block, 0.08, &seed);
}

/* Largest distances of all stresses from direct ones and shears. */
static double distance(const struct specimen *specimen, double direct, double shear)
{
    double most = 0.0;
    for (int e = 0; e < specimen->solid.n_elements; e++)
        for (int k = 0; k < 6; k++)
            most =
                fmax(most, fabs(specimen->solid.state[e].stress[k] - (k < 3 ? direct : shear)));
    return most;
}

/* In one step.  With the eigenvalues 2 g and g/2 of the gradient, (12.3) has rates of
 * 2 g/(1 + g) and g/2/(1 + g/4). */
static void in_one_step(const char *name, bool tetrahedra)
{
    const double g = 1e-3, mu = 4e5, lambda = 4e5;
    const double along = 2.0 * g / (1.0 + g), across = 0.5 * g / (1.0 + 0.25 * g);
    const double direct =
        lambda * (along + 2.0 * across) + 2.0 * mu * (across + (along - across) / 3.0);
    const double shear = 2.0 * mu * (along - across) / 3.0;
    struct solid_block block;
    struct specimen specimen;
    char text[128];
    make(&block, tetrahedra);
    specimen_make(&specimen, &block.mesh, &stuff, 0.5);
    struct solid *solid = &specimen.solid;
    for (int i = 0; i < solid->n_nodes; i++)
        for (int d = 0; d < 3; d++) {
            const double u = field(solid->reference[i], d, g);
            solid_place(solid, i)[d] += u;
            solid_velocity(solid, i)[d] = u / specimen.dt;
        }
    solid_forces(solid, 1, specimen.dt);
    double unbalanced = 0.0;
    for (int i = 0; i < solid->n_nodes; i++)
        for (int d = 0; solid_block_is_inside(&block, i) && d < 3; d++)
            unbalanced = fmax(unbalanced, fabs(solid->internal[i][d]));
    snprintf(text, sizeof text, "%s, in one step: direct stress", name);
    verify_row(text, "Pa", 2000.0, solid->state[0].stress[0], 2.0 * g, VERIFY_RELATIVE,
               "displacements are finite");
    snprintf(text, sizeof text, "%s, in one step: shear stress", name);
    verify_row(text, "Pa", 400.0, solid->state[0].stress[4], 2.0 * g, VERIFY_RELATIVE,
               "displacements are finite");
    snprintf(text, sizeof text, "%s, in one step: largest distance of any stress from exact",
             name);
    verify_row(text, "Pa", 0.0, distance(&specimen, direct, shear), 2000.0 * 1e-12,
               VERIFY_ABSOLUTE, "rounding of displacements: 1e-16 over 1e-3");
    snprintf(text, sizeof text, "%s, in one step: largest force on a node inside", name);
    verify_row(text, "N", 0.0, unbalanced, 1e-12 * 2000.0 / (CELLS * CELLS), VERIFY_ABSOLUTE,
               "rounding, beside stress times the side of a cell");
    snprintf(text, sizeof text, "%s, in one step: largest hourglass force", name);
    verify_row(text, "N", 0.0, specimen_hourglass_most(&specimen), 2000.0 * 1e-13,
               VERIFY_ABSOLUTE, "rounding");
    specimen_free(&specimen);
    solid_block_free(&block);
}

/* The surface moves there over a thousand steps, what is inside follows, damped. */
static void settled(const char *name, bool tetrahedra)
{
    const double g = 1e-6;
    struct solid_block block;
    struct specimen specimen;
    char text[128];
    make(&block, tetrahedra);
    specimen_make(&specimen, &block.mesh, &stuff, 0.9);
    struct solid *solid = &specimen.solid;
    for (int i = 0; i < solid->n_nodes; i++)
        for (int d = 0; !solid_block_is_inside(&block, i) && d < 3; d++) {
            const double u = field(solid->reference[i], d, g);
            const struct solid_table ramp = {
                2, (struct solid_table_point[]){{0.0, 0.0}, {1000 * specimen.dt, u}}};
            solid_supports_add(&solid->supports, SOLID_SUPPORT_DISPLACEMENT, d, &ramp, 1, &i);
        }
    solid->damping = 100.0;
    specimen_steps(&specimen, 2500);
    snprintf(text, sizeof text, "%s, settled: largest distance of any direct or shear stress",
             name);
    verify_row(text, "Pa", 0.0, distance(&specimen, 2.0, 0.4), 2.0 * 1e-5, VERIFY_ABSOLUTE,
               "finite displacements, 2e-6, and what still swings");
    specimen_free(&specimen);
    solid_block_free(&block);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Solids: patch tests",
                 "MacNeal and Harder 1985, solid patch; E 1e6, nu .25");
    in_one_step("hexahedra", false);
    in_one_step("tetrahedra", true);
    settled("hexahedra", false);
    settled("tetrahedra", true);
    return verify_end();
}
