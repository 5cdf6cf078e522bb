/* Shells of which publications know how far they give: what their cases share. */
#ifndef TREMIE_TESTS_VERIFICATION_SHELLS_H
#define TREMIE_TESTS_VERIFICATION_SHELLS_H

#include "solid/solid.h"

/* How far the point gives that publications speak of, with n cells along each side (the roof a
 * quarter, the cylinder an eighth of the whole; the beam n cells across and 6 n along), for the
 * roof and the cylinder with a share of the modes' stiffness.  At rest, found by
 * mass-proportional damping [m]. */
double shells_roof(enum solid_element_shape shape, int n, double modes);
double shells_cylinder(enum solid_element_shape shape, int n, double modes);
/* Pulled at its tip along its width (1) or its thickness (2) there; .32 or .05 thick [m]. */
double shells_beam(enum solid_element_shape shape, int n, double thick, int direction);

#endif
