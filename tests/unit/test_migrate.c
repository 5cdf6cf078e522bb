/* Migration: after any move every sphere has one owner, with all its fields, and every contact
 * is known to all owners of its spheres.
 *
 * ranks: 1 2 3
 */
#include "domain/migrate.h"

#include <stdlib.h>

#include "base/array.h"
#include "base/comm.h"
#include "check.h"
#include "contact/candidates.h"
#include "contact/facet_contact.h"
#include "domain/boxes.h"
#include "domain/halo.h"
#include "model/material.h"
#include "random_cloud.h"

enum { N = 300 };

static double density[1] = {2000.0};
static const struct materials materials = {.n = 1, .density = density};

/* What redistribution works on, and what every rank knows: where each sphere now is. */
struct run {
    struct comm comm;
    struct boxes boxes;
    struct spheres spheres;
    struct candidates candidates;
    struct contact_set contacts;
    struct facet_contacts facets;
    struct halo halo;
    struct migrate migrate;
    double x[N][3];
    bool gone[N];
    int64_t cell[N];
};

/* --------------------------------------------------------- values that depend on ids */

static double radius_of(int64_t id)
{
    return id % 40 == 0 ? 0.3 : 0.05 + 1e-4 * (double)id;
}

static bool touches(const struct run *run, int64_t a, int64_t b)
{
    double distance2 = 0.0;
    for (int k = 0; k < 3; k++)
        distance2 += (run->x[a][k] - run->x[b][k]) * (run->x[a][k] - run->x[b][k]);
    const double sum = radius_of(a) + radius_of(b);
    return distance2 < sum * sum;
}

/* The memory of a contact, from the lower id to the higher. */
static double memory_of(int64_t lower, int64_t higher, int lane)
{
    const double value = 1.0 + (double)(lower * N + higher) + 0.1 * lane;
    return contact_lane_turns(lane) && higher % 2 == 0 ? -value : value;
}

static bool holds_facet(int64_t id)
{
    return id % 3 == 0;
}

static double facet_memory_of(int64_t id, int lane)
{
    return (double)id + 0.25 * lane + 1.0;
}

/* ---------------------------------------------------------------------- redistribution */

/* Cuts that differ from round to round. */
static void cut(struct run *run, int round)
{
    int n[3] = {1, 1, 1};
    n[round % 3] = run->comm.n_ranks;
    const double off = 0.07 * (round % 5);
    const struct vec3 low = {off, -off, 0.5 * off}, high = {1.0 + off, 1.0 - off, 1.0 + off};
    boxes_set_grid(&run->boxes, n, low, high);
}

/* The lists for the present owners, as redistribution makes them. */
static void make_lists(struct run *run, const int *moved)
{
    struct spheres *spheres = &run->spheres;
    spheres_pad(spheres);
    for (int i = 0; i < spheres->n_all; i++)
        spheres->allowance[i] = 0.01;
    candidates_search(&run->candidates, spheres, false);
    contact_set_prune(&run->contacts, &run->candidates, spheres, 0.01, 0.0, true, moved);
}

static void restore_contacts(struct run *run)
{
    struct migrate *migrate = &run->migrate;
    for (int r = 0; r < migrate->n_contacts; r++) {
        const struct contact_record *record = &migrate->contacts[r];
        const int first = lookup_find(&migrate->lookup, record->first_id);
        const int second = lookup_find(&migrate->lookup, record->second_id);
        EXPECT(run->gone[record->first_id] || first >= 0);
        EXPECT(run->gone[record->second_id] || second >= 0);
        if (first >= 0 && second >= 0)
            EXPECT(contact_set_restore(&run->contacts, &run->candidates, &run->spheres, record,
                                       first, second));
    }
    migrate->n_contacts = 0;
}

static void restore_facets(struct run *run)
{
    struct migrate *migrate = &run->migrate;
    int *at = array_allocate((size_t)migrate->n_facets, sizeof *at);
    for (int r = 0; r < migrate->n_facets; r++) {
        at[r] = lookup_find(&migrate->lookup, migrate->facets[r].id);
        EXPECT(at[r] >= 0 && at[r] < run->spheres.n_owned);
    }
    facet_contacts_forget(&run->facets);
    facet_contacts_restore(&run->facets, migrate->n_facets, migrate->facets, at);
    free(at);
}

/* Moves, makes ghosts and lists, and puts back what arrived. */
static void redistribute(struct run *run, const unsigned char *removed, bool renew, bool first)
{
    struct spheres *spheres = &run->spheres;
    migrate_spheres(&run->migrate, &run->comm, &run->boxes, spheres,
                    first ? NULL : &run->contacts, &run->facets, &materials, removed, renew);
    halo_build(&run->halo, &run->comm, &run->boxes, spheres, &materials, 0.01);
    migrate_find_moved(&run->migrate, spheres);
    for (int i = 0; i < run->migrate.n_before; i++) {
        const int now = run->migrate.moved[i];
        EXPECT(now < 0 || spheres->id[now] == run->migrate.id_before[i]);
    }
    if (run->migrate.owned_moved)
        restore_facets(run);
    make_lists(run, run->migrate.moved);
    restore_contacts(run);
}

