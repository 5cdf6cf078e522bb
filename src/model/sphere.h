/*
 * Rigid spheres on one rank: those it owns first, then ghosts, each part in canonical order.
 *
 * Hot data lie in rows of 64 bytes, one cache line, that pair kernels load whole:
 *   motion {x y z R | vx vy vz R}    position at step n, velocity at n - 1/2
 *   spin   {R wx R wy R wz 1/R | wx wy wz 1/m}   angular velocity at n - 1/2
 *   force  {fx fy fz friction | tx ty tz damping}
 * (R stands twice so that the difference of two motion rows holds R_j - R_i; the products in
 * `spin` are derived.)  The spare force lanes gather half of the energy that each contact
 * dissipates in this step by friction and by damping [J].  Two dummies follow the last sphere,
 * far away, as partners of padding.
 *
 * Canonical order is ascending (order_cell, id): see model/order.h.
 */
#ifndef TREMIE_MODEL_SPHERE_H
#define TREMIE_MODEL_SPHERE_H

#include <stdint.h>

#include "base/field.h"
#include "base/vec3.h"
#include "model/periodic.h"

struct materials;

struct sphere_row {
    double lane[8];
} __attribute__((aligned(64)));

enum { SPHERE_N_FIELDS = 12, SPHERE_DUMMIES = 2 };

/* State, in the order of sphere_fields[]. */
enum sphere_field {
    SPHERE_ID,
    SPHERE_ORDER_CELL,
    SPHERE_POSITION,
    SPHERE_VELOCITY,
    SPHERE_ANGULAR_VELOCITY,
    SPHERE_RADIUS,
    SPHERE_MATERIAL,
    SPHERE_GROUP,
    SPHERE_SIDES,
    SPHERE_DISSIPATED_FRICTION,
    SPHERE_DISSIPATED_DAMPING,
    SPHERE_CAUGHT,
};

struct spheres {
    int n_owned, n_all; /* owned; owned and ghosts */
    int capacity;
    struct periodic periodic;                 /* the space that they are in */
    struct sphere_row *motion, *spin, *force; /* n_all + SPHERE_DUMMIES used */
    int64_t *id;                              /* global, never reused */
    int64_t *order_cell; /* cell of the order grid at birth or at the last renewal */
    int32_t *material;
    int32_t *group;
    int64_t *sides;              /* bit s: on the forward side of section s */
    double *dissipated_friction; /* [J] since birth */
    double *dissipated_damping;  /* [J] */
    int32_t *caught; /* 1 + the removal that is to take it out; 0: none (run/removal) */
    /* Not state: bookkeeping of searches. */
    double *allowance;              /* how far this sphere may go before a search is due [m] */
    double (*inverse_allowance)[2]; /* of candidates and of the inner list [1/m] */
    double (*searched_at)[3];       /* position at the last search [m] */
};

extern const struct field sphere_fields[SPHERE_N_FIELDS];

void spheres_init(struct spheres *spheres);
void spheres_clear(struct spheres *spheres);
/* Room for n spheres (and the dummies); contents kept. */
void spheres_reserve(struct spheres *spheres, int n);
/* Gives back room that is not needed, but for a few more; contents kept. */
void spheres_fit(struct spheres *spheres);
/* Where a field of the table lies. */
struct field_view sphere_view(const struct spheres *spheres, int field);
/* Fills what is derived from the fields of sphere i: row products, 1/m from density and
 * radius. */
void sphere_complete(struct spheres *spheres, int i, const struct materials *materials);
/* Writes the dummies behind the last sphere. */
void spheres_pad(struct spheres *spheres);

/* Where the centre is in memory: between searches perhaps beyond a periodic boundary, a ghost a
 * period away from its owner.  Differences are what they are everywhere [m]. */
static inline double *sphere_position(const struct spheres *spheres, int i)
{
    return spheres->motion[i].lane;
}
/* Where it is in the domain: all that depends on places, not on their differences. [m] */
static inline struct vec3 sphere_place(const struct spheres *spheres, int i)
{
    return periodic_place(&spheres->periodic, spheres->motion[i].lane);
}
static inline double sphere_radius(const struct spheres *spheres, int i)
{
    return spheres->motion[i].lane[3];
}
/* Radius and allowance: how far from its place a sphere may touch something before the next
 * search [m]. */
static inline double sphere_reach(const struct spheres *spheres, int i)
{
    return sphere_radius(spheres, i) + spheres->allowance[i];
}
static inline double *sphere_velocity(const struct spheres *spheres, int i)
{
    return spheres->motion[i].lane + 4;
}
static inline double *sphere_angular_velocity(const struct spheres *spheres, int i)
{
    return spheres->spin[i].lane + 4;
}
/* 1/R [1/m]. */
static inline double sphere_curvature(const struct spheres *spheres, int i)
{
    return spheres->spin[i].lane[3];
}
static inline double sphere_inverse_mass(const struct spheres *spheres, int i)
{
    return spheres->spin[i].lane[7];
}

#endif
