/*
 * See run_lock.h.
 *
 * A new lock is written under another name and linked to its own, which only one of several can
 * do, on network file systems too.  A dead owner's lock is replaced by renaming a new one over
 * it.  Two that do this at the same time would both succeed, so it is done with a kernel's lock
 * on the folder held, and only if the lock is still the one that was judged; where the file
 * system has no such locks, the last one wins and the others see that a second later.
 *
 * The heart is a thread, as one step or checkpoint may take longer than an interval.  It writes
 * to the open file, not to the name: the heart of an owner that was replaced beats in a file
 * that has no name any more.
 */
#include "store/run_lock.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <pthread.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/array.h"
#include "base/process.h"
#include "base/report.h"
#include "base/timer.h"
#include "store/file.h"

/* Seconds between heartbeats, and how many of them an owner may miss. */
static const double INTERVAL = 10.0, INTERVALS_STILL = 3.0;
/* Of what a lock states we believe at most this. */
static const double INTERVAL_LEAST = 0.1, INTERVAL_MOST = 600.0;
/* A process that is just being killed lives for a moment more [s]. */
static const double DYING = 0.5;
/* An owner whose folder is taken looks at its lock this often at least [s]. */
static const double LOOKS_WITHIN = 1.5;

enum { TEXT_MAX = 4096, TRIES = 100 };

struct run_lock {
    char *folder, *path, *temporary;
    char token[RUN_LOCK_TOKEN];
    int file;
    off_t beat_at; /* where the number of heartbeats stands in the file */
    pthread_t heart;
    pthread_mutex_t mutex;
    pthread_cond_t end;
    bool beats, ends;
};

static void wait_for(double seconds)
{
    const struct timespec pause = {(time_t)seconds,
                                   (long)(1e9 * (seconds - (double)(time_t)seconds))};
    nanosleep(&pause, NULL);
}

/* -------------------------------------------------------------------------------- text */

static void find_place(char place[128])
{
    char boot[64] = "", space[48] = "";
    FILE *stream = fopen("/proc/sys/kernel/random/boot_id", "re");
    if (stream != NULL) {
        if (fgets(boot, sizeof boot, stream) == NULL)
            boot[0] = '\0';
        fclose(stream);
    }
    boot[strcspn(boot, "\n")] = '\0';
    const ssize_t n = readlink("/proc/self/ns/pid", space, sizeof space - 1);
    space[n > 0 ? n : 0] = '\0';
    snprintf(place, 128, "%s %s", boot, space);
}

static struct run_lock_owner describe_self(void)
{
    struct run_lock_owner self = {.process = getpid(), .interval = INTERVAL};
    uint64_t number = 0;
    const time_t now = time(NULL);
    struct tm parts;
    gethostname(self.host, sizeof self.host - 1);
    find_place(self.place);
    (void)process_lives(self.process, &self.started);
    process_job(self.job, sizeof self.job);
    if (localtime_r(&now, &parts) != NULL)
        strftime(self.since, sizeof self.since, "%Y-%m-%d %H:%M:%S", &parts);
    CHECK(getrandom(&number, sizeof number, 0) == (ssize_t)sizeof number, "no random number");
    snprintf(self.token, sizeof self.token, "%016" PRIx64, number);
    return self;
}

/* The lock's text but for the number of heartbeats, its end. */
static char *write_text(const struct run_lock_owner *owner)
{
    return array_format("token: %s\nhost: %s\nplace: %s\nprocess: %" PRId64
                        "\nstarted: %" PRId64 "\njob: %s\nsince: %s\ninterval: %g\nheartbeat: ",
                        owner->token, owner->host, owner->place, owner->process, owner->started,
                        owner->job, owner->since, owner->interval);
}

