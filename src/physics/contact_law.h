/*
 * What two surfaces in contact do to each other: a normal spring with a dashpot and no pull, a
 * tangential spring with a memory, Coulomb's limit; where a pair of materials asks for it,
 * resistance to rolling and twisting, and static friction.  Equations in src/THEORY.md, section
 * 1; numbers in comments refer to it.
 *
 * The law is written once, in lanes (physics/lanes.h): the pair kernel takes it with as many
 * lanes as the processor has, contacts with facets take it with two, and all get the same
 * bits.  It speaks of a contact, not of what touches: normal, overlap, relative velocity of the
 * two surfaces at the contact point, effective radius and mass.  Who calls it knows lever arms
 * and applies forces.  For a facet of prescribed motion the curvature and the inverse mass are
 * those of the sphere alone.
 *
 * Hertz and Mindlin's springs are as stiff as the contact is wide; the linear law is theirs
 * with a width of 1 wherever surfaces touch, so one text serves both and a list may mix them.
 *
 * The normal points from the first to the second.  Relative velocity is the second's minus the
 * first's, so surfaces approach where v_n < 0.  The memory of a contact is
 *   0..2  force of the tangential spring, that the second exerts on the first [N]
 *   3     contact radius of the last step [m], 1 with the linear law; > 0 exactly when they
 *         touched
 *   4     normal relative velocity of the last step [m/s]
 * with the ledger on
 *   5..7  force of both dashpots, that the second exerts on the first [N]
 * and, only where some pair of the job needs it (`full`),
 *   8..10 force of the rolling spring, as lanes 0..2 [N]
 *   11    force of the twisting spring, along the normal [N]
 *   12    1 where the contact slid in the last step, else 0
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

#include <stddef.h>

#include "model/material.h"
#include "physics/lanes.h"
#include "physics/lanes_rows.h"

enum {
    CONTACT_LAW_FORCE = 0, /* three lanes of history */
    CONTACT_LAW_RADIUS = 3,
    CONTACT_LAW_VELOCITY = 4,
    CONTACT_LAW_DRAG = 5,    /* with the ledger on, three lanes */
    CONTACT_LAW_ROLLING = 8, /* of a full law, three lanes */
    CONTACT_LAW_TWISTING = 11,
    CONTACT_LAW_SLIDING = 12,
    CONTACT_LAW_LANES = 13,
};

/* Of what is compiled in: what is not asked for costs nothing. */
struct contact_law_choice {
    bool full;   /* rolling, twisting, static friction */
    bool ledger; /* of energy */
};

/* The constants of a pair of materials, as in struct material_pair. */
struct contact_law_constants {
    lanes_mask linear;
    lanes normal;        /* [Pa]; linear: [N/m] */
    lanes tangential;    /* [Pa]; linear: [N/m] */
    lanes damping;       /* [sqrt(Pa)]; linear: [sqrt(N/m)] */
    lanes damping_ratio; /* [-] */
    lanes friction;      /* [-] */
    /* Of a full law: */
    lanes static_friction; /* [-] */
    lanes rolling;         /* [-] */
    lanes twisting;        /* [-] */
    lanes_mask constant_torque;
};

/* How two surfaces meet. */
struct contact_law_meeting {
    lanes normal[3];      /* unit vector from the first to the second */
    lanes velocity[3];    /* of the second's surface less the first's, at the contact [m/s] */
    lanes overlap;        /* [m]; 0 where they do not touch, never negative */
    lanes inverse_radius; /* 1/R*: sum of the two curvatures [1/m] */
    lanes width;          /* of the contact, over what the law takes it for [-] */
    lanes inverse_mass;   /* 1/m*: sum of the two inverse masses [1/kg] */
    lanes spin[3];        /* of a full law: the second's spin less the first's [rad/s] */
};

/* What comes of it.  The second feels normal * n + tangential, the first the opposite. */
struct contact_law_result {
    lanes normal;        /* [N], >= 0: surfaces push, never pull */
    lanes tangential[3]; /* on the second [N] */
    lanes torque[3];     /* of a full law: that resists rolling and twisting, on the second;
                            the first feels the opposite [N m] */
    /* Energy turned to heat in the step that ends now [J]; 0 with the ledger off. */
    lanes lost_friction; /* by sliding */
    lanes lost_damping;  /* by dashpots */
    lanes wound;         /* work along the contact that springs took up: what they do not hold
                            any more the law has lost, as their stiffness changed */
};

