/* See surface.h. */
#include "model/surface.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"

int surface_add_vertex(struct surface *surface, struct vec3 place)
{
    ARRAY_GROW(surface->vertices, surface->n_vertices + 1, surface->vertex_capacity);
    surface->vertices[surface->n_vertices] = place;
    return surface->n_vertices++;
}

void surface_add_facet(struct surface *surface, int a, int b, int c, int d)
{
    const int facet[4] = {a, b, c, d};
    ARRAY_GROW(surface->facets, surface->n_facets + 1, surface->facet_capacity);
    memcpy(surface->facets[surface->n_facets++], facet, sizeof facet);
}

void surface_clear(struct surface *surface)
{
    free(surface->vertices);
    free(surface->facets);
    *surface = (struct surface){0};
}
