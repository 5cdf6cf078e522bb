/*
 * tremie-discharge: what passed through each section of a run, and how steadily.
 *
 * Counts and masses come from the run's own samples, so they are exact; the rate is that of
 * steady.h.  Net means forward less backward, forward being along the section's normal.
 *
 * What a section counts apart by material and size class is treated like a section of its own,
 * called outlet.material_ore or outlet.class_1, where asked for.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "base/array.h"
#include "base/report.h"
#include "plot.h"
#include "records.h"
#include "sheet.h"
#include "steady.h"

enum { ROWS_SHOWN = 20, RATES_PLOTTED = 80, NOTHING_TO_REPORT = 1 };
static const char MARK[] =
    ".mass_forward"; /* ends the name of a column that every section has */

struct section {
    char *name;
    double *count_forward, *count_backward; /* since the start */
    double *mass;                           /* net [kg] */
    double *rate;                           /* since the row before [kg/s] */
    struct steady steady;
    double n_per_second; /* spheres, over the steady window */
};

enum part { PART_TOTAL, PART_MATERIAL, PART_SIZE, PART_ALL };
static const char *const PARTS[] = {"total", "material", "size", "all", NULL};

struct discharge {
    const char *run;
    enum part by; /* what is shown beside totals */
    int n_rows, n_sections;
    double *time; /* [s] */
    struct section *sections;
};

/* ---------------------------------------------------------------------------------- reading */

static double at_time(const struct discharge *d, const double *values, double time)
{
    int i = 1;
    while (i < d->n_rows - 1 && d->time[i] < time)
        i++;
    const double share = (time - d->time[i - 1]) / (d->time[i] - d->time[i - 1]);
    return values[i - 1] + share * (values[i] - values[i - 1]);
}

static double net_count(const struct section *section, int row)
{
    return section->count_forward[row] - section->count_backward[row];
}

static bool read_section(struct discharge *d, struct section *section,
                         const struct series *series)
{
    const char *name = section->name;
    double *backward = records_column(series, "%s.mass_backward", name);
    section->mass = records_column(series, "%s.mass_forward", name);
    section->count_forward = records_column(series, "%s.count_forward", name);
    section->count_backward = records_column(series, "%s.count_backward", name);
    section->rate = array_allocate((size_t)d->n_rows, sizeof *section->rate);
    const bool whole =
        backward != NULL && section->count_forward != NULL && section->count_backward != NULL;
    for (int i = 0; whole && i < d->n_rows; i++)
        section->mass[i] -= backward[i];
    for (int i = 1; i < d->n_rows; i++)
        section->rate[i] =
            (section->mass[i] - section->mass[i - 1]) / (d->time[i] - d->time[i - 1]);
    free(backward);
    return whole;
}

static void assess(struct discharge *d, struct section *section)
{
    section->steady = steady_find(d->n_rows, d->time, section->mass);
    const struct steady *steady = &section->steady;
    if (!steady->found)
        return;
    const double n = at_time(d, section->count_forward, steady->to) -
                     at_time(d, section->count_forward, steady->from) -
                     at_time(d, section->count_backward, steady->to) +
                     at_time(d, section->count_backward, steady->from);
    section->n_per_second = n / (steady->to - steady->from);
}

/* Is this section, or part of one, to be shown?  No name has a point in it. */
static bool is_wanted(const struct discharge *d, const char *name)
{
    const char *part = strchr(name, '.');
    if (part == NULL || d->by == PART_ALL)
        return true;
    return (d->by == PART_MATERIAL && strncmp(part, ".material_", 10) == 0) ||
           (d->by == PART_SIZE && strncmp(part, ".class_", 7) == 0);
}

/* A material that bodies alone have never passes. */
static bool is_idle_part(const struct discharge *d, const struct section *section)
{
    const int last = d->n_rows - 1;
    return strchr(section->name, '.') != NULL && last >= 0 &&
           section->count_forward[last] == 0.0 && section->count_backward[last] == 0.0;
}

