/*
 * See contact_set.h.  History is carried from one list to the next by finding each touching
 * contact's pair in the row of its first sphere: rows are short, and an ordinary search moves
 * nothing in memory.
 */
#include "contact/contact_set.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "contact/candidates.h"
#include "model/sphere.h"

static void list_clear(struct contact_list *list)
{
    free(list->first);
    free(list->second);
    for (int l = 0; l < CONTACT_LANES; l++)
        free(list->history[l]);
    *list = (struct contact_list){0};
}

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
    list_clear(&contacts->now);
    list_clear(&contacts->before);
    free(contacts->row_begin);
    free(contacts->row_end);
    *contacts = (struct contact_set){0};
}

/* Capacity for n entries, the padding and what kernels look ahead; 0: there is room. */
static size_t capacity_for(int n, int capacity)
{
    const int needed = n + CONTACT_PAD + CONTACT_AHEAD;
    return needed <= capacity
               ? 0
               : array_capacity((size_t)capacity, (size_t)needed + (size_t)needed / 8);
}

/* Room for the pairs of n entries; contents are lost. */
static void list_reserve_pairs(struct contact_list *list, int n)
{
    const size_t capacity = capacity_for(n, list->capacity);
    if (capacity == 0)
        return;
    free(list->first);
    free(list->second);
    list->capacity = (int)capacity;
    list->first = array_allocate_rows(capacity, sizeof(int));
    list->second = array_allocate_rows(capacity, sizeof(int));
}

/* Room for the history of n entries; contents are lost. */
static void list_reserve_history(const struct contact_set *contacts, struct contact_list *list,
                                 int n)
{
    const size_t capacity = capacity_for(n, list->history_capacity);
    if (capacity == 0)
        return;
    list->history_capacity = (int)capacity;
    for (int l = 0; l < CONTACT_LANES; l++) {
        if (!has_lane(contacts, l))
            continue;
        free(list->history[l]);
        list->history[l] = array_allocate_rows(capacity, sizeof(double));
    }
}

