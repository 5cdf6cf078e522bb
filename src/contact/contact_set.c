/*
 * See contact_set.h.  History is carried from one list to the next lane by lane, once it is
 * known where each entry was before.  An ordinary search moves nothing in memory, so both lists
 * are in the same order and are walked side by side; else each touching contact's pair is
 * looked for in the row of its first sphere, which is short.
 */
#include "contact/contact_set.h"

#include <limits.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "contact/candidates.h"
#include "model/sphere.h"

void contact_set_init(struct contact_set *contacts, bool full, bool ledger)
{
    *contacts = (struct contact_set){.full = full, .ledger = ledger};
}

static bool has_lane(const struct contact_set *contacts, int lane)
{
    return contact_lane_used(lane, contacts->full, contacts->ledger);
}

void contact_set_clear(struct contact_set *contacts)
{
    free(contacts->now.first);
    free(contacts->now.second);
    for (int l = 0; l < CONTACT_LANES; l++)
        free(contacts->now.history[l]);
    free(contacts->spare);
    free(contacts->row_begin);
    free(contacts->row_end);
    *contacts = (struct contact_set){0};
}

/* Room for the pairs of n entries, the padding and what kernels look ahead; those there are
 * stay. */
static void reserve_pairs(struct contact_set *contacts, int n)
{
    struct contact_list *list = &contacts->now;
    const size_t old = (size_t)contacts->pair_capacity;
    const size_t needed = (size_t)n + CONTACT_PAD + CONTACT_AHEAD;
    if (needed <= old)
        return;
    const size_t capacity = needed + needed / 8;
    list->first = array_resize_rows(list->first, old, capacity, sizeof(int));
    list->second = array_resize_rows(list->second, old, capacity, sizeof(int));
    contacts->pair_capacity = (int)capacity;
}

/* The present pairs become those before, until the list is made. */
static void set_pairs_aside(struct contact_set *contacts)
{
    struct contact_list *list = &contacts->now;
    contacts->before = (struct contact_pairs){list->n, list->first, list->second};
    list->first = list->second = NULL;
    contacts->pair_capacity = 0;
    reserve_pairs(contacts, list->n);
}

static void forget_before(struct contact_set *contacts)
{
    free(contacts->before.first);
    free(contacts->before.second);
    free(contacts->source);
    contacts->before = (struct contact_pairs){0};
    contacts->source = NULL;
}

static void pad_pairs(struct contact_set *contacts, int dummy)
{
    struct contact_list *list = &contacts->now;
    list->n_padded = (list->n + CONTACT_PAD - 1) / CONTACT_PAD * CONTACT_PAD;
    for (int k = list->n; k < list->n_padded + CONTACT_AHEAD; k++) {
        list->first[k] = dummy;
        list->second[k] = dummy + 1;
    }
}

/* Inner allowances: how far each sphere may go before the inner list is stale. */
static void choose_allowances(struct spheres *spheres, double *inner, double base,
                              double horizon, bool keep_all)
{
    for (int i = 0; i < spheres->n_all; i++) {
        const double *v = sphere_velocity(spheres, i);
        const double speed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        const double reach = 1.3 * speed * horizon;
        const double wanted = reach > base ? reach : base;
        inner[i] = keep_all || wanted > spheres->allowance[i] ? spheres->allowance[i] : wanted;
        spheres->inverse_allowance[i][1] = 1.0 / inner[i];
    }
}

static void select_pairs(struct contact_set *contacts, const struct candidates *candidates,
                         const struct spheres *spheres, const double *inner, bool keep_all)
{
    struct contact_list *list = &contacts->now;
    int n = 0, begin = 0;
    for (int place = 0; place < spheres->n_all; place++) {
        const int i = candidates->at[place];
        const double *a = spheres->motion[i].lane;
        const double reach = a[3] + inner[i];
        contacts->row_begin[i] = n;
        reserve_pairs(contacts, n + (candidates->row_end[place] - begin));
        for (int k = begin; k < candidates->row_end[place]; k++) {
            const int j = candidates->second[k];
            const int ahead = candidates->second[k + CANDIDATES_AHEAD];
            __builtin_prefetch(&spheres->motion[ahead]);
            __builtin_prefetch(&inner[ahead]);
            const double *b = spheres->motion[j].lane;
            const double dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
            const double sum = reach + b[3] + inner[j];
            list->first[n] = i;
            list->second[n] = j;
            n += (dx * dx + dy * dy + dz * dz < sum * sum) | keep_all;
        }
        contacts->row_end[i] = n;
        begin = candidates->row_end[place];
    }
    list->n = n;
}

