/*
 * See table.h.  Sorting takes two exchanges: first by equal ranges of ids, which a rank can
 * work out alone, sorted there; then, the number of rows before being known, to the slices.  If
 * ids are spread unevenly the first exchange is uneven too, which costs memory for a moment and
 * nothing else.
 *
 * A part of a stream is a range of ids.  Its rows are written up to the last whole block; the
 * last rank keeps the rest, which come first in the next part.
 */
#include "store/table.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "store/crc32.h"
#include "store/h5.h"

enum { PART_BYTES = 1 << 24 };

static const struct field CHECKSUM = {"checksum",  "1", "CRC-32 of each block of 256 rows",
                                      FIELD_INT64, 1,   0};

void table_init(struct table *table, const char *name, size_t record_size,
                int (*compare)(const void *, const void *))
{
    *table = (struct table){
        .name = name, .record_size = record_size, .compare = compare, .part_bytes = PART_BYTES};
}

void table_clear(struct table *table)
{
    free(table->records);
    *table = (struct table){0};
}

void table_add_column(struct table *table, const struct field *field, size_t offset)
{
    CHECK(table->n_columns < TABLE_COLUMNS_MAX, "%s has too many columns", table->name);
    table->columns[table->n_columns++] = (struct table_column){*field, offset};
}

static int64_t n_blocks(int64_t n_rows)
{
    return (n_rows + TABLE_BLOCK - 1) / TABLE_BLOCK;
}

/* First row of rank q's slice of n_rows. */
static int64_t slice_begin(const struct table *table, int64_t n_rows, int q, int n_ranks)
{
    const int64_t unit = table->packed ? H5_PIECE_ROWS : TABLE_BLOCK;
    const int64_t row = (n_rows + unit - 1) / unit * q / n_ranks * unit;
    return row < n_rows ? row : n_rows;
}

static unsigned char *record(const struct table *table, int64_t i)
{
    return table->records + (size_t)i * table->record_size;
}

void table_append(struct table *table, const void *records, int64_t n)
{
    const size_t used = (size_t)table->n * table->record_size;
    if (n == 0)
        return;
    ARRAY_GROW(table->records, used + (size_t)n * table->record_size, table->capacity);
    memcpy(table->records + used, records, (size_t)n * table->record_size);
    table->n += n;
}

/* --------------------------------------------------------------------------------- exchange */

/* Replaces the records, which have been packed, by those that the other ranks packed for this
 * one, in rank order. */
static void receive(struct table *table, struct comm_mail *mail, const struct comm *comm)
{
    free(table->records);
    comm_mail_exchange(mail, comm);
    size_t n_bytes = 0;
    for (int q = 0; q < comm->n_ranks; q++)
        n_bytes += mail->in[q].n;
    table->records = array_allocate(n_bytes, 1);
    table->capacity = n_bytes;
    table->n = (int64_t)(n_bytes / table->record_size);
    size_t at = 0;
    for (int q = 0; q < comm->n_ranks; q++) {
        comm_mail_unpack(mail, q, table->records + at, mail->in[q].n);
        at += mail->in[q].n;
    }
}

/* Ids lie in begin .. end - 1, and some below, which are kept from the part before. */
static void send_by_id(struct table *table, struct comm_mail *mail, const struct comm *comm,
                       int64_t begin, int64_t end)
{
    const int64_t ids_per_rank = (end - begin) / comm->n_ranks + 1;
    comm_mail_begin(mail);
    for (int64_t i = 0; i < table->n; i++) {
        const int64_t id = table_id(table, i);
        CHECK(id >= 0 && id < end, "%s hold id %lld of %lld", table->name, (long long)id,
              (long long)end);
        const int64_t q = id < begin ? 0 : (id - begin) / ids_per_rank;
        comm_mail_pack(mail, (int)q, record(table, i), table->record_size);
    }
    receive(table, mail, comm);
}

