/*
 * Which damping makes a contact give back the restitution that was asked for.
 *
 * With the usual formula a Hertz contact returns what was asked only if it may pull.  Ours may
 * not, so the formula's .5 comes out as .55, its .2 as .32; here the relation is inverted for
 * the contact that lets go, THEORY.md (1.19) to (1.24).  It does not depend on the speed of
 * impact.
 */
#ifndef TREMIE_MODEL_RESTITUTION_H
#define TREMIE_MODEL_RESTITUTION_H

/* The least that can be asked for: damping grows without bound below it, as 1 / 2 sqrt(e). */
#define RESTITUTION_LEAST 0.01

/* Rebound over impact speed of a damped contact that cannot pull, 0 < e <= 1.  `damping` is the
 * share of critical damping, beta >= 0 [-]. */
double restitution_returned(double damping);

/* The damping ratio beta whose contact returns `restitution`, RESTITUTION_LEAST to 1; exactly 0
 * for 1. */
double restitution_damping(double restitution);

#endif
