/*
 * The contacts between spheres on one rank and what they remember.
 *
 * A contact is an entry (first, second) of the inner list, first before second in canonical
 * order, sorted by it over owned spheres and ghosts together; at least one of the two is owned.
 * History lies beside it, one array a lane:
 *   0..2 tangential spring force that the second exerts on the first [N]
 *   3    contact radius of the last step [m]; > 0 exactly when the two touched
 *   4    normal relative velocity of the last step [m/s]
 * A contact that does not touch holds +0.0 in all lanes.
 */
#ifndef TREMIE_CONTACT_CONTACT_SET_H
#define TREMIE_CONTACT_CONTACT_SET_H

#include <stdbool.h>
#include <stdint.h>

enum { CONTACT_LANES = 5, CONTACT_RADIUS_LANE = 3, CONTACT_PAD = 8, CONTACT_AHEAD = 128 };

struct candidates;
struct spheres;

/* An inner list with history. */
struct contact_list {
    int n;        /* entries */
    int n_padded; /* a multiple of CONTACT_PAD; the padding pairs the two dummies */
    int capacity;
    int *first, *second; /* storage indices, CONTACT_AHEAD more of them than n_padded */
    double *history[CONTACT_LANES];
};

struct contact_set {
    struct contact_list now;
    struct contact_list before; /* the list that `now` replaced, and room for the next one */
    int *row_begin, *row_end;   /* entries of `now` whose first is sphere i */
    int row_capacity;
};

/* A touching contact by ids, first_id < second_id, history oriented from first to second: what
 * migrates, is saved and compared. */
struct contact_record {
    int64_t first_id, second_id;
    double history[CONTACT_LANES];
};

static inline bool contact_touches(const struct contact_list *list, int k)
{
    return list->history[CONTACT_RADIUS_LANE][k] > 0.0;
}

void contact_set_clear(struct contact_set *contacts);

/*
 * Makes the inner list anew from the candidates: those pairs that may touch within the next
 * `horizon` seconds at 1.3 times the present speeds, or that are nearer than `base` [m] twice;
 * sets the spheres' inner allowances accordingly.  With keep_all every candidate is kept
 * (allowances as for the search).  History of touching contacts is carried over; moved[] gives
 * the present storage index of what was index i when the list was made (-1: no longer here),
 * NULL when nothing moved.  Local.
 */
void contact_set_prune(struct contact_set *contacts, const struct candidates *candidates,
                       struct spheres *spheres, double base, double horizon, bool keep_all,
                       const int *moved);

/* Records of touching contacts.  Those in which an owned sphere marked by chosen[] takes part,
 * or, with chosen NULL, those whose lower id is owned (each contact on exactly one rank).
 * *records grows (its capacity too); returns their number.  Local. */
int contact_set_records(const struct contact_set *contacts, const struct spheres *spheres,
                        const unsigned char *chosen, struct contact_record **records,
                        int *capacity);

/* Puts a record's history where its pair (storage indices of first_id and second_id) is listed.
 * A pair that is not listed is a mistake of ours.  Local. */
void contact_set_restore(struct contact_set *contacts, const struct candidates *candidates,
                         const struct contact_record *record, int first, int second);

#endif
