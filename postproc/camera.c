/*
 * See camera.h.  Fitting: seen from far away along `ahead`, a ball at camera coordinates (x, y,
 * z) relative to the middle of the scene lies inside the right side of the view of half-angle
 * a, with the eye at (e, 0, -d), when x - z tan a + r / cos a <= e + d tan a; likewise on the
 * left.  So the largest left hand sides over all balls give e and the least d at once, per
 * direction; the larger d is taken.
 */
#include "camera.h"

#include <math.h>

static const double PI = 3.14159265358979323846;
static const double FIELD_OF_VIEW = 32.0; /* across the frame's larger side [degrees] */

struct vec3 camera_direction(const struct camera *camera, struct vec3 direction)
{
    return (struct vec3){vec3_dot(direction, camera->right), vec3_dot(direction, camera->up),
                         vec3_dot(direction, camera->ahead)};
}

struct vec3 camera_point(const struct camera *camera, struct vec3 point)
{
    return camera_direction(camera, vec3_sub(point, camera->eye));
}

static void orient(struct camera *camera, double azimuth, double elevation)
{
    const double a = azimuth * PI / 180.0, e = elevation * PI / 180.0;
    camera->ahead = (struct vec3){-sin(a) * cos(e), cos(a) * cos(e), -sin(e)};
    camera->right = (struct vec3){cos(a), sin(a), 0.0};
    camera->up = vec3_cross(camera->right, camera->ahead);
}

/* Where the eye must stand in one direction across: its offset and the distance. */
struct stand {
    double offset, distance;
};

static struct stand fit_across(const struct camera *camera, struct vec3 across, double tangent,
                               int n, const struct camera_ball *balls)
{
    const double per_radius = sqrt(1.0 + tangent * tangent);
    double most = -INFINITY, least = -INFINITY;
    for (int i = 0; i < n; i++) {
        const double x = vec3_dot(balls[i].centre, across),
                     z = vec3_dot(balls[i].centre, camera->ahead);
        const double spare = balls[i].radius * per_radius - z * tangent;
        most = x + spare > most ? x + spare : most;
        least = -x + spare > least ? -x + spare : least;
    }
    return (struct stand){0.5 * (most - least), 0.5 * (most + least) / tangent};
}

struct camera camera_fit(double azimuth, double elevation, double zoom,
                         struct camera_frame frame, int n, const struct camera_ball *balls)
{
    const double width = frame.right - frame.left, height = frame.bottom - frame.top;
    const double larger = width > height ? width : height;
    struct camera camera = {
        .centre = {0.5 * (frame.left + frame.right), 0.5 * (frame.top + frame.bottom)},
        .focal = 0.5 * larger / tan(0.5 * FIELD_OF_VIEW * PI / 180.0)};
    orient(&camera, azimuth, elevation);
    const struct stand x =
        fit_across(&camera, camera.right, 0.5 * width / camera.focal, n, balls);
    const struct stand y =
        fit_across(&camera, camera.up, 0.5 * height / camera.focal, n, balls);
    const double distance = x.distance > y.distance ? x.distance : y.distance;
    camera.eye = vec3_scale(-distance, camera.ahead);
    camera.eye = vec3_axpy(camera.eye, x.offset, camera.right);
    camera.eye = vec3_axpy(camera.eye, y.offset, camera.up);
    camera.focal *= zoom;
    return camera;
}

struct vec3 camera_middle(int n, const struct camera_ball *balls)
{
    struct vec3 least = balls[0].centre, most = balls[0].centre;
    for (int i = 1; i < n; i++) {
        const struct vec3 c = balls[i].centre;
        least = (struct vec3){fmin(least.x, c.x), fmin(least.y, c.y), fmin(least.z, c.z)};
        most = (struct vec3){fmax(most.x, c.x), fmax(most.y, c.y), fmax(most.z, c.z)};
    }
    return vec3_scale(0.5, vec3_add(least, most));
}
