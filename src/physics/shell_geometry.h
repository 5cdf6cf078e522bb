/*
 * What quadrilaterals and triangles of shells and membranes see of their nodes' motion, and
 * what they do to nodes in return (THEORY.md, section 13).
 *
 * An element stands in its own frame: the third axis is normal to its middle, the other two
 * turn with it.  From places come the frame and gradients; from the nodes' motion and turning
 * come up to eighteen strains, linear in them; and forces and moments are the same sums read
 * the other way, so that what strains take up is what nodes lose.  A rigid turn gives exactly
 * none of them, warped or not, and forces on an element balance.
 *
 * Written in lanes (physics/lanes.h): kernels have several elements side by side, everything
 * else one.
 */
#ifndef TREMIE_PHYSICS_SHELL_GEOMETRY_H
#define TREMIE_PHYSICS_SHELL_GEOMETRY_H

#include "physics/lanes.h"
#include "physics/solid_gradient.h"

/* Strains of an element: where each kind begins. */
enum {
    SHELL_GEOMETRY_STRETCH = 0, /* xx, yy, 2 xy of the middle surface */
    SHELL_GEOMETRY_BEND = 3,    /* the same of curvature */
    SHELL_GEOMETRY_SHEAR = 6,   /* xz, yz across the thickness */
    SHELL_GEOMETRY_MODES = 8,   /* what these do not see: of a quadrilateral two each in the
                                   plane, of the fibres, of the shear along sides; behind them
                                   how corners turn about the normal beside the element */
    SHELL_GEOMETRY_DRILL = SHELL_GEOMETRY_MODES + 6,          /* of a quadrilateral */
    SHELL_GEOMETRY_TRIANGLE_DRILL = SHELL_GEOMETRY_MODES + 1, /* of a triangle */
    SHELL_GEOMETRY_STRAINS = SHELL_GEOMETRY_DRILL + 4
};

struct shell_geometry {
    lanes axis[3][3]; /* of the frame */
    lanes area;
    lanes by_first[2], by_second[2]; /* a gradient from two differences: over the diagonals of a
                                        quadrilateral, the first sides of a triangle */
    lanes xi[2], eta[2];             /* gradients of the element's own coordinates */
    lanes first[2], second[2];       /* these differences of places */
    lanes skew[2];                   /* x0 - x1 + x2 - x3 */
    lanes warp;                      /* corners are this much above and below the middle */
};

LANES_INLINE void shell_geometry_local(const struct shell_geometry *g, const lanes v[3],
                                       lanes local[3])
{
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        local[i] = solid_gradient_dot(g->axis[i], v);
}

LANES_INLINE void shell_geometry_global(const struct shell_geometry *g, const lanes local[3],
                                        lanes v[3])
{
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        v[i] = (g->axis[0][i] * local[0] + g->axis[1][i] * local[1]) + g->axis[2][i] * local[2];
}

/* The frame of tangents along xi and eta: it turns as they do in the mean. */
LANES_INLINE void shell_geometry_frame(struct shell_geometry *g, const lanes normal[3],
                                       const lanes along_xi[3], const lanes along_eta[3])
{
    const lanes per_normal = lanes_all(1.0) / lanes_sqrt(solid_gradient_dot(normal, normal));
    lanes turned[3], mean[3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        g->axis[2][i] = normal[i] * per_normal;
    solid_gradient_cross(turned, along_eta, g->axis[2]);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        mean[i] = along_xi[i] + turned[i];
    const lanes per_mean = lanes_all(1.0) / lanes_sqrt(solid_gradient_dot(mean, mean));
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        g->axis[0][i] = mean[i] * per_mean;
    solid_gradient_cross(g->axis[1], g->axis[2], g->axis[0]);
}

/* Of the differences a and b in the frame: gradient = by_first (f2 - f0) + by_second (f3 - f1),
 * or (f1 - f0) and (f2 - f0) of a triangle. */
LANES_INLINE void shell_geometry_gradient(struct shell_geometry *g)
{
    const lanes *a = g->first, *b = g->second;
    const lanes per = lanes_all(1.0) / (a[0] * b[1] - a[1] * b[0]);
    g->by_first[0] = b[1] * per;
    g->by_first[1] = -b[0] * per;
    g->by_second[0] = -a[1] * per;
    g->by_second[1] = a[0] * per;
}

/* --------------------------------------------------------------------- quadrilaterals */

/* (13.1), (13.2) */
LANES_INLINE void shell_geometry_quad(lanes x[4][3], struct shell_geometry *g)
{
    lanes first[3], second[3], skew[3], normal[3], along_xi[3], along_eta[3], local[3];
    solid_gradient_difference(first, x[2], x[0]);
    solid_gradient_difference(second, x[3], x[1]);
    solid_gradient_cross(normal, first, second);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        skew[i] = (x[0][i] - x[1][i]) + (x[2][i] - x[3][i]);
        along_xi[i] = first[i] - second[i];
        along_eta[i] = first[i] + second[i];
    }
    shell_geometry_frame(g, normal, along_xi, along_eta);
    g->area = solid_gradient_dot(normal, g->axis[2]) * lanes_all(0.5);
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        g->first[i] = solid_gradient_dot(g->axis[i], first);
        g->second[i] = solid_gradient_dot(g->axis[i], second);
    }
    shell_geometry_gradient(g);
    shell_geometry_local(g, skew, local);
    g->warp = local[2] * lanes_all(0.25);
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        g->skew[i] = local[i];
        g->xi[i] = (g->by_first[i] - g->by_second[i]) * lanes_all(2.0);
        g->eta[i] = (g->by_first[i] + g->by_second[i]) * lanes_all(2.0);
    }
}

