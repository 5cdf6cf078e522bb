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
 *   0..2  force of the tangential spring, that the second exerts on the first [N]
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
    /* Energy turned to heat in the step that ends now [J]; 0 with the ledger off. */
    lanes lost_friction; /* by sliding */
    lanes lost_damping;  /* by both dashpots */
    lanes lost_law;      /* tangential elastic energy dropped as the stiffness changes */
};

LANES_INLINE lanes contact_law_dot(const lanes a[3], const lanes b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* What the law works out on its way, per contact. */
struct contact_law_work {
    lanes_mask touching, touched; /* now; in the last step */
    lanes mass;                   /* m* [kg] */
    lanes radius;                 /* of the contact, a [m] */
    lanes inverse_old;            /* 1 / radius of the last step; infinite where new [1/m] */
    lanes v_n, v_t[3];            /* relative velocity across and along the contact [m/s] */
    lanes v_now;                  /* v_n brought from the half step to the step [m/s] */
    lanes f_elastic;              /* Hertz [N] */
    lanes turned[3];              /* memory, turned into the plane of the contact [N] */
    lanes taken;                  /* what turning took off [N] */
    lanes scale;                  /* radius over the last one where it shrinks, else 1 */
    lanes stretch;                /* tangential stiffness x dt [N s/m] */
    lanes c_t;                    /* tangential dashpot [kg/s] */
    lanes_mask sliding;
    lanes share; /* of the tangential force that Coulomb leaves */
    /* With the ledger on: products of turned and v_t. */
    lanes turned_turned, turned_v, v_v;
};

/* Hertz and the normal dashpot, cut off where they would pull. */
LANES_INLINE void contact_law_push(struct contact_law_work *work,
                                   const struct contact_law_meeting *meeting,
                                   const struct contact_law_constants *pair,
                                   const lanes *history, struct contact_law_result *result)
{
    const lanes v_old = lanes_where(work->touched, history[CONTACT_LAW_VELOCITY], work->v_n);
    const lanes c_n = pair->damping * lanes_sqrt(work->radius * work->mass); /* (1.6) */

    work->v_now = work->v_n + 0.5 * (work->v_n - v_old);              /* (1.7) */
    work->f_elastic = pair->normal * work->radius * meeting->overlap; /* (1.5) */
    const lanes f_n = work->f_elastic - c_n * work->v_now;
    result->normal = lanes_keep(f_n > lanes_all(0.0), f_n); /* (1.8) */
    work->c_t = pair->damping_ratio * c_n;
}

/* Mindlin's spring, limited by Coulomb, and the dashpot beside it. */
LANES_INLINE void contact_law_grip(struct contact_law_work *work,
                                   const struct contact_law_meeting *meeting,
                                   const struct contact_law_constants *pair, lanes dt,
                                   bool ledger, lanes *history,
                                   struct contact_law_result *result)
{
    const lanes *n = meeting->normal, one = lanes_all(1.0);
    const lanes radius_old = history[CONTACT_LAW_RADIUS];
    const lanes limit = pair->friction * result->normal; /* [N] */
    lanes h[3], g[3];                                    /* spring; spring and dashpot [N] */

    work->inverse_old = one / radius_old;
    work->scale = lanes_where(work->radius < radius_old, work->radius * work->inverse_old, one);
    work->taken = contact_law_dot(history, n);
    work->stretch = pair->tangential * dt * work->radius; /* (1.9) */
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        work->turned[x] = history[x] - work->taken * n[x];                   /* (1.10) */
        h[x] = work->scale * work->turned[x] + work->stretch * work->v_t[x]; /* (1.11) */
        h[x] = lanes_keep(work->touching, h[x]);
        g[x] = h[x] + work->c_t * work->v_t[x]; /* (1.12) */
    }
    if (ledger) {
        work->turned_turned = contact_law_dot(work->turned, work->turned);
        work->turned_v = contact_law_dot(work->turned, work->v_t);
        work->v_v = contact_law_dot(work->v_t, work->v_t);
    }

    /* Spring and dashpot exert no more than friction can hold.  Where no lane slides nothing
     * would change, so skipping it changes no bit. */
    const lanes g_squared = contact_law_dot(g, g);
    work->sliding = g_squared > limit * limit;
    work->share = one;
    if (lanes_any(work->sliding)) {
        const lanes share = limit / lanes_sqrt(g_squared);
        work->share = lanes_where(work->sliding, share, one);
#pragma GCC unroll 3
        for (int x = 0; x < 3; x++) {
            h[x] *= work->share; /* (1.13) */
            g[x] *= work->share;
        }
    }
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        result->tangential[x] = -g[x];
        history[CONTACT_LAW_FORCE + x] = h[x];
    }
}

