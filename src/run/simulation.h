/*
 * A simulation on one rank: all that the step works on.  step.h moves it; redistribute.h finds
 * who touches and who owns; watch.h looks for failure; observe.h reports.
 */
#ifndef TREMIE_RUN_SIMULATION_H
#define TREMIE_RUN_SIMULATION_H

#include <stdint.h>

#include "base/comm.h"
#include "contact/candidates.h"
#include "contact/contact_set.h"
#include "contact/facet_contact.h"
#include "contact/pair_kernel.h"
#include "domain/balance.h"
#include "domain/boxes.h"
#include "domain/halo.h"
#include "domain/migrate.h"
#include "model/body.h"
#include "model/material.h"
#include "model/sphere.h"
#include "physics/integrate.h"
#include "run/capture.h"
#include "run/contents.h"
#include "run/deform.h"
#include "run/forced.h"
#include "run/insertion.h"
#include "run/local_damping.h"
#include "run/observe.h"
#include "run/probes.h"
#include "run/removal.h"
#include "run/runtime.h"
#include "run/sections.h"
#include "run/touch.h"
#include "run/watch.h"

struct job;
struct packing_sphere;
struct run_folder;

/* Ages of the lists, in shares of what they allow: 1 means stale. */
struct simulation_spent {
    double search; /* of the candidates' allowances */
    double inner;  /* of the inner list's */
    double bodies; /* of the bodies', since the last search */
};

/* What a sphere takes of memory, with its contacts, ghosts and messages, in round numbers. */
enum { SIMULATION_BYTES_A_SPHERE = 3000 };

struct simulation {
    const struct comm *comm;
    const struct job *job;
    double dt;            /* [s] */
    int64_t step;         /* steps done: places are those at step * dt */
    int64_t n_steps;      /* at which the job ends */
    int64_t sample_every; /* steps between samples; 0: none */
    int64_t next_id;
    int64_t n_spheres; /* in the run, on all ranks */

    struct materials materials;
    struct bodies bodies;
    struct spheres spheres;

    struct candidates candidates;
    struct contact_set contacts;
    struct facet_contacts facets;
    double
        *body_allowance; /* how far each body's surface may move before a search is due [m] */
    struct pair_kernel kernel;
    struct integrate_kernel integrate;
    double
        overlap_max; /* largest overlap over radius in the last step, of pairs, on this rank */

    struct boxes boxes;
    struct halo halo;
    struct migrate migrate;
    struct balance balance;
    double half_buffer; /* least allowance of a search [m] */
    double asked_most;  /* largest that speeds may ask for at the next one, in radii */
    struct simulation_spent spent;

    struct vec3 gravity;        /* at this step [m/s2] */
    struct vec3 gravity_change; /* since the step before [m/s2] */
    bool gravity_varies;
    struct forced forced;
    struct deform deform;
    struct probes probes;
    struct touch touch;
    struct local_damping local_damping;
    struct sections sections;
    struct contents contents;
    struct insertions insertions;
    struct removals removals;
    struct observe observe;
    struct capture capture;
    struct watch watch;
    struct runtime runtime;
};

/* Builds the scene of the job, at step 0, distributed and searched.  Returns a REPORT_ status,
 * the reason said, when what the job starts from cannot be read; then there is nothing to
 * destroy.  Collective. */
int simulation_create(struct simulation *sim, const struct comm *comm, const struct job *job,
                      enum isa isa);
/* The same from a checkpoint.  Returns a REPORT_ status, the reason said.  Collective. */
int simulation_restart(struct simulation *sim, const struct comm *comm, const struct job *job,
                       enum isa isa, const char *checkpoint_path);
void simulation_destroy(struct simulation *sim);

/* Writes series and checkpoint of the present step into the folder and drops old checkpoints.
 * Returns a REPORT_ status.  Collective. */
int simulation_save(struct simulation *sim, const struct run_folder *folder,
                    const char *job_text);
/* Writes a sphere that is new in the run as sphere i, in its order cell apart.  Local. */
void simulation_set_sphere(struct simulation *sim, int i, int64_t id, int group,
                           const struct packing_sphere *new);

/* Sizes on this rank, for the runtime table.  Local. */
struct runtime_sizes simulation_sizes(const struct simulation *sim);
/* The rows so far alone.  Collective. */
int simulation_save_series(struct simulation *sim, const struct run_folder *folder);

/* Steps in a time, rounded; 1e15 at most.  Local. */
int64_t simulation_steps(double time, double step);

#endif
