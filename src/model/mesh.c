/*
 * Topology of a body's surface: see mesh.h.
 *
 * Vertices are joined by sorting them by coordinates, edges found by sorting the faces' sides
 * by their two vertices; so everything costs n log n and every number follows from the input's
 * order alone.  A facet with fewer than three different vertices, or without area, is left out:
 * nothing can touch it, and it has no normal.
 */
#include "model/mesh.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"

static const double FLAT =
    1e-9; /* a quad's vertices lie in a plane within this part of its size */
static const double SLIVER = 1e-12; /* twice the area over the square of the size: no area */

/* What is being built: room for all facets to become four triangles. */
struct draft {
    int n_vertices, n_faces, n_means;
    struct vec3 *vertices;
    struct mesh_face *faces;
    int (*mean_of)[4]; /* the quads of the last n_means vertices */
};

struct corner { /* a vertex on its way to being joined */
    struct vec3 place;
    int index;
};

static int compare_doubles(double a, double b)
{
    return (a > b) - (a < b);
}

static int compare_corners(const void *a, const void *b)
{
    const struct corner *p = a, *q = b;
    int order = compare_doubles(p->place.x, q->place.x);
    if (order == 0)
        order = compare_doubles(p->place.y, q->place.y);
    if (order == 0)
        order = compare_doubles(p->place.z, q->place.z);
    return order != 0 ? order : p->index - q->index;
}