/* Three patterns of motion in the frame: differences over the diagonals, and the alternating
 * sum. */
LANES_INLINE void shell_geometry_patterns(const struct shell_geometry *g, lanes moved[4][3],
                                          lanes first[3], lanes second[3], lanes alternating[3])
{
    lanes a[3], b[3], s[3];
    solid_gradient_difference(a, moved[2], moved[0]);
    solid_gradient_difference(b, moved[3], moved[1]);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        s[i] = (moved[0][i] - moved[1][i]) + (moved[2][i] - moved[3][i]);
    shell_geometry_local(g, a, first);
    shell_geometry_local(g, b, second);
    shell_geometry_local(g, s, alternating);
}

LANES_INLINE void shell_geometry_gradients(const struct shell_geometry *g, const lanes first[],
                                           const lanes second[], lanes gradient[2][2])
{
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++)
#pragma GCC unroll 2
        for (int j = 0; j < 2; j++)
            gradient[i][j] = first[i] * g->by_first[j] + second[i] * g->by_second[j];
}

LANES_INLINE void shell_geometry_symmetric(lanes gradient[2][2], lanes strain[3])
{
    strain[0] = gradient[0][0];
    strain[1] = gradient[1][1];
    strain[2] = gradient[0][1] + gradient[1][0];
}

/* How normals at the corners lean, corner 0 by the sum, 1 by the difference, 2 and 3 by their
 * opposites; and the gradient of that.  (13.3) */
struct shell_geometry_lean {
    lanes corner[4][2];
    lanes along_xi[2], along_eta[2];
    lanes gradient[2][2];
};

LANES_INLINE void shell_geometry_leans(const struct shell_geometry *g,
                                       struct shell_geometry_lean *lean)
{
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        const lanes p = g->warp * g->xi[i], r = g->warp * g->eta[i];
        lean->along_xi[i] = p;
        lean->along_eta[i] = r;
        lean->corner[0][i] = p + r;
        lean->corner[1][i] = p - r;
        lean->corner[2][i] = -(p + r);
        lean->corner[3][i] = r - p;
#pragma GCC unroll 2
        for (int j = 0; j < 2; j++)
            lean->gradient[i][j] = -(p * g->eta[j] + r * g->xi[j]);
    }
}

/* Half of each, which sides are sums of: along xi u -+ s, along eta v -+ s. */
struct shell_geometry_sides {
    lanes u[3], v[3], s[3];
};

LANES_INLINE void shell_geometry_halves(const lanes first[3], const lanes second[3],
                                        const lanes alternating[3],
                                        struct shell_geometry_sides *sides)
{
    const lanes half = lanes_all(0.5);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        sides->u[i] = (first[i] - second[i]) * half;
        sides->v[i] = (first[i] + second[i]) * half;
        sides->s[i] = alternating[i] * half;
    }
}

