/*
 * Patch tests of distorted quadrilaterals and triangles (MacNeal and Harder): a linear field in
 * the plane must give uniform stress, a quadratic one across it uniform moments without shear;
 * and nodes inside must feel nothing.  E 1e6, nu .25; a thickness of .001 for bending.
 */
#include <math.h>
#include <stdio.h>

#include "../unit/shell_sheet.h"
#include "physics/shell_geometry.h"
#include "specimen.h"
#include "verify.h"

static const struct solid_material stuff = {1000.0, 1e6, 0.25, 0.0, 1.0, 0.0, 0, NULL, 0.0};

static const double SMALL = 1e-8; /* of the fields that publications give */

static void make(struct shell_sheet *sheet, struct specimen *specimen,
                 enum solid_element_shape shape, double thickness)
{
    uint64_t seed = 11;
    shell_sheet_build(sheet, 4, 3, (const double[2]){0.24, 0.12}, shape, thickness, 3);
    shell_sheet_distort(sheet, 0.015, &seed);
    specimen_make(specimen, &sheet->mesh, &stuff, 0.5);
}

static double unbalanced(const struct shell_sheet *sheet, const struct solid *solid, bool turns)
{
    double most = 0.0;
    for (int i = 0; i < solid->n_nodes; i++)
        for (int d = 0; shell_sheet_is_inside(sheet, i) && d < 3; d++)
            most = fmax(most, turns ? fabs(solid->turns.internal[i][d])
                                    : fabs(solid->internal[i][d]));
    return most;
}

/* u = g (x + y/2), v = g (y + x/2), so little that elements keep their shape. */
static void stretched(const char *name, enum solid_element_shape shape)
{
    const double g = 1e-3 * SMALL, direct = 4000.0 / 3.0, shear = 400.0;
    struct shell_sheet sheet;
    struct specimen specimen;
    char text[128];
    double most = 0.0;
    make(&sheet, &specimen, shape, 0.001);
    struct solid *solid = &specimen.solid;
    for (int i = 0; i < solid->n_nodes; i++)
        for (int d = 0; d < 2; d++) {
            const double *x = solid->reference[i], u = g * (x[d] + 0.5 * x[1 - d]);
            solid_velocity(solid, i)[d] = u / specimen.dt;
            solid_place(solid, i)[d] += u;
        }
    solid_forces(solid, 1, specimen.dt);
    for (int e = 0; e < solid->n_elements; e++)
        for (int k = 0; k < 6; k++) {
            const double right = k < 2 ? direct : k == 3 ? shear : 0.0;
            most = fmax(most, fabs(solid->state[e].stress[k] / SMALL - right));
        }
    snprintf(text, sizeof text, "%s: direct stress", name);
    verify_row(text, "Pa", direct, solid->state[0].stress[0] / SMALL, 1e-10, VERIFY_RELATIVE,
               "strain, 1e-11");
    snprintf(text, sizeof text, "%s: shear stress", name);
    verify_row(text, "Pa", shear, solid->state[0].stress[3] / SMALL, 1e-10, VERIFY_RELATIVE,
               "the same");
    snprintf(text, sizeof text, "%s: largest error of stress", name);
    verify_row(text, "Pa", 0.0, most, 2e-8, VERIFY_AT_MOST, "the same");
    snprintf(text, sizeof text, "%s: force on nodes inside, over stress and section", name);
    verify_row(text, "", 0.0, unbalanced(&sheet, solid, false) / (SMALL * direct * 4e-5), 1e-11,
               VERIFY_AT_MOST, "the same");
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
}

/* Bending and twisting moments of an element about space's axes, over the scale. */
static void moments_of(const struct solid *solid, int e, double scale, double moment[3])
{
    const struct shell_element_points points = shell_element_points(solid->layers);
    struct shell_geometry g;
    double x[SOLID_ELEMENT_CORNERS][3], m[3] = {0.0};
    const double t = solid->shell[e].thickness;
    if (solid_corner_places(solid, e, x) == 3)
        shell_geometry_triangle(x, &g);
    else
        shell_geometry_quad(x, &g);
    for (int l = 0; l < solid->layers; l++)
        for (int k = 0; k < 3; k++)
            m[k] += 0.5 * t * t * points.weight[l] * points.place[l] *
                    solid->shell[e].layer[l][k] / scale;
    const double c = g.axis[0][0], s = g.axis[0][1];
    moment[0] = c * c * m[0] + s * s * m[1] - 2.0 * s * c * m[2];
    moment[1] = s * s * m[0] + c * c * m[1] + 2.0 * s * c * m[2];
    moment[2] = s * c * (m[0] - m[1]) + (c * c - s * s) * m[2];
}

