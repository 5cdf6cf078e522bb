/*
 * See drive.h.  The loop steps, saves when a checkpoint is due, shows progress, and ends for
 * one of four reasons: the end is reached, somebody asked to stop, something failed, the disk
 * does not take it.
 */
#include "run/drive.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "base/timer.h"
#include "job/job.h"
#include "model/solid_mesh.h"
#include "run/control.h"
#include "run/inflow.h"
#include "run/intake.h"
#include "run/options.h"
#include "run/simulation.h"
#include "run/step.h"
#include "run/survey.h"
#include "run/wall_limit.h"
#include "store/checkpoint.h"
#include "store/run_folder.h"
#include "store/run_record.h"

/* Seconds between looks for the stop file, progress reports, and lines that stay. */
static const double LOOKS_EVERY = 0.1, CHORES_EVERY = 1.0, LINES_EVERY = 30.0;

static const char *const STOPS[] = {
    [WATCH_GO_ON] = "",
    [WATCH_STOP_FILE] = "as asked",
    [WATCH_STOP_SIGNAL] = "by a signal",
    [WATCH_STOP_TIME] = "before the wall time ends",
    [WATCH_STOP_LOST] = "",
};

struct drive {
    const struct comm *comm;
    const struct options *options;
    const struct job *job;
    const char *job_text;
    struct run_folder folder; /* open on rank 0 */
    bool resumes;
    bool ended; /* nothing is left to do */
    struct simulation sim;
    int64_t first_step; /* of this process */
    double started, look_at, chores_at, line_at;
    double overlap; /* largest over radius since this process began */
    char *stop_path;
};

/* Only rank 0 holds the folder, but all ranks write into the checkpoint's file. */
static void share_path(struct drive *drive)
{
    char *path = drive->folder.path;
    int64_t size = path != NULL ? (int64_t)strlen(path) + 1 : 0;
    comm_broadcast(drive->comm, &size, sizeof size);
    if (drive->comm->rank != 0)
        drive->folder.path = path = array_allocate((size_t)size, 1);
    comm_broadcast(drive->comm, path, (size_t)size);
    comm_broadcast(drive->comm, drive->folder.tag, sizeof drive->folder.tag);
}

/* A checkpoint that was asked for by name must be one, before anything is made. */
static int look_at_restart(const char *path)
{
    struct checkpoint header = {0};
    char *why = NULL;
    if (path == NULL)
        return REPORT_FINISHED;
    if (!checkpoint_read_header(path, &header, &why)) {
        report_error("cannot use the checkpoint %s: %s; name another one", path, why);
        free(why);
        return REPORT_BAD_INPUT;
    }
    checkpoint_clear(&header);
    return REPORT_FINISHED;
}

static int open_folder(struct drive *drive)
{
    int words[2] = {REPORT_FINISHED, 0};
    drive->folder = (struct run_folder){.path = NULL};
    if (drive->comm->rank == 0)
        words[0] = look_at_restart(drive->options->restart);
    if (drive->comm->rank == 0 && words[0] == REPORT_FINISHED) {
        char *path = intake_folder(drive->options);
        bool resumes = false;
        words[0] = run_folder_open(&drive->folder, path, drive->job_text,
                                   (drive->options->fresh ? RUN_FOLDER_FRESH : 0) |
                                       (drive->options->take_over ? RUN_FOLDER_TAKE_OVER : 0),
                                   &resumes);
        words[1] = resumes;
        if (words[0] == REPORT_FINISHED) {
            char *log = array_format("%s/log", path);
            words[0] = report_log_open(log) ? REPORT_FINISHED : REPORT_STORAGE;
            drive->stop_path = array_format("%s/stop", path);
            (void)unlink(drive->stop_path); /* what was asked of an earlier process */
            free(log);
        }
        free(path);
    }
    comm_broadcast(drive->comm, words, sizeof words);
    drive->resumes = words[1] != 0;
    if (words[0] == REPORT_FINISHED)
        share_path(drive);
    return words[0];
}

static void describe_run(const struct drive *drive)
{
    char host[128] = "";
    (void)gethostname(host, sizeof host - 1);
    report_note("tremie %s, %d ranks, first on %s, kernel %s", TREMIE_VERSION,
                drive->comm->n_ranks, host, isa_name(drive->sim.kernel.isa));
}

/* Does the checkpoint belong to this job?  On rank 0, which says what differs. */
static int compare_job(const struct drive *drive, const char *path)
{
    struct checkpoint header = {0};
    char *why = NULL, *difference = NULL;
    if (!checkpoint_read_header(path, &header, &why)) {
        free(why); /* reading all of it says why */
        return REPORT_FINISHED;
    }
    difference = job_difference(header.job_text, drive->job_text);
    if (difference != NULL)
        report_error("%s was written by another job (%s); run the job that it belongs to", path,
                     difference);
    const int status = difference != NULL ? REPORT_BAD_INPUT : REPORT_FINISHED;
    free(difference);
    checkpoint_clear(&header);
    return status;
}

