/* See solid_surface.h.  The elements that meet at a side's first node are few enough to be
 * looked at one by one. */
#include "solid/solid_surface.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/array.h"
#include "solid/solid.h"

static bool holds(const int *nodes, int n, int node)
{
    for (int c = 0; c < n; c++)
        if (nodes[c] == node)
            return true;
    return false;
}

/* Has the other element a side of the same nodes? */
static bool has_side(const struct solid *solid, int other,
                     const struct solid_surface_face *face)
{
    for (int side = 0; side < SOLID_SIDES; side++) {
        int nodes[SOLID_SIDE_NODES], same = 0;
        const int n = solid_side_nodes(solid, other, side, nodes);
        for (int c = 0; n == face->n && c < n; c++)
            same += holds(face->nodes, n, nodes[c]);
        if (n > 0 && same == n)
            return true;
    }
    return false;
}

static bool is_shared(const struct solid *solid, const struct solid_surface_face *face)
{
    const int i = face->nodes[0];
    for (int k = solid->first[i]; k < solid->first[i + 1]; k++) {
        const int other = solid->meets[k] / SOLID_ELEMENT_CORNERS;
        if (other != face->element && solid->alive[other] &&
            !shell_element_is(solid->shape[other]) && has_side(solid, other, face))
            return true;
    }
    return false;
}

void solid_surface_build(struct solid_surface *surface, const struct solid *solid)
{
    surface->n = 0;
    for (int e = 0; e < solid->n_elements; e++) {
        const bool thin = shell_element_is(solid->shape[e]);
        for (int side = 0; solid->alive[e] && side < (thin ? 1 : SOLID_SIDES); side++) {
            struct solid_surface_face face = {.element = e, .side = side};
            face.n = solid_side_nodes(solid, e, side, face.nodes);
            if (face.n == 0 || (!thin && is_shared(solid, &face)))
                continue;
            ARRAY_GROW(surface->faces, surface->n + 1, surface->capacity);
            surface->faces[surface->n++] = face;
        }
    }
}

void solid_surface_clear(struct solid_surface *surface)
{
    free(surface->faces);
    *surface = (struct solid_surface){0};
}
