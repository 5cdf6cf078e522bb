/* See solid_quality.h.  Nothing here feeds the state. */
#include "model/solid_quality.h"

#include <math.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/groups.h"
#include "base/report.h"
#include "job/job.h"
#include "model/side.h"
#include "model/solid_mesh.h"

/* ------------------------------------------------------------------------------- elements */

long long solid_quality_node_number(const struct solid_mesh *mesh, int node)
{
    return mesh->node_numbers != NULL ? (long long)mesh->node_numbers[node] : node + 1;
}

long long solid_quality_element_number(const struct solid_mesh *mesh, int element)
{
    return mesh->element_numbers != NULL ? (long long)mesh->element_numbers[element]
                                         : element + 1;
}

static struct vec3 mean_of(const struct solid_mesh *mesh, const int *nodes, int n)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int k = 0; k < n; k++)
        sum = vec3_add(sum, mesh->nodes[nodes[k]]);
    return vec3_scale(1.0 / (double)n, sum);
}

struct vec3 solid_quality_centre(const struct solid_mesh *mesh, int element)
{
    const int *nodes = mesh->elements[element];
    return mean_of(mesh, nodes, solid_mesh_n_corners(nodes));
}

/* Area of a side as a vector along its normal, twice; and how much volume it bounds as seen
 * from a point, six times.  A quad counts as four triangles about its mean point, which is
 * exact for the surface that its shape functions make. */
static struct vec3 side_area(const struct solid_mesh *mesh, const int nodes[4], int n,
                             struct vec3 from, double *volume)
{
    struct vec3 sum = {0.0, 0.0, 0.0};
    const struct vec3 middle = vec3_sub(mean_of(mesh, nodes, n), from);
    *volume = 0.0;
    for (int k = 0; k < n; k++) {
        const struct vec3 a = vec3_sub(mesh->nodes[nodes[k]], from);
        const struct vec3 b = vec3_sub(mesh->nodes[nodes[(k + 1) % n]], from);
        sum = vec3_add(sum, vec3_cross(vec3_sub(a, middle), vec3_sub(b, middle)));
        *volume += vec3_dot(middle, vec3_cross(a, b));
    }
    return sum;
}

/* Volume of an element and area of its largest side; of a sheet its own. */
static double measure(const struct solid_mesh *mesh, int element, double *largest)
{
    const int *corners = mesh->elements[element];
    const struct vec3 centre = solid_quality_centre(mesh, element);
    double sum = 0.0;
    *largest = 0.0;
    if (solid_mesh_is_sheet(corners)) {
        *largest = 0.5 * vec3_norm(side_area(mesh, corners, solid_mesh_n_corners(corners),
                                             centre, &sum));
        return *largest * mesh->sheets[element].thickness;
    }
    for (int s = 0; s < solid_mesh_n_sides(corners); s++) {
        int nodes[4];
        double share;
        const int n = solid_mesh_side_nodes(corners, s, nodes);
        const double area = 0.5 * vec3_norm(side_area(mesh, nodes, n, centre, &share));
        sum += share;
        *largest = area > *largest ? area : *largest;
    }
    return sum / 6.0;
}

double solid_quality_volume(const struct solid_mesh *mesh, int element)
{
    double largest;
    return measure(mesh, element, &largest);
}

/* The three neighbours of each corner, right-handed; a tetrahedron's are the other three. */
static const int AROUND_8[8][3] = {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7},
                                   {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}};
static const int AROUND_4[4][3] = {{1, 2, 3}, {2, 0, 3}, {0, 1, 3}, {0, 2, 1}};

/* The same of a sheet. */
static double sheet_jacobian(const struct solid_mesh *mesh, int element, double *aspect)
{
    const int *nodes = mesh->elements[element];
    const int n = solid_mesh_n_corners(nodes);
    const double regular = n == 4 ? 1.0 : 2.0 / sqrt(3.0);
    double least = HUGE_VAL, shortest = HUGE_VAL, longest = 0.0, share;
    const struct vec3 area = side_area(mesh, nodes, n, mesh->nodes[nodes[0]], &share);
    const double size = vec3_norm(area);
    for (int c = 0; c < n; c++) {
        const struct vec3 at = mesh->nodes[nodes[c]];
        const struct vec3 next = vec3_sub(mesh->nodes[nodes[(c + 1) % n]], at),
                          last = vec3_sub(mesh->nodes[nodes[(c + n - 1) % n]], at);
        const double a = vec3_norm(next), b = vec3_norm(last);
        const double turn = vec3_dot(vec3_cross(next, last), area);
        const double scaled = a * b * size > 0.0 ? regular * turn / (a * b * size) : 0.0;
        least = scaled < least ? scaled : least;
        shortest = a < shortest ? a : shortest;
        longest = a > longest ? a : longest;
    }
    *aspect = longest / shortest;
    return least;
}