/* ---------------------------------------------------------------------- beginning */

static void place(struct run *run, int round)
{
    struct cloud_random dice = {(uint64_t)round + 1};
    for (int id = 0; id < N; id++) {
        for (int k = 0; k < 3; k++)
            run->x[id][k] = cloud_unit(&dice);
    }
}

/* Records of the pair contacts of ids first .. past - 1 come late, in two parts. */
static void follow(struct run *run, int first, int past)
{
    struct contact_record *records = NULL;
    int n = 0, capacity = 0;
    for (int a = 0; a < N; a++) {
        for (int b = a + 1; b < N; b++) {
            const bool here = (a >= first && a < past) || (b >= first && b < past);
            if (!here || !touches(run, a, b))
                continue;
            ARRAY_GROW(records, n + 1, capacity);
            records[n] = (struct contact_record){.first_id = a, .second_id = b};
            for (int l = 0; l < CONTACT_LANES; l++)
                records[n].history[l] = memory_of(a, b, l);
            n++;
        }
    }
    migrate_follow(&run->migrate, &run->comm, n / 3, records);
    restore_contacts(run);
    migrate_follow(&run->migrate, &run->comm, n - n / 3, records + n / 3);
    restore_contacts(run);
    free(records);
}

/* As after reading a checkpoint: a slice of the ids each, with all records that concern it. */
static void begin(struct run *run)
{
    *run = (struct run){.comm = comm_world()};
    const int first = N * run->comm.rank / run->comm.n_ranks;
    const int past = N * (run->comm.rank + 1) / run->comm.n_ranks;
    struct migrate *migrate = &run->migrate;
    boxes_init(&run->boxes, run->comm.n_ranks);
    spheres_init(&run->spheres);
    halo_init(&run->halo, &run->comm);
    migrate_init(migrate, &run->comm);
    facet_contacts_init(&run->facets, 1, ISA_AUTO);
    contact_set_init(&run->contacts, true, true);
    place(run, 0);
    for (int id = 0; id < N; id++)
        run->cell[id] = id * 7919 % 23;
    for (int id = first; id < past; id++) {
        const int i = cloud_add(&run->spheres, id, run->x[id], radius_of(id));
        for (int k = 0; k < 3; k++) {
            sphere_velocity(&run->spheres, i)[k] = id + 0.5 * k;
            sphere_angular_velocity(&run->spheres, i)[k] = id - 0.5 * k;
        }
        sphere_complete(&run->spheres, i, &materials);
    }
    for (int id = first; id < past; id++) {
        if (!holds_facet(id))
            continue;
        ARRAY_GROW(migrate->facets, migrate->n_facets + 1, migrate->facet_capacity);
        struct facet_contact_record *record = &migrate->facets[migrate->n_facets++];
        *record = (struct facet_contact_record){.id = id, .feature = 2};
        for (int l = 0; l < CONTACT_LANES; l++)
            record->history[l] = facet_memory_of(id, l);
    }
    cut(run, 0);
    redistribute(run, NULL, true, true);
    follow(run, first, past);
}

static void end(struct run *run)
{
    boxes_clear(&run->boxes);
    spheres_clear(&run->spheres);
    candidates_clear(&run->candidates);
    contact_set_clear(&run->contacts);
    facet_contacts_clear(&run->facets);
    halo_clear(&run->halo);
    migrate_clear(&run->migrate);
}

/* ---------------------------------------------------------------------- checks */

/* One owner each, where its box says, with all fields, in canonical order. */
static void expect_owners(const struct run *run)
{
    const struct spheres *spheres = &run->spheres;
    int64_t n = spheres->n_owned, n_here = 0;
    for (int id = 0; id < N; id++)
        n_here += !run->gone[id];
    comm_sum_int(&run->comm, &n, 1);
    EXPECT(n == n_here);
    for (int i = 0; i < spheres->n_owned; i++) {
        const int64_t id = spheres->id[i];
        struct spheres one;
        spheres_init(&one);
        cloud_add(&one, id, run->x[id], radius_of(id));
        one.order_cell[0] = run->cell[id];
        for (int k = 0; k < 3; k++) {
            sphere_velocity(&one, 0)[k] = (double)id + 0.5 * k;
            sphere_angular_velocity(&one, 0)[k] = (double)id - 0.5 * k;
        }
        sphere_complete(&one, 0, &materials);
        for (int f = 0; f < SPHERE_N_FIELDS; f++) {
            const struct field_view a = sphere_view(&one, f), b = sphere_view(spheres, f);
            if (memcmp(field_at(&a, 0), field_at(&b, i), field_size(&sphere_fields[f])) != 0)
                CHECK_FAIL("%s of sphere %d was lost", sphere_fields[f].name, (int)id);
        }
        EXPECT(memcmp(&one.spin[0], &spheres->spin[i], sizeof *one.spin) == 0);
        EXPECT(!run->gone[id] && boxes_owner(&run->boxes, run->x[id]) == run->comm.rank);
        EXPECT(i == 0 || order_before(spheres->order_cell[i - 1], spheres->id[i - 1],
                                      spheres->order_cell[i], id));
        spheres_clear(&one);
    }
}