LANES_INLINE void shell_geometry_places(const struct shell_geometry *g,
                                        struct shell_geometry_sides *sides)
{
    const lanes zero = lanes_all(0.0);
    const lanes first[3] = {g->first[0], g->first[1], zero},
                second[3] = {g->second[0], g->second[1], zero},
                alternating[3] = {g->skew[0], g->skew[1], g->warp * lanes_all(4.0)};
    shell_geometry_halves(first, second, alternating, sides);
}

/* The corners and signs of the four sides: 01, 32 along xi, 03, 12 along eta. */
static const int SHELL_GEOMETRY_SIDE[4][2] = {{0, 1}, {3, 2}, {0, 3}, {1, 2}};

/* Shear along a side: what its ends move along the mean normal there, and fibres lean along
 * it.  (13.6) */
LANES_INLINE lanes shell_geometry_side_shear(const struct shell_geometry_sides *moved,
                                             const struct shell_geometry_sides *places,
                                             const struct shell_geometry_lean *lean,
                                             lanes fibre[4][3], int side)
{
    const lanes *one = fibre[SHELL_GEOMETRY_SIDE[side][0]],
                *other = fibre[SHELL_GEOMETRY_SIDE[side][1]];
    lanes d[3], x[3], mean[3], normal[2];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        const lanes dm = side < 2 ? moved->u[i] : moved->v[i],
                    xm = side < 2 ? places->u[i] : places->v[i];
        d[i] = side % 2 == 0 ? dm - moved->s[i] : dm + moved->s[i];
        x[i] = side % 2 == 0 ? xm - places->s[i] : xm + places->s[i];
        mean[i] = (one[i] + other[i]) * lanes_all(0.5);
    }
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        const lanes p = side < 2 ? lean->along_xi[i] : lean->along_eta[i];
        normal[i] = side % 2 == 0 ? p : -p;
    }
    return ((d[0] * normal[0] + d[1] * normal[1]) + d[2]) + solid_gradient_dot(x, mean);
}

/* How the end of the normal at a corner moves.  (13.4) */
LANES_INLINE void shell_geometry_fibre(const lanes turn[3], const lanes lean[2], lanes fibre[3])
{
    fibre[0] = turn[1] - turn[2] * lean[1];
    fibre[1] = turn[2] * lean[0] - turn[0];
    fibre[2] = turn[0] * lean[1] - turn[1] * lean[0];
}

/* The strains of a shell's quadrilateral, from the motion and the turning of its nodes.
 * (13.5) to (13.8) */
LANES_INLINE void shell_geometry_quad_strain(const struct shell_geometry *g, lanes moved[4][3],
                                             lanes turned[4][3],
                                             lanes strain[SHELL_GEOMETRY_STRAINS])
{
    lanes first[3], second[3], alternating[3], fibre[4][3], f_first[2], f_second[2];
    lanes gradient[2][2], bend[2][2], shear[4];
    struct shell_geometry_lean lean;
    struct shell_geometry_sides places, motion;
    shell_geometry_patterns(g, moved, first, second, alternating);
    shell_geometry_leans(g, &lean);
#pragma GCC unroll 4
    for (int c = 0; c < 4; c++) {
        lanes turn[3];
        shell_geometry_local(g, turned[c], turn);
        shell_geometry_fibre(turn, lean.corner[c], fibre[c]);
        strain[SHELL_GEOMETRY_DRILL + c] = turn[2];
    }
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        f_first[i] = fibre[2][i] - fibre[0][i];
        f_second[i] = fibre[3][i] - fibre[1][i];
    }
    shell_geometry_gradients(g, first, second, gradient);
    shell_geometry_gradients(g, f_first, f_second, bend);
    const lanes spin = (gradient[1][0] - gradient[0][1]) * lanes_all(0.5);
#pragma GCC unroll 4
    for (int c = 0; c < 4; c++)
        strain[SHELL_GEOMETRY_DRILL + c] -= spin;
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        const lanes all = (fibre[0][i] + fibre[1][i]) + (fibre[2][i] + fibre[3][i]);
        const lanes f_alternating = (fibre[0][i] - fibre[1][i]) + (fibre[2][i] - fibre[3][i]);
        strain[SHELL_GEOMETRY_MODES + i] =
            (alternating[i] - (gradient[i][0] * g->skew[0] + gradient[i][1] * g->skew[1])) -
            g->warp * all;
