/*
 * The contact law for a batch of contacts between spheres and facets.
 *
 * Which facets a sphere touches is decided one by one; what then happens is the same arithmetic
 * for all, so contacts are gathered and the law is taken several at a time.
 */
#ifndef TREMIE_CONTACT_FACET_KERNEL_H
#define TREMIE_CONTACT_FACET_KERNEL_H

#include <stdbool.h>

#include "contact/contact_set.h"
#include "model/material.h"

enum { FACET_KERNEL_BATCH = 64 };

/* The sphere is the first of the two, the facet the second; quantities as in contact_law.h. */
struct facet_kernel_batch {
    int n;
    /* Read. */
    double normal[3][FACET_KERNEL_BATCH];
    double velocity[3][FACET_KERNEL_BATCH];    /* [m/s] */
    double overlap[FACET_KERNEL_BATCH];        /* [m]; 0 for a contact that ends */
    double inverse_radius[FACET_KERNEL_BATCH]; /* [1/m] */
    double inverse_mass[FACET_KERNEL_BATCH];   /* [1/kg] */
    double spin[3][FACET_KERNEL_BATCH];        /* of the body less the sphere's [rad/s] */
    const struct material_pair *pair[FACET_KERNEL_BATCH];
    /* Brought to the present. */
    double history[CONTACT_LANES][FACET_KERNEL_BATCH];
    /* Written. */
    double push[FACET_KERNEL_BATCH];      /* normal force [N] */
    double grip[3][FACET_KERNEL_BATCH];   /* tangential force on the facet [N] */
    double torque[3][FACET_KERNEL_BATCH]; /* of a full law, on the facet [N m] */
    double
        lost_friction[FACET_KERNEL_BATCH]; /* [J]; this and the next two with the ledger only */
    double lost_damping[FACET_KERNEL_BATCH]; /* [J] */
    double lost_law[FACET_KERNEL_BATCH];     /* [J] */
} __attribute__((aligned(64)));

/* full: with rolling, twisting and static friction. */
void facet_kernel_apply(struct facet_kernel_batch *batch, double dt, bool full, bool ledger);

#endif
