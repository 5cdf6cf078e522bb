/*
 * Rigid bodies that forces move: along or about one axis (driven), or freely (THEORY.md,
 * section 10).  Central differences with velocities at half steps, as the spheres'; rotation is
 * a unit quaternion that + - * / and sqrt advance.
 *
 * A step has two halves: rigid_plan() takes the force and finds where the body will be, and
 * what energies it has now; rigid_move() goes there.  Ranks that are given the same force do
 * the same.  Bodies do not feel each other.  All functions are local.
 */
#ifndef TREMIE_MODEL_RIGID_H
#define TREMIE_MODEL_RIGID_H

#include <stdbool.h>

#include "base/vec3.h"

struct job_body;
struct mesh;

enum rigid_kind { RIGID_SLIDE, RIGID_TURN, RIGID_FREE };

/* All that the next step needs, doubles alone. */
struct rigid_state {
    double way, speed;     /* driven: at the step [m] or [rad], half a step before */
    struct vec3 centre;    /* free, as all that follows up to spin [m] */
    double turn[4];        /* orientation: unit quaternion, scalar first */
    struct vec3 velocity;  /* half a step before [m/s] */
    struct vec3 momentum;  /* angular, about the centre, half a step before [kg m2/s] */
    struct vec3 spin;      /* half a step before [rad/s] */
    double work;           /* of applied forces, and of gravity that changes [J] */
    double damped, rubbed; /* taken by damping; by friction and stops [J] */
};

enum { RIGID_STATE_SIZE = sizeof(struct rigid_state) / sizeof(double) };

struct rigid_energies {
    double kinetic_translation, kinetic_rotation, potential; /* at the step [J] */
    double work, damped, rubbed;                             /* done by then [J] */
};

struct rigid {
    enum rigid_kind kind;
    struct vec3 axis, point;  /* driven */
    double mass, inertia;     /* [kg], about the axis [kg m2] */
    double load;              /* applied [N] or [N m] */
    double damping, friction; /* [1/s], [N] or [N m] */
    bool limited;
    double limits[2];   /* [m] or [rad] */
    double start;       /* [s] */
    struct vec3 centre; /* of mass, at the start [m] */
    double tensor[6],
        inverse[6];     /* of inertia, as the body was at the start: xx yy zz xy xz yz */
    double arm;         /* of the farthest vertex from centre or axis [m] */
    double frame[3][3]; /* rotation since the start */
    struct rigid_state state, next;
    struct rigid_energies energies;
};

/* How a forced body is at the start; mass from its surface where the job says so.  The surface
 * must then be closed: rigid_fault() says what is wrong with it (NULL: nothing). */
void rigid_build(struct rigid *rigid, const struct job_body *asked, const struct mesh *mesh);
const char *rigid_fault(const struct job_body *asked, const struct mesh *mesh);

/* Makes what follows from the state anew, after it was read or moved. */
void rigid_refresh(struct rigid *rigid);
struct vec3 rigid_place(const struct rigid *rigid, struct vec3 reference);
/* The point pivot moves at velocity, everything turns about it at spin, half a step before. */
void rigid_motion(const struct rigid *rigid, struct vec3 *pivot, struct vec3 *velocity,
                  struct vec3 *spin);
/* No vertex is faster [m/s]. */
double rigid_speed(const struct rigid *rigid);
/* How easily the body yields to a force along a unit vector at a point: 1 over its effective
 * mass [1/kg]. (10.7) */
double rigid_yield(const struct rigid *rigid, struct vec3 point, struct vec3 along);
/* The most in any direction. */
double rigid_yield_most(const struct rigid *rigid, struct vec3 point);

struct rigid_load {
    struct vec3 force;          /* on the body [N] */
    struct vec3 torque;         /* about the origin [N m] */
    struct vec3 gravity;        /* now [m/s2] */
    struct vec3 gravity_change; /* since the step before [m/s2] */
};
void rigid_plan(struct rigid *rigid, const struct rigid_load *load, double time, double dt);
void rigid_move(struct rigid *rigid);

#endif
