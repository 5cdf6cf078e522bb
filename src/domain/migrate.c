/* See migrate.h. */
#include "domain/migrate.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "domain/boxes.h"
#include "model/sphere.h"

/* What a message's next item is. */
enum item { ITEM_SPHERE, ITEM_CONTACT, ITEM_FACET };

void migrate_init(struct migrate *migrate, const struct comm *comm)
{
    *migrate = (struct migrate){0};
    comm_mail_init(&migrate->mail, comm);
}

void migrate_clear(struct migrate *migrate)
{
    comm_mail_clear(&migrate->mail);
    migrate_forget(migrate);
    *migrate = (struct migrate){0};
}

static void reserve(struct migrate *migrate, int n)
{
    if (migrate->id_before != NULL && n <= migrate->before_capacity)
        return;
    const size_t capacity = array_capacity((size_t)migrate->before_capacity, (size_t)n);
    free(migrate->id_before);
    free(migrate->moved);
    free(migrate->owner);
    free(migrate->leaves);
    migrate->id_before = array_allocate(capacity, sizeof *migrate->id_before);
    migrate->moved = array_allocate(capacity, sizeof *migrate->moved);
    migrate->owner = array_allocate(capacity, sizeof *migrate->owner);
    migrate->leaves = array_allocate(capacity, sizeof *migrate->leaves);
    migrate->before_capacity = (int)capacity;
}

/* Finds everybody's new owner; returns how many leave this rank. */
static int decide_owners(struct migrate *migrate, const struct comm *comm,
                         const struct boxes *boxes, const struct spheres *spheres,
                         const unsigned char *removed)
{
    int n_leaving = 0;
    for (int i = 0; i < spheres->n_owned; i++) {
        migrate->owner[i] = boxes_owner(boxes, sphere_position(spheres, i));
        migrate->leaves[i] = migrate->owner[i] != comm->rank || (removed != NULL && removed[i]);
        n_leaving += migrate->leaves[i];
    }
    return n_leaving;
}

static void pack_item(struct comm_mail *mail, int rank, enum item item, const void *bytes,
                      size_t n)
{
    const unsigned char kind = (unsigned char)item;
    comm_mail_pack(mail, rank, &kind, 1);
    if (n > 0)
        comm_mail_pack(mail, rank, bytes, n);
}

static void pack_spheres(struct migrate *migrate, const struct spheres *spheres,
                         const unsigned char *removed)
{
    for (int i = 0; i < spheres->n_owned; i++) {
        if (!migrate->leaves[i] || (removed != NULL && removed[i]))
            continue;
        pack_item(&migrate->mail, migrate->owner[i], ITEM_SPHERE, NULL, 0);
        for (int f = 0; f < SPHERE_N_FIELDS; f++) {
            const struct field_view view = sphere_view(spheres, f);
            comm_mail_pack(&migrate->mail, migrate->owner[i], field_at(&view, i),
                           field_size(&sphere_fields[f]));
        }
    }
}

/* A record goes wherever one of its spheres goes; -1 where the sphere is not ours or leaves the
 * run. */
static int destination(const struct migrate *migrate, const struct spheres *spheres, int64_t id,
                       const unsigned char *removed)
{
    const int i = lookup_find(&migrate->lookup, id);
    if (i < 0 || i >= spheres->n_owned || (removed != NULL && removed[i]))
        return -1;
    return migrate->owner[i];
}

/* To one or two ranks, or none (-1). */
static void pack_contact(struct migrate *migrate, const struct contact_record *record,
                         int first, int second)
{
    if (first >= 0)
        pack_item(&migrate->mail, first, ITEM_CONTACT, record, sizeof *record);
    if (second >= 0 && second != first)
        pack_item(&migrate->mail, second, ITEM_CONTACT, record, sizeof *record);
}

static void pack_records(struct migrate *migrate, const struct spheres *spheres,
                         const unsigned char *removed)
{
    lookup_fill(&migrate->lookup, spheres->n_owned, spheres->id);
    for (int r = 0; r < migrate->n_contacts; r++) {
        const struct contact_record *record = &migrate->contacts[r];
        const int first = destination(migrate, spheres, record->first_id, removed);
        const int second = destination(migrate, spheres, record->second_id, removed);
        pack_contact(migrate, record, first, second);
    }
    for (int r = 0; r < migrate->n_facets; r++) {
        const struct facet_contact_record *record = &migrate->facets[r];
        const int owner = destination(migrate, spheres, record->id, removed);
        if (owner >= 0)
            pack_item(&migrate->mail, owner, ITEM_FACET, record, sizeof *record);
    }
}

/* Takes out what arrived; spheres are appended behind the n that were here. */
static int unpack(struct migrate *migrate, struct spheres *spheres, int n)
{
    struct comm_mail *mail = &migrate->mail;
    migrate->n_contacts = migrate->n_facets = 0;
    for (int q = 0; q < mail->n_ranks; q++) {
        while (comm_mail_waits(mail, q)) {
            unsigned char item;
            comm_mail_unpack(mail, q, &item, 1);
            if (item == ITEM_CONTACT) {
                ARRAY_GROW(migrate->contacts, migrate->n_contacts + 1,
                           migrate->contact_capacity);
                comm_mail_unpack(mail, q, &migrate->contacts[migrate->n_contacts++],
                                 sizeof *migrate->contacts);
            } else if (item == ITEM_FACET) {
                ARRAY_GROW(migrate->facets, migrate->n_facets + 1, migrate->facet_capacity);
                comm_mail_unpack(mail, q, &migrate->facets[migrate->n_facets++],
                                 sizeof *migrate->facets);
            } else {
                spheres_reserve(spheres, n + 1);
                for (int f = 0; f < SPHERE_N_FIELDS; f++) {
                    const struct field_view view = sphere_view(spheres, f);
                    comm_mail_unpack(mail, q, field_at(&view, n),
                                     field_size(&sphere_fields[f]));
                }
                n++;
            }
        }
    }
    return n;
}

