/*
 * Rigid bodies: surfaces that are at rest, move as prescribed (model/motion) or are moved by
 * forces (model/rigid), and may come and go.
 *
 * Prescribed motion is a function of step x dt alone (never accumulated), so a restart finds
 * the same bits.  The sine and cosine are our own (base/elementary.h).
 */
#ifndef TREMIE_MODEL_BODY_H
#define TREMIE_MODEL_BODY_H

#include <stdbool.h>
#include <stdint.h>

#include "base/exact_vector.h"
#include "base/vec3.h"
#include "model/mesh.h"

struct job;
struct job_motion;
struct rigid;

/* The surface of a body that deforms: how it moves and what pushes it, at each corner of the
 * mesh (vertices below n_corners; behind them run/deform may push nodes below the surface), and
 * what of it was smooth at the start. */
struct body_skin {
    struct vec3 *velocity;      /* half a step before [m/s] */
    double *inverse_mass;       /* [1/kg] */
    struct exact_vector *force; /* of this step's contacts: body_skin_push() [N] */
    bool *pushed;               /* by some of them; forces of others are zero */
    int *smooth; /* of each face: the first one of those that it goes on to without an edge */
    /* Faces are brought to where their corners are when they are asked for. */
    int now, *since; /* counts changes of places; of each face: at which it was brought there */
};

/* Of a surface at rest, as if it could not yield. */
struct body_skin *body_skin_build(const struct mesh *mesh);
/* Force on a point of the skin, to be added to. */
static inline struct exact_vector *body_skin_push(const struct body_skin *skin, int point)
{
    skin->pushed[point] = true;
    return &skin->force[point];
}
void body_skin_free(struct body_skin *skin);

struct body {
    char *name;
    int material;
    struct mesh mesh;
    bool moves;
    /* Prescribed, in the order in which they act; of a body that deforms those of the first of
     * its sets that follows some, which its frame goes by. */
    int n_motions;
    struct job_motion *motions;
    struct rigid *rigid;    /* of a body that forces move, else NULL */
    struct body_skin *skin; /* of a body that deforms, else NULL */
    /* Present motion, set by bodies_place(): the point x of the body moves at
     * velocity_now + spin_now x (x - pivot_now). */
    struct vec3 velocity_now; /* [m/s] */
    struct vec3 spin_now;     /* [rad/s] */
    struct vec3 pivot_now;    /* [m] */
    /* A surface that runs while the body stays: at the point x of it with the normal n it has
     * what is tangential of surface_velocity + surface_spin x (x - surface_pivot) besides. */
    struct job_motion *surface;   /* NULL: it does not */
    bool surface_runs;            /* at this step */
    struct vec3 surface_velocity; /* [m/s] */
    struct vec3 surface_spin;     /* [rad/s] */
    struct vec3 surface_pivot;    /* [m] */
    double surface_speed_max;     /* a bound over all time [m/s] */
    bool exists;                  /* at this step; one that does not touches nothing */
    bool comes_and_goes;          /* does that ever change? */
    double active[2];             /* then: when it comes and goes [s] */
    double placed_at;             /* time at which the vertices are where they are [s] */
    double speed_max; /* fastest vertex, for allowances: over all time, or of a body that forces
                       * move at present [m/s] */
};

/* Brings a face of a skin to where its corners are, before it is looked at; those of other
 * bodies are there. */
void body_renew_face(const struct body *body, int face);
/* Brings the mean point of a quad, if the face of a skin has one for its third corner, to where
 * the quad is. */
static inline void body_renew_mean(const struct body *body, int face)
{
    const struct mesh *mesh = &body->mesh;
    const int v = mesh->faces[face].vertices[2];
    struct vec3 mean = {0.0, 0.0, 0.0};
    if (v < mesh->n_corners)
        return;
    for (int c = 0; c < 4; c++)
        mean = vec3_axpy(mean, 0.25, mesh->place[mesh->mean_of[v - mesh->n_corners][c]]);
    mesh->place[v] = mean;
}

struct bodies {
    int n;
    struct body *list;
    int n_forced; /* bodies that forces move */
};

void bodies_build(struct bodies *bodies, const struct job *job);
void bodies_clear(struct bodies *bodies);
/* Puts all moving bodies where they are at time step * dt, with the velocity they have at
 * (step - 1/2) * dt as the spheres' half-step velocities have; those that forces move are where
 * their state says, those that deform are not placed here.  Bodies at rest cost nothing. */
void bodies_place(struct bodies *bodies, int64_t step, double dt);
/* Velocity of the body at a point. */
struct vec3 body_drift(const struct body *body, struct vec3 point);
/* Velocity of the surface at a point with a normal of length 1: that of the body, and what
 * the surface runs. */
struct vec3 body_velocity(const struct body *body, struct vec3 point, struct vec3 normal);
/* Angular velocity of the surface. */
struct vec3 body_spin(const struct body *body);
/* Where the body has come to: the point x of space moves with it as if it were a part of it. */
struct body_frame {
    struct vec3 origin;  /* where what was at the origin at time 0 is now [m] */
    struct vec3 axes[3]; /* what pointed along x, y, z, of length 1 */
};
/* That of a rigid body at a time, of one that forces move now. */
struct body_frame body_frame(const struct body *body, double time);
/* Where what is at x now was at time 0. */
struct vec3 body_frame_reference(const struct body_frame *frame, struct vec3 x);
/* Is the body there at a step? */
bool body_exists(const struct body *body, int64_t step, double dt);

#endif