static void sort(struct table *table)
{
    if (table->n > 1)
        qsort(table->records, (size_t)table->n, table->record_size, table->compare);
    for (int64_t i = 1; i < table->n; i++)
        CHECK(table->compare(record(table, i - 1), record(table, i)) < 0,
              "%s: id %lld is held twice", table->name, (long long)table_id(table, i));
}

/* What is beyond n_rows goes to the last rank. */
static void send_by_row(struct table *table, struct comm_mail *mail, const struct comm *comm,
                        int64_t n_rows)
{
    const int64_t first = comm_sum_before(comm, table->n);
    comm_mail_begin(mail);
    for (int64_t i = 0, q = 0; i < table->n; i++) {
        while (q < comm->n_ranks - 1 &&
               first + i >= slice_begin(table, n_rows, (int)q + 1, comm->n_ranks))
            q++;
        comm_mail_pack(mail, (int)q, record(table, i), table->record_size);
    }
    receive(table, mail, comm);
}

static int64_t sum_over_ranks(const struct comm *comm, int64_t n)
{
    comm_sum_int(comm, &n, 1);
    return n;
}

/* Sorts all records with ids below `end`, of which n_rows are cut into slices. */
static void arrange(struct table *table, const struct comm *comm, int64_t begin, int64_t end,
                    int64_t n_rows)
{
    struct comm_mail mail;
    comm_mail_init(&mail, comm);
    if (comm->n_ranks > 1)
        send_by_id(table, &mail, comm, begin, end);
    sort(table);
    if (comm->n_ranks > 1)
        send_by_row(table, &mail, comm, n_rows);
    comm_mail_clear(&mail);
}

void table_arrange(struct table *table, const struct comm *comm, int64_t n_ids)
{
    table->n_total = sum_over_ranks(comm, table->n);
    arrange(table, comm, 0, n_ids, table->n_total);
    table->begin = slice_begin(table, table->n_total, comm->rank, comm->n_ranks);
}

/* ------------------------------------------------------------------------------------ files */

static char *column_path(const struct table *table, int k)
{
    return array_format("/%s/%s", table->name, table->columns[k].field.name);
}

static char *checksum_path(const struct table *table, int k)
{
    return array_format("/checksums/%s/%s", table->name, table->columns[k].field.name);
}

int64_t table_file_size(const struct table *table)
{
    int64_t size = 0;
    for (int k = 0; k < table->n_columns; k++)
        size += table->n_total * (int64_t)field_size(&table->columns[k].field) +
                n_blocks(table->n_total) * (int64_t)field_size(&CHECKSUM);
    return size;
}

void table_declare(const struct table *table, struct h5 *h5)
{
    char *group = array_format("/%s", table->name);
    char *checksums = array_format("/checksums/%s", table->name);
    h5_group(h5, group);
    h5_group(h5, checksums);
    for (int k = 0; k < table->n_columns; k++) {
        char *path = column_path(table, k), *sums = checksum_path(table, k);
        if (table->packed)
            h5_declare_packed_rows(h5, path, &table->columns[k].field, table->n_total);
        else
            h5_declare_rows(h5, path, &table->columns[k].field, table->n_total);
        h5_declare_rows(h5, sums, &CHECKSUM, n_blocks(table->n_total));
        free(path);
        free(sums);
    }
    free(group);
    free(checksums);
}

/* Checksums of the blocks of a column's n rows. */
static int64_t *block_sums(const unsigned char *rows, size_t size, int64_t n)
{
    struct crc32 crc;
    crc32_init(&crc);
    int64_t *sums = array_allocate((size_t)n_blocks(n), sizeof *sums);
    for (int64_t b = 0; b < n_blocks(n); b++) {
        const int64_t begin = b * TABLE_BLOCK;
        const int64_t part = n - begin < TABLE_BLOCK ? n - begin : TABLE_BLOCK;
        sums[b] = crc32_of(&crc, rows + (size_t)begin * size, (size_t)part * size);
    }
    return sums;
}