/* The value of a line `key: value`; "" when there is none. */
static void find_value(const char *text, const char *key, char *value, size_t size)
{
    const size_t length = strlen(key);
    value[0] = '\0';
    for (const char *line = text; line != NULL && *line != '\0';) {
        if (strncmp(line, key, length) == 0 && strncmp(line + length, ": ", 2) == 0) {
            snprintf(value, size, "%.*s", (int)strcspn(line + length + 2, "\n"),
                     line + length + 2);
            return;
        }
        line = strchr(line, '\n');
        line = line != NULL ? line + 1 : NULL;
    }
}

/* What a lock's text says; what is missing stays empty. */
static struct run_lock_owner read_text(const char *text)
{
    struct run_lock_owner owner = {.process = 0};
    char number[64];
    find_value(text, "token", owner.token, sizeof owner.token);
    find_value(text, "host", owner.host, sizeof owner.host);
    find_value(text, "place", owner.place, sizeof owner.place);
    find_value(text, "job", owner.job, sizeof owner.job);
    find_value(text, "since", owner.since, sizeof owner.since);
    find_value(text, "process", number, sizeof number);
    owner.process = strtoll(number, NULL, 10);
    find_value(text, "started", number, sizeof number);
    owner.started = strtoll(number, NULL, 10);
    find_value(text, "heartbeat", number, sizeof number);
    owner.beat = strtoll(number, NULL, 10);
    find_value(text, "interval", number, sizeof number);
    owner.interval = number[0] != '\0' ? strtod(number, NULL) : INTERVAL;
    if (!(owner.interval > INTERVAL_LEAST))
        owner.interval = INTERVAL_LEAST;
    if (owner.interval > INTERVAL_MOST)
        owner.interval = INTERVAL_MOST;
    return owner;
}

/* The lock that is there; NULL when there is none, or an empty one, which nobody holds. */
static char *read_lock(const char *path)
{
    char *text = NULL;
    free(file_read(path, TEXT_MAX, &text));
    if (text != NULL && text[0] == '\0') {
        free(text);
        text = NULL;
    }
    return text;
}

bool run_lock_read(const char *folder, struct run_lock_owner *owner)
{
    char *path = array_format("%s/lock", folder), *text = read_lock(path);
    if (text != NULL)
        *owner = read_text(text);
    free(path);
    const bool there = text != NULL;
    free(text);
    return there;
}

/* -------------------------------------------------------------------------------- judging */

enum run_lock_life run_lock_look_for(const struct run_lock_owner *owner)
{
    char host[256] = "", place[128];
    int64_t started;
    gethostname(host, sizeof host - 1);
    find_place(place);
    if (strcmp(host, owner->host) != 0 || strcmp(place, owner->place) != 0)
        return RUN_LOCK_ELSEWHERE;
    return process_lives(owner->process, &started) && started == owner->started ? RUN_LOCK_LIVES
                                                                                : RUN_LOCK_DEAD;
}

/* Does the lock stay what it is for so long? */
static bool stands_still(const char *path, const char *text, double seconds, double look_every)
{
    const double until = timer_now() + seconds;
    bool same = true;
    while (same && timer_now() < until) {
        wait_for(look_every);
        char *now = read_lock(path);
        same = now != NULL && strcmp(now, text) == 0;
        free(now);
    }
    return same;
}

/* Is the owner of the lock with this text dead? */
static bool is_dead(const struct run_lock *lock, const char *text)
{
    const struct run_lock_owner owner = read_text(text);
    const double until = timer_now() + DYING, wait = INTERVALS_STILL * owner.interval;
    enum run_lock_life life = run_lock_look_for(&owner);
    while (life == RUN_LOCK_LIVES && timer_now() < until) {
        wait_for(0.05);
        life = run_lock_look_for(&owner);
    }
    if (life != RUN_LOCK_ELSEWHERE)
        return life == RUN_LOCK_DEAD;
    report_say("%s is locked from another host (%s); waiting %.3g s for a sign of life",
               lock->folder, owner.host, wait);
    return stands_still(lock->path, text, wait, 0.1 * owner.interval);
}

