/*
 * See study.h.  A variant is run like any job, by options that name its number and its folder;
 * one that is not in order leaves nothing behind.  Only rank 0 knows the sweep; the others are
 * told how many variants there are.
 */
#include "run/study.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "job/job.h"
#include "job/sweep.h"
#include "job/yaml_tree.h"
#include "run/check.h"
#include "run/drive.h"
#include "run/intake.h"
#include "run/options.h"
#include "store/file.h"
#include "store/study_file.h"

/* ------------------------------------------------------------------------------- one job */

/* Makes the study's folder with the list of its variants, on one rank. */
static int list_variants(const struct options *options, const struct sweep *sweep)
{
    char *folder = intake_folder(options), *name = job_name(options->job);
    const int status = study_file_write(folder, name, sweep, options->fresh);
    free(folder);
    free(name);
    return status;
}

/* `study` are the options of the study whose folder a variant finds missing, NULL: none. */
static int run_one(const struct comm *comm, const struct options *options,
                   const struct options *study, const struct sweep *sweep)
{
    struct job job = {0};
    char *text = NULL;
    int status = intake_share(comm, options, &job, &text);
    const bool runs = status == REPORT_FINISHED && options->command == OPTIONS_RUN;
    if (runs && study != NULL)
        status =
            comm_agree(comm, comm->rank == 0 ? list_variants(study, sweep) : REPORT_FINISHED);
    if (status == REPORT_FINISHED && options->command == OPTIONS_CHECK)
        check_print(&job, comm, options->advise);
    else if (status == REPORT_FINISHED)
        status = drive_run(comm, options, &job, text);
    report_log_close();
    intake_clear(&job);
    free(text);
    return status;
}

/* A variant in its folder, which rank 0 knows; the study's is made when it is the only one. */
static int run_variant(const struct comm *comm, const struct options *options,
                       const struct sweep *sweep, int variant)
{
    struct options own = *options;
    char *study = intake_folder(options), *folder = NULL;
    if (comm->rank == 0)
        folder = array_format("%s/%s", study, sweep->folders[variant - 1]);
    own.out = folder;
    own.variant = variant;
    const int status = run_one(comm, &own, options->variant > 0 ? options : NULL, sweep);
    free(folder);
    free(study);
    return status;
}

/* ------------------------------------------------------------------------------- checking */

/* A mistake that variants share. */
struct finding {
    struct mistake mistake;
    int n, first; /* variants that have it, and which is the first */
};

struct findings {
    int n, capacity;
    struct finding *list;
};

static bool same_mistake(const struct mistake *a, const struct mistake *b)
{
    return a->line == b->line && a->column == b->column && strcmp(a->text, b->text) == 0 &&
           strcmp(a->file, b->file) == 0;
}

/* Takes over the mistakes of a variant. */
static void findings_add(struct findings *findings, struct mistakes *mistakes, int variant)
{
    for (int i = 0; i < mistakes->n; i++) {
        int k = 0;
        while (k < findings->n && !same_mistake(&findings->list[k].mistake, &mistakes->list[i]))
            k++;
        if (k == findings->n) {
            ARRAY_GROW(findings->list, findings->n + 1, findings->capacity);
            const struct mistake *m = &mistakes->list[i];
            findings->list[findings->n++] = (struct finding){
                .mistake = {array_string(m->file), m->line, m->column, array_string(m->text)},
                .first = variant};
        }
        findings->list[k].n++;
    }
    mistakes_clear(mistakes);
}

/* Prints each mistake once, with the variants that have it where others have not. */
static void findings_print(struct findings *findings, int n_variants)
{
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    for (int k = 0; k < findings->n; k++) {
        const struct finding *finding = &findings->list[k];
        const struct mistake *m = &finding->mistake;
        char *whose = finding->n == n_variants ? array_string("")
                      : finding->n == 1        ? array_format(" (variant %d)", finding->first)
                                               : array_format(" (variant %d and %d more)",
                                                              finding->first, finding->n - 1);
        mistakes_add(&mistakes, m->file, m->line, m->column, "%s%s", m->text, whose);
        free(whose);
    }
    mistakes_print(&mistakes);
    mistakes_clear(&mistakes);
}

static void findings_clear(struct findings *findings)
{
    for (int k = 0; k < findings->n; k++) {
        free(findings->list[k].mistake.file);
        free(findings->list[k].mistake.text);
    }
    free(findings->list);
}

/* Reads a variant as it would be run; with `print` says what it is. */
static void check_variant(const struct options *options, const struct sweep *sweep, int variant,
                          int n_ranks, bool print, struct findings *findings)
{
    struct options own = *options;
    struct job job;
    struct mistakes mistakes;
    char *study = intake_folder(options);
    char *folder = array_format("%s/%s", study, sweep->folders[variant - 1]);
    char *values = sweep_describe(sweep, variant);
    own.out = folder;
    own.variant = variant;
    mistakes_init(&mistakes);
    const bool fine = intake_read(&job, &own, n_ranks, &mistakes);
    if (print && fine)
        report_say("variant %d: %s; %.0f steps of %.6g s, in %s", variant, values,
                   job.time.end / job.time.step, job.time.step, folder);
    else if (print)
        report_say("variant %d: %s; not in order, in %s", variant, values, folder);
    findings_add(findings, &mistakes, variant);
    intake_clear(&job);
    free(values);
    free(folder);
    free(study);
}

