/*
 * What a run watches, and the one reduction of a step.
 *
 * Each step every rank contributes the largest of a few numbers (allowances spent, overlap, a
 * wish to stop, a checkpoint that is due, anything that is not a number), and all act on the
 * same maxima: searching, saving, stopping and failing are collective by construction.  Each
 * failure has a name, a diagnosis (what, where, when) and a remedy; it ends the run with the
 * last good checkpoint kept.  THEORY.md, section 9, says what each detector rests on and within
 * how many steps it rings.
 */
#ifndef TREMIE_RUN_WATCH_H
#define TREMIE_RUN_WATCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "run/schedule.h"

struct critical_step_sums;
struct job;
struct simulation;

enum watch_failure {
    WATCH_FINE,
    WATCH_NOT_A_NUMBER, /* a place or velocity is NaN or infinite */
    WATCH_STEP,         /* the step exceeds what the present contacts allow */
    WATCH_OVERLAP,      /* a contact overlaps too much */
    WATCH_MOTION,     /* a sphere or body moves too far in one step: contacts would be missed */
    WATCH_FAR,        /* so far from the origin that rounding of places spoils contacts */
    WATCH_LEAVER,     /* a sphere left the domain */
    WATCH_FULL,       /* an insertion finds no room, and is to stop then */
    WATCH_ENERGY,     /* the energy balance does not close */
    WATCH_SUMS,       /* a total is beyond what exact sums hold */
    WATCH_ELEMENT,    /* an element of a body that deforms, or a contact of its, has failed */
    WATCH_SOLID_STEP, /* the step exceeds what such elements allow with their contacts */
    WATCH_HOURGLASS,  /* a body that deforms does so in ways that its elements do not feel */
};

/* Why a run stops before its end, with a checkpoint. */
enum watch_stop {
    WATCH_GO_ON,
    WATCH_STOP_FILE, /* `tremie stop` asked for it */
    WATCH_STOP_SIGNAL,
    WATCH_STOP_TIME, /* its wall time is nearly over */
    WATCH_STOP_LOST, /* another process has taken the run's folder */
};

/* Steps between looks at what only changes slowly.  They are part of the result: a run stops at
 * the same step on any ranks, whenever it searches or restarts. */
enum {
    WATCH_CONTACTS_EVERY = 256, /* the step against the contacts; how far from the origin */
    WATCH_ENERGY_EVERY = 1024,  /* the energy balance, beside each sample */
};

struct watch {
    enum watch_failure failure; /* the same on all ranks */
    enum watch_stop stop_asked; /* on this rank, other than by a signal or the clock */
    enum watch_stop stop;       /* why to stop before the end; the same on all ranks */
    bool checkpoint_due;        /* by rank 0's clock */
    double overlap;             /* largest of the last step, on any rank */
    double motion;              /* likewise, over radius, where it came near the limit */
    struct schedule schedule;   /* its clock is rank 0's */
    double allowance_most;      /* largest allowance over radius on this rank [-] */
    /* This rank's findings at a step that is looked at, else 0: they go with the next
     * reduction. */
    double rate;     /* 1 / critical step of the present contacts, if it fails the run [1/s] */
    double rounding; /* of places, over what contacts can bear [-] */
    double radius_least; /* of all spheres at the start [m] */
    /* The step is beyond what is safe as bodies that deform touch: they are looked at each step
     * at which they do, for a light node soon leaves a stiff contact, with energy that it has
     * not brought. */
    bool doubts_nodes;
    /* What all contacts of each body that forces move do to it, when last looked at. */
    struct critical_step_sums *loads;
    /* this rank's part of the diagnosis */
    char what[320];
};

void watch_init(struct watch *watch, const struct job *job);
void watch_clear(struct watch *watch);

/* Notes the allowances that a search has chosen.  Local. */
void watch_searched(struct watch *watch, const struct simulation *sim);
/* Looks at bodies' motion, which the job prescribes, before the first step.  Collective. */
void watch_bodies(struct watch *watch, const struct simulation *sim);

/* Looks at what elements of bodies that deform allow of the step, before the first one.
 * Collective. */
void watch_elements(struct watch *watch, const struct simulation *sim);

/* Looks at the motion of bodies that forces move, in the step just done.  The same on all
 * ranks. */
void watch_forced(struct watch *watch, const struct simulation *sim);

/* Looks at contacts and places, where the step is one that is looked at: forces are known,
 * nothing has moved.  Local; collective where forces move bodies or bodies deform. */
void watch_contacts(struct watch *watch, const struct simulation *sim);

/* The step's one reduction: spent[] becomes the largest on any rank.  Collective. */
void watch_agree(struct watch *watch, struct simulation *sim, double spent[2], bool bad);

/* Notes that an insertion finds no room; the same on all ranks. */
void watch_full(struct watch *watch, const char *what);

/* Looks at the energy balance just made.  The same on all ranks. */
void watch_energy(struct watch *watch, const struct simulation *sim);

/* The critical step of the present contacts [s]; infinite without any.  Collective. */
double watch_critical_step(const struct simulation *sim);

/* The deepest contact of the last forces, over radius [-]; `what` says whose.  Collective. */
double watch_deepest(const struct simulation *sim, char *what, size_t size);

/* Spheres outside the domain that removed[] (n_owned flags) does not mark yet, at steps that
 * the job fixes: stops the run, or marks and counts them and returns how many there are on all
 * ranks.  Collective. */
int64_t watch_leavers(struct watch *watch, struct simulation *sim, unsigned char *removed);

/* Says what failed, where and what to do, on one rank.  Collective. */
void watch_explain(const struct watch *watch, const struct simulation *sim);

#endif
