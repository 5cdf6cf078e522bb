/*
 * Messages go to standard error, except what report_say() says (standard output), and all of
 * them to the log when there is one.  See report.h for the three ways to fail.
 */
#include "base/report.h"

#include <errno.h>
#include <mpi.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include "base/array.h"

static bool report_speaks = true;
static bool report_line_open; /* a progress line stands unfinished on the terminal */
static FILE *report_log;

void report_init(bool speaks)
{
    report_speaks = speaks;
}

bool report_log_open(const char *path)
{
    if (!report_speaks)
        return true;
    report_log_close();
    report_log = fopen(path, "a");
    if (report_log == NULL) {
        report_error("cannot open the log %s: %s; check that the folder can be written to",
                     path, strerror(errno));
        return false;
    }
    setvbuf(report_log, NULL, _IOLBF, 0);
    return true;
}

void report_log_close(void)
{
    if (report_log != NULL)
        fclose(report_log);
    report_log = NULL;
}

static void log_line(const char *label, const char *format, va_list arguments)
    __attribute__((format(printf, 2, 0)));
static void log_line(const char *label, const char *format, va_list arguments)
{
    if (report_log == NULL)
        return;
    const time_t now = time(NULL);
    struct tm parts;
    char stamp[32] = "";
    if (localtime_r(&now, &parts) != NULL)
        strftime(stamp, sizeof stamp, "%Y-%m-%d %H:%M:%S ", &parts);
    fputs(stamp, report_log);
    fputs(label, report_log);
    vfprintf(report_log, format, arguments);
    fputc('\n', report_log);
}

static void line_finish(void)
{
    if (report_line_open)
        fputc('\n', stderr);
    report_line_open = false;
}

static void speak(FILE *stream, const char *label, const char *format, va_list arguments)
    __attribute__((format(printf, 3, 0)));
static void speak(FILE *stream, const char *label, const char *format, va_list arguments)
{
    if (!report_speaks)
        return;
    va_list copy;
    va_copy(copy, arguments);
    line_finish();
    fflush(stream == stdout ? stderr : stdout);
    fputs(label, stream);
    vfprintf(stream, format, arguments);
    fputc('\n', stream);
    fflush(stream);
    log_line(label, format, copy);
    va_end(copy);
}

void report_say(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    speak(stdout, "", format, arguments);
    va_end(arguments);
}

void report_note(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    if (report_speaks)
        log_line("", format, arguments);
    va_end(arguments);
}

void report_warn(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    speak(stderr, "warning: ", format, arguments);
    va_end(arguments);
}

void report_error(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    speak(stderr, "error: ", format, arguments);
    va_end(arguments);
}

void report_progress(bool keep, const char *format, ...)
{
    if (!report_speaks)
        return;
    va_list arguments;
    va_start(arguments, format);
    if (isatty(STDERR_FILENO)) {
        fputs("\r\033[K", stderr);
        vfprintf(stderr, format, arguments);
        report_line_open = true;
        if (keep)
            line_finish();
        fflush(stderr);
    } else if (keep) {
        speak(stderr, "", format, arguments);
    }
    va_end(arguments);
}

/* MPI's rank, as far as there is one, and the end of all of them. */
static int own_rank(void)
{
    int initialized = 0, finalized = 0, rank = 0;
    MPI_Initialized(&initialized);
    MPI_Finalized(&finalized);
    if (!initialized || finalized)
        return -1;
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    return rank;
}

static _Noreturn void stop_all(int status)
{
    fflush(NULL);
    if (own_rank() >= 0)
        MPI_Abort(MPI_COMM_WORLD, status);
    _exit(status);
}

void report_bug(const char *file, int line, const char *condition, const char *format, ...)
{
    const int rank = own_rank();
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "error: %s:%d: rank %d: ", file, line, rank > 0 ? rank : 0);
    vfprintf(stderr, format, arguments);
    fprintf(stderr, " (%s is false); this is a bug in tremie, please report it\n", condition);
    va_end(arguments);
    stop_all(REPORT_BUG);
}

void report_no_memory(size_t bytes)
{
    fprintf(stderr,
            "error: out of memory: %zu bytes more were asked for; use a smaller job, more "
            "machines, or a greater limit of memory\n",
            bytes);
    stop_all(REPORT_STORAGE);
}

/* ---------------------------------------------------------------------- the user's mistakes */

void mistakes_init(struct mistakes *mistakes)
{
    *mistakes = (struct mistakes){0};
}

void mistakes_clear(struct mistakes *mistakes)
{
    for (int i = 0; i < mistakes->n; i++) {
        free(mistakes->list[i].file);
        free(mistakes->list[i].text);
    }
    free(mistakes->list);
    mistakes_init(mistakes);
}

void mistakes_add(struct mistakes *mistakes, const char *file, int line, int column,
                  const char *format, ...)
{
    va_list arguments, copy;
    va_start(arguments, format);
    va_copy(copy, arguments);
    const int length = vsnprintf(NULL, 0, format, arguments);
    CHECK(length >= 0, "cannot format a message");
    char *text = array_allocate((size_t)length + 1, 1);
    vsnprintf(text, (size_t)length + 1, format, copy);
    va_end(copy);
    va_end(arguments);
    ARRAY_GROW(mistakes->list, mistakes->n + 1, mistakes->capacity);
    mistakes->list[mistakes->n++] = (struct mistake){array_string(file), line, column, text};
}

static int compare_places(const void *a, const void *b)
{
    const struct mistake *p = a, *q = b;
    const int by_file = strcmp(p->file, q->file);
    if (by_file != 0)
        return by_file;
    return p->line != q->line ? p->line - q->line : p->column - q->column;
}

void mistakes_print(const struct mistakes *mistakes)
{
    if (mistakes->n == 0)
        return;
    qsort(mistakes->list, (size_t)mistakes->n, sizeof *mistakes->list, compare_places);
    for (int i = 0; i < mistakes->n && report_speaks; i++) {
        const struct mistake *m = &mistakes->list[i];
        if (m->line > 0)
            fprintf(stderr, "%s:%d:%d: %s\n", m->file, m->line, m->column, m->text);
        else
            fprintf(stderr, "%s: %s\n", m->file, m->text);
    }
}
