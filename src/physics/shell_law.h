/*
 * Stress in layers of shells and membranes: plane, elastic, with plastic flow that is brought
 * back to von Mises's ellipse (THEORY.md, 13.5).
 *
 * Written in lanes (physics/lanes.h).
 */
#ifndef TREMIE_PHYSICS_SHELL_LAW_H
#define TREMIE_PHYSICS_SHELL_LAW_H

#include "physics/lanes.h"
#include "physics/shell_geometry.h"
#include "physics/solid_element.h"
#include "physics/solid_law.h"

/* Newton steps of the return.  They rise from solid_law_flow()'s flow, which is never above the
 * right one; four leave 1e-12 of the strain where a trial is twice the yield stress, 1e-6 where
 * it is twenty times that. */
enum { SHELL_LAW_ROUNDS = 4 };

/* What resists a corner's turning about the normal beside its element's, over mu volume:
 * little, for shells know no such resistance, but enough to hold moments where elements meet at
 * an angle.  (13.8) */
static const double SHELL_LAW_DRILL = 0.03;

/* Constants of plane stress. */
struct shell_law {
    const struct solid_element_material *material;
    double plane;   /* E / (1 - nu^2) [Pa] */
    double poisson; /* [-] */
    double shear;   /* mu, in the plane [Pa] */
    double across;  /* 5/6 mu, across the thickness [Pa] */
    double young;   /* [Pa] */
    double all;     /* E / 2 (1 - nu): how flow lessens the sum of both stresses [Pa] */
};

LANES_INLINE struct shell_law shell_law_of(const struct solid_element_material *m)
{
    const double poisson = 0.5 * m->lambda / (m->lambda + m->mu);
    const double young = 2.0 * m->mu * (1.0 + poisson);
    return (struct shell_law){.material = m,
                              .plane = young / (1.0 - poisson * poisson),
                              .poisson = poisson,
                              .shear = m->mu,
                              .across = 5.0 / 6.0 * m->mu,
                              .young = young,
                              .all = 0.5 * young / (1.0 - poisson)};
}

/* Yield stress at a plastic strain, and its slope. */
LANES_INLINE lanes shell_law_yield(const struct solid_element_material *m, lanes p,
                                   lanes *slope)
{
    const struct solid_element_yield *first = &m->yield[0];
    lanes stress =
        lanes_all(first->stress) + (p - lanes_all(first->strain)) * lanes_all(first->slope);
    *slope = lanes_all(first->slope);
    for (int k = 1; k < m->n_yield; k++) {
        const struct solid_element_yield *piece = &m->yield[k];
        const lanes above = p - lanes_all(piece->strain);
        const lanes_mask there = above >= lanes_all(0.0);
        stress = lanes_where(there, lanes_all(piece->stress) + above * lanes_all(piece->slope),
                             stress);
        *slope = lanes_where(there, lanes_all(piece->slope), *slope);
    }
    return stress;
}

/* What a trial's ellipse is made of: quarter the square of the sum, and the rest. */
struct shell_law_trial {
    lanes sum, rest;
};

/* Flow over equivalent stress that brings the trial back, and the equivalent stress then.
 * (13.13) */
LANES_INLINE lanes shell_law_flow(const struct shell_law *law,
                                  const struct shell_law_trial *trial, lanes p, lanes q_trial,
                                  lanes *q)
{
    const lanes one = lanes_all(1.0), thrice = lanes_all(3.0 * law->shear),
                all = lanes_all(law->all);
    const lanes least = solid_law_flow(law->material, p, q_trial);
    lanes flow = least / (q_trial - least * thrice);
#pragma GCC unroll 1
    for (int k = 0; k <= SHELL_LAW_ROUNDS; k++) {
        const lanes a = one / (one + all * flow), b = one / (one + thrice * flow);
        const lanes sum = trial->sum * a * a, rest = trial->rest * b * b;
        lanes slope;
        *q = lanes_sqrt(sum + rest);
        if (k == SHELL_LAW_ROUNDS)
            break;
        const lanes stress = shell_law_yield(law->material, p + flow * *q, &slope);
        const lanes falls = (sum * a * all + rest * b * thrice) / *q;
        flow += (*q - stress) / (falls + slope * (*q - flow * falls));
    }
    return flow;
}

/* Brings a layer's trial back where it is beyond the ellipse; returns how flow thins it, and
 * adds heat per volume.  (13.13) */
