/*
 * Shells of which publications know how far they give: the roof of Scordelis and Lo, the
 * pinched cylinder, the twisted beam (MacNeal and Harder, Finite Elements in Analysis and
 * Design 1, 1985, 3), on coarse meshes; finer ones are in case_shell_statics_fine.
 */
#include <stdio.h>

#include "shells.h"
#include "verify.h"

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Shells: roof, pinched cylinder, twisted beam",
                 "Scordelis-Lo roof: .3024");
    const enum solid_element_shape quad = SOLID_ELEMENT_SHELL_QUAD,
                                   triangle = SOLID_ELEMENT_SHELL_TRIANGLE;
    verify_row("roof, 4 quadrilaterals a side", "m", 0.3024, shells_roof(quad, 4, 1.0), 0.06,
               VERIFY_RELATIVE, "mesh");
    verify_row("roof, 8 quadrilaterals a side", "m", 0.3024, shells_roof(quad, 8, 1.0), 0.02,
               VERIFY_RELATIVE, "mesh");
    verify_row("roof, 8 quadrilaterals a side, a tenth of the modes' stiffness", "m", 0.3024,
               shells_roof(quad, 8, 0.1), 0.06, VERIFY_RELATIVE, "mesh");
    verify_row("roof, 8 triangles a side", "m", 0.3024, shells_roof(triangle, 8, 1.0), 0.15,
               VERIFY_RELATIVE, "mesh");
    verify_source("pinched cylinder: 1.8248e-5");
    verify_row("cylinder, 8 quadrilaterals a side", "m", 1.8248e-5,
               shells_cylinder(quad, 8, 1.0), 0.26, VERIFY_RELATIVE, "mesh");
    verify_row("cylinder, 16 quadrilaterals a side", "m", 1.8248e-5,
               shells_cylinder(quad, 16, 1.0), 0.07, VERIFY_RELATIVE, "mesh");
    verify_row("cylinder, 16 triangles a side", "m", 1.8248e-5,
               shells_cylinder(triangle, 16, 1.0), 0.08, VERIFY_RELATIVE, "mesh");
    verify_source("twisted beam: .005424 along the tip's width");
    verify_row("beam, 2 x 12 quadrilaterals, pulled along the width", "m", 0.005424,
               shells_beam(quad, 2, 0.32, 1), 0.02, VERIFY_RELATIVE, "mesh");
    verify_row("beam, 2 x 12 x 2 triangles, pulled along the width", "m", 0.005424,
               shells_beam(triangle, 2, 0.32, 1), 0.02, VERIFY_RELATIVE, "mesh");
    verify_source("twisted beam: .001754 along its thickness");
    verify_row("beam, 2 x 12 quadrilaterals, pulled along the thickness", "m", 0.001754,
               shells_beam(quad, 2, 0.32, 2), 0.05, VERIFY_RELATIVE, "mesh");
    verify_row("beam, 2 x 12 x 2 triangles, pulled along the thickness", "m", 0.001754,
               shells_beam(triangle, 2, 0.32, 2), 0.17, VERIFY_RELATIVE, "mesh");
    return verify_end();
}
