/*
 * Plastic shells and membranes: a strip bent until all of its thickness flows, and strips
 * pulled far, whose stress follows the yield curve and whose volume only changes as stress
 * says.
 */
#include <math.h>
#include <stdio.h>

#include "../unit/shell_sheet.h"
#include "specimen.h"
#include "verify.h"

static const double YOUNG = 1e9, POISSON = 0.3, YIELD = 1e6;

static struct solid_material stuff(int n, const struct solid_yield_point *yield,
                                   double hardening)
{
    return (struct solid_material){.density = 1000.0,
                                   .young = YOUNG,
                                   .poisson = POISSON,
                                   .hourglass_stiffness = 0.1,
                                   .n_yield = n,
                                   .yield = yield,
                                   .hardening = hardening};
}

/* ------------------------------------------------------------------------------- bending */

/* Moment over width of a flat strip whose ends turn against each other, to a curvature of so
 * many times the first at which it yields; sides are free. */
static double moment_of(enum solid_element_shape shape, int layers, double times)
{
    static const double LENGTH = 0.1, WIDTH = 0.02, THICK = 0.01;
    static const struct solid_yield_point yield[1] = {{0.0, YIELD}};
    const struct solid_material material = stuff(1, yield, 0.0);
    const double first = 2.0 * YIELD / (YOUNG * THICK), time = 0.2;
    const struct shell_element_points points = shell_element_points(layers);
    struct shell_sheet sheet;
    struct specimen specimen;
    double moment = 0.0;
    shell_sheet_build(&sheet, 5, 1, (const double[2]){LENGTH, WIDTH}, shape, THICK, layers);
    specimen_make(&specimen, &sheet.mesh, &material, 0.9);
    struct solid *solid = &specimen.solid;
    solid->damping = 200.0;
    for (int i = 0; i < solid->n_nodes; i++) {
        /* Every section turns as far as it is away: uniform curvature. */
        const double rate = times * first * (solid->reference[i][0] - 0.5 * LENGTH) / time;
        const struct solid_table table = {1, (struct solid_table_point[]){{0.0, rate}}};
        solid_supports_add_turn(&solid->supports, SOLID_SUPPORT_VELOCITY, 1, &table, 1, &i);
    }
    specimen_fix(&specimen, 0, 0.0, 0);
    specimen_fix(&specimen, 1, 0.0, 1);
    specimen_fix(&specimen, 0, 0.5 * LENGTH, 2);
    specimen_steps(&specimen, (int64_t)(time / specimen.dt));
    for (int e = 0; e < solid->n_elements; e++) {
        const double t = solid->shell[e].thickness;
        double own = 0.0; /* the trace: about y alone there is a moment */
        for (int l = 0; l < layers; l++)
            own += 0.5 * t * t * points.weight[l] * points.place[l] *
                   (solid->shell[e].layer[l][0] + solid->shell[e].layer[l][1]);
        moment += fabs(own) / solid->n_elements;
    }
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
    return moment / (0.25 * YIELD * THICK * THICK);
}

/* What points through the thickness make of sigma t^2/4. */
static double full_moment(int layers)
{
    const struct shell_element_points points = shell_element_points(layers);
    double sum = 0.0;
    for (int l = 0; l < layers; l++)
        sum += 2.0 * points.weight[l] * fabs(points.place[l]);
    return sum;
}

static void bend(void)
{
    char text[128];
    for (int layers = 2; layers <= SHELL_ELEMENT_LAYERS; layers++) {
        snprintf(text, sizeof text, "fully plastic moment over sigma t^2/4, %d points", layers);
        verify_row(text, "", full_moment(layers),
                   moment_of(SOLID_ELEMENT_SHELL_QUAD, layers, 12.0), 0.01, VERIFY_RELATIVE,
                   "thickness changes, stress across is nearly none");
    }
    verify_row("fully plastic moment of triangles over sigma t^2/4, 5 points", "",
               full_moment(5), moment_of(SOLID_ELEMENT_SHELL_TRIANGLE, 5, 12.0), 0.02,
               VERIFY_RELATIVE, "the same");
    verify_source("sigma t^2/4");
    verify_row("fully plastic moment over sigma t^2/4, 5 points", "", 1.0,
               moment_of(SOLID_ELEMENT_SHELL_QUAD, 5, 12.0), 0.06, VERIFY_RELATIVE,
               "Gauss's points take .9448 of it");
    verify_source("sigma t^2/6, where the outer points still are elastic");
    verify_row("elastic moment over sigma t^2/4 at the first yield, 5 points", "", 2.0 / 3.0,
               moment_of(SOLID_ELEMENT_SHELL_QUAD, 5, 1.0), 0.005, VERIFY_RELATIVE,
               "the strip still swings");
}

