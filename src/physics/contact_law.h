/*
 * What two surfaces in contact do to each other: Hertz normal to the contact with a dashpot and
 * no pull, Mindlin's no-slip stiffness along it with a memory, Coulomb's limit.  Equations in
 * src/THEORY.md, section 1; numbers in comments refer to it.
 *
 * The law is written once, in lanes (physics/lanes.h): the pair kernel takes it with as many
 * lanes as the processor has, contacts with facets take it with one, and both get the same
 * bits.  It speaks of a contact, not of what touches: normal, overlap, relative velocity of the
 * two surfaces at the contact point, effective radius and mass.  Who calls it knows lever arms
 * and applies forces.  For a facet of prescribed motion the curvature and the inverse mass are
 * those of the sphere alone.
 *
 * The normal points from the first to the second.  Relative velocity is the second's minus the
 * first's, so surfaces approach where v_n < 0.  The memory of a contact is
 *   0..2  tangential force that the second exerts on the first [N]
 *   3     contact radius of the last step [m]; > 0 exactly when they touched
 *   4     normal relative velocity of the last step [m/s]
 * and belongs to the contact: it is +0.0 throughout where surfaces do not touch.
 *
 * What is chosen, and what it costs.  Velocities are those of the half step before, so a
 * dashpot is late by half a step; the normal one is extrapolated by what is remembered in lane
 * 4, which makes it second order, the tangential one is not.  Memory as a force, scaled down
 * with the contact radius on unloading, never returns more than was put in; memory as a
 * displacement would.  It loses up to some per cent of the energy of a fully sticking oblique
 * impact; the ledger counts that.
 */
#ifndef TREMIE_PHYSICS_CONTACT_LAW_H
#define TREMIE_PHYSICS_CONTACT_LAW_H

#include "model/material.h"
#include "physics/lanes.h"

enum {
    CONTACT_LAW_FORCE = 0, /* three lanes of history */
    CONTACT_LAW_RADIUS = 3,
    CONTACT_LAW_VELOCITY = 4,
    CONTACT_LAW_HISTORY = 5,
};

/* The constants of a pair of materials, as in struct material_pair. */
struct contact_law_constants {
    lanes normal;        /* [Pa] */
    lanes tangential;    /* [Pa] */
    lanes damping;       /* [sqrt(Pa)] */
    lanes damping_ratio; /* [-] */
    lanes friction;      /* [-] */
};

/* How two surfaces meet. */
struct contact_law_meeting {
    lanes normal[3];      /* unit vector from the first to the second */
    lanes velocity[3];    /* of the second's surface less the first's, at the contact [m/s] */
    lanes overlap;        /* [m]; 0 where they do not touch, never negative */
    lanes inverse_radius; /* 1/R*: sum of the two curvatures [1/m] */
    lanes inverse_mass;   /* 1/m*: sum of the two inverse masses [1/kg] */
};

/* What comes of it.  The second feels normal * n + tangential, the first the opposite. */
struct contact_law_result {
    lanes normal;        /* [N], >= 0: surfaces push, never pull */
    lanes tangential[3]; /* on the second [N] */
    /* Energy turned to heat in the step that ends now [J]; set only with the ledger on. */
    lanes lost_friction; /* by sliding */
    lanes lost_damping;  /* by both dashpots */
    lanes lost_law;      /* tangential elastic energy dropped as the stiffness changes */
};

