/*
 * Local search on the surface of a body that deforms: what a ball covers of it in this step.
 *
 * Faces of such a body turn against each other, so a contact a feature would come and go with a
 * force already on it.  Instead all faces that the ball covers share one volume behind them
 * (physics/contact_patch.h), which says how deep the contact is, and each node is pushed as the
 * volume grows with its displacement.  What the normal spring holds is thereby a function of
 * where things are and of nothing else, and no energy comes out of seams, nodes and dents
 * (THEORY.md 2.1).
 *
 * Friction and damping act once on every smooth part of the surface (body_skin.smooth), as a
 * sphere in a corner rubs on two walls.  Of each part one entry of the list holds the memory:
 * it keeps it while its face is covered; else the first that is takes it over.
 *
 * Drawback: in a sharp inner corner springs of two walls count as one that is as deep as both
 * together, by Hertz's law stiffer by the fourth root of two (19 %).
 */
#ifndef TREMIE_CONTACT_FACET_PATCH_H
#define TREMIE_CONTACT_FACET_PATCH_H

#include <stdbool.h>

#include "base/exact_sum.h"
#include "contact/facet_contact.h"
#include "model/body.h"

/* What a corner of the mesh has of a contact. */
struct facet_patch_corner {
    int corner;
    double weight;      /* its part of the area; their sum is 1 */
    struct vec3 pushed; /* area times normal, outwards [m2] */
};

/* On a smooth part of the surface. */
struct facet_patch_part {
    int smooth;         /* as in body_skin.smooth */
    int entry;          /* of the group: holds the memory */
    double area;        /* covered [m2] */
    struct vec3 facing; /* sum of areas times normals, outwards [m2] */
    int begin, end;     /* corners */
};

/* What the search finds; kept between searches so that it does not allocate. */
struct facet_patch {
    double depth;   /* as in a half-space that takes the same volume of the ball [m] */
    double through; /* how far it is in where it comes out of the body's other side: below the
                       face that holds its foot; 0: it does not come out [m] */
    bool is_circle; /* within one triangle: what a kernel is for (facet_kernel.h) */
    int n_parts, part_capacity, n_corners, corner_capacity, n_ended, ended_capacity;
    struct facet_patch_part *parts;
    struct facet_patch_corner *corners;
    int *ended; /* entries that hold memory of a part that is not covered any more */
    int n_cuts, cut_capacity, slot_capacity;
    struct facet_patch_cut *cuts; /* face by face */
    int *slots; /* of each corner of the mesh: its place among those of a part; else -1 */
};

void facet_patch_clear(struct facet_patch *patch);
/* Searches a group, the entries of a sphere with one body, of which n are near: near[] ascends
 * and holds every face that is covered and every entry with history.  Hands history over.
 * Local. */
void facet_patch_search(struct facet_patch *patch, struct facet_contact *group, const int *near,
                        int n, const struct body *body, struct vec3 centre, double radius);
/* How far a ball is in before a face that holds its foot; 0: it does not, or is behind [m]. */
double facet_patch_reach(const struct mesh *mesh, int face, struct vec3 centre, double radius);
/* One part that is a whole face, its corners with equal weights. */
void facet_patch_whole(struct facet_patch *patch, const struct body *body, int face);

#endif
