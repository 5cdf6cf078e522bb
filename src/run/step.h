/* One time step, in the order of the procedure that the method was published with. */
#ifndef TREMIE_RUN_STEP_H
#define TREMIE_RUN_STEP_H

struct simulation;

/* Lists fresh, bodies in place, all contact forces of the present instant known; a sample taken
 * where one is due.  Collective. */
void step_forces(struct simulation *sim);
/* One whole step.  Collective. */
void step(struct simulation *sim);

#endif
