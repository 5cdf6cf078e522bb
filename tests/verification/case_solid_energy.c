/*
 * Energy of solids: work of elements, loads, supports, gravity and damping against motion, and
 * what elements took up against where it is.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/solid_block.h"
#include "solid/solid_side.h"
#include "specimen.h"
#include "verify.h"

static const struct solid_yield_point yield[2] = {{0.0, 2e6}, {0.02, 3e6}};
static const struct solid_material tough = {1000.0, 1e9, 0.3, 3e-6, 0.1, 0.05, 2, yield, 1e7};
static const struct solid_material elastic = {1000.0, 1e9, 0.3, 0.0, 0.1, 0.0, 0, NULL, 0.0};

struct outcome {
    double balance; /* over all energy that came in [-] */
    double held;    /* internal energy that is nowhere, over internal energy [-] */
    double share[SOLID_N_ENERGIES]; /* over what came in [-] */
};

/* A distorted block whose foot is shaken, with pressure on its top, gravity and damping, for 30
 * ms; all loads by a factor. */
static struct outcome shake(const struct solid_material *material, bool tetrahedra,
                            double factor)
{
    enum { STEPS = 400 };
    struct solid_block block;
    struct specimen specimen;
    struct outcome outcome = {0};
    uint64_t seed = 9;
    solid_block_build(&block, 3, 3, 4, (const double[3]){3.0, 3.0, 4.0}, tetrahedra);
    solid_block_distort(&block, 0.2, &seed);
    specimen_make(&specimen, &block.mesh, material, 1.0);
    specimen.dt = 0.03 / STEPS;
    struct solid *solid = &specimen.solid;
    const struct solid_table foot = {
        3,
        (struct solid_table_point[]){{0.0, 0.0}, {0.01, 3.0 * factor}, {0.02, -3.0 * factor}}};
    const struct solid_table rising = {2,
                                       (struct solid_table_point[]){{0.0, 0.0}, {0.02, 1.0}}};
    int *nodes;
    const int n = specimen_plane(&specimen, 2, 0.0, &nodes);
    solid_supports_add(&solid->supports, SOLID_SUPPORT_VELOCITY, 0, &foot, n, nodes);
    solid_supports_add(&solid->supports, SOLID_SUPPORT_FIXED, 2, NULL, n, nodes);
    const struct solid_side top = {solid->n_elements - 1, tetrahedra ? 2 : 1};
    solid_loads_add_pressure(&solid->loads, 2e5 * factor, &rising, 1, &top);
    solid->gravity[2] = -9.81 * factor;
    solid->damping = 5.0;
    specimen_steps(&specimen, STEPS);
    const struct solid_energies energies = specimen_energies(&specimen);
    double inside = 0.0;
    for (int k = SOLID_ENERGY_ELASTIC; k < SOLID_N_ENERGIES; k++)
        inside += solid_energy_value(&energies, (enum solid_energy)k);
    const double internal = solid_energy_value(&energies, SOLID_ENERGY_INTERNAL);
    const double all = internal + solid_energy_value(&energies, SOLID_ENERGY_KINETIC);
    outcome.balance = solid_energy_balance(&energies) / all;
    outcome.held = (internal - inside) / internal;
    for (int k = 0; k < SOLID_N_ENERGIES; k++)
        outcome.share[k] = solid_energy_value(&energies, (enum solid_energy)k) / all;
    free(nodes);
    specimen_free(&specimen);
    solid_block_free(&block);
    return outcome;
}

static void compare(const char *name, const struct solid_material *material, bool tetrahedra)
{
    const struct outcome full = shake(material, tetrahedra, 1.0);
    char text[128];
    verify_source("(12.14)");
    snprintf(text, sizeof text, "%s: balance over the energy", name);
    verify_row(text, "", 0.0, full.balance, 1e-11, VERIFY_ABSOLUTE, "rounding");
    snprintf(text, sizeof text, "%s: internal energy that is nowhere, over it", name);
    verify_row(text, "", 0.0, full.held, 0.01, VERIFY_ABSOLUTE, "usual bound");
    if (material == &tough) {
        snprintf(text, sizeof text, "%s: heat of plastic flow over all, so that it did flow",
                 name);
        verify_row(text, "", 0.1, full.share[SOLID_ENERGY_PLASTIC], 0.0, VERIFY_AT_LEAST,
                   "a condition");
        return;
    }
    const struct outcome tenth = shake(material, tetrahedra, 0.1);
    verify_source("of the order of the strain");
    snprintf(text, sizeof text, "%s: that at a tenth of the loads, over at full", name);
    verify_row(text, "", 0.1, tenth.held / full.held, 0.02, VERIFY_ABSOLUTE,
               "the next order in the strain, and of the step");
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Solids: energy", "(12.14)");
    compare("elastic hexahedra", &elastic, false);
    compare("elastic tetrahedra", &elastic, true);
    compare("hexahedra that flow, damped", &tough, false);
    compare("tetrahedra that flow, damped", &tough, true);
    return verify_end();
}