#pragma GCC unroll 2
        for (int j = 0; j < 2; j++)
            bend[i][j] -=
                gradient[i][0] * lean.gradient[0][j] + gradient[i][1] * lean.gradient[1][j];
        strain[SHELL_GEOMETRY_MODES + 2 + i] =
            f_alternating - (bend[i][0] * g->skew[0] + bend[i][1] * g->skew[1]);
    }
    shell_geometry_symmetric(gradient, strain + SHELL_GEOMETRY_STRETCH);
    shell_geometry_symmetric(bend, strain + SHELL_GEOMETRY_BEND);
    shell_geometry_halves(first, second, alternating, &motion);
    shell_geometry_places(g, &places);
#pragma GCC unroll 4
    for (int k = 0; k < 4; k++)
        shear[k] = shell_geometry_side_shear(&motion, &places, &lean, fibre, k);
    const lanes quarter = lanes_all(0.25);
    const lanes along_xi = (shear[0] + shear[1]) * quarter,
                along_eta = (shear[2] + shear[3]) * quarter;
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++)
        strain[SHELL_GEOMETRY_SHEAR + i] = g->xi[i] * along_xi + g->eta[i] * along_eta;
    strain[SHELL_GEOMETRY_MODES + 4] = (shear[1] - shear[0]) * quarter;
    strain[SHELL_GEOMETRY_MODES + 5] = (shear[3] - shear[2]) * quarter;
}

/* What the strains' forces f push along patterns of motion.  (13.9) */
struct shell_geometry_push {
    lanes first[3], second[3], alternating[3];
};

/* Corners' forces of what patterns are pushed, in space. */
LANES_INLINE void shell_geometry_quad_forces(const struct shell_geometry *g,
                                             const struct shell_geometry_push *push,
                                             lanes force[4][3])
{
    lanes a[3], b[3], s[3];
    shell_geometry_global(g, push->first, a);
    shell_geometry_global(g, push->second, b);
    shell_geometry_global(g, push->alternating, s);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        force[0][i] = s[i] - a[i];
        force[1][i] = -b[i] - s[i];
        force[2][i] = s[i] + a[i];
        force[3][i] = b[i] - s[i];
    }
}

/* A side's shear force against its ends' motion and fibres: (13.6) the other way. */
LANES_INLINE void shell_geometry_side_push(const struct shell_geometry_sides *places,
                                           const struct shell_geometry_lean *lean, int side,
                                           lanes f, struct shell_geometry_push *push,
                                           lanes fibre[4][3])
{
    const lanes half = lanes_all(0.5), along = f * half;
    lanes *one = fibre[SHELL_GEOMETRY_SIDE[side][0]],
          *other = fibre[SHELL_GEOMETRY_SIDE[side][1]];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        const lanes xm = side < 2 ? places->u[i] : places->v[i];
        const lanes x = side % 2 == 0 ? xm - places->s[i] : xm + places->s[i];
        const lanes p = i == 2     ? lanes_all(1.0)
                        : side < 2 ? lean->along_xi[i]
                                   : lean->along_eta[i];
        const lanes normal = i < 2 && side % 2 == 1 ? -p : p;
        const lanes d = along * normal;
        one[i] += along * x;
        other[i] += along * x;
        push->first[i] += d;
        push->second[i] += side < 2 ? -d : d;
        push->alternating[i] += side % 2 == 0 ? -d : d;
    }
}

/* Forces and moments on the corners that do with any motion the work that f does with its
 * strains: f = area times stress resultants, then the modes' forces.  (13.9) */