static double warp_of(const struct solid_mesh *mesh, int element)
{
    const int *nodes = mesh->elements[element];
    double share;
    if (!solid_mesh_is_sheet(nodes) || solid_mesh_n_corners(nodes) < 4)
        return 0.0;
    const struct vec3 twice = side_area(mesh, nodes, 4, mesh->nodes[nodes[0]], &share);
    const double size = vec3_norm(twice);
    const struct vec3 diagonals =
        vec3_sub(vec3_add(mesh->nodes[nodes[0]], mesh->nodes[nodes[2]]),
                 vec3_add(mesh->nodes[nodes[1]], mesh->nodes[nodes[3]]));
    return size > 0.0 ? fabs(vec3_dot(diagonals, twice)) / (size * sqrt(0.5 * size)) : 0.0;
}

/* Scaled Jacobian of an element, and its longest over its shortest edge. */
static double jacobian_of(const struct solid_mesh *mesh, int element, double *aspect)
{
    const int *nodes = mesh->elements[element];
    if (solid_mesh_is_sheet(nodes))
        return sheet_jacobian(mesh, element, aspect);
    const int n = solid_mesh_n_corners(nodes);
    const double regular = n == 8 ? 1.0 : sqrt(2.0); /* over the volume of three edges */
    double least = HUGE_VAL, shortest = HUGE_VAL, longest = 0.0;
    for (int c = 0; c < n; c++) {
        struct vec3 edge[3];
        double lengths = 1.0;
        for (int k = 0; k < 3; k++) {
            edge[k] = vec3_sub(mesh->nodes[nodes[n == 8 ? AROUND_8[c][k] : AROUND_4[c][k]]],
                               mesh->nodes[nodes[c]]);
            const double length = vec3_norm(edge[k]);
            lengths *= length;
            shortest = length < shortest ? length : shortest;
            longest = length > longest ? length : longest;
        }
        const double volume = vec3_dot(edge[0], vec3_cross(edge[1], edge[2]));
        const double scaled = lengths > 0.0 ? regular * volume / lengths : 0.0;
        least = scaled < least ? scaled : least;
    }
    *aspect = longest / shortest;
    return least;
}

/* ---------------------------------------------------------------------------------- parts */

/* Pieces that have no node in common. */
static int count_parts(const struct solid_mesh *mesh)
{
    int *groups = groups_apart(mesh->n_nodes);
    int n = mesh->n_nodes;
    for (int e = 0; e < mesh->n_elements; e++)
        for (int c = 1; c < solid_mesh_n_corners(mesh->elements[e]); c++)
            n -= groups_join(groups, mesh->elements[e][0], mesh->elements[e][c]);
    free(groups);
    return n;
}

static void add_element(struct solid_quality *quality, const struct solid_mesh *mesh, int e)
{
    double aspect;
    const double jacobian = jacobian_of(mesh, e, &aspect);
    const int n = solid_mesh_n_corners(mesh->elements[e]);
    const double warp = warp_of(mesh, e);
    if (solid_mesh_is_sheet(mesh->elements[e])) {
        const double thickness = mesh->sheets[e].thickness;
        const double width = sqrt(solid_quality_volume(mesh, e) / thickness);
        const double thick = thickness / width;
        quality->n_quads += n == 4;
        quality->n_triangles += n == 3;
        quality->thickness_least =
            thickness < quality->thickness_least ? thickness : quality->thickness_least;
        quality->thickness_most =
            thickness > quality->thickness_most ? thickness : quality->thickness_most;
        if (thick > quality->thick) {
            quality->thick = thick;
            quality->thick_worst = e;
        }
    } else {
        quality->n_hexahedra += n == 8;
        quality->n_tetrahedra += n == 4;
    }
    if (warp > quality->warp) {
        quality->warp = warp;
        quality->warp_worst = e;
    }
    quality->volume += solid_quality_volume(mesh, e);
    quality->jacobian_mean += jacobian / (double)mesh->n_elements;
    if (!(aspect <= quality->aspect)) {
        quality->aspect = aspect;
        quality->aspect_worst = e;
    }
    if (!(jacobian >= quality->jacobian_least)) {
        quality->jacobian_least = jacobian;
        quality->jacobian_worst = e;
    }
}

