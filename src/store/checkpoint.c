/*
 * See checkpoint.h.
 *
 * Written as store/shared_file.h says.
 *
 * Metadata carry HDF5's own checksums, rows those of store/table.h, the rest an attribute
 * `checksum`.  A drawback: the reserved space must be there beside the older checkpoints.
 */
#include "store/checkpoint.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "model/sphere.h"
#include "store/crc32.h"
#include "store/file.h"
#include "store/h5.h"
#include "store/shared_file.h"
#include "store/table.h"

static const char FORMAT[] = "tremie checkpoint";

enum { SPHERES, CONTACTS, FACET_CONTACTS, N_KINDS, N_TABLES = N_KINDS + CHECKPOINT_MORE };

static const struct field SUMS = {"sums",
                                  "1",
                                  "limbs of 2^10, 2^-30 and 2^-70, terms, overflows",
                                  FIELD_INT64,
                                  sizeof(struct exact_sum) / sizeof(int64_t),
                                  0};

/* ----------------------------------------------------------------------------------- tables */

static int compare_int64(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

static int compare_spheres(const void *a, const void *b)
{
    int64_t ids[2];
    memcpy(&ids[0], a, sizeof ids[0]);
    memcpy(&ids[1], b, sizeof ids[1]);
    return compare_int64(ids[0], ids[1]);
}

static int compare_contacts(const void *a, const void *b)
{
    const struct contact_record *p = a, *q = b;
    const int by_first = compare_int64(p->first_id, q->first_id);
    return by_first != 0 ? by_first : compare_int64(p->second_id, q->second_id);
}

static int compare_facet_contacts(const void *a, const void *b)
{
    const struct facet_contact_record *p = a, *q = b;
    const int by_id = compare_int64(p->id, q->id);
    const int by_body = compare_int64(p->body, q->body);
    if (by_id != 0 || by_body != 0)
        return by_id != 0 ? by_id : by_body;
    return compare_int64(p->feature, q->feature);
}

/* What a contact remembers, from `offset` on. */
static void add_history(struct table *table, size_t offset, bool full, bool ledger)
{
    static const struct field force = {
        "tangential_force", "N", "as felt by the surface of the second partner",
        FIELD_DOUBLE,       3,   0};
    static const struct field radius = {"contact_radius", "m", "at the last step",
                                        FIELD_DOUBLE,     1,   0};
    static const struct field velocity = {
        "normal_velocity", "m/s", "normal relative velocity of the last step",
        FIELD_DOUBLE,      1,     0};
    table_add_column(table, &force, offset);
    table_add_column(table, &radius, offset + CONTACT_RADIUS_LANE * sizeof(double));
    table_add_column(table, &velocity, offset + (CONTACT_RADIUS_LANE + 1) * sizeof(double));
    static const struct field drag = {
        "dashpot_force", "N", "of both dashpots, as felt by the second partner",
        FIELD_DOUBLE,    3,   0};
    if (ledger)
        table_add_column(table, &drag, offset + CONTACT_DRAG_LANE * sizeof(double));
    if (!full)
        return;
    static const struct field rolling = {
        "rolling_force", "N", "of the rolling spring, as felt by the second partner",
        FIELD_DOUBLE,    3,   0};
    static const struct field twisting = {
        "twisting_force", "N", "of the twisting spring, along the normal", FIELD_DOUBLE, 1, 0};
    static const struct field sliding = {"sliding",    "1", "1 where it slid in the last step",
                                         FIELD_DOUBLE, 1,   0};
    table_add_column(table, &rolling, offset + CONTACT_ROLLING_LANE * sizeof(double));
    table_add_column(table, &twisting, offset + CONTACT_TWISTING_LANE * sizeof(double));
    table_add_column(table, &sliding, offset + (CONTACT_TWISTING_LANE + 1) * sizeof(double));
}

static bool is_saved(int field, bool removals)
{
    return (sphere_fields[field].use & FIELD_SAVED) != 0 &&
           (field != SPHERE_CAUGHT || removals);
}

static void describe_spheres(struct table *table, bool removals)
{
    table_init(table, "spheres", 0, compare_spheres);
    for (int f = 0; f < SPHERE_N_FIELDS; f++) {
        if (!is_saved(f, removals))
            continue;
        table_add_column(table, &sphere_fields[f], table->record_size);
        table->record_size += field_size(&sphere_fields[f]);
    }
}

static void describe_contacts(struct table *table, bool full, bool ledger)
{
    static const struct field first = {"first_id",  "1", "sphere of the lower id",
                                       FIELD_INT64, 1,   0};
    static const struct field second = {"second_id", "1", "sphere of the higher id",
                                        FIELD_INT64, 1,   0};
    table_init(table, "contacts", sizeof(struct contact_record), compare_contacts);
    table_add_column(table, &first, offsetof(struct contact_record, first_id));
    table_add_column(table, &second, offsetof(struct contact_record, second_id));
    add_history(table, offsetof(struct contact_record, history), full, ledger);
}

static void describe_facet_contacts(struct table *table, bool full, bool ledger)
{
    static const struct field id = {"id", "1", "sphere", FIELD_INT64, 1, 0};
    static const struct field body = {
        "body", "1", "counted from 0 in the order of the job", FIELD_INT32, 1, 0};
    static const struct field feature = {
        "feature", "1", "faces first, then edges, then vertices", FIELD_INT32, 1, 0};
    table_init(table, "facet_contacts", sizeof(struct facet_contact_record),
               compare_facet_contacts);
    table_add_column(table, &id, offsetof(struct facet_contact_record, id));
    table_add_column(table, &body, offsetof(struct facet_contact_record, body));
    table_add_column(table, &feature, offsetof(struct facet_contact_record, feature));
    add_history(table, offsetof(struct facet_contact_record, history), full, ledger);
}

/* Rows of an id and fields, side by side. */
static void describe_more(struct table *table, const struct checkpoint_more *more, bool full,
                          bool ledger)
{
    static const struct field id = {"id", "1", "counted over all bodies", FIELD_INT64, 1, 0};
    if (more->contacts) {
        describe_facet_contacts(table, full, ledger);
        table->name = more->name;
        return;
    }
    table_init(table, more->name, sizeof(int64_t), compare_spheres);
    table_add_column(table, &id, 0);
    for (int f = 0; f < more->n_fields; f++) {
        table_add_column(table, &more->fields[f], table->record_size);
        table->record_size += field_size(&more->fields[f]);
    }
}

static int count_tables(const struct checkpoint *checkpoint)
{
    return N_KINDS + checkpoint->n_more;
}

static void tables_init(struct table tables[N_TABLES], const struct checkpoint *checkpoint)
{
    const bool full = checkpoint->full, ledger = checkpoint->ledger;
    for (int k = 0; k < checkpoint->n_more; k++)
        describe_more(&tables[N_KINDS + k], &checkpoint->more[k], full, ledger);
    describe_spheres(&tables[SPHERES], checkpoint->removals);
    describe_contacts(&tables[CONTACTS], full, ledger);
    describe_facet_contacts(&tables[FACET_CONTACTS], full, ledger);
}

static void tables_clear(struct table tables[N_TABLES], const struct checkpoint *checkpoint)
{
    for (int k = 0; k < count_tables(checkpoint); k++)
        table_clear(&tables[k]);
}

/* Copies sphere i into a record (`pack`), or a record into sphere i. */
static void move_sphere(const struct table *table, const struct spheres *spheres, int64_t i,
                        unsigned char *record, bool pack)
{
    for (int k = 0, f = 0; k < table->n_columns; k++, f++) {
        while ((sphere_fields[f].use & FIELD_SAVED) == 0)
            f++;
        const struct field_view view = sphere_view(spheres, f);
        unsigned char *place = field_at(&view, i), *saved = record + table->columns[k].offset;
        memcpy(pack ? saved : place, pack ? place : saved, field_size(&sphere_fields[f]));
    }
}

static void collect_spheres(struct table *table, const void *from, int64_t begin, int64_t end)
{
    const struct spheres *spheres = ((const struct checkpoint *)from)->spheres;
    unsigned char *record = array_allocate(1, table->record_size);
    for (int i = 0; i < spheres->n_owned; i++) {
        if (spheres->id[i] < begin || spheres->id[i] >= end)
            continue;
        move_sphere(table, spheres, i, record, true);
        table_append(table, record, 1);
    }
    free(record);
}

static void collect_contacts(struct table *table, const void *from, int64_t begin, int64_t end)
{
    const struct checkpoint_contacts *held = &((const struct checkpoint *)from)->held;
    struct contact_record *records = NULL;
    const int n = held->pairs(held->from, begin, end, &records);
    for (int k = 0; k < n; k++)
        CHECK(records[k].first_id < records[k].second_id,
              "a contact of %" PRId64 " and %" PRId64, records[k].first_id,
              records[k].second_id);
    table_append(table, records, n);
    free(records);
}

static void collect_facet_contacts(struct table *table, const void *from, int64_t begin,
                                   int64_t end)
{
    const struct checkpoint_contacts *held = &((const struct checkpoint *)from)->held;
    struct facet_contact_record *records = NULL;
    const int n = held->facets(held->from, begin, end, &records);
    table_append(table, records, n);
    free(records);
}

/* Tables that come from this checkpoint.  Collective. */
static void tables_to_write(struct table tables[N_TABLES], const struct comm *comm,
                            const struct checkpoint *checkpoint)
{
    static void (*const collect[N_KINDS])(struct table *, const void *, int64_t, int64_t) = {
        collect_spheres, collect_contacts, collect_facet_contacts};
    int64_t n_total[N_KINDS] = {checkpoint->spheres->n_owned, checkpoint->n_contacts,
                                checkpoint->n_facet_contacts};
    comm_sum_int(comm, n_total, N_KINDS);
    tables_init(tables, checkpoint);
    for (int k = 0; k < N_KINDS; k++) {
        tables[k].collect = collect[k];
        tables[k].from = checkpoint;
        tables[k].n_ids = checkpoint->next_id;
        tables[k].n_total = n_total[k];
    }
    for (int k = 0; k < checkpoint->n_more; k++) {
        const struct checkpoint_more *more = &checkpoint->more[k];
        struct table *table = &tables[N_KINDS + k];
        table->collect = more->collect;
        table->from = more->from;
        table->n_ids = table->n_total = more->n_ids;
        if (more->contacts) {
            table->n_total = more->n_rows;
            comm_sum_int(comm, &table->n_total, 1);
        }
    }
}

/* ---------------------------------------------------------------------------------- writing */

static int64_t checksum(const void *bytes, size_t n)
{
    struct crc32 crc;
    crc32_init(&crc);
    return crc32_of(&crc, bytes, n);
}

static void put_run(struct h5 *h5, const struct checkpoint *checkpoint,
                    const struct table tables[N_TABLES])
{
    static const char run[] = "/run";
    h5_group(h5, run);
    h5_put_text(h5, run, "format", FORMAT);
    h5_put_int(h5, run, "format_version", CHECKPOINT_FORMAT_VERSION);
    h5_put_int(h5, run, "step", checkpoint->step);
    h5_put_double(h5, run, "time", (double)checkpoint->step * checkpoint->dt);
    h5_put_text(h5, run, "time_unit", "s");
    h5_put_double(h5, run, "dt", checkpoint->dt);
    h5_put_text(h5, run, "dt_unit", "s");
    h5_put_int(h5, run, "next_id", checkpoint->next_id);
    h5_put_int(h5, run, "n_spheres", tables[SPHERES].n_total);
    h5_put_int(h5, run, "n_contacts", tables[CONTACTS].n_total);
    h5_put_int(h5, run, "n_facet_contacts", tables[FACET_CONTACTS].n_total);
    h5_put_int(h5, run, "n_monitors", checkpoint->n_monitors);
    h5_put_text(h5, run, "title", checkpoint->title);
    h5_put_document(h5, "/run/job", checkpoint->job_text);
    h5_put_int(h5, "/run/job", "checksum",
               checksum(checkpoint->job_text, strlen(checkpoint->job_text)));
}

/* Names one a line, sums beside them. */
static void put_monitors(struct h5 *h5, int n, const struct checkpoint_monitor *monitors)
{
    char *names = array_allocate((size_t)n * CHECKPOINT_NAME_SIZE + 1, 1);
    struct exact_sum *sums = array_allocate((size_t)n, sizeof *sums);
    size_t length = 0;
    for (int i = 0; i < n; i++) {
        length += (size_t)sprintf(names + length, "%.*s\n", CHECKPOINT_NAME_SIZE - 1,
                                  monitors[i].name);
        sums[i] = monitors[i].sum;
    }
    h5_group(h5, "/monitors");
    h5_put_document(h5, "/monitors/names", names);
    h5_put_int(h5, "/monitors/names", "checksum", checksum(names, length));
    h5_declare_rows(h5, "/monitors/sums", &SUMS, n);
    h5_write_rows(h5, "/monitors/sums", &SUMS, 0, n, sums);
    h5_put_int(h5, "/monitors/sums", "checksum", checksum(sums, (size_t)n * sizeof *sums));
    free(names);
    free(sums);
}

/* What put_all() puts there takes at most. */
static int64_t content_size(const struct checkpoint *checkpoint)
{
    enum { NOTE_SIZE = 2048 };
    return (int64_t)strlen(checkpoint->job_text) +
           checkpoint->n_monitors * (int64_t)sizeof *checkpoint->monitors +
           checkpoint->notes.n * (int64_t)NOTE_SIZE;
}

/* What a new file is laid out from. */
struct content {
    const struct checkpoint *checkpoint;
    const struct checkpoint_monitor *totals;
    const struct table *tables;
};

static void put_all(struct h5 *h5, const void *from)
{
    const struct content *content = from;
    put_run(h5, content->checkpoint, content->tables);
    put_monitors(h5, content->checkpoint->n_monitors, content->totals);
    notes_put(&content->checkpoint->notes, h5);
    h5_group(h5, "/checksums");
    for (int k = 0; k < count_tables(content->checkpoint); k++)
        table_declare(&content->tables[k], h5);
}

/* Collective. */
static void check_notes(const struct comm *comm, const struct notes *notes)
{
    const int64_t sum = notes_checksum(notes);
    int64_t extremes[2] = {sum, -sum};
    comm_max_int(comm, extremes, 2);
    CHECK(extremes[0] == -extremes[1], "ranks have different notes for the checkpoint");
}

int checkpoint_write(const struct comm *comm, const char *path,
                     const struct checkpoint *checkpoint)
{
    check_notes(comm, &checkpoint->notes);
    struct table tables[N_TABLES];
    tables_to_write(tables, comm, checkpoint);
    const int n = checkpoint->n_monitors;
    struct checkpoint_monitor *totals = array_allocate((size_t)n, sizeof *totals);
    for (int i = 0; i < n; i++) {
        totals[i] = checkpoint->monitors[i];
        exact_sum_reduce(comm, &totals[i].sum, 1);
    }
    const struct content content = {checkpoint, totals, tables};
    const struct shared_file file = {
        .folder = checkpoint->folder,
        .path = path,
        .what = "checkpoint",
        .remedy = "earlier ones are untouched: free some space or mend the disk, then run the "
                  "same command again",
        .lay_out = put_all,
        .content = &content,
        .size = content_size(checkpoint),
        .n_tables = count_tables(checkpoint),
        .tables = tables,
    };
    const int status = shared_file_write(comm, &file);
    tables_clear(tables, checkpoint);
    free(totals);
    return status;
}

/* ---------------------------------------------------------------------------------- reading */

/* A text with its checksum. */
static char *get_document(struct h5 *h5, const char *path)
{
    char *text = h5_get_document(h5, path);
    const int64_t stored = h5_get_int(h5, path, "checksum");
    if (stored != checksum(text, strlen(text)))
        h5_fail(h5, "%s: the checksum is wrong", path);
    return text;
}

static void check_format(struct h5 *h5)
{
    if (h5->why == NULL && !h5_has(h5, "/run")) {
        h5_fail(h5, "it is not a checkpoint of tremie");
        return;
    }
    char *format = h5_get_text(h5, "/run", "format");
    const int64_t version = h5_get_int(h5, "/run", "format_version");
    if (strcmp(format, FORMAT) != 0)
        h5_fail(h5, "it is not a checkpoint of tremie");
    else if (version != CHECKPOINT_FORMAT_VERSION)
        h5_fail(h5,
                "its format version is %" PRId64
                " and this program reads %d; use the tremie that wrote it",
                version, CHECKPOINT_FORMAT_VERSION);
    free(format);
}

static void get_header(struct h5 *h5, struct checkpoint *checkpoint)
{
    check_format(h5);
    checkpoint->step = h5_get_int(h5, "/run", "step");
    checkpoint->dt = h5_get_double(h5, "/run", "dt");
    checkpoint->next_id = h5_get_int(h5, "/run", "next_id");
    checkpoint->title = h5_get_text(h5, "/run", "title");
    checkpoint->job_text = get_document(h5, "/run/job");
    if (checkpoint->step < 0 || checkpoint->next_id < 0 || !(checkpoint->dt > 0.0))
        h5_fail(h5, "/run: step, dt or next_id make no sense");
}

bool checkpoint_read_header(const char *path, struct checkpoint *checkpoint, char **why)
{
    struct h5 h5;
    *checkpoint = (struct checkpoint){0};
    h5_open(&h5, path);
    get_header(&h5, checkpoint);
    h5_close(&h5);
    *why = h5.why;
    if (h5.why != NULL)
        checkpoint_clear(checkpoint);
    return h5.why == NULL;
}

static void get_monitors(struct h5 *h5, struct checkpoint *checkpoint)
{
    const int64_t n = h5_count_rows(h5, "/monitors/sums", &SUMS);
    struct exact_sum *sums = array_allocate((size_t)n, sizeof *sums);
    checkpoint->monitors = array_allocate((size_t)n, sizeof *checkpoint->monitors);
    h5_read_rows(h5, "/monitors/sums", &SUMS, 0, n, sums);
    if (h5_get_int(h5, "/monitors/sums", "checksum") !=
        checksum(sums, (size_t)n * sizeof *sums))
        h5_fail(h5, "/monitors/sums: the checksum is wrong");
    char *names = get_document(h5, "/monitors/names"), *at = names;
    for (int64_t i = 0; i < n; i++) {
        struct checkpoint_monitor *monitor = &checkpoint->monitors[i];
        const size_t length = strcspn(at, "\n");
        if (at[length] == '\0' || length >= CHECKPOINT_NAME_SIZE) {
            h5_fail(h5, "/monitors/names: a name is missing");
            break;
        }
        memcpy(monitor->name, at, length);
        monitor->sum = sums[i];
        at += length + 1;
    }
    checkpoint->n_monitors = (int)n;
    free(names);
    free(sums);
}

/* A text from rank 0.  Collective. */
static void share_text(const struct comm *comm, char **text)
{
    int64_t size = comm->rank == 0 ? (int64_t)strlen(*text) + 1 : 0;
    comm_broadcast(comm, &size, sizeof size);
    if (comm->rank != 0)
        *text = array_allocate((size_t)size, 1);
    comm_broadcast(comm, *text, (size_t)size);
}

/* What rank 0 read, to all; monitors' totals stay with rank 0.  Collective. */
static void share_header(const struct comm *comm, struct checkpoint *checkpoint,
                         struct table tables[N_TABLES])
{
    int64_t numbers[] = {checkpoint->step,         checkpoint->next_id,
                         checkpoint->n_monitors,   tables[SPHERES].n_total,
                         tables[CONTACTS].n_total, tables[FACET_CONTACTS].n_total};
    comm_broadcast(comm, numbers, sizeof numbers);
    comm_broadcast(comm, &checkpoint->dt, sizeof checkpoint->dt);
    checkpoint->step = numbers[0];
    checkpoint->next_id = numbers[1];
    checkpoint->n_monitors = (int)numbers[2];
    for (int k = 0; k < N_KINDS; k++)
        tables[k].n_total = numbers[3 + k];
    for (int k = 0; k < checkpoint->n_more; k++)
        comm_broadcast(comm, &tables[N_KINDS + k].n_total, sizeof tables->n_total);
    share_text(comm, &checkpoint->title);
    share_text(comm, &checkpoint->job_text);
    const size_t n = (size_t)checkpoint->n_monitors;
    if (comm->rank != 0)
        checkpoint->monitors = array_allocate(n, sizeof *checkpoint->monitors);
    comm_broadcast(comm, checkpoint->monitors, n * sizeof *checkpoint->monitors);
    for (size_t i = 0; comm->rank != 0 && i < n; i++)
        checkpoint->monitors[i].sum = (struct exact_sum){0};
    struct notes *notes = &checkpoint->notes;
    comm_broadcast(comm, &notes->n, sizeof notes->n);
    if (comm->rank != 0)
        ARRAY_GROW(notes->list, notes->n, notes->capacity);
    comm_broadcast(comm, notes->list, (size_t)notes->n * sizeof *notes->list);
}

/* Everything that one process can say about the file as a whole.  Local. */
static char *read_header(const char *path, struct checkpoint *checkpoint,
                         struct table tables[N_TABLES])
{
    static const char *const counts[N_KINDS] = {"n_spheres", "n_contacts", "n_facet_contacts"};
    struct h5 h5;
    h5_open(&h5, path);
    h5_look_around(&h5);
    get_header(&h5, checkpoint);
    get_monitors(&h5, checkpoint);
    notes_get(&checkpoint->notes, &h5);
    for (int k = 0; k < checkpoint->n_more; k++) {
        struct table *table = &tables[N_KINDS + k];
        table_measure(table, &h5);
        if (!checkpoint->more[k].contacts && table->n_total != checkpoint->more[k].n_ids)
            h5_fail(&h5, "/%s: %lld rows in place of %lld", table->name,
                    (long long)table->n_total, (long long)checkpoint->more[k].n_ids);
    }
    for (int k = 0; k < N_KINDS; k++) {
        table_measure(&tables[k], &h5);
        if (h5_get_int(&h5, "/run", counts[k]) != tables[k].n_total)
            h5_fail(&h5, "/%s: the number of rows is not %s", tables[k].name, counts[k]);
    }
    h5_close(&h5);
    return h5.why;
}

static char *check_facet_contacts(const struct table *table)
{
    const struct facet_contact_record *facets = (const void *)table->records;
    for (int64_t i = 0; i < table->n; i++)
        if (facets[i].body < 0 || facets[i].feature < 0 ||
            !(facets[i].history[CONTACT_RADIUS_LANE] > 0.0))
            return array_format("/%s: that of %" PRId64 " makes no sense", table->name,
                                facets[i].id);
    return NULL;
}

/* Values that the program would stumble over.  Bodies, features and materials are counted by
 * the job, which the caller knows. */
static char *check_values(const struct table tables[N_TABLES], const struct spheres *spheres)
{
    for (int i = 0; i < spheres->n_owned; i++)
        if (!(sphere_radius(spheres, i) > 0.0) || spheres->material[i] < 0 ||
            spheres->group[i] < 0)
            return array_format("/spheres: radius, material or group of id %" PRId64
                                " makes no sense",
                                spheres->id[i]);
    return check_facet_contacts(&tables[FACET_CONTACTS]);
}

/* This rank's rows, verified.  Local. */
static char *read_rows(const struct comm *comm, const char *path, struct checkpoint *checkpoint,
                       struct table tables[N_TABLES])
{
    struct h5 h5;
    h5_open(&h5, path);
    table_read(&tables[SPHERES], &h5, comm, checkpoint->next_id);
    table_read(&tables[FACET_CONTACTS], &h5, comm, checkpoint->next_id);
    const struct comm alone = {.mpi = MPI_COMM_SELF, .rank = 0, .n_ranks = 1};
    for (int k = 0; k < checkpoint->n_more; k++) {
        struct table *table = &tables[N_KINDS + k];
        table_read(table, &h5, &alone, checkpoint->more[k].n_ids);
    }
    h5_close(&h5);
    return h5.why;
}

/* Gives the records to the checkpoint. */
static void hand_over(struct checkpoint *checkpoint, struct table tables[N_TABLES])
{
    const struct spheres *spheres = checkpoint->spheres;
    checkpoint->n_slice = spheres->n_owned;
    checkpoint->slice = array_allocate((size_t)spheres->n_owned, sizeof *checkpoint->slice);
    memcpy(checkpoint->slice, spheres->id, (size_t)spheres->n_owned * sizeof *spheres->id);
    checkpoint->n_facet_contacts = (int)tables[FACET_CONTACTS].n;
    checkpoint->facet_contacts = (void *)tables[FACET_CONTACTS].records;
    tables[FACET_CONTACTS].records = NULL;
    for (int k = 0; k < checkpoint->n_more; k++) {
        struct table *table = &tables[N_KINDS + k];
        checkpoint->more[k].record_size = table->record_size;
        checkpoint->more[k].n_rows = table->n;
        checkpoint->more[k].records = table->records;
        table->records = NULL;
    }
}

static void place_spheres(struct spheres *spheres, struct table *table)
{
    spheres_reserve(spheres, (int)table->n);
    spheres->n_owned = spheres->n_all = (int)table->n;
    for (int64_t i = 0; i < table->n; i++)
        move_sphere(table, spheres, i, table->records + (size_t)i * table->record_size, false);
    spheres_pad(spheres);
}

static char *read_file(const struct comm *comm, const char *path, struct checkpoint *checkpoint,
                       struct table tables[N_TABLES])
{
    char *why = comm->rank == 0 ? read_header(path, checkpoint, tables) : NULL;
    if (!shared_file_all_well(comm, &why))
        return why;
    share_header(comm, checkpoint, tables);
    why = read_rows(comm, path, checkpoint, tables);
    if (!shared_file_all_well(comm, &why))
        return why;
    why = table_follow(&tables[FACET_CONTACTS], comm, &tables[SPHERES], 1);
    place_spheres(checkpoint->spheres, &tables[SPHERES]);
    if (why == NULL)
        why = check_values(tables, checkpoint->spheres);
    for (int k = 0; k < checkpoint->n_more && why == NULL; k++)
        if (checkpoint->more[k].contacts)
            why = check_facet_contacts(&tables[N_KINDS + k]);
    if (shared_file_all_well(comm, &why))
        hand_over(checkpoint, tables);
    return why;
}

static int refuse(const char *path, char *why)
{
    report_error("cannot use the checkpoint %s: %s", path, why);
    free(why);
    return REPORT_STORAGE;
}

int checkpoint_read(const struct comm *comm, const char *path, struct checkpoint *checkpoint)
{
    struct table tables[N_TABLES];
    tables_init(tables, checkpoint);
    char *why = read_file(comm, path, checkpoint, tables);
    tables_clear(tables, checkpoint);
    if (why == NULL)
        return REPORT_FINISHED;
    checkpoint_clear(checkpoint);
    checkpoint->spheres->n_owned = checkpoint->spheres->n_all = 0;
    spheres_pad(checkpoint->spheres);
    return refuse(path, why);
}

static char *check_contacts(const struct table *table)
{
    const struct contact_record *contacts = (const void *)table->records;
    for (int64_t i = 0; i < table->n; i++)
        if (contacts[i].first_id >= contacts[i].second_id ||
            !(contacts[i].history[CONTACT_RADIUS_LANE] > 0.0))
            return array_format("/contacts: that of %" PRId64 " and %" PRId64 " makes no sense",
                                contacts[i].first_id, contacts[i].second_id);
    return NULL;
}

/* A part of the contacts that is right and where it belongs; false with the reason in h5.
 * Collective. */
static bool read_contacts_part(struct table *table, const struct comm *comm, struct h5 *h5,
                               const struct checkpoint *checkpoint, int64_t part)
{
    struct table owners;
    table_init(&owners, "spheres", sizeof *checkpoint->slice, compare_spheres);
    owners.n = checkpoint->n_slice;
    owners.records = (void *)checkpoint->slice;
    table_read_part(table, h5, comm, checkpoint->next_id, part, table_n_parts(table, comm));
    if (!shared_file_all_well(comm, &h5->why))
        return false;
    h5->why = table_follow(table, comm, &owners, 2);
    if (h5->why == NULL)
        h5->why = check_contacts(table);
    return shared_file_all_well(comm, &h5->why);
}

int checkpoint_read_contacts(const struct comm *comm, const char *path,
                             const struct checkpoint *checkpoint, checkpoint_take *take,
                             void *into)
{
    struct table table;
    struct h5 h5;
    describe_contacts(&table, checkpoint->full, checkpoint->ledger);
    h5_open(&h5, path);
    table_measure(&table, &h5);
    bool well = shared_file_all_well(comm, &h5.why);
    for (int64_t part = 0; well && part < table_n_parts(&table, comm); part++) {
        well = read_contacts_part(&table, comm, &h5, checkpoint, part);
        if (well)
            take(into, (int)table.n, (void *)table.records);
    }
    h5_close(&h5);
    table_clear(&table);
    return well ? REPORT_FINISHED : refuse(path, h5.why);
}

void checkpoint_clear(struct checkpoint *checkpoint)
{
    struct spheres *spheres = checkpoint->spheres;
    free(checkpoint->title);
    free(checkpoint->job_text);
    free(checkpoint->slice);
    free(checkpoint->facet_contacts);
    free(checkpoint->monitors);
    for (int k = 0; k < checkpoint->n_more; k++)
        free(checkpoint->more[k].records);
    notes_clear(&checkpoint->notes);
    *checkpoint = (struct checkpoint){.spheres = spheres};
}
