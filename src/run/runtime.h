/*
 * Where the time goes: wall time of each rank by phase, counts of searches and redistributions,
 * and the "runtime" table that tremie-runstats reads.  Nothing here feeds a result.
 */
#ifndef TREMIE_RUN_RUNTIME_H
#define TREMIE_RUN_RUNTIME_H

#include <stdint.h>

#include "store/series.h"

struct boxes;
struct comm;

enum runtime_phase {
    RUNTIME_BODIES,
    RUNTIME_FACETS,
    RUNTIME_PAIRS,
    RUNTIME_INTEGRATE,
    RUNTIME_SOLIDS, /* their elements and nodes, and what ranks tell each other of them */
    RUNTIME_HALO,
    RUNTIME_WATCH,
    RUNTIME_SEARCH,
    RUNTIME_REDISTRIBUTE, /* the high level: migration, ghosts */
    RUNTIME_REPARTITION,  /* the low level: measuring balance, cutting anew */
    RUNTIME_SAMPLE,
    RUNTIME_CHECKPOINT,
    RUNTIME_N_PHASES,
};

/* Sizes on this rank when a row is made. */
struct runtime_sizes {
    int64_t n_owned, n_ghosts, n_internal, n_interfacial, n_candidates, n_contacts;
    int64_t n_spheres; /* in the run */
    int64_t n_nodes, n_copies,
        n_elements;   /* of bodies that deform: moved, not moved, computed */
    int64_t weight;   /* see redistribute_weight() [ns] */
    double imbalance; /* largest over mean working time at the last verdict; 1 before it */
};

struct runtime {
    double phase[RUNTIME_N_PHASES]; /* [s] since the last row */
    double mark;                    /* when the present phase began */
    double started, row_started;    /* [s] */
    int64_t row_step;
    int64_t searches, prunes, redistributions, repartitions, migrated,
        particle_steps;           /* since the last row */
    int64_t nodes_migrated, told; /* of bodies that deform: how many; bytes sent about them */
    struct series table;          /* on rank 0 */
    struct series subdomains;     /* boxes of all ranks at each save, on rank 0 */
};

void runtime_init(struct runtime *runtime, int64_t step);
void runtime_clear(struct runtime *runtime);
/* A phase begins now; the time since the last mark is nobody's. */
void runtime_begin(struct runtime *runtime);
/* The time since the last mark was this phase's; the next phase begins. */
void runtime_end(struct runtime *runtime, enum runtime_phase phase);
/* Adds a row and starts counting anew.  Collective. */
void runtime_row(struct runtime *runtime, const struct comm *comm, int64_t step, double time,
                 const struct runtime_sizes *sizes);
/* Adds the boxes of all ranks to the table of subdomains.  Local, on rank 0. */
void runtime_subdomains(struct runtime *runtime, const struct boxes *boxes, int64_t step);
/* Own resident memory [bytes]. */
double runtime_memory(void);

#endif
