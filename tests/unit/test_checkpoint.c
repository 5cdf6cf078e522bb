/* Checkpoints: the same bytes from any number of ranks, the same state on any number of
 * ranks, and every damage noticed.  ranks: 1 2 3 5 / */
#include "store/checkpoint.h"

#include <math.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "check.h"
#include "model/sphere.h"
#include "store/file.h"
#include "store/h5.h"

enum { N_IDS = 1700, N_MONITORS = 3 };

/* ------------------------------------------------------------------------------- a state to
 * be saved */

/* Every fifth id is gone, as after removals; the rest are dealt out like cards. */
static bool exists(int64_t id)
{
    return id % 5 != 3;
}

static int owner(const struct comm *comm, int64_t id)
{
    return (int)(id * 2654435761 % 4294967296 / 7 % comm->n_ranks);
}

/* Some number that depends on sphere, field and component. */
static double value(int64_t id, int field, int component)
{
    return ((double)id + 0.1 * field) / (3.0 + component) - 7.0 * (field % 2);
}

static bool touches(int64_t first, int64_t second)
{
    return exists(first) && exists(second) && second < N_IDS;
}

static void fill_history(double *history, int64_t id)
{
    for (int l = 0; l < CONTACT_LANES; l++)
        history[l] = l == CONTACT_RADIUS_LANE ? 1e-3 + 1e-6 * (double)id : value(id, 20, l);
}

static void set_field(const struct spheres *spheres, int field, int i, int64_t id)
{
    const struct field_view view = sphere_view(spheres, field);
    for (int k = 0; k < sphere_fields[field].width; k++) {
        const double x = value(id, field, k);
        if (sphere_fields[field].type == FIELD_DOUBLE)
            ((double *)field_at(&view, i))[k] = x;
        else if (sphere_fields[field].type == FIELD_INT64)
            ((int64_t *)field_at(&view, i))[k] = (int64_t)(1e6 * x);
        else
            ((int32_t *)field_at(&view, i))[k] = (int32_t)(id % 3);
    }
}

static void build_spheres(struct spheres *spheres, const struct comm *comm)
{
    spheres_init(spheres);
    for (int64_t id = N_IDS - 1; id >= 0; id--) {
        if (!exists(id) || owner(comm, id) != comm->rank)
            continue;
        const int i = spheres->n_owned++;
        spheres_reserve(spheres, spheres->n_owned);
        for (int f = 0; f < SPHERE_N_FIELDS; f++)
            set_field(spheres, f, i, id);
        spheres->id[i] = id;
        spheres->motion[i].lane[3] = 0.1 + 1e-5 * (double)id;
    }
    spheres->n_all = spheres->n_owned;
    spheres_pad(spheres);
}

static void add_notes(struct checkpoint *checkpoint)
{
    const double reals[] = {1.5, -0.0, 1e-300};
    const int64_t ints[] = {INT64_MIN, 7};
    notes_add(&checkpoint->notes, "piston.state", 3, reals);
    notes_add_ints(&checkpoint->notes, "insertion-1", 2, ints);
}

static int pairs_of(const void *from, int64_t begin, int64_t end,
                    struct contact_record **records)
{
    const struct spheres *spheres = ((const struct checkpoint *)from)->spheres;
    int n = 0;
    *records = array_allocate(2 * (size_t)spheres->n_owned, sizeof **records);
    for (int i = 0; i < spheres->n_owned; i++) {
        const int64_t id = spheres->id[i];
        for (int64_t other = id + 1; other <= id + 1600; other += 1599) {
            if (id < begin || id >= end || !touches(id, other))
                continue;
            (*records)[n] = (struct contact_record){.first_id = id, .second_id = other};
            fill_history((*records)[n++].history, id);
        }
    }
    return n;
}

static int facets_of(const void *from, int64_t begin, int64_t end,
                     struct facet_contact_record **records)
{
    const struct checkpoint *all = from;
    int n = 0;
    *records = array_allocate((size_t)all->n_facet_contacts, sizeof **records);
    for (int k = 0; k < all->n_facet_contacts; k++)
        if (all->facet_contacts[k].id >= begin && all->facet_contacts[k].id < end)
            (*records)[n++] = all->facet_contacts[k];
    return n;
}

