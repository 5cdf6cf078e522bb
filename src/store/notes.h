/*
 * Notes: small state in checkpoints that belongs to no sphere and no contact, and is the same
 * on all ranks: where a driven body is, how far an insertion has come.
 *
 * A note is a name and up to NOTES_WIDTH numbers, all doubles or all int64.  In the file it is
 * the data set /state/NAME with its CRC-32 as attribute `checksum`; /state/names lists them,
 * one a line with its type ("double piston.state").  A file without /state has no notes.
 * Whoever adds a note when a checkpoint is written takes it by the same name when one is read.
 *
 * All functions are local; ranks that call them alike hold the same.
 */
#ifndef TREMIE_STORE_NOTES_H
#define TREMIE_STORE_NOTES_H

#include <stdbool.h>
#include <stdint.h>

struct h5;

enum { NOTES_WIDTH = 32, NOTES_NAME_SIZE = 64 };

struct note {
    char name[NOTES_NAME_SIZE]; /* letters, digits, ".", "-" and "_" */
    bool whole;                 /* int64, else doubles */
    int n;
    union {
        double reals[NOTES_WIDTH];
        int64_t ints[NOTES_WIDTH];
    } values;
};

struct notes {
    int n, capacity;
    struct note *list;
};

void notes_clear(struct notes *notes);
/* A new note; its name must be new. */
void notes_add(struct notes *notes, const char *name, int n, const double *values);
void notes_add_ints(struct notes *notes, const char *name, int n, const int64_t *values);
/* Copies a note's numbers.  False, having said which one is missing, when there is none of that
 * name, type and length. */
bool notes_take(const struct notes *notes, const char *name, int n, double *values);
bool notes_take_ints(const struct notes *notes, const char *name, int n, int64_t *values);
/* CRC-32 of all of it, by which ranks see that they hold the same. */
int64_t notes_checksum(const struct notes *notes);

/* To and from a file (store/h5); failures are noted there. */
void notes_put(const struct notes *notes, struct h5 *h5);
void notes_get(struct notes *notes, struct h5 *h5);

#endif
