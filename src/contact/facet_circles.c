/* See facet_circles.h. */
#include "contact/facet_circles.h"

#include <stdlib.h>

#include "base/array.h"
#include "contact/facet_contact.h"
#include "model/body.h"

void facet_circles_clear(struct facet_kernel_circles *circles)
{
    free(circles->list);
    free(circles->kind);
    free(circles->found);
    free(circles->circle);
    *circles = (struct facet_kernel_circles){0};
}

/* Where the third corner is the mean point of a quad, the quad's other two bear. */
static struct facet_kernel_triangle triangle_of(const struct mesh *mesh, int face)
{
    const int *v = mesh->faces[face].vertices;
    struct facet_kernel_triangle triangle = {{v[0], v[1], v[2]}, {v[2], -1}};
    if (v[2] < mesh->n_corners)
        return triangle;
    const int *quad = mesh->mean_of[v[2] - mesh->n_corners];
    for (int m = 0, n = 0; m < 4 && n < 2; m++)
        if (quad[m] != v[0] && quad[m] != v[1])
            triangle.bearers[n++] = quad[m];
    return triangle;
}

int facet_circles_add(struct facet_kernel_circles *circles,
                      const struct facet_kernel_entry *entry)
{
    const int place = circles->n++, had = circles->capacity;
    ARRAY_GROW(circles->list, circles->n, circles->capacity);
    if (circles->capacity > had) {
        const size_t padded = (size_t)circles->capacity + FACET_KERNEL_PAD;
        free(circles->kind);
        free(circles->found);
        free(circles->circle);
        circles->kind = array_allocate(padded, sizeof *circles->kind);
        circles->found = array_allocate(padded, sizeof *circles->found);
        circles->circle = array_allocate_rows(padded, sizeof *circles->circle);
    }
    circles->list[place] = *entry;
    circles->list[place].triangle = triangle_of(&entry->body->mesh, entry->contact->feature);
    return place;
}

void facet_circles_take(struct facet_kernel_circles *circles, int place)
{
    circles->list[place] = circles->list[--circles->n];
}

void facet_circles_renew_means(const struct facet_kernel_circles *circles)
{
    for (int k = 0; k < circles->n; k++)
        if (circles->list[k].triangle.bearers[1] >= 0)
            body_renew_mean(circles->list[k].body, circles->list[k].contact->feature);
}
