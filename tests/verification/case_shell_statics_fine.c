/* The roof, the cylinder and the beam of case_shell_statics on finer meshes: how fast what they
 * give converges, and what published elements give on the same ones. */
/* long */
#include <math.h>
#include <stdio.h>

#include "shells.h"
#include "verify.h"

enum { MESHES = 3 };

/* What an element of others gives on the same meshes, 0 where that is not known, and how near
 * to it ours comes. */
struct published {
    const char *element, *source;
    double given[MESHES], within[MESHES];
};

/* S4R has one point in the plane and hourglass control, as ours; the others, integrated in
 * full, find shear along sides. */
#define ABAQUS     "Abaqus 6.6 Benchmarks Manual 2.3.7"
#define KO         "Ko, Lee, Lee, Bathe, Comput. Struct. 193, 2017, 187"
#define OPTISTRUCT "OptiStruct, verification problem OS-V 0730"

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

static void beside(const char *name, const struct published *other, const double got[MESHES])
{
    verify_source(other->source);
    for (int k = 0; k < MESHES; k++) {
        char text[128];
        snprintf(text, sizeof text, "%s, mesh %d, beside %s", name, k + 1, other->element);
        if (other->given[k] > 0.0)
            verify_row(text, "m", other->given[k], got[k], other->within[k], VERIFY_RELATIVE,
                       "two elements' errors");
    }
}

/* A thin beam is as warped as a thick one, so what is wrong with warped elements tells more. */
static void thin_beam(void)
{
    static const char *const names[2] = {
        "thin beam, 2, 4, 8 quadrilaterals across, along its width",
        "thin beam, 2, 4, 8 quadrilaterals across, along its thickness"};
    static const struct published others[2] = {
        {"S4R", ABAQUS, {1.394, 1.389, 1.388}, {0.06, 0.01, 0.005}},
        {"S4R", ABAQUS, {0.3403, 0.3422, 0.3428}, {0.03, 0.01, 0.005}},
    };
    static const double expected[2] = {1.390, 0.3431};
    for (int d = 0; d < 2; d++) {
        double got[MESHES];
        for (int k = 0; k < MESHES; k++)
            got[k] = shells_beam(SOLID_ELEMENT_SHELL_QUAD, 2 << k, 0.05, d + 1);
        verify_source(d == 0 ? "twisted beam .05 thick: 1.390 along the tip's width"
                             : "twisted beam .05 thick: .3431 along its thickness");
        converge(names[d], expected[d], 0.005, true, got);
        beside(names[d], &others[d], got);
    }
}

int main(int argc, char **argv)
{
    static const enum solid_element_shape shapes[2] = {SOLID_ELEMENT_SHELL_QUAD,
                                                       SOLID_ELEMENT_SHELL_TRIANGLE};
    static const char *const names[2] = {"quadrilaterals", "triangles"};
    static const struct published roofs[2] = {
        {"MITC4", KO, {0.0, 0.0, 0.9886 * 0.3024}, {0.0, 0.0, 0.01}},
        {"MITC3", KO, {0.0, 0.0, 0.9550 * 0.3024}, {0.0, 0.0, 0.01}},
    };
    static const struct published coarse_roofs = {
        "CQUAD4", OPTISTRUCT, {1.082 * 0.3024, 1.020 * 0.3024, 0.0}, {0.1, 0.05, 0.0}};
    static const struct published cylinders[2] = {
        {"MITC4", KO, {0.0, 0.9286 * 1.8248e-5, 0.0}, {0.0, 0.01, 0.0}},
        {"MITC3", KO, {0.0, 0.9308 * 1.8248e-5, 0.0}, {0.0, 0.01, 0.0}},
    };
    static const struct published beams[2] = {
        {"S4R", ABAQUS, {5.479e-3, 5.437e-3, 5.430e-3}, {0.04, 0.01, 0.005}},
        {"S4R", ABAQUS, {1.868e-3, 1.777e-3, 1.761e-3}, {0.12, 0.04, 0.01}},
    };
    verify_begin(argc, argv, "Shells: roof, pinched cylinder, twisted beam on finer meshes",
                 "");
    for (int s = 0; s < 2; s++) {
        char text[128];
        double roof[MESHES], cylinder[MESHES], beam[2][MESHES];
        for (int k = 0; k < MESHES; k++) {
            roof[k] = shells_roof(shapes[s], 4 << k, 1.0);
            cylinder[k] = shells_cylinder(shapes[s], 8 << k, 1.0);
            beam[0][k] = shells_beam(shapes[s], 2 << k, 0.32, 1);
            beam[1][k] = shells_beam(shapes[s], 2 << k, 0.32, 2);
        }
        verify_source("Scordelis-Lo roof: .3024");
        snprintf(text, sizeof text, "roof, 4, 8, 16 %s a side", names[s]);
        converge(text, 0.3024, s == 0 ? 0.01 : 0.05, s == 0, roof);
        beside(text, &roofs[s], roof);
        if (s == 0)
            beside(text, &coarse_roofs, roof);
        verify_source("pinched cylinder: 1.8248e-5");
        snprintf(text, sizeof text, "cylinder, 8, 16, 32 %s a side", names[s]);
        converge(text, 1.8248e-5, 0.03, s == 0, cylinder);
        beside(text, &cylinders[s], cylinder);

        verify_source("twisted beam: .005424 along the tip's width");
        snprintf(text, sizeof text, "beam, 2, 4, 8 %s across, along its width", names[s]);
        converge(text, 0.005424, s == 0 ? 0.01 : 0.02, s == 0, beam[0]);
        if (s == 0)
            beside(text, &beams[0], beam[0]);
        verify_source("twisted beam: .001754 along its thickness");
        snprintf(text, sizeof text, "beam, 2, 4, 8 %s across, along its thickness", names[s]);
        converge(text, 0.001754, s == 0 ? 0.01 : 0.03, s == 0, beam[1]);
        if (s == 0)
            beside(text, &beams[1], beam[1]);
    }
    thin_beam();
    return verify_end();
}
