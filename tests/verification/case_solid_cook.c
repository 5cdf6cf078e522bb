/*
 * Cook's membrane: a tapered panel, clamped on one side, sheared on the other; the middle of
 * the loaded side rises by 23.96 in plane stress.  Here a layer of hexahedra, free to get
 * thinner, about as thick as they are wide, damped until it rests.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/solid_block.h"
#include "specimen.h"
#include "verify.h"

static const double LOAD = 1e-4; /* of 1: displacements are small */
static const struct solid_material unit = {1.0, 1.0, 1.0 / 3.0, 0.0, 0.1, 0.0, 0, NULL, 0.0};

static double rise(int n)
{
    struct solid_block block;
    struct specimen specimen;
    const double thickness = 30.0 / n; /* about as cells are wide and high */
    solid_block_build(&block, n, n, 1, (const double[3]){1.0, 1.0, thickness}, false);
    for (int i = 0; i < block.mesh.n_nodes; i++) {
        double *x = block.mesh.places[i];
        const double u = x[0], v = x[1];
        x[0] = 48.0 * u;
        x[1] = 44.0 * u + v * (44.0 * (1.0 - u) + 16.0 * u);
    }
    specimen_make(&specimen, &block.mesh, &unit, 0.95);
    struct solid *solid = &specimen.solid;
    for (int d = 0; d < 2; d++)
        specimen_fix(&specimen, 0, 0.0, d);
    specimen_fix(&specimen, 2, 0.0, 2);
    for (int j = 0; j <= n; j++) {
        const int nodes[2] = {solid_block_node(&block, n, j, 0),
                              solid_block_node(&block, n, j, 1)};
        const double share = (j == 0 || j == n ? 0.5 : 1.0) / (2.0 * n);
        solid_loads_add_force(&solid->loads, (struct vec3){0.0, LOAD * share * thickness, 0.0},
                              NULL, 2, nodes);
    }
    solid->damping = 0.025;
    specimen_steps(&specimen, (int64_t)(1500.0 / specimen.dt));
    const int tip = solid_block_node(&block, n, n / 2, 0);
    const double got = (solid_place(solid, tip)[1] - solid->reference[tip][1]) / LOAD;
    specimen_free(&specimen);
    solid_block_free(&block);
    return got;
}

/*
 * Where the clamp ends at a free side that makes 108.4 degrees with it, stress is singular:
 * displacements go as r^0.677 (Williams, J. Appl. Mech. 19, 1952: the least root L of
 * sin^2(L w) = 4/((3 - nu)(1 + nu)) - (1 + nu)/(3 - nu) L^2 sin^2 w).  What a load does at its
 * own place converges with twice that power, 1.35, in the end; before, the rest counts, which
 * is of the order 2.
 */
static void order_rows(const double rises[4])
{
    static const double END = 1.35;
    verify_source("singular corner and second order");
    for (int k = 2; k < 4; k++) {
        const double order = log2((rises[k - 1] - rises[k - 2]) / (rises[k] - rises[k - 1]));
        char text[96];
        snprintf(text, sizeof text, "order from %d, %d and %d cells", 1 << k, 2 << k, 4 << k);
        verify_row(text, "", 0.5 * (END + 2.0), order, 0.5 * (2.0 - END), VERIFY_ABSOLUTE,
                   "1.35 to 2");
    }
    /* By the two orders that bound it. */
    const double last = rises[3] - rises[2];
    const double least = rises[3] + last / 3.0, most = rises[3] + last / (exp2(END) - 1.0);
    verify_source("commonly quoted, plane stress");
    verify_row("extrapolated from 16 and 32 cells", "", 23.96, 0.5 * (least + most),
               0.5 * (most - least) + 0.005, VERIFY_ABSOLUTE,
               "orders between these, and the digits quoted");
}

int main(int argc, char **argv)
{
    static const int cells[] = {4, 8, 16, 32};
    static const double tolerance[] = {0.2, 0.08, 0.025, 0.01};
    verify_begin(argc, argv, "Solids: Cook's membrane", "commonly quoted, plane stress");
    double rises[4];
    for (int k = 0; k < 4; k++) {
        char text[96];
        rises[k] = rise(cells[k]);
        snprintf(text, sizeof text, "%d x %d cells: rise of the middle of the loaded side",
                 cells[k], cells[k]);
        verify_row(text, "", 23.96, rises[k], tolerance[k], VERIFY_RELATIVE,
                   "first to second order in the size of cells");
    }
    order_rows(rises);
    return verify_end();
}
