/*
 * Words of a text in memory that know where they stand: for files of numbers and keywords.
 */
#ifndef TREMIE_BASE_SCAN_H
#define TREMIE_BASE_SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A place in a text; the text ends with a zero after its n bytes. */
struct scan {
    const char *path; /* for messages */
    const char *at, *end;
    const char *line_start;
    int line;
    const char *word; /* the last word, and its length; not ended by a zero */
    size_t length;
    char *why; /* the first complaint; the caller frees it */
};

void scan_init(struct scan *scan, const char *path, const char *text, size_t n);
/* The next word, between blanks; false at the end of the text. */
bool scan_word(struct scan *scan);
/* The next word of this line; false, without going on, where the line ends. */
bool scan_word_of_line(struct scan *scan);
/* Leaves out what is left of this line. */
void scan_skip_line(struct scan *scan);
/* Is the last word this one, whatever its letters' case? */
bool scan_is(const struct scan *scan, const char *word);
/* The next word must be this one, a finite number, or a whole number from `least` to `most`;
 * else a complaint names `what` was expected. */
bool scan_expect(struct scan *scan, const char *word, const char *what);
bool scan_number(struct scan *scan, double *value, const char *what);
bool scan_whole(struct scan *scan, int64_t least, int64_t most, int64_t *value,
                const char *what);
/* Complains at the last word: "path:line:column: what". Returns false. */
bool scan_complain(struct scan *scan, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
/* Complains that the next word (or the end) is not what is expected. Returns false. */
bool scan_refuse(struct scan *scan, const char *expected);

#endif
