/*
 * Nodes that turn: those of shells.  They have an angular velocity and inertia against turning,
 * the same about every axis; how far they have turned is nowhere needed (THEORY.md, 13.1).
 *
 * A solid without shells has none of this.
 */
#ifndef TREMIE_SOLID_SOLID_TURN_H
#define TREMIE_SOLID_SOLID_TURN_H

#include <stdbool.h>
#include <stdint.h>

#include "physics/solid_element.h"

struct solid;
struct solid_pace;

struct solid_turns {
    int n_nodes;                     /* of the solid; 0: none turns */
    struct solid_element_node *spin; /* {wx wy wz -} half a step earlier [rad/s]; padded */
    double *inertia;                 /* [kg m2]; 0: this one does not turn */
    double (*internal)[3];           /* moment of the elements at step n [N m] */
    double (*external)[3];           /* of loads [N m] */
    double (*contact)[3];            /* from outside; solid_move() clears it [N m] */
};

void solid_turns_init(struct solid_turns *turns, int n_nodes);
void solid_turns_clear(struct solid_turns *turns);

/* No moments yet; those of loads are not touched if there never were any. */
void solid_turns_begin(struct solid_turns *turns, bool loaded);
/* From the angular velocities at n - 1/2 to those at n + 1/2, and the work that was done;
 * supports are at n + 1 already.  Contacts' moments are cleared if they are to be forgotten. */
void solid_turns_move(struct solid *solid, const struct solid_pace *pace, bool forget);
/* Adds the power of what works on a node that turns as half a step earlier to `power`, of each
 * enum solid_work [W]; returns its kinetic energy in turning [J]. */
double solid_turns_power(const struct solid *solid, int i, double dt, double power[]);

/* Moment of what holds a node that turns, in the step that is about to be made; none where it
 * does not turn [N m]. */
void solid_turns_support(const struct solid *solid, int i, double dt, double moment[3]);

static inline double *solid_turn_spin(const struct solid_turns *turns, int i)
{
    return turns->spin[i].lane;
}

#endif