LANES_INLINE lanes shell_law_return(const struct shell_law *law, const lanes old[3],
                                    lanes layer[4], lanes *heat)
{
    const lanes half = lanes_all(0.5), one = lanes_all(1.0), zero = lanes_all(0.0);
    const lanes sum = layer[0] + layer[1], difference = layer[0] - layer[1];
    const struct shell_law_trial trial = {sum * sum * lanes_all(0.25),
                                          difference * difference * lanes_all(0.75) +
                                              layer[2] * layer[2] * lanes_all(3.0)};
    const lanes q_trial = lanes_sqrt(trial.sum + trial.rest);
    lanes slope, q;
    const lanes_mask flows = q_trial > shell_law_yield(law->material, layer[3], &slope);
    if (!lanes_any(flows))
        return zero;
    const lanes flow = shell_law_flow(law, &trial, layer[3], q_trial, &q);
    const lanes p = layer[3] + flow * q;
    /* What is left of the distance to the ellipse goes straight. */
    const lanes onto = shell_law_yield(law->material, p, &slope) / q;
    const lanes s = sum / (one + lanes_all(law->all) * flow) * onto,
                by = onto / (one + lanes_all(3.0 * law->shear) * flow);
    const lanes d = difference * by;
    const lanes back[3] = {(s + d) * half, (s - d) * half, layer[2] * by};
    const lanes strain[3] = {(back[0] - back[1] * half) * flow,
                             (back[1] - back[0] * half) * flow,
                             back[2] * flow * lanes_all(3.0)};
    lanes work = zero;
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        work += (old[k] + back[k]) * strain[k];
        layer[k] = lanes_where(flows, back[k], layer[k]);
    }
    layer[3] = lanes_where(flows, p, layer[3]);
    *heat += lanes_keep(flows, work * half);
    return lanes_keep(flows, -(strain[0] + strain[1]));
}

/* Shear of triangles is softened where they are thin beside their longest side.  (13.11) */
LANES_INLINE lanes shell_law_softened(const struct shell_geometry *g, lanes thickness)
{
    const lanes third[2] = {g->second[0] - g->first[0], g->second[1] - g->first[1]};
    const lanes a = g->first[0] * g->first[0] + g->first[1] * g->first[1],
                b = g->second[0] * g->second[0] + g->second[1] * g->second[1],
                c = third[0] * third[0] + third[1] * third[1];
    const lanes ab = lanes_where(a > b, a, b), square = thickness * thickness;
    return square / (square + lanes_all(0.1) * lanes_where(ab > c, ab, c));
}

/* What resists across the thickness over strain there [Pa]. */
LANES_INLINE lanes shell_law_across(const struct shell_law *law, const struct shell_geometry *g,
                                    lanes thickness, bool triangle)
{
    return triangle ? lanes_all(law->across) * shell_law_softened(g, thickness)
                    : lanes_all(law->across);
}

/* How many modes an element has. */
LANES_INLINE int shell_law_n_modes(bool shell, bool triangle)
{
    return triangle ? (shell ? 4 : 0) : (shell ? 10 : 2);
}

/* Their stiffness.  (13.8), (13.11) */
LANES_INLINE void shell_law_modes(const struct shell_law *law, const struct shell_geometry *g,
                                  lanes thickness, bool triangle, lanes stiffness[10])
{
    const lanes drill = g->area * thickness * lanes_all(SHELL_LAW_DRILL * law->shear);
#pragma GCC unroll 4
    for (int c = 0; c < 4; c++)
        stiffness[(triangle ? 1 : 6) + c] = drill;
    const lanes volume = g->area * thickness * lanes_all(law->material->hourglass_stiffness);
    const lanes across = shell_law_across(law, g, thickness, triangle) * volume;
    const lanes xi = g->xi[0] * g->xi[0] + g->xi[1] * g->xi[1],
                eta = g->eta[0] * g->eta[0] + g->eta[1] * g->eta[1];
    if (triangle) {
        const lanes mixed = g->xi[0] * g->eta[0] + g->xi[1] * g->eta[1];
        stiffness[0] = across * ((xi + eta) + mixed) * lanes_all(1.0 / 18.0);
        return;
    }
#pragma GCC unroll 2
    for (int i = 0; i < 2; i++) {
        stiffness[i] = volume * lanes_all(law->young / 48.0) *
                       (g->xi[i] * g->xi[i] + g->eta[i] * g->eta[i]);
        stiffness[2 + i] = stiffness[i] * thickness * thickness * lanes_all(1.0 / 12.0);
    }
    stiffness[4] = across * xi * lanes_all(1.0 / 3.0);
    stiffness[5] = across * eta * lanes_all(1.0 / 3.0);
}

/* Change of a layer's stress by the elastic law.  (13.12) */
LANES_INLINE void shell_law_elastic(const struct shell_law *law, const lanes strain[3],
                                    lanes change[3])
{
    const lanes plane = lanes_all(law->plane), poisson = lanes_all(law->poisson);
    change[0] = plane * (strain[0] + poisson * strain[1]);
    change[1] = plane * (strain[1] + poisson * strain[0]);
    change[2] = lanes_all(law->shear) * strain[2];
}

#endif
