/*
 * tremie-study: the variants of a study side by side, what varies and what came of it.
 *
 * Results are columns of the runs' samples, each as one number: its last value, its mean, a
 * rate.  Variants are read one after the other, and what is kept of each is a row; a variant
 * that has not run, or has no such column, leaves its cells empty.
 */
#include <fnmatch.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "base/array.h"
#include "base/report.h"
#include "records.h"
#include "sheet.h"
#include "steady.h"
#include "store/file.h"
#include "store/run_lock.h"
#include "store/run_record.h"
#include "store/study_file.h"

enum { NOTHING_TO_SHOW = 1 };

enum how { HOW_LAST, HOW_MEAN, HOW_MIN, HOW_MAX, HOW_RATE, HOW_STEADY, HOW_LOW, HOW_HIGH };

/* How headings and --results call them; the last two come with HOW_STEADY. */
static const char *const HOWS[] = {"last", "mean",   "min",        "max",
                                   "rate", "steady", "steady_low", "steady_high"};
enum { N_WISHED = HOW_STEADY + 1 };

static const char STANDARD[] = "overlap_max:max,balance,*.mass_forward";

/* One of --results. */
struct wish {
    char *pattern;
    enum how how;
    bool met; /* some variant has such a column */
};

struct column {
    char *name, *unit;
    enum how how;
};

struct row {
    char state[16];
    bool has_status, has_time;
    int64_t step;
    double time;                 /* simulated [s] */
    double wall, particle_steps; /* of the steps that stand; wall [s] */
    int n_values;                /* of the columns there were when it was read */
    double *values;
};

struct study {
    const char *path;
    double from, to; /* window of the samples [s] */
    struct sweep sweep;
    char **units; /* of the values of each key; NULL: they are words */
    int n_wishes, wish_capacity, n_columns, column_capacity;
    struct wish *wishes;
    struct column *columns;
    struct row *rows;
};

/* ------------------------------------------------------------------------------- wishes */

static bool add_wish(struct study *study, const char *text, int length)
{
    char *pattern = array_format("%.*s", length, text), *colon = strrchr(pattern, ':');
    struct wish wish = {.pattern = pattern, .how = HOW_LAST};
    bool known = colon == NULL;
    for (int how = 0; colon != NULL && how < N_WISHED; how++) {
        if (strcmp(colon + 1, HOWS[how]) != 0)
            continue;
        wish.how = (enum how)how;
        known = true;
    }
    ARRAY_GROW(study->wishes, study->n_wishes + 1, study->wish_capacity);
    study->wishes[study->n_wishes++] = wish;
    if (!known)
        report_error("--results: \"%s\" is no way to make a number of samples; choose one of "
                     "last, mean, min, max, rate, steady",
                     colon + 1);
    if (colon != NULL)
        *colon = '\0';
    return known;
}

static bool read_wishes(struct study *study, const char *list)
{
    bool fine = true;
    for (const char *part = list; part != NULL && fine;) {
        const int length = (int)strcspn(part, ",");
        fine = add_wish(study, part, length);
        part = part[length] == ',' ? part + length + 1 : NULL;
    }
    return fine;
}

/* ------------------------------------------------------------------------------- results */

/* A column of samples within the window; rows without a number are left out. */
struct samples {
    int n;
    double *time, *value;
};

static struct samples take_samples(const struct study *study, const struct series *series,
                                   const char *name)
{
    double *time = records_column(series, "time"), *value = records_column(series, "%s", name);
    struct samples samples = {0, time, value};
    for (int i = 0; time != NULL && value != NULL && i < series->n_rows; i++) {
        if (isnan(value[i]) || !(time[i] >= study->from && time[i] <= study->to))
            continue;
        time[samples.n] = time[i];
        value[samples.n++] = value[i];
    }
    return samples;
}

static double steady_rate(const struct samples *samples, enum how how)
{
    const struct steady steady = steady_find(samples->n, samples->time, samples->value);
    if (!steady.found)
        return (double)NAN;
    return steady.rate + (how == HOW_LOW    ? -steady.half_width
                          : how == HOW_HIGH ? steady.half_width
                                            : 0.0);
}

