/*
 * Forces of a step's contacts with facets.
 *
 * Spheres that may only touch one face of one body are put together face by face, and the
 * kernel finds out for whole vectors of them whether they do. Of all others each step goes
 * through the list sphere by sphere and body by body. The local search says which contacts of
 * such a group act; these, and those that end, are gathered into a batch, in order, for which
 * the law is then taken at once; what comes of it is added contact by contact in the same
 * order. So neither the list nor the size of a batch shows in the result.
 *
 * Before a surface that deforms nearly all balls cover a circle within one triangle or nothing.
 * Those for which one triangle is near stand in a list that the kernel goes through by itself;
 * of others it is asked what their triangles are covered of, and only where that is more than
 * one circle are patches found and added up (contact/facet_patch.h).
 */
#ifndef TREMIE_CONTACT_FACET_STEP_H
#define TREMIE_CONTACT_FACET_STEP_H

#include <stdbool.h>

#include "contact/facet_contact.h"

/* Local search and law: adds forces and torques to spheres->force, updates history, body loads
 * and overlap_max. The spheres are padded (spheres_pad). dt in s. Local. */
void facet_step_apply(struct facet_contacts *facets, struct spheres *spheres,
                      const struct bodies *bodies, const struct materials *materials, double dt,
                      bool ledger);

#endif
