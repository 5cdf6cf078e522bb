/* A tree of bounding boxes over the faces of a mesh: see facet_tree.h. */
#include "contact/facet_tree.h"

#include <stdbool.h>
#include <stdlib.h>

#include "base/array.h"
#include "physics/contact_geometry.h"

enum { LEAF_FACES = 4 };

/* An edge or vertex must not be missed because rounding puts its face a hair farther than
 * itself. */
static const double MARGIN = 1.0 + 1e-6;

struct split { /* a face on its way to its place in the tree */
    double key;
    int face;
};

static int compare_splits(const void *a, const void *b)
{
    const struct split *p = a, *q = b;
    if (p->key != q->key)
        return p->key < q->key ? -1 : 1;
    return p->face - q->face;
}

static double along_axis(struct vec3 v, int axis)
{
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/* Sum of a face's vertices over their number, along an axis. */
static double face_middle(const struct mesh *mesh, int f, int axis)
{
    double sum = 0.0;
    for (int k = 0; k < mesh->faces[f].n; k++)
        sum += along_axis(mesh->reference[mesh->faces[f].vertices[k]], axis);
    return sum / (double)mesh->faces[f].n;
}

/* Sorts faces [begin, end) of the order by their middles along the axis where these spread
 * most. */
static void sort_faces(struct facet_tree *tree, const struct mesh *mesh, int begin, int end,
                       struct split *splits)
{
    int widest = 0;
    double spread_most = -1.0;
    for (int axis = 0; axis < 3; axis++) {
        double low = face_middle(mesh, tree->order[begin], axis), high = low;
        for (int k = begin; k < end; k++) {
            const double middle = face_middle(mesh, tree->order[k], axis);
            low = middle < low ? middle : low;
            high = middle > high ? middle : high;
        }
        if (high - low > spread_most) {
            spread_most = high - low;
            widest = axis;
        }
    }
    for (int k = begin; k < end; k++)
        splits[k] = (struct split){face_middle(mesh, tree->order[k], widest), tree->order[k]};
    qsort(splits + begin, (size_t)(end - begin), sizeof *splits, compare_splits);
    for (int k = begin; k < end; k++)
        tree->order[k] = splits[k].face;
}

static void add_nodes(struct facet_tree *tree, const struct mesh *mesh, int begin, int end,
                      struct split *splits)
{
    struct facet_tree_node *node = &tree->nodes[tree->n_nodes++];
    if (end - begin <= LEAF_FACES) {
        node->begin = begin;
        node->end = end;
    } else {
        const int middle = begin + (end - begin) / 2;
        sort_faces(tree, mesh, begin, end, splits);
        add_nodes(tree, mesh, begin, middle, splits);
        add_nodes(tree, mesh, middle, end, splits);
    }
    node->skip = tree->n_nodes;
}

void facet_tree_build(struct facet_tree *tree, const struct mesh *mesh)
{
    const size_t n = (size_t)mesh->n_faces;
    tree->nodes = array_allocate(2 * n + 1, sizeof *tree->nodes);
    tree->order = array_allocate(n, sizeof *tree->order);
    tree->vertex_face = array_allocate((size_t)mesh->n_vertices, sizeof *tree->vertex_face);
    tree->n_nodes = 0;
    for (int f = mesh->n_faces - 1; f >= 0; f--) {
        tree->order[f] = f;
        for (int k = 0; k < mesh->faces[f].n; k++)
            tree->vertex_face[mesh->faces[f].vertices[k]] = f;
    }
    struct split *splits = array_allocate(n, sizeof *splits);
    add_nodes(tree, mesh, 0, mesh->n_faces, splits);
    free(splits);
    facet_tree_refit(tree, mesh);
}

void facet_tree_clear(struct facet_tree *tree)
{
    free(tree->nodes);
    free(tree->order);
    free(tree->vertex_face);
    *tree = (struct facet_tree){0};
}

static void widen(struct facet_tree_node *node, const double low[3], const double high[3])
{
    for (int axis = 0; axis < 3; axis++) {
        node->low[axis] = low[axis] < node->low[axis] ? low[axis] : node->low[axis];
        node->high[axis] = high[axis] > node->high[axis] ? high[axis] : node->high[axis];
    }
}

static void widen_by_face(struct facet_tree_node *node, const struct mesh *mesh, int f)
{
    for (int k = 0; k < mesh->faces[f].n; k++) {
        const struct vec3 v = mesh->place[mesh->faces[f].vertices[k]];
        const double point[3] = {v.x, v.y, v.z};
        widen(node, point, point);
    }
}

void facet_tree_refit(struct facet_tree *tree, const struct mesh *mesh)
{
    for (int i = tree->n_nodes - 1; i >= 0; i--) {
        struct facet_tree_node *node = &tree->nodes[i];
        for (int axis = 0; axis < 3; axis++) {
            node->low[axis] = (double)INFINITY;
            node->high[axis] = -(double)INFINITY;
        }
        for (int k = node->begin; k < node->end; k++)
            widen_by_face(node, mesh, tree->order[k]);
        for (int child = i + 1; child < node->skip; child = tree->nodes[child].skip)
            widen(node, tree->nodes[child].low, tree->nodes[child].high);
    }
}

/* Do two boxes meet?  All six are asked, for which answers no is hard to foresee. */
static inline bool boxes_meet(const struct facet_tree_node *node, const double low[3],
                              const double high[3])
{
    return (node->low[0] <= high[0]) & (node->high[0] >= low[0]) & (node->low[1] <= high[1]) &
           (node->high[1] >= low[1]) & (node->low[2] <= high[2]) & (node->high[2] >= low[2]);
}

static void add_feature(struct facet_tree_found *found, int feature)
{
    ARRAY_GROW(found->features, found->n + 1, found->capacity);
    found->features[found->n++] = feature;
}

static void add_if_near(const struct mesh *mesh, int feature, struct vec3 centre, double reach,
                        struct facet_tree_found *found)
{
    if (contact_geometry_reaches(mesh, feature, centre, reach))
        add_feature(found, feature);
}

/* What is near of a face's border, each edge and vertex with its first face. */
static void add_border(const struct facet_tree *tree, const struct mesh *mesh, int f,
                       struct vec3 centre, double reach, struct facet_tree_found *found)
{
    const struct mesh_face *face = &mesh->faces[f];
    for (int k = 0; k < face->n; k++) {
        if (!contact_geometry_reaches_side(mesh, f, k, centre, reach))
            continue;
        const int edge = face->edges[k], vertex = face->vertices[k];
        if (mesh->edges[edge].faces[0] == f)
            add_if_near(mesh, mesh->n_faces + edge, centre, reach, found);
        if (tree->vertex_face[vertex] == f)
            add_if_near(mesh, mesh->n_faces + mesh->n_edges + vertex, centre, reach, found);
    }
}

static void sort_features(struct facet_tree_found *found)
{
    for (int k = 1; k < found->n; k++) {
        const int feature = found->features[k];
        int place = k;
        for (; place > 0 && found->features[place - 1] > feature; place--)
            found->features[place] = found->features[place - 1];
        found->features[place] = feature;
    }
}

/* A leaf's faces that are near, with their borders. */
static void add_leaf(const struct facet_tree *tree, const struct facet_tree_node *node,
                     const struct mesh *mesh, bool faces_alone, struct vec3 centre,
                     double reach, struct facet_tree_found *found)
{
    for (int k = node->begin; k < node->end; k++) {
        const int f = tree->order[k];
        if (!contact_geometry_reaches(mesh, f, centre, reach * MARGIN))
            continue;
        add_feature(found, f);
        if (!faces_alone)
            add_border(tree, mesh, f, centre, reach, found);
    }
}

void facet_tree_query(const struct facet_tree *tree, const struct mesh *mesh, bool faces_alone,
                      struct vec3 centre, double reach, struct facet_tree_found *found)
{
    const double wide = reach * MARGIN, widest = wide * MARGIN;
    const double low[3] = {centre.x - widest, centre.y - widest, centre.z - widest};
    const double high[3] = {centre.x + widest, centre.y + widest, centre.z + widest};
    found->n = 0;
    for (int i = 0; i < tree->n_nodes;) {
        const struct facet_tree_node *node = &tree->nodes[i];
        if (!boxes_meet(node, low, high)) {
            i = node->skip;
            continue;
        }
        add_leaf(tree, node, mesh, faces_alone, centre, wide, found);
        i++;
    }
    const int n = mesh_n_features(mesh);
    for (int round = n - mesh->n_bands - mesh->n_rings; round < n; round++)
        add_if_near(mesh, round, centre, wide, found);
    sort_features(found);
}
