/*
 * The contacts between spheres on one rank and what they remember.
 *
 * A contact is an entry (first, second) of the inner list, first before second in canonical order,
 * sorted by it over owned spheres and ghosts together; at least one of the two is owned.  History lies
 * beside it, one array a lane:
 *   0..2 tangential force, as felt by the second sphere's surface [N] (sign: see physics/contact_law.h)
 *   3    contact radius of the last step [m]; > 0 exactly when the two touched
 *   4    normal relative velocity of the last step [m/s]
 * A contact that does not touch holds +0.0 in all lanes.
 */
#ifndef TREMIE_CONTACT_CONTACT_SET_H
#define TREMIE_CONTACT_CONTACT_SET_H

#include <stdbool.h>
#include <stdint.h>

enum { CONTACT_LANES = 5, CONTACT_RADIUS_LANE = 3, CONTACT_PAD = 8 };

struct spheres;

struct contact_set {
    int n;        /* entries */
    int n_padded; /* a multiple of CONTACT_PAD; the padding pairs the two dummies */
    int capacity;
    int *first, *second;           /* storage indices */
    double *history[CONTACT_LANES];
    int *row_begin, *row_end;      /* entries whose first is sphere i */
    int row_capacity;
};

/* A touching contact by ids, first_id < second_id, history oriented from first to second: what
 * migrates, is saved and compared. */
struct contact_record {
    int64_t first_id, second_id;
    double history[CONTACT_LANES];
};

static inline bool contact_touches(const struct contact_set *contacts, int k)
{
    return contacts->history[CONTACT_RADIUS_LANE][k] > 0.0;
}

#endif
