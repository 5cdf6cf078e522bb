/*
 * Every shape is a section of quads, drawn out in layers.  The section of a cylinder has a core
 * of squares whose sides bulge a little, so that at its corners the three cells that meet have
 * about 120 degrees each, and layers from there to the rim; no cell is folded or nearly so, as
 * some are where a square is bent into a disc.
 *
 * A cell becomes six tetrahedra about its node of least number: on each of its sides the
 * diagonal from the side's least node cuts, whichever cell asks, so cuts of neighbours agree.
 */
#include "model/solid_shape.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/elementary.h"
#include "base/report.h"
#include "base/vec3.h"
#include "job/job.h"
#include "model/solid_mesh.h"

static const double PI = 3.14159265358979323846;
/* Of a cylinder's radius: where the corners of the core are; and by how much its sides bulge
 * from straight (0) to round (1). */
static const double CORE = 0.6, BULGE = 0.32;

/* What a side of an element lies on, as a set of bits; X_MIN is also a cylinder's side and a
 * tube's inside, X_MAX its outside. */
enum { NOWHERE = 0, BOTTOM = 1, TOP = 2, X_MIN = 4, X_MAX = 8, Y_MIN = 16, Y_MAX = 32 };

struct section {
    int n_points, n_quads;
    double (*points)[2]; /* [m] */
    int (*quads)[4];     /* counter-clockwise */
    int (*labels)[4];    /* of the side from corner k to k + 1 */
};

/* Where a section stands, and along what it is drawn out. */
struct frame {
    struct vec3 origin, a, b, along; /* at height 0 of the section's origin; of length 1 */
    double low, high;                /* heights [m] */
    int n_layers;
};

/* -------------------------------------------------------------------------------- sections */

static void section_reserve(struct section *section, int n_points, int n_quads)
{
    *section = (struct section){0};
    section->points = array_allocate((size_t)n_points, sizeof *section->points);
    section->quads = array_allocate((size_t)n_quads, sizeof *section->quads);
    section->labels = array_allocate((size_t)n_quads, sizeof *section->labels);
}

static void section_clear(struct section *section)
{
    free(section->points);
    free(section->quads);
    free(section->labels);
}

static void add_point(struct section *section, double x, double y)
{
    section->points[section->n_points][0] = x;
    section->points[section->n_points++][1] = y;
}

static void add_quad(struct section *section, const int corners[4], const int labels[4])
{
    memcpy(section->quads[section->n_quads], corners, 4 * sizeof *corners);
    memcpy(section->labels[section->n_quads++], labels, 4 * sizeof *labels);
}

/* Place k of n between two, which it hits exactly. */
static double between(double low, double high, int k, int n)
{
    return k == n ? high : low + (high - low) * ((double)k / (double)n);
}

static void build_rectangle(struct section *section, struct vec3 low, struct vec3 high,
                            const int n[2])
{
    section_reserve(section, (n[0] + 1) * (n[1] + 1), n[0] * n[1]);
    for (int j = 0; j <= n[1]; j++)
        for (int i = 0; i <= n[0]; i++)
            add_point(section, between(low.x, high.x, i, n[0]),
                      between(low.y, high.y, j, n[1]));
    for (int j = 0; j < n[1]; j++)
        for (int i = 0; i < n[0]; i++) {
            const int c = j * (n[0] + 1) + i, d = c + n[0] + 1;
            const int corners[4] = {c, c + 1, d + 1, d};
            const int labels[4] = {j == 0 ? Y_MIN : NOWHERE, i == n[0] - 1 ? X_MAX : NOWHERE,
                                   j == n[1] - 1 ? Y_MAX : NOWHERE, i == 0 ? X_MIN : NOWHERE};
            add_quad(section, corners, labels);
        }
}

