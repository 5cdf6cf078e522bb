/*
 * Balls that may cover a circle within one triangle of a surface that deforms, put together for
 * the kernel that finds out (facet_kernel.h).
 */
#ifndef TREMIE_CONTACT_FACET_CIRCLES_H
#define TREMIE_CONTACT_FACET_CIRCLES_H

#include "contact/facet_kernel.h"

void facet_circles_clear(struct facet_kernel_circles *circles);
/* Adds one, whose triangle is the contact's; returns its place. */
int facet_circles_add(struct facet_kernel_circles *circles,
                      const struct facet_kernel_entry *entry);
/* The last one takes the place of another, which goes. */
void facet_circles_take(struct facet_kernel_circles *circles, int place);
/* Brings mean points of quads to where they belong. */
void facet_circles_renew_means(const struct facet_kernel_circles *circles);

#endif
