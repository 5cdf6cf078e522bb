/* See skin.h. */
#include "model/skin.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "model/side.h"
#include "model/solid_mesh.h"

/* ---------------------------------------------------------------------------------- places */

static struct vec3 place_of(const double *places, size_t stride, int node)
{
    const double *x = places + stride * (size_t)node;
    return (struct vec3){x[0], x[1], x[2]};
}

struct vec3 skin_normal(const struct skin_sheet *sheet, const double *places, size_t stride)
{
    const int *c = sheet->corners;
    const struct vec3 a = place_of(places, stride, c[0]), b = place_of(places, stride, c[1]),
                      d = place_of(places, stride, c[2]);
    const struct vec3 area =
        c[3] < 0 ? vec3_cross(vec3_sub(b, a), vec3_sub(d, a))
                 : vec3_cross(vec3_sub(d, a), vec3_sub(place_of(places, stride, c[3]), b));
    return vec3_scale(1.0 / vec3_norm(area), area);
}

struct vec3 skin_arm(const struct skin *skin, int ring, const struct vec3 *normals)
{
    const struct skin_ring *own = &skin->rings[ring];
    struct vec3 sum = {0.0, 0.0, 0.0};
    for (int k = own->begin; k < own->end; k++)
        sum = vec3_add(sum, normals[skin->around[k]]);
    return vec3_scale(own->half / vec3_norm(sum), sum);
}

void skin_place(const struct skin *skin, const struct vec3 *nodes, struct vec3 *vertices)
{
    struct vec3 *normals = array_allocate((size_t)skin->n_sheets, sizeof *normals);
    for (int s = 0; s < skin->n_sheets; s++)
        normals[s] = skin_normal(&skin->sheets[s], &nodes->x, 3);
    for (int v = 0; v < skin->n_plain; v++)
        vertices[v] = nodes[skin->nodes[v]];
    for (int r = 0; r < skin->n_rings; r++) {
        const struct vec3 arm = skin_arm(skin, r, normals), at = nodes[skin->rings[r].node];
        vertices[skin_above(skin, r)] = vec3_add(at, arm);
        if (r < skin->n_both)
            vertices[skin_above(skin, r) + 1] = vec3_sub(at, arm);
    }
    free(normals);
}

static int count_facets(const struct solid_mesh *mesh, const int *partners)
{
    int n = 0;
    for (int k = 0; k < SOLID_MESH_SIDES * mesh->n_elements; k++)
        n += partners[k] == SOLID_MESH_OUTSIDE;
    for (int e = 0; e < mesh->n_elements; e++)
        n += solid_mesh_is_sheet(mesh->elements[e]) ? 7 : 0; /* more: two a side, four rims */
    return n;
}

/* ---------------------------------------------------------------------------------- sheets */

struct draft {
    const struct solid_mesh *mesh;
    int n, *elements; /* sheets, by their elements */
    struct vec3 *normals;
    int n_sides;
    struct side *sides; /* those of one edge follow each other */
    int (*partner)[4];  /* of each side: another sheet's into which it goes on, * 4; -1 */
    int *on;            /* the side of a solid that each lies on, or -1 */
    bool *flipped; /* is it seen from below in its part, which goes on from sheet to sheet? */
};

static void list_sides(struct draft *draft)
{
    draft->sides = array_allocate(4 * (size_t)draft->n, sizeof *draft->sides);
    for (int s = 0; s < draft->n; s++) {
        const int *corners = draft->mesh->elements[draft->elements[s]];
        side_add(draft->sides, &draft->n_sides, s, solid_mesh_n_corners(corners), corners);
    }
    side_sort(draft->sides, draft->n_sides);
}

/* Two that are alone at an edge go on into each other if their normals hardly differ. */
static void find_partners(struct draft *draft)
{
    draft->partner = array_allocate((size_t)draft->n, sizeof *draft->partner);
    memset(draft->partner, -1, (size_t)draft->n * sizeof *draft->partner);
    for (int k = 0, end; k < draft->n_sides; k = end) {
        const struct side *p = &draft->sides[k], *q = p + 1;
        end = side_edge_end(draft->sides, k, draft->n_sides);
        if (end - k != 2)
            continue;
        const double cosine = vec3_dot(draft->normals[p->polygon], draft->normals[q->polygon]);
        if ((p->turned != q->turned ? cosine : -cosine) < SKIN_SMOOTH ||
            (draft->on[p->polygon] < 0) != (draft->on[q->polygon] < 0))
            continue;
        draft->partner[p->polygon][p->side] = 4 * q->polygon + q->side;
        draft->partner[q->polygon][q->side] = 4 * p->polygon + p->side;
    }
}

