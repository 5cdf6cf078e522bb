/*
 * A cantilever strip that a moment at its end rolls up into a circle: M = 2 pi EI/L.  Every
 * section then has the curvature M/EI, and the tip is where the root is.
 */
#include <math.h>
#include <stdio.h>

#include "../unit/shell_sheet.h"
#include "specimen.h"
#include "verify.h"

static const double LENGTH = 1.0, WIDTH = 0.05, THICK = 0.02, YOUNG = 2.1e11;

/* Rolled by this share of a circle, slowly beside its first period of 60 ms: the tip's place
 * beside the root and above it [m]. */
static void roll(enum solid_element_shape shape, int cells, double share, double tip[2])
{
    static const struct solid_material steel = {7850.0, 2.1e11, 0.0,  0.0, 1.0,
                                                0.0,    0,      NULL, 0.0};
    const double time = 0.6;
    const double moment = share * 2.0 * M_PI * YOUNG * WIDTH * pow(THICK, 3.0) / 12.0 / LENGTH;
    const struct solid_table rising = {2,
                                       (struct solid_table_point[]){{0.0, 0.0}, {time, 1.0}}};
    struct shell_sheet sheet;
    struct specimen specimen;
    shell_sheet_build(&sheet, cells, 1, (const double[2]){LENGTH, WIDTH}, shape, THICK, 2);
    specimen_make(&specimen, &sheet.mesh, &steel, 0.9);
    struct solid *solid = &specimen.solid;
    solid->damping = 200.0;
    for (int d = 0; d < 3; d++) {
        specimen_fix(&specimen, 0, 0.0, d);
        specimen_fix_turn(&specimen, 0, 0.0, d);
    }
    const int ends[2] = {shell_sheet_node(&sheet, cells, 0),
                         shell_sheet_node(&sheet, cells, 1)};
    solid_loads_add_moment(&solid->loads, (struct vec3){0.0, -0.5 * moment, 0.0}, &rising, 2,
                           ends);
    specimen_steps(&specimen, (int64_t)(2.0 * time / specimen.dt));
    tip[0] = solid_place(solid, ends[0])[0];
    tip[1] = solid_place(solid, ends[0])[2];
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
}

static void compare(const char *name, enum solid_element_shape shape, double share)
{
    const double angle = 2.0 * M_PI * share, radius = LENGTH / angle;
    double tip[2];
    char text[128];
    roll(shape, 20, share, tip);
    snprintf(text, sizeof text, "%s, rolled by %g of a circle: tip from the root", name, share);
    verify_row(text, "m", radius * sin(angle), tip[0], 0.005, VERIFY_ABSOLUTE,
               "20 chords for the arc; what still moves");
    snprintf(text, sizeof text, "%s, rolled by %g of a circle: tip above the root", name,
             share);
    verify_row(text, "m", radius * (1.0 - cos(angle)), tip[1], 0.005, VERIFY_ABSOLUTE,
               "the same");
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Shells: a strip rolled up by a moment", "curvature M/EI");
    compare("quadrilaterals", SOLID_ELEMENT_SHELL_QUAD, 0.5);
    compare("quadrilaterals", SOLID_ELEMENT_SHELL_QUAD, 1.0);
    compare("triangles", SOLID_ELEMENT_SHELL_TRIANGLE, 0.5);
    return verify_end();
}