/* Point k of n around, of a circle. */
static void add_around(struct section *section, double radius, double start, int k, int n)
{
    const double angle = start + 2.0 * PI * ((double)k / (double)n);
    add_point(section, radius * elementary_cos(angle), radius * elementary_sin(angle));
}

static void build_annulus(struct section *section, double inner, double outer, int around,
                          int through)
{
    section_reserve(section, around * (through + 1), around * through);
    for (int j = 0; j <= through; j++)
        for (int k = 0; k < around; k++)
            add_around(section, between(inner, outer, j, through), 0.0, k, around);
    for (int j = 0; j < through; j++)
        for (int k = 0; k < around; k++) {
            const int next = (k + 1) % around, c = j * around, d = c + around;
            const int corners[4] = {c + k, d + k, d + next, c + next};
            const int labels[4] = {NOWHERE, j == through - 1 ? X_MAX : NOWHERE, NOWHERE,
                                   j == 0 ? X_MIN : NOWHERE};
            add_quad(section, corners, labels);
        }
}

/* A point of the core at s, t from -1 to 1: between that of a square and that of the disc which
 * lines of constant larger coordinate go round. */
static void add_core(struct section *section, double radius, double s, double t)
{
    const double half = radius / sqrt(2.0);
    const bool upright = (s < 0.0 ? -s : s) >= (t < 0.0 ? -t : t);
    const double reach = upright ? s : t, share = upright ? t : s;
    const double angle = reach != 0.0 ? 0.25 * PI * (share / reach) : 0.0;
    const double ahead = reach * radius * elementary_cos(angle);
    const double aside = reach * radius * elementary_sin(angle);
    const double x = upright ? ahead : aside, y = upright ? aside : ahead;
    add_point(section, half * s + BULGE * (x - half * s), half * t + BULGE * (y - half * t));
}

/* Point k of 4 n around the core, counter-clockwise from its corner of least x and y. */
static int core_border(int k, int n)
{
    const int row = n + 1, along = k % n;
    switch (k / n) {
    case 0:
        return along;
    case 1:
        return along * row + n;
    case 2:
        return n * row + n - along;
    default:
        return (n - along) * row;
    }
}

/* Point k of 4 n around in ring j, ring 0 being the border of the core. */
static int ring_point(int j, int k, int n)
{
    k = k % (4 * n);
    return j == 0 ? core_border(k, n) : (n + 1) * (n + 1) + (j - 1) * 4 * n + k;
}

static void build_disc(struct section *section, double radius, int n, int m)
{
    static const int inside[4] = {NOWHERE, NOWHERE, NOWHERE, NOWHERE};
    section_reserve(section, (n + 1) * (n + 1) + 4 * n * m, n * n + 4 * n * m);
    for (int j = 0; j <= n; j++)
        for (int i = 0; i <= n; i++)
            add_core(section, CORE * radius, between(-1.0, 1.0, i, n),
                     between(-1.0, 1.0, j, n));
    for (int j = 1; j <= m; j++)
        for (int k = 0; k < 4 * n; k++) {
            add_around(section, radius, -0.75 * PI, k, 4 * n);
            double *rim = section->points[section->n_points - 1];
            const double *core = section->points[core_border(k, n)];
            rim[0] = between(core[0], rim[0], j, m);
            rim[1] = between(core[1], rim[1], j, m);
        }
    for (int j = 0; j < n; j++)
        for (int i = 0; i < n; i++) {
            const int c = j * (n + 1) + i, d = c + n + 1;
            const int corners[4] = {c, c + 1, d + 1, d};
            add_quad(section, corners, inside);
        }
    for (int j = 0; j < m; j++)
        for (int k = 0; k < 4 * n; k++) {
            const int corners[4] = {ring_point(j, k, n), ring_point(j + 1, k, n),
                                    ring_point(j + 1, k + 1, n), ring_point(j, k + 1, n)};
            const int labels[4] = {NOWHERE, j == m - 1 ? X_MIN : NOWHERE, NOWHERE, NOWHERE};
            add_quad(section, corners, labels);
        }
}