/* Entry of the pair, -1 when it is not listed.  Rows are short, but those of spheres that are
 * much larger than others; they are in order of the second's place. */
static int find_entry(const struct contact_set *contacts, const struct candidates *candidates,
                      int first, int second)
{
    enum { SHORT = 16 };
    const int *list = contacts->now.second, *places = candidates->place;
    int begin = contacts->row_begin[first], end = contacts->row_end[first];
    while (end - begin > SHORT) {
        const int middle = begin + (end - begin) / 2;
        if (places[list[middle]] <= places[second])
            begin = middle;
        else
            end = middle;
    }
    for (int k = begin; k < end; k++) {
        if (list[k] == second)
            return k;
    }
    return -1;
}

/* Seen from the other side, vectors turn round; the rest stays. */
static double seen_from(bool other_side, int lane, double h)
{
    return other_side && contact_lane_turns(lane) ? -h : h;
}

/* What a contact remembers, as seen from its first: entry `before`, or a history given. */
struct memory {
    int before;
    const double *history; /* NULL: entry `before` */
};

static void write_history(struct contact_set *contacts, int entry, bool turned,
                          const double history[CONTACT_LANES])
{
    for (int l = 0; l < CONTACT_LANES; l++)
        if (has_lane(contacts, l))
            contacts->now.history[l][entry] = seen_from(turned, l, history[l]);
}

/* Gives the memory to where the two are listed; false where they are not. */
static bool place_between(struct contact_set *contacts, const struct candidates *candidates,
                          int first, int second, bool turned, struct memory memory)
{
    const bool swapped = candidates->place[first] > candidates->place[second];
    const int entry = swapped ? find_entry(contacts, candidates, second, first)
                              : find_entry(contacts, candidates, first, second);
    if (entry < 0)
        return false;
    if (memory.history != NULL)
        write_history(contacts, entry, turned != swapped, memory.history);
    else
        contacts->source[entry] = 2 * memory.before + (turned != swapped);
    return true;
}

/* Copies of a sphere here, itself and images, stand together in canonical order: its lowest
 * and one past its highest place. */
static void find_copies(const struct candidates *candidates, const struct spheres *spheres,
                        int i, int places[2])
{
    places[0] = candidates->place[i];
    places[1] = places[0] + 1;
    while (places[0] > 0 && spheres->id[candidates->at[places[0] - 1]] == spheres->id[i])
        places[0]--;
    while (places[1] < spheres->n_all &&
           spheres->id[candidates->at[places[1]]] == spheres->id[i])
        places[1]++;
}

static double distance2_of(const struct spheres *spheres, int i, int j)
{
    const double *a = sphere_position(spheres, i), *b = sphere_position(spheres, j);
    const double dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
    return dx * dx + dy * dy + dz * dz;
}

/* Gives the memory to each owned copy of `first` and the copy of `second` that is nearest to
 * it: periods are so long that no other touches. */
static bool place_copies(struct contact_set *contacts, const struct candidates *candidates,
                         const struct spheres *spheres, int first, int second, bool turned,
                         struct memory memory)
{
    int a[2], b[2];
    bool placed = false;
    find_copies(candidates, spheres, first, a);
    find_copies(candidates, spheres, second, b);
    for (int p = a[0]; p < a[1]; p++) {
        const int i = candidates->at[p];
        int nearest = candidates->at[b[0]];
        for (int q = b[0] + 1; q < b[1]; q++) {
            const int j = candidates->at[q];
            nearest =
                distance2_of(spheres, i, j) < distance2_of(spheres, i, nearest) ? j : nearest;
        }
        if (i < spheres->n_owned &&
            place_between(contacts, candidates, i, nearest, turned, memory))
            placed = true;
    }
    return placed;
}

