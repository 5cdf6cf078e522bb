/* See cantilever.h. */
#include "cantilever.h"

#include <math.h>

#include "../unit/solid_block.h"
#include "specimen.h"

static const double LENGTH = 1.0, SIDE = 0.05;
static const double ROOT = 1.875104068711961; /* of cos y cosh y = -1 */
static const struct solid_material steel = {7850.0, 2.1e11, 0.3, 0.0, 0.0, 0.0, 0, NULL, 0.0};

double cantilever_theory(void)
{
    return ROOT * ROOT / (2.0 * M_PI) *
           sqrt(steel.young * SIDE * SIDE / 12.0 / (steel.density * pow(LENGTH, 4.0)));
}

double cantilever_bending_stiffness(void)
{
    struct solid_element_material material = {0};
    solid_element_elastic(&material, steel.young, steel.poisson);
    return steel.young / (3.0 * (material.lambda + 2.0 * material.mu));
}

double cantilever_mode(double x, double *slope)
{
    const double k = ROOT / LENGTH, y = k * x;
    const double s = (cosh(ROOT) + cos(ROOT)) / (sinh(ROOT) + sin(ROOT));
    *slope = k * (sinh(y) + sin(y) - s * (cosh(y) - cos(y)));
    return cosh(y) - cos(y) - s * (sinh(y) - sin(y));
}

double cantilever_displacement(const struct solid *solid)
{
    double sum = 0.0, slope;
    for (int i = 0; i < solid->n_nodes; i++)
        sum += solid->mass[i] * cantilever_mode(solid->reference[i][0], &slope) *
               (solid_place(solid, i)[2] - solid->reference[i][2]);
    return sum;
}

double cantilever_frequency(int across, double hourglass_stiffness)
{
    enum { BETWEEN = 10 }; /* steps between looks: a look costs as much as a step */
    struct solid_material material = steel;
    struct solid_block block;
    struct specimen specimen;
    material.hourglass_stiffness = hourglass_stiffness;
    solid_block_build(&block, 20 * across, across, across,
                      (const double[3]){LENGTH, SIDE, SIDE}, false);
    specimen_make(&specimen, &block.mesh, &material, 0.95);
    struct solid *solid = &specimen.solid;
    for (int d = 0; d < 3; d++)
        specimen_fix(&specimen, 0, 0.0, d);
    for (int i = 0; i < solid->n_nodes; i++) {
        double slope;
        solid_velocity(solid, i)[2] = 0.01 * cantilever_mode(solid->reference[i][0], &slope);
        solid_velocity(solid, i)[0] = -0.01 * slope * (solid->reference[i][2] - 0.5 * SIDE);
    }
    double crossing[2] = {0.0}, before = 0.0;
    for (int n = 0; n < 2;) {
        specimen_steps(&specimen, BETWEEN);
        const double now = cantilever_displacement(solid);
        if (before != 0.0 && (before > 0.0) != (now > 0.0))
            crossing[n++] =
                ((double)specimen.step - BETWEEN * now / (now - before)) * specimen.dt;
        before = now;
    }
    specimen_free(&specimen);
    solid_block_free(&block);
    return 0.5 / (crossing[1] - crossing[0]);
}
