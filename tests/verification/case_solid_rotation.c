/*
 * Solids that turn.  As prescribed, by quarter and full turns: no strain, and stress that is
 * there turns along.  Free: a bar about its middle is stretched to rho w^2 (L^2/4 - x^2)/2.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/solid_block.h"
#include "job/job.h"
#include "specimen.h"
#include "verify.h"

static const struct solid_material steel = {7850.0, 2.1e11, 0.3, 0.0, 0.1, 0.02, 0, NULL, 0.0};

static void prescribed(const char *name, bool tetrahedra, double turns, int n_steps)
{
    const struct job_motion motion = {.pivot = {0.3, 2.0, -1.0},
                                      .axis = {1.0 / 3.0, 2.0 / 3.0, 2.0 / 3.0},
                                      .rate = 2.0 * M_PI,
                                      .stop = 1e9};
    struct solid_block block;
    struct specimen specimen;
    char text[128];
    uint64_t seed = 3;
    solid_block_build(&block, 3, 3, 3, (const double[3]){1.0, 1.0, 1.0}, tetrahedra);
    solid_block_distort(&block, 0.08, &seed);
    specimen_make(&specimen, &block.mesh, &steel, 1.0);
    specimen.dt = turns / n_steps;
    int *all = calloc((size_t)block.mesh.n_nodes, sizeof *all);
    for (int i = 0; i < block.mesh.n_nodes; i++)
        all[i] = i;
    solid_supports_add_motion(&specimen.solid.supports, 1, &motion, block.mesh.n_nodes, all);
    specimen_steps(&specimen, n_steps + 1);
    const double step = 2.0 * M_PI * turns / n_steps;
    /* A place is rounded to 4e-16 and a cell is a third wide; so is each step's strain. */
    const double each = 3.0 * 4e-16;
    snprintf(text, sizeof text,
             "%s, %g turns in %d steps of %.1f degrees: largest stress over Young's modulus",
             name, turns, n_steps, step * 180.0 / M_PI);
    verify_row(text, "", 0.0, specimen_stress_most(&specimen) / steel.young,
               10.0 * each * sqrt((double)n_steps), VERIFY_AT_MOST,
               "rounding of places, step by step, on no side");
    snprintf(text, sizeof text, "%s, %g turns: largest hourglass force over modulus and area",
             name, turns);
    if (!tetrahedra)
        verify_row(text, "", 0.0, specimen_hourglass_most(&specimen) / steel.young,
                   10.0 * each * sqrt((double)n_steps), VERIFY_AT_MOST, "the same");
    free(all);
    specimen_free(&specimen);
    solid_block_free(&block);
}

/* A quarter turn about z in 30 steps, with stress in it: xx and yy change places, zx becomes
 * yz, and so on; hourglass forces turn too. */
