/*
 * Topology of a body's surface: see mesh.h.
 *
 * Vertices are joined by sorting them by coordinates, edges found by sorting the faces' sides
 * by their two vertices; so everything costs n log n and every number follows from the input's
 * order alone.  A facet with fewer than three different vertices, or without area, is left out:
 * nothing can touch it, and it has no normal.  So is a facet with the vertices of an earlier
 * one, found by sorting them.
 *
 * A round surface has few features; its place in space is that of two vertices on its axis, so
 * whoever moves vertices moves it.
 */
#include "model/mesh.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "model/side.h"

static const double FLAT =
    1e-9; /* a quad's vertices lie in a plane within this part of its size */
static const double SLIVER = 1e-12; /* twice the area over the square of the size: no area */

/* What is being built: room for all facets to become four triangles. */
struct draft {
    int n_vertices, n_faces, n_means;
    int n_degenerate, first_degenerate;
    struct vec3 *vertices;
    struct mesh_face *faces;
    int *facet;        /* the facet that gave a face */
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

int *mesh_joined_vertices(int n, const struct vec3 *vertices)
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

static void add_face(struct draft *draft, struct mesh_face face, int facet)
{
    if (face.n < 3 || !has_area(&face, draft->vertices))
        return;
    draft->facet[draft->n_faces] = facet;
    draft->faces[draft->n_faces++] = face;
}

/* A quad as four triangles about the mean of its vertices. */
static void add_fan(struct draft *draft, const struct mesh_face *quad, int facet)
{
    struct vec3 mean = {0.0, 0.0, 0.0};
    for (int k = 0; k < 4; k++)
        mean = vec3_axpy(mean, 0.25, draft->vertices[quad->vertices[k]]);
    const int centre = draft->n_vertices++;
    draft->vertices[centre] = mean;
    memcpy(draft->mean_of[draft->n_means++], quad->vertices, sizeof *draft->mean_of);
    for (int k = 0; k < 4; k++)
        add_face(draft,
                 (struct mesh_face){
                     3, {quad->vertices[k], quad->vertices[(k + 1) % 4], centre}, {0, 0, 0, 0}},
                 facet);
}

static int *all_apart(int n)
{
    int *own = array_allocate((size_t)n, sizeof *own);
    for (int v = 0; v < n; v++)
        own[v] = v;
    return own;
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

/* Of a surface that deforms quads are divided whether flat or not, and no vertices are
 * joined. */
static struct draft draft_faces(int n_vertices, const struct vec3 *vertices, int n_facets,
                                const int (*facets)[4], bool deforms)
{
    struct draft draft = {.n_vertices = n_vertices, .first_degenerate = -1};
    draft.vertices =
        array_allocate((size_t)n_vertices + (size_t)n_facets, sizeof *draft.vertices);
    draft.faces = array_allocate(4 * (size_t)n_facets, sizeof *draft.faces);
    draft.facet = array_allocate(4 * (size_t)n_facets, sizeof *draft.facet);
    draft.mean_of = array_allocate((size_t)n_facets, sizeof *draft.mean_of);
    for (int v = 0; v < n_vertices; v++)
        draft.vertices[v] = vertices[v];
    int *joined = deforms ? all_apart(n_vertices) : mesh_joined_vertices(n_vertices, vertices);
    for (int f = 0; f < n_facets; f++) {
        const struct mesh_face face = joined_facet(facets[f], joined, n_vertices);
        const int n_before = draft.n_faces;
        if (face.n < 4 || (!deforms && is_flat_and_convex(&face, draft.vertices)))
            add_face(&draft, face, f);
        else
            add_fan(&draft, &face, f);
        if (draft.n_faces > n_before)
            continue;
        draft.first_degenerate = draft.n_degenerate == 0 ? f : draft.first_degenerate;
        draft.n_degenerate++;
    }
    free(joined);
    return draft;
}

struct twin {        /* a face on its way to being compared */
    int vertices[4]; /* ascending; a triangle has -1 first */
    int face;
};

static int compare_twins(const void *a, const void *b)
{
    const struct twin *p = a, *q = b;
    for (int k = 0; k < 4; k++)
        if (p->vertices[k] != q->vertices[k])
            return p->vertices[k] < q->vertices[k] ? -1 : 1;
    return (p->face > q->face) - (p->face < q->face);
}

static struct twin twin_of(const struct mesh_face *face, int f)
{
    struct twin twin = {{-1, -1, -1, -1}, f};
    for (int n = 0; n < face->n; n++) {
        int k = 3 - n;
        for (; k < 3 && twin.vertices[k + 1] < face->vertices[n]; k++)
            twin.vertices[k] = twin.vertices[k + 1];
        twin.vertices[k] = face->vertices[n];
    }
    return twin;
}

/* Leaves out the faces whose vertices an earlier one has. */
static void drop_duplicates(struct draft *draft, struct mesh *mesh)
{
    const int n = draft->n_faces;
    struct twin *twins = array_allocate((size_t)n, sizeof *twins);
    bool *is_twin = array_allocate((size_t)n, sizeof *is_twin);
    for (int f = 0; f < n; f++)
        twins[f] = twin_of(&draft->faces[f], f);
    qsort(twins, (size_t)n, sizeof *twins, compare_twins);
    for (int k = 1; k < n; k++)
        is_twin[twins[k].face] =
            memcmp(twins[k].vertices, twins[k - 1].vertices, sizeof twins[k].vertices) == 0;
    draft->n_faces = 0;
    mesh->first_duplicate = -1;
    for (int f = 0; f < n; f++) {
        if (!is_twin[f]) {
            draft->faces[draft->n_faces++] = draft->faces[f];
            continue;
        }
        if (mesh->n_duplicates++ == 0)
            mesh->first_duplicate = draft->facet[f];
    }
    free(twins);
    free(is_twin);
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

static void find_edges(struct mesh *mesh)
{
    struct side *sides = array_allocate(4 * (size_t)mesh->n_faces, sizeof *sides);
    int n = 0;
    for (int f = 0; f < mesh->n_faces; f++)
        side_add(sides, &n, f, mesh->faces[f].n, mesh->faces[f].vertices);
    side_sort(sides, n);
    mesh->edges = array_allocate((size_t)n, sizeof *mesh->edges);
    for (int first = 0, end; first < n; first = end) {
        const struct side *p = &sides[first];
        end = side_edge_end(sides, first, n);
        mesh->edges[mesh->n_edges] =
            (struct mesh_edge){{p->ends[0], p->ends[1]},
                               {p->polygon, end - first > 1 ? p[1].polygon : -1},
                               end - first};
        for (int k = first; k < end; k++)
            mesh->faces[sides[k].polygon].edges[sides[k].side] = mesh->n_edges;
        mesh->n_edges++;
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

static void build(struct mesh *mesh, int n_vertices, const struct vec3 *vertices, int n_facets,
                  const int (*facets)[4], bool deforms)
{
    *mesh = (struct mesh){0};
    struct draft draft = draft_faces(n_vertices, vertices, n_facets, facets, deforms);
    mesh->n_degenerate = draft.n_degenerate;
    mesh->first_degenerate = draft.first_degenerate;
    drop_duplicates(&draft, mesh);
    keep_used_vertices(mesh, &draft);
    mesh->n_faces = draft.n_faces;
    mesh->faces = draft.faces;
    free(draft.vertices);
    free(draft.facet);
    free(draft.mean_of);
    find_edges(mesh);
    list_edges_at_vertices(mesh);
    mesh->place =
        array_allocate((size_t)mesh->n_vertices + 1, sizeof *mesh->place); /* kernels read on */
    for (int v = 0; v < mesh->n_vertices; v++)
        mesh->place[v] = mesh->reference[v];
    mesh->face_normal = array_allocate((size_t)mesh->n_faces, sizeof *mesh->face_normal);
    mesh->face_borders = array_allocate_rows((size_t)mesh->n_faces, sizeof *mesh->face_borders);
    mesh_update(mesh);
}

void mesh_build(struct mesh *mesh, int n_vertices, const struct vec3 *vertices, int n_facets,
                const int (*facets)[4])
{
    build(mesh, n_vertices, vertices, n_facets, facets, false);
}

void mesh_build_skin(struct mesh *mesh, int n_vertices, const struct vec3 *vertices,
                     int n_facets, const int (*facets)[4])
{
    build(mesh, n_vertices, vertices, n_facets, facets, true);
    CHECK(mesh->n_corners == n_vertices, "%d of %d vertices are on the surface",
          mesh->n_corners, n_vertices);
}

/* ---- Round surfaces
 * --------------------------------------------------------------------------- */

static void join_bands(struct mesh *mesh, const struct mesh_profile *profile)
{
    mesh->n_rings = profile->n_points;
    mesh->n_bands = profile->n_bands;
    mesh->rings = array_allocate((size_t)mesh->n_rings, sizeof *mesh->rings);
    mesh->bands = array_allocate((size_t)mesh->n_bands, sizeof *mesh->bands);
    for (int r = 0; r < mesh->n_rings; r++)
        mesh->rings[r] =
            (struct mesh_ring){profile->points[r][0], profile->points[r][1], {-1, -1}};
    for (int b = 0; b < mesh->n_bands; b++) {
        const int *ends = profile->bands[b];
        const double *from = profile->points[ends[0]], *to = profile->points[ends[1]];
        const double out = to[0] - from[0], up = to[1] - from[1];
        const double length = sqrt(out * out + up * up);
        CHECK(length > 0.0, "a band without length");
        mesh->bands[b] =
            (struct mesh_band){{ends[0], ends[1]}, {out / length, up / length}, length};
        for (int k = 0; k < 2; k++) {
            struct mesh_ring *ring = &mesh->rings[ends[k]];
            CHECK(ring->bands[1] < 0, "a ring with more than two bands");
            ring->bands[ring->bands[0] < 0 ? 0 : 1] = b;
        }
    }
}

void mesh_build_round(struct mesh *mesh, const struct mesh_profile *profile, struct vec3 origin,
                      struct vec3 direction, int n_vertices, const struct vec3 *vertices,
                      int n_skin, const int (*skin)[4])
{
    *mesh = (struct mesh){.first_degenerate = -1, .first_duplicate = -1};
    join_bands(mesh, profile);
    mesh->n_vertices = mesh->n_corners = n_vertices + 2;
    mesh->reference = array_allocate((size_t)mesh->n_vertices, sizeof *mesh->reference);
    mesh->place = array_allocate((size_t)mesh->n_vertices, sizeof *mesh->place);
    for (int v = 0; v < n_vertices; v++)
        mesh->reference[v] = vertices[v];
    for (int k = 0; k < 2; k++)
        mesh->axis[k] = n_vertices + k;
    /* The axis is given by its part between the lowest and the highest ring, or, for a disc, by
     * a part as long as that is wide, so that rounding cannot turn it by much. */
    double low = mesh->rings[0].height, high = low, width = 0.0;
    for (int r = 0; r < mesh->n_rings; r++) {
        low = mesh->rings[r].height < low ? mesh->rings[r].height : low;
        high = larger(high, mesh->rings[r].height);
        width = larger(width, mesh->rings[r].radius);
    }
    if (!(high > low)) {
        low -= 0.5 * width;
        high += 0.5 * width;
    }
    mesh->reference[mesh->axis[0]] = vec3_axpy(origin, low, direction);
    mesh->reference[mesh->axis[1]] = vec3_axpy(origin, high, direction);
    for (int r = 0; r < mesh->n_rings; r++)
        mesh->rings[r].height -= low;
    for (int v = 0; v < mesh->n_vertices; v++)
        mesh->place[v] = mesh->reference[v];
    mesh->n_skin = n_skin;
    mesh->skin = array_allocate((size_t)n_skin, sizeof *mesh->skin);
    for (int f = 0; f < n_skin; f++)
        memcpy(mesh->skin[f], skin[f], sizeof mesh->skin[f]);
    mesh->edge_begin = array_allocate((size_t)mesh->n_vertices + 1, sizeof *mesh->edge_begin);
    mesh_update(mesh);
}

/* Where the axis is now. */
static void update_axis(struct mesh *mesh)
{
    const struct vec3 along = vec3_sub(mesh->place[mesh->axis[1]], mesh->place[mesh->axis[0]]);
    mesh->origin = mesh->place[mesh->axis[0]];
    mesh->direction = vec3_scale(1.0 / vec3_norm(along), along);
    const struct vec3 u = mesh->direction;
    const struct vec3 other =
        u.x * u.x <= 0.5 ? (struct vec3){1.0, 0.0, 0.0} : (struct vec3){0.0, 1.0, 0.0};
    const struct vec3 across = vec3_cross(u, other);
    mesh->aside = vec3_scale(1.0 / vec3_norm(across), across);
}

/* ---- Survey
 * ----------------------------------------------------------------------------------- */

static const double PI = 3.14159265358979323846;

/* Does the face go from the edge's first vertex to its second? */
static bool goes_along(const struct mesh *mesh, int f, int edge)
{
    const struct mesh_face *face = &mesh->faces[f];
    int k = 0;
    while (face->edges[k] != edge)
        k++;
    return face->vertices[k] == mesh->edges[edge].vertices[0];
}

static void survey_edges(const struct mesh *mesh, struct mesh_survey *survey)
{
    for (int e = mesh->n_edges - 1; e >= 0; e--) {
        const struct mesh_edge *edge = &mesh->edges[e];
        if (edge->n_faces < 2) {
            survey->n_open++;
            survey->first_open = e;
        } else if (edge->n_faces > 2) {
            survey->n_shared++;
            survey->first_shared = e;
        } else if (goes_along(mesh, edge->faces[0], e) == goes_along(mesh, edge->faces[1], e)) {
            survey->n_turned++;
            survey->first_turned = e;
        }
    }
    survey->closed = mesh->n_faces > 0 && survey->n_open == 0 && survey->n_shared == 0;
}

static void survey_faces(const struct mesh *mesh, struct mesh_survey *survey)
{
    double six_volumes = 0.0;
    for (int f = 0; f < mesh->n_faces; f++) {
        const struct vec3 twice_area = face_area(&mesh->faces[f], mesh->reference);
        const struct vec3 arm =
            vec3_sub(mesh->reference[mesh->faces[f].vertices[0]], survey->low);
        survey->area += 0.5 * vec3_norm(twice_area);
        six_volumes += vec3_dot(arm, twice_area);
    }
    survey->volume = six_volumes < 0.0 ? -six_volumes / 6.0 : six_volumes / 6.0;
}

/* Pappus: a band is a frustum's side. */
static void survey_bands(const struct mesh *mesh, struct mesh_survey *survey)
{
    double volume = 0.0;
    survey->closed = mesh->n_bands > 0;
    for (int b = 0; b < mesh->n_bands; b++) {
        const struct mesh_ring *from = &mesh->rings[mesh->bands[b].rings[0]];
        const struct mesh_ring *to = &mesh->rings[mesh->bands[b].rings[1]];
        const double p = from->radius, q = to->radius;
        survey->area += PI * (p + q) * mesh->bands[b].length;
        volume += PI / 3.0 * (p * p + p * q + q * q) * (to->height - from->height);
    }
    for (int r = 0; r < mesh->n_rings; r++) {
        if (mesh->rings[r].bands[1] >= 0 || !(mesh->rings[r].radius > 0.0))
            continue;
        survey->closed = false;
        survey->n_open++;
    }
    survey->volume = volume < 0.0 ? -volume : volume;
}

struct mesh_survey mesh_survey(const struct mesh *mesh)
{
    struct mesh_survey survey = {.first_open = -1, .first_shared = -1, .first_turned = -1};
    const int n = mesh->n_bands > 0 ? mesh->n_vertices - 2 : mesh->n_vertices;
    for (int v = 0; v < n; v++) {
        const struct vec3 x = mesh->reference[v];
        const struct vec3 low = v == 0 ? x : survey.low, high = v == 0 ? x : survey.high;
        survey.low =
            (struct vec3){-larger(-low.x, -x.x), -larger(-low.y, -x.y), -larger(-low.z, -x.z)};
        survey.high =
            (struct vec3){larger(high.x, x.x), larger(high.y, x.y), larger(high.z, x.z)};
    }
    if (mesh->n_bands > 0) {
        survey_bands(mesh, &survey);
    } else {
        survey_edges(mesh, &survey);
        survey_faces(mesh, &survey);
    }
    if (!survey.closed)
        survey.volume = 0.0;
    return survey;
}

void mesh_clear(struct mesh *mesh)
{
    free(mesh->bands);
    free(mesh->rings);
    free(mesh->skin);
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

void mesh_update_face(const struct mesh *mesh, int f)
{
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

void mesh_update(struct mesh *mesh)
{
    if (mesh->n_bands > 0)
        update_axis(mesh);
    for (int f = 0; f < mesh->n_faces; f++)
        mesh_update_face(mesh, f);
}
