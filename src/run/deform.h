/*
 * Bodies that deform: solids of finite elements (solid/solid.h) in the step.
 *
 * Every rank holds all of them, and moves its own share of their nodes: slabs across the
 * longest side of the body at the start, with as many nodes each.  After each move ranks tell
 * each other where theirs are; what contacts do to a node goes, as exact sums, to the rank
 * that moves it. So elements are shared out evenly whatever the spheres do, at the price of
 * memory for all of the nodes, and of one exchange of them a step, on every rank.
 *
 * A body's surface is the skin that contacts push (model/body.h): its vertices are nodes.
 */
#ifndef TREMIE_RUN_DEFORM_H
#define TREMIE_RUN_DEFORM_H

#include <stdbool.h>
#include <stdint.h>

#include "base/comm.h"
#include "solid/solid.h"
#include "solid/solid_energy.h"

struct checkpoint_more;
struct simulation;

struct deform_body {
    int body; /* among the simulation's */
    struct solid solid;
    int *nodes;                      /* of each corner of the skin */
    int *owner;                      /* rank that moves each node */
    int *by_owner;                   /* nodes, those of rank 0 first */
    int first_own;                   /* in by_owner: where this rank's begin */
    int *sizes;                      /* of each rank's nodes, as told [bytes] */
    struct solid_element_node *told; /* all nodes by owner, on their way; of several ranks */
    struct comm_mail mail;
    int64_t first_node, first_element; /* their ids, counted over all solids */
};

struct deform {
    int n;
    struct deform_body *list;
    int64_t n_nodes, n_elements; /* of all */
    bool failed;                 /* some element here has, in this step */
    bool hourglass;              /* some solid has too much energy in hourglass modes */
};

void deform_init(struct deform *deform, const struct simulation *sim, enum isa isa);
void deform_clear(struct deform *deform);

/* Puts the skins where the nodes are, with their velocities, before contacts.  Local. */
void deform_begin(struct simulation *sim);
/* Takes the contacts' forces and finds the elements'.  Collective. */
void deform_plan(struct simulation *sim);
/* Moves all nodes.  Collective. */
void deform_move(struct simulation *sim);

/* Totals over all solids and ranks, between deform_plan() and deform_move(); notes whether some
 * solid has too much in hourglass modes.  Collective. */
void deform_energies(struct simulation *sim, struct solid_energies *energies);
/* The critical step of the elements as they are, without contacts; *body is whose.  Infinite
 * without any.  Collective. */
double deform_critical_step(const struct simulation *sim, int *body);

/* Tables of nodes and elements for checkpoints: two, none without solids. */
int deform_tables(const struct simulation *sim, struct checkpoint_more *tables);
/* Takes them over as read. */
void deform_restore(struct simulation *sim, const struct checkpoint_more *tables);

#endif