/* Where the work of this contact went in this step, but for what it stores. */
LANES_INLINE void contact_law_ledger(const struct contact_law_work *work,
                                     const struct contact_law_meeting *meeting,
                                     const struct contact_law_constants *pair, lanes dt,
                                     struct contact_law_result *result)
{
    const lanes one = lanes_all(1.0), softness = one / pair->tangential; /* [1/Pa] */
    const lanes inverse_a = one / work->radius; /* infinite where they do not touch [1/m] */
    /* Products of v_t and the spring's force, scaled (h1) and stretched (h2). */
    const lanes h1_h1 = work->scale * work->scale * work->turned_turned;
    const lanes h1_v = work->scale * work->turned_v;
    const lanes h2_v = h1_v + work->stretch * work->v_v;

    /* Dashpots.  The tangential velocity comes from the half step to the step by what this
     * contact's own force does to it: 7/4 dt / m* f. */
    const lanes half = 1.75 * dt * meeting->inverse_mass;
    const lanes g_v = work->share * (h2_v + work->c_t * work->v_v);
    const lanes dashed = work->share * work->c_t * (work->v_v - half * g_v) * dt;
    const lanes pushed = (work->f_elastic - result->normal) * work->v_now * dt;
    result->lost_damping = pushed + dashed; /* (1.17) */

    /* The spring that slides: the mean of its force before and after, times how far. */
    if (lanes_any(work->sliding)) {
        const lanes h1_h2 = h1_h1 + work->stretch * h1_v;
        const lanes h2_h2 = h1_h2 + work->stretch * h2_v;
        const lanes mean = 0.5 * (h1_h2 + work->share * h2_h2);
        const lanes slid = mean * (one - work->share) * softness * inverse_a;
        result->lost_friction = lanes_keep(work->sliding, slid + dashed); /* (1.16) */
        result->lost_damping = lanes_where(work->sliding, pushed, result->lost_damping);
    }

    /* The memory turned, the stiffness changed, and work was done against the force before. */
    const lanes turned = work->turned_turned + work->taken * work->taken;
    const lanes after = lanes_keep(work->touching, h1_h1 * inverse_a);
    const lanes dropped =
        lanes_keep(work->touched, softness * (turned * work->inverse_old - after));
    result->lost_law = 0.5 * (dropped + (work->turned_v - h1_v) * dt); /* (1.18) */
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
    const lanes *n = meeting->normal, *v = meeting->velocity;
    struct contact_law_work work = {.touching = meeting->overlap > lanes_all(0.0),
                                    .touched = history[CONTACT_LAW_RADIUS] > lanes_all(0.0),
                                    .mass = 1.0 / meeting->inverse_mass};

    work.radius = lanes_sqrt(meeting->overlap * (1.0 / meeting->inverse_radius)); /* (1.4) */
    work.v_n = contact_law_dot(v, n);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        work.v_t[x] = v[x] - work.v_n * n[x];
    contact_law_push(&work, meeting, pair, history, result);
    contact_law_grip(&work, meeting, pair, dt, ledger, history, result);
    result->lost_friction = result->lost_damping = result->lost_law = lanes_all(0.0);
    if (ledger)
        contact_law_ledger(&work, meeting, pair, dt, result);
    history[CONTACT_LAW_RADIUS] = work.radius;
    history[CONTACT_LAW_VELOCITY] = lanes_keep(work.touching, work.v_n);
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

/* Elastic energy that a touching contact holds: Hertz and the tangential spring [J]. (1.15) */
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
