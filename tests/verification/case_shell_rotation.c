/*
 * Shells and membranes that turn as rigid bodies: prescribed turns strain nothing, however far
 * a step turns, warped or not; what they remember turns along; and free ones keep their energy
 * and hold the stress of theory.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/shell_sheet.h"
#include "job/job.h"
#include "specimen.h"
#include "verify.h"

static const struct solid_material steel = {7850.0, 2.1e11, 0.3, 0.0, 1.0, 0.0, 0, NULL, 0.0};

/* A distorted, warped sheet is turned about an axis askew. */
static void prescribed(const char *name, enum solid_element_shape shape, double turns,
                       int n_steps)
{
    const double time = 1.0, askew = 1.0 / sqrt(3.0);
    const struct job_motion motion = {
        .axis = {askew, askew, askew}, .rate = 2.0 * M_PI * turns / time, .stop = 1e9};
    struct shell_sheet sheet;
    struct specimen specimen;
    uint64_t seed = 4;
    int *all;
    char text[128];
    double most = 0.0;
    shell_sheet_build(&sheet, 4, 3, (const double[2]){1.0, 1.0}, shape, 0.05, 3);
    shell_sheet_distort(&sheet, 0.08, &seed);
    for (int i = 0; i < sheet.mesh.n_nodes; i++)
        sheet.mesh.places[i][2] = 0.1 * solid_block_random(&seed);
    specimen_make(&specimen, &sheet.mesh, &steel, 1.0);
    struct solid *solid = &specimen.solid;
    specimen.dt = time / n_steps;
    all = calloc((size_t)solid->n_nodes, sizeof *all);
    for (int i = 0; i < solid->n_nodes; i++)
        all[i] = i;
    solid_supports_add_motion(&solid->supports, 1, &motion, solid->n_nodes, all);
    specimen_steps(&specimen, n_steps + 1);
    for (int e = 0; e < solid->n_elements; e++) {
        for (int l = 0; l < solid->layers; l++)
            for (int k = 0; k < 3; k++)
                most = fmax(most, fabs(solid->shell[e].layer[l][k]));
        most = fmax(most, fmax(fabs(solid->shell[e].shear[0]), fabs(solid->shell[e].shear[1])));
    }
    snprintf(text, sizeof text, "%s, %g turns in %d steps: stress over modulus", name, turns,
             n_steps);
    verify_row(text, "", 0.0, most / 2.1e11, 1e-15 * (n_steps + 2), VERIFY_AT_MOST,
               "rounding of each step");
    free(all);
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
}

/* ------------------------------------------------------------------------------- free */

static const double LENGTH = 1.0, WIDTH = 0.05, THICK = 0.01, SPIN = 300.0;

static double momentum_about(const struct solid *solid, int axis)
{
    const int j = (axis + 1) % 3, k = (axis + 2) % 3;
    double sum = 0.0;
    for (int i = 0; i < solid->n_nodes; i++) {
        const double *x = solid_place(solid, i), *v = solid_velocity(solid, i);
        sum += solid->mass[i] * (x[j] * v[k] - x[k] * v[j]);
        if (solid->turns.n_nodes > 0)
            sum += solid->turns.inertia[i] * solid_turn_spin(&solid->turns, i)[axis];
    }
    return sum;
}

/* A strip spins about its normal (2) or across it (1).  Lumped masses and the sheet's own
 * inertia are what turns. */
static void spin_it(struct solid *solid, double dt, int axis)
{
    for (int i = 0; i < solid->n_nodes; i++) {
        /* v at -dt/2 of a rigid turn to the second order */
        const double *x = solid->reference[i], back = 0.5 * SPIN * dt;
        const int j = (axis + 1) % 3, k = (axis + 2) % 3;
        solid_velocity(solid, i)[j] = SPIN * (-x[k] + back * x[j]);
        solid_velocity(solid, i)[k] = SPIN * (x[j] + back * x[k]);
        if (solid->turns.n_nodes > 0)
            solid_turn_spin(&solid->turns, i)[axis] = SPIN;
    }
}

static double energy_of(struct specimen *specimen)
{
    const struct solid_energies energies = specimen_energies(specimen);
    return solid_energy_value(&energies, SOLID_ENERGY_KINETIC) +
           solid_energy_value(&energies, SOLID_ENERGY_ELASTIC);
}

