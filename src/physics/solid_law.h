/*
 * What stress does while an element moves: it turns along (Hughes and Winget, Int. J. Numer.
 * Meth. Eng. 15, 1980, 1862), and changes by the elastic law and plastic flow with isotropic
 * hardening (radial return).  THEORY.md, (12.5), (12.7), (12.8).
 *
 * Written in lanes (physics/lanes.h).
 */
#ifndef TREMIE_PHYSICS_SOLID_LAW_H
#define TREMIE_PHYSICS_SOLID_LAW_H

#include "physics/lanes.h"
#include "physics/solid_element.h"

/* The rotation of a step from the gradient of its motion at the middle.  (12.5) */
LANES_INLINE void solid_law_turn(lanes gradient[3][3], lanes turn[3][3])
{
    const lanes quarter = lanes_all(0.25), one = lanes_all(1.0);
    const lanes a[3] = {(gradient[2][1] - gradient[1][2]) * quarter,
                        (gradient[0][2] - gradient[2][0]) * quarter,
                        (gradient[1][0] - gradient[0][1]) * quarter};
    const lanes square = (a[0] * a[0] + a[1] * a[1]) + a[2] * a[2];
    const lanes scale = lanes_all(2.0) / (one + square);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        turn[i][i] = one - scale * (a[j] * a[j] + a[k] * a[k]);
        turn[i][j] = scale * (a[i] * a[j] - a[k]);
        turn[j][i] = scale * (a[i] * a[j] + a[k]);
    }
}

/* T s T^t of a symmetric matrix xx yy zz xy yz zx. */
LANES_INLINE void solid_law_turned(lanes turn[3][3], lanes s[6])
{
    const lanes full[3][3] = {{s[0], s[3], s[5]}, {s[3], s[1], s[4]}, {s[5], s[4], s[2]}};
    lanes half[3][3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++)
#pragma GCC unroll 3
        for (int j = 0; j < 3; j++)
            half[i][j] =
                (turn[i][0] * full[0][j] + turn[i][1] * full[1][j]) + turn[i][2] * full[2][j];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        s[i] = (half[i][0] * turn[i][0] + half[i][1] * turn[i][1]) + half[i][2] * turn[i][2];
        s[3 + i] =
            (half[i][0] * turn[j][0] + half[i][1] * turn[j][1]) + half[i][2] * turn[j][2];
    }
}

/* a : b of symmetric matrices. */
LANES_INLINE lanes solid_law_product(const lanes a[6], const lanes b[6])
{
    const lanes across = (a[3] * b[3] + a[4] * b[4]) + a[5] * b[5];
    return ((a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]) + (across + across);
}

/* Plastic strain beyond p that brings the equivalent stress q of the elastic trial back to the
 * yield curve: 0 where it does not reach it.  The curve is met in the last of its pieces at
 * whose beginning the trial is still above it.  (12.8) */
LANES_INLINE lanes solid_law_flow(const struct solid_element_material *m, lanes p, lanes q)
{
    const lanes start = q + p * lanes_all(3.0 * m->mu);
    lanes end = p;
    for (int k = 0; k < m->n_yield; k++) {
        const struct solid_element_yield *piece = &m->yield[k];
        const lanes above = start - lanes_all(3.0 * m->mu * piece->strain + piece->stress);
        const lanes met = lanes_all(piece->strain) + above * lanes_all(piece->inverse);
        end = k == 0 ? met : lanes_where(above >= lanes_all(0.0), met, end);
    }
    const lanes flow = end - p;
    return lanes_where(flow > lanes_all(0.0), flow, lanes_all(0.0));
}

/* Brings stress, trial of the elastic law, back to the yield surface and counts the flow.
 * (12.8) */
LANES_INLINE void solid_law_return(const struct solid_element_material *m, lanes volume,
                                   const lanes old[6], lanes own[8])
{
    const lanes mean = ((own[0] + own[1]) + own[2]) * lanes_all(1.0 / 3.0);
    const lanes deviator[6] = {own[0] - mean, own[1] - mean, own[2] - mean,
                               own[3],        own[4],        own[5]};
    const lanes q = lanes_sqrt(solid_law_product(deviator, deviator) * lanes_all(1.5));
    const lanes flow = solid_law_flow(m, own[6], q);
    const lanes_mask flows = flow > lanes_all(0.0);
    const lanes drop = lanes_keep(flows, flow * lanes_all(3.0 * m->mu) / q);
    /* Heat: mean stress of the step times flow 3/2 s/q, in the direction of the trial. */
    const lanes along = solid_law_product(old, deviator);
    const lanes heat = (along + (lanes_all(1.0) - drop) * q * q * lanes_all(2.0 / 3.0)) *
                       (flow * lanes_all(0.75)) / q;
#pragma GCC unroll 6
    for (int k = 0; k < 6; k++)
        own[k] -= deviator[k] * drop;
    own[6] += flow;
    own[7] += lanes_keep(flows, heat * volume);
}

/*
 * One step of the first row of an element's state: stress, plastic strain and work.  `acting`
 * becomes the stress that acts, with that of stiffness-proportional damping, which is not
 * remembered; what that turns into heat is returned [J].  (12.7)
 */
LANES_INLINE lanes solid_law_stress(const struct solid_element_material *m, double dt,
                                    lanes gradient[3][3], lanes turn[3][3], lanes volume,
                                    bool plastic, lanes own[8], lanes acting[3][3])
{
    const lanes half = lanes_all(0.5), twice_mu = lanes_all(2.0 * m->mu);
    lanes strain[6], elastic[6];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        strain[i] = gradient[i][i];
        strain[3 + i] = (gradient[i][j] + gradient[j][i]) * half;
    }
    const lanes all_round = ((strain[0] + strain[1]) + strain[2]) * lanes_all(m->lambda);
#pragma GCC unroll 6
    for (int k = 0; k < 6; k++)
        elastic[k] = k < 3 ? all_round + strain[k] * twice_mu : strain[k] * twice_mu;

    solid_law_turned(turn, own);
    lanes old[6];
#pragma GCC unroll 6
    for (int k = 0; k < 6; k++) {
        old[k] = own[k];
        own[k] += elastic[k];
    }
    if (plastic)
        solid_law_return(m, volume, old, own);

    const lanes rate = lanes_all(m->damping / dt);
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        acting[i][i] = own[i] + elastic[i] * rate;
        acting[i][j] = acting[j][i] = own[3 + i] + elastic[3 + i] * rate;
    }
    return solid_law_product(elastic, strain) * rate * volume;
}

#endif