static void clear_section(struct section *section)
{
    free(section->name);
    free(section->count_forward);
    free(section->count_backward);
    free(section->mass);
    free(section->rate);
}

/* Finds the sections among the columns.  False when a section lacks a column. */
static bool read_sections(struct discharge *d, const struct series *series)
{
    bool whole = true;
    d->sections = array_allocate((size_t)series->n_columns, sizeof *d->sections);
    for (int k = 0; k < series->n_columns; k++) {
        char *name = array_string(series->columns[k].name);
        const size_t length = strlen(name), mark = strlen(MARK);
        if (length <= mark || strcmp(name + length - mark, MARK) != 0) {
            free(name);
            continue;
        }
        name[length - mark] = '\0';
        if (!is_wanted(d, name)) {
            free(name);
            continue;
        }
        struct section *section = &d->sections[d->n_sections++];
        section->name = name;
        whole = read_section(d, section, series) && whole;
        if (whole && is_idle_part(d, section)) {
            clear_section(section);
            d->n_sections--;
        }
    }
    return whole;
}

static int read_run(struct discharge *d, const char *run)
{
    struct series series;
    const int status = records_read(&series, run, "series");
    if (status != REPORT_FINISHED)
        return status;
    d->run = run;
    d->n_rows = series.n_rows;
    d->time = records_column(&series, "time");
    const bool whole = d->time != NULL && read_sections(d, &series);
    series_clear(&series);
    if (whole)
        return REPORT_FINISHED;
    report_error(
        "the series of %s lack columns that every run writes; was it written by tremie?", run);
    return REPORT_STORAGE;
}

static void clear(struct discharge *d)
{
    for (int s = 0; s < d->n_sections; s++)
        clear_section(&d->sections[s]);
    free(d->sections);
    free(d->time);
}

/* ---------------------------------------------------------------------------------- showing */

static void print_rows(const struct discharge *d, const struct section *section)
{
    struct sheet sheet;
    sheet_init(&sheet);
    const char *const headings[] = {"time [s]", "forward",       "backward",
                                    "net",      "net mass [kg]", "rate [kg/s]"};
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        sheet_heading(&sheet, "%s", headings[i]);
    const int n_shown = d->n_rows < ROWS_SHOWN ? d->n_rows : ROWS_SHOWN;
    for (int k = 0, last = 0; k < n_shown; k++) {
        const int i = n_shown > 1 ? (int)((int64_t)k * (d->n_rows - 1) / (n_shown - 1)) : 0;
        sheet_cell(&sheet, "%.6g", d->time[i]);
        sheet_cell(&sheet, "%.0f", section->count_forward[i]);
        sheet_cell(&sheet, "%.0f", section->count_backward[i]);
        sheet_cell(&sheet, "%.0f", net_count(section, i));
        sheet_cell(&sheet, "%.6g", section->mass[i]);
        if (k == 0)
            sheet_cell(&sheet, "-");
        else
            sheet_cell(&sheet, "%.4g",
                       (section->mass[i] - section->mass[last]) / (d->time[i] - d->time[last]));
        last = i;
    }
    sheet_print(&sheet, stdout);
    sheet_clear(&sheet);
}

static void print_section(const struct discharge *d, const struct section *section)
{
    const int last = d->n_rows - 1;
    const struct steady *steady = &section->steady;
    printf("\nsection %s\n", section->name);
    print_rows(d, section);
    printf("total: %.0f spheres net (%.0f forward, %.0f backward), %.6g kg at %.6g s\n",
           net_count(section, last), section->count_forward[last],
           section->count_backward[last], section->mass[last], d->time[last]);
    if (steady->flows)
        printf("flow: from %.4g s to %.4g s\n", steady->begin, steady->end);
    char rate[STEADY_TEXT_SIZE];
    steady_write_interval(rate, steady->rate, steady->half_width);
    if (steady->found)
        printf("steady: from %.4g s to %.4g s, %s kg/s (95 %%, %d batches), %.5g spheres/s\n",
               steady->from, steady->to, rate, steady->n_batches, section->n_per_second);
    else
        printf("no steady window: %s\n", steady->why);
}