/* ---------------------------------------------------------------------------------- layers */

static void draw_out(struct solid_mesh *mesh, const struct section *section,
                     const struct frame *frame, int *labels)
{
    for (int l = 0; l <= frame->n_layers; l++) {
        const struct vec3 middle = vec3_axpy(
            frame->origin, between(frame->low, frame->high, l, frame->n_layers), frame->along);
        for (int p = 0; p < section->n_points; p++)
            mesh->nodes[mesh->n_nodes++] =
                vec3_axpy(vec3_axpy(middle, section->points[p][0], frame->a),
                          section->points[p][1], frame->b);
    }
    for (int l = 0; l < frame->n_layers; l++)
        for (int q = 0; q < section->n_quads; q++) {
            int *element = mesh->elements[mesh->n_elements];
            int *label = labels + SOLID_MESH_SIDES * mesh->n_elements++;
            label[0] = l == 0 ? BOTTOM : NOWHERE;
            label[1] = l == frame->n_layers - 1 ? TOP : NOWHERE;
            for (int c = 0; c < 4; c++) {
                element[c] = l * section->n_points + section->quads[q][c];
                element[4 + c] = element[c] + section->n_points;
                label[2 + c] = section->labels[q][c];
            }
        }
}

/* ------------------------------------------------------------------------------ tetrahedra */

/* The corner of least number of n. */
static int least_of(const int *nodes, int n)
{
    int least = 0;
    for (int k = 1; k < n; k++)
        least = nodes[k] < nodes[least] ? k : least;
    return least;
}

/* Which side of a cell has these three nodes; -1: none. */
static int side_with(const int cell[8], const int nodes[3])
{
    for (int s = 0; s < 6; s++) {
        int corners[4], n = 0;
        solid_mesh_side_nodes(cell, s, corners);
        for (int k = 0; k < 12; k++)
            n += corners[k % 4] == nodes[k / 4];
        if (n == 3)
            return s;
    }
    return -1;
}

/* The two triangles of a side that lies opposite to a node, with the node as tetrahedra. */
static int cut_side(int apex, const int corners[4], int (*tetrahedra)[8], int n)
{
    const int first = least_of(corners, 4);
    for (int k = 0; k < 2; k++) {
        int *t = tetrahedra[n++];
        for (int c = 0; c < 8; c++)
            t[c] = -1;
        /* Seen from outside the side turns counter-clockwise, so seen from the node it does
         * the other way round. */
        t[0] = corners[first];
        t[1] = corners[(first + 2 + k) % 4];
        t[2] = corners[(first + 1 + k) % 4];
        t[3] = apex;
    }
    return n;
}

static int cut_cell(const int cell[8], int (*tetrahedra)[8])
{
    const int apex = cell[least_of(cell, 8)];
    int n = 0;
    for (int s = 0; s < 6; s++) {
        int corners[4];
        solid_mesh_side_nodes(cell, s, corners);
        if (corners[least_of(corners, 4)] != apex)
            n = cut_side(apex, corners, tetrahedra, n);
    }
    return n;
}

static void cut_cells(struct solid_mesh *mesh, int **labels)
{
    const int n_cells = mesh->n_elements;
    int(*tetrahedra)[8] = array_allocate(6 * (size_t)n_cells, sizeof *tetrahedra);
    int *cut = array_allocate(6 * (size_t)n_cells * SOLID_MESH_SIDES, sizeof *cut);
    int n = 0;
    for (int e = 0; e < n_cells; e++) {
        const int first = n;
        n += cut_cell(mesh->elements[e], tetrahedra + n);
        for (int t = first; t < n; t++)
            for (int s = 0; s < 4; s++) {
                int corners[4];
                solid_mesh_side_nodes(tetrahedra[t], s, corners);
                const int side = side_with(mesh->elements[e], corners);
                cut[SOLID_MESH_SIDES * t + s] =
                    side >= 0 ? (*labels)[SOLID_MESH_SIDES * e + side] : NOWHERE;
            }
    }
    free(mesh->elements);
    free(*labels);
    mesh->elements = tetrahedra;
    mesh->n_elements = n;
    *labels = cut;
}