struct solid_quality solid_quality_of(const struct solid_mesh *mesh)
{
    struct solid_mesh_side *sides;
    struct solid_quality quality = {.n_sides = solid_mesh_surface(mesh, &sides),
                                    .low = {HUGE_VAL, HUGE_VAL, HUGE_VAL},
                                    .high = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL},
                                    .jacobian_least = HUGE_VAL,
                                    .thickness_least = HUGE_VAL,
                                    .n_parts = count_parts(mesh)};
    for (int k = 0; k < mesh->n_nodes; k++) {
        const struct vec3 x = mesh->nodes[k];
        quality.low.x = x.x < quality.low.x ? x.x : quality.low.x;
        quality.low.y = x.y < quality.low.y ? x.y : quality.low.y;
        quality.low.z = x.z < quality.low.z ? x.z : quality.low.z;
        quality.high.x = x.x > quality.high.x ? x.x : quality.high.x;
        quality.high.y = x.y > quality.high.y ? x.y : quality.high.y;
        quality.high.z = x.z > quality.high.z ? x.z : quality.high.z;
    }
    for (int e = 0; e < mesh->n_elements; e++)
        add_element(&quality, mesh, e);
    for (int k = 0; k < quality.n_sides; k++) {
        int nodes[4];
        double share;
        const int n =
            solid_mesh_side_nodes(mesh->elements[sides[k].element], sides[k].side, nodes);
        quality.area +=
            0.5 * vec3_norm(side_area(mesh, nodes, n, mesh->nodes[nodes[0]], &share));
    }
    free(sides);
    return quality;
}

/* --------------------------------------------------------------------------------- faults */

enum { LISTED = 5, TEXT = 256 }; /* of each kind */

struct finder {
    const struct solid_mesh *mesh;
    const char *name, *file;
    struct job_place place;
    struct mistakes *mistakes;
    int n; /* of the present kind */
};

