/*
 * A sphere on a large plate of a shell (Zener, Phys. Rev. 59, 1941, 669): what the plate's
 * bending waves carry away makes the sphere come back slower.  The contact is Hertz's spring at
 * one node; a quarter of the plate is modelled, so wide that no wave is back before the sphere
 * is gone.
 */
#include <math.h>
#include <stdio.h>

#include "../unit/shell_sheet.h"
#include "specimen.h"
#include "verify.h"

static const struct solid_material steel = {7850.0, 2.1e11, 0.3, 0.0, 1.0, 0.0, 0, NULL, 0.0};
static const double RADIUS = 0.01, SPEED = 1.0;

struct sphere {
    double mass, spring; /* [kg], [N/m^1.5] */
    double z, v;         /* of its lowest point [m]; half a step earlier [m/s] */
    double force, most;  /* [N] */
    double touched;      /* [s] */
};

/* Node 0 is the middle of the plate. */
static void push(struct specimen *specimen, void *what)
{
    struct sphere *sphere = what;
    struct solid *solid = &specimen->solid;
    const double overlap = solid_place(solid, 0)[2] - sphere->z;
    sphere->force = overlap > 0.0 ? sphere->spring * overlap * sqrt(overlap) : 0.0;
    sphere->most = fmax(sphere->most, sphere->force);
    sphere->touched += overlap > 0.0 ? specimen->dt : 0.0;
    solid->contact[0][2] -= 0.25 * sphere->force;
    sphere->v += specimen->dt * sphere->force / sphere->mass;
    sphere->z += specimen->dt * sphere->v;
}

static struct sphere sphere_of_steel(void)
{
    return (struct sphere){.mass = 4.0 / 3.0 * M_PI * pow(RADIUS, 3.0) * steel.density,
                           .spring = 4.0 / 3.0 * 0.5 * steel.young /
                                     (1.0 - steel.poisson * steel.poisson) * sqrt(RADIUS),
                           .v = -SPEED};
}

/* Zener's parameter for a plate of this thickness. */
static double lambda_of(double thickness)
{
    const struct sphere sphere = sphere_of_steel();
    const double bending =
        steel.young * pow(thickness, 3.0) / (12.0 * (1.0 - steel.poisson * steel.poisson));
    return pow(sphere.mass, 0.6) * pow(sphere.spring, 0.4) * pow(SPEED, 0.2) /
           (8.0 * sqrt(bending * steel.density * thickness));
}

static struct sphere impact(enum solid_element_shape shape, double thickness, double cell)
{
    enum { CELLS = 24 };
    struct shell_sheet sheet;
    struct specimen specimen;
    struct sphere sphere = sphere_of_steel();
    shell_sheet_build(&sheet, CELLS, CELLS, (const double[2]){CELLS * cell, CELLS * cell},
                      shape, thickness, 2);
    specimen_make(&specimen, &sheet.mesh, &steel, 0.5);
    for (int axis = 0; axis < 2; axis++) { /* planes of symmetry */
        specimen_fix(&specimen, axis, 0.0, axis);
        specimen_fix_turn(&specimen, axis, 0.0, 1 - axis);
        specimen_fix_turn(&specimen, axis, 0.0, 2);
    }
    do
        specimen_pushed_steps(&specimen, 1, push, &sphere);
    while (sphere.force > 0.0 || sphere.most == 0.0);
    specimen_free(&specimen);
    shell_sheet_free(&sheet);
    return sphere;
}

/* A row of Zener's table: restitution, largest force over m v/T, duration over T. */
struct answer {
    double lambda, restitution, force, duration;
};

static void compare(const char *name, enum solid_element_shape shape,
                    const struct answer *answer)
{
    const struct sphere before = sphere_of_steel();
    const double scale = pow(before.mass / (before.spring * sqrt(SPEED)), 0.4);
    const double thickness = 0.01 * sqrt(lambda_of(0.01) / answer->lambda);
    const struct sphere after = impact(shape, thickness, thickness);
    char text[128];
    snprintf(text, sizeof text, "%s, lambda %.4f: restitution", name, answer->lambda);
    verify_row(text, "", answer->restitution, after.v / SPEED, 0.05, VERIFY_RELATIVE,
               "plates shear, Zener's do not; one node carries the load");
    snprintf(text, sizeof text, "%s, lambda %.4f: largest force", name, answer->lambda);
    verify_row(text, "N", answer->force * before.mass * SPEED / scale, after.most, 0.05,
               VERIFY_RELATIVE, "the same");
    snprintf(text, sizeof text, "%s, lambda %.4f: duration", name, answer->lambda);
    verify_row(text, "s", answer->duration * scale, after.touched, 0.05, VERIFY_RELATIVE,
               "the same, and a step");
}

int main(int argc, char **argv)
{
    static const struct answer answers[4] = {{0.05, 0.91777, 1.08680, 3.2471},
                                             {0.1556, 0.76852, 0.98385, 3.3162},
                                             {0.2434, 0.66482, 0.91178, 3.3822},
                                             {0.5, 0.43690, 0.75023, 3.6245}};
    verify_begin(argc, argv, "Shells: a sphere on a large plate",
                 "Zener 1941, integrated for this project");
    for (int k = 0; k < 4; k++)
        compare("quadrilaterals", SOLID_ELEMENT_SHELL_QUAD, &answers[k]);
    compare("triangles", SOLID_ELEMENT_SHELL_TRIANGLE, &answers[1]);
    return verify_end();
}
