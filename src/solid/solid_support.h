/*
 * What holds nodes: directions in which they do not move, or move as prescribed; axes about
 * which those of shells do not turn, or turn as prescribed.
 *
 * A prescribed place is a function of step x dt, never a sum over steps; the velocity at the
 * half step is the one that leads there.
 */
#ifndef TREMIE_SOLID_SOLID_SUPPORT_H
#define TREMIE_SOLID_SOLID_SUPPORT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/exact_sum.h"
#include "base/vec3.h"
#include "solid/solid_table.h"

struct job_motion;
struct motion_place;

enum solid_support_kind {
    SOLID_SUPPORT_FIXED,
    SOLID_SUPPORT_DISPLACEMENT, /* since step 0, from a table [m] */
    SOLID_SUPPORT_VELOCITY,     /* from a table [m/s] */
    SOLID_SUPPORT_MOTION,       /* whole nodes follow motions, in the order in which they act */
};

struct solid_support {
    enum solid_support_kind kind;
    int direction; /* 0 to 2; of motions, which take all, 0 */
    bool turns;    /* holds turning about that axis, not motion along it */
    struct solid_table table;
    int n_motions;
    const struct job_motion *motions; /* of the caller, who keeps them */
    /* At the step that solid_supports_set() was given: */
    double shift;                /* [m] */
    struct motion_place *places; /* of each motion */
    /* What it has done so far; shares of this rank, its user may set them back. */
    struct exact_sum force[3]; /* on nodes, summed over steps [N] */
    struct exact_sum work;     /* up to the middle of the last move [J] */
    struct vec3 spin; /* that led there from the step before; of others than motions the same
                         about each axis [rad/s] */
};

struct solid_supports {
    int n, capacity;
    struct solid_support *list;
    int n_nodes;
    int (*of_node)[3];      /* support of each direction; -1: none */
    int (*turn_of_node)[3]; /* of turning about each axis; NULL: no node turns */
};

/* Does it push nodes along a direction? */
static inline bool solid_support_pushes(const struct solid_support *support, int direction)
{
    return support->kind == SOLID_SUPPORT_MOTION ||
           (direction == support->direction && !support->turns);
}

/* Of a node's entries in `of_node` or `turn_of_node`: is it held in some direction? */
static inline bool solid_supports_hold(const int held[3])
{
    return (held[0] & held[1] & held[2]) >= 0; /* -1: not held */
}

void solid_supports_init(struct solid_supports *supports, int n_nodes);
void solid_supports_clear(struct solid_supports *supports);

/* Holds nodes in a direction (0 to 2).  The table is copied; with SOLID_SUPPORT_FIXED none is
 * needed.  A later support of the same node and direction takes the place of an earlier one. */
void solid_supports_add(struct solid_supports *supports, enum solid_support_kind kind,
                        int direction, const struct solid_table *table, int n_nodes,
                        const int *nodes);
/* Makes nodes follow prescribed motions. */
void solid_supports_add_motion(struct solid_supports *supports, int n_motions,
                               const struct job_motion *motions, int n_nodes, const int *nodes);

/* From now on nodes have turning to be held. */
void solid_supports_init_turns(struct solid_supports *supports);
/* Holds nodes' turning about an axis of space (0 to 2): tables are of angles [rad] or of
 * angular velocities [rad/s].  Nodes that follow motions turn with them. */
void solid_supports_add_turn(struct solid_supports *supports, enum solid_support_kind kind,
                             int direction, const struct solid_table *table, int n_nodes,
                             const int *nodes);

/* Brings all supports to a step. */
void solid_supports_set(struct solid_supports *supports, int64_t step, double dt);
/* Where that puts a node, in the directions in which it is held; others are left. */
void solid_supports_place(const struct solid_supports *supports, int node,
                          const double reference[3], double place[3]);
/* Books a step's force on a node that moves at v. */
void solid_supports_book(struct solid_supports *supports, int node, const double force[3],
                         const double v[3], double dt);
/* Books a step's work of a moment on a node that turns at w. */
void solid_supports_book_turn(struct solid_supports *supports, int node, const double moment[3],
                              const double w[3], double dt);
/* How fast a node turns on its way there, where its turning is held; others are left.
 * (13.17) */
void solid_supports_spin(const struct solid_supports *supports, int node, double spin[3]);

#endif
