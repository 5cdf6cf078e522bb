/*
 * A table that describes every key of a file, and what follows from it: reading with checks and
 * messages, writing back with defaults, the reference page.
 *
 * A row names a key, its type, unit, bounds, default and meaning, and where in a struct the
 * value goes.  Rows of groups, lists and mappings point to further tables.  Values are stored
 * in SI units.
 */
#ifndef TREMIE_JOB_SCHEMA_H
#define TREMIE_JOB_SCHEMA_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

struct mistakes;
struct yaml_tree_node;

enum schema_type {
    SCHEMA_TEXT,      /* char *: any text */
    SCHEMA_NAME,      /* char *: letters, digits, - and _ */
    SCHEMA_FILE,      /* char *: a path relative to the file that holds it; made absolute */
    SCHEMA_FLAG,      /* bool */
    SCHEMA_NUMBER,    /* double, or a list of as many as `size` holds */
    SCHEMA_DIRECTION, /* three doubles, made length 1 */
    SCHEMA_COUNT,     /* int64_t: a whole number */
    SCHEMA_INT,       /* int: a whole number, or a list of as many as `size` holds */
    SCHEMA_CHOICE,    /* an enum: index into `choices`; with size 0 only checked */
    SCHEMA_CHOICES,   /* int: a set of bits 1 << index into `choices` */
    SCHEMA_REFERENCE, /* int: index of a name in the reader's list, or a list of as many */
    SCHEMA_NUMBERS,   /* double * and a count: a list of numbers */
    SCHEMA_POINTS,    /* struct vec3 * and a count: a list of [x, y, z] */
    SCHEMA_FACETS,    /* int (*)[4] and a count: a list of 3 or 4 indices, the fourth else -1 */
    SCHEMA_GROUP,     /* a mapping whose values go to the same struct, or to one inside it */
    SCHEMA_LIST,      /* pointer and count: a list of mappings */
    SCHEMA_NAMED, /* pointer and count: a mapping of at most `max` names to mappings; the name
                     is the element's first member */
    SCHEMA_ELSEWHERE, /* read elsewhere: described here only; `word` says what is expected */
};

enum schema_bound {
    SCHEMA_AT_LEAST = 1,
    SCHEMA_ABOVE = 2,
    SCHEMA_AT_MOST = 4,
    SCHEMA_BELOW = 8
};

struct schema_key {
    const char *name; /* NULL ends a table */
    enum schema_type type;
    const char *help;     /* its meaning */
    const char *unit;     /* numbers: SI unit, "1" for a pure number */
    const char *standard; /* default as YAML; NULL where there is none */
    bool required;
    int bounds; /* set of enum schema_bound; for lists of the number of elements */
    double min, max;
    const char *word; /* may stand for a number, and then gives word_value */
    double word_value;
    const char *const *choices; /* NULL ends it */
    unsigned kinds; /* applies only where the table's `kind` (or `model`) is one of these bits;
                     0: always */
    size_t offset, size;
    /* An optional key without a default is present when these bytes are not all zero; a bool
     * among them is set when it is read. */
    size_t given, given_size;
    size_t count;   /* offset of the int that counts elements */
    size_t element; /* bytes of an element */
    bool single;    /* a list of mappings: a mapping alone stands for a list of one */
    const struct schema_key *inside;
};

struct schema_reader {
    struct mistakes *mistakes;
    int n_names; /* what SCHEMA_REFERENCE may name */
    const char *const *names;
};

/* More mistakes than these are not listed. */
enum { SCHEMA_MISTAKES = 200 };

/* Fills a zeroed struct from a node.  All mistakes are listed; what is wrong stays zero.
 * `path` names the node in messages ("" for the root).  Local. */
void schema_read(const struct schema_reader *reader, const struct schema_key *table,
                 const struct yaml_tree_node *node, const char *path, void *into);

/* Writes a struct as YAML that reads back equal. */
void schema_write(FILE *out, const struct schema_key *table, const void *from,
                  const char *const *names);

/* Frees what reading allocated inside the struct. */
void schema_clear(const struct schema_key *table, void *from);

/* Does what this key says decide which of the table's keys apply? */
bool schema_tells_kind(const struct schema_key *key);

/* What a value of this key should be, in words: "a length above 0 m". */
enum { SCHEMA_EXPECTED = 240 };
const char *schema_expected(const struct schema_key *key, char text[SCHEMA_EXPECTED]);

/* Writes the reference of a table in Markdown: one section a group, one row a key. */
void schema_reference(FILE *out, const struct schema_key *table);

/* The candidate nearest to a word when it is near enough to be meant; else NULL. */
const char *schema_suggestion(const char *word, const char *const *candidates, int n);

/* A path relative to the folder of `file`, which names it, made absolute.  The caller frees
 * it. */
char *schema_path(const char *path, const char *file);

/* A double as text, as short as reads back equal. */
enum { SCHEMA_DOUBLE = 32 };
const char *schema_double(char text[SCHEMA_DOUBLE], double value);

#endif