static bool place_memory(struct contact_set *contacts, const struct candidates *candidates,
                         const struct spheres *spheres, int first, int second,
                         struct memory memory)
{
    bool placed;
    if (spheres->periodic.any) {
        placed = place_copies(contacts, candidates, spheres, first, second, false, memory);
        placed =
            place_copies(contacts, candidates, spheres, second, first, true, memory) || placed;
    } else {
        placed = place_between(contacts, candidates, first, second, false, memory);
    }
    return placed;
}

static bool touched_before(const struct contact_set *contacts, int k)
{
    return contacts->now.history[CONTACT_RADIUS_LANE][k] > 0.0;
}

/* Where the entries of the list come from, if spheres moved in memory. */
static void find_sources(struct contact_set *contacts, const struct candidates *candidates,
                         const struct spheres *spheres, const int *moved)
{
    const struct contact_pairs *before = &contacts->before;
    for (int k = 0; k < before->n; k++) {
        if (!touched_before(contacts, k))
            continue;
        const int first = moved == NULL ? before->first[k] : moved[before->first[k]];
        const int second = moved == NULL ? before->second[k] : moved[before->second[k]];
        /* Contacts between what others own now are theirs to remember. */
        if (first < 0 || second < 0 ||
            (first >= spheres->n_owned && second >= spheres->n_owned))
            continue;
        CHECK(place_memory(contacts, candidates, spheres, first, second,
                           (struct memory){.before = k}),
              "a touching contact is not in the list");
    }
}

/* The same where nothing moved: both lists are in the same order, row by row. */
static void match_rows(struct contact_set *contacts)
{
    const struct contact_pairs *before = &contacts->before;
    const int *second = contacts->now.second;
    int row = -1, k = 0, end = 0;
    for (int b = 0; b < before->n; b++) {
        if (!touched_before(contacts, b))
            continue;
        if (before->first[b] != row) {
            row = before->first[b];
            k = contacts->row_begin[row];
            end = contacts->row_end[row];
        }
        while (k < end && second[k] != before->second[b])
            k++;
        CHECK(k < end, "a touching contact is not in the list");
        contacts->source[k] = 2 * b;
    }
}

static void copy_lane(const double *old, const int *source, int n, double *new)
{
    for (int k = 0; k < n; k++)
        new[k] = old[source[k] >> 1];
}

/* The same of a lane that turns round with its contact; without a branch, which nobody could
 * foresee. */
static void copy_turning_lane(const double *old, const int *source, int n, double *new)
{
    for (int k = 0; k < n; k++) {
        uint64_t bits;
        memcpy(&bits, &old[source[k] >> 1], sizeof bits);
        bits ^= (uint64_t)(source[k] & 1) << 63;
        memcpy(&new[k], &bits, sizeof bits);
    }
}

/* One lane anew from the old one, in the spare one, which the old one then is. */
static void carry_lane(struct contact_set *contacts, int lane)
{
    const struct contact_list *list = &contacts->now;
    double *old = list->history[lane], *new = contacts->spare;
    const int n = old != NULL ? list->n : 0;
    if (old != NULL)
        old[contacts->before.n] = 0.0; /* where entries come from that were not there */
    if (contact_lane_turns(lane))
        copy_turning_lane(old, contacts->source, n, new);
    else
        copy_lane(old, contacts->source, n, new);
    for (int k = n; k < list->n_padded; k++)
        new[k] = 0.0;
    contacts->spare = old;
    contacts->now.history[lane] = new;
}

/* Lanes for the present list.  Where they have to grow each is made before the old one goes. */
static void carry_history(struct contact_set *contacts)
{
    const size_t needed = (size_t)contacts->now.n_padded + 1;
    const bool grow = needed > (size_t)contacts->history_capacity;
    const size_t capacity = grow ? needed + needed / 32 : (size_t)contacts->history_capacity;
    for (int l = 0; l < CONTACT_LANES; l++) {
        if (!has_lane(contacts, l))
            continue;
        if (grow || contacts->spare == NULL) {
            free(contacts->spare);
            contacts->spare = array_allocate_rows(capacity, sizeof(double));
        }
        carry_lane(contacts, l);
    }
    free(contacts->spare);
    contacts->spare = NULL;
    contacts->history_capacity = (int)capacity;
}

