/* See specimen.h. */
#include "specimen.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "solid/solid_limits.h"

void specimen_make(struct specimen *specimen, const struct solid_parts *mesh,
                   const struct solid_material *material, double share)
{
    *specimen = (struct specimen){.step = 0};
    solid_create(&specimen->solid, mesh, 1, material, ISA_AUTO);
    specimen->dt = share * solid_limits_find(&specimen->solid, NULL, NULL).step;
}

void specimen_free(struct specimen *specimen)
{
    solid_destroy(&specimen->solid);
}

void specimen_pushed_steps(struct specimen *specimen, int64_t n, specimen_push *push,
                           void *what)
{
    struct solid *solid = &specimen->solid;
    for (int64_t k = 0; k < n; k++) {
        CHECK(solid_forces(solid, specimen->step, specimen->dt),
              "element %d failed at step %lld", solid_limits_fault(solid, specimen->dt).element,
              (long long)specimen->step);
        if (push != NULL)
            push(specimen, what);
        solid_move(solid, specimen->step++, specimen->dt);
    }
}

void specimen_steps(struct specimen *specimen, int64_t n)
{
    specimen_pushed_steps(specimen, n, NULL, NULL);
}

double specimen_settle(struct specimen *specimen, int node, int direction)
{
    struct solid *solid = &specimen->solid;
    const double *v = solid_velocity(solid, node);
    specimen_steps(specimen, 10);
    const bool up = v[direction] > 0.0;
    while ((v[direction] > 0.0) == up)
        specimen_steps(specimen, 1);
    const int64_t period = 2 * specimen->step;
    solid->damping = 4.0 * M_PI / ((double)period * specimen->dt);
    const double *x = solid_place(solid, node), from = solid->reference[node][direction];
    double before;
    do {
        before = x[direction];
        specimen_steps(specimen, 2 * period);
    } while (fabs(x[direction] - before) > 1e-6 * fabs(x[direction] - from));
    return x[direction] - from;
}

/* Forces of a step must not be computed twice: a copy of the state is. */
struct solid_energies specimen_energies(struct specimen *specimen)
{
    struct solid *solid = &specimen->solid;
    struct solid_energies energies = {0};
    const size_t n = (size_t)solid->n_elements + 1;
    struct solid_element_state *own = solid->state;
    struct shell_element_state *shell = solid->shell;
    solid->state = array_allocate_rows(n, sizeof *own);
    memcpy(solid->state, own, n * sizeof *own);
    if (shell != NULL) {
        solid->shell = array_allocate_rows(n, sizeof *shell);
        memcpy(solid->shell, shell, n * sizeof *shell);
    }
    solid_forces(solid, specimen->step, specimen->dt);
    solid_energies_add(solid, specimen->step, specimen->dt, &energies);
    free(solid->state);
    solid->state = own;
    if (shell != NULL) {
        free(solid->shell);
        solid->shell = shell;
    }
    return energies;
}

int specimen_plane(const struct specimen *specimen, int axis, double coordinate, int **nodes)
{
    const struct solid *solid = &specimen->solid;
    int n = 0;
    *nodes = array_allocate((size_t)solid->n_nodes, sizeof **nodes);
    for (int i = 0; i < solid->n_nodes; i++)
        if (fabs(solid->reference[i][axis] - coordinate) < 1e-12)
            (*nodes)[n++] = i;
    return n;
}

void specimen_fix(struct specimen *specimen, int axis, double coordinate, int direction)
{
    int *nodes;
    const int n = specimen_plane(specimen, axis, coordinate, &nodes);
    solid_supports_add(&specimen->solid.supports, SOLID_SUPPORT_FIXED, direction, NULL, n,
                       nodes);
    free(nodes);
}

void specimen_fix_turn(struct specimen *specimen, int axis, double coordinate, int direction)
{
    int *nodes;
    const int n = specimen_plane(specimen, axis, coordinate, &nodes);
    solid_supports_add_turn(&specimen->solid.supports, SOLID_SUPPORT_FIXED, direction, NULL, n,
                            nodes);
    free(nodes);
}

double specimen_stress_most(const struct specimen *specimen)
{
    double most = 0.0;
    for (int e = 0; e < specimen->solid.n_elements; e++)
        for (int k = 0; k < 6; k++)
            most = fmax(most, fabs(specimen->solid.state[e].stress[k]));
    return most;
}

double specimen_hourglass_most(const struct specimen *specimen)
{
    double most = 0.0;
    for (int e = 0; e < specimen->solid.n_elements; e++)
        for (int k = 0; k < 12; k++)
            most = fmax(most, fabs(specimen->solid.state[e].hourglass[k / 3][k % 3]));
    return most;
}
