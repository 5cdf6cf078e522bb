/*
 * What a run tells of itself in small text files that people and programs can read while it
 * runs: RUN/status, replaced every second, and RUN/history, which gets a line whenever a
 * process starts to step and when it ends.  Local; written by rank 0.
 */
#ifndef TREMIE_STORE_RUN_RECORD_H
#define TREMIE_STORE_RUN_RECORD_H

#include <stdbool.h>
#include <stdint.h>

struct run_folder;
struct run_lock_owner;

struct run_record_status {
    char state[16]; /* running, stopped, finished or failed */
    char owner[32]; /* token of the process that says so */
    int64_t step, n_steps, n_spheres;
    double time, end;     /* simulated [s] */
    double rate;          /* sphere-steps a second */
    double left;          /* wall time to the end, estimated [s]; negative: unknown */
    int64_t ranks, since; /* since 1970 [s]: when the status was written */
};

/* One line of the history. */
struct run_record_event {
    bool start; /* else an end */
    int64_t at; /* since 1970 [s] */
    int64_t step;
    /* of a start */
    int64_t ranks, process;
    char host[256], job[128];
    /* of an end */
    int64_t status; /* of the program */
    double seconds; /* since the start */
    double cost;    /* of a checkpoint, estimated [s] */
    char why[64];
};

/* Replaces the status, of what is still our folder; `owner` and `since` are filled in. */
void run_record_write_status(const struct run_folder *folder,
                             const struct run_record_status *status);
/* False when there is none. */
bool run_record_read_status(const char *folder, struct run_record_status *status);

/* Does the process live that owns a folder?  On its own host that shows at once, from another
 * one by how long ago it was heard of. */
bool run_record_lives(const char *folder, const struct run_lock_owner *owner);
/* What a run does: the status' state, or starting, killed or not started, by its status, empty
 * where there is none, and who owns it, NULL: nobody.  Lives as long as the status. */
const char *run_record_state(const char *folder, const struct run_record_status *status,
                             const struct run_lock_owner *owner);

/* Adds to the history; `at` and, of a start, `process`, `host` and `job` are filled in. */
void run_record_add_event(const struct run_folder *folder,
                          const struct run_record_event *event);
/* All of it; the caller frees *events. */
int run_record_history(const char *folder, struct run_record_event **events);

#endif
