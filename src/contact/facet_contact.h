/*
 * Contacts between spheres and the features (faces, edges, vertices) of bodies, with history;
 * of bodies that deform, which are met by faces alone, see facet_patch.h.
 *
 * Global search gives, for each owned sphere, the features of each body within the sphere's
 * radius and allowance (and the body's own allowance). Local search computes, each step, the
 * closest point of each such feature *in its own region*: a face holds what projects into it,
 * an edge what projects onto it and lies outside its adjoining faces' prisms, a vertex the
 * rest. So a sphere has one contact on a convex edge, one a wall in a concave corner. Contacts
 * of one sphere with one body whose normals differ by less than 15 degrees or whose patches
 * overlap are one contact (THEORY.md 2.2). A contact whose point lies on or behind the tangent
 * plane of a deeper one is none: it is the edge of a neighbour in the same plane, or the far
 * side of a thin body. History belongs to (sphere, body, feature); a feature that becomes
 * active takes over the history of the feature of the same sphere and body that was active the
 * step before, is not any more, and is the same contact (rotated with the normal), so nothing
 * jumps when a sphere rolls over a seam.
 *
 * All of this follows from the touching contacts' history and from where things are, never from
 * what else is listed: lists made at other moments give the same bits.
 *
 * Contributions are added to the sphere's force row in order of (sphere, body, feature), before
 * all pairs. Force, torque and work on a body are exact sums.
 */
#ifndef TREMIE_CONTACT_FACET_CONTACT_H
#define TREMIE_CONTACT_FACET_CONTACT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/exact_sum.h"
#include "base/isa.h"
#include "base/vec3.h"
#include "contact/contact_set.h"

struct spheres;
struct bodies;
struct materials;

struct facet_contact {
    double history[CONTACT_LANES];
    double overlap; /* of the last facet_step_apply(), for its energy; not state [m] */
    int sphere;     /* storage index of an owned sphere */
    int body;
    int feature; /* see model/mesh.h */
};

/* Did the two touch in the last step?  Then it remembers. */
static inline bool facet_contact_touched(const struct facet_contact *contact)
{
    return contact->history[CONTACT_RADIUS_LANE] > 0.0;
}

/* By id: what migrates, is saved and compared (only touching ones). */
struct facet_contact_record {
    int64_t id;
    int32_t body, feature;
    double history[CONTACT_LANES];
};

/* What each body felt, summed over steps since the last sample; exact, so ranks' shares add
 * up. */
struct body_load {
    struct exact_sum force[3];  /* [N], summed over steps */
    struct exact_sum torque[3]; /* about the origin [N m], summed over steps */
    struct exact_sum work;      /* of the body's motion on spheres [J], since step 0 */
    struct exact_sum wound;     /* work that its contacts' springs took up [J], since step 0 */
};

struct facet_contacts {
    /* Set after facet_contacts_init() where what touches is not spheres alone: */
    const double
        *width; /* of each sphere's contacts, over what the law takes them for; NULL: 1 */
    bool (*meets)(const void *from, int sphere, int body, int feature); /* NULL: all with all */
    const void *from;
    /* What spheres have moved since some time: none farther, between two moments, than what
     * this grew times its allowance.  Negative: nobody says. */
    double moved;
    int n, capacity;
    struct facet_contact *list; /* sorted by (sphere's canonical order, body, feature) */
    struct body_load *loads;    /* one a body */
    int n_bodies;
    double overlap_max;      /* largest overlap/radius of the last step */
    double through_max;      /* of those that come out of a thin body's other side, likewise */
    struct facet_work *work; /* search trees and scratch: facet_work.h */
};

void facet_contacts_init(struct facet_contacts *facets, int n_bodies, enum isa isa);
void facet_contacts_clear(struct facet_contacts *facets);

/* Global search: lists the features near each owned sphere (storage order is canonical order),
 * within radius + spheres->allowance + body_allowance[body]; all_pairs lists all. Touching
 * contacts of the old list stay, with their history, for the same storage index. Local. */
void facet_contacts_search(struct facet_contacts *facets, const struct spheres *spheres,
                           const struct bodies *bodies, const double *body_allowance,
                           bool all_pairs);

/* Does a ball there meet the surface of a body, as bodies are now?  After
 * facet_contacts_refit() of this step. Local. */
bool facet_contacts_meet(const struct facet_contacts *facets, const struct bodies *bodies,
                         struct vec3 centre, double radius);
/* Brings the search trees to where the bodies are. Local. */
void facet_contacts_refit(struct facet_contacts *facets, const struct bodies *bodies);

/* Records of touching contacts of spheres whose id lies in begin .. end - 1; *records is
 * resized (free it); returns their number. Local. */
int facet_contacts_records(const struct facet_contacts *facets, const struct spheres *spheres,
                           int64_t begin, int64_t end, struct facet_contact_record **records);
/* Their number, of all spheres. Local. */
int facet_contacts_count(const struct facet_contacts *facets);
/* Empties the list, before spheres move in memory: what is to be kept is kept as records.
 * Local. */
void facet_contacts_forget(struct facet_contacts *facets);
/* Puts history into the list, which may be empty yet and then grows; sphere_of_record gives the
 * storage index of record k's sphere (-1: not owned here, left out). Local. */
void facet_contacts_restore(struct facet_contacts *facets, int n,
                            const struct facet_contact_record *records,
                            const int *sphere_of_record);

/* Energy that contacts with bodies that exist no more held across them, before
 * facet_step_apply() ends these; added to `sum`. Local. */
void facet_contacts_held(const struct facet_contacts *facets, const struct spheres *spheres,
                         const struct bodies *bodies, const struct materials *materials,
                         double dt, struct exact_sum *sum);

/* How far the sphere of an entry is in the entry's body, one that deforms, below any face that
 * holds its foot [m].  Local. */
double facet_contacts_reach(const struct facet_contacts *facets, const struct spheres *spheres,
                            const struct bodies *bodies, int entry);

/* Elastic energy stored in facet contacts (each once, by the sphere's owner), as of the last
 * facet_step_apply(): that of normal springs is added to `normal`, that of springs with a
 * memory to `springs`. Local. */
void facet_contacts_elastic_energy(const struct facet_contacts *facets,
                                   const struct spheres *spheres, const struct bodies *bodies,
                                   const struct materials *materials, struct exact_sum *normal,
                                   struct exact_sum *springs);

#endif