static void carried(void)
{
    static const double before[6] = {3e8, 1e8, 2e8, 4e7, 5e7, 6e7};
    static const double after[6] = {1e8, 3e8, 2e8, -4e7, 6e7, -5e7};
    const struct job_motion motion = {.axis = {0.0, 0.0, 1.0}, .rate = 0.5 * M_PI, .stop = 1e9};
    struct solid_block block;
    struct specimen specimen;
    int all[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    double most = 0.0;
    solid_block_build(&block, 1, 1, 1, (const double[3]){1.0, 1.0, 1.0}, false);
    specimen_make(&specimen, &block.mesh, &steel, 1.0);
    specimen.dt = 1.0 / 30.0;
    struct solid_element_state *state = &specimen.solid.state[0];
    for (int k = 0; k < 6; k++)
        state->stress[k] = before[k];
    state->hourglass[2][0] = 1e6;
    solid_supports_add_motion(&specimen.solid.supports, 1, &motion, 8, all);
    specimen_steps(&specimen, 31);
    for (int k = 0; k < 6; k++)
        most = fmax(most, fabs(state->stress[k] - after[k]));
    verify_row("stress turned by 90 degrees: largest error over the stress", "", 0.0,
               most / 3e8, 1e-11, VERIFY_AT_MOST,
               "rounding of strains, 4e-16 times the modulus over the stress, 30 times");
    verify_row("hourglass force turned by 90 degrees: error", "N", 1e6, state->hourglass[2][1],
               1e-9, VERIFY_RELATIVE, "rounding");
    specimen_free(&specimen);
    solid_block_free(&block);
}

/* ------------------------------------------------------------------------------- free */

static const double LENGTH = 1.0, SIDE = 0.05, SPIN = 400.0;

/* Stress along the bar in its element e. */
static double along(const struct solid *solid, int e, int tip, int root)
{
    double axis[3], length = 0.0;
    for (int d = 0; d < 3; d++) {
        axis[d] = solid_place(solid, tip)[d] - solid_place(solid, root)[d];
        length += axis[d] * axis[d];
    }
    const double *s = solid->state[e].stress;
    return (axis[0] * axis[0] * s[0] + axis[1] * axis[1] * s[1] + axis[2] * axis[2] * s[2] +
            2.0 * (axis[0] * axis[1] * s[3] + axis[1] * axis[2] * s[4] +
                   axis[2] * axis[0] * s[5])) /
           length;
}

static double angular_momentum(const struct solid *solid)
{
    double sum = 0.0;
    for (int i = 0; i < solid->n_nodes; i++) {
        const double *x = solid_place(solid, i), *v = solid_velocity(solid, i);
        sum += solid->mass[i] * (x[0] * v[1] - x[1] * v[0]);
    }
    return sum;
}

static double motion_and_stress(const struct solid_energies *energies)
{
    return solid_energy_value(energies, SOLID_ENERGY_KINETIC) +
           solid_energy_value(energies, SOLID_ENERGY_ELASTIC);
}

static void free_spin(int cells)
{
    struct solid_material damped = steel;
    struct solid_block block;
    struct specimen specimen;
    char text[128];
    damped.damping = 1e-5;
    solid_block_build(&block, cells, 1, 1, (const double[3]){LENGTH, SIDE, SIDE}, false);
    for (int i = 0; i < block.mesh.n_nodes; i++)
        for (int d = 0; d < 3; d++)
            block.mesh.places[i][d] -= 0.5 * (d == 0 ? LENGTH : SIDE);
    specimen_make(&specimen, &block.mesh, &damped, 0.8);
    struct solid *solid = &specimen.solid;
    for (int i = 0; i < solid->n_nodes; i++) {
        /* v at -dt/2 of a rigid turn to the second order */
        const double *x = solid->reference[i], back = 0.5 * SPIN * specimen.dt;
        solid_velocity(solid, i)[0] = SPIN * (-x[1] + back * x[0]);
        solid_velocity(solid, i)[1] = SPIN * (x[0] + back * x[1]);
    }
    const double l_before = angular_momentum(solid);
    const double per_turn = 2.0 * M_PI / SPIN / specimen.dt;
    specimen_steps(&specimen, (int64_t)per_turn);
    const struct solid_energies before = specimen_energies(&specimen);
    specimen_steps(&specimen, (int64_t)(3.0 * per_turn));
    const struct solid_energies after = specimen_energies(&specimen);
    const double l_after = angular_momentum(solid);
    const int tip = solid_block_node(&block, cells, 0, 0), root = 0;
    double worst = 0.0, length = 0.0, spin = 0.0;
    for (int d = 0; d < 3; d++)
        length += pow(solid_place(solid, tip)[d] - solid_place(solid, root)[d], 2.0);
    length = sqrt(length);
    spin = SPIN * pow(LENGTH / length, 2.0);
    const double middle = 0.125 * 7850.0 * spin * spin * length * length;
    for (int e = 0; e < cells; e++) {
        const double x = ((e + 0.5) / cells - 0.5) * length;
        const double theory = middle * (1.0 - 4.0 * x * x / (length * length));
        worst = fmax(worst, fabs(along(solid, e, tip, root) - theory));
    }
    snprintf(text, sizeof text,
             "bar of %d cells, turning freely: largest error of stress over that in the middle",
             cells);
    verify_row(text, "", 0.0, worst / middle, 1.0 / (cells * cells) + 0.002, VERIFY_AT_MOST,
               "second order of the cells' length, and strain");
    snprintf(text, sizeof text, "bar of %d cells: stress in the middle", cells);
    verify_row(text, "Pa", middle, along(solid, cells / 2, tip, root), 0.01, VERIFY_RELATIVE,
               "the same");
    snprintf(text, sizeof text,
             "bar of %d cells: kinetic and elastic energy after three turns over before",
             cells);
    verify_row(text, "", 1.0, motion_and_stress(&after) / motion_and_stress(&before), 1e-6,
               VERIFY_ABSOLUTE, "asked for");
    snprintf(text, sizeof text, "bar of %d cells: angular momentum after over before", cells);
    verify_row(text, "", 1.0, l_after / l_before, 1e-11, VERIFY_ABSOLUTE, "rounding");
    specimen_free(&specimen);
    solid_block_free(&block);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Solids that turn", "a rigid turn strains nothing");
    prescribed("hexahedra", false, 0.25, 25);
    prescribed("hexahedra", false, 0.25, 1);
    prescribed("hexahedra", false, 5.0, 500);
    prescribed("tetrahedra", true, 0.25, 25);
    prescribed("tetrahedra", true, 5.0, 500);
    carried();
    verify_source("rho w^2 (L^2/4 - x^2)/2");
    free_spin(10);
    free_spin(20);
    return verify_end();
}