static void refuse(const struct run_lock *lock, const char *text)
{
    const struct run_lock_owner owner = read_text(text);
    report_error("%s is in use by process %" PRId64 " on %s%s%s since %s; wait for it, stop it "
                 "with `tremie stop %s`, or take the folder away from it with --take-over",
                 lock->folder, owner.process, owner.host[0] != '\0' ? owner.host : "some host",
                 owner.job[0] != '\0' ? ", job " : "", owner.job, owner.since, lock->folder);
}

/* -------------------------------------------------------------------------------- taking */

/* The lock under another name; 0 or the error. */
static int prepare(struct run_lock *lock)
{
    const struct run_lock_owner self = describe_self();
    char *text = write_text(&self);
    memcpy(lock->token, self.token, sizeof lock->token);
    lock->temporary = file_temporary(lock->path, lock->token);
    lock->file = open(lock->temporary, O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    lock->beat_at = (off_t)strlen(text);
    int error = lock->file < 0 ? errno : 0;
    if (error == 0 && (pwrite(lock->file, text, strlen(text), 0) != (ssize_t)strlen(text) ||
                       pwrite(lock->file, "000000000000\n", 13, lock->beat_at) != 13 ||
                       fsync(lock->file) != 0))
        error = errno != 0 ? errno : ENOSPC;
    free(text);
    return error;
}

/* Gives the lock its name if there is none yet; 0, EEXIST or another error. */
static int put_new(struct run_lock *lock)
{
    struct stat state;
    const int error = link(lock->temporary, lock->path) == 0 ? 0 : errno;
    /* NFS may report that to have failed which was done. */
    if (error == 0 || (fstat(lock->file, &state) == 0 && state.st_nlink == 2)) {
        unlink(lock->temporary);
        return 0;
    }
    if (error != EPERM && error != EOPNOTSUPP && error != ENOSYS)
        return error;
    /* No links here: claim the name, then fill it. */
    const int claim = open(lock->path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (claim < 0)
        return errno;
    close(claim);
    return rename(lock->temporary, lock->path) != 0 ? errno : 0;
}

/* Puts the lock in the place of the one with this text, NULL: an empty one.  Returns 0, EAGAIN
 * when that is not there any more, or another error. */
static int put_over(struct run_lock *lock, const char *text)
{
    const int folder = open(lock->folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0)
        return errno;
    const bool guarded = flock(folder, LOCK_EX) == 0;
    char *now = read_lock(lock->path);
    char was[RUN_LOCK_TOKEN] = "", is[RUN_LOCK_TOKEN] = "";
    if (text != NULL)
        find_value(text, "token", was, sizeof was);
    if (now != NULL)
        find_value(now, "token", is, sizeof is);
    int error = (now == NULL) != (text == NULL) || strcmp(was, is) != 0 ? EAGAIN : 0;
    if (error == 0 && rename(lock->temporary, lock->path) != 0)
        error = errno;
    free(now);
    close(folder); /* which ends the kernel's lock */
    if (error == 0 && !guarded) {
        wait_for(1.0);
        error = run_lock_is_ours(lock) ? 0 : EAGAIN;
    }
    return error;
}

/* Tries once; 0, EAGAIN or ENOENT when another try may help, EBUSY when it is held, or another
 * error. */
static int try_to_take(struct run_lock *lock, bool take_over)
{
    int error = put_new(lock);
    if (error != EEXIST)
        return error;
    char *text = read_lock(lock->path);
    if (text != NULL && !take_over && !is_dead(lock, text)) {
        char *now = read_lock(lock->path);
        error = now == NULL ? EAGAIN : EBUSY;
        if (error == EBUSY)
            refuse(lock, now);
        free(now);
    } else {
        error = access(lock->path, F_OK) != 0 ? EAGAIN : put_over(lock, text);
        if (error == 0 && take_over && text != NULL) {
            report_warn("%s is taken over from process %" PRId64 " on %s", lock->folder,
                        read_text(text).process, read_text(text).host);
            wait_for(LOOKS_WITHIN); /* if it lives it lets go now */
        }
    }
    free(text);
    return error;
}

/* -------------------------------------------------------------------------------- heart */

static void *beat(void *argument)
{
    struct run_lock *lock = argument;
    struct timespec next;
    clock_gettime(CLOCK_MONOTONIC, &next);
    pthread_mutex_lock(&lock->mutex);
    for (long long n = 1; !lock->ends; n++) {
        char text[32];
        next.tv_sec += (time_t)INTERVAL;
        while (!lock->ends &&
               pthread_cond_timedwait(&lock->end, &lock->mutex, &next) != ETIMEDOUT)
            ;
        if (lock->ends)
            break;
        pthread_mutex_unlock(&lock->mutex);
        snprintf(text, sizeof text, "%012lld", n);
        /* A heart that cannot write stands still: that is what it is for. */
        if (pwrite(lock->file, text, 12, lock->beat_at) == 12)
            (void)fdatasync(lock->file);
        pthread_mutex_lock(&lock->mutex);
    }
    pthread_mutex_unlock(&lock->mutex);
    return NULL;
}

/* Signals are for the thread that steps. */
static void start_heart(struct run_lock *lock)
{
    sigset_t all, before;
    pthread_condattr_t clock;
    pthread_condattr_init(&clock);
    pthread_condattr_setclock(&clock, CLOCK_MONOTONIC);
    pthread_mutex_init(&lock->mutex, NULL);
    pthread_cond_init(&lock->end, &clock);
    pthread_condattr_destroy(&clock);
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    lock->beats = pthread_create(&lock->heart, NULL, beat, lock) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    if (!lock->beats)
        report_warn("no thread for the heartbeat of %s: another host may take the run for dead",
                    lock->path);
}

static void stop_heart(struct run_lock *lock)
{
    if (!lock->beats)
        return;
    pthread_mutex_lock(&lock->mutex);
    lock->ends = true;
    pthread_cond_signal(&lock->end);
    pthread_mutex_unlock(&lock->mutex);
    pthread_join(lock->heart, NULL);
    pthread_cond_destroy(&lock->end);
    pthread_mutex_destroy(&lock->mutex);
}

/* -------------------------------------------------------------------------------- whole */

static void destroy(struct run_lock *lock)
{
    if (lock->file >= 0)
        close(lock->file);
    free(lock->folder);
    free(lock->path);
    free(lock->temporary);
    free(lock);
}

/* The file under another name, which an owner that clears up may also have removed. */
static void forget(struct run_lock *lock)
{
    if (lock->file < 0)
        return;
    close(lock->file);
    unlink(lock->temporary);
    free(lock->temporary);
    lock->temporary = NULL;
    lock->file = -1;
}

struct run_lock *run_lock_take(const char *folder, bool take_over, int *status)
{
    struct run_lock *lock = array_allocate(1, sizeof *lock);
    *lock = (struct run_lock){
        .folder = array_string(folder), .path = array_format("%s/lock", folder), .file = -1};
    int error = EAGAIN;
    for (int k = 0; k < TRIES && (error == EAGAIN || error == ENOENT); k++) {
        forget(lock);
        error = prepare(lock);
        if (error == 0)
            error = try_to_take(lock, take_over);
    }
    *status = error == 0 ? REPORT_FINISHED : error == EBUSY ? REPORT_BAD_INPUT : REPORT_STORAGE;
    if (error == 0) {
        start_heart(lock);
        return lock;
    }
    if (error != EBUSY)
        report_error("cannot write to %s: %s; name another folder with --out", folder,
                     strerror(error));
    forget(lock);
    destroy(lock);
    return NULL;
}

const char *run_lock_token(const struct run_lock *lock)
{
    return lock->token;
}

bool run_lock_is_ours(const struct run_lock *lock)
{
    struct run_lock_owner owner;
    return run_lock_read(lock->folder, &owner) && strcmp(owner.token, lock->token) == 0;
}

void run_lock_release(struct run_lock *lock)
{
    if (lock == NULL)
        return;
    stop_heart(lock);
    if (run_lock_is_ours(lock))
        unlink(lock->path);
    destroy(lock);
}