/* ------------------------------------------------------------------------------- pulling */

static void pull(const char *name, enum solid_element_shape shape)
{
    static const double LENGTH = 0.1, WIDTH = 0.05, THICK = 0.01, STRETCH = 1.35;
    static const struct solid_yield_point yield[3] = {{0.0, 1e6}, {0.05, 1.5e6}, {0.2, 2e6}};
    const struct solid_material material = stuff(3, yield, 2e6);
    const double time = 0.8;
    const struct solid_table table = {
        2, (struct solid_table_point[]){{0.0, 0.0}, {time, (STRETCH - 1.0) * LENGTH}}};
    struct shell_sheet sheet;
    struct specimen specimen;
    char text[128];
    int *nodes;
    shell_sheet_build(&sheet, 4, 2, (const double[2]){LENGTH, WIDTH}, shape, THICK, 3);
    specimen_make(&specimen, &sheet.mesh, &material, 0.7);
    struct solid *solid = &specimen.solid;
    solid->damping = 50.0;
    specimen_fix(&specimen, 0, 0.0, 0);
    specimen_fix(&specimen, 1, 0.0, 1);
    for (int axis = 0; axis < 2; axis++)
        specimen_fix(&specimen, axis, 0.0, 2);
    const int n = specimen_plane(&specimen, 0, LENGTH, &nodes);
    solid_supports_add(&solid->supports, SOLID_SUPPORT_DISPLACEMENT, 0, &table, n, nodes);
    specimen_steps(&specimen, (int64_t)(time / specimen.dt));
    double volume = 0.0, thickness = 0.0, stress = 0.0;
    for (int e = 0; e < solid->n_elements; e++) {
        stress += solid->state[e].stress[0] / solid->n_elements;
        volume += solid->state[e].volume;
        thickness += solid->shell[e].thickness / solid->n_elements;
    }
    const double p = log(STRETCH) - stress / YOUNG;
    snprintf(text, sizeof text, "%s: stress over the yield curve's at ln(l/l0) - sigma/E",
             name);
    verify_row(text, "", 1.0, stress / solid_element_yield_stress(&solid->materials[0], p),
               2e-3, VERIFY_RELATIVE, "inertia of what is pulled");
    snprintf(text, sizeof text, "%s: volume over 1 + (1 - 2 nu) sigma/E", name);
    verify_row(text, "", 1.0,
               volume /
                   (LENGTH * WIDTH * THICK * (1.0 + (1.0 - 2.0 * POISSON) * stress / YOUNG)),
               5e-4, VERIFY_RELATIVE, "second order in strain of a step; what moves across");
    snprintf(text, sizeof text, "%s: thickness over t (l0/l)^.5", name);
    verify_row(text, "", 1.0, thickness / (THICK / sqrt(STRETCH)), 2e-3, VERIFY_RELATIVE,
               "elastic strain, .1 %");
    free(nodes);
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Plastic shells and membranes",
                 "sum of weights times |place| of Gauss's points");
    bend();
    verify_source("J2 flow keeps the volume; one stress");
    pull("shell of quadrilaterals, pulled", SOLID_ELEMENT_SHELL_QUAD);
    pull("shell of triangles, pulled", SOLID_ELEMENT_SHELL_TRIANGLE);
    pull("membrane of quadrilaterals, pulled", SOLID_ELEMENT_MEMBRANE_QUAD);
    pull("membrane of triangles, pulled", SOLID_ELEMENT_MEMBRANE_TRIANGLE);
    return verify_end();
}