/* Tries one checkpoint; the path is rank 0's. */
static int try_checkpoint(struct drive *drive, const char *path)
{
    char shared[4096] = "";
    int status = REPORT_FINISHED;
    if (drive->comm->rank == 0) {
        snprintf(shared, sizeof shared, "%s", path);
        status = compare_job(drive, path);
    }
    status = comm_agree(drive->comm, status);
    if (status != REPORT_FINISHED)
        return status;
    comm_broadcast(drive->comm, shared, sizeof shared);
    return simulation_restart(&drive->sim, drive->comm, drive->job, drive->options->isa,
                              shared);
}

/* Resumes from the newest checkpoint that reads back well; *found tells whether there was
 * any. */
static int resume(struct drive *drive, bool *found)
{
    int64_t *steps = NULL;
    int64_t n = drive->comm->rank == 0 ? run_folder_checkpoints(&drive->folder, &steps) : 0;
    comm_broadcast(drive->comm, &n, sizeof n);
    int status = n < 0 ? REPORT_STORAGE : REPORT_FINISHED;
    *found = false;
    for (int64_t k = 0; k < n && !*found; k++) {
        char *path = drive->comm->rank == 0
                         ? run_folder_checkpoint_path(&drive->folder, steps[k])
                         : NULL;
        status = try_checkpoint(drive, path);
        *found = status == REPORT_FINISHED;
        if (!*found && k + 1 < n)
            report_warn("%s is not used; trying the checkpoint before it", path);
        free(path);
    }
    free(steps);
    if (n > 0 && !*found)
        report_error("none of the %lld checkpoints can be used; start over with --fresh",
                     (long long)n);
    return *found || n == 0 ? REPORT_FINISHED : status;
}

/* Is there nothing left to do?  Only with the rows of the last instant has a run ended: it may
 * have been killed after its last checkpoint. */
static bool has_ended(const struct drive *drive)
{
    const struct simulation *sim = &drive->sim;
    int ended = sim->step > sim->n_steps;
    if (drive->comm->rank == 0 && sim->step == sim->n_steps) {
        char *path = run_folder_series_path(&drive->folder, sim->n_steps + 1);
        ended = access(path, F_OK) == 0;
        free(path);
    }
    comm_broadcast(drive->comm, &ended, sizeof ended);
    return ended != 0;
}

/* The simulation, from a named checkpoint, the newest good one, or the scene; there is none
 * after a failure. */
static int prepare(struct drive *drive)
{
    bool found = false;
    int status = REPORT_FINISHED;
    if (drive->options->restart != NULL) {
        status = try_checkpoint(drive, drive->options->restart);
        found = status == REPORT_FINISHED;
    } else if (drive->resumes) {
        status = resume(drive, &found);
    }
    if (status != REPORT_FINISHED)
        return status;
    if (!found)
        status = simulation_create(&drive->sim, drive->comm, drive->job, drive->options->isa);
    if (status != REPORT_FINISHED)
        return status;
    describe_run(drive);
    survey_warn(drive->job, &drive->sim.bodies, &drive->sim.spheres, drive->comm);
    if (drive->comm->rank == 0)
        inflow_warn(drive->job, &drive->sim.bodies);
    if (found)
        report_say("resumes at step %lld (%.6g s)", (long long)drive->sim.step,
                   (double)drive->sim.step * drive->sim.dt);
    drive->ended = found && drive->options->restart == NULL && has_ended(drive);
    if (drive->comm->rank == 0 && !drive->ended)
        status = capture_open(&drive->sim, &drive->folder);
    if (drive->comm->rank == 0 && !drive->ended && status == REPORT_FINISHED)
        status = run_folder_rewind(&drive->folder, drive->sim.step);
    status = comm_agree(drive->comm, status);
    if (status != REPORT_FINISHED)
        simulation_destroy(&drive->sim);
    return status;
}

/* ------------------------------------------------------------------------------------
 * chores */

