/*
 * Which of a sphere's contacts with a body are near, and who is to be looked at in a step.
 *
 * Where facets are finer than spheres, a group is long, and most of it is too far to touch
 * within the next steps. So each long group knows which of its entries are near, and looks at
 * the others only when the sphere and the body have together moved as far as these were from
 * touching. A sphere at rest looks at all once a search, and a group of which nothing is near
 * is not even visited before the fastest sphere may have gone that far.
 */
#ifndef TREMIE_CONTACT_FACET_GROUPS_H
#define TREMIE_CONTACT_FACET_GROUPS_H

#include <stdbool.h>

#include "contact/facet_work.h"

struct bodies;
struct spheres;

/* Says of the list of contacts who is looked at in runs, and who in groups: a sphere's contacts
 * with several bodies follow each other in the order of the list. */
void facet_groups_list(struct facet_contacts *facets, const struct spheres *spheres,
                       const struct bodies *bodies);
/* Looks at groups whose sphere, or body, may have gone too far. */
void facet_groups_examine(const struct facet_work_step *step);
/* Finds out what is near of group g. */
void facet_groups_look_again(const struct facet_work_step *step, int g);
/* Lists groups that are looked at in every step, and entries that a kernel surveys. */
void facet_groups_survey(const struct facet_work_step *step);

/* May a kernel find out by itself what near entries cover? */
bool facet_groups_may_be_seen(const struct facet_work_step *step,
                              const struct facet_work_group *group);
/* Puts an entry of group g among circles that may be, as long as its sphere is within `reach`
 * of where it was; returns its place. */
int facet_groups_add_circle(const struct facet_work_step *step,
                            struct facet_kernel_circles *circles, int g, int entry,
                            double reach);

#endif
