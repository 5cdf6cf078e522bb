/*
 * See run_folder.h.
 *
 * A folder is looked through before anything in it is touched: one with other things than a
 * run's in it is somebody's folder, not ours.  Nor is one whose files are links, through which
 * we would write to other places, or no plain files.
 */
#include "store/run_folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "store/file.h"
#include "store/run_lock.h"

/* What a run keeps in its folder and what moves aside when it starts over; beside these the
 * lock, older set_aside_N and hidden files may be there. */
static const char *const RESULTS[] = {"job.yaml", "checkpoints", "series", "snapshots",
                                      "log",      "status",      "history"};
enum { N_RESULTS = sizeof RESULTS / sizeof *RESULTS };

static const char *const SUBFOLDERS[] = {"checkpoints", "series"};
enum { N_SUBFOLDERS = sizeof SUBFOLDERS / sizeof *SUBFOLDERS };

static const char SET_ASIDE[] = "set_aside_";

enum { JOB_TEXT_MAX = 1 << 26 };

static char *path_in(const char *folder, const char *name)
{
    return array_format("%s/%s", folder, name);
}

/* Those of them, and other names that are ours, that are folders. */
static bool is_folder(const char *name)
{
    return strcmp(name, "checkpoints") == 0 || strcmp(name, "series") == 0 ||
           strcmp(name, "snapshots") == 0;
}

static bool is_result(const char *name)
{
    for (int k = 0; k < N_RESULTS; k++)
        if (strcmp(name, RESULTS[k]) == 0)
            return true;
    return false;
}

/* Tables and pictures that people make of a run and keep beside it. */
static bool is_report(const char *name)
{
    static const char *const ends[] = {".svg", ".png", ".csv", ".txt", ".html"};
    const char *dot = strrchr(name, '.');
    for (size_t k = 0; dot != NULL && k < sizeof ends / sizeof *ends; k++)
        if (strcmp(dot, ends[k]) == 0)
            return true;
    return false;
}

static bool is_ours(const char *name)
{
    return is_result(name) || is_report(name) || strcmp(name, "lock") == 0 ||
           strcmp(name, "stop") == 0 || name[0] == '.' ||
           strncmp(name, SET_ASIDE, sizeof SET_ASIDE - 1) == 0;
}

/* ----------------------------------------------------------------------------- a first look */

struct look {
    bool exists, has_job, has_results;
    char *foreign; /* something that is not a run's, NULL when there is nothing */
    char *strange; /* a file of ours that leads elsewhere, or is none */
};

/* Is a name that we write to something else than a plain file or folder? */
static bool is_strange(int folder, const char *name)
{
    struct stat state;
    if ((!is_result(name) && strcmp(name, "lock") != 0) ||
        fstatat(folder, name, &state, AT_SYMLINK_NOFOLLOW) != 0)
        return false;
    return is_folder(name) ? !S_ISDIR(state.st_mode) : !S_ISREG(state.st_mode);
}

/* What is there?  Nothing is changed. */
static int look_at(const char *path, struct look *look)
{
    *look = (struct look){0};
    DIR *entries = opendir(path);
    if (entries == NULL && errno == ENOENT)
        return REPORT_FINISHED;
    if (entries == NULL) {
        report_error("cannot use %s as the run's folder: %s; name another one with --out", path,
                     strerror(errno));
        return errno == ENOTDIR ? REPORT_BAD_INPUT : REPORT_STORAGE;
    }
    look->exists = true;
    for (const struct dirent *entry; (entry = readdir(entries)) != NULL;) {
        look->has_job = look->has_job || strcmp(entry->d_name, "job.yaml") == 0;
        look->has_results = look->has_results || is_result(entry->d_name);
        if (!is_ours(entry->d_name) && look->foreign == NULL)
            look->foreign = array_string(entry->d_name);
        if (look->strange == NULL && is_strange(dirfd(entries), entry->d_name))
            look->strange = array_string(entry->d_name);
    }
    closedir(entries);
    return REPORT_FINISHED;
}

/* ------------------------------------------------------------------------------------- lock */

const char *run_folder_tag(const struct run_folder *folder)
{
    return folder != NULL ? folder->tag : "";
}