LANES_INLINE void shell_geometry_quad_resist(const struct shell_geometry *g,
                                             const lanes f[SHELL_GEOMETRY_STRAINS],
                                             lanes force[4][3], lanes moment[4][3])
{
    const lanes *n = f + SHELL_GEOMETRY_STRETCH, *m = f + SHELL_GEOMETRY_BEND,
                *q = f + SHELL_GEOMETRY_MODES, *d = f + SHELL_GEOMETRY_DRILL;
    const lanes zero = lanes_all(0.0), quarter = lanes_all(0.25);
    const lanes drill = ((d[0] + d[1]) + (d[2] + d[3])) * lanes_all(0.5);
    const lanes stretch[2][2] = {{n[0], n[2] + drill}, {n[2] - drill, n[1]}},
                bend[2][2] = {{m[0], m[2]}, {m[2], m[1]}};
    struct shell_geometry_lean lean;
    struct shell_geometry_sides places;
    struct shell_geometry_push push;
    lanes fibre[4][3];
    shell_geometry_leans(g, &lean);
    shell_geometry_places(g, &places);
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        lanes by_motion[2], by_fibre[2];
#pragma GCC unroll 2
        for (int j = 0; j < 2; j++)
            by_fibre[j] = bend[i][j] - q[2 + i] * g->skew[j];
#pragma GCC unroll 2
        for (int j = 0; j < 2; j++)
            by_motion[j] = (stretch[i][j] - (by_fibre[0] * lean.gradient[j][0] +
                                             by_fibre[1] * lean.gradient[j][1])) -
                           q[i] * g->skew[j];
        push.first[i] = g->by_first[0] * by_motion[0] + g->by_first[1] * by_motion[1];
        push.second[i] = g->by_second[0] * by_motion[0] + g->by_second[1] * by_motion[1];
        push.alternating[i] = q[i];
        const lanes a = g->by_first[0] * by_fibre[0] + g->by_first[1] * by_fibre[1],
                    b = g->by_second[0] * by_fibre[0] + g->by_second[1] * by_fibre[1];
        const lanes all = g->warp * q[i];
        fibre[0][i] = (q[2 + i] - a) - all;
        fibre[1][i] = (-q[2 + i] - b) - all;
        fibre[2][i] = (q[2 + i] + a) - all;
        fibre[3][i] = (b - q[2 + i]) - all;
    }
    push.first[2] = push.second[2] = push.alternating[2] = zero;
#pragma GCC unroll 4
    for (int c = 0; c < 4; c++)
        fibre[c][2] = zero;
    const lanes *t = f + SHELL_GEOMETRY_SHEAR;
    const lanes along_xi = g->xi[0] * t[0] + g->xi[1] * t[1],
                along_eta = g->eta[0] * t[0] + g->eta[1] * t[1];
    const lanes side[4] = {(along_xi - q[4]) * quarter, (along_xi + q[4]) * quarter,
                           (along_eta - q[5]) * quarter, (along_eta + q[5]) * quarter};
#pragma GCC unroll 4
    for (int k = 0; k < 4; k++)
        shell_geometry_side_push(&places, &lean, k, side[k], &push, fibre);
    shell_geometry_quad_forces(g, &push, force);
#pragma GCC unroll 4
    for (int c = 0; c < 4; c++) {
        const lanes normal[3] = {lean.corner[c][0], lean.corner[c][1], lanes_all(1.0)};
        lanes local[3];
        solid_gradient_cross(local, normal, fibre[c]);
        local[2] += d[c];
        shell_geometry_global(g, local, moment[c]);
    }
}

/* The same of a membrane's, whose fibres stay normal to its middle: stretch, the modes in the
 * plane, and in the place of the next one the change of the warp.  (13.10) */
LANES_INLINE void shell_geometry_quad_stretch(const struct shell_geometry *g, lanes moved[4][3],
                                              lanes strain[SHELL_GEOMETRY_STRAINS])
{
    lanes first[3], second[3], alternating[3], gradient[2][2], slope[2];
    shell_geometry_patterns(g, moved, first, second, alternating);
    shell_geometry_gradients(g, first, second, gradient);
    shell_geometry_symmetric(gradient, strain + SHELL_GEOMETRY_STRETCH);
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        slope[i] = first[2] * g->by_first[i] + second[2] * g->by_second[i];
        strain[SHELL_GEOMETRY_MODES + i] =
            (alternating[i] - (gradient[i][0] * g->skew[0] + gradient[i][1] * g->skew[1])) +
            lanes_all(4.0) * g->warp * slope[i];
    }
    strain[SHELL_GEOMETRY_MODES + 2] =
        alternating[2] - (slope[0] * g->skew[0] + slope[1] * g->skew[1]);
}

