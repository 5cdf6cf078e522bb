/*
 * A surface as the panels that it bends in: facets that go on into each other without a sharp
 * fold are one panel.  Folds hold a panel, as walls that meet hold each other.
 */
#ifndef TREMIE_RUN_PANELS_H
#define TREMIE_RUN_PANELS_H

#include <stdbool.h>

#include "base/vec3.h"

struct mesh;

struct panel {
    int n_faces;
    double area;        /* [m2] */
    double span;        /* twice from its farthest point to what holds it; 0: nothing [m] */
    double curvature;   /* mean sum of both [1/m] */
    struct vec3 normal; /* mean, of length 1, or shorter where it is curved */
};

struct panels {
    int n;
    struct panel *list;
};

/* `rims_hold`: free edges do as well.  `held` are places that do besides.  Local. */
void panels_find(struct panels *panels, const struct mesh *mesh, bool rims_hold, int n_held,
                 const struct vec3 *held);
void panels_clear(struct panels *panels);
/* How far the farthest of these points is from the nearest that is held; 0 without any [m]. */
double panels_farthest(int n, const struct vec3 *points, int n_held, const struct vec3 *held);

#endif