static void format_duration(char *text, size_t size, double seconds)
{
    const long s = (long)(seconds + 0.5);
    if (s < 3600)
        snprintf(text, size, "%ld:%02ld", s / 60, s % 60);
    else
        snprintf(text, size, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
}

static void write_status(const struct drive *drive, const char *state, double rate, double left)
{
    const struct simulation *sim = &drive->sim;
    struct run_record_status status = {.step = sim->step,
                                       .n_steps = sim->n_steps,
                                       .n_spheres = sim->n_spheres,
                                       .time = (double)sim->step * sim->dt,
                                       .end = (double)sim->n_steps * sim->dt,
                                       .rate = rate,
                                       .left = left,
                                       .ranks = drive->comm->n_ranks};
    snprintf(status.state, sizeof status.state, "%s", state);
    run_record_write_status(&drive->folder, &status);
}

/* Progress, status and the stop file; on rank 0. */
static void do_chores(struct drive *drive)
{
    const double now = timer_now();
    struct simulation *sim = &drive->sim;
    if (drive->comm->rank != 0 || now < drive->look_at)
        return;
    drive->look_at = now + LOOKS_EVERY;
    if (access(drive->stop_path, F_OK) == 0)
        sim->watch.stop_asked = WATCH_STOP_FILE; /* collective with the next step's reduction */
    if (now < drive->chores_at)
        return;
    drive->chores_at = now + CHORES_EVERY;
    if (run_folder_is_lost(&drive->folder)) {
        sim->watch.stop_asked = WATCH_STOP_LOST;
        return;
    }
    const double done = (double)(sim->step - drive->first_step), elapsed = now - drive->started;
    const double rate = elapsed > 0.0 ? done * (double)sim->n_spheres / elapsed : 0.0;
    const double left = done > 0.0 ? elapsed / done * (double)(sim->n_steps - sim->step) : -1.0;
    char text[32] = "unknown";
    if (left >= 0.0)
        format_duration(text, sizeof text, left);
    const bool keep = now >= drive->line_at;
    if (keep)
        drive->line_at = now + LINES_EVERY;
    report_progress(
        keep && !isatty(STDERR_FILENO),
        "step %lld of %lld, %.4g s, %.3g million particle-steps/s, overlap %.2g, imbalance "
        "%.2f, %s left",
        (long long)sim->step, (long long)sim->n_steps, (double)sim->step * sim->dt, rate * 1e-6,
        sim->watch.overlap, sim->balance.imbalance > 0.0 ? sim->balance.imbalance : 1.0, text);
    write_status(drive, "running", rate, left);
}

static bool checkpoint_is_due(struct drive *drive)
{
    struct simulation *sim = &drive->sim;
    const bool due =
        sim->watch.checkpoint_due || schedule_has_step(&sim->watch.schedule, sim->step);
    sim->watch.checkpoint_due = false;
    return due;
}

/* Does this process, rank 0, still own the folder? */
static bool is_ours(const struct drive *drive)
{
    return drive->comm->rank == 0 && run_lock_is_ours(drive->folder.lock);
}

static int save(struct drive *drive)
{
    const double began = timer_now();
    const int status = simulation_save(&drive->sim, &drive->folder, drive->job_text);
    const double now = timer_now();
    if (status == REPORT_FINISHED) {
        schedule_saved(&drive->sim.watch.schedule, now, now - began);
        if (is_ours(drive))
            report_note("checkpoint at step %lld (%.6g s) in %.3g s",
                        (long long)drive->sim.step, (double)drive->sim.step * drive->sim.dt,
                        now - began);
    } else if (is_ours(drive)) { /* else that was said */
        report_error(
            "the checkpoint of step %lld could not be written; the one before stands, make "
            "room and "
            "give the same command again",
            (long long)drive->sim.step);
    }
    return status;
}

static int loop(struct drive *drive)
{
    struct simulation *sim = &drive->sim;
    /* What a run resumes from is there already, unless it is another run's. */
    int64_t saved_at = sim->step > 0 && drive->options->restart == NULL ? sim->step : -1;
    int status = REPORT_FINISHED;
    while (sim->step < sim->n_steps && sim->watch.stop == WATCH_GO_ON &&
           sim->watch.failure == WATCH_FINE) {
        step(sim);
        status = capture_write(sim, &drive->folder);
        if (status != REPORT_FINISHED)
            return status;
        drive->overlap =
            sim->watch.overlap > drive->overlap ? sim->watch.overlap : drive->overlap;
        do_chores(drive);
        if (sim->watch.failure == WATCH_FINE && checkpoint_is_due(drive)) {
            status = save(drive);
            saved_at = sim->step;
        }
        if (status != REPORT_FINISHED)
            return status;
    }
    if (sim->watch.failure != WATCH_FINE) {
        watch_explain(&sim->watch, sim);
        return REPORT_UNSTABLE;
    }
    if (sim->watch.stop == WATCH_STOP_LOST)
        return REPORT_STORAGE;
    if (saved_at != sim->step)
        status = save(drive);
    return status;
}

/* The rows of the last instant: its forces are computed but nothing moves any more.  A run that
 * failed keeps the rows that it has; one that fails only now does not end, so that the same
 * command finds the same again. */
static int finish_series(struct drive *drive)
{
    struct simulation *sim = &drive->sim;
    if (sim->watch.failure == WATCH_FINE) {
        step_forces(sim);
        const int written = capture_write(sim, &drive->folder);
        if (written != REPORT_FINISHED)
            return written;
        if (sim->watch.failure != WATCH_FINE) {
            watch_explain(&sim->watch, sim);
            return REPORT_UNSTABLE;
        }
    }
    /* The segment is named after the step that would be next; a longer run replaces it. */
    sim->step++;
    const int status = simulation_save_series(sim, &drive->folder);
    sim->step--;
    return status;
}

/* What checkpoints took the process before. */
static void recall_cost(struct drive *drive)
{
    struct run_record_event *events;
    const int n = run_record_history(drive->folder.path, &events);
    for (int k = 0; k < n; k++)
        if (!events[k].start && events[k].cost > 0.0)
            drive->sim.watch.schedule.cost = events[k].cost;
    free(events);
}

/* Lets the run know when it has to stop. */
static void limit_time(struct drive *drive)
{
    struct schedule *schedule = &drive->sim.watch.schedule;
    const char *whose;
    const double left = wall_limit_left(drive->options->wall, &whose);
    char text[32];
    schedule_guess(schedule, drive->sim.n_spheres);
    if (drive->comm->rank != 0)
        return;
    recall_cost(drive);
    if (isinf(left))
        return;
    schedule_limit(schedule, timer_now(), left);
    format_duration(text, sizeof text, left > 0.0 ? left : 0.0);
    report_note("%s of wall time are left (%s)", text, whose);
    if (left < schedule_reserve(schedule))
        report_warn("the wall time that is left by %s, %s, is hardly enough for a checkpoint; "
                    "ask for more",
                    whose, text);
}

static void record_start(const struct drive *drive)
{
    const struct run_record_event event = {
        .start = true, .step = drive->sim.step, .ranks = drive->comm->n_ranks};
    run_record_add_event(&drive->folder, &event);
}

static void record_end(const struct drive *drive, int status, double rate, double elapsed)
{
    struct run_record_event event = {.step = drive->sim.step,
                                     .status = status,
                                     .seconds = elapsed,
                                     .cost = drive->sim.watch.schedule.cost};
    const char *state = status == REPORT_FINISHED  ? "finished"
                        : status == REPORT_STOPPED ? "stopped"
                                                   : "failed";
    snprintf(event.why, sizeof event.why, "%s%s%s", state, status == REPORT_STOPPED ? " " : "",
             status == REPORT_STOPPED ? STOPS[drive->sim.watch.stop] : "");
    write_status(drive, state, rate, status == REPORT_FINISHED ? 0.0 : -1.0);
    run_record_add_event(&drive->folder, &event);
}

static int finish(struct drive *drive, int status)
{
    struct simulation *sim = &drive->sim;
    const double elapsed = timer_now() - drive->started;
    const double done = (double)(sim->step - drive->first_step);
    char took[32];
    if (status == REPORT_FINISHED && sim->step < sim->n_steps)
        status = REPORT_STOPPED;
    if (status == REPORT_FINISHED)
        status = finish_series(drive);
    else if (status == REPORT_UNSTABLE)
        (void)finish_series(drive);
    format_duration(took, sizeof took, elapsed);
    const double rate = elapsed > 0.0 ? done * (double)sim->n_spheres / elapsed : 0.0;
    if (status == REPORT_FINISHED)
        report_say("finished at step %lld (%.6g s) after %s: %.3g million particle-steps/s, "
                   "largest overlap %.2g of a radius",
                   (long long)sim->step, (double)sim->step * sim->dt, took, rate * 1e-6,
                   drive->overlap);
    else if (status == REPORT_STOPPED)
        report_say(
            "stopped %s with a checkpoint at step %lld of %lld; the same command resumes",
            STOPS[sim->watch.stop], (long long)sim->step, (long long)sim->n_steps);
    if (is_ours(drive))
        record_end(drive, status, rate, elapsed);
    return status;
}

int drive_run(const struct comm *comm, const struct options *options, struct job *job,
              const char *job_text)
{
    struct drive drive = {.comm = comm, .options = options, .job = job, .job_text = job_text};
    int status = open_folder(&drive);
    if (status == REPORT_FINISHED) {
        status = prepare(&drive);
        solid_mesh_release(job);
        if (status == REPORT_FINISHED) {
            drive.first_step = drive.sim.step;
            drive.started = timer_now();
            limit_time(&drive);
            if (comm->rank == 0 && !drive.ended)
                record_start(&drive);
            drive.look_at = drive.chores_at = drive.started;
            drive.line_at = drive.started + LINES_EVERY;
            if (drive.ended)
                report_say("nothing to do: the run has reached its end");
            else
                status = finish(&drive, loop(&drive));
            simulation_destroy(&drive.sim);
        }
    }
    if (comm->rank == 0)
        run_folder_close(&drive.folder);
    else
        free(drive.folder.path);
    free(drive.stop_path);
    return status;
}