/* Sorts who stays (old indices below n_owned) and who arrived (from n_before on). */
static void sort_owned(struct migrate *migrate, struct spheres *spheres, int n_with_arrivals)
{
    struct order_key *keys = array_allocate((size_t)n_with_arrivals, sizeof *keys);
    int n = 0;
    for (int i = 0; i < n_with_arrivals; i++) {
        const bool here = i < spheres->n_owned ? !migrate->leaves[i] : i >= migrate->n_before;
        if (here)
            keys[n++] = (struct order_key){spheres->order_cell[i], spheres->id[i], i};
    }
    order_arrange(spheres, 0, keys, n);
    for (int k = 0; k < n; k++) {
        if (keys[k].index < migrate->n_before)
            migrate->moved[keys[k].index] = k;
    }
    free(keys);
    spheres->n_owned = n;
}

void migrate_spheres(struct migrate *migrate, const struct comm *comm,
                     const struct boxes *boxes, struct spheres *spheres,
                     const struct contact_set *contacts, const struct facet_contacts *facets,
                     const struct materials *materials, const unsigned char *removed,
                     bool renew_order)
{
    reserve(migrate, spheres->n_all);
    migrate->n_before = spheres->n_all;
    memcpy(migrate->id_before, spheres->id, (size_t)spheres->n_all * sizeof *spheres->id);
    const int n_leaving = decide_owners(migrate, comm, boxes, spheres, removed);
    migrate->n_left = n_leaving;
    if (contacts != NULL) {
        migrate->n_contacts =
            n_leaving == 0
                ? 0
                : contact_set_records(contacts, spheres, migrate->leaves, &migrate->contacts,
                                      &migrate->contact_capacity);
        free(migrate->facets);
        migrate->facets = NULL;
        migrate->n_facets =
            facet_contacts_records(facets, spheres, 0, INT64_MAX, &migrate->facets);
        migrate->facet_capacity = migrate->n_facets;
    }
    comm_mail_begin(&migrate->mail);
    if (n_leaving > 0)
        pack_spheres(migrate, spheres, removed);
    if (migrate->n_contacts > 0 || migrate->n_facets > 0)
        pack_records(migrate, spheres, removed);
    comm_mail_exchange(&migrate->mail, comm);
    const int n_with_arrivals = unpack(migrate, spheres, migrate->n_before + migrate->n_born);
    comm_mail_forget(&migrate->mail);
    migrate->n_born = 0;
    for (int i = 0; i < migrate->n_before; i++)
        migrate->moved[i] = i < spheres->n_owned && !migrate->leaves[i] ? i : -1;
    migrate->owned_moved = renew_order || n_leaving > 0 || n_with_arrivals > migrate->n_before;
    if (migrate->owned_moved)
        sort_owned(migrate, spheres, n_with_arrivals);
    for (int i = 0; i < spheres->n_owned && migrate->owned_moved; i++)
        sphere_complete(spheres, i, materials);
    spheres->n_all = spheres->n_owned;
}

void migrate_find_moved(struct migrate *migrate, const struct spheres *spheres)
{
    lookup_fill(&migrate->lookup, spheres->n_all, spheres->id);
    for (int i = 0; i < migrate->n_before; i++) {
        if (migrate->moved[i] < 0)
            migrate->moved[i] = lookup_find(&migrate->lookup, migrate->id_before[i]);
    }
}

void migrate_follow(struct migrate *migrate, const struct comm *comm, int n,
                    const struct contact_record *records)
{
    if (migrate->before.ids == NULL)
        lookup_fill(&migrate->before, migrate->n_before, migrate->id_before);
    comm_mail_begin(&migrate->mail);
    for (int r = 0; r < n; r++) {
        const int i = lookup_find(&migrate->before, records[r].first_id);
        const int j = lookup_find(&migrate->before, records[r].second_id);
        pack_contact(migrate, &records[r], i < 0 ? -1 : migrate->owner[i],
                     j < 0 ? -1 : migrate->owner[j]);
    }
    comm_mail_exchange(&migrate->mail, comm);
    unpack(migrate, NULL, 0);
    comm_mail_forget(&migrate->mail);
}

void migrate_forget_before(struct migrate *migrate)
{
    if (migrate->n_contacts == 0)
        lookup_clear(&migrate->lookup);
    lookup_clear(&migrate->before);
    free(migrate->id_before);
    free(migrate->owner);
    free(migrate->leaves);
    migrate->id_before = NULL;
    migrate->owner = NULL;
    migrate->leaves = NULL;
}

void migrate_forget(struct migrate *migrate)
{
    migrate_forget_before(migrate);
    lookup_clear(&migrate->lookup);
    free(migrate->moved);
    free(migrate->contacts);
    free(migrate->facets);
    migrate->contacts = NULL;
    migrate->facets = NULL;
    migrate->contact_capacity = migrate->facet_capacity = 0;
    migrate->moved = NULL;
    migrate->before_capacity = 0;
}
