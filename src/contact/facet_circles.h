/*
 * Entries of the list of contacts that may be circles within one triangle of a surface that
 * deforms, laid out for the kernel that finds out (facet_kernel.h).
 */
#ifndef TREMIE_CONTACT_FACET_CIRCLES_H
#define TREMIE_CONTACT_FACET_CIRCLES_H

#include "base/vec3.h"
#include "contact/facet_kernel.h"

struct facet_circles {
    int capacity;
    struct facet_kernel_circles of;
    int *groups; /* whose they are, as given */
};

void facet_circles_clear(struct facet_circles *circles);
/* Adds one that is all that counts of its sphere as long as this is less than `reach` away from
 * where it was, less what bodies have travelled by then [m]; returns its place. */
int facet_circles_add(struct facet_circles *circles, struct facet_contact *contact,
                      const struct body *body, struct facet_kernel_load *load, int group,
                      struct vec3 from, double reach);
/* The group of the last one. */
int facet_circles_last(const struct facet_circles *circles);
/* The last one takes the place of another, which goes. */
void facet_circles_take(struct facet_circles *circles, int place);
/* Brings mean points of quads to where they belong. */
void facet_circles_renew_means(const struct facet_kernel_circles *of);

#endif
