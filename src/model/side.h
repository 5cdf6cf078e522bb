/* Sides of polygons, sorted so that those along one edge follow each other. */
#ifndef TREMIE_MODEL_SIDE_H
#define TREMIE_MODEL_SIDE_H

#include <stdbool.h>

struct side {
    int ends[2]; /* vertices, ascending */
    int polygon, side;
    bool turned; /* does it go from the greater to the lesser? */
};

/* Appends the sides of a polygon of n corners to a list that has room for them. */
void side_add(struct side *sides, int *n_sides, int polygon, int n, const int *corners);
/* By edges, of each by polygons and their sides. */
void side_sort(struct side *sides, int n);
/* Behind the sides along the edge of the first one, in a sorted list. */
int side_edge_end(const struct side *sides, int first, int n);

#endif
