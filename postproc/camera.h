/*
 * A perspective camera: from space to the picture.
 *
 * Camera coordinates have x to the right, y upwards and z away from the eye (depth).  The
 * picture plane is at depth 1, so that a point shows at (x/z, y/z) times `focal` pixels from
 * the principal point.
 */
#ifndef TREMIE_POSTPROC_CAMERA_H
#define TREMIE_POSTPROC_CAMERA_H

#include "base/vec3.h"

struct camera {
    struct vec3 eye;              /* [m] */
    struct vec3 right, up, ahead; /* orthonormal */
    double focal;                 /* [pixels] */
    double centre[2];             /* principal point [pixels], y downwards */
};

/* The part of a picture that a scene is to fill. */
struct camera_frame {
    double left, top, right, bottom; /* [pixels] */
};

/* A ball that must be in the picture. */
struct camera_ball {
    struct vec3 centre; /* [m] */
    double radius;      /* [m] */
};

/*
 * Looks along the direction given by azimuth and elevation [degrees]: the eye stands at
 * `azimuth` from the -y axis towards +x and `elevation` above the horizon.  The nearest place
 * is chosen from where all balls fit the frame; zoom > 1 shows them larger about the middle.
 */
struct camera camera_fit(double azimuth, double elevation, double zoom,
                         struct camera_frame frame, int n, const struct camera_ball *balls);

/* The middle of the box around all balls. */
struct vec3 camera_middle(int n, const struct camera_ball *balls);

/* Camera coordinates of a point, and of a direction. */
struct vec3 camera_point(const struct camera *camera, struct vec3 point);
struct vec3 camera_direction(const struct camera *camera, struct vec3 direction);

#endif
