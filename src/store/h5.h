/*
 * HDF5, checked.
 *
 * The first failure of a file is kept as `why` and everything after it does nothing, so a
 * sequence of calls reads straight on and is tested once, at the end.  HDF5 itself prints
 * nothing.  Objects are named by their path in the file.  Bytes depend on nothing but what is
 * written: no times, one format version, little-endian.  Reading never trusts the file: type
 * and shape are compared with what is expected.
 *
 * Row data lie contiguous and unfiltered, in space that exists once h5_save() has returned;
 * writing rows changes none of the rest.  So one process may lay the file out and many fill it
 * in.  Packed rows (shuffled and deflated, which loses nothing) come in pieces, into a new file
 * only.
 */
#ifndef TREMIE_STORE_H5_H
#define TREMIE_STORE_H5_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/field.h"

struct comm;

enum { H5_PIECE_ROWS = 8192 };

struct h5 {
    int64_t file; /* HDF5's handle, negative when closed */
    int memory;   /* descriptor of a new file's memory, negative when there is none */
    char *why;    /* the first failure, NULL while all is well; its user frees it */
};

/* A new, empty file at `path`; what is put into it stays in memory until h5_save().  Local. */
void h5_create(struct h5 *h5, const char *path);
/* Closes a new file and puts it on the disk, with space for rows not yet written.  Local. */
void h5_save(struct h5 *h5, const char *path);
/* For reading, by one process.  Local. */
void h5_open(struct h5 *h5, const char *path);
/* For all ranks to write rows that were declared.  When that fails on some rank, no rank may
 * close the file, nor end in MPI_Finalize: they would wait for each other.  Collective. */
void h5_open_shared(struct h5 *h5, const char *path, const struct comm *comm);
/* After all rows have been written to the shared file at `path`: whatever closing it writes,
 * metadata as they are there already, goes nowhere, so that closing cannot fail.  Local. */
void h5_let_go(struct h5 *h5, const char *path);
/* Closes the file, if it is open.  Collective after h5_open_shared, else local. */
void h5_close(struct h5 *h5);
/* Notes a failure found by the caller, unless there was one already.  Local. */
void h5_fail(struct h5 *h5, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* All below are local. */
void h5_group(struct h5 *h5, const char *path);
void h5_put_text(struct h5 *h5, const char *object, const char *name, const char *text);
void h5_put_int(struct h5 *h5, const char *object, const char *name, int64_t value);
void h5_put_double(struct h5 *h5, const char *object, const char *name, double value);
/* The caller frees the text; "" after a failure. */
char *h5_get_text(struct h5 *h5, const char *object, const char *name);
int64_t h5_get_int(struct h5 *h5, const char *object, const char *name);
double h5_get_double(struct h5 *h5, const char *object, const char *name);
/* Looks at all objects and attributes of the file, so that HDF5 verifies its own checksums of
 * parts that nobody asks for. */
void h5_look_around(struct h5 *h5);
/* Is there an object of this path? */
bool h5_has(struct h5 *h5, const char *path);

/* A long text as an object of its own. */
void h5_put_document(struct h5 *h5, const char *path, const char *text);
char *h5_get_document(struct h5 *h5, const char *path);

/* Lays out n rows of a field, with its unit and description. */
void h5_declare_rows(struct h5 *h5, const char *path, const struct field *field, int64_t n);
/* The same for packed rows. */
void h5_declare_packed_rows(struct h5 *h5, const char *path, const struct field *field,
                            int64_t n);
/* Rows begin .. begin + n - 1, side by side in memory; none when n is 0. */
void h5_write_rows(struct h5 *h5, const char *path, const struct field *field, int64_t begin,
                   int64_t n, const void *rows);
void h5_read_rows(struct h5 *h5, const char *path, const struct field *field, int64_t begin,
                  int64_t n, void *rows);
/* The number of rows there are, after comparing type and width; 0 after a failure. */
int64_t h5_count_rows(struct h5 *h5, const char *path, const struct field *field);
/* Type and width of a data set (the caller's name and unit stay); its number of rows, 0 after
 * a failure. */
int64_t h5_find_rows(struct h5 *h5, const char *path, struct field *field);

/* A piece of n of the n_total rows as it stands in a file, `size` bytes; the caller frees it.
 * A piece is the H5_PIECE_ROWS rows from a multiple of as many on, or those that are left. */
unsigned char *h5_pack(const struct field *field, int64_t n_total, int64_t n, const void *rows,
                       size_t *size);
/* Puts the piece that begins with row `begin` into rows that were declared packed. */
void h5_put_packed(struct h5 *h5, const char *path, int64_t begin, size_t size,
                   const void *packed);

/* Makes `path` stand for an object of another file, named relative to this file's folder. */
void h5_link(struct h5 *h5, const char *path, const char *file, const char *object);

/* A whole column of doubles with HDF5's own Fletcher32 checksum, which any reader verifies. */
void h5_put_column(struct h5 *h5, const char *path, const struct field *field, int64_t n,
                   const double *values);

#endif
