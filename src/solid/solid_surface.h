/* The surface of a solid: sides of living elements that no other living element shares; shells
 * and membranes once, as seen from their side 0, whatever is behind them. */
#ifndef TREMIE_SOLID_SOLID_SURFACE_H
#define TREMIE_SOLID_SOLID_SURFACE_H

#include "solid/solid_side.h"

struct solid;

struct solid_surface_face {
    int element, side;
    int n;                       /* 3 or 4 */
    int nodes[SOLID_SIDE_NODES]; /* against the clock as seen from outside */
};

struct solid_surface {
    int n, capacity; /* in ascending order of (element, side) */
    struct solid_surface_face *faces;
};

/* Of the whole solid as `alive` says, whoever computes what; the surface is zero at first or an
 * earlier one. */
void solid_surface_build(struct solid_surface *surface, const struct solid *solid);
void solid_surface_clear(struct solid_surface *surface);

#endif