LANES_INLINE lanes contact_law_dot(const lanes a[3], const lanes b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Constants of one pair for all lanes. */
LANES_INLINE struct contact_law_constants contact_law_constants_of_one(
    const struct material_pair *pair)
{
    return (struct contact_law_constants){
        .linear = lanes_all(pair->linear) > lanes_all(0.0),
        .normal = lanes_all(pair->normal),
        .tangential = lanes_all(pair->tangential),
        .damping = lanes_all(pair->damping),
        .damping_ratio = lanes_all(pair->damping_ratio),
        .friction = lanes_all(pair->friction),
        .static_friction = lanes_all(pair->static_friction),
        .rolling = lanes_all(pair->rolling),
        .twisting = lanes_all(pair->twisting),
        .constant_torque = lanes_all(pair->constant_torque) > lanes_all(0.0),
    };
}

#if LANES_WIDTH > 1
/* Constants of a pair for each lane: rows of eight, transposed. */
LANES_INLINE struct contact_law_constants contact_law_constants_of_each(
    const struct material_pair *const pairs[LANES_WIDTH], bool full)
{
    lanes rows[8], twisting = lanes_all(0.0), constant = lanes_all(0.0);

    _Static_assert(offsetof(struct material_pair, rolling) == 7 * sizeof(double), "a row");
#pragma GCC unroll 8
    for (int l = 0; l < LANES_WIDTH; l++)
#pragma GCC unroll 4
        for (int part = 0; part < LANES_PARTS; part++)
            rows[LANES_WIDTH * part + l] = lanes_load(&pairs[l]->normal + LANES_WIDTH * part);
    lanes_transpose(rows);
    for (int l = 0; l < LANES_WIDTH && full; l++) {
        twisting[l] = pairs[l]->twisting;
        constant[l] = pairs[l]->constant_torque;
    }
    return (struct contact_law_constants){
        .linear = rows[5] > lanes_all(0.0),
        .normal = rows[0],
        .tangential = rows[1],
        .damping = rows[2],
        .damping_ratio = rows[3],
        .friction = rows[4],
        .static_friction = rows[6],
        .rolling = rows[7],
        .twisting = twisting,
        .constant_torque = constant > lanes_all(0.0),
    };
}
#endif

/* What the law works out on its way, per contact. */
struct contact_law_work {
    lanes_mask touching, touched; /* now; in the last step */
    lanes mass;                   /* m* [kg] */
    lanes radius;                 /* of the contact, a [m] */
    lanes inverse_old;            /* 1 / radius of the last step; infinite where new [1/m] */
    lanes v_n;                    /* relative velocity across the contact [m/s] */
    lanes v_now;                  /* v_n brought from the half step to the step [m/s] */
    lanes f_elastic;              /* [N] */
    lanes scale;                  /* radius over the last one where it shrinks, else 1 */
    lanes middle;                 /* radius in the step's middle, as it grows [m] */
    lanes stretch;                /* tangential stiffness there x dt [N s/m] */
    lanes c_t;                    /* tangential dashpot [kg/s] */
};

/* A spring with a memory, a dashpot beside it and Coulomb's limit for both: the tangential one,
 * the rolling one, or, with one component, the twisting one. */
struct contact_law_spring {
    const lanes *velocity; /* of its two ends [m/s] */
    lanes *memory;         /* [N] */
    lanes scale;           /* of the memory */
    lanes stretch, c;      /* [N s/m], [kg/s] */
    lanes hold, slide;     /* what it holds before it slides, and while it slides [N] */
    /* What comes of it: */
    lanes force[3]; /* of spring and dashpot, along the velocity [N] */
    lanes_mask sliding;
    /* With the ledger on: power of the spring's forces before and after [W], and, while it
     * slides, the mean spring force times the stretch that sliding spares it [N2]. */
    lanes power, slip;
};

/* The normal spring and its dashpot, cut off where they would pull. */
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

LANES_INLINE lanes contact_law_product(const lanes *a, const lanes *b, int n)
{
    return n == 1 ? a[0] * b[0] : contact_law_dot(a, b);
}

/* Lets the lanes that slide give way: h1 is the memory before, h the stretched spring, g spring
 * and dashpot.  The slider is in series with both, so the spring keeps what the dashpot, at the
 * spring's own rate, leaves of friction. */
LANES_INLINE void contact_law_slide(struct contact_law_spring *spring, lanes g_squared, int n,
                                    bool ledger, const lanes h1[3], lanes h[3], lanes g[3])
{
    const lanes share = spring->slide / lanes_sqrt(g_squared);
    const lanes kept = spring->stretch / (spring->stretch + spring->c); /* (1.13) */
    lanes slip = lanes_all(0.0);

#pragma GCC unroll 3
    for (int x = 0; x < n; x++) {
        const lanes all = share * g[x];
        const lanes held = h1[x] + kept * (all - h1[x]);
        if (ledger)
            slip += 0.5 * (h1[x] + held) * (h[x] - held);
        g[x] = lanes_where(spring->sliding, all, g[x]);
        h[x] = lanes_where(spring->sliding, held, h[x]);
    }
    spring->slip = lanes_keep(spring->sliding, slip);
}

/* Stretches a spring of n components, whose memory lies in the plane of the contact by now, and
 * lets it slide. */
LANES_INLINE void contact_law_stretch(struct contact_law_spring *spring, lanes_mask touching,
                                      int n, bool ledger)
{
    lanes h1[3], h[3], g[3]; /* memory; spring; spring and dashpot [N] */

    spring->slip = lanes_all(0.0);
    if (ledger)
        spring->power = contact_law_product(spring->memory, spring->velocity, n);
#pragma GCC unroll 3
    for (int x = 0; x < n; x++) {
        h1[x] = spring->scale * spring->memory[x];
        h[x] = h1[x] + spring->stretch * spring->velocity[x];
        h[x] = lanes_keep(touching, h[x]);             /* (1.11) */
        g[x] = h[x] + spring->c * spring->velocity[x]; /* (1.12) */
    }

    /* Spring and dashpot exert no more than friction can hold.  Where no lane slides nothing
     * would change, so skipping it changes no bit. */
    const lanes g_squared = contact_law_product(g, g, n);
    spring->sliding = g_squared > spring->hold * spring->hold;
    if (lanes_any(spring->sliding))
        contact_law_slide(spring, g_squared, n, ledger, h1, h, g);
    if (ledger)
        spring->power += contact_law_product(h, spring->velocity, n);
#pragma GCC unroll 3
    for (int x = 0; x < n; x++) {
        spring->force[x] = g[x];
        spring->memory[x] = h[x];
    }
}

/* Where the work of a spring and its dashpot went in this step.  `dragged` is the dashpot's,
 * which counts as friction where it slides. */
LANES_INLINE void contact_law_spring_ledger(const struct contact_law_spring *spring,
                                            const struct contact_law_work *work, lanes dragged,
                                            lanes softness, lanes dt,
                                            struct contact_law_result *result)
{
    lanes wound = 0.5 * dt * spring->power; /* (1.18) */

    result->lost_damping += lanes_where(spring->sliding, lanes_all(0.0), dragged);
    if (lanes_any(spring->sliding)) { /* without, this changes nothing */
        const lanes slid = spring->slip * softness / work->middle;
        const lanes rubbed = lanes_keep(spring->sliding, slid);
        result->lost_friction += lanes_keep(spring->sliding, slid + dragged); /* (1.16) */
        wound -= rubbed;
    }
    result->wound += wound;
}

/* The part of a vector in the plane of the contact; returns what lay across it. */
LANES_INLINE lanes contact_law_flatten(lanes vector[3], const lanes normal[3])
{
    const lanes across = contact_law_dot(vector, normal);

#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        vector[x] -= across * normal[x];
    return across;
}

/* The dashpots' work in the interval that ends now: its velocity times the mean of the forces
 * at its two ends (1.17).  What acted across the contact is counted as damping; returns what
 * acted along it. */
LANES_INLINE lanes contact_law_drag(const struct contact_law_work *work, const lanes v_t[3],
                                    const struct contact_law_meeting *meeting, lanes dt,
                                    const lanes tangential[3], lanes *history,
                                    struct contact_law_result *result)
{
    lanes *old = history + CONTACT_LAW_DRAG;
    const lanes half = 0.5 * dt, pushed = result->normal - work->f_elastic; /* [N] */
    const lanes across = contact_law_dot(old, meeting->normal) - pushed;
    const lanes along = contact_law_dot(old, v_t) + contact_law_dot(tangential, v_t);

    result->lost_damping += half * across * work->v_n;
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        old[x] = lanes_keep(work->touching, tangential[x] - pushed * meeting->normal[x]);
    return half * along;
}

/* The tangential spring. */
LANES_INLINE void contact_law_grip(struct contact_law_work *work, lanes v_t[3],
                                   const struct contact_law_meeting *meeting,
                                   const struct contact_law_constants *pair, lanes dt,
                                   struct contact_law_choice choice, lanes *history,
                                   struct contact_law_result *result)
{
    contact_law_flatten(history, meeting->normal); /* (1.10) */
    struct contact_law_spring spring = {.velocity = v_t,
                                        .memory = history,
                                        .scale = work->scale,
                                        .stretch = work->stretch,
                                        .c = work->c_t,
                                        .slide = pair->friction * result->normal};

    spring.hold = spring.slide;
    if (choice.full) {
        const lanes_mask slid = history[CONTACT_LAW_SLIDING] > lanes_all(0.0);
        const lanes still = pair->static_friction * result->normal;
        spring.hold = lanes_where(slid, spring.slide, still); /* (1.14) */
    }
    contact_law_stretch(&spring, work->touching, 3, choice.ledger);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        result->tangential[x] = -spring.force[x];
    if (choice.full)
        history[CONTACT_LAW_SLIDING] =
            lanes_keep(spring.sliding & work->touching, lanes_all(1.0));
    if (choice.ledger) {
        const lanes drag[3] = {spring.force[0] - history[0], spring.force[1] - history[1],
                               spring.force[2] - history[2]};
        const lanes dragged = contact_law_drag(work, v_t, meeting, dt, drag, history, result);
        contact_law_spring_ledger(&spring, work, dragged, 1.0 / pair->tangential, dt, result);
    }
}

/* Work of a dashpot whose force at the last step is not remembered: late by half a step, which
 * cancels over a contact but for its ends. */
LANES_INLINE lanes contact_law_dragged(const struct contact_law_spring *spring, int n, lanes dt)
{
    lanes drag[3];

#pragma GCC unroll 3
    for (int x = 0; x < n; x++)
        drag[x] = spring->force[x] - spring->memory[x];
    return contact_law_product(drag, spring->velocity, n) * dt;
}

/* Resistance to rolling and twisting: springs like the tangential one, that the surfaces' spin
 * stretches. */
LANES_INLINE void contact_law_roll(const struct contact_law_work *work,
                                   const struct contact_law_meeting *meeting,
                                   const struct contact_law_constants *pair, lanes dt,
                                   bool ledger, lanes *history,
                                   struct contact_law_result *result)
{
    const lanes radius = 1.0 / meeting->inverse_radius, zero = lanes_all(0.0); /* R* [m] */
    const lanes softness = 1.0 / pair->tangential;
    lanes rolls[3] = {radius * meeting->spin[0], radius * meeting->spin[1],
                      radius * meeting->spin[2]};                     /* (1.26) [m/s] */
    const lanes twists = contact_law_flatten(rolls, meeting->normal); /* [m/s] */
    contact_law_flatten(history + CONTACT_LAW_ROLLING, meeting->normal);
    /* A torque of constant size needs no memory: a dashpot that would stop the spin within two
     * steps, limited. */
    const lanes_mask forgets = pair->constant_torque;
    struct contact_law_spring spring = {
        .velocity = rolls,
        .memory = history + CONTACT_LAW_ROLLING,
        .scale = lanes_where(forgets, zero, work->scale),
        .stretch = lanes_where(forgets, zero, work->stretch),
        .c = lanes_keep(work->touching,
                        lanes_where(forgets, 0.2 * work->mass / dt, work->c_t)), /* (1.28) */
        .slide = pair->rolling * result->normal};                                /* (1.27) */
    spring.hold = spring.slide;
    contact_law_stretch(&spring, work->touching, 3, ledger);
    if (ledger)
        contact_law_spring_ledger(&spring, work, contact_law_dragged(&spring, 3, dt), softness,
                                  dt, result);

    struct contact_law_spring twist = {.velocity = &twists,
                                       .memory = history + CONTACT_LAW_TWISTING,
                                       .scale = work->scale,
                                       .stretch = work->stretch,
                                       .c = work->c_t,
                                       .slide = pair->twisting * result->normal};
    twist.hold = twist.slide;
    contact_law_stretch(&twist, work->touching, 1, ledger);
    if (ledger)
        contact_law_spring_ledger(&twist, work, contact_law_dragged(&twist, 1, dt), softness,
                                  dt, result);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        result->torque[x] =
            -radius * (spring.force[x] + twist.force[0] * meeting->normal[x]); /* (1.29) */
}

/*
 * The law.  `history` has CONTACT_LAW_LANES lanes, of which those that the choice needs are
 * read and brought to the present.  Where surfaces do not touch, forces are zero and the
 * history becomes +0.0; with the ledger on, what a contact that has just ended still held is
 * counted as lost, so call once more after the end.
 */
LANES_INLINE void contact_law(const struct contact_law_meeting *meeting,
                              const struct contact_law_constants *pair, lanes dt,
                              struct contact_law_choice choice, lanes *history,
                              struct contact_law_result *result)
{
    const lanes radius_old = history[CONTACT_LAW_RADIUS], one = lanes_all(1.0);
    struct contact_law_work work = {.touching = meeting->overlap > lanes_all(0.0),
                                    .touched = radius_old > lanes_all(0.0),
                                    .mass = 1.0 / meeting->inverse_mass};
    lanes v_t[3] = {meeting->velocity[0], meeting->velocity[1], meeting->velocity[2]};

    const lanes squared = meeting->overlap * (1.0 / meeting->inverse_radius);
    work.radius =
        meeting->width * lanes_sqrt(lanes_where(pair->linear, lanes_keep(work.touching, one),
                                                squared)); /* (1.4) */
    work.v_n = contact_law_flatten(v_t, meeting->normal);
    contact_law_push(&work, meeting, pair, history, result);
    work.inverse_old = one / radius_old;
    work.scale = lanes_where(work.radius < radius_old, work.radius * work.inverse_old, one);
    const lanes smaller = lanes_where(work.radius < radius_old, work.radius, radius_old);
    work.middle = 0.5 * (work.radius + smaller);
    const lanes_mask begins = pair->linear & work.touching & (radius_old <= lanes_all(0.0));
    if (lanes_any(begins)) { /* a spring of full stiffness for part of the step (1.33) */
        const lanes part = meeting->overlap / (-work.v_n * dt);
        const lanes_mask within = (part < one) & (part > lanes_all(0.0));
        work.middle = lanes_where(begins & within, part * work.radius, work.middle);
    }
    work.stretch = pair->tangential * dt * work.middle; /* (1.11) */
    result->lost_friction = result->lost_damping = result->wound = lanes_all(0.0);
    contact_law_grip(&work, v_t, meeting, pair, dt, choice, history, result);
    if (choice.full)
        contact_law_roll(&work, meeting, pair, dt, choice.ledger, history, result);
    history[CONTACT_LAW_RADIUS] = work.radius;
    history[CONTACT_LAW_VELOCITY] = lanes_keep(work.touching, work.v_n);
}

#if LANES_WIDTH == 1
/* The law for a single contact. */
LANES_INLINE void contact_law_scalar(const struct contact_law_meeting *meeting,
                                     const struct material_pair *pair, double dt,
                                     struct contact_law_choice choice, double *history,
                                     struct contact_law_result *result)
{
    const struct contact_law_constants constants = contact_law_constants_of_one(pair);
    contact_law(meeting, &constants, dt, choice, history, result);
}

/* Elastic energy that a contact's springs with a memory hold after the law [J].  (1.15) */
LANES_INLINE double contact_law_spring_energy(const struct material_pair *pair,
                                              const double history[CONTACT_LAW_LANES])
{
    const double *rolling = history + CONTACT_LAW_ROLLING;
    const double twisting = history[CONTACT_LAW_TWISTING];
    const double springs = contact_law_dot(history, history) +
                           contact_law_dot(rolling, rolling) + twisting * twisting;
    const double radius = history[CONTACT_LAW_RADIUS];
    return radius > 0.0 ? springs / (2.0 * pair->tangential * radius) : 0.0;
}

/* Force of the normal spring of a contact as wide as the law takes it for [N].  (1.5) */
LANES_INLINE double contact_law_normal_force(double overlap, double inverse_radius,
                                             const struct material_pair *pair)
{
    const double radius = pair->linear > 0.0 ? 1.0 : sqrt(overlap / inverse_radius); /* [m] */
    return pair->normal * radius * overlap;
}

/* Elastic energy of the normal spring [J].  (1.15) */
LANES_INLINE double contact_law_normal_energy(double overlap, double inverse_radius,
                                              const struct material_pair *pair)
{
    if (!(overlap > 0.0))
        return 0.0;
    const bool linear = pair->linear > 0.0;
    const double radius = linear ? 1.0 : sqrt(overlap / inverse_radius); /* [m] */
    return (linear ? 0.5 : 0.4) * pair->normal * radius * overlap * overlap;
}
#endif

#endif
