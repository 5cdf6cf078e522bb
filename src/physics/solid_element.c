/*
 * Chooses among the compilations of solid_element_blocks.c; and what is asked of one element at
 * a time: its energy, its volume, the step it allows.
 *
 * The bound on the step is that of Flanagan and Belytschko (1981), sharpened: what resists
 * volume change has the trace of B B^t, what resists shear only its largest eigenvalue.  For
 * cubes and for flat elements it is the largest frequency itself.
 */
#include "physics/solid_element.h"

#include <math.h>

#include "physics/eigenvalue.h"
#include "physics/shell_element.h"
#include "physics/solid_element_blocks.h"
#include "physics/solid_gradient.h"
#include "physics/solid_law.h"

struct solid_element_kernel solid_element_choose(enum isa isa)
{
    struct solid_element_kernel kernel = ISA_PICK(isa_choose(isa), solid_element_blocks);
    shell_element_choose(isa, &kernel);
    return kernel;
}

void solid_element_elastic(struct solid_element_material *material, double young,
                           double poisson)
{
    material->mu = 0.5 * young / (1.0 + poisson);
    material->lambda = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
}

double solid_element_energy(const struct solid_element_state *state,
                            const struct solid_element_material *material)
{
    const double *s = state->stress, trace = (s[0] + s[1]) + s[2];
    const double bulk3 = 3.0 * material->lambda + 2.0 * material->mu;
    const double held = solid_law_product(s, s) - material->lambda / bulk3 * trace * trace;
    return state->volume * held / (4.0 * material->mu);
}

double solid_element_mises(const struct solid_element_state *state)
{
    const double *s = state->stress, mean = ((s[0] + s[1]) + s[2]) / 3.0;
    const double deviator[6] = {s[0] - mean, s[1] - mean, s[2] - mean, s[3], s[4], s[5]};
    return sqrt(1.5 * solid_law_product(deviator, deviator));
}

double solid_element_yield_stress(const struct solid_element_material *material, double strain)
{
    int k = 0;
    while (k + 1 < material->n_yield && strain >= material->yield[k + 1].strain)
        k++;
    const struct solid_element_yield *piece = &material->yield[k];
    return piece->stress + piece->slope * (strain - piece->strain);
}

int solid_element_corners(enum solid_element_shape shape)
{
    static const int corners[SOLID_ELEMENT_N_SHAPES] = {
        [SOLID_ELEMENT_HEXAHEDRON] = 8,    [SOLID_ELEMENT_TETRAHEDRON] = 4,
        [SOLID_ELEMENT_SHELL_QUAD] = 4,    [SOLID_ELEMENT_SHELL_TRIANGLE] = 3,
        [SOLID_ELEMENT_MEMBRANE_QUAD] = 4, [SOLID_ELEMENT_MEMBRANE_TRIANGLE] = 3};
    return corners[shape];
}

static double gradient_of(enum solid_element_shape shape, double x[][3], double b[][3])
{
    return shape == SOLID_ELEMENT_HEXAHEDRON ? solid_gradient_hexahedron(x, b)
                                             : solid_gradient_tetrahedron(x, b);
}

double solid_element_volume(enum solid_element_shape shape, double x[][3])
{
    double b[8][3];
    return gradient_of(shape, x, b);
}

/* ------------------------------------------------------------------------------- the step */

/* What couples uniform strain with hourglass modes: the sum of squares of gamma B^t, and the
 * largest sum of squares of gamma.  (12.12) */
static void hourglass_shape(double x[][3], double b[][3], double volume, double *length,
                            double *coupling)
{
    double gamma[4][8];
    for (int a = 0; a < 4; a++) {
        double unit[4] = {0.0};
        unit[a] = 1.0;
        solid_gradient_spread(unit, gamma[a]);
    }
    for (int a = 0; a < 4; a++) {
        double places[3] = {0.0};
        for (int c = 0; c < 8; c++)
            for (int j = 0; j < 3; j++)
                places[j] += gamma[a][c] * (x[c][j] - x[0][j]);
        for (int c = 0; c < 8; c++)
            gamma[a][c] -= solid_gradient_dot(b[c], places) / volume;
    }
    *length = *coupling = 0.0;
    for (int a = 0; a < 4; a++) {
        double row = 0.0;
        for (int other = 0; other < 4; other++) {
            double product = 0.0;
            for (int c = 0; c < 8; c++)
                product += gamma[a][c] * gamma[other][c];
            row += fabs(product);
        }
        *length = row > *length ? row : *length;
        for (int j = 0; j < 3; j++) {
            double product = 0.0;
            for (int c = 0; c < 8; c++)
                product += gamma[a][c] * b[c][j];
            *coupling += product * product;
        }
    }
}

struct solid_element_load solid_element_load(enum solid_element_shape shape, double x[][3],
                                             double mass,
                                             const struct solid_element_material *material)
{
    const int n = solid_element_corners(shape);
    const double share = mass / n, lambda = material->lambda, mu = material->mu;
    double b[8][3], g[3][3] = {{0.0}};
    const double volume = gradient_of(shape, x, b);
    for (int c = 0; c < n; c++)
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                g[i][j] += b[c][i] * b[c][j];
    const double trace = g[0][0] + g[1][1] + g[2][2];
    struct solid_element_load load = {
        .stretch =
            (lambda * trace + 2.0 * mu * eigenvalue_largest(3, &g[0][0])) / (volume * share),
        .damping = material->damping};
    if (shape == SOLID_ELEMENT_HEXAHEDRON) {
        double length, coupling;
        hourglass_shape(x, b, volume, &length, &coupling);
        const double whole = (lambda + 2.0 * mu) * trace / (24.0 * volume);
        load.hourglass = material->hourglass_stiffness * whole * length / share;
        load.hourglass_damped =
            0.25 * material->hourglass_viscosity * sqrt(whole * mass) * length / share;
        /* Over the length of gamma, as it comes with the stiffness of the modes. */
        load.mixed = (lambda + 2.0 * mu) * coupling / (volume * share * length);
    }
    return load;
}

/* dt^2 omega^2 and what dashpots of velocities half a step old add: stable up to 4.  (12.13) */
static double load_of_step(const struct solid_element_load *load, double contact,
                           double contact_damping, double dt)
{
    const double late = dt * dt + 2.0 * dt * load->damping;
    const double stretch = late * load->stretch;
    const double hourglass = dt * dt * load->hourglass + 2.0 * dt * load->hourglass_damped;
    const double half = 0.5 * (stretch - hourglass);
    return 0.5 * (stretch + hourglass) + sqrt(half * half + late * load->mixed * hourglass) +
           dt * dt * contact + 2.0 * dt * contact_damping;
}

double solid_element_critical_step(const struct solid_element_load *load, double contact,
                                   double contact_damping)
{
    double low = 0.0, high = 2.0 / sqrt(load->stretch); /* without all else */
    if (!(load_of_step(load, contact, contact_damping, high) > 4.0))
        return high;
    for (int k = 0; k < 60; k++) {
        const double middle = 0.5 * (low + high);
        if (load_of_step(load, contact, contact_damping, middle) <= 4.0)
            low = middle;
        else
            high = middle;
    }
    return low;
}
