/*
 * Drawing with depth: spheres, facets, lines and text, finely sampled, then averaged into a
 * picture.
 *
 * Spheres go first: every sample keeps the nearest surface (a z-buffer), with its normal and
 * colour, found by cutting the ray of the sample with the sphere, so outlines and intersections
 * are exact at any size.  canvas_light() then lights all of it at once: a lamp, a sky, and
 * shade in crevices, found from the depths around a sample.  Facets and lines are laid over,
 * tested against the depths; text and marks come last.  A drawback: glassy facets are not
 * sorted, so where several overlap their mix depends on the order of drawing; they are faint
 * and of one colour, and that does not show.
 */
#ifndef TREMIE_POSTPROC_CANVAS_H
#define TREMIE_POSTPROC_CANVAS_H

#include "base/vec3.h"
#include "camera.h"
#include "colours.h"
#include "image.h"

enum { CANVAS_SAMPLES = 2 }; /* samples of a pixel across and down */

struct canvas {
    int width, height; /* [samples] */
    float *depth;      /* [m]; infinite where there is nothing */
    unsigned char (*colour)[3];
    signed char (*normal)[3]; /* camera coordinates, times 127 */
};

enum canvas_anchor { CANVAS_LEFT, CANVAS_MIDDLE, CANVAS_RIGHT };

/* A canvas for a picture of width x height pixels, with its backdrop.  The camera that draws on
 * it works in samples. */
void canvas_init(struct canvas *canvas, int width, int height);
void canvas_clear(struct canvas *canvas);

void canvas_sphere(struct canvas *canvas, const struct camera *camera, struct vec3 centre,
                   double radius, struct colours_rgb colour);
/* Lights the spheres drawn so far; `reach` is how far surfaces shade each other [m]. */
void canvas_light(struct canvas *canvas, const struct camera *camera, double reach);
/* A convex polygon of n <= 8 corners, like a sheet of glass of this opacity. */
void canvas_facet(struct canvas *canvas, const struct camera *camera, int n,
                  const struct vec3 *corners, struct colours_rgb colour, double opacity);
/* A line in space, `width` samples wide, hidden by what is nearer by more than `slack` [m]. */
void canvas_edge(struct canvas *canvas, const struct camera *camera, struct vec3 a,
                 struct vec3 b, double width, double slack, struct colours_rgb colour);

/* On the picture's plane, in samples from the top left corner. */
void canvas_rectangle(struct canvas *canvas, double left, double top, double right,
                      double bottom, struct colours_rgb colour);
void canvas_stroke(struct canvas *canvas, const double a[2], const double b[2], double width,
                   struct colours_rgb colour);
/* Text whose capitals are `height` samples high and stand on y. */
void canvas_text(struct canvas *canvas, double x, double y, double height,
                 enum canvas_anchor anchor, struct colours_rgb colour, const char *text);
double canvas_text_width(double height, const char *text);

/* The picture: the mean of each pixel's samples. */
void canvas_develop(const struct canvas *canvas, struct image *image);

#endif
