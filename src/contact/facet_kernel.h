/*
 * The contact law for contacts between spheres and facets, several at a time.
 *
 * Most spheres that touch a body touch one face of it and nothing else.  Those that may do so
 * until the next search are put together in runs, face by face, and the kernel finds out for
 * whole vectors of them whether and where they touch.  Whatever else may touch is decided one
 * by one (contact/facet_local.h) and gathered into a batch, of which the kernel takes several
 * at a time as well.  Either way the arithmetic is the same text, so who went which way shows
 * nowhere.
 *
 * A ball before a surface that deforms mostly covers a circle within one triangle of it.  Of
 * those who may, the kernel finds out who does, and does all of it: a circle is a contact with
 * the triangle's plane, whose force corners bear by where its foot is.
 */
#ifndef TREMIE_CONTACT_FACET_KERNEL_H
#define TREMIE_CONTACT_FACET_KERNEL_H

#include <stdbool.h>
#include <stdint.h>

#include "base/isa.h"
#include "contact/contact_set.h"
#include "model/material.h"
#include "model/sphere.h"
#include "physics/lanes_exact.h"

struct body;
struct facet_contact;

enum {
    FACET_KERNEL_BATCH = 128,
    FACET_KERNEL_PAD = 8, /* runs are multiples of this */
    FACET_KERNEL_AHEAD =
        32, /* contacts behind a run's last that must be there, to be fetched */
    /* Force on a body (3) [N], torque (3) [N m], its work, work that springs took up [J]. */
    FACET_KERNEL_SUMS = 8,
};

/* What a body feels in a step, while it is being summed. */
struct facet_kernel_load {
    struct lanes_exact sums[FACET_KERNEL_SUMS];
    int64_t n_terms;
    int64_t n_overflow; /* contacts whose force did not fit */
};

/* Contacts that are known; the sphere is the first of the two, the body the second. */
struct facet_kernel_batch {
    int n;
    struct facet_contact *contact[FACET_KERNEL_BATCH];
    int sphere[FACET_KERNEL_BATCH];
    struct facet_kernel_load *load[FACET_KERNEL_BATCH];
    const struct material_pair *pair[FACET_KERNEL_BATCH];
    double normal[3][FACET_KERNEL_BATCH]; /* from the sphere to the body */
    double point[3][FACET_KERNEL_BATCH];  /* of the body [m] */
    double overlap[FACET_KERNEL_BATCH];   /* [m]; 0 for a contact that ends */
    double wall[3][FACET_KERNEL_BATCH];   /* velocity of the body's surface there [m/s] */
    double turns[3][FACET_KERNEL_BATCH];  /* its angular velocity [rad/s] */
    double yield[FACET_KERNEL_BATCH];     /* inverse mass of the body there [1/kg] */
    double width[FACET_KERNEL_BATCH];     /* of the contact, over that on a plane [-] */
    double force[3][FACET_KERNEL_BATCH];  /* out: on the body, as its sums took it [N] */
} __attribute__((aligned(64)));

/* Corners of the mesh that a triangle has, and those that bear what presses it: the first two
 * and one or two more, -1: one, which is the third. */
struct facet_kernel_triangle {
    int corners[3], bearers[2];
};

/* A ball that may cover something of a triangle, and whose they are. */
struct facet_kernel_entry {
    /* Only as long as it is less than this from there, less what `travelled` says. */
    double from[3], reach; /* [m] */
    struct facet_contact *contact;
    const struct body *body;
    struct facet_kernel_load *load;
    struct facet_kernel_triangle triangle;
    int sphere, group;
};

/* What it does cover. */
enum facet_kernel_kind {
    FACET_KERNEL_GONE,    /* it is not as near as it must be */
    FACET_KERNEL_NOTHING, /* nor did it */
    FACET_KERNEL_CIRCLE,
    FACET_KERNEL_OTHER, /* a part of one, or nothing any more */
};

/* Balls before triangles of surfaces that deform.  A third corner that is a mean point is where
 * it belongs: body_renew_mean(). */
struct facet_kernel_circles {
    int n, capacity;
    struct facet_kernel_entry *list;
    double travelled; /* by bodies [m] */
    /* Out, here with room for FACET_KERNEL_PAD more: an enum facet_kernel_kind of each; those
     * that are circles. */
    unsigned char *kind;
    int *found;
    struct facet_kernel_circle *circle;
};

/* A circle. */
struct facet_kernel_circle {
    double normal[3], height; /* of the triangle; of the centre over it [m] */
    double first, third;      /* parts of the corners there [-] */
    double unused[2];
} __attribute__((aligned(64)));

/* Spheres before one face of a body that does not yield and whose surface does not run. */
struct facet_kernel_run {
    const struct body *body;
    int face;
    int n;                                 /* a multiple of FACET_KERNEL_PAD */
    struct facet_contact *const *contacts; /* padding is the work's dummy */
    const int *spheres;                    /* theirs */
    struct facet_kernel_load *load;
};

/* What a kernel works on: reads motion, spin and material, adds to the spheres' force rows
 * (with the ledger on also what friction and damping dissipate, in lanes 3 and 7), to loads;
 * brings history to the present and notes overlaps. */
struct facet_kernel_work {
    const struct sphere_row *motion, *spin;
    struct sphere_row *force;
    const int32_t *material;
    int n_materials;
    const struct material_pair *pairs; /* n_materials x n_materials */
    const double *width;               /* of each sphere's contacts; NULL: 1 */
    struct facet_contact *dummy;       /* of the dummy sphere behind the last, no history */
    double dt;                         /* [s] */
    double overlap_max;                /* largest overlap / radius: grows [-] */
};

/* A batch is done with afterwards, but for its forces. */
struct facet_kernel {
    void (*batch)(struct facet_kernel_work *work, struct facet_kernel_batch *batch);
    void (*run)(struct facet_kernel_work *work, const struct facet_kernel_run *run);
    /* Whether a ball may cover something of n entries of its list with a body that deforms;
     * near a corner it says so also where it just does not.  Mean points are where they
     * belong. */
    void (*reaches)(const struct body *body, int n, const struct facet_contact *entries,
                    struct vec3 centre, double radius, bool *reaches);
    /* Finds kinds; circles() also does all that circles do.  Places are those in `motion`: not
     * where space is periodic. */
    void (*kinds)(const struct facet_kernel_work *work, struct facet_kernel_circles *circles);
    void (*circles)(struct facet_kernel_work *work, struct facet_kernel_circles *circles);
};

/* full: with rolling, twisting and static friction.  The instruction set must run. */
struct facet_kernel facet_kernel_choose(enum isa isa, bool full, bool ledger);

#endif
