/* See outside.h. */
#include "run/outside.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "store/file.h"
#include "store/run_folder.h"
#include "store/run_record.h"
#include "store/study_file.h"

struct account {
    const char *run;
    const char *state; /* see run_record_state */
    bool has_owner;
    struct run_lock_owner owner;
    struct run_record_status status;
    int64_t checkpoint, checkpoint_at; /* the newest's step, and when; -1: none */
    int n_events;
    struct run_record_event *events;
};

/* ------------------------------------------------------------------------------- looking */

static void look_for_checkpoint(struct account *account)
{
    char *folder = array_format("%s/checkpoints", account->run);
    int64_t *steps;
    const int n = file_steps(folder, &steps);
    struct stat state;
    account->checkpoint = -1;
    if (n > 0) {
        char *path = file_step_path(folder, steps[n - 1]);
        account->checkpoint = steps[n - 1];
        account->checkpoint_at = stat(path, &state) == 0 ? (int64_t)state.st_mtime : 0;
        free(path);
    }
    free(steps);
    free(folder);
}

/* False when there is no run in that folder. */
static bool look(struct account *account, const char *run)
{
    char *job = array_format("%s/job.yaml", run);
    *account = (struct account){.run = run};
    account->has_owner = run_lock_read(run, &account->owner);
    const bool there = access(job, F_OK) == 0 || account->has_owner;
    free(job);
    if (!there)
        return false;
    (void)run_record_read_status(run, &account->status);
    account->n_events = run_record_history(run, &account->events);
    account->state =
        run_record_state(run, &account->status, account->has_owner ? &account->owner : NULL);
    look_for_checkpoint(account);
    return true;
}

/* ------------------------------------------------------------------------------- people */

static const char *format_time(char text[32], int64_t at)
{
    const time_t t = (time_t)at;
    struct tm parts;
    if (localtime_r(&t, &parts) == NULL || strftime(text, 32, "%Y-%m-%d %H:%M:%S", &parts) == 0)
        text[0] = '\0';
    return text;
}

