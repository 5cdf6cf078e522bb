/*
 * Local search among the features of one body near one sphere: which contacts act in this step.
 *
 * First every listed feature says whether it touches, then it is decided which of those stand:
 * the deepest first, and it silences all that are the same contact. What a feature remembers
 * that stands no more passes to the one that begins to stand with nearly the same normal. Only
 * the history of contacts and the geometry enter, so besides what touches the list may hold
 * anything.
 */
#ifndef TREMIE_CONTACT_FACET_LOCAL_H
#define TREMIE_CONTACT_FACET_LOCAL_H

#include <stdbool.h>

#include "contact/facet_contact.h"
#include "model/mesh.h"
#include "physics/contact_geometry.h"

/* A feature that touches. */
struct facet_local_touch {
    int entry; /* within the group */
    bool settled, stands;
    double claim; /* its overlap, more if it stood before [m] */
    struct contact_geometry at;
};

/* What the search finds; kept between searches so that it does not allocate. */
struct facet_local {
    int n_touches, n_ended, capacity;
    struct facet_local_touch *touches; /* ascending; those that stand are the contacts */
    int *ended; /* entries that hold history, do not stand and have no heir */
};

void facet_local_clear(struct facet_local *local);
/* Searches a group: the n entries of a sphere with one body. Their history is handed over,
 * nothing else is changed. Local. */
void facet_local_search(struct facet_local *local, struct facet_contact *group, int n,
                        const struct mesh *mesh, struct vec3 centre, double radius);

#endif
