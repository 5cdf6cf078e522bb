/*
 * Memory: allocation that never returns NULL, arrays that grow, rows aligned to a cache line.
 *
 * A batch run that cannot get memory has nothing better to do than to say so and stop; the last
 * checkpoint stands.  All sizes are in elements.
 */
#ifndef TREMIE_BASE_ARRAY_H
#define TREMIE_BASE_ARRAY_H

#include <stdbool.h>
#include <stddef.h>

/* n zeroed elements of `size` bytes each; free() releases them. */
void *array_allocate(size_t n, size_t size);
/* The same, aligned to 64 bytes (and to huge pages when large); free() releases them. */
void *array_allocate_rows(size_t n, size_t size);
/* The same, without huge pages: only what is written to takes memory, page by page, as long as
 * the whole is large. */
void *array_allocate_sparse(size_t n, size_t size);
/* Gives back the memory of all elements of a large array but those to keep, as far as these
 * leave whole pages; their contents are lost. */
void array_forget(void *rows, size_t n, size_t size, const bool *keep);
/* Room for n elements of `size` bytes, contents kept, new bytes zeroed. */
void *array_resize(void *old, size_t n_old, size_t n, size_t size);
/* Like array_resize for memory from array_allocate_rows. */
void *array_resize_rows(void *old, size_t n_old, size_t n, size_t size);
/* A copy of a string. */
char *array_string(const char *text);
/* printf into a new string. */
char *array_format(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* For qsort(): ints and doubles in ascending order. */
int array_compare_ints(const void *a, const void *b);
int array_compare_doubles(const void *a, const void *b);

/* Next capacity for `needed` elements where `capacity` was. */
size_t array_capacity(size_t capacity, size_t needed);

/* Makes room for `needed` elements in `pointer`, whose capacity is the integer `capacity`. */
#define ARRAY_GROW(pointer, needed, capacity)                                                  \
    do {                                                                                       \
        if ((size_t)(needed) > (size_t)(capacity)) {                                           \
            const size_t grown_ = array_capacity((size_t)(capacity), (size_t)(needed));        \
            (pointer) =                                                                        \
                array_resize((pointer), (size_t)(capacity), grown_, sizeof *(pointer));        \
            (capacity) = (__typeof__(capacity))grown_;                                         \
        }                                                                                      \
    } while (0)

#endif
