/*
 * What an HDF5 file of ours holds, found out from the file itself: every data set and every
 * attribute of a group, sorted by path, so that tools need not know what there is and new
 * fields need no new code.
 *
 * Paths are those of the file, an attribute's with an @: "/spheres/position", "/run@step".
 * Numbers are read as int64_t or double, whichever keeps their bits.
 */
#ifndef TREMIE_POSTPROC_CONTENT_H
#define TREMIE_POSTPROC_CONTENT_H

#include <stdint.h>

enum content_kind { CONTENT_INT, CONTENT_DOUBLE, CONTENT_TEXT, CONTENT_OTHER };

struct content_item {
    char *path;
    enum content_kind kind;
    int64_t n_rows, width; /* a single value: 1 and 1; a text: 1 and its length */
};

struct content {
    int64_t file; /* HDF5's handle */
    int n, capacity;
    struct content_item *items;
};

/* Returns NULL, or the reason, which the caller frees; then there is nothing to clear. */
char *content_open(struct content *content, const char *path);
void content_clear(struct content *content);

/* NULL when there is none of this path. */
const struct content_item *content_find(const struct content *content, const char *path);

/* All values, or the text with a closing zero; the caller frees them.  NULL when they cannot be
 * read or are of another kind. */
int64_t *content_ints(const struct content *content, const struct content_item *item);
double *content_doubles(const struct content *content, const struct content_item *item);
char *content_text(const struct content *content, const struct content_item *item);
/* A text attribute of an object, such as its unit; "" when there is none.  The caller frees
 * it. */
char *content_note(const struct content *content, const char *object, const char *name);

#endif
