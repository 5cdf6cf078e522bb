/* See notes.h. */
#include "store/notes.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "store/crc32.h"
#include "store/h5.h"

static const char GROUP[] = "/state", NAMES[] = "/state/names";

static struct field field_of(bool whole)
{
    return (struct field){
        "note", "1", "a note: see its name", whole ? FIELD_INT64 : FIELD_DOUBLE, 1, 0};
}

static int64_t checksum(const void *bytes, size_t n)
{
    struct crc32 crc;
    crc32_init(&crc);
    return crc32_of(&crc, bytes, n);
}

void notes_clear(struct notes *notes)
{
    free(notes->list);
    *notes = (struct notes){0};
}

/* The note of a name; NULL where there is none. */
static const struct note *find(const struct notes *notes, const char *name)
{
    for (int k = 0; k < notes->n; k++)
        if (strcmp(notes->list[k].name, name) == 0)
            return &notes->list[k];
    return NULL;
}

static void add(struct notes *notes, const char *name, bool whole, int n, const void *values)
{
    CHECK(n > 0 && n <= NOTES_WIDTH, "a note of %d numbers", n);
    CHECK(strlen(name) < NOTES_NAME_SIZE && find(notes, name) == NULL, "a note '%s'", name);
    ARRAY_GROW(notes->list, notes->n + 1, notes->capacity);
    struct note *note = &notes->list[notes->n++];
    memset(note, 0, sizeof *note);
    memcpy(note->name, name, strlen(name));
    note->whole = whole;
    note->n = n;
    memcpy(&note->values, values, (size_t)n * sizeof *note->values.reals);
}

void notes_add(struct notes *notes, const char *name, int n, const double *values)
{
    add(notes, name, false, n, values);
}

void notes_add_ints(struct notes *notes, const char *name, int n, const int64_t *values)
{
    add(notes, name, true, n, values);
}

static bool take(const struct notes *notes, const char *name, bool whole, int n, void *values)
{
    const struct note *note = find(notes, name);
    if (note == NULL || note->whole != whole || note->n != n) {
        report_error("the checkpoint holds no state '%s' of %d %s; use the job it belongs to",
                     name, n, whole ? "whole numbers" : "numbers");
        return false;
    }
    memcpy(values, &note->values, (size_t)n * sizeof *note->values.reals);
    return true;
}

bool notes_take(const struct notes *notes, const char *name, int n, double *values)
{
    return take(notes, name, false, n, values);
}

bool notes_take_ints(const struct notes *notes, const char *name, int n, int64_t *values)
{
    return take(notes, name, true, n, values);
}

int64_t notes_checksum(const struct notes *notes)
{
    return checksum(notes->list, (size_t)notes->n * sizeof *notes->list);
}

void notes_put(const struct notes *notes, struct h5 *h5)
{
    if (notes->n == 0)
        return;
    char *names = array_string("");
    h5_group(h5, GROUP);
    for (int k = 0; k < notes->n; k++) {
        const struct note *note = &notes->list[k];
        const struct field field = field_of(note->whole);
        char *longer =
            array_format("%s%s %s\n", names, note->whole ? "int64" : "double", note->name);
        char *path = array_format("%s/%s", GROUP, note->name);
        h5_declare_rows(h5, path, &field, note->n);
        h5_write_rows(h5, path, &field, 0, note->n, &note->values);
        h5_put_int(h5, path, "checksum",
                   checksum(&note->values, (size_t)note->n * sizeof *note->values.reals));
        free(path);
        free(names);
        names = longer;
    }
    h5_put_document(h5, NAMES, names);
    h5_put_int(h5, NAMES, "checksum", checksum(names, strlen(names)));
    free(names);
}

static void get_note(struct notes *notes, struct h5 *h5, const char *name, bool whole)
{
    struct note note = {.whole = whole};
    const struct field field = field_of(whole);
    char *path = array_format("%s/%s", GROUP, name);
    const int64_t n = h5_count_rows(h5, path, &field);
    if (h5->why == NULL && (n < 1 || n > NOTES_WIDTH || find(notes, name) != NULL))
        h5_fail(h5, "%s: %" PRId64 " numbers, or there twice", path, n);
    if (h5->why == NULL) {
        h5_read_rows(h5, path, &field, 0, n, &note.values);
        if (h5_get_int(h5, path, "checksum") !=
            checksum(&note.values, (size_t)n * sizeof *note.values.reals))
            h5_fail(h5, "%s: the checksum is wrong", path);
        add(notes, name, whole, (int)n, &note.values);
    }
    free(path);
}

void notes_get(struct notes *notes, struct h5 *h5)
{
    if (!h5_has(h5, GROUP))
        return;
    char *names = h5_get_document(h5, NAMES);
    if (h5_get_int(h5, NAMES, "checksum") != checksum(names, strlen(names)))
        h5_fail(h5, "%s: the checksum is wrong", NAMES);
    for (const char *at = names; *at != '\0' && h5->why == NULL; at += strcspn(at, "\n") + 1) {
        char name[NOTES_NAME_SIZE];
        const bool whole = strncmp(at, "int64 ", 6) == 0;
        const char *begin = at + strcspn(at, " \n");
        const size_t length = strcspn(begin, "\n");
        if (length < 2 || length > NOTES_NAME_SIZE || begin[length] != '\n') {
            h5_fail(h5, "%s: a name is missing", NAMES);
            break;
        }
        memcpy(name, begin + 1, length - 1);
        name[length - 1] = '\0';
        get_note(notes, h5, name, whole);
    }
    free(names);
}
