/*
 * Insertion: spheres that come in while the run goes on.
 *
 * At its occasions, steps that are multiples of `every`, an insertion brings in what is due:
 * its rate times the time since its start, less what it has brought.  The last step before
 * until.time is an occasion too, for all that is due by until.time: none is lost, and a run
 * that ends there has it in its last checkpoint.  (The end of a run is none: a run that is made
 * longer later does what it would have done.)  The k-th sphere of an
 * insertion has its radius, material and velocity from k alone, so what finds no room waits
 * with its size and the sizes keep their distribution however full the region is.  Places are
 * drawn by the number of the attempt.  Every rank draws the same, tests against the spheres
 * that it owns and its share of the bodies, one reduction gives the verdict on up to
 * INSERTION_WAITING attempts, and they are accepted in order, tested against each other.  So
 * what comes in, and its ids, is a function of the job alone.  (8.1)
 */
#ifndef TREMIE_RUN_INSERTION_H
#define TREMIE_RUN_INSERTION_H

#include <stdbool.h>
#include <stdint.h>

#include "model/crowd.h"
#include "model/packing.h"
#include "model/region.h"
#include "model/sizes.h"
#include "run/tally.h"

struct bodies;
struct job;
struct notes;
struct simulation;

/* Spheres of one insertion that are tried side by side, and at most wait for the next occasion;
 * attempts that a sphere has at one. */
enum { INSERTION_WAITING = 32, INSERTION_ATTEMPTS = 100 };

/* Of one that was drawn and has no place yet. */
struct insertion_waiting {
    int64_t k;
    int n_tried; /* at this occasion */
};

struct insertion {
    const struct job_insertion *asked;
    bool occasion; /* at this step, and something is due */
    double due;    /* then: by number or mass as the rate is */
    int number;    /* in the job */
    struct region region;
    struct sizes sizes;
    bool *solid; /* bodies whose inside is not for it */
    /* State, the same on all ranks. */
    int64_t n_attempts, n_drawn, n_inserted;
    double mass_drawn; /* [kg] */
    int n_waiting;
    struct insertion_waiting waiting[INSERTION_WAITING];
    /* On rank 0, what came in since step 0; elsewhere nothing. */
    struct tally tally;
    int64_t n_lacked; /* the most that was said to be lacking */
};

/* One that comes in at this step. */
struct insertion_new {
    struct packing_sphere sphere;
    int64_t id;
    int group;
};

struct insertions {
    int n;
    struct insertion *list;
    struct crowd crowd; /* who could be in the way at this step */
    int n_surfaces;
    struct region_surface **surfaces; /* of bodies that are solid to one of them, as they were
                                       * at the last occasion; else NULL */
    int n_new, new_capacity;          /* to be placed by insertions_place() */
    struct insertion_new *new;
    double radius_max; /* of all spheres in the run, where there are new ones [m] */
};

void insertions_init(struct insertions *insertions, const struct job *job,
                     const struct bodies *bodies);
void insertions_clear(struct insertions *insertions);

/* Finds places for what is due at this step, with new ids; spheres that are marked in removed[]
 * (NULL: none) are in nobody's way.  Returns how many come in.  Collective. */
int insertions_try(struct simulation *sim, const unsigned char *removed);
/* Puts those that belong into this rank's box behind its ghosts, for the migration to take
 * in.  Local. */
void insertions_place(struct simulation *sim);

/* What is due by `time`, by number or mass as the rate is. */
double insertion_due(const struct job_insertion *asked, double time);
/* What was due at the last occasion up to this step. */
double insertion_due_since(const struct job_insertion *asked, int64_t step, double dt);
/* Radius, material and velocity of the k-th sphere of the insertion of this number; its place
 * is not set. */
struct packing_sphere insertion_sphere(const struct job_insertion *asked, int number,
                                       const struct sizes *sizes, int64_t seed, int64_t k);

void insertions_put_notes(const struct insertions *insertions, struct notes *notes);
/* False, the reason said, where a note is missing or makes no sense. */
bool insertions_take_notes(struct insertions *insertions, const struct notes *notes);

#endif
