/*
 * The contacts between spheres on one rank and what they remember.
 *
 * A contact is an entry (first, second) of the inner list, first before second in canonical
 * order, sorted by it over owned spheres and ghosts together; at least one of the two is owned.
 * History lies beside it, one array a lane:
 *   0..2 tangential spring force that the second exerts on the first [N]
 *   3    contact radius of the last step [m]; > 0 exactly when the two touched
 *   4    normal relative velocity of the last step [m/s]
 * with the ledger on
 *   5..7 force of the dashpots, as 0..2 [N]
 * and, where the job's pairs of materials need them (`full`),
 *   8..10 rolling spring force, as 0..2 [N]
 *   11   twisting spring force along the normal [N]
 *   12   1 where the contact slid in the last step
 * A contact that does not touch holds +0.0 in all lanes.
 *
 * Where space is periodic, a rank may hold images of its own spheres.  A contact over the
 * boundary then stands in the list twice, between either sphere and the other's image, with the
 * same history; each entry acts on its owned sphere, and its record is made once.
 */
#ifndef TREMIE_CONTACT_CONTACT_SET_H
#define TREMIE_CONTACT_CONTACT_SET_H

#include <stdbool.h>
#include <stdint.h>

enum {
    CONTACT_LANES = 13, /* at most */
    CONTACT_RADIUS_LANE = 3,
    CONTACT_DRAG_LANE = 5,
    CONTACT_ROLLING_LANE = 8,
    CONTACT_TWISTING_LANE = 11,
    CONTACT_PAD = 8,
    CONTACT_AHEAD = 128
};

struct candidates;
struct spheres;

/* An inner list with history. */
struct contact_list {
    int n;               /* entries */
    int n_padded;        /* a multiple of CONTACT_PAD; the padding pairs the two dummies */
    int *first, *second; /* storage indices, CONTACT_AHEAD more of them than n_padded */
    double *history[CONTACT_LANES]; /* NULL where the job needs no such lane */
};

/* Pairs of a list. */
struct contact_pairs {
    int n;
    int *first, *second;
};

struct contact_set {
    bool full, ledger; /* which lanes there are */
    struct contact_list now;
    int pair_capacity, history_capacity; /* of `now` */
    double *spare;            /* a lane that the next one is made in; none between lists */
    int *row_begin, *row_end; /* entries of `now` whose first is sphere i */
    int row_capacity;
    /* While `now` is made: */
    struct contact_pairs before; /* pairs of the list that it replaces */
    int *source; /* of an entry: where it was before, times 2, plus 1 where it was the other way
                    round; behind the last one where it was not there */
};

/* A touching contact by ids, first_id < second_id, history oriented from first to second: what
 * migrates, is saved and compared.  Lanes that the job does not need hold zeros. */
struct contact_record {
    int64_t first_id, second_id;
    double history[CONTACT_LANES];
};

static inline bool contact_touches(const struct contact_list *list, int k)
{
    return list->history[CONTACT_RADIUS_LANE][k] > 0.0;
}

/* Is this lane there, in a job with rolling, twisting or static friction (full), with the
 * ledger on? */
static inline bool contact_lane_used(int lane, bool full, bool ledger)
{
    return lane < CONTACT_DRAG_LANE || (lane < CONTACT_ROLLING_LANE ? ledger : full);
}

/* Does this lane change its sign when the first and the second change places?  Forces in space
 * do. */
static inline bool contact_lane_turns(int lane)
{
    return lane < CONTACT_RADIUS_LANE ||
           (lane >= CONTACT_DRAG_LANE && lane < CONTACT_TWISTING_LANE);
}

void contact_set_init(struct contact_set *contacts, bool full, bool ledger);
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

/* Records of touching contacts in which an owned sphere marked by chosen[] takes part.
 * *records grows (its capacity too); returns their number.  Local. */
int contact_set_records(const struct contact_set *contacts, const struct spheres *spheres,
                        const unsigned char *chosen, struct contact_record **records,
                        int *capacity);
/* The same of those whose lower id is owned here, each contact on exactly one rank, and lies in
 * begin .. end - 1.  Local. */
int contact_set_records_of(const struct contact_set *contacts, const struct spheres *spheres,
                           int64_t begin, int64_t end, struct contact_record **records,
                           int *capacity);
/* How many touching contacts have their lower id owned here.  Local. */
int contact_set_count(const struct contact_set *contacts, const struct spheres *spheres);

/* Puts a record's history where its pair (storage indices of first_id and second_id, of any
 * copies of them) is listed; false where it is not, for the two are far apart.  Local. */
bool contact_set_restore(struct contact_set *contacts, const struct candidates *candidates,
                         const struct spheres *spheres, const struct contact_record *record,
                         int first, int second);

#endif