bool run_folder_is_lost(const struct run_folder *folder)
{
    if (folder == NULL || folder->lock == NULL || run_lock_is_ours(folder->lock))
        return false;
    report_log_close(); /* the log is the other one's */
    struct run_lock_owner owner;
    if (run_lock_read(folder->path, &owner))
        report_error("%s was taken over by process %" PRId64
                     " on %s; this one leaves and writes nothing more",
                     folder->path, owner.process, owner.host);
    else
        report_error("the lock of %s was taken away; this process leaves and writes nothing "
                     "more, start the run again",
                     folder->path);
    return true;
}

/* ---------------------------------------------------------------------------- setting aside */

/* A new folder RUN/set_aside_N; NULL, with the reason said, when there can be none. */
static char *new_aside(const struct run_folder *folder)
{
    for (int n = 1;; n++) {
        char *aside = array_format("%s/%s%d", folder->path, SET_ASIDE, n);
        if (mkdir(aside, 0777) == 0)
            return aside;
        const int error = errno;
        if (error != EEXIST) {
            report_error("cannot make %s: %s", aside, strerror(error));
            free(aside);
            return NULL;
        }
        free(aside);
    }
}

/* Moves FROM/name to TO/name; what is not there need not be moved. */
static int move(const char *from, const char *to, const char *name)
{
    char *was = path_in(from, name), *is = path_in(to, name);
    const int error = rename(was, is) != 0 && errno != ENOENT ? errno : 0;
    if (error != 0)
        report_error("cannot move %s to %s: %s", was, is, strerror(error));
    free(was);
    free(is);
    return error != 0 ? REPORT_STORAGE : REPORT_FINISHED;
}

static int set_results_aside(const struct run_folder *folder)
{
    char *aside = new_aside(folder);
    if (aside == NULL)
        return REPORT_STORAGE;
    int status = REPORT_FINISHED;
    for (int k = 0; k < N_RESULTS && status == REPORT_FINISHED; k++)
        status = move(folder->path, aside, RESULTS[k]);
    if (status == REPORT_FINISHED)
        report_say("starting over: what was in %s is now in %s", folder->path, aside);
    free(aside);
    return status;
}

/* Says why, which errno tells. */
static int cannot_read(const char *path)
{
    report_error("cannot read %s: %s; mend that and give the same command again", path,
                 strerror(errno));
    return REPORT_STORAGE;
}

/* Moves the files of RUN/name later than `step` to ASIDE/name; *aside is made when it is
 * needed. */
static int set_later_aside(const struct run_folder *folder, const char *name, int64_t step,
                           char **aside, int *n_moved)
{
    char *from = path_in(folder->path, name), *to = NULL;
    int64_t *steps;
    const int n = file_steps(from, &steps);
    int status = n < 0 ? cannot_read(from) : REPORT_FINISHED;
    for (int i = 0; i < n && status == REPORT_FINISHED; i++) {
        if (steps[i] <= step)
            continue;
        if (*aside == NULL)
            *aside = new_aside(folder);
        if (to == NULL && *aside != NULL) {
            to = path_in(*aside, name);
            (void)mkdir(to, 0777); /* where this fails so will the move, which says why */
        }
        char *path = file_step_path("", steps[i]);
        status = *aside != NULL ? move(from, to, path + 1) : REPORT_STORAGE;
        (*n_moved)++;
        free(path);
    }
    free(steps);
    free(from);
    free(to);
    return status;
}

int run_folder_rewind(const struct run_folder *folder, int64_t step)
{
    char *aside = NULL;
    int n_moved = 0;
    int status = set_later_aside(folder, "checkpoints", step, &aside, &n_moved);
    if (status == REPORT_FINISHED)
        status = set_later_aside(folder, "series", step, &aside, &n_moved);
    if (status == REPORT_FINISHED)
        status = set_later_aside(folder, "snapshots", step, &aside, &n_moved);
    if (status == REPORT_FINISHED && n_moved > 0)
        report_say("%d files of steps after %" PRId64 " are now in %s", n_moved, step, aside);
    free(aside);
    return status;
}

/* --------------------------------------------------------------------------- open and close */

static int make_folder(const char *path)
{
    char *why = file_make_folders(path);
    if (why != NULL)
        report_error("cannot make the folder %s: %s; name another one with --out", path, why);
    const int status = why != NULL ? REPORT_STORAGE : REPORT_FINISHED;
    free(why);
    return status;
}

