/*
 * Energy of shells and membranes: work of elements, loads, moments, supports, gravity and
 * damping against motion, and what elements took up against where it is.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/shell_sheet.h"
#include "solid/solid_side.h"
#include "specimen.h"
#include "verify.h"

static const struct solid_yield_point yield[2] = {{0.0, 2e6}, {0.02, 3e6}};
static const struct solid_material tough = {1000.0, 1e9, 0.3, 3e-6, 0.2, 0.0, 2, yield, 1e7};
static const struct solid_material elastic = {1000.0, 1e9, 0.3, 0.0, 0.2, 0.0, 0, NULL, 0.0};

struct outcome {
    double balance; /* over all energy that came in [-] */
    double held;    /* internal energy that is nowhere, over internal energy [-] */
    double share[SOLID_N_ENERGIES]; /* over internal energy [-] */
};

/* A distorted, warped sheet that is shaken at one side, with pressure, moments, gravity and
 * damping, for 30 ms; all loads by a factor, and so many steps. */
static struct outcome shake(const struct solid_material *material,
                            enum solid_element_shape shape, double factor, int n_steps)
{
    struct shell_sheet sheet;
    struct specimen specimen;
    struct outcome outcome = {0};
    uint64_t seed = 9;
    int *nodes;
    shell_sheet_build(&sheet, 6, 5, (const double[2]){3.0, 2.5}, shape, 0.1, 3);
    shell_sheet_distort(&sheet, 0.1, &seed);
    for (int i = 0; i < sheet.mesh.n_nodes; i++)
        sheet.mesh.places[i][2] = 0.05 * solid_block_random(&seed);
    specimen_make(&specimen, &sheet.mesh, material, 1.0);
    specimen.dt = 0.03 / n_steps;
    struct solid *solid = &specimen.solid;
    const struct solid_table foot = {
        3,
        (struct solid_table_point[]){{0.0, 0.0}, {0.01, 3.0 * factor}, {0.02, -3.0 * factor}}};
    const struct solid_table rising = {2,
                                       (struct solid_table_point[]){{0.0, 0.0}, {0.02, 1.0}}};
    const int n = specimen_plane(&specimen, 0, 0.0, &nodes);
    solid_supports_add(&solid->supports, SOLID_SUPPORT_VELOCITY, 0, &foot, n, nodes);
    solid_supports_add(&solid->supports, SOLID_SUPPORT_VELOCITY, 2, &foot, n, nodes);
    solid_supports_add(&solid->supports, SOLID_SUPPORT_FIXED, 1, NULL, n, nodes);
    if (shell_element_turns(shape)) {
        const int tip = solid->n_nodes - 1;
        solid_supports_add_turn(&solid->supports, SOLID_SUPPORT_FIXED, 1, NULL, n, nodes);
        solid_loads_add_moment(&solid->loads, (struct vec3){0.0, 300.0 * factor, 0.0}, &rising,
                               1, &tip);
    }
    const struct solid_side last = {solid->n_elements - 1, 1};
    solid_loads_add_pressure(&solid->loads, 1e4 * factor, &rising, 1, &last);
    solid->gravity[2] = -9.81 * factor;
    solid->damping = 5.0;
    specimen_steps(&specimen, n_steps);
    const struct solid_energies energies = specimen_energies(&specimen);
    double inside = 0.0;
    for (int k = SOLID_ENERGY_ELASTIC; k < SOLID_N_ENERGIES; k++)
        inside += solid_energy_value(&energies, (enum solid_energy)k);
    const double internal = solid_energy_value(&energies, SOLID_ENERGY_INTERNAL);
    outcome.balance = solid_energy_balance(&energies) /
                      (internal + solid_energy_value(&energies, SOLID_ENERGY_KINETIC));
    outcome.held = (internal - inside) / internal;
    for (int k = 0; k < SOLID_N_ENERGIES; k++)
        outcome.share[k] = solid_energy_value(&energies, (enum solid_energy)k) / internal;
    free(nodes);
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
    return outcome;
}

static void compare(const char *name, enum solid_element_shape shape)
{
    char text[128];
    const struct outcome small = shake(&elastic, shape, 0.001, 1000),
                         hard = shake(&tough, shape, 1.0, 1000);
    snprintf(text, sizeof text, "%s, elastic: balance over energy", name);
    verify_row(text, "", 0.0, small.balance, 1e-11, VERIFY_ABSOLUTE, "rounding");
    snprintf(text, sizeof text, "%s, plastic: balance over energy", name);
    verify_row(text, "", 0.0, hard.balance, 1e-11, VERIFY_ABSOLUTE, "rounding");
    snprintf(text, sizeof text, "%s, elastic, small strain: internal energy not found again",
             name);
    verify_row(text, "", 0.0, small.held, 0.001, VERIFY_ABSOLUTE, "strain and step");
    snprintf(text, sizeof text, "%s, plastic: internal energy not found again", name);
    verify_row(text, "", 0.0, hard.held, 0.01, VERIFY_ABSOLUTE, "asked for");
    snprintf(text, sizeof text, "%s, plastic: share of energy that flow took", name);
    verify_row(text, "", 0.05, hard.share[SOLID_ENERGY_PLASTIC], 0.0, VERIFY_AT_LEAST,
               "it flows");
    snprintf(text, sizeof text, "%s: hourglass energy over internal energy", name);
    verify_row(text, "", 0.1, hard.share[SOLID_ENERGY_HOURGLASS], 0.0, VERIFY_AT_MOST,
               "what runs are stopped at");
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Energy of shells and membranes",
                 "kinetic + internal + damping = work done from outside");
    compare("quadrilaterals of a shell", SOLID_ELEMENT_SHELL_QUAD);
    compare("triangles of a shell", SOLID_ELEMENT_SHELL_TRIANGLE);
    compare("quadrilaterals of a membrane", SOLID_ELEMENT_MEMBRANE_QUAD);
    compare("triangles of a membrane", SOLID_ELEMENT_MEMBRANE_TRIANGLE);
    return verify_end();
}
