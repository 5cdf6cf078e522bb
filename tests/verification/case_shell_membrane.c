/*
 * A square membrane under tension that pressure bulges a little: Poisson's equation, T lap w =
 * -p.  Its resistance across is tension alone, and that of one point is blind to the pattern
 * that alternates from node to node; what flattens warped elements is not.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "../unit/shell_sheet.h"
#include "specimen.h"
#include "verify.h"

static const struct solid_material rubber = {1000.0, 1e7, 0.4, 0.0, 1.0, 0.0, 0, NULL, 0.0};
static const double SIDE = 1.0, THICK = 1e-3, STRESS = 1e4, PRESSURE = 1e-3;

/* Rise in the middle over p L^2/T, by the series for a square. */
static double theory(void)
{
    double sum = 0.0;
    for (int m = 1; m < 200; m += 2)
        for (int n = 1; n < 200; n += 2)
            sum += ((m + n) / 2 % 2 == 1 ? 1.0 : -1.0) / ((double)m * n * (m * m + n * n));
    return 16.0 / pow(M_PI, 4.0) * sum;
}

/* Pulled by the stress in all directions, with pressure on all of it, or a force at the middle
 * and the opposite at its neighbours. */
static void make(struct specimen *specimen, struct shell_sheet *sheet,
                 enum solid_element_shape shape, int cells)
{
    shell_sheet_build(sheet, cells, cells, (const double[2]){SIDE, SIDE}, shape, THICK, 1);
    specimen_make(specimen, &sheet->mesh, &rubber, 0.9);
    struct solid *solid = &specimen->solid;
    for (int e = 0; e < solid->n_elements; e++)
        solid->shell[e].layer[0][0] = solid->shell[e].layer[0][1] = STRESS;
    for (int axis = 0; axis < 2; axis++)
        for (int d = 0; d < 3; d++) {
            specimen_fix(specimen, axis, 0.0, d);
            specimen_fix(specimen, axis, SIDE, d);
        }
}

static double rise(enum solid_element_shape shape, int cells)
{
    struct shell_sheet sheet;
    struct specimen specimen;
    make(&specimen, &sheet, shape, cells);
    struct solid *solid = &specimen.solid;
    struct solid_side *sides = calloc((size_t)solid->n_elements, sizeof *sides);
    for (int e = 0; e < solid->n_elements; e++)
        sides[e] = (struct solid_side){e, 1};
    solid_loads_add_pressure(&solid->loads, PRESSURE, NULL, solid->n_elements, sides);
    const double up =
        specimen_settle(&specimen, shell_sheet_node(&sheet, cells / 2, cells / 2), 2);
    free(sides);
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
    return up / (PRESSURE * SIDE * SIDE / (STRESS * THICK));
}

/* Nodes are moved up and down in turn by a little; the force that brings the middle one back,
 * over that of the bilinear surface: of each of four elements T h/12 (4/a^2 + 4/a^2) a^2. */
static double flattening(void)
{
    enum { CELLS = 6 };
    const double high = 1e-6;
    struct shell_sheet sheet;
    struct specimen specimen;
    make(&specimen, &sheet, SOLID_ELEMENT_MEMBRANE_QUAD, CELLS);
    struct solid *solid = &specimen.solid;
    for (int j = 0; j <= CELLS; j++)
        for (int i = 0; i <= CELLS; i++)
            solid_place(solid, shell_sheet_node(&sheet, i, j))[2] =
                (i + j) % 2 == 0 ? high : -high;
    solid_forces(solid, 0, specimen.dt);
    const double force = -solid->internal[shell_sheet_node(&sheet, 3, 3)][2];
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
    return force / (4.0 * STRESS * THICK * high * 8.0 / 12.0);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Membranes: a square under tension, bulged by pressure",
                 "series of Poisson's equation");
    double got[3];
    char text[128];
    for (int k = 0; k < 3; k++) {
        const int cells = 4 << k;
        got[k] = rise(SOLID_ELEMENT_MEMBRANE_QUAD, cells);
        snprintf(text, sizeof text, "rise of %d x %d quadrilaterals over p L^2/T", cells,
                 cells);
        verify_row(text, "", theory(), got[k], 1.0 / (cells * cells) + 1e-3, VERIFY_RELATIVE,
                   "second order of cells");
    }
    verify_row("order of convergence", "", 2.0,
               log2(fabs((got[0] - theory()) / (got[1] - theory()))), 0.3, VERIFY_ABSOLUTE,
               "coarse meshes");
    verify_row("rise of 16 x 16 pairs of triangles over p L^2/T", "", theory(),
               rise(SOLID_ELEMENT_MEMBRANE_TRIANGLE, 16), 0.01, VERIFY_RELATIVE,
               "second order of cells");
    verify_source("uniform tension in a bilinear surface");
    verify_row("force against nodes up and down in turn, over theory", "", 1.0, flattening(),
               1e-6, VERIFY_RELATIVE, "slopes squared");
    return verify_end();
}