/* For every vertex the first one at the same place. */
static int *joined_vertices(int n, const struct vec3 *vertices)
{
    struct corner *corners = array_allocate((size_t)n, sizeof *corners);
    int *joined = array_allocate((size_t)n, sizeof *joined);
    for (int v = 0; v < n; v++)
        corners[v] = (struct corner){vertices[v], v};
    qsort(corners, (size_t)n, sizeof *corners, compare_corners);
    for (int k = 0, first = 0; k < n; k++) {
        const struct vec3 a = corners[first].place, b = corners[k].place;
        if (!(a.x == b.x && a.y == b.y && a.z == b.z))
            first = k;
        joined[corners[k].index] = corners[first].index;
    }
    free(corners);
    return joined;
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

/* The normal of a face times twice its area. */
static struct vec3 face_area(const struct mesh_face *face, const struct vec3 *vertices)
{
    const struct vec3 a = vertices[face->vertices[0]], b = vertices[face->vertices[1]];
    const struct vec3 c = vertices[face->vertices[2]];
    if (face->n == 3)
        return vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
    return vec3_cross(vec3_sub(c, a), vec3_sub(vertices[face->vertices[3]], b));
}

static double face_size(const struct mesh_face *face, const struct vec3 *vertices)
{
    double size = 0.0;
    for (int i = 0; i < face->n; i++)
        for (int j = 0; j < i; j++)
            size = larger(size, vec3_norm(vec3_sub(vertices[face->vertices[i]],
                                                   vertices[face->vertices[j]])));
    return size;
}

static bool has_area(const struct mesh_face *face, const struct vec3 *vertices)
{
    const double size = face_size(face, vertices);
    return vec3_norm(face_area(face, vertices)) > SLIVER * size * size;
}

static bool is_flat_and_convex(const struct mesh_face *face, const struct vec3 *vertices)
{
    if (face->n == 3)
        return true;
    if (!has_area(face, vertices))
        return false;
    const struct vec3 area = face_area(face, vertices);
    const struct vec3 normal = vec3_scale(1.0 / vec3_norm(area), area);
    const double size = face_size(face, vertices);
    for (int k = 0; k < 4; k++) {
        const struct vec3 before = vertices[face->vertices[k]];
        const struct vec3 here = vertices[face->vertices[(k + 1) % 4]];
        const struct vec3 after = vertices[face->vertices[(k + 2) % 4]];
        const struct vec3 side = vec3_sub(here, before);
        const double off = vec3_dot(side, normal);
        const double turn = vec3_dot(vec3_cross(side, vec3_sub(after, here)), normal);
        if (!(off <= FLAT * size && off >= -FLAT * size && turn > SLIVER * size * size))
            return false;
    }
    return true;
}

static void add_face(struct draft *draft, struct mesh_face face)
{
    if (has_area(&face, draft->vertices))
        draft->faces[draft->n_faces++] = face;
}

/* A quad as four triangles about the mean of its vertices. */
static void add_fan(struct draft *draft, const struct mesh_face *quad)
{
    struct vec3 mean = {0.0, 0.0, 0.0};
    for (int k = 0; k < 4; k++)
        mean = vec3_axpy(mean, 0.25, draft->vertices[quad->vertices[k]]);
    const int centre = draft->n_vertices++;
    draft->vertices[centre] = mean;
    memcpy(draft->mean_of[draft->n_means++], quad->vertices, sizeof *draft->mean_of);
    for (int k = 0; k < 4; k++)
        add_face(draft,
                 (struct mesh_face){3,
                                    {quad->vertices[k], quad->vertices[(k + 1) % 4], centre},
                                    {0, 0, 0, 0}});
}

/* A facet's vertices after joining; neighbours that fell together count once. */
static struct mesh_face joined_facet(const int facet[4], const int *joined, int n_vertices)
{
    struct mesh_face face = {0, {0, 0, 0, 0}, {0, 0, 0, 0}};
    const int n = facet[3] < 0 ? 3 : 4;
    for (int k = 0; k < n; k++) {
        CHECK(facet[k] >= 0 && facet[k] < n_vertices, "facet with vertex %d of %d", facet[k],
              n_vertices);
        const int vertex = joined[facet[k]];
        if (face.n == 0 || face.vertices[face.n - 1] != vertex)
            face.vertices[face.n++] = vertex;
    }
    if (face.n > 1 && face.vertices[face.n - 1] == face.vertices[0])
        face.n--;
    return face;
}

static struct draft draft_faces(int n_vertices, const struct vec3 *vertices, int n_facets,
                                const int (*facets)[4])
{
    struct draft draft = {.n_vertices = n_vertices};
    draft.vertices =
        array_allocate((size_t)n_vertices + (size_t)n_facets, sizeof *draft.vertices);
    draft.faces = array_allocate(4 * (size_t)n_facets, sizeof *draft.faces);
    draft.mean_of = array_allocate((size_t)n_facets, sizeof *draft.mean_of);
    for (int v = 0; v < n_vertices; v++)
        draft.vertices[v] = vertices[v];
    int *joined = joined_vertices(n_vertices, vertices);
    for (int f = 0; f < n_facets; f++) {
        const struct mesh_face face = joined_facet(facets[f], joined, n_vertices);
        if (face.n < 3)
            continue;
        if (is_flat_and_convex(&face, draft.vertices))
            add_face(&draft, face);
        else
            add_fan(&draft, &face);
    }
    free(joined);
    return draft;
}

/* Which of the draft's vertices faces use, themselves or through a mean point: 1, else 0. */
static int *used_vertices(const struct draft *draft)
{
    const int n_given = draft->n_vertices - draft->n_means;
    int *used = array_allocate((size_t)draft->n_vertices, sizeof *used);
    for (int f = 0; f < draft->n_faces; f++)
        for (int k = 0; k < draft->faces[f].n; k++)
            used[draft->faces[f].vertices[k]] = 1;
    for (int m = 0; m < draft->n_means; m++)
        for (int k = 0; k < 4 && used[n_given + m] != 0; k++)
            used[draft->mean_of[m][k]] = 1;
    return used;
}

/* Takes over the vertices that are used, in their order, and renumbers. */
static void keep_used_vertices(struct mesh *mesh, const struct draft *draft)
{
    const int n_given = draft->n_vertices - draft->n_means;
    int *number = used_vertices(draft);
    mesh->reference = array_allocate((size_t)draft->n_vertices, sizeof *mesh->reference);
    mesh->mean_of = array_allocate((size_t)draft->n_means, sizeof *mesh->mean_of);
    for (int v = 0; v < draft->n_vertices; v++) {
        if (number[v] == 0)
            continue;
        mesh->reference[mesh->n_vertices] = draft->vertices[v];
        number[v] = mesh->n_vertices++;
        if (v < n_given) {
            mesh->n_corners++;
            continue;
        }
        for (int k = 0; k < 4; k++)
            mesh->mean_of[number[v] - mesh->n_corners][k] =
                number[draft->mean_of[v - n_given][k]];
    }
    for (int f = 0; f < draft->n_faces; f++)
        for (int k = 0; k < draft->faces[f].n; k++)
            draft->faces[f].vertices[k] = number[draft->faces[f].vertices[k]];
    free(number);
}

struct side { /* of a face, on its way to being an edge */
    int low, high, face, k;
};

static int compare_sides(const void *a, const void *b)
{
    const struct side *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    if (p->face != q->face)
        return p->face < q->face ? -1 : 1;
    return p->k - q->k;
}

static void find_edges(struct mesh *mesh)
{
    struct side *sides = array_allocate(4 * (size_t)mesh->n_faces, sizeof *sides);
    int n = 0;
    for (int f = 0; f < mesh->n_faces; f++) {
        const struct mesh_face *face = &mesh->faces[f];
        for (int k = 0; k < face->n; k++) {
            const int a = face->vertices[k], b = face->vertices[(k + 1) % face->n];
            sides[n++] = (struct side){a < b ? a : b, a < b ? b : a, f, k};
        }
    }
    qsort(sides, (size_t)n, sizeof *sides, compare_sides);
    mesh->edges = array_allocate((size_t)n, sizeof *mesh->edges);
    for (int s = 0; s < n; s++) {
        struct mesh_edge *edge = &mesh->edges[mesh->n_edges];
        const bool same =
            s > 0 && sides[s].low == sides[s - 1].low && sides[s].high == sides[s - 1].high;
        if (!same) {
            mesh->n_edges++;
            *edge = (struct mesh_edge){{sides[s].low, sides[s].high}, {sides[s].face, -1}};
        } else if (edge[-1].faces[1] < 0) {
            edge[-1].faces[1] = sides[s].face;
        }
        mesh->faces[sides[s].face].edges[sides[s].k] = mesh->n_edges - 1;
    }
    free(sides);
}

static void list_edges_at_vertices(struct mesh *mesh)
{
    mesh->edge_begin = array_allocate((size_t)mesh->n_vertices + 1, sizeof *mesh->edge_begin);
    mesh->edge_list = array_allocate(2 * (size_t)mesh->n_edges, sizeof *mesh->edge_list);
    int *end = array_allocate((size_t)mesh->n_vertices + 1, sizeof *end);
    for (int e = 0; e < mesh->n_edges; e++)
        for (int k = 0; k < 2; k++)
            mesh->edge_begin[mesh->edges[e].vertices[k] + 1]++;
    for (int v = 0; v < mesh->n_vertices; v++) {
        mesh->edge_begin[v + 1] += mesh->edge_begin[v];
        end[v] = mesh->edge_begin[v];
    }
    for (int e = 0; e < mesh->n_edges; e++)
        for (int k = 0; k < 2; k++)
            mesh->edge_list[end[mesh->edges[e].vertices[k]]++] = e;
    free(end);
}

void mesh_build(struct mesh *mesh, int n_vertices, const struct vec3 *vertices, int n_facets,
                const int (*facets)[4])
{
    *mesh = (struct mesh){0};
    const struct draft draft = draft_faces(n_vertices, vertices, n_facets, facets);
    keep_used_vertices(mesh, &draft);
    mesh->n_faces = draft.n_faces;
    mesh->faces = draft.faces;
    free(draft.vertices);
    free(draft.mean_of);
    find_edges(mesh);
    list_edges_at_vertices(mesh);
    mesh->place = array_allocate((size_t)mesh->n_vertices, sizeof *mesh->place);
    for (int v = 0; v < mesh->n_vertices; v++)
        mesh->place[v] = mesh->reference[v];
    mesh->face_normal = array_allocate((size_t)mesh->n_faces, sizeof *mesh->face_normal);
    mesh->face_borders = array_allocate_rows((size_t)mesh->n_faces, sizeof *mesh->face_borders);
    mesh_update(mesh);
}

void mesh_clear(struct mesh *mesh)
{
    free(mesh->mean_of);
    free(mesh->reference);
    free(mesh->place);
    free(mesh->edges);
    free(mesh->faces);
    free(mesh->face_normal);
    free(mesh->face_borders);
    free(mesh->edge_begin);
    free(mesh->edge_list);
    *mesh = (struct mesh){0};
}

void mesh_update(struct mesh *mesh)
{
    for (int f = 0; f < mesh->n_faces; f++) {
        const struct mesh_face *face = &mesh->faces[f];
        const struct vec3 area = face_area(face, mesh->place);
        const struct vec3 normal = vec3_scale(1.0 / vec3_norm(area), area);
        mesh->face_normal[f] = normal;
        for (int k = 0; k < face->n; k++) {
            const struct vec3 from = mesh->place[face->vertices[k]];
            const struct vec3 to = mesh->place[face->vertices[k + 1 < face->n ? k + 1 : 0]];
            const struct vec3 along = vec3_sub(to, from);
            mesh->face_borders[f][k] =
                (struct mesh_border){from, vec3_cross(normal, along), vec3_dot(along, along)};
        }
    }
}