static void reserve_rows(struct contact_set *contacts, int n)
{
    if (n <= contacts->row_capacity)
        return;
    const size_t capacity = array_capacity((size_t)contacts->row_capacity, (size_t)n);
    free(contacts->row_begin);
    free(contacts->row_end);
    contacts->row_begin = array_allocate_rows(capacity, sizeof(int));
    contacts->row_end = array_allocate_rows(capacity, sizeof(int));
    contacts->row_capacity = (int)capacity;
}

static void begin_sources(struct contact_set *contacts)
{
    contacts->source = array_allocate_rows((size_t)contacts->now.n, sizeof *contacts->source);
    for (int k = 0; k < contacts->now.n; k++)
        contacts->source[k] = 2 * contacts->before.n;
}

void contact_set_prune(struct contact_set *contacts, const struct candidates *candidates,
                       struct spheres *spheres, double base, double horizon, bool keep_all,
                       const int *moved)
{
    double *inner = array_allocate((size_t)spheres->n_all, sizeof *inner);
    set_pairs_aside(contacts);
    reserve_rows(contacts, spheres->n_all);
    choose_allowances(spheres, inner, base, horizon, keep_all);
    select_pairs(contacts, candidates, spheres, inner, keep_all);
    free(inner);
    pad_pairs(contacts, spheres->n_all);
    begin_sources(contacts);
    if (moved == NULL && !spheres->periodic.any)
        match_rows(contacts);
    else
        find_sources(contacts, candidates, spheres, moved);
    carry_history(contacts);
    forget_before(contacts);
}

/* The two of an entry by their ids. */
static int lower_of(const struct contact_list *list, const struct spheres *spheres, int k)
{
    const int i = list->first[k], j = list->second[k];
    return spheres->id[i] > spheres->id[j] ? j : i;
}

static void add_record(const struct contact_set *contacts, const struct spheres *spheres, int k,
                       int *n, struct contact_record **records, int *capacity)
{
    const struct contact_list *list = &contacts->now;
    const int lower = lower_of(list, spheres, k);
    const bool turned = lower != list->first[k];
    ARRAY_GROW(*records, *n + 1, *capacity);
    struct contact_record *record = &(*records)[(*n)++];
    record->first_id = spheres->id[lower];
    record->second_id = spheres->id[turned ? list->first[k] : list->second[k]];
    for (int l = 0; l < CONTACT_LANES; l++)
        record->history[l] =
            has_lane(contacts, l) ? seen_from(turned, l, list->history[l][k]) : 0.0;
}

int contact_set_records(const struct contact_set *contacts, const struct spheres *spheres,
                        const unsigned char *chosen, struct contact_record **records,
                        int *capacity)
{
    const struct contact_list *list = &contacts->now;
    int n = 0;
    for (int k = 0; k < list->n; k++) {
        const int i = list->first[k], j = list->second[k], owned = spheres->n_owned;
        if (contact_touches(list, k) && ((i < owned && chosen[i]) || (j < owned && chosen[j])))
            add_record(contacts, spheres, k, &n, records, capacity);
    }
    return n;
}

int contact_set_records_of(const struct contact_set *contacts, const struct spheres *spheres,
                           int64_t begin, int64_t end, struct contact_record **records,
                           int *capacity)
{
    const struct contact_list *list = &contacts->now;
    int n = 0;
    for (int k = 0; k < list->n; k++) {
        const int lower = contact_touches(list, k) ? lower_of(list, spheres, k) : INT_MAX;
        if (lower < spheres->n_owned && spheres->id[lower] >= begin && spheres->id[lower] < end)
            add_record(contacts, spheres, k, &n, records, capacity);
    }
    return n;
}

int contact_set_count(const struct contact_set *contacts, const struct spheres *spheres)
{
    const struct contact_list *list = &contacts->now;
    int n = 0;
    for (int k = 0; k < list->n; k++)
        n += contact_touches(list, k) && lower_of(list, spheres, k) < spheres->n_owned;
    return n;
}

bool contact_set_restore(struct contact_set *contacts, const struct candidates *candidates,
                         const struct spheres *spheres, const struct contact_record *record,
                         int first, int second)
{
    return place_memory(contacts, candidates, spheres, first, second,
                        (struct memory){.history = record->history});
}
