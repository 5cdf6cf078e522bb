/*
 * Bodies that deform: solids, shells and membranes of finite elements (solid/solid.h) in the
 * step.
 *
 * Their nodes belong to subdomains, as spheres do (deform_share.h).  A body's surface is the
 * skin that contacts push (deform_skin.h, model/body.h): its vertices are nodes.
 */
#ifndef TREMIE_RUN_DEFORM_H
#define TREMIE_RUN_DEFORM_H

#include <stdbool.h>
#include <stdint.h>

#include "base/comm.h"
#include "run/deform_share.h"
#include "run/deform_skin.h"
#include "solid/solid.h"
#include "solid/solid_energy.h"

struct simulation;

struct deform_body {
    int body; /* among the simulation's */
    struct solid solid;
    struct deform_share share;
    struct deform_skin skin;
    double speed; /* of the fastest vertex here in each substep so far of the step, added up */
    int64_t first_node, first_element; /* their ids, counted over all solids */
    /* Where its nodes touch bodies (run/touch.h), one a corner of the mesh, else none: */
    int n_balls, first_ball; /* counted likewise */
    struct solid_ball *balls;
    int *inner; /* SOLID_BALL_INNER of each: its inner nodes among the skin's points */
};

struct deform {
    int n;
    struct deform_body *list;
    int64_t n_nodes, n_elements; /* of all */
    int n_balls;
    bool sheets, turns; /* has some body shells or membranes; does some node turn? */
    bool failed;        /* some element here has, in this step */
    bool hourglass;     /* some solid has too much energy in hourglass modes */
    int substeps;       /* that elements take in a step */
    double spent;       /* share of their allowances that surfaces have used in the last step */
    int n_near,
        *near; /* ranks with copies of nodes moved here, or whose nodes have copies here */
    int n_pushing, *pushing; /* those of which some node may be touched on the other */
    struct comm_mail mail;
};

/* The elements' own step and how many of them there were when one of the run's begins. */
static inline double deform_dt(const struct deform *deform, double dt)
{
    return dt / deform->substeps;
}
static inline int64_t deform_step(const struct deform *deform, int64_t step)
{
    return step * deform->substeps;
}

void deform_init(struct deform *deform, const struct simulation *sim, enum isa isa);
void deform_clear(struct deform *deform, const struct comm *comm);

/* Puts the skins where the nodes are, with their velocities.  Local. */
void deform_place(struct simulation *sim);
/* Puts all faces of skins where their corners are, before a search.  Local. */
void deform_place_faces(const struct simulation *sim);
/* Tells how fast skins are on any rank, for allowances.  Collective. */
void deform_agree(struct simulation *sim);
/* Takes the contacts' forces and finds the elements'.  Collective. */
void deform_plan(struct simulation *sim);
/* Moves all nodes and skins, and finds how much of the allowances that uses here.
 * Collective. */
void deform_move(struct simulation *sim);

/* What this rank has of all solids. */
struct deform_sizes {
    int64_t n_nodes;    /* moved here */
    int64_t n_copies;   /* of nodes that others move */
    int64_t n_elements; /* computed here */
};
struct deform_sizes deform_sizes(const struct deform *deform);
/* Totals over all solids and ranks, between deform_plan() and deform_move(); notes whether some
 * solid has too much in hourglass modes.  Collective. */
void deform_energies(struct simulation *sim, struct solid_energies *energies);
/* What the elements as they are allow of the step, with the contacts that touch now. */
struct deform_limit {
    double step;       /* infinite without any [s] */
    int body;          /* whose; -1: none */
    int element, node; /* where it is too little for the job, who allows no more: an element and
                          its corner with contacts; -1: none, or on another rank */
};
/* Of those elements alone that have contacts, if `touched`.  Collective. */
struct deform_limit deform_critical_step(const struct simulation *sim, bool touched);
/* "node 12 of body 'bar' at (0, 0, 0) m"; nothing on ranks that do not have it. */
int deform_name_limit(const struct simulation *sim, const struct deform_limit *limit,
                      char *text, int size);

#endif