/* Do two sheets go round in the same sense, by sides that are partners? */
static bool agree(const struct draft *draft, int sheet, int side, int partner)
{
    const int *own = draft->mesh->elements[draft->elements[sheet]];
    const int *other = draft->mesh->elements[draft->elements[partner / 4]];
    const int n = solid_mesh_n_corners(other);
    return own[side] == other[(partner % 4 + 1) % n];
}

/* Sheets that go on into each other are all seen from one side, that of the first of them. */
static void find_parts(struct draft *draft)
{
    int *queue = array_allocate((size_t)draft->n, sizeof *queue);
    bool *seen = array_allocate((size_t)draft->n, sizeof *seen);
    draft->flipped = array_allocate((size_t)draft->n, sizeof *draft->flipped);
    for (int first = 0; first < draft->n; first++) {
        int n = 0;
        if (seen[first])
            continue;
        seen[first] = true;
        queue[n++] = first;
        for (int k = 0; k < n; k++)
            for (int side = 0; side < 4; side++) {
                const int partner = draft->partner[queue[k]][side];
                if (partner < 0 || seen[partner / 4])
                    continue;
                seen[partner / 4] = true;
                draft->flipped[partner / 4] =
                    draft->flipped[queue[k]] != !agree(draft, queue[k], side, partner);
                queue[n++] = partner / 4;
            }
    }
    free(queue);
    free(seen);
}

/* Is there no border of a part at a sheet's side?  There is one where a part comes round to
 * itself with its other side. */
static bool goes_on(const struct draft *draft, int sheet, int side)
{
    const int partner = draft->partner[sheet][side];
    return partner >= 0 && (draft->flipped[partner / 4] != draft->flipped[sheet]) ==
                               !agree(draft, sheet, side, partner);
}

static int first_of(int *same, int corner)
{
    while (same[corner] != corner)
        corner = same[corner] = same[same[corner]];
    return corner;
}

/* Corners, counted 4 * sheet + corner of its element, that have a node and a side in common at
 * which their sheets go on. */
static int *join_corners(const struct draft *draft)
{
    int *same = array_allocate(4 * (size_t)draft->n, sizeof *same);
    for (int c = 0; c < 4 * draft->n; c++)
        same[c] = c;
    for (int s = 0; s < draft->n; s++) {
        const int *own = draft->mesh->elements[draft->elements[s]];
        const int n = solid_mesh_n_corners(own);
        for (int side = 0; side < n; side++) {
            if (!goes_on(draft, s, side))
                continue;
            const int sheet = draft->partner[s][side] / 4, begin = draft->partner[s][side] % 4;
            const int *other = draft->mesh->elements[draft->elements[sheet]];
            const int end = (begin + 1) % solid_mesh_n_corners(other);
            const bool straight = other[begin] == own[side];
            for (int k = 0; k < 2; k++) {
                const int a = first_of(same, 4 * s + (side + k) % n);
                const int b = first_of(same, 4 * sheet + ((k == 0) == straight ? begin : end));
                same[a > b ? a : b] = a > b ? b : a;
            }
        }
    }
    return same;
}

/* Rings of the corners of each sheet, in their order. */
static int (*find_rings(struct skin *skin, const struct draft *draft))[4]
{
    int(*rings)[4] = array_allocate((size_t)draft->n, sizeof *rings);
    int *same = join_corners(draft);
    int *ring = array_allocate(4 * (size_t)draft->n, sizeof *ring); /* of the first, from 1 */
    for (int pass = 0; pass < 2 * draft->n; pass++) {               /* those on solids last */
        const int s = pass % draft->n, n = skin->sheets[s].corners[3] < 0 ? 3 : 4;
        if ((draft->on[s] < 0) != (pass < draft->n))
            continue;
        rings[s][3] = -1;
        for (int k = 0; k < n; k++) {
            const int first = first_of(same, 4 * s + (draft->flipped[s] ? n - 1 - k : k));
            if (ring[first] == 0) {
                ARRAY_GROW(skin->rings, skin->n_rings + 1, skin->ring_capacity);
                skin->rings[skin->n_rings] =
                    (struct skin_ring){.node = skin->sheets[s].corners[k]};
                ring[first] = ++skin->n_rings;
            }
            rings[s][k] = ring[first] - 1;
            skin->rings[rings[s][k]].end++;
        }
        skin->n_both = draft->on[s] < 0 ? skin->n_rings : skin->n_both;
    }
    free(same);
    free(ring);
    return rings;
}