static void list_pad(struct contact_set *contacts, int dummy)
{
    struct contact_list *list = &contacts->now;
    list->n_padded = (list->n + CONTACT_PAD - 1) / CONTACT_PAD * CONTACT_PAD;
    for (int k = list->n; k < list->n_padded + CONTACT_AHEAD; k++) {
        list->first[k] = dummy;
        list->second[k] = dummy + 1;
    }
    for (int l = 0; l < CONTACT_LANES; l++) {
        for (int k = list->n; has_lane(contacts, l) && k < list->n_padded; k++)
            list->history[l][k] = 0.0;
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
        for (int k = begin; k < candidates->row_end[place]; k++) {
            const int j = candidates->second[k];
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
    list_reserve_history(contacts, list, n);
    for (int l = 0; l < CONTACT_LANES; l++) {
        for (int k = 0; has_lane(contacts, l) && k < n; k++)
            list->history[l][k] = 0.0;
    }
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

/* Writes the history where the two are listed; false where they are not. */
static bool place_between(struct contact_set *contacts, const struct candidates *candidates,
                          int first, int second, const double history[CONTACT_LANES])
{
    const bool turned = candidates->place[first] > candidates->place[second];
    const int entry = turned ? find_entry(contacts, candidates, second, first)
                             : find_entry(contacts, candidates, first, second);
    if (entry < 0)
        return false;
    for (int l = 0; l < CONTACT_LANES; l++)
        if (has_lane(contacts, l))
            contacts->now.history[l][entry] = seen_from(turned, l, history[l]);
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

/* Writes the history between each owned copy of `first` and the copy of `second` that is
 * nearest to it: periods are so long that no other touches. */
static bool place_copies(struct contact_set *contacts, const struct candidates *candidates,
                         const struct spheres *spheres, int first, int second, bool turned,
                         const double history[CONTACT_LANES])
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
        if (i < spheres->n_owned && place_between(contacts, candidates, turned ? nearest : i,
                                                  turned ? i : nearest, history))
            placed = true;
    }
    return placed;
}

static void place_history(struct contact_set *contacts, const struct candidates *candidates,
                          const struct spheres *spheres, int first, int second,
                          const double history[CONTACT_LANES])
{
    bool placed;
    if (spheres->periodic.any) {
        placed = place_copies(contacts, candidates, spheres, first, second, false, history);
        placed =
            place_copies(contacts, candidates, spheres, second, first, true, history) || placed;
    } else {
        placed = place_between(contacts, candidates, first, second, history);
    }
    CHECK(placed, "a touching contact is not in the list");
}

static void carry_history(struct contact_set *contacts, const struct candidates *candidates,
                          const struct spheres *spheres, const int *moved)
{
    const struct contact_list *before = &contacts->before;
    for (int k = 0; k < before->n; k++) {
        if (!contact_touches(before, k))
            continue;
        const int first = moved == NULL ? before->first[k] : moved[before->first[k]];
        const int second = moved == NULL ? before->second[k] : moved[before->second[k]];
        /* Contacts between what others own now are theirs to remember. */
        if (first < 0 || second < 0 ||
            (first >= spheres->n_owned && second >= spheres->n_owned))
            continue;
        double history[CONTACT_LANES];
        for (int l = 0; l < CONTACT_LANES; l++)
            history[l] = has_lane(contacts, l) ? before->history[l][k] : 0.0;
        place_history(contacts, candidates, spheres, first, second, history);
    }
}

void contact_set_prune(struct contact_set *contacts, const struct candidates *candidates,
                       struct spheres *spheres, double base, double horizon, bool keep_all,
                       const int *moved)
{
    const struct contact_list swap = contacts->before;
    contacts->before = contacts->now;
    contacts->now = swap;
    list_reserve_pairs(&contacts->now, candidates->n);
    if (spheres->n_all > contacts->row_capacity) {
        const size_t capacity =
            array_capacity((size_t)contacts->row_capacity, (size_t)spheres->n_all);
        free(contacts->row_begin);
        free(contacts->row_end);
        contacts->row_begin = array_allocate_rows(capacity, sizeof(int));
        contacts->row_end = array_allocate_rows(capacity, sizeof(int));
        contacts->row_capacity = (int)capacity;
    }
    double *inner = array_allocate((size_t)spheres->n_all, sizeof *inner);
    choose_allowances(spheres, inner, base, horizon, keep_all);
    select_pairs(contacts, candidates, spheres, inner, keep_all);
    list_pad(contacts, spheres->n_all);
    carry_history(contacts, candidates, spheres, moved);
    free(inner);
}

int contact_set_records(const struct contact_set *contacts, const struct spheres *spheres,
                        const unsigned char *chosen, struct contact_record **records,
                        int *capacity)
{
    const struct contact_list *list = &contacts->now;
    int n = 0;
    for (int k = 0; k < list->n; k++) {
        if (!contact_touches(list, k))
            continue;
        const int i = list->first[k], j = list->second[k];
        const bool turned = spheres->id[i] > spheres->id[j];
        const int lower = turned ? j : i, owned = spheres->n_owned;
        const bool wanted = chosen == NULL
                                ? lower < owned
                                : (i < owned && chosen[i]) || (j < owned && chosen[j]);
        if (!wanted)
            continue;
        ARRAY_GROW(*records, n + 1, *capacity);
        struct contact_record *record = &(*records)[n++];
        record->first_id = spheres->id[lower];
        record->second_id = spheres->id[turned ? i : j];
        for (int l = 0; l < CONTACT_LANES; l++)
            record->history[l] =
                has_lane(contacts, l) ? seen_from(turned, l, list->history[l][k]) : 0.0;
    }
    return n;
}

void contact_set_restore(struct contact_set *contacts, const struct candidates *candidates,
                         const struct spheres *spheres, const struct contact_record *record,
                         int first, int second)
{
    place_history(contacts, candidates, spheres, first, second, record->history);
}
