/*
 * Spheres from an HDF5 file, as a packing: a checkpoint, or any file with these under /spheres:
 * position (n x 3), radius (n), velocity and angular_velocity (n x 3), little-endian doubles in
 * SI units.
 */
#ifndef TREMIE_STORE_SPHERE_FILE_H
#define TREMIE_STORE_SPHERE_FILE_H

#include "model/packings.h"

/* A packings_reader: "path: what; what is expected" where there is something wrong.  Local. */
char *sphere_file_read(const char *path, const struct packing_sphere *standard, int64_t *n,
                       struct packing_sphere **rows);

#endif
