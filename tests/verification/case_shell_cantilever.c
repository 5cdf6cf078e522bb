/* The first frequency of a cantilever that is a strip of square cells of a shell, bent across
 * its thickness.  Beam theory does not know its width. */
#include <math.h>
#include <stdio.h>

#include "../unit/shell_sheet.h"
#include "cantilever.h"
#include "specimen.h"
#include "verify.h"

static const double LENGTH = 1.0, SIDE = 0.05;

/* From the time between two passages of its tip through its place of rest, after the static
 * shape of a force at its tip, which is nearly the first mode [1/s]. */
static double frequency(enum solid_element_shape shape, int cells)
{
    static const struct solid_material steel = {7850.0, 2.1e11, 0.3,  0.0, 1.0,
                                                0.0,    0,      NULL, 0.0};
    struct shell_sheet sheet;
    struct specimen specimen;
    shell_sheet_build(&sheet, cells, 1, (const double[2]){LENGTH, LENGTH / cells}, shape, SIDE,
                      2);
    specimen_make(&specimen, &sheet.mesh, &steel, 0.9);
    struct solid *solid = &specimen.solid;
    for (int d = 0; d < 3; d++) {
        specimen_fix(&specimen, 0, 0.0, d);
        specimen_fix_turn(&specimen, 0, 0.0, d);
    }
    for (int i = 0; i < solid->n_nodes; i++) {
        double slope;
        solid_velocity(solid, i)[2] = 0.01 * cantilever_mode(solid->reference[i][0], &slope);
        solid_turn_spin(&solid->turns, i)[1] = -0.01 * slope;
    }
    double crossing[2] = {0.0}, before = 0.0;
    for (int n = 0; n < 2;) {
        specimen_steps(&specimen, 1);
        const double now = cantilever_displacement(solid);
        if (before != 0.0 && (before > 0.0) != (now > 0.0))
            crossing[n++] = ((double)specimen.step - now / (now - before)) * specimen.dt;
        before = now;
    }
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
    return 0.5 / (crossing[1] - crossing[0]);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Shells: cantilever, 1 m long, .05 m thick",
                 "1.8751^2/2 pi sqrt(EI/(rho A L^4))");
    const double theory = cantilever_theory();
    const enum solid_element_shape shapes[2] = {SOLID_ELEMENT_SHELL_QUAD,
                                                SOLID_ELEMENT_SHELL_TRIANGLE};
    const char *const names[2] = {"quadrilaterals", "triangles"};
    for (int s = 0; s < 2; s++) {
        double got[3];
        char text[128];
        for (int k = 0; k < 3; k++) {
            const int cells = 5 << k;
            got[k] = frequency(shapes[s], cells);
            snprintf(text, sizeof text, "%s, %d along it", names[s], cells);
            verify_row(text, "1/s", theory, got[k], 0.003 + 0.6 / (cells * cells),
                       VERIFY_RELATIVE, "second order of their length; shear and the clamp");
        }
        if (s == 0) /* triangles' shear softens with their size besides */
            verify_row("quadrilaterals: order of convergence from 5, 10 and 20", "", 2.0,
                       log2(fabs((got[1] - got[0]) / (got[2] - got[1]))), 0.3, VERIFY_AT_LEAST,
                       "higher orders");
    }
    return verify_end();
}