LANES_INLINE void shell_geometry_quad_pull(const struct shell_geometry *g,
                                           const lanes f[SHELL_GEOMETRY_STRAINS],
                                           lanes force[4][3])
{
    const lanes *n = f + SHELL_GEOMETRY_STRETCH, *q = f + SHELL_GEOMETRY_MODES;
    const lanes stretch[2][2] = {{n[0], n[2]}, {n[2], n[1]}};
    struct shell_geometry_push push;
    lanes by_slope[2];
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        const lanes x = stretch[i][0] - q[i] * g->skew[0],
                    y = stretch[i][1] - q[i] * g->skew[1];
        push.first[i] = g->by_first[0] * x + g->by_first[1] * y;
        push.second[i] = g->by_second[0] * x + g->by_second[1] * y;
        push.alternating[i] = q[i];
        by_slope[i] = lanes_all(4.0) * g->warp * q[i] - q[2] * g->skew[i];
    }
    push.first[2] = g->by_first[0] * by_slope[0] + g->by_first[1] * by_slope[1];
    push.second[2] = g->by_second[0] * by_slope[0] + g->by_second[1] * by_slope[1];
    push.alternating[2] = q[2];
    shell_geometry_quad_forces(g, &push, force);
}

/* ------------------------------------------------------------------------- triangles */

LANES_INLINE void shell_geometry_triangle(lanes x[3][3], struct shell_geometry *g)
{
    lanes first[3], second[3], normal[3];
    solid_gradient_difference(first, x[1], x[0]);
    solid_gradient_difference(second, x[2], x[0]);
    solid_gradient_cross(normal, first, second);
    shell_geometry_frame(g, normal, first, second);
    g->area = solid_gradient_dot(normal, g->axis[2]) * lanes_all(0.5);
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        g->first[i] = solid_gradient_dot(g->axis[i], first);
        g->second[i] = solid_gradient_dot(g->axis[i], second);
        g->skew[i] = lanes_all(0.0);
    }
    g->warp = lanes_all(0.0);
    shell_geometry_gradient(g);
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        g->xi[i] = g->by_first[i];
        g->eta[i] = g->by_second[i];
    }
}

/* Motion of the first two sides, in the frame. */
LANES_INLINE void shell_geometry_triangle_motion(const struct shell_geometry *g,
                                                 lanes moved[3][3], lanes first[3],
                                                 lanes second[3])
{
    lanes a[3], b[3];
    solid_gradient_difference(a, moved[1], moved[0]);
    solid_gradient_difference(b, moved[2], moved[0]);
    shell_geometry_local(g, a, first);
    shell_geometry_local(g, b, second);
}

LANES_INLINE void shell_geometry_triangle_stretch(const struct shell_geometry *g,
                                                  lanes moved[3][3],
                                                  lanes strain[SHELL_GEOMETRY_STRAINS])
{
    lanes first[3], second[3], gradient[2][2];
    shell_geometry_triangle_motion(g, moved, first, second);
    shell_geometry_gradients(g, first, second, gradient);
    shell_geometry_symmetric(gradient, strain + SHELL_GEOMETRY_STRETCH);
}

/* The strains of a shell's triangle: one mode, the shear that goes round its sides.  (13.11) */
LANES_INLINE void shell_geometry_triangle_strain(const struct shell_geometry *g,
                                                 lanes moved[3][3], lanes turned[3][3],
                                                 lanes strain[SHELL_GEOMETRY_STRAINS])
{
    lanes first[3], second[3], gradient[2][2];
    lanes t[3][3], fibre[3][2], f_first[2], f_second[2], bend[2][2];
    const lanes half = lanes_all(0.5), third = lanes_all(1.0 / 3.0);
    shell_geometry_triangle_motion(g, moved, first, second);
    shell_geometry_gradients(g, first, second, gradient);
    shell_geometry_symmetric(gradient, strain + SHELL_GEOMETRY_STRETCH);
    const lanes spin = (gradient[1][0] - gradient[0][1]) * half;
#pragma GCC unroll 3
    for (int c = 0; c < 3; c++) {
        shell_geometry_local(g, turned[c], t[c]);
        fibre[c][0] = t[c][1];
        fibre[c][1] = -t[c][0];
        strain[SHELL_GEOMETRY_TRIANGLE_DRILL + c] = t[c][2] - spin;
    }
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        f_first[i] = fibre[1][i] - fibre[0][i];
        f_second[i] = fibre[2][i] - fibre[0][i];
    }
    shell_geometry_gradients(g, f_first, f_second, bend);
    shell_geometry_symmetric(bend, strain + SHELL_GEOMETRY_BEND);
    lanes s01 = first[2], s02 = second[2], s12 = second[2] - first[2];
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        s01 += g->first[i] * (fibre[0][i] + fibre[1][i]) * half;
        s02 += g->second[i] * (fibre[0][i] + fibre[2][i]) * half;
        s12 += (g->second[i] - g->first[i]) * (fibre[1][i] + fibre[2][i]) * half;
    }
    const lanes round = (s02 - s01) - s12;
    const lanes along_xi = s01 + round * third, along_eta = s02 - round * third;
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++)
        strain[SHELL_GEOMETRY_SHEAR + i] = g->xi[i] * along_xi + g->eta[i] * along_eta;
    strain[SHELL_GEOMETRY_MODES] = round;
}

