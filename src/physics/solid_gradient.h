/*
 * Volume of a hexahedron and of a tetrahedron, and its gradient with respect to the corners:
 * the mean gradient operator of one-point elements (THEORY.md, section 12).
 *
 * The exact volume of the hexahedron with bilinear faces is three triple products of
 * differences of corners (Grandy, Efficient computation of volume of hexahedral cells,
 * UCRL-ID-128886, 1997); each of their nine factors has a cross product for a derivative, and
 * corners gather those.  That is a third of the work of the usual formula corner by corner.
 * Only differences of places enter.
 *
 * Written in lanes (physics/lanes.h): kernels have several elements side by side, everything
 * else one.
 */
#ifndef TREMIE_PHYSICS_SOLID_GRADIENT_H
#define TREMIE_PHYSICS_SOLID_GRADIENT_H

#include "physics/lanes.h"

LANES_INLINE void solid_gradient_difference(lanes d[3], const lanes a[3], const lanes b[3])
{
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        d[i] = a[i] - b[i];
}

LANES_INLINE void solid_gradient_cross(lanes c[3], const lanes a[3], const lanes b[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

LANES_INLINE lanes solid_gradient_dot(const lanes a[3], const lanes b[3])
{
    return (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
}

/* a = (x_p - x_q) + (x_r - x_s), b = x_t - x_u, c = x_v - x_w: the triple product a . b x c,
 * and its derivatives with respect to a, b, c. */
LANES_INLINE lanes solid_gradient_triple(lanes x[8][3], const int corner[8], lanes by_a[3],
                                         lanes by_b[3], lanes by_c[3])
{
    lanes a[3], b[3], c[3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
        a[i] = (x[corner[0]][i] - x[corner[1]][i]) + (x[corner[2]][i] - x[corner[3]][i]);
    solid_gradient_difference(b, x[corner[4]], x[corner[5]]);
    solid_gradient_difference(c, x[corner[6]], x[corner[7]]);
    solid_gradient_cross(by_a, b, c);
    solid_gradient_cross(by_b, c, a);
    solid_gradient_cross(by_c, a, b);
    return solid_gradient_dot(a, by_a);
}

/* Of the hexahedron with these corners, the first four about one face, the others above them:
 * returns the volume [m3], b is its gradient [m2].  (12.2) */
LANES_INLINE lanes solid_gradient_hexahedron(lanes x[8][3], lanes b[8][3])
{
    static const int first[8] = {3, 1, 7, 2, 6, 3, 2, 0}, second[8] = {4, 3, 5, 7, 6, 4, 7, 0},
                     third[8] = {1, 4, 2, 5, 6, 1, 5, 0};
    lanes a1[3], b1[3], c1[3], a2[3], b2[3], c2[3], a3[3], b3[3], c3[3];
    const lanes t1 = solid_gradient_triple(x, first, a1, b1, c1),
                t2 = solid_gradient_triple(x, second, a2, b2, c2),
                t3 = solid_gradient_triple(x, third, a3, b3, c3);
    const lanes twelfth = lanes_all(1.0 / 12.0);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        const lanes p = (a3[i] - a1[i]) * twelfth, q = (a1[i] - a2[i]) * twelfth,
                    r = (a2[i] - a3[i]) * twelfth;
        const lanes u = b1[i] * twelfth, v = b2[i] * twelfth, w = b3[i] * twelfth;
        const lanes f = c1[i] * twelfth, g = c2[i] * twelfth, h = c3[i] * twelfth;
        b[0][i] = -(f + g) - h;
        b[1][i] = p - w;
        b[2][i] = p + f;
        b[3][i] = q - u;
        b[4][i] = r - v;
        b[5][i] = r + h;
        b[6][i] = (u + v) + w;
        b[7][i] = q + g;
    }
    return ((t1 + t2) + t3) * twelfth;
}

/* The same of the tetrahedron: corner 3 is on the side of the first three from which they go
 * round against the clock. */
LANES_INLINE lanes solid_gradient_tetrahedron(lanes x[4][3], lanes b[4][3])
{
    lanes d1[3], d2[3], d3[3];
    const lanes sixth = lanes_all(1.0 / 6.0);
    solid_gradient_difference(d1, x[1], x[0]);
    solid_gradient_difference(d2, x[2], x[0]);
    solid_gradient_difference(d3, x[3], x[0]);
    solid_gradient_cross(b[1], d2, d3);
    solid_gradient_cross(b[2], d3, d1);
    solid_gradient_cross(b[3], d1, d2);
    const lanes volume = solid_gradient_dot(d1, b[1]) * sixth;
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
#pragma GCC unroll 3
        for (int c = 1; c < 4; c++)
            b[c][i] = b[c][i] * sixth;
        b[0][i] = -(b[1][i] + b[2][i]) - b[3][i];
    }
    return volume;
}

/* The four hourglass patterns of eight numbers at corners: sums with the signs of eta zeta,
 * xi zeta, xi eta, xi eta zeta.  (12.6) */
LANES_INLINE void solid_gradient_patterns(const lanes f[8], lanes pattern[4])
{
    const lanes s01 = f[0] + f[1], d01 = f[0] - f[1], s23 = f[2] + f[3], d23 = f[2] - f[3];
    const lanes s45 = f[4] + f[5], d45 = f[4] - f[5], s67 = f[6] + f[7], d67 = f[6] - f[7];
    pattern[0] = (s01 - s23) - (s45 - s67);
    pattern[1] = (d01 - d23) - (d45 - d67);
    pattern[2] = (d01 + d23) + (d45 + d67);
    pattern[3] = (d45 + d67) - (d01 + d23);
}

/* The reverse: what the four give at each corner. */
LANES_INLINE void solid_gradient_spread(const lanes pattern[4], lanes f[8])
{
    const lanes a = pattern[0] + pattern[1], b = pattern[0] - pattern[1];
    const lanes c = pattern[2] + pattern[3], d = pattern[2] - pattern[3];
    f[0] = a + d;
    f[1] = b - d;
    f[2] = d - a;
    f[3] = -b - d;
    f[4] = c - a;
    f[5] = -b - c;
    f[6] = a + c;
    f[7] = b - c;
}

#endif
