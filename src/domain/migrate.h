/*
 * Migration: spheres that crossed into another subdomain move to its rank with all their fields
 * and the history of every contact in which they take part; what stays is put back into
 * canonical order.
 *
 * Both owners of a contact know its history, so a record travels with each sphere that moves.
 * Spheres that left the run (`removed`) go nowhere.  Afterwards moved[] tells, for each storage
 * index of before, where that sphere is now; lists carry their history by it.
 */
#ifndef TREMIE_DOMAIN_MIGRATE_H
#define TREMIE_DOMAIN_MIGRATE_H

#include <stdbool.h>
#include <stdint.h>

#include "base/comm.h"
#include "contact/contact_set.h"
#include "contact/facet_contact.h"
#include "domain/lookup.h"
#include "model/order.h"

struct boxes;
struct materials;
struct spheres;

struct migrate {
    struct comm_mail mail;
    struct lookup lookup;
    struct lookup before; /* of what was here before the move: for migrate_follow() alone */
    /* Records on their way, filled by migrate_spheres or (facets at first) by the caller: pair
     * contacts of spheres that leave, all facet contacts (storage indices may change).
     * Afterwards what arrived. */
    int n_contacts, contact_capacity, n_facets, facet_capacity;
    struct contact_record *contacts;
    struct facet_contact_record *facets;
    /* Before the move */
    int n_before, before_capacity;
    int64_t *id_before; /* ids by storage index */
    int *moved; /* storage index now; -1: not here.  Known for all after migrate_find_moved() */
    int *owner; /* rank of each owned sphere's new owner */
    unsigned char *leaves;
    bool owned_moved; /* storage indices of owned spheres changed on this rank */
    int n_born;       /* spheres that the caller has put behind the ghosts: they stay here */
    int64_t n_left;   /* spheres that left this rank in the last migration */
};

void migrate_init(struct migrate *migrate, const struct comm *comm);
void migrate_clear(struct migrate *migrate);

/*
 * Moves every owned sphere to the owner of its place.  removed: owned spheres that leave the
 * run, or NULL.  renew_order: cells have been renewed, so all are sorted anew.  contacts may be
 * NULL (restart: the records are the caller's).  Spheres that are new in the run (n_born) stand
 * behind the ghosts, on the rank that is to own them.  Ghosts are gone afterwards.  Collective.
 */
void migrate_spheres(struct migrate *migrate, const struct comm *comm,
                     const struct boxes *boxes, struct spheres *spheres,
                     const struct contact_set *contacts, const struct facet_contacts *facets,
                     const struct materials *materials, const unsigned char *removed,
                     bool renew_order);

/* Completes moved[] once the new ghosts are here; the lookup then finds all spheres here.
 * Local. */
void migrate_find_moved(struct migrate *migrate, const struct spheres *spheres);
/* Records of pair contacts that came late: sends each where the spheres went that were owned
 * here before the last migration; `contacts` then holds what arrived.  Collective. */
void migrate_follow(struct migrate *migrate, const struct comm *comm, int n,
                    const struct contact_record *records);
/* Gives back what moved[] and the records that arrived make superfluous.  Local. */
void migrate_forget_before(struct migrate *migrate);
/* Gives back the memory of what only matters during a redistribution: lookup, moved[] and what
 * was before.  Local. */
void migrate_forget(struct migrate *migrate);

#endif
