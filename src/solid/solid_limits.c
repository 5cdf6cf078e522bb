/* See solid_limits.h. */
#include "solid/solid_limits.h"

#include <math.h>

#include "solid/solid.h"

/* The corner whose contacts are stiffest beside its mass. */
static int stiffest_corner(const struct solid *solid, int element, const double *stiffness)
{
    int found = -1;
    double most = 0.0;
    for (int c = 0; c < solid_element_corners(solid->shape[element]); c++) {
        const int i = solid->corners[element][c];
        if (stiffness[i] / solid->mass[i] > most) {
            most = stiffness[i] / solid->mass[i];
            found = i;
        }
    }
    return found;
}

/* The largest of such quotients. */
static double largest_share(const struct solid *solid, int element, const double *of_node)
{
    double most = 0.0;
    for (int c = 0; of_node != NULL && c < solid_element_corners(solid->shape[element]); c++) {
        const int i = solid->corners[element][c];
        const double share = of_node[i] / solid->mass[i];
        most = share > most ? share : most;
    }
    return most;
}

static struct solid_element_load load_of(const struct solid *solid, int element, double x[][3],
                                         double enough)
{
    const struct solid_element_material *material = &solid->materials[solid->material[element]];
    const double mass = solid->element_mass[element];
    if (!shell_element_is(solid->shape[element]))
        return solid_element_load(solid->shape[element], x, mass, material);
    return shell_element_load(solid->shape[element], x, mass, solid->shell[element].thickness,
                              solid->layers, material, enough);
}

/* What an element allows with contacts on its corners; not less than `dt` it may be a bound. */
static double step_of(const struct solid *solid, int e, double spring, double dashpot,
                      double dt)
{
    double x[SOLID_ELEMENT_CORNERS][3];
    solid_corner_places(solid, e, x);
    struct solid_element_load load = load_of(solid, e, x, 1.0 / (dt * dt));
    const double bound = solid_element_critical_step(&load, spring, dashpot);
    if (bound >= dt || dt == (double)INFINITY)
        return bound;
    load = load_of(solid, e, x, 0.0);
    return solid_element_critical_step(&load, spring, dashpot);
}

struct solid_limits solid_limits_within(const struct solid *solid, const double *stiffness,
                                        const double *damping, bool touched, double dt)
{
    struct solid_limits limits = {(double)INFINITY, -1, -1};
    for (int e = 0; e < solid->n_elements; e++) {
        if (solid->slot[e] < 0)
            continue;
        const double spring = largest_share(solid, e, stiffness);
        if (touched && !(spring > 0.0))
            continue;
        const double step = step_of(solid, e, spring, largest_share(solid, e, damping), dt);
        if (step < limits.step)
            limits = (struct solid_limits){step, e, -1};
    }
    if (stiffness != NULL && limits.element >= 0)
        limits.node = stiffest_corner(solid, limits.element, stiffness);
    return limits;
}

struct solid_limits solid_limits_find(const struct solid *solid, const double *stiffness,
                                      const double *damping)
{
    return solid_limits_within(solid, stiffness, damping, false, (double)INFINITY);
}

/* ------------------------------------------------------------------------------- failures */

static struct vec3 middle_of(const struct solid *solid, int element)
{
    double x[SOLID_ELEMENT_CORNERS][3];
    const int n = solid_corner_places(solid, element, x);
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int c = 0; c < n; c++)
        sum = vec3_add(sum, (struct vec3){x[c][0], x[c][1], x[c][2]});
    return vec3_scale(1.0 / n, sum);
}

/* The lesser of the volumes now and half a step back; NaN where one of them is. */
static double least_volume(const struct solid *solid, int element, double dt)
{
    double x[SOLID_ELEMENT_CORNERS][3], middle[SOLID_ELEMENT_CORNERS][3];
    const int n = solid_corner_places(solid, element, x);
    for (int c = 0; c < n; c++)
        for (int k = 0; k < 3; k++)
            middle[c][k] =
                x[c][k] - solid_velocity(solid, solid->corners[element][c])[k] * dt * 0.5;
    if (shell_element_is(solid->shape[element]))
        return shell_element_facing(solid->shape[element], x, middle) *
               solid->shell[element].thickness;
    const double now = solid_element_volume(solid->shape[element], x),
                 before = solid_element_volume(solid->shape[element], middle);
    return now < before || now != now ? now : before;
}

/* Are stress and hourglass forces finite? */
static bool is_sound(const struct solid_element_state *state)
{
    double all = 0.0;
    for (int k = 0; k < 6; k++)
        all += state->stress[k] * 0.0;
    for (int k = 0; k < 12; k++)
        all += state->hourglass[k / 3][k % 3] * 0.0;
    return all == 0.0;
}

struct solid_limits_fault solid_limits_fault(const struct solid *solid, double dt)
{
    struct solid_limits_fault fault = {SOLID_LIMITS_FINE, -1, {0.0, 0.0, 0.0}, 0.0};
    for (int e = 0; e < solid->n_elements; e++) {
        if (solid->slot[e] < 0)
            continue;
        const double volume = least_volume(solid, e, dt);
        if (volume > 0.0 && is_sound(&solid->state[e]))
            continue;
        fault.failure = volume <= 0.0 ? SOLID_LIMITS_INVERTED : SOLID_LIMITS_NOT_A_NUMBER;
        fault.element = e;
        fault.place = middle_of(solid, e);
        fault.value = volume;
        break;
    }
    return fault;
}

struct solid_limits_fault solid_limits_hourglass(const struct solid *solid, double hourglass,
                                                 double internal, double share)
{
    struct solid_limits_fault fault = {SOLID_LIMITS_FINE, -1, {0.0, 0.0, 0.0}, 0.0};
    if (hourglass <= share * internal)
        return fault;
    double most = -1.0;
    for (int e = 0; e < solid->n_elements; e++) {
        const double own = solid->state[e].hourglass_work + solid->state[e].hourglass_damped;
        if (solid_counts(solid, e) && own > most) {
            most = own;
            fault.element = e;
        }
    }
    if (fault.element < 0)
        return fault;
    fault.failure = SOLID_LIMITS_HOURGLASS;
    fault.place = middle_of(solid, fault.element);
    fault.value = hourglass / internal;
    return fault;
}
