/* Tables: rows collected part by part give the file of rows that are there all at once, on any
 * number of ranks.  ranks: 1 2 3 5 / */
#include "store/table.h"

#include <stdlib.h>
#include <unistd.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "check.h"
#include "store/file.h"
#include "store/h5.h"

enum { N_IDS = 5000 };

struct row {
    int64_t id;
    int32_t which;
    double value[3];
};

static const struct field FIELDS[] = {
    {"id", "1", "of the row", FIELD_INT64, 1, 0},
    {"which", "1", "of its rows", FIELD_INT32, 1, 0},
    {"value", "m", "some number", FIELD_DOUBLE, 3, 0},
};

static int compare_rows(const void *a, const void *b)
{
    const struct row *p = a, *q = b;
    return p->id != q->id ? (p->id < q->id ? -1 : 1)
                          : (p->which > q->which) - (p->which < q->which);
}

/* Ids have no, one, two, ... rows; those of the lower half have more. */
static int rows_of(int64_t id)
{
    return (int)(id % 3) + (id < N_IDS / 2 ? 2 : 0);
}

/* This rank's rows, last first. */
static void collect(struct table *table, const void *from, int64_t begin, int64_t end)
{
    const struct comm *comm = from;
    for (int64_t id = (end < N_IDS ? end : N_IDS) - 1; id >= begin; id--)
        for (int which = rows_of(id) - 1; which >= 0; which--)
            if ((id * 7 + which) % 11 % comm->n_ranks == comm->rank) {
                const double x = (double)id + 0.25 * which;
                const struct row row = {id, which, {x, 2.0 * x, 1.0 / (1.0 + x)}};
                table_append(table, &row, 1);
            }
}

static void describe(struct table *table)
{
    static const size_t offsets[] = {offsetof(struct row, id), offsetof(struct row, which),
                                     offsetof(struct row, value)};
    table_init(table, "rows", sizeof(struct row), compare_rows);
    for (int k = 0; k < 3; k++)
        table_add_column(table, &FIELDS[k], offsets[k]);
}

/* A file by one process, which lays it out. */
static void write_rows(const struct comm *comm, const char *path, struct table *table)
{
    struct h5 h5;
    comm_barrier(comm); /* nobody reads the one before any more */
    if (comm->rank == 0) {
        h5_create(&h5, path);
        h5_group(&h5, "/checksums");
        table_declare(table, &h5);
        h5_save(&h5, path);
        EXPECT(h5.why == NULL);
        free(h5.why);
    }
    comm_barrier(comm);
    h5_open_shared(&h5, path, comm);
    if (table->collect != NULL)
        table_stream(table, comm, &h5);
    else
        table_write(table, &h5);
    h5_close(&h5);
    EXPECT(h5.why == NULL);
    free(h5.why);
    comm_barrier(comm);
}

static char *name_of(const struct comm *comm, const char *name)
{
    int64_t pid = getpid();
    comm_broadcast(comm, &pid, sizeof pid);
    const char *folder = getenv("SCRATCH");
    return array_format("%s/%lld_%s.h5", folder != NULL ? folder : "/tmp", (long long)pid,
                        name);
}

static int64_t total(const struct comm *comm, int64_t n)
{
    comm_sum_int(comm, &n, 1);
    return n;
}

/* The rows in the file, all on this rank, verified. */
static void read_back(const char *path, struct table *table)
{
    const struct comm self = {.mpi = MPI_COMM_SELF, .rank = 0, .n_ranks = 1};
    struct h5 h5;
    describe(table);
    h5_open(&h5, path);
    table_measure(table, &h5);
    table_read(table, &h5, &self, N_IDS);
    h5_close(&h5);
    EXPECT(h5.why == NULL);
    free(h5.why);
}

TEST(parts_give_the_file_of_the_whole)
{
    const struct comm comm = comm_world();
    struct table whole, parts, is, was;
    char *paths[2] = {name_of(&comm, "whole"), name_of(&comm, "parts")};
    describe(&whole);
    collect(&whole, &comm, 0, N_IDS);
    const int64_t n = total(&comm, whole.n);
    table_arrange(&whole, &comm, N_IDS);
    EXPECT(whole.n_total == n && n > 20 * TABLE_BLOCK);
    write_rows(&comm, paths[0], &whole);
    read_back(paths[0], &was);
    for (int64_t bytes = sizeof(struct row); bytes < 1000000; bytes *= 37) {
        describe(&parts);
        parts.collect = collect;
        parts.from = &comm;
        parts.n_ids = N_IDS;
        parts.n_total = n;
        parts.part_bytes = bytes;
        write_rows(&comm, paths[1], &parts);
        EXPECT(parts.n == 0 && parts.records == NULL);
        read_back(paths[1], &is);
        EXPECT(is.n == n &&
               memcmp(is.records, was.records, (size_t)n * sizeof(struct row)) == 0);
        table_clear(&is);
        table_clear(&parts);
    }
    table_clear(&whole);
    table_clear(&was);
    for (int k = 0; k < 2; k++)
        free(paths[k]);
}

/* All ranks' rows of all parts are those of the whole, in their places, each once. */
static void expect_parts(const struct comm *comm, const char *path, const struct table *whole,
                         int64_t n_parts)
{
    struct table table;
    struct h5 h5;
    int64_t n = 0, expected = 0;
    describe(&table);
    h5_open(&h5, path);
    table_measure(&table, &h5);
    for (int64_t part = 0; part < n_parts; part++) {
        table_read_part(&table, &h5, comm, N_IDS, part, n_parts);
        const int64_t n_here = total(comm, table.n);
        n += n_here;
        EXPECT(n_here <= (whole->n / TABLE_BLOCK / n_parts + 2) * TABLE_BLOCK);
        expected += comm_sum_before(comm, table.n);
        EXPECT(table.n == 0 || table.begin == expected);
        expected = n;
        EXPECT(memcmp(table.records, whole->records + (size_t)table.begin * sizeof(struct row),
                      (size_t)table.n * sizeof(struct row)) == 0);
    }
    h5_close(&h5);
    EXPECT(h5.why == NULL && n == whole->n);
    free(h5.why);
    table_clear(&table);
}

TEST(parts_are_read_as_the_whole)
{
    const struct comm comm = comm_world();
    struct table whole, was;
    char *path = name_of(&comm, "read");
    describe(&whole);
    collect(&whole, &comm, 0, N_IDS);
    table_arrange(&whole, &comm, N_IDS);
    write_rows(&comm, path, &whole);
    read_back(path, &was);
    for (int64_t n_parts = 1; n_parts < 100; n_parts = 3 * n_parts + 1)
        expect_parts(&comm, path, &was, n_parts);
    table_clear(&whole);
    table_clear(&was);
    free(path);
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