static void build(struct checkpoint *checkpoint, struct spheres *spheres,
                  const struct comm *comm)
{
    build_spheres(spheres, comm);
    *checkpoint =
        (struct checkpoint){.step = 1234, .dt = 1e-5, .next_id = N_IDS, .spheres = spheres};
    checkpoint->title = array_string("A heap of \xc3\xa9tain");
    checkpoint->job_text = array_string("title: test\ntime: {end: 1}\n");
    checkpoint->full = checkpoint->ledger = checkpoint->removals = true;
    checkpoint->facet_contacts = array_allocate(2 * N_IDS, sizeof *checkpoint->facet_contacts);
    for (int64_t id = 0; id < N_IDS; id++) {
        if (!exists(id) || owner(comm, id) != comm->rank)
            continue;
        checkpoint->n_contacts += touches(id, id + 1) + touches(id, id + 1600);
        for (int body = 0; id % 7 == 0 && body < 2; body++) {
            struct facet_contact_record *record =
                &checkpoint->facet_contacts[checkpoint->n_facet_contacts++];
            *record = (struct facet_contact_record){.id = id, .body = 1 - body, .feature = 4};
            fill_history(record->history, id);
        }
    }
    checkpoint->held = (struct checkpoint_contacts){checkpoint, pairs_of, facets_of};
    checkpoint->n_monitors = N_MONITORS;
    checkpoint->monitors = array_allocate(N_MONITORS, sizeof *checkpoint->monitors);
    for (int k = 0; k < N_MONITORS; k++)
        (void)snprintf(checkpoint->monitors[k].name, CHECKPOINT_NAME_SIZE, "monitor %d", k);
    for (int i = 0; i < spheres->n_owned; i++)
        for (int k = 0; k < N_MONITORS; k++)
            exact_sum_add(&checkpoint->monitors[k].sum, value(spheres->id[i], 30, k));
    add_notes(checkpoint);
}

static void clear(struct checkpoint *checkpoint, struct spheres *spheres)
{
    checkpoint_clear(checkpoint);
    spheres_clear(spheres);
}

/* ---------------------------------------------------------------------------------- helpers */

/* A path in the scratch folder, the same on all ranks. */
static char *scratch(const struct comm *comm, const char *name)
{
    static int pid;
    if (pid == 0) {
        pid = (int)getpid();
        MPI_Bcast(&pid, 1, MPI_INT, 0, comm->mpi);
    }
    const char *folder = getenv("SCRATCH");
    return array_format("%s/%d_%s", folder != NULL ? folder : "/tmp", pid, name);
}

static struct comm alone(void)
{
    return (struct comm){.mpi = MPI_COMM_SELF, .rank = 0, .n_ranks = 1};
}

static int write_state(const struct comm *comm, const char *path)
{
    struct checkpoint checkpoint;
    struct spheres spheres;
    build(&checkpoint, &spheres, comm);
    const int status = checkpoint_write(comm, path, &checkpoint);
    clear(&checkpoint, &spheres);
    return status;
}

static unsigned char *bytes_of(const char *path, size_t *n)
{
    struct stat state;
    *n = 0;
    FILE *stream = fopen(path, "rb");
    if (stream == NULL || fstat(fileno(stream), &state) != 0)
        return array_allocate(1, 1);
    unsigned char *bytes = array_allocate((size_t)state.st_size, 1);
    *n = fread(bytes, 1, (size_t)state.st_size, stream);
    fclose(stream);
    return bytes;
}

static bool same_files(const char *a, const char *b)
{
    size_t n_a, n_b;
    unsigned char *bytes_a = bytes_of(a, &n_a), *bytes_b = bytes_of(b, &n_b);
    const bool same = n_a > 0 && n_a == n_b && memcmp(bytes_a, bytes_b, n_a) == 0;
    free(bytes_a);
    free(bytes_b);
    return same;
}

static void put_bytes(const char *path, const unsigned char *bytes, size_t n)
{
    char *why = file_write(path, bytes, n);
    EXPECT(why == NULL);
    free(why);
}

struct pairs {
    int n, capacity;
    struct contact_record *records;
};