/* w = g (x^2 + xy + y^2)/2, nodes turned as its slopes say, so little that it stays flat. */
static void bent(const char *name, enum solid_element_shape shape)
{
    const double g = 1e-3 * SMALL;
    struct shell_sheet sheet;
    struct specimen specimen;
    char text[128];
    double most = 0.0, shear = 0.0, first[3];
    make(&sheet, &specimen, shape, 0.001);
    struct solid *solid = &specimen.solid;
    for (int i = 0; i < solid->n_nodes; i++) {
        const double *x = solid->reference[i];
        const double w = 0.5 * g * (x[0] * x[0] + x[0] * x[1] + x[1] * x[1]);
        solid_place(solid, i)[2] += w;
        solid_velocity(solid, i)[2] = w / specimen.dt;
        solid_turn_spin(&solid->turns, i)[0] = g * (0.5 * x[0] + x[1]) / specimen.dt;
        solid_turn_spin(&solid->turns, i)[1] = -g * (x[0] + 0.5 * x[1]) / specimen.dt;
    }
    solid_forces(solid, 1, specimen.dt);
    moments_of(solid, 0, SMALL, first);
    for (int e = 0; e < solid->n_elements; e++) {
        double moment[3];
        moments_of(solid, e, SMALL, moment);
        for (int k = 0; k < 3; k++)
            most = fmax(most, fabs(moment[k] + (k < 2 ? 1e-6 / 9.0 : 1e-6 / 30.0)));
        for (int k = 0; k < 2; k++)
            shear = fmax(shear, fabs(solid->shell[e].shear[k]) / SMALL);
    }
    snprintf(text, sizeof text, "%s: bending moment over width", name);
    verify_row(text, "N", 1e-6 / 9.0, -first[0], 1e-10, VERIFY_RELATIVE, "rounding");
    snprintf(text, sizeof text, "%s: twisting moment over width", name);
    verify_row(text, "N", 1e-6 / 30.0, -first[2], 1e-10, VERIFY_RELATIVE, "rounding");
    snprintf(text, sizeof text, "%s: largest error of moments, over the bending moment", name);
    verify_row(text, "", 0.0, most * 9e6, 1e-12, VERIFY_AT_MOST, "rounding");
    snprintf(text, sizeof text, "%s: largest stress of transverse shear, over that of bending",
             name);
    verify_row(text, "", 0.0, shear / (2.0 / 3.0), 1e-6, VERIFY_AT_MOST,
               "rounding, times the length over the thickness");
    snprintf(text, sizeof text, "%s: moment on nodes inside, over bending moment and length",
             name);
    verify_row(text, "", 0.0, unbalanced(&sheet, solid, true) / SMALL * 9e6 / 0.04, 1e-9,
               VERIFY_AT_MOST, "slopes squared, of what resists turning about the normal");
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Shells and membranes: patch tests",
                 "MacNeal and Harder 1985: sigma 1333.3, tau 400");
    stretched("quadrilaterals of a shell", SOLID_ELEMENT_SHELL_QUAD);
    stretched("triangles of a shell", SOLID_ELEMENT_SHELL_TRIANGLE);
    stretched("quadrilaterals of a membrane", SOLID_ELEMENT_MEMBRANE_QUAD);
    stretched("triangles of a membrane", SOLID_ELEMENT_MEMBRANE_TRIANGLE);
    verify_source("MacNeal and Harder 1985: M 1.111e-7, Mxy 3.333e-8");
    bent("quadrilaterals, bent", SOLID_ELEMENT_SHELL_QUAD);
    bent("triangles, bent", SOLID_ELEMENT_SHELL_TRIANGLE);
    return verify_end();
}
