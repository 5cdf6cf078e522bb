/*
 * Local search among the features of one body near one sphere: which contacts act in this step.
 *
 * First every listed feature says whether it touches, then it is decided which of those stand:
 * the deepest first, and it silences all that are the same contact: those with nearly the same
 * normal, those whose patch overlaps its own, and those that lie in its tangent plane or behind
 * it. A contact that stands for several such acts as deep as the deepest of them, and its
 * normal turns from one to the next while they are about as deep (THEORY.md 2.2), so no force
 * jumps at a concave seam and a sphere may come to rest in it. What a feature remembers that
 * stands no more passes to the one that stands in its stead. Only the history of contacts and
 * the geometry enter, so besides what touches the list may hold anything.
 *
 * Drawback: a fold of more than 15 degrees holds two contacts until the sphere is so deep in it
 * that patches overlap, and one afterwards: there the force falls by up to a half.
 */
#ifndef TREMIE_CONTACT_FACET_LOCAL_H
#define TREMIE_CONTACT_FACET_LOCAL_H

#include <stdbool.h>

#include "contact/facet_contact.h"
#include "model/mesh.h"
#include "model/periodic.h"
#include "physics/contact_geometry.h"

/* A feature that touches. */
struct facet_local_touch {
    int entry;     /* within the group */
    int stands_in; /* the touch that stands for this one, itself if it does; -1: undecided */
    bool one_with; /* is one contact with that, not just hidden by it */
    double claim;  /* its overlap, more if it stood before [m] */
    struct contact_geometry at;      /* where the feature is touched */
    struct contact_geometry acts_at; /* where the contact acts that stands here */
};

/* What the search finds; kept between searches so that it does not allocate. */
struct facet_local {
    int n_touches, n_ended, capacity;
    struct facet_local_touch *touches; /* ascending; see facet_local_stands() */
    int *ended; /* entries that hold history, do not stand and have no heir */
};

/* Is touch t a contact? */
static inline bool facet_local_stands(const struct facet_local *local, int t)
{
    return local->touches[t].stands_in == t;
}

void facet_local_clear(struct facet_local *local);
/* Searches a group, the entries of a sphere with one body, of which n are near: near[] ascends
 * and holds every entry that touches or has history. Their history is handed over, also
 * to where the sphere comes in again past a periodic boundary; nothing else is changed.
 * Local. */
void facet_local_search(struct facet_local *local, struct facet_contact *group, const int *near,
                        int n, const struct mesh *mesh, const struct periodic *periodic,
                        struct vec3 centre, double radius);

#endif