static void take_pairs(void *into, int n, struct contact_record *records)
{
    struct pairs *pairs = into;
    ARRAY_GROW(pairs->records, pairs->n + n, pairs->capacity);
    for (int k = 0; k < n; k++)
        pairs->records[pairs->n++] = records[k];
}

/* Are these pairs those that this checkpoint has, by first and second id? */
static bool same_pairs(const struct checkpoint *checkpoint, const struct pairs *pairs)
{
    struct contact_record *expected;
    const int n = pairs_of(checkpoint, 0, INT64_MAX, &expected);
    const bool same =
        n == pairs->n && memcmp(pairs->records, expected, (size_t)n * sizeof *expected) == 0;
    free(expected);
    return same;
}

/* Reads on this process alone; is the state that of build()? */
static int read_alone(const char *path, bool *same)
{
    const struct comm self = alone();
    struct checkpoint was, is = {.full = true, .ledger = true, .removals = true};
    struct spheres spheres_was, spheres_is;
    build(&was, &spheres_was, &self);
    spheres_init(&spheres_is);
    is.spheres = &spheres_is;
    int status = checkpoint_read(&self, path, &is);
    struct pairs pairs = {0};
    if (status == REPORT_FINISHED)
        status = checkpoint_read_contacts(&self, path, &is, take_pairs, &pairs);
    *same = status == REPORT_FINISHED && is.step == was.step && is.dt == was.dt &&
            is.next_id == was.next_id && strcmp(is.title, was.title) == 0 &&
            strcmp(is.job_text, was.job_text) == 0 && pairs.n == was.n_contacts &&
            spheres_is.n_owned == spheres_was.n_owned && same_pairs(&is, &pairs) &&
            is.n_facet_contacts == was.n_facet_contacts &&
            notes_checksum(&is.notes) == notes_checksum(&was.notes);
    for (int i = 0; *same && i < spheres_is.n_owned; i++) {
        const int j = spheres_was.n_owned - 1 - i;
        for (int f = 0; f < SPHERE_N_FIELDS; f++) {
            const struct field_view a = sphere_view(&spheres_is, f),
                                    b = sphere_view(&spheres_was, f);
            *same = *same && memcmp(field_at(&a, i), field_at(&b, j),
                                    field_size(&sphere_fields[f])) == 0;
        }
    }
    free(pairs.records);
    clear(&was, &spheres_was);
    clear(&is, &spheres_is);
    return status;
}

/* ------------------------------------------------------------------------------------ tests */

TEST(bytes_do_not_depend_on_ranks)
{
    const struct comm comm = comm_world(), self = alone();
    char *many = scratch(&comm, "many.h5"), *again = scratch(&comm, "again.h5");
    char *one = scratch(&comm, "one.h5");
    EXPECT(write_state(&comm, many) == REPORT_FINISHED);
    EXPECT(write_state(&comm, again) == REPORT_FINISHED);
    if (comm.rank == 0) {
        EXPECT(write_state(&self, one) == REPORT_FINISHED);
        EXPECT(same_files(many, one));
        EXPECT(same_files(many, again));
        bool same;
        EXPECT(read_alone(many, &same) == REPORT_FINISHED && same);
    }
    comm_barrier(&comm);
    free(many);
    free(again);
    free(one);
}

static bool owns(const struct spheres *spheres, int64_t id)
{
    for (int i = 0; i < spheres->n_owned; i++)
        if (spheres->id[i] == id)
            return true;
    return false;
}

/* Contacts that this rank must have been given: those of build() with an owned end. */
static int n_contacts_of(const struct spheres *spheres)
{
    int n = 0;
    for (int64_t id = 0; id < N_IDS; id++)
        for (int64_t other = id + 1; other <= id + 1600; other += 1599)
            n += touches(id, other) && (owns(spheres, id) || owns(spheres, other));
    return n;
}