static int make_subfolders(const char *path)
{
    int status = REPORT_FINISHED;
    for (int k = 0; k < N_SUBFOLDERS && status == REPORT_FINISHED; k++) {
        char *subfolder = path_in(path, SUBFOLDERS[k]);
        status = make_folder(subfolder);
        free(subfolder);
    }
    return status;
}

/* Does the folder hold this job?  Says why not. */
static int compare_job(const struct run_folder *folder, const char *job_text)
{
    char *path = path_in(folder->path, "job.yaml"), *was = NULL;
    char *why = file_read(path, JOB_TEXT_MAX, &was);
    if (why != NULL) {
        report_error(
            "cannot read %s: %s; name another folder with --out, or start over with --fresh",
            path, why);
        free(why);
        free(path);
        return REPORT_STORAGE;
    }
    char *difference = job_difference(was, job_text);
    if (difference != NULL)
        report_error(
            "%s belongs to another job: %s; name another folder with --out, or start over with "
            "--fresh, which sets the results there aside",
            folder->path, difference);
    const int status = difference != NULL ? REPORT_BAD_INPUT : REPORT_FINISHED;
    free(difference);
    free(was);
    free(path);
    return status;
}

static void remove_temporaries(const struct run_folder *folder)
{
    file_remove_temporaries(folder->path);
    for (int k = 0; k < N_SUBFOLDERS; k++) {
        char *path = path_in(folder->path, SUBFOLDERS[k]);
        file_remove_temporaries(path);
        free(path);
    }
    char *snapshots = path_in(folder->path, "snapshots");
    file_remove_temporaries(snapshots);
    free(snapshots);
}

static int put_job(const struct run_folder *folder, const char *job_text)
{
    char *path = path_in(folder->path, "job.yaml"), *why;
    const bool done = run_folder_replace(folder, path, job_text, strlen(job_text), &why);
    if (why != NULL)
        report_error(
            "cannot write %s: %s; free some space or mend the disk and run the command again",
            path, why);
    free(why);
    free(path);
    return done ? REPORT_FINISHED : REPORT_STORAGE;
}

/* With the lock held: brings the folder's content in line with the job. */
static int settle(const struct run_folder *folder, const struct look *look,
                  const char *job_text, bool fresh, bool *resumes)
{
    int status = REPORT_FINISHED;
    if (fresh && look->has_results)
        status = set_results_aside(folder);
    else if (look->has_job)
        status = compare_job(folder, job_text);
    if (status == REPORT_FINISHED)
        status = make_subfolders(folder->path);
    if (status == REPORT_FINISHED)
        remove_temporaries(folder);
    if (status == REPORT_FINISHED)
        status = put_job(folder, job_text);
    *resumes = status == REPORT_FINISHED && look->has_job && !fresh;
    return status;
}

/* Can a run live here?  Says why not; nothing has been changed. */
static int judge(const char *path, const struct look *look, bool fresh)
{
    if (look->foreign != NULL) {
        report_error(
            "%s holds other things than a run (%s); name a new or empty folder with --out",
            path, look->foreign);
        return REPORT_BAD_INPUT;
    }
    if (look->strange != NULL) {
        report_error("%s/%s is %s; a run writes to nothing outside its folder: remove it, or "
                     "name another folder with --out",
                     path, look->strange,
                     is_folder(look->strange) ? "no folder of its own" : "no plain file");
        return REPORT_BAD_INPUT;
    }
    if (look->has_results && !look->has_job && !fresh) {
        char *checkpoints = path_in(path, "checkpoints");
        int64_t *steps;
        const int n = file_steps(checkpoints, &steps);
        free(steps);
        free(checkpoints);
        if (n != 0) {
            report_error(
                "%s holds checkpoints but no job.yaml that says of what; name another folder "
                "with --out, or start over with --fresh, which sets them aside",
                path);
            return REPORT_BAD_INPUT;
        }
    }
    return REPORT_FINISHED;
}

static int inspect(const char *path, bool fresh, struct look *look)
{
    int status = look_at(path, look);
    if (status == REPORT_FINISHED)
        status = judge(path, look, fresh);
    free(look->foreign);
    free(look->strange);
    return status;
}