static int write_csv(const struct discharge *d, const char *path)
{
    struct sheet sheet;
    sheet_init(&sheet);
    sheet_heading(&sheet, "time_s");
    for (int s = 0; s < d->n_sections; s++) {
        const char *name = d->sections[s].name;
        sheet_heading(&sheet, "%s.count_forward", name);
        sheet_heading(&sheet, "%s.count_backward", name);
        sheet_heading(&sheet, "%s.net_mass_kg", name);
        sheet_heading(&sheet, "%s.rate_kg_s", name);
    }
    for (int i = 0; i < d->n_rows; i++) {
        sheet_cell(&sheet, "%.12g", d->time[i]);
        for (int s = 0; s < d->n_sections; s++) {
            sheet_cell(&sheet, "%.0f", d->sections[s].count_forward[i]);
            sheet_cell(&sheet, "%.0f", d->sections[s].count_backward[i]);
            sheet_cell(&sheet, "%.12g", d->sections[s].mass[i]);
            sheet_cell(&sheet, "%.9g", d->sections[s].rate[i]);
        }
    }
    const int status = sheet_write_csv(&sheet, path);
    sheet_clear(&sheet);
    return status;
}

/* A curve of rates over stretches of rows, so that it can be read. */
struct coarse {
    int n;
    double *time, *rate;
};

static struct coarse coarsen(const struct discharge *d, const struct section *section)
{
    const int stride = 1 + (d->n_rows - 2) / RATES_PLOTTED;
    struct coarse coarse = {.time = array_allocate((size_t)d->n_rows, sizeof(double)),
                            .rate = array_allocate((size_t)d->n_rows, sizeof(double))};
    for (int i = 0; i < d->n_rows; i += stride) {
        const int from = i > 0 ? i - stride : 0, to = i > 0                ? i
                                                      : stride < d->n_rows ? stride
                                                                           : d->n_rows - 1;
        coarse.time[coarse.n] = d->time[i];
        coarse.rate[coarse.n++] =
            (section->mass[to] - section->mass[from]) / (d->time[to] - d->time[from]);
    }
    return coarse;
}

static void plot_section(struct plot *plot, const struct discharge *d, int s,
                         const struct coarse *coarse, char **label, double level[2][2])
{
    const struct section *section = &d->sections[s];
    const struct steady *steady = &section->steady;
    plot_add_curve(&plot->panels[0], (struct plot_curve){.label = section->name,
                                                         .n = d->n_rows,
                                                         .x = d->time,
                                                         .y = section->mass,
                                                         .colour = s});
    char rate[STEADY_TEXT_SIZE];
    steady_write_interval(rate, steady->rate, steady->half_width);
    *label = steady->found ? array_format("%s: %s kg/s (95 %%) from %.3g s to %.3g s",
                                          section->name, rate, steady->from, steady->to)
                           : array_format("%s: no steady window", section->name);
    plot_add_curve(&plot->panels[1], (struct plot_curve){.label = *label,
                                                         .n = coarse->n,
                                                         .x = coarse->time,
                                                         .y = coarse->rate,
                                                         .colour = s,
                                                         .steps = true});
    if (!steady->found)
        return;
    level[0][0] = steady->from;
    level[0][1] = steady->to;
    level[1][0] = level[1][1] = steady->rate;
    plot_add_band(&plot->panels[0],
                  (struct plot_band){{steady->from, steady->to}, {-INFINITY, INFINITY}, s});
    plot_add_band(&plot->panels[1], (struct plot_band){{steady->from, steady->to},
                                                       {steady->rate - steady->half_width,
                                                        steady->rate + steady->half_width},
                                                       s});
    plot_add_curve(
        &plot->panels[1],
        (struct plot_curve){.n = 2, .x = level[0], .y = level[1], .colour = s, .dashed = true});
}

