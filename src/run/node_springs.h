/*
 * Springs and dashpots of contacts as nodes of solids feel them, for the critical step (12.13):
 * a light node between stiff elements and a stiff contact allows less than either.
 */
#ifndef TREMIE_RUN_NODE_SPRINGS_H
#define TREMIE_RUN_NODE_SPRINGS_H

struct simulation;

/* Of each node, sums over the contacts that touch now. */
struct node_springs {
    double *stiffness; /* [N/m] */
    double *damping;   /* [kg/s] */
};

/* Which of the bodies that deform have contacts here that touch: 1, else 0.  Local. */
void node_springs_touched(const struct simulation *sim, double *touched);
/* Of all nodes of a body among those that deform.  Collective. */
void node_springs_find(struct node_springs *springs, const struct simulation *sim, int deform);
/* As elements feel them that take n steps in one of the contacts: such a step is stable with
 * them if the contacts' step is, with ω² = λ/n² + k/m of an element's λ (12.22). */
void node_springs_slow(const struct node_springs *springs, int n_nodes, int n);
void node_springs_clear(struct node_springs *springs);

#endif
