/*
 * Cylinders and cones cut into triangles, for cases about smooth walls that a mesh stands for.
 */
#ifndef TREMIE_TESTS_VERIFICATION_SURFACE_H
#define TREMIE_TESTS_VERIFICATION_SURFACE_H

#include <stdbool.h>

struct surface {
    double radius[2]; /* at the low and the high end; vertices lie on it [m] */
    double z[2];      /* [m] */
    int n_around, n_rings;
    bool has_floor; /* closed by a fan of triangles at the low end */
};

/* An entry of the job's list `bodies`: 2 n_around n_rings triangles about the z axis, half of a
 * segment turned from ring to ring where there are several. The caller frees it. */
char *surface_body(const char *name, const char *material, const struct surface *surface);

#endif