static void expect_contacts(const struct checkpoint *checkpoint, const struct pairs *pairs)
{
    const struct spheres *spheres = checkpoint->spheres;
    EXPECT(pairs->n == n_contacts_of(spheres));
    for (int k = 0; k < pairs->n; k++) {
        const struct contact_record *record = &pairs->records[k];
        double history[CONTACT_LANES];
        fill_history(history, record->first_id);
        EXPECT(owns(spheres, record->first_id) || owns(spheres, record->second_id));
        EXPECT(memcmp(history, record->history, sizeof history) == 0);
    }
    int n_facet_contacts = 0;
    for (int i = 0; i < spheres->n_owned; i++)
        n_facet_contacts += spheres->id[i] % 7 == 0 ? 2 : 0;
    EXPECT(checkpoint->n_facet_contacts == n_facet_contacts);
    for (int k = 0; k < checkpoint->n_facet_contacts; k++) {
        const struct facet_contact_record *record = &checkpoint->facet_contacts[k];
        EXPECT(owns(spheres, record->id) && record->body == k % 2 && record->feature == 4);
    }
}

TEST(state_returns)
{
    const struct comm comm = comm_world();
    char *path = scratch(&comm, "state.h5");
    EXPECT(write_state(&comm, path) == REPORT_FINISHED);
    struct spheres spheres, expected;
    spheres_init(&spheres);
    spheres_init(&expected);
    spheres_reserve(&expected, 1);
    struct checkpoint checkpoint = {
        .spheres = &spheres, .full = true, .ledger = true, .removals = true};
    EXPECT(checkpoint_read(&comm, path, &checkpoint) == REPORT_FINISHED);
    EXPECT(checkpoint.step == 1234 && checkpoint.dt == 1e-5 && checkpoint.next_id == N_IDS);
    EXPECT_STRING(checkpoint.job_text, "title: test\ntime: {end: 1}\n");
    int64_t n = spheres.n_owned, n_expected = 0;
    comm_sum_int(&comm, &n, 1);
    for (int64_t id = 0; id < N_IDS; id++)
        n_expected += exists(id);
    EXPECT(n == n_expected && spheres.n_all == spheres.n_owned);
    for (int i = 0; i < spheres.n_owned; i++) {
        EXPECT(sphere_position(&spheres, i)[2] == value(spheres.id[i], SPHERE_POSITION, 2));
        EXPECT(sphere_angular_velocity(&spheres, i)[1] ==
               value(spheres.id[i], SPHERE_ANGULAR_VELOCITY, 1));
        EXPECT(sphere_radius(&spheres, i) == 0.1 + 1e-5 * (double)spheres.id[i]);
        EXPECT(i == 0 || spheres.id[i] > spheres.id[i - 1]);
    }
    struct pairs pairs = {0};
    EXPECT(checkpoint_read_contacts(&comm, path, &checkpoint, take_pairs, &pairs) ==
           REPORT_FINISHED);
    expect_contacts(&checkpoint, &pairs);
    free(pairs.records);
    clear(&checkpoint, &spheres);
    spheres_clear(&expected);
    free(path);
}

TEST(monitors_are_totals)
{
    const struct comm comm = comm_world(), self = alone();
    char *path = scratch(&comm, "monitors.h5");
    EXPECT(write_state(&comm, path) == REPORT_FINISHED);
    struct spheres spheres, all_spheres;
    spheres_init(&spheres);
    struct checkpoint checkpoint = {.spheres = &spheres,
                                    .full = true,
                                    .ledger = true,
                                    .removals = true},
                      all;
    build(&all, &all_spheres, &self);
    EXPECT(checkpoint_read(&comm, path, &checkpoint) == REPORT_FINISHED);
    EXPECT(checkpoint.n_monitors == N_MONITORS);
    for (int k = 0; k < checkpoint.n_monitors; k++) {
        struct exact_sum total = checkpoint.monitors[k].sum;
        EXPECT(comm.rank == 0 || exact_sum_value(&total) == 0.0);
        exact_sum_reduce(&comm, &total, 1);
        exact_sum_normalise(&all.monitors[k].sum);
        EXPECT(memcmp(&total, &all.monitors[k].sum, sizeof total) == 0);
        EXPECT_STRING(checkpoint.monitors[k].name, all.monitors[k].name);
    }
    clear(&checkpoint, &spheres);
    clear(&all, &all_spheres);
    free(path);
}

