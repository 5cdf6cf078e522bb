/* Memory that is there or the run stops: see array.h. */
#include "base/array.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

#include "base/report.h"

enum { CACHE_LINE = 64, PAGE = 4096, HUGE_PAGE = 2 * 1024 * 1024 };

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

void *array_allocate_sparse(size_t n, size_t size)
{
    const size_t bytes = checked_bytes(n, size), whole = bytes / PAGE * PAGE;
    char *memory = NULL;
    if (posix_memalign((void **)&memory, PAGE, bytes > 0 ? bytes : PAGE) != 0)
        report_no_memory(bytes);
    /* Pages that are given back come again as zeros when they are needed. */
    if (whole > 0 && (madvise(memory, whole, MADV_NOHUGEPAGE) != 0 ||
                      madvise(memory, whole, MADV_DONTNEED) != 0))
        memset(memory, 0, whole);
    memset(memory + whole, 0, bytes - whole);
    return memory;
}

/* Gives back the whole pages between two places, if there are any. */
static void forget_between(char *begin, char *end)
{
    char *first = begin + (PAGE - (uintptr_t)begin % PAGE) % PAGE;
    char *last = end - (uintptr_t)end % PAGE;
    if (first < last)
        (void)madvise(first, (size_t)(last - first), MADV_DONTNEED); /* else it stays */
}

void array_forget(void *rows, size_t n, size_t size, const bool *keep)
{
    for (size_t i = 0, end; i < n; i = end + 1) {
        for (end = i; end < n && !keep[end]; end++)
            continue;
        forget_between((char *)rows + i * size, (char *)rows + end * size);
    }
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

int array_compare_ints(const void *a, const void *b)
{
    const int *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

int array_compare_doubles(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

size_t array_capacity(size_t capacity, size_t needed)
{
    const size_t grown = capacity + capacity / 8 + 16;
    return grown > needed ? grown : needed;
}
