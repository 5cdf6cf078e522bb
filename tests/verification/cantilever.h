/* A steel cantilever: its first frequency, of hexahedra and by theory. */
#ifndef TREMIE_TESTS_VERIFICATION_CANTILEVER_H
#define TREMIE_TESTS_VERIFICATION_CANTILEVER_H

#include "solid/solid.h"

/* 1 m x .05 m x .05 m, of cubes, so many across; hourglass stiffness as given.  From the times
 * at which it passes its place of rest [1/s]. */
double cantilever_frequency(int across, double hourglass_stiffness);
/* What beam theory gives: 1.8751^2/2 pi sqrt(EI/(rho A L^4)) [1/s]. */
double cantilever_theory(void);
/* The hourglass stiffness with which cubes bend as beams do.  (12.10) */
double cantilever_bending_stiffness(void);

/* The first mode of such a beam and its slope at x. */
double cantilever_mode(double x, double *slope);
/* Displacement across it in the shape of that mode: higher ones are orthogonal to it. */
double cantilever_displacement(const struct solid *solid);

#endif