TEST(notes_return)
{
    const struct comm comm = comm_world();
    char *path = scratch(&comm, "notes.h5");
    EXPECT(write_state(&comm, path) == REPORT_FINISHED);
    struct spheres spheres;
    spheres_init(&spheres);
    struct checkpoint checkpoint = {
        .spheres = &spheres, .full = true, .ledger = true, .removals = true};
    EXPECT(checkpoint_read(&comm, path, &checkpoint) == REPORT_FINISHED);
    double reals[3], no_reals[2];
    int64_t ints[2], no_ints[3];
    EXPECT(notes_take(&checkpoint.notes, "piston.state", 3, reals));
    EXPECT(reals[0] == 1.5 && reals[1] == 0.0 && signbit(reals[1]) && reals[2] == 1e-300);
    EXPECT(notes_take_ints(&checkpoint.notes, "insertion-1", 2, ints));
    EXPECT(ints[0] == INT64_MIN && ints[1] == 7);
    report_init(false); /* each of these says what is missing */
    EXPECT(!notes_take(&checkpoint.notes, "piston", 3, reals));
    EXPECT(!notes_take(&checkpoint.notes, "piston.state", 2, no_reals));
    EXPECT(!notes_take_ints(&checkpoint.notes, "piston.state", 3, no_ints));
    report_init(comm.rank == 0);
    clear(&checkpoint, &spheres);
    free(path);
}

TEST(header_alone)
{
    const struct comm comm = comm_world();
    char *path = scratch(&comm, "header.h5");
    EXPECT(write_state(&comm, path) == REPORT_FINISHED);
    struct checkpoint checkpoint;
    char *why;
    EXPECT(checkpoint_read_header(path, &checkpoint, &why) && why == NULL);
    EXPECT(checkpoint.step == 1234 && checkpoint.dt == 1e-5);
    EXPECT_STRING(checkpoint.title, "A heap of \xc3\xa9tain");
    checkpoint_clear(&checkpoint);
    EXPECT(!checkpoint_read_header("/nowhere/at/all.h5", &checkpoint, &why));
    EXPECT(why != NULL && strstr(why, "No such file") != NULL);
    free(why);
    free(path);
}

TEST(nothing_at_all)
{
    const struct comm comm = comm_world();
    char *path = scratch(&comm, "empty.h5");
    struct spheres spheres;
    spheres_init(&spheres);
    char title[] = "", job[] = "";
    struct checkpoint checkpoint = {.dt = 1.0,
                                    .spheres = &spheres,
                                    .full = true,
                                    .ledger = true,
                                    .title = title,
                                    .job_text = job};
    checkpoint.held = (struct checkpoint_contacts){&checkpoint, pairs_of, facets_of};
    EXPECT(checkpoint_write(&comm, path, &checkpoint) == REPORT_FINISHED);
    struct checkpoint read = {.spheres = &spheres, .full = true, .ledger = true};
    EXPECT(checkpoint_read(&comm, path, &read) == REPORT_FINISHED);
    struct pairs pairs = {0};
    EXPECT(checkpoint_read_contacts(&comm, path, &read, take_pairs, &pairs) == REPORT_FINISHED);
    EXPECT(spheres.n_owned == 0 && pairs.n == 0 && read.n_monitors == 0);
    free(pairs.records);
    EXPECT_STRING(read.job_text, "");
    clear(&read, &spheres);
    free(path);
}

/* Reads on all ranks what must be refused. */
static void expect_refused(const struct comm *comm, const char *path)
{
    struct spheres spheres;
    spheres_init(&spheres);
    struct checkpoint checkpoint = {
        .spheres = &spheres, .full = true, .ledger = true, .removals = true};
    struct pairs pairs = {0};
    report_init(false);
    const int status = checkpoint_read(comm, path, &checkpoint);
    if (status == REPORT_FINISHED)
        EXPECT(checkpoint_read_contacts(comm, path, &checkpoint, take_pairs, &pairs) ==
               REPORT_STORAGE);
    else
        EXPECT(status == REPORT_STORAGE && spheres.n_owned == 0 && checkpoint.title == NULL);
    report_init(comm->rank == 0);
    free(pairs.records);
    clear(&checkpoint, &spheres);
}

