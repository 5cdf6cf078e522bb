/*
 * See run_record.h.  Lines that cannot be read, as a full disk may leave them, are passed over.
 */
#include "store/run_record.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/array.h"
#include "base/process.h"
#include "store/file.h"
#include "store/run_folder.h"
#include "store/run_lock.h"

/* A run on another host that said nothing for so long is taken to be dead [s]. */
static const int64_t SILENCE = 60;

enum { STATUS_MAX = 1 << 16, HISTORY_MAX = 1 << 26 };

static char *read_file(const char *folder, const char *name, size_t limit)
{
    char *path = array_format("%s/%s", folder, name), *text = NULL;
    free(file_read(path, limit, &text));
    free(path);
    return text;
}

/* The line that begins at *next, cut off the text; NULL at the end. */
static const char *cut_line(char **next)
{
    char *line = *next;
    if (line == NULL || *line == '\0')
        return NULL;
    *next = strchr(line, '\n');
    if (*next != NULL)
        *(*next)++ = '\0';
    return line;
}

/* ------------------------------------------------------------------------------- status */

void run_record_write_status(const struct run_folder *folder,
                             const struct run_record_status *status)
{
    char left[32] = "unknown";
    if (status->left >= 0.0)
        snprintf(left, sizeof left, "%.0f s", status->left);
    char *text = array_format("state: %s\nstep: %" PRId64 " of %" PRId64
                              "\ntime: %.9g of %.9g s\nspheres: %" PRId64 "\nranks: %" PRId64
                              "\nrate: %.4g particle-steps/s\nremaining: %s\nowner: %s\n"
                              "updated: %lld\n",
                              status->state, status->step, status->n_steps, status->time,
                              status->end, status->n_spheres, status->ranks, status->rate, left,
                              folder->tag, (long long)time(NULL));
    run_folder_status(folder, text);
    free(text);
}

bool run_record_read_status(const char *folder, struct run_record_status *status)
{
    *status = (struct run_record_status){.left = -1.0};
    char *text = read_file(folder, "status", STATUS_MAX);
    char *next = text;
    for (const char *line; (line = cut_line(&next)) != NULL;)
        (void)(sscanf(line, "state: %15s", status->state) == 1 ||
               sscanf(line, "step: %" SCNd64 " of %" SCNd64, &status->step, &status->n_steps) ==
                   2 ||
               sscanf(line, "time: %lf of %lf", &status->time, &status->end) == 2 ||
               sscanf(line, "spheres: %" SCNd64, &status->n_spheres) == 1 ||
               sscanf(line, "ranks: %" SCNd64, &status->ranks) == 1 ||
               sscanf(line, "rate: %lf", &status->rate) == 1 ||
               sscanf(line, "remaining: %lf", &status->left) == 1 ||
               sscanf(line, "owner: %31s", status->owner) == 1 ||
               sscanf(line, "updated: %" SCNd64, &status->since) == 1);
    free(text);
    return status->state[0] != '\0';
}

/* ------------------------------------------------------------------------------- state */

bool run_record_lives(const char *folder, const struct run_lock_owner *owner)
{
    const enum run_lock_life life = run_lock_look_for(owner);
    if (life != RUN_LOCK_ELSEWHERE)
        return life == RUN_LOCK_LIVES;
    char *path = array_format("%s/lock", folder);
    struct stat state;
    const bool there = stat(path, &state) == 0;
    free(path);
    return there && (int64_t)time(NULL) - (int64_t)state.st_mtime < SILENCE;
}

const char *run_record_state(const char *folder, const struct run_record_status *status,
                             const struct run_lock_owner *owner)
{
    if (owner == NULL || !run_record_lives(folder, owner)) {
        const bool died = strcmp(status->state, "running") == 0 || owner != NULL;
        return died ? "killed" : status->state[0] != '\0' ? status->state : "not started";
    }
    return strcmp(status->owner, owner->token) == 0 ? status->state : "starting";
}

/* ------------------------------------------------------------------------------- history */

/* Replaces the file, so that there is no half a line in it, and none of an owner that has lost
 * the folder.  What cannot be read is left alone. */
static void append(const struct run_folder *folder, const char *line)
{
    char *path = array_format("%s/history", folder->path), *why = NULL;
    char *before = read_file(folder->path, "history", HISTORY_MAX);
    if (before != NULL || access(path, F_OK) != 0) {
        char *text = array_format("%s%s", before != NULL ? before : "", line);
        /* It only informs: a disk that fails is met by what matters. */
        (void)run_folder_replace(folder, path, text, strlen(text), &why);
        free(text);
    }
    free(why);
    free(before);
    free(path);
}

void run_record_add_event(const struct run_folder *folder, const struct run_record_event *event)
{
    char when[32] = "", host[256] = "", job[128], *line;
    const time_t now = time(NULL);
    struct tm parts;
    if (run_folder_is_lost(folder))
        return;
    if (gmtime_r(&now, &parts) != NULL)
        strftime(when, sizeof when, "%Y-%m-%dT%H:%M:%SZ", &parts);
    gethostname(host, sizeof host - 1);
    process_job(job, sizeof job);
    if (event->start)
        line = array_format("%s start step %" PRId64 " ranks %" PRId64
                            " process %ld host %s job %s\n",
                            when, event->step, event->ranks, (long)getpid(), host, job);
    else
        line = array_format(
            "%s end step %" PRId64 " status %" PRId64 " seconds %.1f checkpoint %.3g why %s\n",
            when, event->step, event->status, event->seconds, event->cost, event->why);
    append(folder, line);
    free(line);
}

static bool read_event(const char *line, struct run_record_event *event)
{
    struct tm parts = {.tm_year = 0};
    *event = (struct run_record_event){.start = false};
    const char *rest = strptime(line, "%Y-%m-%dT%H:%M:%SZ", &parts);
    if (rest == NULL)
        return false;
    event->at = (int64_t)timegm(&parts);
    event->start = strncmp(rest, " start ", 7) == 0;
    if (event->start)
        return sscanf(rest,
                      " start step %" SCNd64 " ranks %" SCNd64 " process %" SCNd64
                      " host %255s job %127[^\n]",
                      &event->step, &event->ranks, &event->process, event->host,
                      event->job) >= 4;
    return sscanf(rest,
                  " end step %" SCNd64 " status %" SCNd64
                  " seconds %lf checkpoint %lf why %63[^\n]",
                  &event->step, &event->status, &event->seconds, &event->cost, event->why) == 5;
}

int run_record_history(const char *folder, struct run_record_event **events)
{
    char *text = read_file(folder, "history", HISTORY_MAX);
    int n = 0, capacity = 0;
    *events = NULL;
    char *next = text;
    for (const char *line; (line = cut_line(&next)) != NULL;) {
        ARRAY_GROW(*events, n + 1, capacity);
        n += read_event(line, &(*events)[n]);
    }
    free(text);
    return n;
}
