/* See surface.h. */
#include "surface.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"

/* A text that grows. */
struct text {
    char *begin;
    size_t size, used;
};

#define PRINT(text, ...)                                                                       \
    do {                                                                                       \
        make_room(text);                                                                       \
        (text)->used += (size_t)snprintf((text)->begin + (text)->used,                         \
                                         (text)->size - (text)->used, __VA_ARGS__);            \
    } while (0)

enum { LINE_MAX_SIZE = 512 };

static void make_room(struct text *text)
{
    if (text->size - text->used >= LINE_MAX_SIZE)
        return;
    const size_t size = 2 * text->size + LINE_MAX_SIZE;
    text->begin = array_resize(text->begin, text->size, size, 1);
    text->size = size;
}

static void print_vertices(struct text *text, const struct surface *surface)
{
    const double pi = 3.14159265358979323846;
    const int n = surface->n_around;
    for (int ring = 0; ring <= surface->n_rings; ring++) {
        const double part = (double)ring / (double)surface->n_rings;
        const double radius = (1.0 - part) * surface->radius[0] + part * surface->radius[1];
        const double z = (1.0 - part) * surface->z[0] + part * surface->z[1];
        for (int k = 0; k < n; k++) {
            const double shift = surface->n_rings > 1 ? 0.5 * (double)(ring % 2) : 0.0;
            const double angle = 2.0 * pi * ((double)k + shift) / (double)n;
            PRINT(text, "%s[%.17g, %.17g, %.17g]", ring + k > 0 ? ", " : "",
                  radius * cos(angle), radius * sin(angle), z);
        }
    }
    if (surface->has_floor)
        PRINT(text, ", [0, 0, %.17g]", surface->z[0]);
}

static void print_facets(struct text *text, const struct surface *surface)
{
    const int n = surface->n_around;
    for (int ring = 0; ring < surface->n_rings; ring++) {
        for (int k = 0; k < n; k++) {
            const int a = ring * n + k, b = ring * n + (k + 1) % n, c = b + n, d = a + n;
            /* The upper vertex that is over the middle of a-b is d, or c a ring farther. */
            PRINT(text, "%s", ring + k > 0 ? ", " : "");
            if (ring % 2 == 0)
                PRINT(text, "[%d, %d, %d], [%d, %d, %d]", a, b, d, b, c, d);
            else
                PRINT(text, "[%d, %d, %d], [%d, %d, %d]", a, b, c, a, c, d);
        }
    }
    for (int k = 0; surface->has_floor && k < n; k++)
        PRINT(text, ", [%d, %d, %d]", (k + 1) % n, k, n * (surface->n_rings + 1));
}

char *surface_body(const char *name, const char *material, const struct surface *surface)
{
    struct text text = {NULL, 0, 0};
    PRINT(&text, "  - {name: %s, material: %s, geometry: {kind: mesh, vertices: [", name,
          material);
    print_vertices(&text, surface);
    PRINT(&text, "], facets: [");
    print_facets(&text, surface);
    PRINT(&text, "]}}\n");
    return text.begin;
}