TEST(bad_files_are_refused)
{
    const struct comm comm = comm_world();
    char *good = scratch(&comm, "good.h5"), *bad = scratch(&comm, "bad.h5");
    EXPECT(write_state(&comm, good) == REPORT_FINISHED);
    size_t n;
    unsigned char *bytes = bytes_of(good, &n);
    const size_t lengths[] = {0, 7, 40, 1000, n / 2, n - 4096, n - 1};
    for (size_t k = 0; k < sizeof lengths / sizeof *lengths; k++) {
        if (comm.rank == 0)
            put_bytes(bad, bytes, lengths[k]);
        comm_barrier(&comm);
        expect_refused(&comm, bad);
    }
    expect_refused(&comm, "/nowhere/at/all.h5");
    expect_refused(&comm, "/tmp");
    /* One bit in the last block of rows, which only one rank reads. */
    bytes[n / 2] ^= 16;
    if (comm.rank == 0)
        put_bytes(bad, bytes, n);
    comm_barrier(&comm);
    expect_refused(&comm, bad);
    free(bytes);
    free(good);
    free(bad);
}

TEST(flipped_bits_are_noticed)
{
    const struct comm comm = comm_world();
    char *good = scratch(&comm, "whole.h5"), *bad = scratch(&comm, "flipped.h5");
    EXPECT(write_state(&comm, good) == REPORT_FINISHED);
    size_t n;
    unsigned char *bytes = bytes_of(good, &n);
    report_init(false);
    for (uint64_t k = 0; comm.rank == 0 && k < 150; k++) {
        /* A third of them in the first kilobytes, where metadata are. */
        const uint64_t random = (k + 1) * 0x9E3779B97F4A7C15u;
        const size_t at = (size_t)(random >> 20) % (k % 3 == 0 ? 6000 : n);
        const unsigned char bit = (unsigned char)(1u << (random >> 60 & 7));
        bytes[at] ^= bit;
        put_bytes(bad, bytes, n);
        bytes[at] ^= bit;
        bool same;
        EXPECT(read_alone(bad, &same) == REPORT_STORAGE || same);
    }
    report_init(comm.rank == 0);
    comm_barrier(&comm);
    free(bytes);
    free(good);
    free(bad);
}

TEST(newer_format_is_named)
{
    const struct comm comm = comm_world();
    char *path = scratch(&comm, "newer.h5");
    if (comm.rank == 0) {
        struct h5 h5;
        h5_create(&h5, path);
        h5_group(&h5, "/run");
        h5_put_text(&h5, "/run", "format", "tremie checkpoint");
        h5_put_int(&h5, "/run", "format_version", CHECKPOINT_FORMAT_VERSION + 1);
        h5_save(&h5, path);
        EXPECT(h5.why == NULL);
        free(h5.why);
    }
    comm_barrier(&comm);
    struct checkpoint checkpoint;
    char *why;
    EXPECT(!checkpoint_read_header(path, &checkpoint, &why));
    EXPECT(why != NULL && strstr(why, "format version is 6") != NULL);
    free(why);
    expect_refused(&comm, path);
    free(path);
}

TEST(what_cannot_be_written_leaves_the_old_file)
{
    const struct comm comm = comm_world();
    char *path = scratch(&comm, "limited.h5"), *copy = scratch(&comm, "copy.h5");
    char *temporary = file_temporary(path, "");
    EXPECT(write_state(&comm, path) == REPORT_FINISHED);
    EXPECT(write_state(&comm, copy) == REPORT_FINISHED);
    struct rlimit was, small;
    getrlimit(RLIMIT_FSIZE, &was);
    small = was;
    report_init(false);
    for (small.rlim_cur = 1; small.rlim_cur < 200000; small.rlim_cur += 66000) {
        setrlimit(RLIMIT_FSIZE, &small);
        EXPECT(write_state(&comm, path) == REPORT_STORAGE);
        setrlimit(RLIMIT_FSIZE, &was);
        comm_barrier(&comm); /* rank 0 tidies up */
        EXPECT(access(temporary, F_OK) != 0);
        EXPECT(same_files(path, copy));
    }
    EXPECT(write_state(&comm, "/nowhere/at/all.h5") == REPORT_STORAGE);
    report_init(comm.rank == 0);
    free(path);
    free(copy);
    free(temporary);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const struct comm comm = comm_world();
    report_init(comm.rank == 0);
    const int failed = check_run(argc, argv);
    MPI_Finalize();
    return failed;
}