static double number_of(const struct samples *samples, enum how how)
{
    const int last = samples->n - 1;
    if (last < 0)
        return (double)NAN;
    const double *value = samples->value, *time = samples->time;
    double sum = 0.0, least = value[0], most = value[0];
    for (int i = 0; i <= last; i++) {
        sum += value[i];
        least = value[i] < least ? value[i] : least;
        most = value[i] > most ? value[i] : most;
    }
    switch (how) {
    case HOW_LAST:
        return value[last];
    case HOW_MEAN:
        return sum / samples->n;
    case HOW_MIN:
        return least;
    case HOW_MAX:
        return most;
    case HOW_RATE:
        return time[last] > time[0] ? (value[last] - value[0]) / (time[last] - time[0])
                                    : (double)NAN;
    case HOW_STEADY:
    case HOW_LOW:
    case HOW_HIGH:
        break;
    }
    return steady_rate(samples, how);
}

static void add_column(struct study *study, const struct series_column *of, enum how how)
{
    for (int c = 0; c < study->n_columns; c++)
        if (study->columns[c].how == how && strcmp(study->columns[c].name, of->name) == 0)
            return;
    const bool rate = how >= HOW_RATE;
    ARRAY_GROW(study->columns, study->n_columns + 1, study->column_capacity);
    study->columns[study->n_columns++] = (struct column){
        array_string(of->name), array_format("%s%s", of->unit, rate ? "/s" : ""), how};
}

/* The columns of a variant that are asked for. */
static void meet_wishes(struct study *study, const struct series *series)
{
    for (int w = 0; w < study->n_wishes; w++) {
        struct wish *wish = &study->wishes[w];
        for (int k = 0; k < series->n_columns; k++) {
            const struct series_column *column = &series->columns[k];
            if (fnmatch(wish->pattern, column->name, 0) != 0)
                continue;
            wish->met = true;
            add_column(study, column, wish->how);
            for (int how = HOW_LOW; wish->how == HOW_STEADY && how <= HOW_HIGH; how++)
                add_column(study, column, (enum how)how);
        }
    }
}

/* ------------------------------------------------------------------------------- reading */

static void read_state(struct row *row, const char *run)
{
    struct run_record_status status;
    struct run_lock_owner owner;
    row->has_status = run_record_read_status(run, &status);
    const bool has_owner = run_lock_read(run, &owner);
    snprintf(row->state, sizeof row->state, "%s",
             run_record_state(run, &status, has_owner ? &owner : NULL));
    row->step = status.step;
    row->time = status.time;
}

static bool has_samples(const char *run)
{
    char *folder = array_format("%s/series", run);
    int64_t *steps;
    const int n = file_steps(folder, &steps);
    free(steps);
    free(folder);
    return n > 0;
}

static int read_samples(struct study *study, struct row *row, const char *run)
{
    struct series series, runtime;
    int status = records_read(&series, run, "series");
    if (status != REPORT_FINISHED)
        return status;
    meet_wishes(study, &series);
    row->n_values = study->n_columns;
    row->values = array_allocate((size_t)row->n_values, sizeof *row->values);
    for (int c = 0; c < row->n_values; c++) {
        const struct samples samples = take_samples(study, &series, study->columns[c].name);
        row->values[c] = number_of(&samples, study->columns[c].how);
        free(samples.time);
        free(samples.value);
    }
    series_clear(&series);
    status = records_read(&runtime, run, "runtime");
    if (status != REPORT_FINISHED)
        return status;
    row->wall = records_sum(&runtime, "wall");
    row->particle_steps = records_sum(&runtime, "particle_steps");
    row->has_time = row->wall > 0.0;
    series_clear(&runtime);
    return REPORT_FINISHED;
}