/* The column's rows side by side; the caller frees them. */
static unsigned char *gather_column(const struct table *table, int k)
{
    const struct table_column *column = &table->columns[k];
    const size_t size = field_size(&column->field);
    unsigned char *rows = array_allocate((size_t)table->n, size);
    for (int64_t i = 0; i < table->n; i++)
        memcpy(rows + (size_t)i * size, record(table, i) + column->offset, size);
    return rows;
}

static void write_column(const struct table *table, int k, struct h5 *h5)
{
    const struct table_column *column = &table->columns[k];
    const size_t size = field_size(&column->field);
    unsigned char *rows = gather_column(table, k);
    int64_t *sums = block_sums(rows, size, table->n);
    char *path = column_path(table, k), *sums_path = checksum_path(table, k);
    if (!table->packed)
        h5_write_rows(h5, path, &column->field, table->begin, table->n, rows);
    h5_write_rows(h5, sums_path, &CHECKSUM, n_blocks(table->begin), n_blocks(table->n), sums);
    free(path);
    free(sums_path);
    free(sums);
    free(rows);
}

void table_write(const struct table *table, struct h5 *h5)
{
    for (int k = 0; k < table->n_columns; k++)
        write_column(table, k, h5);
}

/* Writes those of this rank's rows that lie in its slice of n_rows, of which `before` are in
 * the file already, and keeps the others. */
static void write_part(struct table *table, const struct comm *comm, struct h5 *h5,
                       int64_t before, int64_t n_rows)
{
    const int64_t begin = slice_begin(table, n_rows, comm->rank, comm->n_ranks);
    const int64_t n = slice_begin(table, n_rows, comm->rank + 1, comm->n_ranks) - begin;
    const int64_t kept = table->n - n;
    table->begin = before + begin;
    table->n = n;
    table_write(table, h5);
    if (kept > 0)
        memmove(table->records, record(table, n), (size_t)kept * table->record_size);
    table->n = kept;
}

int64_t table_n_parts(const struct table *table, const struct comm *comm)
{
    const int64_t bytes = table->n_total * (int64_t)table->record_size;
    return bytes / table->part_bytes / comm->n_ranks + 1;
}

void table_stream(struct table *table, const struct comm *comm, struct h5 *h5)
{
    const int64_t n_parts = table_n_parts(table, comm);
    const int64_t ids = table->n_ids / n_parts + 1;
    int64_t written = 0;
    table->n = 0;
    for (int64_t part = 0; part < n_parts; part++) {
        const int64_t begin = part * ids, end = begin + ids;
        table->collect(table, table->from, begin, end);
        const int64_t n = sum_over_ranks(comm, table->n);
        const int64_t n_rows = part == n_parts - 1 ? n : n / TABLE_BLOCK * TABLE_BLOCK;
        arrange(table, comm, begin, end, n_rows);
        write_part(table, comm, h5, written, n_rows);
        written += n_rows;
    }
    CHECK(written == table->n_total, "%lld rows of %s in place of %lld", (long long)written,
          table->name, (long long)table->n_total);
    free(table->records);
    table->records = NULL;
    table->capacity = 0;
}

/* What says of a packed piece where it belongs. */
struct piece {
    int64_t begin, size;
};

static void send_pieces(const struct table *table, int k, struct comm_mail *mail)
{
    const struct field *field = &table->columns[k].field;
    unsigned char *rows = gather_column(table, k);
    for (int64_t begin = 0; begin < table->n; begin += H5_PIECE_ROWS) {
        const int64_t left = table->n - begin;
        size_t size;
        unsigned char *packed =
            h5_pack(field, table->n_total, left < H5_PIECE_ROWS ? left : H5_PIECE_ROWS,
                    rows + (size_t)begin * field_size(field), &size);
        const struct piece piece = {table->begin + begin, (int64_t)size};
        comm_mail_pack(mail, 0, &piece, sizeof piece);
        comm_mail_pack(mail, 0, packed, size);
        free(packed);
    }
    free(rows);
}

