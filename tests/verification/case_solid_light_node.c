/*
 * A contact's spring on the end of an elastic rod, a node of half a cell's mass: the step that
 * is stable, found by trying, against theory and against the bound that the program goes by.
 * gamma is the spring over E A / h of a cell; steps are over h/c.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/solid_block.h"
#include "solid/solid_limits.h"
#include "specimen.h"
#include "verify.h"

enum { CELLS = 10, STEPS = 6000 };
static const struct solid_material unit = {1.0, 1.0, 0.0, 0.0, 0.1, 0.0, 0, NULL, 0.0};

static void push(struct specimen *specimen, void *what)
{
    const double stiffness = *(const double *)what;
    struct solid *solid = &specimen->solid;
    for (int i = 0; i < solid->n_nodes; i++)
        if (solid->reference[i][0] == 0.0)
            solid->contact[i][0] = -stiffness * solid_place(solid, i)[0];
}

/* Does a small motion stay small? */
static bool is_stable(struct solid_block *block, double stiffness, double damping, double dt)
{
    struct solid_material material = unit;
    struct specimen specimen;
    uint64_t seed = 1;
    double most = 0.0;
    material.damping = damping;
    specimen_make(&specimen, &block->mesh, &material, 1.0);
    specimen.dt = dt;
    for (int i = 0; i <= CELLS; i++) { /* cross-sections move as one */
        const double v = 1e-9 * solid_block_random(&seed);
        for (int k = 0; k < 4; k++)
            solid_velocity(&specimen.solid, solid_block_node(block, i, k % 2, k / 2))[0] = v;
    }
    for (int n = 0; n < STEPS && most < 1e-5; n++) {
        specimen_pushed_steps(&specimen, 1, push, &stiffness);
        for (int i = 0; i < specimen.solid.n_nodes; i++)
            most = fmax(most, fabs(solid_velocity(&specimen.solid, i)[0]));
    }
    specimen_free(&specimen);
    return most < 1e-7;
}

static double largest_stable(struct solid_block *block, double stiffness, double damping)
{
    double low = 0.05, high = 1.05;
    while (high - low > 2e-4) {
        const double middle = 0.5 * (low + high);
        if (is_stable(block, stiffness, damping, middle))
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* What the program allows: springs on the four nodes of the end. */
static double allowed(struct solid_block *block, double stiffness, double damping)
{
    struct solid_material material = unit;
    struct solid solid;
    material.damping = damping;
    solid_create(&solid, &block->mesh, 1, &material, ISA_AUTO);
    double *of_node = calloc((size_t)solid.n_nodes, sizeof *of_node);
    for (int i = 0; i < solid.n_nodes; i++)
        if (solid.reference[i][0] == 0.0)
            of_node[i] = stiffness;
    const double step = solid_limits_find(&solid, of_node, NULL).step;
    free(of_node);
    solid_destroy(&solid);
    return step;
}

/* The rod by itself, damped: xi of the fastest motion, of frequency 2 c/h. */
static void damped_rod(struct solid_block *block)
{
    static const double ratios[] = {0.1, 0.5, 1.0};
    for (int k = 0; k < 3; k++) {
        const double xi = ratios[k], expected = sqrt(1.0 + xi * xi) - xi;
        char text[96];
        verify_source("sqrt(1 + xi^2) - xi");
        snprintf(text, sizeof text, "no spring, damping ratio %g: largest stable step", xi);
        verify_row(text, "h/c", expected, largest_stable(block, 0.0, xi), 0.002,
                   VERIFY_RELATIVE, "bisection to 2e-4");
        snprintf(text, sizeof text, "no spring, damping ratio %g: step allowed", xi);
        verify_row(text, "h/c", expected, allowed(block, 0.0, xi), 5e-4, VERIFY_RELATIVE,
                   "an eigenvalue that is found to 3e-4");
    }
}

int main(int argc, char **argv)
{
    static const struct {
        double gamma, exact;
    } rows[] = {{0.25, 0.9924}, {0.5, 0.9717},  {1.0, 0.9102},
                {2.0, 0.7862},  {10.0, 0.4254}, {100.0, 0.1407}};
    struct solid_block block;
    verify_begin(argc, argv, "Solids: a contact's spring on a light node", "");
    solid_block_build(&block, CELLS, 1, 1, (const double[3]){CELLS, 1.0, 1.0}, false);
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        const double stiffness = 0.25 * rows[k].gamma; /* of each of four nodes */
        const double stable = largest_stable(&block, stiffness, 0.0);
        const double bound = allowed(&block, stiffness, 0.0);
        char text[96];
        verify_source("largest eigenvalue of the rod");
        snprintf(text, sizeof text, "gamma %g: largest stable step", rows[k].gamma);
        verify_row(text, "h/c", rows[k].exact, stable, 0.004, VERIFY_RELATIVE,
                   "growth over some thousand steps must show; bisection to 2e-4");
        verify_source("1/sqrt(1 + gamma/2)");
        snprintf(text, sizeof text, "gamma %g: step allowed", rows[k].gamma);
        verify_row(text, "h/c", 1.0 / sqrt(1.0 + 0.5 * rows[k].gamma), bound, 5e-4,
                   VERIFY_RELATIVE, "an eigenvalue that is found to 3e-4");
        snprintf(text, sizeof text, "gamma %g: step allowed over the stable one",
                 rows[k].gamma);
        verify_row(text, "", 1.0, bound / stable, 0.0, VERIFY_AT_MOST, "a bound");
    }
    damped_rod(&block);
    solid_block_free(&block);
    return verify_end();
}