/* Reads all variants; the status is the worst of theirs, NOTHING_TO_SHOW where none has run. */
static int read_variants(struct study *study)
{
    int worst = REPORT_FINISHED, n_read = 0;
    study->rows = array_allocate((size_t)study->sweep.n_variants, sizeof *study->rows);
    for (int v = 0; v < study->sweep.n_variants; v++) {
        char *run = array_format("%s/%s", study->path, study->sweep.folders[v]);
        read_state(&study->rows[v], run);
        const int status =
            has_samples(run) ? read_samples(study, &study->rows[v], run) : NOTHING_TO_SHOW;
        n_read += status == REPORT_FINISHED;
        if (status > worst && status != NOTHING_TO_SHOW)
            worst = status;
        free(run);
    }
    for (int w = 0; w < study->n_wishes && n_read > 0; w++) {
        const struct wish *wish = &study->wishes[w];
        if (wish->met || strchr(wish->pattern, '*') != NULL)
            continue;
        report_error("no variant has a column \"%s\" among its samples; tremie-info RUN lists "
                     "those that there are",
                     wish->pattern);
        return REPORT_BAD_INPUT;
    }
    return worst == REPORT_FINISHED && n_read == 0 ? NOTHING_TO_SHOW : worst;
}

/* ------------------------------------------------------------------------------- the table */

/* What all values of a key have behind their number, "mm" of 60 mm; NULL where they are no such
 * numbers.  The caller frees it. */
static char *common_unit(const struct sweep *sweep, int key)
{
    char *unit = NULL;
    for (int v = 1; v <= sweep->n_variants; v++) {
        const char *text = sweep_value(sweep, v, key);
        char *end;
        const double value = strtod(text, &end);
        end += strspn(end, " ");
        if (end == text || !isfinite(value) || (unit != NULL && strcmp(end, unit) != 0)) {
            free(unit);
            return NULL;
        }
        if (unit == NULL)
            unit = array_string(end);
    }
    return unit;
}

static void add_headings(const struct study *study, struct sheet *sheet)
{
    sheet_heading(sheet, "variant");
    for (int k = 0; k < study->sweep.n_keys; k++) {
        char *unit = records_unit(study->units[k] != NULL ? study->units[k] : "");
        sheet_heading(sheet, "%s%s", study->sweep.names[k], unit);
        free(unit);
    }
    static const char *const fixed[] = {"state", "steps", "time_s", "wall_s",
                                        "million_particle_steps_s"};
    for (size_t k = 0; k < sizeof fixed / sizeof *fixed; k++)
        sheet_heading(sheet, "%s", fixed[k]);
    for (int c = 0; c < study->n_columns; c++) {
        const struct column *column = &study->columns[c];
        char *unit = records_unit(column->unit);
        sheet_heading(sheet, "%s%s%s%s", column->name, column->how != HOW_LAST ? "." : "",
                      column->how != HOW_LAST ? HOWS[column->how] : "", unit);
        free(unit);
    }
}

static void add_number(struct sheet *sheet, bool known, double value, int digits,
                       const char *unknown)
{
    if (known && !isnan(value))
        sheet_cell(sheet, "%.*g", digits, value);
    else
        sheet_cell(sheet, "%s", unknown);
}

static void add_row(const struct study *study, struct sheet *sheet, int v, int digits,
                    const char *unknown)
{
    const struct row *row = &study->rows[v];
    sheet_cell(sheet, "%d", v + 1);
    for (int k = 0; k < study->sweep.n_keys; k++) {
        const char *value = sweep_value(&study->sweep, v + 1, k);
        const size_t length = study->units[k] != NULL ? strcspn(value, " ") : strlen(value);
        sheet_cell(sheet, "%.*s", (int)length, value);
    }
    sheet_cell(sheet, "%s", row->state);
    add_number(sheet, row->has_status, (double)row->step, 15, unknown);
    add_number(sheet, row->has_status, row->time, digits, unknown);
    add_number(sheet, row->has_time, row->wall, digits < 6 ? digits : 6, unknown);
    add_number(sheet, row->has_time, row->particle_steps / row->wall * 1e-6, 4, unknown);
    for (int c = 0; c < study->n_columns; c++)
        add_number(sheet, c < row->n_values, c < row->n_values ? row->values[c] : 0.0, digits,
                   unknown);
}

static void fill(const struct study *study, struct sheet *sheet, int digits,
                 const char *unknown)
{
    sheet_init(sheet);
    add_headings(study, sheet);
    for (int v = 0; v < study->sweep.n_variants; v++)
        add_row(study, sheet, v, digits, unknown);
}

