/*
 * What spheres are like at the start, as a job places them: which overlap others or bodies more
 * than the watch bears, which are outside the domain, or inside a body of elements.  A run of
 * them would stop at once, or not feel them.
 */
#ifndef TREMIE_RUN_START_H
#define TREMIE_RUN_START_H

struct bodies;
struct job;
struct mistakes;
struct packing;
struct packings;

/* Lists what is wrong, the first sphere of each kind and group by name.  Spheres `before`, of
 * the state that a job starts from, are not compared with each other.  The domain is known.
 * Where there are more than START_SPHERES_MOST the run itself finds out.  Local. */
enum { START_SPHERES_MOST = 10000000 };
void start_check(const struct job *job, const struct bodies *bodies,
                 const struct packings *packings, const struct packing *before,
                 struct mistakes *mistakes);

#endif
