/* See facet_circles.h. */
#include "contact/facet_circles.h"

#include <stdlib.h>

#include "base/array.h"
#include "contact/facet_contact.h"
#include "model/body.h"

void facet_circles_clear(struct facet_circles *circles)
{
    struct facet_kernel_circles *of = &circles->of;
    free(of->contact);
    free(of->sphere);
    free(of->body);
    free(of->triangle);
    free(of->load);
    for (int x = 0; x < 3; x++)
        free(of->from[x]);
    free(of->reach);
    free(of->gone);
    free(of->left);
    free(of->found);
    free(of->circle);
    free(circles->groups);
    *circles = (struct facet_circles){0};
}

/* Kernels load whole vectors. */
static void reserve(struct facet_circles *circles, int n)
{
    struct facet_kernel_circles *of = &circles->of;
    const int needed = n + FACET_KERNEL_PAD, had = circles->capacity;
    if (needed <= had)
        return;
#define GROW(pointer)                                                                          \
    do {                                                                                       \
        circles->capacity = had;                                                               \
        ARRAY_GROW(pointer, needed, circles->capacity);                                        \
    } while (0)
    GROW(of->contact);
    GROW(of->sphere);
    GROW(of->body);
    GROW(of->triangle);
    GROW(of->load);
    for (int x = 0; x < 3; x++)
        GROW(of->from[x]);
    GROW(of->reach);
    GROW(of->gone);
    GROW(of->left);
    GROW(circles->groups);
#undef GROW
    free(of->found);
    free(of->circle);
    of->found = array_allocate((size_t)circles->capacity, sizeof *of->found);
    of->circle = array_allocate_rows((size_t)circles->capacity, sizeof *of->circle);
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

int facet_circles_add(struct facet_circles *circles, struct facet_contact *contact,
                      const struct body *body, struct facet_kernel_load *load, int group,
                      struct vec3 from, double reach)
{
    struct facet_kernel_circles *of = &circles->of;
    reserve(circles, of->n + 1);
    const int k = of->n++;
    of->contact[k] = contact;
    of->sphere[k] = contact->sphere;
    of->body[k] = body;
    of->triangle[k] = triangle_of(&body->mesh, contact->feature);
    of->load[k] = load;
    of->from[0][k] = from.x;
    of->from[1][k] = from.y;
    of->from[2][k] = from.z;
    of->reach[k] = reach;
    circles->groups[k] = group;
    return k;
}

int facet_circles_last(const struct facet_circles *circles)
{
    return circles->groups[circles->of.n - 1];
}

void facet_circles_take(struct facet_circles *circles, int place)
{
    struct facet_kernel_circles *of = &circles->of;
    const int last = --of->n;
    of->contact[place] = of->contact[last];
    of->sphere[place] = of->sphere[last];
    of->body[place] = of->body[last];
    of->triangle[place] = of->triangle[last];
    of->load[place] = of->load[last];
    for (int x = 0; x < 3; x++)
        of->from[x][place] = of->from[x][last];
    of->reach[place] = of->reach[last];
    circles->groups[place] = circles->groups[last];
}

void facet_circles_renew_means(const struct facet_kernel_circles *of)
{
    for (int k = 0; k < of->n; k++)
        if (of->triangle[k].bearers[1] >= 0)
            body_renew_mean(of->body[k], of->contact[k]->feature);
}
