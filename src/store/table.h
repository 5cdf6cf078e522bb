/*
 * Records spread over ranks, in a file: sorted by key, cut into contiguous slices, one rank a
 * slice, each member of the record a data set of its own ("column") in a group named after the
 * table.
 *
 * Beside each column stand CRC-32 checksums of its blocks of TABLE_BLOCK rows, in /checksums
 * under the same path.  Slices are whole blocks, so every block is written, summed and verified
 * by one rank, and neither blocks nor bytes depend on the number of ranks; those of a packed
 * table are whole pieces (store/h5.h), which their ranks pack.  A drawback: below TABLE_BLOCK
 * rows a rank, or a piece, some ranks have nothing to do.  All that one rank sends another must
 * fit 2 GiB.
 *
 * Records are here all at once (table_arrange), or are collected while the file is written,
 * part by part (table_stream), which takes no more memory for more rows and gives the same
 * bytes.
 */
#ifndef TREMIE_STORE_TABLE_H
#define TREMIE_STORE_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/field.h"

struct comm;
struct h5;

enum { TABLE_BLOCK = 256, TABLE_COLUMNS_MAX = 16 };

struct table_column {
    struct field field;
    size_t offset; /* within a record [bytes] */
};

struct table {
    const char *name;
    int n_columns;
    struct table_column columns[TABLE_COLUMNS_MAX];
    size_t record_size;                           /* a record begins with its int64 id */
    int (*compare)(const void *a, const void *b); /* by key; the id comes first in it */
    bool packed;                                  /* columns are compressed in the file */
    int64_t n_total;                              /* records on all ranks */
    int64_t begin, n;                             /* those here: begin .. begin + n - 1 */
    unsigned char *records;
    size_t capacity; /* of records, as table_append() fills them [bytes] */
    /* Of a table that is streamed: appends the records whose id lies in begin .. end - 1, in
     * any order; ids are below n_ids.  Else NULL. */
    void (*collect)(struct table *table, const void *from, int64_t begin, int64_t end);
    const void *from;
    int64_t n_ids;
    int64_t part_bytes; /* that a rank holds of it at a time, about */
};

void table_init(struct table *table, const char *name, size_t record_size,
                int (*compare)(const void *, const void *));
void table_clear(struct table *table);
void table_add_column(struct table *table, const struct field *field, size_t offset);

/* Adds n records behind those that are here.  Local. */
void table_append(struct table *table, const void *records, int64_t n);

/* Sorts the n records that each rank holds into slices; ids lie in 0 .. n_ids - 1, keys are
 * unique. Collective. */
void table_arrange(struct table *table, const struct comm *comm, int64_t n_ids);

/* Bytes that the table takes in a file.  Local. */
int64_t table_file_size(const struct table *table);
/* Lays out all n_total rows: one process.  Local. */
void table_declare(const struct table *table, struct h5 *h5);
/* Puts the rows of a packed table into the new file that rank 0 lays out; the others' `h5` is
 * not used.  Collective. */
void table_pack(const struct table *table, const struct comm *comm, struct h5 *h5);
/* Writes this rank's slice, unless packed, and its checksums.  Local. */
void table_write(const struct table *table, struct h5 *h5);
/* Collects and writes all n_total rows with their checksums; none are here afterwards.
 * Collective. */
void table_stream(struct table *table, const struct comm *comm, struct h5 *h5);

/* Finds n_total, with all columns and checksums compared in type and length.  Local. */
void table_measure(struct table *table, struct h5 *h5);
/* Given n_total, reads this rank's slice, verifying checksums, that ids lie in 0 .. n_ids - 1
 * and that keys ascend.  Local. */
void table_read(struct table *table, struct h5 *h5, const struct comm *comm, int64_t n_ids);

/* In how many parts a rank deals with a table, so that it never holds much of it.  The same on
 * all ranks. */
int64_t table_n_parts(const struct table *table, const struct comm *comm);
/* The same as table_read() of one of n_parts parts of the rows, of which this rank reads a
 * slice.  Local. */
void table_read_part(struct table *table, struct h5 *h5, const struct comm *comm, int64_t n_ids,
                     int64_t part, int64_t n_parts);

/* After table_read of both: sends each record to the ranks in whose slice of `owners` its ids
 * lie; the first n_ids int64 of a record are ids.  Returns NULL, or what is wrong (an id that
 * no slice has), which the caller frees.  Collective. */
char *table_follow(struct table *table, const struct comm *comm, const struct table *owners,
                   int n_ids);

static inline int64_t table_id(const struct table *table, int64_t i)
{
    int64_t id;
    memcpy(&id, table->records + (size_t)i * table->record_size, sizeof id);
    return id;
}

#endif
