/*
 * Balls below the surface of a solid, by which its nodes touch other bodies.
 *
 * A ball lies below each vertex of the skin, on the line to a node farther in, and is tangent
 * to the faces around the vertex.  Where no node lies farther in, as at the tip of a
 * tetrahedron, it is the middle of an element.  So bodies touch when their surfaces do, a ball
 * can be pressed in as deep as its radius, and where it is depends linearly on few nodes,
 * which therefore take what it feels.  Edges and corners are round by as much.
 */
#ifndef TREMIE_MODEL_SOLID_BALL_H
#define TREMIE_MODEL_SOLID_BALL_H

struct mesh;
struct solid_mesh;

enum { SOLID_BALL_INNER = 8 };

struct solid_ball {
    int outer;                   /* node at the vertex */
    int n_inner;                 /* 0: there is no room for a ball here */
    int inner[SOLID_BALL_INNER]; /* one node, or those of an element: their mean counts */
    double part;   /* of the inner ones in where the ball is; the outer one has the rest */
    double depth;  /* of these below the faces, or the way to the nearest node if less [m] */
    double radius; /* [m] */
    double area;   /* of the surface that the vertex stands for [m2] */
};

/* At time 0; nodes[v] is the node of vertex v of the skin.  One a vertex; the caller frees
 * them. */
struct solid_ball *solid_balls(const struct solid_mesh *mesh, const struct mesh *skin,
                               const int *nodes);

#endif