/* Every contact of an owned sphere is here with its memory, and nothing else is. */
static void expect_memories(const struct run *run,
                            bool (*expected)(const struct run *, int, int))
{
    struct contact_record *records = NULL;
    int capacity = 0, n_expected = 0;
    unsigned char *all = array_allocate((size_t)run->spheres.n_owned, 1);
    memset(all, 1, (size_t)run->spheres.n_owned);
    const int n = contact_set_records(&run->contacts, &run->spheres, all, &records, &capacity);
    for (int a = 0; a < N; a++) {
        for (int b = a + 1; b < N; b++) {
            const bool mine = boxes_owner(&run->boxes, run->x[a]) == run->comm.rank ||
                              boxes_owner(&run->boxes, run->x[b]) == run->comm.rank;
            n_expected += mine && expected(run, a, b);
        }
    }
    EXPECT(n == n_expected);
    for (int r = 0; r < n; r++) {
        const struct contact_record *record = &records[r];
        EXPECT(expected(run, (int)record->first_id, (int)record->second_id));
        for (int l = 0; l < CONTACT_LANES; l++)
            EXPECT(record->history[l] == memory_of(record->first_id, record->second_id, l));
    }
    free(all);
    free(records);
}

static void expect_facet_memories(const struct run *run)
{
    struct facet_contact_record *records = NULL;
    const int n = facet_contacts_records(&run->facets, &run->spheres, 0, INT64_MAX, &records);
    int n_expected = 0;
    for (int i = 0; i < run->spheres.n_owned; i++)
        n_expected += holds_facet(run->spheres.id[i]);
    EXPECT(n == n_expected);
    for (int r = 0; r < n; r++) {
        EXPECT(holds_facet(records[r].id) && records[r].feature == 2);
        for (int l = 0; l < CONTACT_LANES; l++)
            EXPECT(records[r].history[l] == facet_memory_of(records[r].id, l));
    }
    free(records);
}

static bool lasts(const struct run *run, int a, int b)
{
    return !run->gone[a] && !run->gone[b] && touches(run, a, b);
}

static void check(const struct run *run)
{
    expect_owners(run);
    expect_memories(run, lasts);
    expect_facet_memories(run);
}

/* ---------------------------------------------------------------------- tests */

static struct run run;

TEST(from_slices_to_owners)
{
    begin(&run);
    check(&run);
    end(&run);
}

/* The cuts move over spheres that stay where they are. */
TEST(cuts_that_move)
{
    begin(&run);
    for (int round = 1; round < 12; round++) {
        cut(&run, round);
        redistribute(&run, NULL, false, false);
        check(&run);
        if (run.comm.n_ranks > 1 && round % 3 == 1) {
            int64_t n = run.migrate.n_left;
            comm_sum_int(&run.comm, &n, 1);
            EXPECT(n > 10);
        }
    }
    end(&run);
}

TEST(nothing_moves)
{
    begin(&run);
    redistribute(&run, NULL, false, false);
    EXPECT(!run.migrate.owned_moved && run.migrate.n_left == 0);
    check(&run);
    end(&run);
}

/* Cells change and with them the order: many a contact is turned round. */
TEST(renewed_order)
{
    begin(&run);
    for (int round = 1; round < 6; round++) {
        for (int id = 0; id < N; id++)
            run.cell[id] = id * (7919 + 100 * round) % (17 + round);
        for (int i = 0; i < run.spheres.n_owned; i++)
            run.spheres.order_cell[i] = run.cell[run.spheres.id[i]];
        cut(&run, round / 2);
        redistribute(&run, NULL, true, false);
        check(&run);
    }
    end(&run);
}

/* Spheres leave the run while they touch others, some of which move to another rank. */
TEST(removed_spheres)
{
    begin(&run);
    for (int round = 1; round < 5; round++) {
        unsigned char *removed = array_allocate((size_t)run.spheres.n_owned, 1);
        for (int i = 0; i < run.spheres.n_owned; i++)
            removed[i] = run.spheres.id[i] % 7 == round;
        for (int id = 0; id < N; id++)
            run.gone[id] = run.gone[id] || id % 7 == round;
        cut(&run, round);
        redistribute(&run, removed, false, false);
        free(removed);
        check(&run);
    }
    end(&run);
}

/* Everybody goes to one rank, which leaves the others empty, and back. */
TEST(empty_ranks)
{
    begin(&run);
    for (int round = 0; round < 4; round++) {
        const double far = round % 2 == 0 ? 100.0 : 0.0;
        const int n[3] = {run.comm.n_ranks, 1, 1};
        const struct vec3 low = {far, 0.0, 0.0}, high = {far + 1.0, 1.0, 1.0};
        boxes_set_grid(&run.boxes, n, low, high);
        redistribute(&run, NULL, false, false);
        check(&run);
        if (round % 2 == 0)
            EXPECT(run.spheres.n_owned == (run.comm.rank == 0 ? N : 0));
    }
    end(&run);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const int status = check_run(argc, argv);
    MPI_Finalize();
    return status;
}
