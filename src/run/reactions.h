/*
 * Reactions: the force of what holds or moves the sets of bodies that deform, and the work of
 * what moves them, in the series.
 *
 * Forces are means over the steps since the row before, that of the row included, as those of
 * contacts on bodies are: times the time between they are impulses.  What runs over steps
 * stands in the supports (solid/solid_support.h) and is saved as monitors.  A direction in
 * which two items of a body's `boundary` hold a node counts for the later one.
 */
#ifndef TREMIE_RUN_REACTIONS_H
#define TREMIE_RUN_REACTIONS_H

struct series;
struct simulation;

/* Adds the columns BODY.SET.reaction_x and so on. */
void reactions_add_columns(const struct simulation *sim, struct series *table);
/* Puts the values over all ranks into row[n..] in the order of the columns, between
 * deform_plan() and deform_move(); returns the new n.  Row and the one before are n_steps
 * apart.  Collective. */
int reactions_values(struct simulation *sim, double n_steps, double *row, int n);

#endif