static void put_pieces(const struct table *table, int k, struct comm_mail *mail, int from,
                       struct h5 *h5)
{
    char *path = column_path(table, k);
    while (comm_mail_waits(mail, from)) {
        struct piece piece;
        comm_mail_unpack(mail, from, &piece, sizeof piece);
        unsigned char *packed = array_allocate((size_t)piece.size, 1);
        comm_mail_unpack(mail, from, packed, (size_t)piece.size);
        h5_put_packed(h5, path, piece.begin, (size_t)piece.size, packed);
        free(packed);
    }
    free(path);
}

void table_pack(const struct table *table, const struct comm *comm, struct h5 *h5)
{
    struct comm_mail mail;
    comm_mail_init(&mail, comm);
    for (int k = 0; k < table->n_columns; k++) {
        comm_mail_begin(&mail);
        send_pieces(table, k, &mail);
        comm_mail_exchange(&mail, comm);
        for (int q = 0; q < comm->n_ranks && comm->rank == 0; q++)
            put_pieces(table, k, &mail, q, h5);
    }
    comm_mail_clear(&mail);
}

void table_measure(struct table *table, struct h5 *h5)
{
    for (int k = 0; k < table->n_columns; k++) {
        char *path = column_path(table, k), *sums_path = checksum_path(table, k);
        const int64_t n = h5_count_rows(h5, path, &table->columns[k].field);
        const int64_t n_sums = h5_count_rows(h5, sums_path, &CHECKSUM);
        if (k == 0)
            table->n_total = n;
        if (n != table->n_total || n_sums != n_blocks(n))
            h5_fail(h5, "%s and its neighbours differ in length", path);
        free(path);
        free(sums_path);
    }
}

static void read_column(struct table *table, int k, struct h5 *h5)
{
    const struct table_column *column = &table->columns[k];
    const size_t size = field_size(&column->field);
    const int64_t n_sums = n_blocks(table->n);
    unsigned char *rows = array_allocate((size_t)table->n, size);
    int64_t *stored = array_allocate((size_t)n_sums, sizeof *stored);
    char *path = column_path(table, k), *sums_path = checksum_path(table, k);
    h5_read_rows(h5, path, &column->field, table->begin, table->n, rows);
    h5_read_rows(h5, sums_path, &CHECKSUM, n_blocks(table->begin), n_sums, stored);
    int64_t *sums = block_sums(rows, size, table->n);
    for (int64_t b = 0; b < n_sums; b++)
        if (sums[b] != stored[b])
            h5_fail(h5, "%s: the checksum of rows %lld and following is wrong", path,
                    (long long)(table->begin + b * TABLE_BLOCK));
    for (int64_t i = 0; i < table->n; i++)
        memcpy(record(table, i) + column->offset, rows + (size_t)i * size, size);
    free(path);
    free(sums_path);
    free(sums);
    free(stored);
    free(rows);
}

/* This rank's slice of n rows from `first` on. */
static void read_slice(struct table *table, struct h5 *h5, const struct comm *comm,
                       int64_t n_ids, int64_t first, int64_t n)
{
    const int64_t begin = slice_begin(table, n, comm->rank, comm->n_ranks);
    table->begin = first + begin;
    table->n = slice_begin(table, n, comm->rank + 1, comm->n_ranks) - begin;
    free(table->records);
    table->records = array_allocate((size_t)table->n, table->record_size);
    for (int k = 0; k < table->n_columns; k++)
        read_column(table, k, h5);
    for (int64_t i = 0; i < table->n; i++) {
        const int64_t id = table_id(table, i);
        if (id < 0 || id >= n_ids)
            h5_fail(h5, "/%s: id %lld is not below %lld", table->name, (long long)id,
                    (long long)n_ids);
        else if (i > 0 && table->compare(record(table, i - 1), record(table, i)) >= 0)
            h5_fail(h5, "/%s: id %lld is out of order", table->name, (long long)id);
    }
}

