/*
 * Subdomains: axis-aligned boxes, one a rank, that tile space; a binary tree of cuts tells
 * whose a point is.  Boxes are half open (low <= x < high), so a plane of spheres on a cut has
 * one owner; outer boxes reach to infinity.  Every rank holds the whole tree: O(number of
 * ranks), no more.
 */
#ifndef TREMIE_DOMAIN_BOXES_H
#define TREMIE_DOMAIN_BOXES_H

#include "base/vec3.h"

struct boxes_node {
    int axis;
    double cut;   /* x[axis] < cut goes to child 0 [m] */
    int child[2]; /* >= 0: a node; < 0: the rank is -1 - child */
};

struct boxes {
    int n_ranks, n_nodes; /* n_ranks - 1 nodes; node 0 is the root */
    struct boxes_node *nodes;
    double (*low)[3], (*high)[3]; /* of each rank's box [m] */
};

/* All of space to rank 0 (n_ranks = 1), or room for n_ranks - 1 nodes to be filled. */
void boxes_init(struct boxes *boxes, int n_ranks);
void boxes_clear(struct boxes *boxes);
/* An even grid of n[0] x n[1] x n[2] = n_ranks boxes over [low, high]. */
void boxes_set_grid(struct boxes *boxes, const int n[3], struct vec3 low, struct vec3 high);
/* Derives low and high from the nodes. */
void boxes_update(struct boxes *boxes);
int boxes_owner(const struct boxes *boxes, const double x[3]);

#endif
