/*
 * A part of space that does not move: a box, a cylinder, a ball, or the inside of a body's
 * closed surface (as it is at time 0).  For packings, insertion, what is counted or damped.
 *
 * Answers are exact comparisons of + - * / and square roots, so they are the same on every
 * rank. Local, all of it.
 */
#ifndef TREMIE_MODEL_REGION_H
#define TREMIE_MODEL_REGION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/vec3.h"
#include "job/job.h"

struct bodies;
struct body;
struct mesh;
struct periodic;
struct region_surface;

struct region {
    enum job_region_kind kind;
    struct vec3 low, high;          /* corners of the least box that holds it [m] */
    double volume;                  /* [m3] */
    struct vec3 centre;             /* sphere; cylinder: one end of its axis [m] */
    struct vec3 axis;               /* cylinder: of length 1 */
    double length, radius;          /* cylinder, sphere [m] */
    bool endless[3];                /* has no ends along x, y, z: see region_repeat */
    struct region_surface *surface; /* inside; else NULL */
};

/* Builds the region.  `bodies` are only looked at for `inside`, and not kept.  Returns false
 * with the reason in *why (caller frees): no such body, or its surface is not closed. */
bool region_build(struct region *region, const struct job_region *asked,
                  const struct bodies *bodies, char **why);
void region_clear(struct region *region);
/* Where space repeats, a region that spans a period has no ends there: it becomes what of it
 * lies within the domain, and keeps no margin from the boundary.  A tilted cylinder, a ball and
 * an inside keep their surface. */
void region_repeat(struct region *region, const struct periodic *periodic);

/* Is x inside, at least `margin` from the region's surface?  A margin below 0, which an inside
 * does not have, lets x be that far outside. */
bool region_contains(const struct region *region, struct vec3 x, double margin);

/* Does the straight way to x, along and as long as `way`, meet the region?  Of the inside of a
 * body: is x in it? */
bool region_is_met(const struct region *region, struct vec3 x, struct vec3 way);

/* A random point, even in the box that holds all places with this margin: try region_contains
 * next.  Attempts from 0; each takes the counters 3 attempt .. 3 attempt + 2 of the stream. */
struct vec3 region_point(const struct region *region, double margin, uint64_t seed,
                         uint64_t stream, uint64_t attempt);

/* The surface of any body, closed or not, with its vertices at these places, for instance
 * mesh->reference. */
struct region_surface *region_surface_build(const struct mesh *mesh,
                                            const struct vec3 *vertices);
void region_surface_destroy(struct region_surface *surface);
/* Is it nearer to x than the margin? */
bool region_surface_is_near(const struct region_surface *surface, struct vec3 x, double margin);
/* Is x inside a surface that is closed? */
bool region_surface_holds(const struct region_surface *surface, struct vec3 x);

/* Is a body solid to spheres that come into this region?  One with a closed surface is, unless
 * most of the region is inside it: then it is their container. */
bool region_meets_solid(const struct region *region, const struct body *body);

#endif
