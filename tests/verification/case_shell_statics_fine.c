/* The roof, the cylinder and the beam of case_shell_statics on finer meshes, and how fast what
 * they give converges. */
/* long */
#include <math.h>
#include <stdio.h>

#include "shells.h"
#include "verify.h"

enum { MESHES = 3 };

/* What three meshes give, the finest of them within a tolerance; and the order with which their
 * differences fall, if it is asked: triangles' shear is softened with
 * their size, they converge more slowly. */
static void converge(const char *name, double expected, double tolerance, bool order,
                     const double got[MESHES])
{
    char text[128];
    snprintf(text, sizeof text, "%s, the finest mesh", name);
    verify_row(text, "m", expected, got[2], tolerance, VERIFY_RELATIVE, "mesh");
    if (!order)
        return;
    snprintf(text, sizeof text, "%s: order of convergence", name);
    verify_row(text, "", 2.0, log2(fabs((got[1] - got[0]) / (got[2] - got[1]))), 0.5,
               VERIFY_AT_LEAST, "meshes are coarse for it");
}

int main(int argc, char **argv)
{
    static const enum solid_element_shape shapes[2] = {SOLID_ELEMENT_SHELL_QUAD,
                                                       SOLID_ELEMENT_SHELL_TRIANGLE};
    static const char *const names[2] = {"quadrilaterals", "triangles"};
    verify_begin(argc, argv, "Shells: roof, pinched cylinder, twisted beam on finer meshes",
                 "");
    for (int s = 0; s < 2; s++) {
        char text[128];
        double roof[MESHES], cylinder[MESHES], beam[2][MESHES];
        for (int k = 0; k < MESHES; k++) {
            roof[k] = shells_roof(shapes[s], 4 << k, 1.0);
            cylinder[k] = shells_cylinder(shapes[s], 8 << k, 1.0);
            beam[0][k] = shells_beam(shapes[s], 2 << k, 1.0, 1);
            beam[1][k] = shells_beam(shapes[s], 2 << k, 1.0, 2);
        }
        verify_source("Scordelis-Lo roof: .3024");
        snprintf(text, sizeof text, "roof, 4, 8, 16 %s a side", names[s]);
        converge(text, 0.3024, s == 0 ? 0.01 : 0.05, s == 0, roof);
        verify_source("pinched cylinder: 1.8248e-5");
        snprintf(text, sizeof text, "cylinder, 8, 16, 32 %s a side", names[s]);
        converge(text, 1.8248e-5, 0.03, s == 0, cylinder);

        verify_source("twisted beam: .005424 along the tip's width");
        snprintf(text, sizeof text, "beam, 2, 4, 8 %s across, along its width", names[s]);
        converge(text, 0.005424, s == 0 ? 0.01 : 0.02, s == 0, beam[0]);
        verify_source("twisted beam: .001754 along its thickness");
        snprintf(text, sizeof text, "beam, 2, 4, 8 %s across, along its thickness", names[s]);
        converge(text, 0.001754, s == 0 ? 0.01 : 0.03, s == 0, beam[1]);
    }
    return verify_end();
}