/* Forces of what acts in the frame along the two differences, in space. */
LANES_INLINE void shell_geometry_triangle_forces(const struct shell_geometry *g,
                                                 const lanes first[3], const lanes second[3],
                                                 lanes force[3][3])
{
    shell_geometry_global(g, first, force[1]);
    shell_geometry_global(g, second, force[2]);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        force[0][i] = -(force[1][i] + force[2][i]);
}

LANES_INLINE void shell_geometry_triangle_pull(const struct shell_geometry *g,
                                               const lanes f[SHELL_GEOMETRY_STRAINS],
                                               lanes force[3][3])
{
    const lanes *n = f + SHELL_GEOMETRY_STRETCH;
    const lanes stretch[2][2] = {{n[0], n[2]}, {n[2], n[1]}};
    lanes first[3], second[3];
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        first[i] = g->by_first[0] * stretch[i][0] + g->by_first[1] * stretch[i][1];
        second[i] = g->by_second[0] * stretch[i][0] + g->by_second[1] * stretch[i][1];
    }
    first[2] = second[2] = lanes_all(0.0);
    shell_geometry_triangle_forces(g, first, second, force);
}

LANES_INLINE void shell_geometry_triangle_resist(const struct shell_geometry *g,
                                                 const lanes f[SHELL_GEOMETRY_STRAINS],
                                                 lanes force[3][3], lanes moment[3][3])
{
    const lanes *n = f + SHELL_GEOMETRY_STRETCH, *m = f + SHELL_GEOMETRY_BEND,
                *t = f + SHELL_GEOMETRY_SHEAR, *d = f + SHELL_GEOMETRY_TRIANGLE_DRILL;
    const lanes half = lanes_all(0.5), third = lanes_all(1.0 / 3.0);
    const lanes drill = ((d[0] + d[1]) + d[2]) * half;
    const lanes stretch[2][2] = {{n[0], n[2] + drill}, {n[2] - drill, n[1]}},
                bend[2][2] = {{m[0], m[2]}, {m[2], m[1]}};
    const lanes along_xi = g->xi[0] * t[0] + g->xi[1] * t[1],
                along_eta = g->eta[0] * t[0] + g->eta[1] * t[1];
    const lanes round = f[SHELL_GEOMETRY_MODES] + (along_xi - along_eta) * third;
    const lanes f01 = along_xi - round, f02 = along_eta + round, f12 = -round;
    lanes first[3], second[3], fibre[3][2];
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        first[i] = g->by_first[0] * stretch[i][0] + g->by_first[1] * stretch[i][1];
        second[i] = g->by_second[0] * stretch[i][0] + g->by_second[1] * stretch[i][1];
        const lanes a = g->by_first[0] * bend[i][0] + g->by_first[1] * bend[i][1],
                    b = g->by_second[0] * bend[i][0] + g->by_second[1] * bend[i][1];
        const lanes s01 = f01 * g->first[i] * half, s02 = f02 * g->second[i] * half,
                    s12 = f12 * (g->second[i] - g->first[i]) * half;
        fibre[0][i] = (s01 + s02) - (a + b);
        fibre[1][i] = (s01 + s12) + a;
        fibre[2][i] = (s02 + s12) + b;
    }
    first[2] = f01 - f12;
    second[2] = f02 + f12;
    shell_geometry_triangle_forces(g, first, second, force);
#pragma GCC unroll 3
    for (int c = 0; c < 3; c++) {
        const lanes local[3] = {-fibre[c][1], fibre[c][0], d[c]};
        shell_geometry_global(g, local, moment[c]);
    }
}

#endif
