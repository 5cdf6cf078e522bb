/*
 * What tremie says to people, and the three ways to fail.
 *
 * - The user's mistake: collected in a `struct mistakes`, all printed at once as
 *   `file:line:column: what is wrong; what is expected`, then exit 2.
 * - The machine's (disk, file, memory): `report_error(what, what to do)` on one rank, then a
 *   status that all ranks agree on (exit 4).
 * - Ours: CHECK(condition, ...) stops all ranks with the reason (exit 70).
 *
 * Only the speaking rank (0 unless told otherwise) prints; CHECK speaks from any rank.  The log
 * file is, with MPI itself, the only global state of the program.
 */
#ifndef TREMIE_BASE_REPORT_H
#define TREMIE_BASE_REPORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

/* Exit statuses of `tremie` (documented in README.md). */
enum report_exit {
    REPORT_FINISHED = 0,
    REPORT_BAD_INPUT = 2,
    REPORT_UNSTABLE = 3,
    REPORT_STORAGE = 4,
    REPORT_BUG = 70,
    REPORT_STOPPED = 75, /* stopped early with a checkpoint: requeue me */
};

/* Tells the module whether this process speaks.  Local. */
void report_init(bool speaks);

/* Also writes everything said from now on to this file, appended.  Returns false, having said
 * why, when the file cannot be opened.  Does nothing on silent ranks.  Local. */
bool report_log_open(const char *path);
void report_log_close(void);

/* A line for the person at the terminal and the log (printf format, no newline needed). */
void report_say(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* A line for the log alone. */
void report_note(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* `warning: ...` */
void report_warn(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* `error: what happened; what to do`: the text is formatted like printf's. */
void report_error(const char *format, ...) __attribute__((format(printf, 1, 2)));
/* Progress on one line that overwrites itself on a terminal; elsewhere a line only when
 * `keep`. */
void report_progress(bool keep, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Stops every rank at once with our exit status for bugs. */
_Noreturn void report_bug(const char *file, int line, const char *condition, const char *format,
                          ...) __attribute__((format(printf, 4, 5)));

/* Stops every rank at once, as there is no memory of that size, with the status of what the
 * machine fails in. */
_Noreturn void report_no_memory(size_t bytes);

#define CHECK(condition, ...)                                                                  \
    do {                                                                                       \
        if (!(condition))                                                                      \
            report_bug(__FILE__, __LINE__, #condition, __VA_ARGS__);                           \
    } while (0)

/* The user's mistakes, collected in the order they are found, printed sorted by place. */
struct mistake {
    char *file;
    int line, column; /* from 1; 0 when a place has no meaning (the file as a whole) */
    char *text;       /* "what is wrong; what is expected" */
};

struct mistakes {
    int n, capacity;
    struct mistake *list;
};

void mistakes_init(struct mistakes *mistakes);
void mistakes_clear(struct mistakes *mistakes);
void mistakes_add(struct mistakes *mistakes, const char *file, int line, int column,
                  const char *format, ...) __attribute__((format(printf, 5, 6)));
/* Prints all of them on the speaking rank, one a line, sorted by file, line and column. */
void mistakes_print(const struct mistakes *mistakes);

#endif
