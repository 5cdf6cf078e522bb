/*
 * Probes: nodes and elements of bodies that deform, alone or the mean of a set, in the series.
 *
 * A rank adds what it moves and counts (solid/solid.h), as exact sums, so values do not depend
 * on who has what.  They are those of the instant of the row: nothing is remembered.
 */
#ifndef TREMIE_RUN_PROBES_H
#define TREMIE_RUN_PROBES_H

struct job_probe;
struct series;
struct simulation;

struct probe {
    const struct job_probe *asked;
    int deform;    /* which of the bodies that deform */
    int n;         /* nodes or elements */
    int *items;    /* their numbers */
    double *share; /* of each in the mean [-] */
};

struct probes {
    int n;
    struct probe *list;
};

/* After bodies that deform.  Local. */
void probes_init(struct probes *probes, const struct simulation *sim);
void probes_clear(struct probes *probes);
/* Adds the columns NAME.displacement_x and so on. */
void probes_add_columns(const struct probes *probes, struct series *table);
/* Puts the values over all ranks into row[n..] in the order of the columns, between
 * deform_plan() and deform_move(); returns the new n.  Collective. */
int probes_values(struct simulation *sim, double *row, int n);

#endif
