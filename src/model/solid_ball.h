/*
 * Balls below the surface of a solid, by which its nodes touch other bodies.
 *
 * A ball lies below each vertex of the skin, on the line to a node farther in, and is tangent
 * to the faces around the vertex.  So bodies touch when their surfaces do, a ball can be
 * pressed in as deep as its radius, and where it is depends linearly on two nodes, which
 * therefore take what it feels.  Edges and corners are round by as much.
 */
#ifndef TREMIE_MODEL_SOLID_BALL_H
#define TREMIE_MODEL_SOLID_BALL_H

struct mesh;
struct solid_mesh;

struct solid_ball {
    int outer, inner; /* nodes; inner -1: there is no room for a ball here */
    double part;      /* of the inner one in where the ball is; the outer one has the rest */
    double radius;    /* [m] */
    double area;      /* of the surface that the vertex stands for [m2] */
};

/* At time 0; nodes[v] is the node of vertex v of the skin.  One a vertex; the caller frees
 * them. */
struct solid_ball *solid_balls(const struct solid_mesh *mesh, const struct mesh *skin,
                               const int *nodes);

#endif
