/*
 * Damping of its own in parts of space (`damping_regions`): a force of -damping x mass x
 * velocity on the spheres whose centres are there, and a moment likewise, added to their rows
 * before the step looks at energies (THEORY.md, section 5.2).  Costs nothing where no job asks
 * for it.
 */
#ifndef TREMIE_RUN_LOCAL_DAMPING_H
#define TREMIE_RUN_LOCAL_DAMPING_H

struct region;
struct simulation;

struct local_damping {
    int n;
    struct region *regions;
};

/* The job has been checked: its regions can be built.  Local. */
void local_damping_init(struct local_damping *damping, const struct simulation *sim);
void local_damping_clear(struct local_damping *damping);
/* After all other forces of a step.  Local. */
void local_damping_apply(struct simulation *sim);

#endif