void table_read(struct table *table, struct h5 *h5, const struct comm *comm, int64_t n_ids)
{
    read_slice(table, h5, comm, n_ids, 0, table->n_total);
}

void table_read_part(struct table *table, struct h5 *h5, const struct comm *comm, int64_t n_ids,
                     int64_t part, int64_t n_parts)
{
    const int64_t most = (n_blocks(table->n_total) + n_parts - 1) / n_parts * TABLE_BLOCK;
    const int64_t first = part * most < table->n_total ? part * most : table->n_total;
    const int64_t left = table->n_total - first;
    read_slice(table, h5, comm, n_ids, first, left < most ? left : most);
}

/* ----------------------------------------------------------------------------------- follow */

/* The first id of every rank's slice; a slice without records begins where the next one does.
 * *why says when slices overlap. */
static int64_t *first_ids(const struct table *table, const struct comm *comm, char **why)
{
    const int n_ranks = comm->n_ranks;
    const int64_t own[2] = {table->n > 0 ? table_id(table, 0) : -1,
                            table->n > 0 ? table_id(table, table->n - 1) : -1};
    int64_t(*all)[2] = array_allocate((size_t)n_ranks, sizeof *all);
    comm_gather_all(comm, own, all, sizeof own);
    int64_t *first = array_allocate((size_t)n_ranks, sizeof *first);
    int64_t next = INT64_MAX;
    for (int q = n_ranks - 1; q >= 0; q--) {
        if (all[q][1] >= next && *why == NULL)
            *why = array_format("/%s: ids are out of order", table->name);
        next = all[q][0] >= 0 ? all[q][0] : next;
        first[q] = next;
    }
    free(all);
    return first;
}

/* The last rank whose slice does not begin after this id; 0 when all do. */
static int rank_of(const int64_t *first, int n_ranks, int64_t id)
{
    int low = 0, high = n_ranks;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (first[middle] <= id)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static bool has_id(const struct table *table, int64_t id)
{
    int64_t low = 0, high = table->n;
    while (low < high) {
        const int64_t middle = (low + high) / 2;
        if (table_id(table, middle) < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low < table->n && table_id(table, low) == id;
}

static void send_to_owners(struct table *table, const struct comm *comm, const int64_t *first,
                           int n_ids)
{
    struct comm_mail mail;
    comm_mail_init(&mail, comm);
    comm_mail_begin(&mail);
    for (int64_t i = 0; i < table->n; i++) {
        int64_t ids[2];
        memcpy(ids, record(table, i), (size_t)n_ids * sizeof *ids);
        const int q = rank_of(first, comm->n_ranks, ids[0]);
        const int p = rank_of(first, comm->n_ranks, ids[n_ids - 1]);
        comm_mail_pack(&mail, q, record(table, i), table->record_size);
        if (p != q)
            comm_mail_pack(&mail, p, record(table, i), table->record_size);
    }
    receive(table, &mail, comm);
    comm_mail_clear(&mail);
}

char *table_follow(struct table *table, const struct comm *comm, const struct table *owners,
                   int n_ids)
{
    CHECK(n_ids == 1 || n_ids == 2, "records of %d ids", n_ids);
    char *why = NULL;
    int64_t *first = first_ids(owners, comm, &why);
    if (comm->n_ranks > 1)
        send_to_owners(table, comm, first, n_ids);
    for (int64_t i = 0; i < table->n; i++)
        for (int k = 0; k < n_ids && why == NULL; k++) {
            int64_t id;
            memcpy(&id, record(table, i) + (size_t)k * sizeof id, sizeof id);
            if (rank_of(first, comm->n_ranks, id) == comm->rank && !has_id(owners, id))
                why = array_format("/%s: there is no id %lld", table->name, (long long)id);
        }
    free(first);
    return why;
}