/* The sheets around each ring, and half of their mean thickness. */
static void list_around(struct skin *skin, const struct draft *draft, int (*rings)[4])
{
    int n = 0;
    for (int r = 0; r < skin->n_rings; r++) {
        const int count = skin->rings[r].end;
        skin->rings[r].begin = skin->rings[r].end = n;
        n += count;
    }
    skin->around = array_allocate((size_t)n, sizeof *skin->around);
    for (int s = 0; s < draft->n; s++)
        for (int k = 0; k < 4 && rings[s][k] >= 0; k++) {
            struct skin_ring *ring = &skin->rings[rings[s][k]];
            skin->around[ring->end++] = s;
            ring->half += 0.5 * draft->mesh->sheets[draft->elements[s]].thickness;
        }
    for (int r = 0; r < skin->n_rings; r++)
        skin->rings[r].half /= (double)(skin->rings[r].end - skin->rings[r].begin);
}

static void add_facet(struct skin *skin, int a, int b, int c, int d)
{
    const int facet[4] = {a, b, c, d};
    memcpy(skin->facets[skin->n_facets++], facet, sizeof facet);
}

/* Vertices below the sheet's corners: those of a solid's nodes where it lies on one. */
static void find_below(const struct skin *skin, const struct draft *draft, int s, int n,
                       const int rings[4], const int *plain, int below[4])
{
    for (int k = 0; k < n; k++)
        below[k] = draft->on[s] < 0 ? skin_above(skin, rings[k]) + 1
                                    : plain[skin->sheets[s].corners[k]] - 1;
}

/* Side k of what may be seen from below is another of the element itself. */
static int own_side(const struct draft *draft, int s, int n, int k)
{
    return draft->flipped[s] ? (2 * n - 2 - k) % n : k;
}

/* Above, below, and at what is no border of a part. */
static void add_sheet(struct skin *skin, const struct draft *draft, int s, const int rings[4],
                      const int *plain)
{
    const int n = rings[3] >= 0 ? 4 : 3;
    int above[4], below[4];
    for (int k = 0; k < n; k++)
        above[k] = skin_above(skin, rings[k]);
    find_below(skin, draft, s, n, rings, plain, below);
    for (int k = 2; k < n; k++) { /* triangles: cheaper than four about a mean point */
        add_facet(skin, above[0], above[k - 1], above[k], -1);
        if (draft->on[s] < 0)
            add_facet(skin, below[k], below[k - 1], below[0], -1);
    }
    for (int k = 0; k < n; k++) {
        const int next = (k + 1) % n;
        if (!goes_on(draft, s, own_side(draft, s, n, k)))
            add_facet(skin, below[k], below[next], above[next], above[k]);
    }
}

/* Corners as seen from above in the sheet's part: from below they go round the other way. */
static void turn_sheets(struct skin *skin, const struct draft *draft)
{
    for (int s = 0; s < draft->n; s++) {
        const int *corners = draft->mesh->elements[draft->elements[s]];
        const int n = solid_mesh_n_corners(corners);
        skin->sheets[s].corners[3] = -1;
        for (int k = 0; k < n; k++)
            skin->sheets[s].corners[k] = corners[draft->flipped[s] ? n - 1 - k : k];
    }
}

/* Sheets between solids are left out. */
static void draft_init(struct draft *draft, const struct solid_mesh *mesh, const int *covered,
                       const int *partners)
{
    *draft = (struct draft){.mesh = mesh};
    draft->elements = array_allocate((size_t)mesh->n_elements, sizeof *draft->elements);
    draft->on = array_allocate((size_t)mesh->n_elements, sizeof *draft->on);
    for (int e = 0; e < mesh->n_elements; e++) {
        if (!solid_mesh_is_sheet(mesh->elements[e]) ||
            (covered[e] >= 0 && partners[covered[e]] != SOLID_MESH_OUTSIDE))
            continue;
        draft->on[draft->n] = covered[e];
        draft->elements[draft->n++] = e;
    }
    draft->normals = array_allocate((size_t)draft->n, sizeof *draft->normals);
    for (int s = 0; s < draft->n; s++) {
        struct skin_sheet sheet;
        memcpy(sheet.corners, mesh->elements[draft->elements[s]], sizeof sheet.corners);
        draft->normals[s] = skin_normal(&sheet, &mesh->nodes->x, 3);
    }
    list_sides(draft);
    find_partners(draft);
    find_parts(draft);
}