/* ------------------------------------------------------------------------------------ sets */

static void add_set(struct solid_mesh *mesh, const char *name, const int *labels, int wanted)
{
    struct solid_mesh_list nodes = {0}, sides = {0}, elements = {0};
    for (int number = 0; number < SOLID_MESH_SIDES * mesh->n_elements; number++) {
        int corners[4];
        if ((labels[number] & wanted) == 0)
            continue;
        solid_mesh_list_add(&sides, number);
        const int n = solid_mesh_side_nodes(mesh->elements[number / SOLID_MESH_SIDES],
                                            number % SOLID_MESH_SIDES, corners);
        for (int k = 0; k < n; k++)
            solid_mesh_list_add(&nodes, corners[k]);
    }
    solid_mesh_add_set(mesh, name, &nodes, &sides, &elements);
    free(nodes.items);
    free(sides.items);
}

static void add_sets(struct solid_mesh *mesh, enum job_mesh_kind kind, const int *labels)
{
    static const struct {
        const char *name;
        int labels;
        unsigned kinds;
    } sets[] = {
#define WITH(kind) (1u << (kind))
#define FLAT       (WITH(JOB_MESH_BOX) | WITH(JOB_MESH_PLATE))
#define ANY        (FLAT | WITH(JOB_MESH_CYLINDER) | WITH(JOB_MESH_TUBE))
        {"bottom", BOTTOM, ANY},
        {"top", TOP, ANY},
        {"side", X_MIN | X_MAX | Y_MIN | Y_MAX, FLAT | WITH(JOB_MESH_CYLINDER)},
        {"x_min", X_MIN, FLAT},
        {"x_max", X_MAX, FLAT},
        {"y_min", Y_MIN, FLAT},
        {"y_max", Y_MAX, FLAT},
        {"z_min", BOTTOM, FLAT},
        {"z_max", TOP, FLAT},
        {"inside", X_MIN, WITH(JOB_MESH_TUBE)},
        {"outside", X_MAX, WITH(JOB_MESH_TUBE)},
    };
    for (size_t k = 0; k < sizeof sets / sizeof *sets; k++)
        if ((sets[k].kinds & WITH(kind)) != 0)
            add_set(mesh, sets[k].name, labels, sets[k].labels);
}

/* ---------------------------------------------------------------------------------- shapes */

/* Corners of a box or a plate. */
static void corners_of(const struct job_body *body, struct vec3 *low, struct vec3 *high)
{
    const struct job_solid *solid = &body->solid;
    const bool plate = solid->kind == JOB_MESH_PLATE;
    const struct vec3 size = {solid->size[0], solid->size[1], solid->thickness};
    *low = plate ? solid->corner : body->min;
    *high = plate ? vec3_add(solid->corner, size) : body->max;
}

/* What is divided into cells, along each of the three ways [m]. */
static void ways_of(const struct job_body *body, double ways[3])
{
    const bool tube = body->solid.kind == JOB_MESH_TUBE;
    struct vec3 low, high;
    if (tube || body->solid.kind == JOB_MESH_CYLINDER) {
        /* Cells are widest at the rim, and from the core to it beside the middle of a side. */
        ways[0] = tube ? 2.0 * PI * body->outer : 0.5 * PI * body->radius;
        ways[1] = tube ? body->outer - body->inner
                       : (1.0 - CORE * (BULGE + (1.0 - BULGE) / sqrt(2.0))) * body->radius;
        ways[2] = vec3_norm(vec3_sub(body->to, body->from));
        return;
    }
    corners_of(body, &low, &high);
    ways[0] = high.x - low.x;
    ways[1] = high.y - low.y;
    ways[2] = high.z - low.z;
}

