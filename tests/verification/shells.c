/* See shells.h. */
#include "shells.h"

#include <math.h>

#include "../unit/shell_sheet.h"
#include "specimen.h"

static struct solid_material stuff(double density, double young, double poisson, double modes)
{
    return (struct solid_material){
        .density = density, .young = young, .poisson = poisson, .hourglass_stiffness = modes};
}

/* A plane of symmetry across an axis: no motion along it, no turning about the others. */
static void mirror(struct specimen *specimen, int axis, double coordinate)
{
    specimen_fix(specimen, axis, coordinate, axis);
    specimen_fix_turn(specimen, axis, coordinate, (axis + 1) % 3);
    specimen_fix_turn(specimen, axis, coordinate, (axis + 2) % 3);
}

static double finish(struct specimen *specimen, struct shell_sheet *sheet, int node,
                     int direction)
{
    const double moved = specimen_settle(specimen, node, direction);
    specimen_free(specimen);
    shell_sheet_free(sheet);
    return moved;
}

/* Rolls a sheet about the x axis, from the top down. */
static void roll(struct shell_sheet *sheet, double radius, double angle)
{
    for (int i = 0; i < sheet->mesh.n_nodes; i++) {
        double *x = sheet->mesh.places[i];
        const double at = angle * x[1];
        x[2] = x[1] == 1.0 && angle > 1.5 ? 0.0 : radius * cos(at);
        x[1] = radius * sin(at);
    }
}

double shells_roof(enum solid_element_shape shape, int n, double modes)
{
    static const double DENSITY = 1.0, THICK = 0.25, LOAD = 90.0;
    static const double SMALL = 1e-3; /* of the load: the whole one moves it by its thickness */
    const struct solid_material material = stuff(DENSITY, 4.32e8, 0.0, modes);
    struct shell_sheet sheet;
    struct specimen specimen;
    shell_sheet_build(&sheet, n, n, (const double[2]){25.0, 1.0}, shape, THICK, 2);
    roll(&sheet, 25.0, 40.0 * M_PI / 180.0);
    specimen_make(&specimen, &sheet.mesh, &material, 0.9);
    specimen.solid.gravity[2] = -SMALL * LOAD / (DENSITY * THICK);
    mirror(&specimen, 0, 0.0);
    mirror(&specimen, 1, 0.0);
    specimen_fix(&specimen, 0, 25.0, 1);
    specimen_fix(&specimen, 0, 25.0, 2);
    return -finish(&specimen, &sheet, shell_sheet_node(&sheet, 0, n), 2) / SMALL;
}

double shells_cylinder(enum solid_element_shape shape, int n, double modes)
{
    const struct solid_material material = stuff(1.0, 3e6, 0.3, modes);
    struct shell_sheet sheet;
    struct specimen specimen;
    shell_sheet_build(&sheet, n, n, (const double[2]){300.0, 1.0}, shape, 3.0, 2);
    roll(&sheet, 300.0, 0.5 * M_PI);
    specimen_make(&specimen, &sheet.mesh, &material, 0.9);
    const int top = shell_sheet_node(&sheet, 0, 0);
    solid_loads_add_force(&specimen.solid.loads, (struct vec3){0.0, 0.0, -0.25}, NULL, 1, &top);
    mirror(&specimen, 0, 0.0);
    mirror(&specimen, 1, 0.0);
    mirror(&specimen, 2, 0.0);
    specimen_fix(&specimen, 0, 300.0, 1);
    specimen_fix(&specimen, 0, 300.0, 2);
    return -finish(&specimen, &sheet, top, 2);
}

double shells_beam(enum solid_element_shape shape, int n, double thick, int direction)
{
    static const double LENGTH = 12.0, WIDTH = 1.1;
    static const double SMALL = 1e-3; /* of the load: the whole one bends a thin beam far */
    const struct solid_material material = stuff(1.0, 29e6, 0.22, 1.0);
    struct shell_sheet sheet;
    struct specimen specimen;
    shell_sheet_build(&sheet, 6 * n, n, (const double[2]){LENGTH, WIDTH}, shape, thick, 2);
    for (int i = 0; i < sheet.mesh.n_nodes; i++) {
        double *x = sheet.mesh.places[i];
        const double at = 0.5 * M_PI * (1.0 - x[0] / LENGTH), y = x[1] - 0.5 * WIDTH;
        x[1] = y * cos(at);
        x[2] = y * sin(at);
    }
    specimen_make(&specimen, &sheet.mesh, &material, 0.9);
    for (int d = 0; d < 3; d++) {
        specimen_fix(&specimen, 0, 0.0, d);
        specimen_fix_turn(&specimen, 0, 0.0, d);
    }
    for (int j = 0; j <= n; j++) {
        const int node = shell_sheet_node(&sheet, 6 * n, j);
        const double share = SMALL * (j == 0 || j == n ? 0.5 : 1.0) / n;
        const struct vec3 force = {0.0, direction == 1 ? share : 0.0,
                                   direction == 2 ? share : 0.0};
        solid_loads_add_force(&specimen.solid.loads, force, NULL, 1, &node);
    }
    const int middle = shell_sheet_node(&sheet, 6 * n, n / 2);
    return finish(&specimen, &sheet, middle, direction) / SMALL;
}
