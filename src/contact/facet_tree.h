/*
 * Global search among the features of one body: which lie near a point.
 *
 * The faces are held by a tree of bounding boxes; nodes lie in depth-first order, and each
 * knows where to go on when its box is missed, so a query is one loop without a stack. A few
 * large quads make one leaf, thousands of small triangles a deep tree; either way the cost
 * follows from what is near. The tree's shape comes from the reference mesh, once; when a body
 * has moved only the boxes are made anew. A round surface has few features, which are asked one
 * by one. Drawback: boxes along the axes hold a large sloping
 * facet badly, so leaves test its plane.
 */
#ifndef TREMIE_CONTACT_FACET_TREE_H
#define TREMIE_CONTACT_FACET_TREE_H

#include <stdbool.h>

#include "base/vec3.h"
#include "model/mesh.h"

struct facet_tree_node {
    double low[3], high[3]; /* [m] */
    int skip;               /* node that follows where this one's box is missed */
    int begin, end;         /* a leaf's faces in `order`; begin == end elsewhere */
};

struct facet_tree {
    int n_nodes;
    struct facet_tree_node *nodes;
    int *order;       /* faces, leaf by leaf */
    int *vertex_face; /* the first face at each vertex */
};

/* What a query finds; kept between queries so that it does not allocate. */
struct facet_tree_found {
    int n, capacity;
    int *features;
};

void facet_tree_build(struct facet_tree *tree, const struct mesh *mesh);
void facet_tree_clear(struct facet_tree *tree);
/* Makes the boxes anew from the present place of the mesh. */
void facet_tree_refit(struct facet_tree *tree, const struct mesh *mesh);
/* All features, or all faces, of which any point lies within reach of the centre (and maybe
 * some that are a little farther), ascending, each once. */
void facet_tree_query(const struct facet_tree *tree, const struct mesh *mesh, bool faces_alone,
                      struct vec3 centre, double reach, struct facet_tree_found *found);

#endif