static void draft_clear(struct draft *draft)
{
    free(draft->elements);
    free(draft->on);
    free(draft->normals);
    free(draft->sides);
    free(draft->partner);
    free(draft->flipped);
}

/* The vertex of a solid's node, from 1; what is new ends the list. */
static int add_plain(struct skin *skin, int *plain, int node)
{
    if (plain[node] == 0) {
        skin->nodes[skin->n_plain] = node;
        plain[node] = ++skin->n_plain;
    }
    return plain[node];
}

/* Sides of solids without a sheet on them; and where rims of those come down. */
static void add_solids(struct skin *skin, const struct draft *draft, const int *partners,
                       int *plain)
{
    const struct solid_mesh *mesh = draft->mesh;
    bool *bare = array_allocate(SOLID_MESH_SIDES * (size_t)mesh->n_elements, sizeof *bare);
    for (int k = 0; k < SOLID_MESH_SIDES * mesh->n_elements; k++)
        bare[k] = partners[k] == SOLID_MESH_OUTSIDE &&
                  !solid_mesh_is_sheet(mesh->elements[k / SOLID_MESH_SIDES]);
    for (int s = 0; s < draft->n; s++)
        if (draft->on[s] >= 0)
            bare[draft->on[s]] = false;
    for (int k = 0; k < SOLID_MESH_SIDES * mesh->n_elements; k++) {
        if (!bare[k])
            continue;
        int *facet = skin->facets[skin->n_facets++];
        const int n = solid_mesh_side_nodes(mesh->elements[k / SOLID_MESH_SIDES],
                                            k % SOLID_MESH_SIDES, facet);
        for (int c = 0; c < n; c++)
            facet[c] = add_plain(skin, plain, facet[c]) - 1;
    }
    for (int s = 0; s < draft->n; s++) {
        const int *corners = mesh->elements[draft->elements[s]];
        const int n = solid_mesh_n_corners(corners);
        for (int side = 0; side < n && draft->on[s] >= 0; side++)
            if (!goes_on(draft, s, side)) {
                (void)add_plain(skin, plain, corners[side]);
                (void)add_plain(skin, plain, corners[(side + 1) % n]);
            }
    }
    skin->n_vertices = skin->n_plain;
    free(bare);
}

static void add_sheets(struct skin *skin, const struct draft *draft, const int *plain)
{
    skin->n_sheets = draft->n;
    skin->sheets = array_allocate((size_t)draft->n, sizeof *skin->sheets);
    turn_sheets(skin, draft);
    int(*rings)[4] = find_rings(skin, draft);
    list_around(skin, draft, rings);
    skin->nodes = array_resize(skin->nodes, (size_t)skin->n_plain,
                               (size_t)(skin->n_plain + skin->n_both + skin->n_rings),
                               sizeof *skin->nodes);
    for (int r = 0; r < skin->n_rings; r++)
        for (int k = 0; k < (r < skin->n_both ? 2 : 1); k++)
            skin->nodes[skin->n_vertices++] = skin->rings[r].node;
    for (int s = 0; s < draft->n; s++)
        add_sheet(skin, draft, s, rings[s], plain);
    free(rings);
}

/* ------------------------------------------------------------------------------------ all */

void skin_build(struct skin *skin, const struct solid_mesh *mesh)
{
    struct draft draft;
    int *partners = solid_mesh_partners(mesh), *covered = solid_mesh_covered(mesh);
    int *plain = array_allocate((size_t)mesh->n_nodes, sizeof *plain); /* from 1; 0: none */
    *skin = (struct skin){.n_vertices = 0};
    skin->nodes = array_allocate((size_t)mesh->n_nodes, sizeof *skin->nodes);
    skin->facets = array_allocate((size_t)count_facets(mesh, partners), sizeof *skin->facets);
    draft_init(&draft, mesh, covered, partners);
    add_solids(skin, &draft, partners, plain);
    add_sheets(skin, &draft, plain);
    draft_clear(&draft);
    free(partners);
    free(covered);
    free(plain);
}

void skin_clear(struct skin *skin)
{
    free(skin->nodes);
    free(skin->facets);
    free(skin->rings);
    free(skin->sheets);
    free(skin->around);
    *skin = (struct skin){.n_vertices = 0};
}
