/*
 * Bodies that deform and touch bodies: nodes of their skins against faces of others, of rigid
 * bodies' surfaces, and of themselves.
 *
 * Each such node has a ball below the surface (model/solid_ball.h), which meets other bodies as
 * a sphere does, by a linear spring as stiff as what the node is made of (THEORY.md 12.8), with
 * friction, a dashpot and a memory. What it feels goes to the two nodes between which it is.
 * Where both bodies' nodes touch, both do.
 *
 * A ball belongs to the rank that moves its node.  Contacts with its own body leave out the
 * faces that were near at the start.
 */
#ifndef TREMIE_RUN_TOUCH_H
#define TREMIE_RUN_TOUCH_H

#include <stdbool.h>
#include <stdint.h>

#include "base/isa.h"
#include "contact/facet_contact.h"
#include "model/material.h"
#include "model/sphere.h"

struct checkpoint_more;
struct exact_sum;
struct simulation;

/* Room that a rank's balls may take before the next search [m]. */
struct touch_extent {
    double low[3], high[3];
};

struct touch {
    int n_balls; /* of all bodies: ids are below */
    int *owned;  /* ball of each sphere here; ascending */
    int *place;  /* sphere of each ball; -1: not here */
    double *width;
    double buffer; /* half of the balls' mean radius; infinite without balls [m] */
    struct spheres spheres;
    struct facet_contacts contacts;
    struct materials materials;   /* springs of balls of one material on bodies of another */
    struct touch_extent *extents; /* one a rank */
    int64_t n_changes;            /* of who moves what, when balls were last listed */
    int n_waiting;                /* contacts from a file that are in no list yet */
    struct facet_contact_record *waiting;
};

/* After deform_init(). */
void touch_init(struct touch *touch, const struct simulation *sim, enum isa isa);
void touch_clear(struct touch *touch);

/* Where balls will be by the next search, of all ranks, by who will move their nodes.
 * Collective. */
void touch_find_extents(struct simulation *sim);
/* May a rank's balls come into a box? */
bool touch_reaches(const struct touch *touch, int rank, const double low[3],
                   const double high[3]);
/* Lists the balls whose nodes are moved here and what they may touch. Collective. */
void touch_search(struct simulation *sim, bool all_pairs);
/* Puts balls where their nodes are, without forces.  Local. */
void touch_begin(struct simulation *sim);
/* Adds what balls do to all bodies.  Local. */
void touch_apply(struct simulation *sim);
/* How many contacts touch.  Local. */
int touch_count(const struct touch *touch);
/* Books what contacts have lost in the step.  Local. */
void touch_end(struct simulation *sim);

/* Adds what present contacts do to bodies that forces move: stiffness [1/s2] and damping [1/s]
 * over how such a body yields, two sums a body.  Local. */
void touch_load_bodies(const struct touch *touch, const struct bodies *bodies,
                       struct exact_sum *sums);

/* What springs hold, as facet_contacts_elastic_energy(); and what the step loses, half of it
 * by now where it is by dashpots. Local. */
void touch_energies(const struct simulation *sim, struct exact_sum *normal,
                    struct exact_sum *springs, struct exact_sum *friction,
                    struct exact_sum *damping);

/* The table of contacts for checkpoints: one, or none. */
int touch_table(const struct simulation *sim, struct checkpoint_more *table);
/* Are these contacts of the job's balls and bodies? */
bool touch_fits(const struct simulation *sim, const struct checkpoint_more *table);
/* Takes them over. */
void touch_restore(struct simulation *sim, struct checkpoint_more *table);

#endif
