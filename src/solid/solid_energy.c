/* See solid_energy.h. */
#include "solid/solid_energy.h"

#include "solid/solid.h"

static void add_node(const struct solid *solid, int i, int64_t step, double dt,
                     struct solid_energies *energies)
{
    const struct solid_advance advance = solid_advance(solid, i, dt);
    const double *v = solid_velocity(solid, i);
    double power[SOLID_N_WORKS], kinetic = 0.0;
    solid_power(solid, i, &advance, v, power);
    for (int k = 0; k < 3; k++)
        kinetic += 0.5 * solid->mass[i] * v[k] * advance.velocity[k];
    if (solid->turns.n_nodes > 0)
        kinetic += solid_turns_power(solid, i, dt, power);
    exact_sum_add(&energies->sums[SOLID_ENERGY_KINETIC], kinetic);
    for (int w = 0; w < SOLID_N_WORKS; w++)
        exact_sum_add(&energies->sums[SOLID_ENERGY_INTERNAL + w],
                      solid->work[i][w] + (step > 0 ? 0.5 * dt * power[w] : 0.0));
}

static void add_element(const struct solid *solid, int e, struct solid_energies *energies)
{
    const struct solid_element_state *state = &solid->state[e];
    const struct solid_element_material *material = &solid->materials[solid->material[e]];
    const bool is_sheet = shell_element_is(solid->shape[e]);
    const double bent = is_sheet ? material->hourglass_stiffness * state->hourglass_work : 0.0;
    const double elastic = is_sheet
                               ? shell_element_energy(solid->shape[e], state, &solid->shell[e],
                                                      solid->layers, material)
                               : solid_element_energy(state, material);
    const double terms[] = {elastic + bent, state->plastic_work, state->hourglass_work - bent,
                            state->hourglass_damped, state->damped};
    for (int k = 0; k < (int)(sizeof terms / sizeof *terms); k++)
        exact_sum_add(&energies->sums[SOLID_ENERGY_ELASTIC + k], terms[k]);
}

void solid_energies_add(struct solid *solid, int64_t step, double dt,
                        struct solid_energies *energies)
{
    solid_supports_set(&solid->supports, step + 1, dt);
    for (int i = 0; i < solid->n_nodes; i++)
        if (solid->moves[i])
            add_node(solid, i, step, dt, energies);
    for (int e = 0; e < solid->n_elements; e++)
        if (solid_counts(solid, e))
            add_element(solid, e, energies);
}

double solid_energy_value(const struct solid_energies *energies, enum solid_energy energy)
{
    return exact_sum_value(&energies->sums[energy]);
}

double solid_energy_balance(const struct solid_energies *energies)
{
    const double inside = solid_energy_value(energies, SOLID_ENERGY_KINETIC) +
                          solid_energy_value(energies, SOLID_ENERGY_INTERNAL) +
                          solid_energy_value(energies, SOLID_ENERGY_BACKGROUND);
    const double done = solid_energy_value(energies, SOLID_ENERGY_LOADS) +
                        solid_energy_value(energies, SOLID_ENERGY_CONTACT) +
                        solid_energy_value(energies, SOLID_ENERGY_GRAVITY) +
                        solid_energy_value(energies, SOLID_ENERGY_SUPPORTS);
    return inside - done;
}