/* Checks all variants on one rank; returns a REPORT_ status. */
static int check_all(const struct options *options, const struct sweep *sweep, int n_ranks)
{
    struct findings findings = {0};
    for (int v = 1; v <= sweep->n_variants; v++)
        check_variant(options, sweep, v, n_ranks, options->command == OPTIONS_CHECK, &findings);
    findings_print(&findings, sweep->n_variants);
    const int status = findings.n > 0 ? REPORT_BAD_INPUT : REPORT_FINISHED;
    if (status == REPORT_FINISHED && options->command == OPTIONS_CHECK)
        report_say("%d variants; check --variant N shows the scene of one and what it warns of",
                   sweep->n_variants);
    findings_clear(&findings);
    return status;
}

/* ------------------------------------------------------------------------------- running */

static bool goes_on_after(int status)
{
    return status == REPORT_FINISHED || status == REPORT_UNSTABLE || status == REPORT_BAD_INPUT;
}

/* Is the job file as it was?  Then the next variant is one of the same study.  Says why not. */
static bool is_same_file(const char *path, const char *was)
{
    char *now = NULL;
    free(file_read(path, YAML_TREE_MAX_BYTES, &now));
    const bool same = now != NULL && strcmp(was, now) == 0;
    if (!same)
        report_error("%s has changed since the study began; give the same command again to go "
                     "on with what it is now",
                     path);
    free(now);
    return same;
}

/* The next variant, on all ranks; `text` is the job file as the study began, on rank 0. */
static int run_next(const struct comm *comm, const struct options *options,
                    const struct sweep *sweep, int variant, const char *text)
{
    int status = REPORT_FINISHED;
    if (comm->rank == 0) {
        char *values = sweep_describe(sweep, variant);
        report_say("variant %d of %d: %s", variant, sweep->n_variants, values);
        status = is_same_file(options->job, text) ? REPORT_FINISHED : REPORT_STORAGE;
        free(values);
    }
    status = comm_agree(comm, status);
    if (status == REPORT_FINISHED)
        status = comm_agree(comm, run_variant(comm, options, sweep, variant));
    return status;
}

static int run_all(const struct comm *comm, const struct options *options,
                   const struct sweep *sweep, int n_variants)
{
    int worst = REPORT_FINISHED, n_ended = 0;
    char *text = NULL;
    if (comm->rank == 0)
        free(file_read(options->job, YAML_TREE_MAX_BYTES, &text));
    for (int v = 1; v <= n_variants && goes_on_after(worst); v++) {
        const int status = run_next(comm, options, sweep, v, text != NULL ? text : "");
        n_ended += status == REPORT_FINISHED;
        worst = status > worst ? status : worst;
    }
    free(text);
    report_say("%d of %d variants have ended%s", n_ended, n_variants,
               worst == REPORT_FINISHED  ? ""
               : worst == REPORT_STOPPED ? "; the same command goes on"
                                         : "; what became of the others is said above");
    return worst;
}

/* ------------------------------------------------------------------------------- all of it */

/* The mistakes of a job whose sweep has some. */
static void print_mistakes(const struct options *options, int n_ranks,
                           struct mistakes *of_sweep)
{
    struct findings findings = {0};
    struct options own = *options;
    struct mistakes mistakes;
    struct job job;
    own.variant = 0;
    mistakes_init(&mistakes);
    findings_add(&findings, of_sweep, 0);
    (void)intake_read(&job, &own, n_ranks, &mistakes);
    findings_add(&findings, &mistakes, 0);
    findings_print(&findings, 1);
    findings_clear(&findings);
    intake_clear(&job);
}

/* Do the options go with the sweep?  Says why not. */
static bool options_fit(const struct options *options, const struct sweep *sweep)
{
    if (sweep->n_variants == 0 && options->variant > 0)
        report_error("%s has no sweep; leave out --variant", options->job);
    else if (options->variant > sweep->n_variants)
        report_error("there is no variant %d: the sweep of %s has %d, from 1 on; name one of "
                     "them",
                     options->variant, options->job, sweep->n_variants);
    else if (sweep->n_variants > 0 && options->variant == 0 && options->restart != NULL)
        report_error("--restart is for one run and %s is a study; name a --variant",
                     options->job);
    else
        return true;
    return false;
}

/* Reads the sweep on rank 0; where all of it is to run, checks it and makes the study's
 * folder. */
static int open_study(const struct comm *comm, const struct options *options,
                      struct sweep *sweep)
{
    struct mistakes mistakes;
    int status = REPORT_FINISHED;
    mistakes_init(&mistakes);
    if (!job_read_sweep(sweep, options->job, options->n_overrides, options->overrides,
                        &mistakes)) {
        print_mistakes(options, comm->n_ranks, &mistakes);
        status = REPORT_BAD_INPUT;
    } else if (!options_fit(options, sweep)) {
        status = REPORT_BAD_INPUT;
    } else if (sweep->n_variants > 0 && options->variant == 0) {
        status = check_all(options, sweep, comm->n_ranks);
        if (status == REPORT_FINISHED && options->command == OPTIONS_RUN)
            status = list_variants(options, sweep);
    }
    mistakes_clear(&mistakes);
    return status;
}

int study_run_or_check(const struct comm *comm, const struct options *options)
{
    struct sweep sweep = {0};
    int words[2] = {REPORT_FINISHED, 0};
    if (comm->rank == 0) {
        words[0] = open_study(comm, options, &sweep);
        words[1] = sweep.n_variants;
    }
    comm_broadcast(comm, words, sizeof words);
    int status = words[0];
    if (status == REPORT_FINISHED && words[1] == 0)
        status = run_one(comm, options, NULL, NULL);
    else if (status == REPORT_FINISHED && options->variant > 0)
        status = run_variant(comm, options, &sweep, options->variant);
    else if (status == REPORT_FINISHED && options->command == OPTIONS_RUN)
        status = run_all(comm, options, &sweep, words[1]);
    sweep_clear(&sweep);
    return status;
}
