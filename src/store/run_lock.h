/*
 * Who may write to a run's folder: the file RUN/lock, which outlives its owner and the file
 * system's own locks.
 *
 * It names the owner's host, process, start of that process and scheduler's job, a token that
 * nobody else has, and a heartbeat that the owner moves on every few seconds.  On the owner's
 * host its process is looked for; from another one only the heartbeat tells, by the watcher's
 * own clock: an owner whose heart has stood still for three intervals is taken to be dead.  One
 * that is only slow, or stopped, and wakes up when the folder is another's finds another token
 * there, and leaves; so the token is read again before anything gets its final name.
 *
 * All functions are local to one process (rank 0).
 */
#ifndef TREMIE_STORE_RUN_LOCK_H
#define TREMIE_STORE_RUN_LOCK_H

#include <stdbool.h>
#include <stdint.h>

struct run_lock;

enum { RUN_LOCK_TOKEN = 17 };

/* What a lock says of its owner. */
struct run_lock_owner {
    char token[RUN_LOCK_TOKEN];
    char host[256];
    char
        place[128]; /* boot and name space in which the number of the process means something */
    int64_t process, started;
    char job[128]; /* the scheduler's, "" without one */
    char since[32];
    double interval; /* between heartbeats [s] */
    int64_t beat;    /* heartbeats so far */
};

enum run_lock_life {
    RUN_LOCK_LIVES,
    RUN_LOCK_DEAD,
    RUN_LOCK_ELSEWHERE, /* cannot be looked for from here */
};

/* Takes the lock, from an owner that is dead or, with take_over, from any.  NULL: not, *status
 * being a REPORT_ status with the reason said. */
struct run_lock *run_lock_take(const char *folder, bool take_over, int *status);
/* Gives the lock back, if it is still ours; NULL is no lock. */
void run_lock_release(struct run_lock *lock);

const char *run_lock_token(const struct run_lock *lock);
/* Does the folder's lock still have our token? */
bool run_lock_is_ours(const struct run_lock *lock);

/* Reads who owns a folder; false when nobody does. */
bool run_lock_read(const char *folder, struct run_lock_owner *owner);
enum run_lock_life run_lock_look_for(const struct run_lock_owner *owner);

#endif