static const char *format_span(char text[32], double seconds)
{
    const long s = seconds < 1e9 ? (long)(seconds + 0.5) : 1000000000;
    snprintf(text, 32, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
    return text;
}

static void print_history(const struct account *account)
{
    char text[32], span[32];
    puts("history:");
    for (int k = 0; k < account->n_events; k++) {
        const struct run_record_event *event = &account->events[k];
        const bool last = k + 1 == account->n_events;
        printf("  %s  ", format_time(text, event->at));
        if (event->start)
            printf("step %" PRId64 ": started, %" PRId64 " ranks, first on %s%s%s\n",
                   event->step, event->ranks, event->host,
                   event->job[0] != '\0' ? ", job " : "", event->job);
        else
            printf("step %" PRId64 ": %s, after %s (status %" PRId64 ")\n", event->step,
                   event->why, format_span(span, event->seconds), event->status);
        const bool died = event->start && (last ? strcmp(account->state, "killed") == 0
                                                : account->events[k + 1].start);
        if (died)
            puts("                       killed");
    }
}

static void print_for_people(const struct account *account)
{
    const struct run_record_status *status = &account->status;
    char text[32], span[32];
    const int64_t now = (int64_t)time(NULL);
    printf("state: %s\n", account->state);
    if (account->has_owner)
        printf("process: %" PRId64 " on %s%s%s\n", account->owner.process, account->owner.host,
               account->owner.job[0] != '\0' ? ", job " : "", account->owner.job);
    if (status->state[0] != '\0') {
        printf("step: %" PRId64 " of %" PRId64 "\ntime: %.6g of %.6g s\nspheres: %" PRId64 "\n",
               status->step, status->n_steps, status->time, status->end, status->n_spheres);
        printf("rate: %.3g million particle-steps/s on %" PRId64 " ranks\n",
               status->rate * 1e-6, status->ranks);
        printf("last heard of: %s\n", format_time(text, status->since));
    }
    if (account->checkpoint >= 0)
        printf("checkpoint: step %" PRId64 ", %s ago\n", account->checkpoint,
               format_span(span, (double)(now - account->checkpoint_at)));
    if (strcmp(account->state, "running") == 0 && status->left >= 0.0)
        printf("remaining: %s, until %s\n", format_span(span, status->left),
               format_time(text, status->since + (int64_t)status->left));
    print_history(account);
}

/* ------------------------------------------------------------------------------- JSON */

static void put_string(const char *name, const char *text)
{
    printf("\"%s\": \"", name);
    for (const unsigned char *c = (const unsigned char *)text; *c != '\0'; c++) {
        if (*c == '"' || *c == '\\')
            printf("\\%c", *c);
        else if (*c < 0x20)
            printf("\\u%04x", *c);
        else
            putchar(*c);
    }
    putchar('"');
}

static void put_event(const struct run_record_event *event)
{
    printf("    {\"event\": \"%s\", \"at\": %" PRId64 ", \"step\": %" PRId64,
           event->start ? "start" : "end", event->at, event->step);
    if (event->start) {
        printf(", \"ranks\": %" PRId64 ", \"process\": %" PRId64 ", ", event->ranks,
               event->process);
        put_string("host", event->host);
        printf(", ");
        put_string("job", event->job);
    } else {
        printf(", \"status\": %" PRId64 ", \"seconds\": %g, \"checkpoint_seconds\": %g, ",
               event->status, event->seconds, event->cost);
        put_string("why", event->why);
    }
    putchar('}');
}

static void print_json(const struct account *account)
{
    const struct run_record_status *status = &account->status;
    printf("{\n  ");
    put_string("run", account->run);
    printf(",\n  ");
    put_string("state", account->state);
    printf(",\n  \"step\": %" PRId64 ", \"n_steps\": %" PRId64
           ", \"time\": %.9g, \"end\": %.9g,\n  \"spheres\": %" PRId64 ", \"ranks\": %" PRId64
           ", \"rate\": %.4g, \"seconds_left\": ",
           status->step, status->n_steps, status->time, status->end, status->n_spheres,
           status->ranks, status->rate);
    if (status->left >= 0.0)
        printf("%.0f", status->left);
    else
        printf("null");
    printf(", \"updated\": %" PRId64 ",\n  \"checkpoint\": ", status->since);
    if (account->checkpoint >= 0)
        printf("{\"step\": %" PRId64 ", \"at\": %" PRId64 "}", account->checkpoint,
               account->checkpoint_at);
    else
        printf("null");
    printf(",\n  \"owner\": ");
    if (account->has_owner) {
        printf("{\"process\": %" PRId64 ", ", account->owner.process);
        put_string("host", account->owner.host);
        printf(", ");
        put_string("job", account->owner.job);
        putchar('}');
    } else {
        printf("null");
    }
    printf(",\n  \"history\": [");
    for (int k = 0; k < account->n_events; k++) {
        puts(k > 0 ? "," : "");
        put_event(&account->events[k]);
    }
    printf("]\n}");
}

static int run_status(const char *run, bool json)
{
    struct account account;
    if (!look(&account, run)) {
        report_error("there is no run in %s; name the folder of a run or a study", run);
        return REPORT_BAD_INPUT;
    }
    if (json)
        print_json(&account);
    else
        print_for_people(&account);
    if (json)
        putchar('\n');
    free(account.events);
    return REPORT_FINISHED;
}

/* ------------------------------------------------------------------------------- studies */

/* A variant's run in short; one that has not begun is `not started`. */
static void print_variant(const struct account *account, const struct sweep *sweep, int variant)
{
    const struct run_record_status *status = &account->status;
    char *values = sweep_describe(sweep, variant);
    char span[32];
    printf("variant %d: %s", variant, account->state);
    if (status->n_steps > 0)
        printf(", step %" PRId64 " of %" PRId64, status->step, status->n_steps);
    if (strcmp(account->state, "running") == 0 && status->left >= 0.0)
        printf(", %s left", format_span(span, status->left));
    printf("; %s, in %s\n", values, sweep->folders[variant - 1]);
    free(values);
}

static void print_variant_json(const struct account *account, const struct sweep *sweep,
                               int variant)
{
    printf("%s\n{\"variant\": %d, \"values\": {", variant > 1 ? "," : "", variant);
    for (int k = 0; k < sweep->n_keys; k++) {
        printf("%s", k > 0 ? ", " : "");
        put_string(sweep->names[k], sweep_value(sweep, variant, k));
    }
    printf("}, \"status\": ");
    print_json(account);
    putchar('}');
}

/* How many variants are in each state. */
static void print_states(int n, char *const *states)
{
    bool first = true;
    for (int i = 0; i < n; i++) {
        int count = 0, before = 0;
        for (int k = 0; k < n; k++) {
            count += strcmp(states[k], states[i]) == 0;
            before += k < i && strcmp(states[k], states[i]) == 0;
        }
        if (before > 0)
            continue;
        printf("%s%d %s", first ? "" : ", ", count, states[i]);
        first = false;
    }
    printf(" of %d variants\n", n);
}

static int study_status(const char *study, bool json)
{
    struct sweep sweep;
    const int status = study_file_read(study, &sweep);
    if (status != REPORT_FINISHED)
        return status;
    char **states = array_allocate((size_t)sweep.n_variants, sizeof *states);
    if (json) {
        printf("{");
        put_string("study", study);
        printf(", \"variants\": [");
    }
    for (int v = 1; v <= sweep.n_variants; v++) {
        char *run = array_format("%s/%s", study, sweep.folders[v - 1]);
        struct account account;
        if (!look(&account, run))
            account = (struct account){.run = run, .state = "not started", .checkpoint = -1};
        if (json)
            print_variant_json(&account, &sweep, v);
        else
            print_variant(&account, &sweep, v);
        states[v - 1] = array_string(account.state);
        free(account.events);
        free(run);
    }
    if (json)
        puts("]}");
    else
        print_states(sweep.n_variants, states);
    for (int v = 0; v < sweep.n_variants; v++)
        free(states[v]);
    free(states);
    sweep_clear(&sweep);
    return REPORT_FINISHED;
}

int outside_status(const char *run, bool json)
{
    return study_file_is_there(run) ? study_status(run, json) : run_status(run, json);
}

/* ------------------------------------------------------------------------------- stopping */

static int stop_run(const char *run)
{
    struct account account;
    if (!look(&account, run)) {
        report_error("there is no run in %s; name the folder of a run or a study", run);
        return REPORT_BAD_INPUT;
    }
    int status = REPORT_FINISHED;
    if (!account.has_owner || !run_record_lives(run, &account.owner)) {
        report_say("nothing runs in %s: there is nothing to stop", run);
    } else {
        char *stop = array_format("%s/stop", run);
        status = run_folder_write_file(stop, "stop\n");
        if (status == REPORT_FINISHED)
            report_say("asked the run in %s to stop with a checkpoint", run);
        free(stop);
    }
    free(account.events);
    return status;
}

/* Asks what runs of a study to stop. */
static int stop_study(const char *study)
{
    struct sweep sweep;
    int status = study_file_read(study, &sweep), n = 0;
    for (int v = 0; v < sweep.n_variants && status == REPORT_FINISHED; v++) {
        char *run = array_format("%s/%s", study, sweep.folders[v]);
        struct run_lock_owner owner;
        if (run_lock_read(run, &owner) && run_record_lives(run, &owner)) {
            status = stop_run(run);
            n++;
        }
        free(run);
    }
    if (status == REPORT_FINISHED && n == 0)
        report_say("nothing runs in %s: there is nothing to stop", study);
    sweep_clear(&sweep);
    return status;
}

int outside_stop(const char *run)
{
    return study_file_is_there(run) ? stop_study(run) : stop_run(run);
}