void solid_shape_cells(const struct job_body *body, double cells[3])
{
    static const double HAIR = 1e-9;
    double ways[3];
    ways_of(body, ways);
    for (int k = 0; k < 3; k++) {
        const double least = k == 0 && body->solid.kind == JOB_MESH_TUBE ? 3.0 : 1.0;
        cells[k] = (double)body->solid.cells[k];
        if (body->solid.cell > 0.0)
            cells[k] = ceil(ways[k] / body->solid.cell * (1.0 - HAIR));
        cells[k] = cells[k] > least ? cells[k] : least;
    }
}

double solid_shape_n_elements(const struct job_body *body)
{
    const double share = body->solid.elements == JOB_ELEMENTS_TETRAHEDRA ? 6.0 : 1.0;
    double n[3];
    solid_shape_cells(body, n);
    if (body->solid.kind == JOB_MESH_CYLINDER)
        return share * (n[0] * n[0] + 4.0 * n[0] * n[1]) * n[2];
    return share * n[0] * n[1] * n[2];
}

/* A frame about the axis from `from` to `to`. */
static struct frame axis_frame(const struct job_body *body)
{
    const struct vec3 way = vec3_sub(body->to, body->from);
    const double length = vec3_norm(way);
    const struct vec3 u = vec3_scale(1.0 / length, way);
    const struct vec3 other =
        u.x * u.x <= 0.5 ? (struct vec3){1.0, 0.0, 0.0} : (struct vec3){0.0, 1.0, 0.0};
    const struct vec3 across = vec3_axpy(other, -vec3_dot(other, u), u);
    const struct vec3 a = vec3_scale(1.0 / vec3_norm(across), across);
    return (struct frame){body->from, a, vec3_cross(u, a), u, 0.0, length, 0};
}

static struct frame build_section(struct section *section, const struct job_body *body,
                                  const int n[3])
{
    struct frame frame = {.a = {1.0, 0.0, 0.0}, .b = {0.0, 1.0, 0.0}, .along = {0.0, 0.0, 1.0}};
    struct vec3 low, high;
    switch (body->solid.kind) {
    case JOB_MESH_BOX:
    case JOB_MESH_PLATE:
        corners_of(body, &low, &high);
        build_rectangle(section, low, high, n);
        frame.low = low.z;
        frame.high = high.z;
        break;
    case JOB_MESH_CYLINDER:
        build_disc(section, body->radius, n[0], n[1]);
        frame = axis_frame(body);
        break;
    case JOB_MESH_TUBE:
        build_annulus(section, body->inner, body->outer, n[0], n[1]);
        frame = axis_frame(body);
        break;
    case JOB_MESH_GMSH:
        CHECK(false, "a file is no shape");
    }
    frame.n_layers = n[2];
    return frame;
}

void solid_shape_build(struct solid_mesh *mesh, const struct job_body *body)
{
    struct section section = {0};
    double cells[3];
    solid_shape_cells(body, cells);
    const int n[3] = {(int)cells[0], (int)cells[1], (int)cells[2]};
    const struct frame frame = build_section(&section, body, n);
    const size_t n_elements = (size_t)section.n_quads * (size_t)n[2];
    int *labels = array_allocate(n_elements * SOLID_MESH_SIDES, sizeof *labels);
    mesh->nodes =
        array_allocate((size_t)section.n_points * ((size_t)n[2] + 1), sizeof *mesh->nodes);
    mesh->elements = array_allocate(n_elements, sizeof *mesh->elements);
    draw_out(mesh, &section, &frame, labels);
    if (body->solid.elements == JOB_ELEMENTS_TETRAHEDRA)
        cut_cells(mesh, &labels);
    add_sets(mesh, body->solid.kind, labels);
    section_clear(&section);
    free(labels);
}
