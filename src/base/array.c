/* Memory that is there or the run stops: see array.h. */
#include "base/array.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "base/report.h"

enum { CACHE_LINE = 64, HUGE_PAGE = 2 * 1024 * 1024 };

static size_t checked_bytes(size_t n, size_t size)
{
    CHECK(size == 0 || n <= SIZE_MAX / 4 / size, "%zu elements of %zu bytes asked for", n,
          size);
    return n * size;
}

void *array_allocate(size_t n, size_t size)
{
    void *memory = calloc(n > 0 ? n : 1, size > 0 ? size : 1);
    if (memory == NULL)
        report_no_memory(checked_bytes(n, size));
    return memory;
}

void *array_allocate_rows(size_t n, size_t size)
{
    const size_t bytes = checked_bytes(n, size);
    void *memory = NULL;
    const int error = posix_memalign(&memory, bytes >= HUGE_PAGE ? HUGE_PAGE : CACHE_LINE,
                                     bytes > 0 ? bytes : CACHE_LINE);
    if (error != 0)
        report_no_memory(bytes);
    /* Only what fills huge pages: another one for the rest would be mostly empty. */
    if (bytes >= HUGE_PAGE)
        (void)madvise(memory, bytes / HUGE_PAGE * HUGE_PAGE, MADV_HUGEPAGE); /* it may fail */
    memset(memory, 0, bytes);
    return memory;
}

void *array_resize(void *old, size_t n_old, size_t n, size_t size)
{
    const size_t bytes = checked_bytes(n, size);
    char *memory = realloc(old, bytes > 0 ? bytes : 1);
    if (memory == NULL)
        report_no_memory(bytes);
    if (n > n_old)
        memset(memory + n_old * size, 0, (n - n_old) * size);
    return memory;
}

void *array_resize_rows(void *old, size_t n_old, size_t n, size_t size)
{
    void *memory = array_allocate_rows(n, size);
    if (old != NULL)
        memcpy(memory, old, (n_old < n ? n_old : n) * size);
    free(old);
    return memory;
}

char *array_string(const char *text)
{
    const size_t size = strlen(text) + 1;
    char *copy = array_allocate(size, 1);
    memcpy(copy, text, size);
    return copy;
}

char *array_format(const char *format, ...)
{
    va_list arguments, copy;
    va_start(arguments, format);
    va_copy(copy, arguments);
    const int length = vsnprintf(NULL, 0, format, arguments);
    CHECK(length >= 0, "cannot format %s", format);
    char *text = array_allocate((size_t)length + 1, 1);
    vsnprintf(text, (size_t)length + 1, format, copy);
    va_end(copy);
    va_end(arguments);
    return text;
}

size_t array_capacity(size_t capacity, size_t needed)
{
    const size_t grown = capacity + capacity / 8 + 16;
    return grown > needed ? grown : needed;
}
