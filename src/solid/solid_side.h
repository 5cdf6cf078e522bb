/* Sides of elements. */
#ifndef TREMIE_SOLID_SOLID_SIDE_H
#define TREMIE_SOLID_SOLID_SIDE_H

struct solid;

enum { SOLID_SIDES = 6 /* at most */, SOLID_SIDE_NODES = 4 /* at most */ };

/* Side `side` of an element, counted as model/solid_mesh.h does; of shells and membranes 0123
 * or 012, and the same from behind. */
struct solid_side {
    int element, side;
};

/* Nodes of a side, against the clock as seen from outside; returns how many, 0 where the
 * element has no such side. */
int solid_side_nodes(const struct solid *solid, int element, int side,
                     int nodes[SOLID_SIDE_NODES]);
/* Integrals of the normal of a side times the shape function of each of its n nodes at x, which
 * sum up to its area along its normal [m2].  (12.16) */
void solid_side_areas(int n, double x[SOLID_SIDE_NODES][3], double area[SOLID_SIDE_NODES][3]);

#endif
