/*
 * Both levels of redistribution and global search: who owns what, who may touch whom.
 *
 * Any of it may happen at any step for any reason and changes no bit; the exceptions are the
 * renewal of canonical order, the removal and the insertion of spheres, which fall on steps
 * that the job fixes.
 */
#ifndef TREMIE_RUN_REDISTRIBUTE_H
#define TREMIE_RUN_REDISTRIBUTE_H

#include <stdbool.h>
#include <stdint.h>

struct contact_record;
struct simulation;

/* Must the lists be made anew before forces can be computed?  Local, the same on all ranks. */
bool redistribute_is_due(const struct simulation *sim);
/* The same for the inner list alone. */
bool redistribute_inner_is_due(const struct simulation *sim);

/* Makes everything anew.  removed marks owned spheres that leave the run, or is NULL; what
 * insertions_try() has found room for comes in.  Collective. */
void redistribute(struct simulation *sim, const unsigned char *removed);
/* Makes the inner list anew out of the candidates.  Local, on all ranks together. */
void redistribute_inner(struct simulation *sim);
/* First distribution of spheres that lie anywhere, in any order; the migration holds the
 * records of their contacts with bodies.  Collective. */
void redistribute_first(struct simulation *sim);
/* After it, as often as there are more of them: n records of contacts between spheres, in which
 * one of those takes part that this rank owned before.  Returns how many arrived here that join
 * spheres which are far apart.  Collective. */
int redistribute_restore(struct simulation *sim, int n, const struct contact_record *records);

/* What this rank has to do in a step, as the low level weighs it [ns].  Local. */
int64_t redistribute_weight(const struct simulation *sim);

/* Books the motion of the step just done against the allowances; spent[] is the largest on any
 * rank. Finds out exactly where the bound says stale.  Collective when it does. */
void redistribute_spend(struct simulation *sim, const double spent[2]);

#endif