LANES_INLINE lanes contact_law_dot(const lanes a[3], const lanes b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Hertz and the normal dashpot, cut off where they would pull: (1.4) to (1.8). */
LANES_INLINE void contact_law_push(const struct contact_law_meeting *meeting,
                                   const struct contact_law_constants *pair, lanes radius,
                                   lanes v_n, lanes c_n, lanes dt, bool ledger, lanes *history,
                                   struct contact_law_result *result)
{
    const lanes zero = lanes_all(0.0);
    const lanes_mask touching = meeting->overlap > zero;
    const lanes_mask touched = history[CONTACT_LAW_RADIUS] > zero;
    const lanes v_old = lanes_where(touched, history[CONTACT_LAW_VELOCITY], v_n);
    const lanes v_now = v_n + 0.5 * (v_n - v_old);                    /* [m/s]      (1.7) */
    const lanes f_elastic = pair->normal * radius * meeting->overlap; /* Hertz [N]  (1.4) */
    const lanes f = f_elastic - c_n * v_now;                          /* [N]        (1.6) */

    result->normal = lanes_keep(f > zero, f);
    history[CONTACT_LAW_VELOCITY] = lanes_keep(touching, v_n);
    if (ledger)
        result->lost_damping = (f_elastic - result->normal) * v_now * dt; /* [J]      (1.17) */
}

/* Mindlin's spring and the dashpot beside it, limited by Coulomb.               (1.9) to (1.14)
 */
LANES_INLINE void contact_law_grip(const struct contact_law_meeting *meeting,
                                   const struct contact_law_constants *pair, lanes radius,
                                   const lanes v_t[3], lanes c_t, lanes dt, bool ledger,
                                   lanes *history, struct contact_law_result *result)
{
    const lanes zero = lanes_all(0.0), one = lanes_all(1.0);
    const lanes *n = meeting->normal;
    const lanes_mask touching = meeting->overlap > zero;
    const lanes radius_old = history[CONTACT_LAW_RADIUS];
    const lanes inverse_old = one / radius_old;  /* infinite where new, and then not chosen */
    const lanes k_t = pair->tangential * radius; /* [N/m]     (1.9) */
    const lanes limit = pair->friction * result->normal; /* [N]      (1.12) */

    /* The memory turns with the contact and gives way as the contact shrinks. */
    const lanes h_n = contact_law_dot(history, n);
    const lanes scale = lanes_where(radius < radius_old, radius * inverse_old, one);
    const lanes turned[3] = {history[0] - h_n * n[0], history[1] - h_n * n[1],
                             history[2] - h_n * n[2]}; /* [N]      (1.10) */
    const lanes stretch = k_t * dt;
    lanes kept[3], h[3];
    for (int x = 0; x < 3; x++) {
        kept[x] = scale * turned[x];
        h[x] = lanes_keep(touching, kept[x] + stretch * v_t[x]); /* [N]      (1.11) */
    }

    /* Coulomb: the spring keeps no more than friction can hold, and what slides has no dashpot.
     * Without a sliding lane nothing would change, so skipping it changes no bit.       (1.12)
     */
    const lanes h_squared = contact_law_dot(h, h);
    const lanes_mask sliding = h_squared > limit * limit;
    if (ledger)
        result->lost_friction = zero;
    if (lanes_any(sliding)) {
        const lanes ratio = lanes_where(sliding, limit / lanes_sqrt(h_squared), one);
        c_t = lanes_where(sliding, zero, c_t);
        if (ledger) {
            const lanes both = contact_law_dot(kept, h) + ratio * h_squared;
            result->lost_friction =
                lanes_keep(sliding, 0.5 * both * (one - ratio) / k_t); /* [J]      (1.16) */
        }
        for (int x = 0; x < 3; x++)
            h[x] *= ratio;
    }
    for (int x = 0; x < 3; x++)
        result->tangential[x] = -h[x] - c_t * v_t[x]; /* [N]      (1.13) */

    if (ledger) {
        const lanes_mask touched = radius_old > zero;
        const lanes inverse_tangential = one / pair->tangential;
        const lanes t_squared = contact_law_dot(turned, turned);
        const lanes before = lanes_keep(touched, (t_squared + h_n * h_n) * inverse_old);
        const lanes after = lanes_keep(touching, scale * scale * t_squared / radius);
        const lanes dropped = (one - scale) * contact_law_dot(turned, v_t) * dt;
        result->lost_law = 0.5 * (lanes_keep(touched, inverse_tangential * (before - after)) +
                                  dropped); /* [J]      (1.18) */
        /* The dashpot's own force brings the velocity from the half step to the step. */
        const lanes half = 1.75 * meeting->inverse_mass * dt;
        const lanes power =
            contact_law_dot(v_t, v_t) + half * contact_law_dot(v_t, result->tangential);
        result->lost_damping += c_t * power * dt; /* [J]      (1.17) */
    }
    for (int x = 0; x < 3; x++)
        history[CONTACT_LAW_FORCE + x] = h[x];
    history[CONTACT_LAW_RADIUS] = radius;
}

/*
 * The law.  `history` has CONTACT_LAW_HISTORY lanes and is brought to the present.  Where
 * surfaces do not touch, forces are zero and the history becomes +0.0; with the ledger on, what
 * a contact that has just ended still held is counted as lost, so call once more after the end.
 */
LANES_INLINE void contact_law(const struct contact_law_meeting *meeting,
                              const struct contact_law_constants *pair, lanes dt, bool ledger,
                              lanes *history, struct contact_law_result *result)
{
    const lanes *n = meeting->normal;
    const lanes v_n = contact_law_dot(meeting->velocity, n); /* [m/s] */
    const lanes v_t[3] = {meeting->velocity[0] - v_n * n[0], meeting->velocity[1] - v_n * n[1],
                          meeting->velocity[2] - v_n * n[2]}; /* [m/s] */
    const lanes radius =
        lanes_sqrt(meeting->overlap / meeting->inverse_radius); /* [m]  (1.3) */
    const lanes c_n =
        pair->damping * lanes_sqrt(radius / meeting->inverse_mass); /*     (1.5) */

    contact_law_push(meeting, pair, radius, v_n, c_n, dt, ledger, history, result);
    contact_law_grip(meeting, pair, radius, v_t, pair->damping_ratio * c_n, dt, ledger, history,
                     result);
}

#if LANES_WIDTH == 1
/* The law for a single contact. */
LANES_INLINE void contact_law_scalar(const struct contact_law_meeting *meeting,
                                     const struct material_pair *pair, double dt, bool ledger,
                                     double history[CONTACT_LAW_HISTORY],
                                     struct contact_law_result *result)
{
    const struct contact_law_constants constants = {
        pair->normal, pair->tangential, pair->damping, pair->damping_ratio, pair->friction};
    contact_law(meeting, &constants, dt, ledger, history, result);
}

/* Elastic energy that a touching contact holds: Hertz and the tangential spring [J].     (1.15)
 */
LANES_INLINE double contact_law_elastic_energy(double overlap, double inverse_radius,
                                               const struct material_pair *pair,
                                               const double history[CONTACT_LAW_HISTORY])
{
    if (!(overlap > 0.0))
        return 0.0;
    const double radius = sqrt(overlap / inverse_radius); /* [m] */
    return 0.4 * pair->normal * radius * overlap * overlap +
           contact_law_dot(history, history) / (2.0 * pair->tangential * radius);
}
#endif

#endif