static void find(struct finder *finder, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Lists one fault of the present kind while few are listed. */
static void find(struct finder *finder, const char *format, ...)
{
    char text[TEXT];
    va_list arguments;
    if (++finder->n > LISTED)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    mistakes_add(finder->mistakes, finder->file, finder->place.line, finder->place.column,
                 "body '%s': %s", finder->name, text);
}

/* Tells how many more there are, and begins the next kind. */
static void end_kind(struct finder *finder, const char *what)
{
    if (finder->n > LISTED)
        mistakes_add(finder->mistakes, finder->file, finder->place.line, finder->place.column,
                     "body '%s': %d more %s; none is expected", finder->name,
                     finder->n - LISTED, what);
    finder->n = 0;
}

/* "element 12 at (0.1, 0.2, 0.3) m" */
static const char *element_name(const struct finder *finder, int e, char text[TEXT])
{
    const struct vec3 x = solid_quality_centre(finder->mesh, e);
    snprintf(text, TEXT, "element %lld at (%.4g, %.4g, %.4g) m",
             solid_quality_element_number(finder->mesh, e), x.x, x.y, x.z);
    return text;
}

static const char *edge_name(const struct finder *finder, int a, int b, char text[TEXT])
{
    const int ends[2] = {a, b};
    const struct vec3 x = mean_of(finder->mesh, ends, 2);
    snprintf(text, TEXT, "the edge of nodes %lld and %lld at (%.4g, %.4g, %.4g) m",
             solid_quality_node_number(finder->mesh, a),
             solid_quality_node_number(finder->mesh, b), x.x, x.y, x.z);
    return text;
}

static void find_loose_nodes(struct finder *finder)
{
    const struct solid_mesh *mesh = finder->mesh;
    bool *used = array_allocate((size_t)mesh->n_nodes, sizeof *used);
    for (int e = 0; e < mesh->n_elements; e++)
        for (int c = 0; c < solid_mesh_n_corners(mesh->elements[e]); c++)
            used[mesh->elements[e][c]] = true;
    for (int k = 0; k < mesh->n_nodes; k++)
        if (!used[k])
            find(
                finder,
                "node %lld at (%.4g, %.4g, %.4g) m belongs to no element; a mesh without loose "
                "nodes, or `group`, a physical volume, is expected",
                solid_quality_node_number(mesh, k), mesh->nodes[k].x, mesh->nodes[k].y,
                mesh->nodes[k].z);
    end_kind(finder, "nodes that belong to no element");
    free(used);
}

static bool has_node_twice(const int *element)
{
    const int n = solid_mesh_n_corners(element);
    for (int a = 1; a < n; a++)
        for (int b = 0; b < a; b++)
            if (element[a] == element[b])
                return true;
    return false;
}

/* Volumes below this part of what edges as long would span are none. */
static const double FLAT = 1e-9;

static void find_folded(struct finder *finder)
{
    const struct solid_mesh *mesh = finder->mesh;
    char name[TEXT];
    for (int e = 0; e < mesh->n_elements; e++)
        if (has_node_twice(mesh->elements[e]))
            find(finder, "%s has a node twice; different ones are expected",
                 element_name(finder, e, name));
    end_kind(finder, "elements with a node twice");
    for (int e = 0; e < mesh->n_elements; e++) {
        double largest, aspect;
        const double volume = measure(mesh, e, &largest);
        const double span = largest * sqrt(largest);
        const double corner = jacobian_of(mesh, e, &aspect);
        if (solid_mesh_is_sheet(mesh->elements[e])) {
            if (!(corner > FLAT) && !has_node_twice(mesh->elements[e]))
                find(
                    finder,
                    "%s has no area or is folded, at a corner its scaled Jacobian is %.2g; one "
                    "above 0 is expected",
                    element_name(finder, e, name), corner);
            continue;
        }
        if (!(volume > FLAT * span) && !has_node_twice(mesh->elements[e]))
            find(finder,
                 volume < -FLAT * span ? "%s is flipped, its volume is %.3g m3; nodes "
                                         "the other way round are expected"
                                       : "%s is flat, its volume is %.3g m3; one above "
                                         "0 is expected",
                 element_name(finder, e, name), volume);
        else if (!(corner > -FLAT) && !has_node_twice(mesh->elements[e]))
            find(
                finder,
                "%s is folded, at a corner its scaled Jacobian is %.2g; one above 0 is expected",
                element_name(finder, e, name), corner);
    }
    end_kind(finder, "elements that are flipped, flat or folded");
}

/* An element by its nodes in order. */
struct known {
    int nodes[8], element;
};

static int compare_nodes(const struct known *p, const struct known *q)
{
    for (int k = 0; k < 8; k++)
        if (p->nodes[k] != q->nodes[k])
            return p->nodes[k] < q->nodes[k] ? -1 : 1;
    return 0;
}

static int compare_known(const void *a, const void *b)
{
    const struct known *p = a, *q = b;
    const int order = compare_nodes(p, q);
    return order != 0 ? order : (p->element > q->element) - (p->element < q->element);
}

static void find_doubles(struct finder *finder)
{
    const struct solid_mesh *mesh = finder->mesh;
    struct known *known = array_allocate((size_t)mesh->n_elements, sizeof *known);
    char name[TEXT];
    for (int e = 0; e < mesh->n_elements; e++) {
        memcpy(known[e].nodes, mesh->elements[e], sizeof known[e].nodes);
        qsort(known[e].nodes, 8, sizeof *known[e].nodes, array_compare_ints);
        known[e].element = e;
    }
    qsort(known, (size_t)mesh->n_elements, sizeof *known, compare_known);
    for (int k = 1; k < mesh->n_elements; k++)
        if (compare_nodes(&known[k - 1], &known[k]) == 0)
            find(finder, "%s has the nodes of element %lld; each element once is expected, %s",
                 element_name(finder, known[k].element, name),
                 solid_quality_element_number(mesh, known[k - 1].element),
                 solid_mesh_is_sheet(mesh->elements[known[k].element])
                     ? "and one sheet in a place"
                     : "in one physical volume or in format 4.1");
    end_kind(finder, "elements that are there twice");
    free(known);
}

/* Sides of the surface: polygons of the edges at which they meet. */
struct outside {
    struct solid_mesh_side *sides;
    int n_edges; /* one for each side along it */
    struct side *edges;
};

static struct outside find_outside(const struct solid_mesh *mesh)
{
    struct outside outside = {.n_edges = 0};
    const int n = solid_mesh_surface(mesh, &outside.sides);
    outside.edges = array_allocate(4 * (size_t)n, sizeof *outside.edges);
    for (int k = 0; k < n; k++) {
        const struct solid_mesh_side at = outside.sides[k];
        int nodes[4];
        if (solid_mesh_is_sheet(mesh->elements[at.element]))
            continue; /* may end, and meet several */
        const int m = solid_mesh_side_nodes(mesh->elements[at.element], at.side, nodes);
        side_add(outside.edges, &outside.n_edges, k, m, nodes);
    }
    side_sort(outside.edges, outside.n_edges);
    return outside;
}

/* Do a quad and a triangle of the surface lie on each other? */
static bool is_seam(const struct solid_mesh *mesh, struct solid_mesh_side p,
                    struct solid_mesh_side q)
{
    int a[4], b[4], n_shared = 0;
    const int n = solid_mesh_side_nodes(mesh->elements[p.element], p.side, a);
    const int m = solid_mesh_side_nodes(mesh->elements[q.element], q.side, b);
    for (int k = 0; k < n; k++)
        for (int j = 0; j < m; j++)
            n_shared += a[k] == b[j];
    return n != m && n_shared == 3;
}

static void find_shared_sides(struct finder *finder)
{
    const struct solid_mesh *mesh = finder->mesh;
    int *partners = solid_mesh_partners(mesh);
    char name[TEXT];
    for (int number = 0; number < SOLID_MESH_SIDES * mesh->n_elements; number++)
        if (partners[number] == SOLID_MESH_SEVERAL)
            find(finder, "%s shares a side with more than one element; one is expected",
                 element_name(finder, number / SOLID_MESH_SIDES, name));
    end_kind(finder, "sides of more than two elements");
    free(partners);
}

static void find_seams(struct finder *finder, const struct outside *outside)
{
    const struct solid_mesh *mesh = finder->mesh;
    const struct side *edges = outside->edges;
    enum { MOST = 16 }; /* sides of an edge that are looked at */
    char name[TEXT];
    for (int first = 0, end; first < outside->n_edges; first = end) {
        end = side_edge_end(edges, first, outside->n_edges);
        for (int k = first + 1; k < end && k < first + MOST; k++)
            for (int j = first; j < k; j++)
                if (is_seam(mesh, outside->sides[edges[j].polygon],
                            outside->sides[edges[k].polygon]))
                    find(finder,
                         "%s meets another in a part of a side, hexahedron and tetrahedron, "
                         "which leaves a gap; elements of one kind there are expected",
                         element_name(finder, outside->sides[edges[k].polygon].element, name));
    }
    end_kind(finder, "edges of sides where hexahedra meet tetrahedra");
}

static void find_bad_edges(struct finder *finder)
{
    const struct outside outside = find_outside(finder->mesh);
    const struct side *edges = outside.edges;
    const int n_before = finder->mistakes->n;
    char name[TEXT];
    find_seams(finder, &outside);
    for (int first = 0, end; first < outside.n_edges && finder->mistakes->n == n_before;
         first = end) {
        end = side_edge_end(edges, first, outside.n_edges);
        if (end - first != 2)
            find(finder,
                 "%s is one of %d sides of the surface, which meets itself there; elements "
                 "joined in whole sides are expected",
                 edge_name(finder, edges[first].ends[0], edges[first].ends[1], name),
                 end - first);
    }
    end_kind(finder, "edges where the surface meets itself");
    free(outside.sides);
    free(outside.edges);
}

void solid_quality_check(const struct solid_mesh *mesh, const char *name, const char *file,
                         struct job_place place, struct mistakes *mistakes)
{
    struct finder finder = {mesh, name, file, place, mistakes, 0};
    const int n_before = mistakes->n;
    find_loose_nodes(&finder);
    find_folded(&finder);
    if (mistakes->n > n_before)
        return; /* what follows would speak of the same elements again */
    find_doubles(&finder);
    if (mistakes->n == n_before)
        find_shared_sides(&finder);
    if (mistakes->n == n_before)
        find_bad_edges(&finder);
}