/* Stress along the strip in element e. */
static double along(const struct solid *solid, int e, int cells)
{
    const double *tip = solid_place(solid, cells), *root = solid_place(solid, 0);
    double axis[3], length = 0.0;
    for (int d = 0; d < 3; d++) {
        axis[d] = tip[d] - root[d];
        length += axis[d] * axis[d];
    }
    const double *s = solid->state[e].stress;
    return (axis[0] * axis[0] * s[0] + axis[1] * axis[1] * s[1] + axis[2] * axis[2] * s[2] +
            2.0 * (axis[0] * axis[1] * s[3] + axis[1] * axis[2] * s[4] +
                   axis[2] * axis[0] * s[5])) /
           length;
}

static void free_spin(const char *name, enum solid_element_shape shape, int cells, int axis)
{
    const int per_cell = solid_element_corners(shape) == 3 ? 2 : 1;
    struct solid_material damped = steel;
    struct shell_sheet sheet;
    struct specimen specimen;
    char text[160];
    damped.damping = 1e-5;
    shell_sheet_build(&sheet, cells, 1, (const double[2]){LENGTH, WIDTH}, shape, THICK, 2);
    for (int i = 0; i < sheet.mesh.n_nodes; i++) {
        sheet.mesh.places[i][0] -= 0.5 * LENGTH;
        sheet.mesh.places[i][1] -= 0.5 * WIDTH;
    }
    specimen_make(&specimen, &sheet.mesh, &damped, 0.8);
    struct solid *solid = &specimen.solid;
    spin_it(solid, specimen.dt, axis);
    const double l_before = momentum_about(solid, axis);
    const double per_turn = 2.0 * M_PI / SPIN / specimen.dt;
    specimen_steps(&specimen, (int64_t)per_turn);
    const double before = energy_of(&specimen);
    specimen_steps(&specimen, (int64_t)(3.0 * per_turn));
    const double after = energy_of(&specimen), l_after = momentum_about(solid, axis);
    double worst = 0.0;
    const double middle = 0.125 * 7850.0 * SPIN * SPIN * LENGTH * LENGTH;
    for (int e = 0; e < cells; e++) {
        const double x = (e + 0.5) / cells - 0.5;
        double sum = 0.0;
        for (int k = 0; k < per_cell; k++)
            sum += along(solid, per_cell * e + k, cells) / per_cell;
        worst = fmax(worst, fabs(sum - middle * (1.0 - 4.0 * x * x)));
    }
    snprintf(text, sizeof text, "%s, %d cells: largest error of stress over that in the middle",
             name, cells);
    verify_row(text, "", 0.0, worst / middle, 1.5 / (cells * cells) + 0.003, VERIFY_AT_MOST,
               "second order of the cells' length, and strain");
    snprintf(text, sizeof text,
             "%s, %d cells: kinetic and elastic energy after three turns over before", name,
             cells);
    verify_row(text, "", 1.0, after / before, 1e-6, VERIFY_ABSOLUTE, "asked for");
    snprintf(text, sizeof text, "%s, %d cells: angular momentum after over before", name,
             cells);
    verify_row(text, "", 1.0, l_after / l_before, 1e-10, VERIFY_ABSOLUTE, "rounding");
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Shells and membranes that turn", "a rigid turn strains nothing");
    prescribed("quadrilaterals of a shell", SOLID_ELEMENT_SHELL_QUAD, 0.25, 25);
    prescribed("quadrilaterals of a shell", SOLID_ELEMENT_SHELL_QUAD, 0.25, 1);
    prescribed("quadrilaterals of a shell", SOLID_ELEMENT_SHELL_QUAD, 5.0, 500);
    prescribed("triangles of a shell", SOLID_ELEMENT_SHELL_TRIANGLE, 5.0, 500);
    prescribed("quadrilaterals of a membrane", SOLID_ELEMENT_MEMBRANE_QUAD, 5.0, 500);
    prescribed("triangles of a membrane", SOLID_ELEMENT_MEMBRANE_TRIANGLE, 5.0, 500);
    verify_source("rho w^2 (L^2/4 - x^2)/2");
    free_spin("strip of a shell about its normal", SOLID_ELEMENT_SHELL_QUAD, 20, 2);
    free_spin("strip of a shell across", SOLID_ELEMENT_SHELL_QUAD, 10, 1);
    free_spin("strip of a shell across", SOLID_ELEMENT_SHELL_QUAD, 20, 1);
    free_spin("strip of triangles of a shell across", SOLID_ELEMENT_SHELL_TRIANGLE, 20, 1);
    free_spin("strip of a membrane about its normal", SOLID_ELEMENT_MEMBRANE_QUAD, 20, 2);
    return verify_end();
}