static int show(const struct study *study, const char *csv)
{
    enum { DIGITS_SHOWN = 5, DIGITS_WRITTEN = 12 };
    struct sheet sheet;
    int status = REPORT_FINISHED;
    printf("study %s: %d variants\n\n", study->path, study->sweep.n_variants);
    fill(study, &sheet, DIGITS_SHOWN, "-");
    sheet_print(&sheet, stdout);
    sheet_clear(&sheet);
    if (csv != NULL) {
        fill(study, &sheet, DIGITS_WRITTEN, "");
        status = sheet_write_csv(&sheet, csv);
        sheet_clear(&sheet);
    }
    return status;
}

/* ------------------------------------------------------------------------------- main */

static void clear(struct study *study)
{
    for (int v = 0; study->rows != NULL && v < study->sweep.n_variants; v++)
        free(study->rows[v].values);
    for (int k = 0; study->units != NULL && k < study->sweep.n_keys; k++)
        free(study->units[k]);
    free(study->units);
    for (int c = 0; c < study->n_columns; c++) {
        free(study->columns[c].name);
        free(study->columns[c].unit);
    }
    for (int w = 0; w < study->n_wishes; w++)
        free(study->wishes[w].pattern);
    free(study->rows);
    free(study->columns);
    free(study->wishes);
    sweep_clear(&study->sweep);
}

static int run(struct study *study, const char *results, const char *csv)
{
    if (!study_file_is_there(study->path)) {
        report_error("%s is no folder of a study; give one, as `tremie run` makes it of a job "
                     "with a sweep",
                     study->path);
        return REPORT_BAD_INPUT;
    }
    if (!read_wishes(study, results))
        return REPORT_BAD_INPUT;
    int status = study_file_read(study->path, &study->sweep);
    if (status != REPORT_FINISHED)
        return status;
    study->units = array_allocate((size_t)study->sweep.n_keys, sizeof *study->units);
    for (int k = 0; k < study->sweep.n_keys; k++)
        study->units[k] = common_unit(&study->sweep, k);
    status = read_variants(study);
    if (status == REPORT_BAD_INPUT)
        return status;
    const int shown = show(study, csv);
    return shown > status ? shown : status;
}

int main(int argc, char **argv)
{
    const char *results = STANDARD, *csv = NULL;
    struct study study = {.from = -INFINITY, .to = INFINITY};
    const struct arguments_entry entries[] = {
        {"results", 0, ARGUMENTS_TEXT, &results, "COLUMN[:HOW],..",
         "columns of the samples, * for any letters, and what to make of them", NULL},
        {"from", 0, ARGUMENTS_NUMBER, &study.from, "TIME", "samples from this time on [s]",
         NULL},
        {"to", 0, ARGUMENTS_NUMBER, &study.to, "TIME", "samples up to this time [s]", NULL},
        {"csv", 0, ARGUMENTS_TEXT, &csv, "FILE", "writes the table as comma-separated values",
         NULL},
    };
    const struct arguments_page page = {
        "tremie-study",
        "STUDY [--results COLUMN[:HOW],..] [--from TIME] [--to TIME] [--csv FILE]",
        "Shows the variants of a study, a row each: the values of the keys that vary, state, steps,\n"
        "simulated time, wall time, rate, and results.  STUDY is the study's folder.\n"
        "\n"
        "A result is a column of the runs' samples, as tremie-info names it, and HOW one of last\n"
        "(the default), mean, min, max (of the samples), rate (increase over time) and steady (rate of\n"
        "the steady part, as tremie-discharge finds it, with its 95 % interval).  By default:\n"
        "overlap_max:max,balance,*.mass_forward\n"
        "\n"
        "Exit status: 0 shown; 1 no variant has samples yet; 2 bad arguments; 4 a file cannot be read or\n"
        "written.\n",
        sizeof entries / sizeof *entries,
        entries,
        1,
        1};
    int n;
    int status = arguments_read(&page, argc, argv, &n);
    if (status != ARGUMENTS_GO_ON)
        return status;
    study.path = argv[1];
    status = run(&study, results, csv);
    clear(&study);
    return status;
}