static int write_svg(const struct discharge *d, const char *path)
{
    const size_t n = (size_t)d->n_sections;
    char *title = array_format("Discharge of %s", d->run);
    char **labels = array_allocate(n, sizeof *labels);
    double(*levels)[2][2] = array_allocate(n, sizeof *levels);
    struct coarse *coarse = array_allocate(n, sizeof *coarse);
    struct plot plot = {.title = title,
                        .n_panels = 2,
                        .panels = {{.x_label = "time [s]", .y_label = "net mass [kg]"},
                                   {.x_label = "time [s]", .y_label = "rate [kg/s]"}}};
    for (int s = 0; s < d->n_sections; s++) {
        coarse[s] = coarsen(d, &d->sections[s]);
        plot_section(&plot, d, s, &coarse[s], &labels[s], levels[s]);
    }
    const int status = plot_write_svg(&plot, path);
    for (int s = 0; s < d->n_sections; s++) {
        free(labels[s]);
        free(coarse[s].time);
        free(coarse[s].rate);
    }
    free(labels);
    free(levels);
    free(coarse);
    free(title);
    return status;
}

static int show(struct discharge *d, const char *csv, const char *svg)
{
    if (d->n_sections == 0) {
        printf(
            "%s has no section, so nothing is counted; name one under `sections:` in the job\n",
            d->run);
        return NOTHING_TO_REPORT;
    }
    if (d->n_rows < 2) {
        printf("%s has %d sample%s so far; a rate needs two\n", d->run, d->n_rows,
               d->n_rows == 1 ? "" : "s");
        return NOTHING_TO_REPORT;
    }
    printf("discharge of %s: %d samples from %.6g s to %.6g s\n", d->run, d->n_rows, d->time[0],
           d->time[d->n_rows - 1]);
    for (int s = 0; s < d->n_sections; s++) {
        assess(d, &d->sections[s]);
        print_section(d, &d->sections[s]);
    }
    int status = csv != NULL ? write_csv(d, csv) : REPORT_FINISHED;
    if (svg != NULL && status == REPORT_FINISHED)
        status = write_svg(d, svg);
    return status;
}

int main(int argc, char **argv)
{
    const char *csv = NULL, *svg = NULL;
    int by = PART_TOTAL;
    const struct arguments_entry entries[] = {
        {"by", 0, ARGUMENTS_CHOICE, &by, "WHAT",
         "shows beside totals what sections count apart", PARTS},
        {"csv", 0, ARGUMENTS_TEXT, &csv, "FILE", "writes all samples as comma-separated values",
         NULL},
        {"svg", 0, ARGUMENTS_TEXT, &svg, "FILE", "draws mass and rate over time", NULL},
    };
    const struct arguments_page page = {
        "tremie-discharge",
        "RUN [--by WHAT] [--csv FILE] [--svg FILE]",
        "Shows how many spheres and what mass passed each section of a run over time, and the rate with\n"
        "its 95 % confidence interval over the window in which it is steady.  RUN is the run's folder.\n"
        "\n"
        "Exit status: 0 shown; 1 nothing to show (no section, fewer than two samples); 2 bad arguments;\n"
        "4 a file cannot be read or written.\n",
        sizeof entries / sizeof *entries,
        entries,
        1,
        1};
    int n;
    int status = arguments_read(&page, argc, argv, &n);
    if (status != ARGUMENTS_GO_ON)
        return status;
    struct discharge d = {.by = (enum part)by};
    status = read_run(&d, argv[1]);
    if (status == REPORT_FINISHED)
        status = show(&d, csv, svg);
    clear(&d);
    return status;
}
