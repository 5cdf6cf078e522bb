/* See fuzz.h. */
#include "fuzz.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

void __wrap_report_bug(const char *file, int line, const char *condition, const char *format,
                       ...) __attribute__((format(printf, 4, 5)));
void __wrap_report_no_memory(size_t bytes);

void __wrap_report_bug(const char *file, int line, const char *condition, const char *format,
                       ...)
{
    va_list arguments;
    va_start(arguments, format);
    fprintf(stderr, "%s:%d: (%s) ", file, line, condition);
    vfprintf(stderr, format, arguments);
    fputc('\n', stderr);
    va_end(arguments);
    abort();
}

void __wrap_report_no_memory(size_t bytes)
{
    fprintf(stderr, "out of memory: %zu bytes\n", bytes);
    abort();
}

const char *fuzz_file(const void *bytes, size_t n)
{
    static char path[32];
    if (path[0] == '\0')
        snprintf(path, sizeof path, "input.%d", (int)getpid());
    FILE *out = fopen(path, "wb");
    if (out == NULL || fwrite(bytes, 1, n, out) != n || fclose(out) != 0)
        abort();
    return path;
}