int run_folder_open(struct run_folder *folder, const char *path, const char *job_text, int how,
                    bool *resumes)
{
    const bool fresh = (how & RUN_FOLDER_FRESH) != 0;
    *folder = (struct run_folder){.path = array_string(path)};
    *resumes = false;
    struct look look;
    int status = inspect(path, fresh, &look);
    if (status == REPORT_FINISHED && !look.exists)
        status = make_folder(path);
    if (status == REPORT_FINISHED)
        folder->lock = run_lock_take(path, (how & RUN_FOLDER_TAKE_OVER) != 0, &status);
    if (folder->lock != NULL)
        snprintf(folder->tag, sizeof folder->tag, "%s", run_lock_token(folder->lock));
    if (status == REPORT_FINISHED) /* once more: another run may have come and gone */
        status = inspect(path, fresh, &look);
    if (status == REPORT_FINISHED)
        status = settle(folder, &look, job_text, fresh, resumes);
    if (status != REPORT_FINISHED)
        run_folder_close(folder);
    return status;
}

void run_folder_close(struct run_folder *folder)
{
    run_lock_release(folder->lock);
    free(folder->path);
    *folder = (struct run_folder){.path = NULL};
}

/* -------------------------------------------------------------------------------- its files */

static char *step_path(const struct run_folder *folder, const char *name, int64_t step)
{
    char *parent = path_in(folder->path, name), *path = file_step_path(parent, step);
    free(parent);
    return path;
}

char *run_folder_checkpoint_path(const struct run_folder *folder, int64_t step)
{
    return step_path(folder, "checkpoints", step);
}

char *run_folder_series_path(const struct run_folder *folder, int64_t step)
{
    return step_path(folder, "series", step);
}

int run_folder_checkpoints(const struct run_folder *folder, int64_t **steps)
{
    char *path = path_in(folder->path, "checkpoints");
    const int n = file_steps(path, steps);
    if (n < 0)
        (void)cannot_read(path);
    free(path);
    for (int i = 0; i < n / 2; i++) {
        const int64_t step = (*steps)[i];
        (*steps)[i] = (*steps)[n - 1 - i];
        (*steps)[n - 1 - i] = step;
    }
    return n;
}

void run_folder_prune(const struct run_folder *folder, int keep)
{
    CHECK(keep > 0, "%d checkpoints to keep", keep);
    int64_t *steps;
    const int n = run_folder_checkpoints(folder, &steps);
    for (int i = keep; i < n; i++) {
        char *path = run_folder_checkpoint_path(folder, steps[i]);
        if (unlink(path) != 0)
            report_warn("cannot remove the old checkpoint %s: %s", path, strerror(errno));
        free(path);
    }
    free(steps);
}

bool run_folder_replace(const struct run_folder *folder, const char *path, const void *bytes,
                        size_t n, char **why)
{
    char *temporary = file_temporary(path, run_folder_tag(folder));
    *why = file_prepare(temporary, bytes, n);
    bool done = *why == NULL && !run_folder_is_lost(folder);
    if (done) {
        *why = file_publish(temporary, path);
        done = *why == NULL;
    }
    if (!done)
        unlink(temporary);
    /* Who has lost the folder misses files that the new owner cleared away. */
    if (*why != NULL && run_folder_is_lost(folder)) {
        free(*why);
        *why = NULL;
    }
    free(temporary);
    return done;
}

void run_folder_status(const struct run_folder *folder, const char *text)
{
    if (run_folder_is_lost(folder))
        return;
    char *path = path_in(folder->path, "status"),
         *temporary = file_temporary(path, folder->tag);
    FILE *stream = fopen(temporary, "we");
    if (stream != NULL) {
        const bool written = fputs(text, stream) >= 0;
        /* Not forced to the disk: it is for the living, and comes often. */
        if (fclose(stream) == 0 && written)
            (void)rename(temporary, path);
    }
    free(path);
    free(temporary);
}

int run_folder_write_file(const char *path, const char *text)
{
    char *why = file_write(path, text, strlen(text));
    if (why == NULL)
        return REPORT_FINISHED;
    report_error(
        "cannot write %s: %s; free some space or mend the disk and run the command again", path,
        why);
    free(why);
    return REPORT_STORAGE;
}
