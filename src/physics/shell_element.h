/*
 * Quadrilaterals and triangles of shells and membranes, with one point in their plane and
 * several through the thickness (THEORY.md, section 13): shapes beside those of
 * physics/solid_element.h, with the same nodes, corners, lists and forces.
 *
 * Quadrilaterals of shells are those of Belytschko, Lin and Tsay with what Belytschko, Wong and
 * Chiang added: warped ones know it, shear is found along sides.  Everything is kept in the
 * element's own frame, which turns along, so nothing that is remembered has to be turned.
 * Nodes of shells also turn; about its own normal an element resists no turning.
 *
 * What all elements remember stands in their solid_element_state: `stress` is the mean through
 * the thickness, in space, and `plastic_strain` the most of all layers; `hourglass` holds the
 * forces of the modes.  What only these have stands in a second state.
 */
#ifndef TREMIE_PHYSICS_SHELL_ELEMENT_H
#define TREMIE_PHYSICS_SHELL_ELEMENT_H

#include "physics/solid_element.h"

enum { SHELL_ELEMENT_LAYERS = 5 /* at most */ };

/* What an element of a shell or membrane remembers besides, in its own frame. */
struct shell_element_state {
    double layer[SHELL_ELEMENT_LAYERS][4]; /* xx yy xy [Pa], plastic strain; from below */
    double shear[2];                       /* xz yz, the mean [Pa] */
    double thickness;                      /* [m] */
    double across;                         /* stiffness against that shear [Pa] */
} __attribute__((aligned(64)));

/* Places of the points through the thickness, -1 to 1, and their weights, together 1:
 * Gauss's.  There are 1 to SHELL_ELEMENT_LAYERS. */
struct shell_element_points {
    double place[SHELL_ELEMENT_LAYERS], weight[SHELL_ELEMENT_LAYERS];
};
struct shell_element_points shell_element_points(int layers);

bool shell_element_is(enum solid_element_shape shape);
/* Does it have fibres, so that its nodes turn? */
bool shell_element_turns(enum solid_element_shape shape);

/* Adds the kernels of these shapes. */
void shell_element_choose(enum isa isa, struct solid_element_kernel *kernel);

/* Without stress. */
struct shell_element_state shell_element_begin(double thickness,
                                               const struct solid_element_material *material);
/* [m2] */
double shell_element_area(enum solid_element_shape shape, double x[][3]);
/* The area at x, as seen along the normal it has at y: not positive where it has turned over
 * on the way [m2]. */
double shell_element_facing(enum solid_element_shape shape, double x[][3], double y[][3]);
/* Inertia of a corner's share of the mass against turning, over that share [m2]: as of the
 * thickness, or more where that would limit the step.  (13.15) */
double shell_element_inertia(enum solid_element_shape shape, double x[][3], double thickness);
/* Von Mises's equivalent stress, the most of all layers; shear across is not in it [Pa]. */
double shell_element_mises(const struct shell_element_state *shell,
                           enum solid_element_shape shape, int layers);
/* Energy that stress holds in the element [J]. */
double shell_element_energy(enum solid_element_shape shape,
                            const struct solid_element_state *state,
                            const struct shell_element_state *shell, int layers,
                            const struct solid_element_material *material);
/* What it allows of the step, for corners of a third or a quarter of the mass, (13.16); or a
 * bound on the frequency squared that is at most `enough` [1/s2]. */
struct solid_element_load shell_element_load(enum solid_element_shape shape, double x[][3],
                                             double mass, double thickness, int layers,
                                             const struct solid_element_material *material,
                                             double enough);

#endif
