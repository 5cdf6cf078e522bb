/*
 * What a run watches, and the one reduction of a step.
 *
 * Each step every rank contributes the largest of a few numbers (allowances spent, overlap, a
 * wish to stop, a checkpoint that is due, anything that is not a number), and all act on the
 * same maxima: searching, saving, stopping and failing are collective by construction.  Each
 * failure has a name, a diagnosis (what, where, when) and a remedy; it ends the run with the
 * last good checkpoint kept.
 */
#ifndef TREMIE_RUN_WATCH_H
#define TREMIE_RUN_WATCH_H

#include <stdbool.h>

struct simulation;

enum watch_failure {
    WATCH_FINE,
    WATCH_NOT_A_NUMBER, /* a place or velocity is NaN or infinite */
    WATCH_OVERLAP,      /* a contact overlaps too much: too soft, too fast, too large a step */
    WATCH_MOTION, /* a sphere or body moves too far in one step: contacts would be missed */
    WATCH_LEAVER, /* a sphere left the domain */
    WATCH_ENERGY, /* the energy balance does not close */
    WATCH_SUMS,   /* a total is beyond what exact sums hold */
};

struct watch {
    enum watch_failure failure;             /* the same on all ranks */
    bool stop_asked;                        /* on this rank, other than by a signal */
    bool stop_agreed;                       /* somebody asked to stop; the same on all ranks */
    bool checkpoint_due;                    /* by rank 0's clock */
    double overlap;                         /* largest of the last step, on any rank */
    double checkpoint_every, checkpoint_at; /* rank 0's clock [s]; every 0: never */
    /* this rank's part of the diagnosis */
    char what[160];
};

void watch_init(struct watch *watch, double checkpoint_every);

/* The step's one reduction: spent[] becomes the largest on any rank.  Collective. */
void watch_agree(struct watch *watch, struct simulation *sim, double spent[2], bool bad);

/* Looks at what only changes slowly: motion a step against radius.  At each search.
 * Collective. */
void watch_motion(struct watch *watch, const struct simulation *sim);
/* Looks at the energy balance of the sample just taken.  The same on all ranks. */
void watch_energy(struct watch *watch, const struct simulation *sim);

/* Spheres outside the domain, at steps that the job fixes: stops the run, or marks them in
 * removed[] (n_owned flags) and returns how many there are on all ranks.  Collective. */
int watch_leavers(struct watch *watch, struct simulation *sim, unsigned char *removed);

/* Says what failed, where and what to do, on one rank.  Collective. */
void watch_explain(const struct watch *watch, const struct simulation *sim);

#endif
