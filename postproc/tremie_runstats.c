/*
 * tremie-runstats: where the time of a run went, and how runs on several rank counts compare.
 *
 * A run writes one row of timings with each sample: what each phase took since the row before,
 * the least, mean and most over its ranks.  Rows are added up here.  The sum of the ranks'
 * largest times is an upper bound of any rank's total, since another rank may be the slowest in
 * each row.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "base/array.h"
#include "base/report.h"
#include "records.h"
#include "sheet.h"

enum { N_PHASES = 12, NAME_SIZE = 64, NOTHING_TO_REPORT = 1, RUNS_MOST = 1000 };

static const char *const phases[N_PHASES] = {
    "bodies", "facets", "pairs",        "integrate",   "solids", "halo",
    "watch",  "search", "redistribute", "repartition", "sample", "checkpoint",
};

struct phase {
    double least, mean, most; /* over ranks, summed over rows [s] */
};

struct stats {
    const char *run;
    struct series rows;
    double ranks_least, ranks_most;
    double wall, steps, particle_steps;
    struct phase phases[N_PHASES];
    double compute; /* mean over ranks, all phases [s] */
};

static double phase_sum(const struct series *rows, const char *phase, const char *what)
{
    char name[NAME_SIZE];
    snprintf(name, sizeof name, "%s.%s", phase, what);
    const double sum = records_sum(rows, name);
    return isnan(sum) ? 0.0 : sum;
}

static double ranks_at(const struct series *rows, int row)
{
    const int column = series_column_index(rows, "ranks");
    return rows->values[(size_t)row * (size_t)rows->n_columns + (size_t)column];
}

static void find_ranks(struct stats *stats)
{
    stats->ranks_least = INFINITY;
    for (int i = 0; i < stats->rows.n_rows; i++) {
        const double ranks = ranks_at(&stats->rows, i);
        stats->ranks_least = ranks < stats->ranks_least ? ranks : stats->ranks_least;
        stats->ranks_most = ranks > stats->ranks_most ? ranks : stats->ranks_most;
    }
}

static int read_stats(struct stats *stats, const char *run)
{
    *stats = (struct stats){.run = run};
    const int status = records_read(&stats->rows, run, "runtime");
    if (status != REPORT_FINISHED)
        return status;
    stats->wall = records_sum(&stats->rows, "wall");
    stats->steps = records_sum(&stats->rows, "steps");
    stats->particle_steps = records_sum(&stats->rows, "particle_steps");
    if (!(stats->wall > 0.0 && stats->steps > 0.0) ||
        series_column_index(&stats->rows, "ranks") < 0) {
        printf("%s has made no steps whose time was taken\n", run);
        series_clear(&stats->rows);
        return NOTHING_TO_REPORT;
    }
    find_ranks(stats);
    for (int p = 0; p < N_PHASES; p++) {
        stats->phases[p] = (struct phase){phase_sum(&stats->rows, phases[p], "min"),
                                          phase_sum(&stats->rows, phases[p], "mean"),
                                          phase_sum(&stats->rows, phases[p], "max")};
        stats->compute += stats->phases[p].mean;
    }
    return REPORT_FINISHED;
}

/* ---------------------------------------------------------------------------------- one run */

static void write_ranks(char text[NAME_SIZE], const struct stats *stats)
{
    if (stats->ranks_least < stats->ranks_most)
        snprintf(text, NAME_SIZE, "%.0f to %.0f", stats->ranks_least, stats->ranks_most);
    else
        snprintf(text, NAME_SIZE, "%.0f", stats->ranks_most);
}

static double share(double part, double whole)
{
    return whole > 0.0 ? 100.0 * part / whole : 0.0;
}

static double million_per_second(const struct stats *stats)
{
    return stats->particle_steps / stats->wall / 1e6;
}

static void print_phases(const struct stats *stats)
{
    struct sheet sheet;
    sheet_init(&sheet);
    const char *const headings[] = {"phase",   "min [s]",   "mean [s]",
                                    "max [s]", "share [%]", "max/mean"};
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        sheet_heading(&sheet, "%s", headings[i]);
    for (int p = 0; p <= N_PHASES; p++) {
        const double rest = stats->wall - stats->compute;
        const struct phase phase =
            p < N_PHASES ? stats->phases[p] : (struct phase){rest, rest, rest};
        sheet_cell(&sheet, "%s", p < N_PHASES ? phases[p] : "other");
        sheet_cell(&sheet, "%.3f", phase.least);
        sheet_cell(&sheet, "%.3f", phase.mean);
        sheet_cell(&sheet, "%.3f", phase.most);
        sheet_cell(&sheet, "%.1f", share(phase.mean, stats->wall));
        if (phase.mean > 0.0 && p < N_PHASES)
            sheet_cell(&sheet, "%.2f", phase.most / phase.mean);
        else
            sheet_cell(&sheet, "-");
    }
    sheet_print(&sheet, stdout);
    sheet_clear(&sheet);
}

static double phase_most(const struct stats *stats, const char *name)
{
    for (int p = 0; p < N_PHASES; p++)
        if (strcmp(phases[p], name) == 0)
            return stats->phases[p].most;
    return 0.0;
}

/* How often something happened and what one time costs. */
static void print_events(const struct stats *stats, const char *column, const char *called,
                         const char *phase)
{
    const double n = records_sum(&stats->rows, column);
    if (isnan(n))
        return;
    printf("%-28s %.0f", called, n);
    if (n > 0.0) {
        printf(", one in %.4g steps", stats->steps / n);
        if (phase != NULL)
            printf(", %.3g ms each", 1e3 * phase_most(stats, phase) / n);
    }
    printf("\n");
}

static void print_value(const struct stats *stats, const char *called,
                        const char *const columns[3], double unit, const char *unit_name)
{
    static const char *const words[3] = {"least", "mean", "most"};
    bool any = false;
    for (int k = 0; k < 3; k++) {
        if (columns[k] == NULL || series_column_index(&stats->rows, columns[k]) < 0)
            continue;
        const double value = k == 2 ? records_max(&stats->rows, columns[k])
                                    : records_mean(&stats->rows, columns[k]);
        if (isnan(value))
            continue;
        if (any)
            printf(", ");
        else
            printf("%-28s ", called);
        any = true;
        printf("%.6g%s (%s)", value / unit, unit_name, words[k]);
    }
    if (any)
        printf("\n");
}

/* Of bodies that deform. */
static void print_solids(const struct stats *stats)
{
    print_value(stats, "  nodes moved",
                (const char *const[3]){"nodes.min", "nodes.mean", "nodes.max"}, 1, "");
    print_value(stats, "  copies of nodes",
                (const char *const[3]){NULL, "node_copies.mean", "node_copies.max"}, 1, "");
    print_value(stats, "  elements computed",
                (const char *const[3]){"elements.min", "elements.mean", "elements.max"}, 1, "");
    printf("%-28s %.0f\n", "nodes that changed rank",
           records_sum(&stats->rows, "nodes_migrated"));
    printf("%-28s %.4g kB\n", "told about nodes each step",
           1e-3 * records_sum(&stats->rows, "nodes_told") / stats->steps);
}

/* How evenly boxes share out what they are cut by. */
static void print_weights(const struct stats *stats)
{
    double *most = records_column(&stats->rows, "weight.max");
    double *mean = records_column(&stats->rows, "weight.mean");
    double sum = 0.0, worst = 0.0;
    for (int i = 0; most != NULL && mean != NULL && i < stats->rows.n_rows; i++) {
        const double ratio = most[i] / mean[i];
        sum += ratio;
        worst = ratio > worst ? ratio : worst;
    }
    if (sum > 0.0)
        printf("%-28s %.6g (mean), %.6g (most)\n", "imbalance of weights",
               sum / stats->rows.n_rows, worst);
    free(most);
    free(mean);
}

static void print_counts(const struct stats *stats)
{
    print_events(stats, "searches", "searches", "search");
    print_events(stats, "prunes", "prunings of the list", NULL);
    print_events(stats, "redistributions", "redistributions, high level", "redistribute");
    print_events(stats, "repartitions", "redistributions, low level", "repartition");
    print_events(stats, "migrated", "spheres that changed rank", NULL);
    printf("both levels of redistribution together took %.3f s, %.2f %% of the time\n",
           phase_most(stats, "redistribute") + phase_most(stats, "repartition"),
           share(phase_most(stats, "redistribute") + phase_most(stats, "repartition"),
                 stats->wall));
    printf("on a rank, over the samples:\n");
    print_value(stats, "  spheres owned",
                (const char *const[3]){"owned.min", "owned.mean", "owned.max"}, 1, "");
    print_value(stats, "  ghosts (external)",
                (const char *const[3]){NULL, "ghosts.mean", "ghosts.max"}, 1, "");
    print_value(stats, "  internal", (const char *const[3]){NULL, "internal.mean", NULL}, 1,
                "");
    print_value(stats, "  interfacial", (const char *const[3]){NULL, "interfacial.mean", NULL},
                1, "");
    print_value(stats, "  candidates", (const char *const[3]){NULL, "candidates.mean", NULL}, 1,
                "");
    print_value(stats, "  pairs in the inner list",
                (const char *const[3]){NULL, "contacts.mean", NULL}, 1, "");
    if (records_max(&stats->rows, "nodes.max") > 0.0)
        print_solids(stats);
    print_value(stats, "  memory", (const char *const[3]){NULL, "memory.mean", "memory.max"},
                1048576.0, " MiB");
    print_value(stats, "imbalance of computing",
                (const char *const[3]){NULL, "imbalance", "imbalance"}, 1, "");
    print_weights(stats);
}

static void print_stats(const struct stats *stats)
{
    char ranks[NAME_SIZE];
    write_ranks(ranks, stats);
    printf("%s: %.0f spheres, %s rank%s, %.0f steps in %.4g s\n", stats->run,
           records_last(&stats->rows, "n_spheres"), ranks, stats->ranks_most > 1.0 ? "s" : "",
           stats->steps, stats->wall);
    const double rate = million_per_second(stats);
    printf("rate: %.3g million particle-steps/s", rate);
    if (!(stats->ranks_least < stats->ranks_most))
        printf(", %.3g a rank", rate / stats->ranks_most);
    printf("; %.4g us a step\n\n", 1e6 * stats->wall / stats->steps);
    print_phases(stats);
    printf("\n");
    print_counts(stats);
}

/* ----------------------------------------------------------------------------- several runs */

static int compare_ranks(const void *a, const void *b)
{
    const struct stats *p = a, *q = b;
    return (p->ranks_most > q->ranks_most) - (p->ranks_most < q->ranks_most);
}

static bool same_work(int n, const struct stats *runs)
{
    for (int i = 1; i < n; i++)
        if (runs[i].steps != runs[0].steps || runs[i].particle_steps != runs[0].particle_steps)
            return false;
    return true;
}

/* Time that one particle-step takes, or one step where the former is not known [s]. */
static double unit_time(const struct stats *stats)
{
    return stats->wall / (stats->particle_steps > 0.0 ? stats->particle_steps : stats->steps);
}

static void fill_speed_up(struct sheet *sheet, int n, const struct stats *runs)
{
    const char *const headings[] = {
        "ranks", "time [s]", "speed-up", "efficiency", "million particle-steps/s", "run"};
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        sheet_heading(sheet, "%s", headings[i]);
    for (int i = 0; i < n; i++) {
        const double ratio = unit_time(&runs[0]) / unit_time(&runs[i]);
        const double speed_up = runs[0].ranks_most * ratio;
        char ranks[NAME_SIZE];
        write_ranks(ranks, &runs[i]);
        sheet_cell(sheet, "%s", ranks);
        sheet_cell(sheet, "%.4g", runs[i].wall);
        sheet_cell(sheet, "%.2f", speed_up);
        sheet_cell(sheet, "%.2f", speed_up / runs[i].ranks_most);
        sheet_cell(sheet, "%.3g", million_per_second(&runs[i]));
        sheet_cell(sheet, "%s", runs[i].run);
    }
}

static void print_speed_up(int n, struct stats *runs)
{
    struct sheet sheet;
    sheet_init(&sheet);
    qsort(runs, (size_t)n, sizeof *runs, compare_ranks);
    fill_speed_up(&sheet, n, runs);
    printf("\nspeed-up, the run on %.0f rank%s counted as %.0f:\n", runs[0].ranks_most,
           runs[0].ranks_most > 1.0 ? "s" : "", runs[0].ranks_most);
    sheet_print(&sheet, stdout);
    if (!same_work(n, runs))
        printf(
            "the runs did not do the same work: speed-ups compare the time of a particle-step\n");
    sheet_clear(&sheet);
}

/* --------------------------------------------------------------------------------- the file */

static const char *const summed[] = {"searches", "prunes", "redistributions", "repartitions",
                                     "migrated"};
static const char *const averaged[] = {"imbalance",     "ghosts.mean",      "owned.mean",
                                       "internal.mean", "interfacial.mean", "candidates.mean",
                                       "contacts.mean", "memory.mean"};
enum {
    N_SUMMED = sizeof summed / sizeof *summed,
    N_AVERAGED = sizeof averaged / sizeof *averaged
};

static void fill_headings(struct sheet *sheet)
{
    static const char *const first[] = {"run",
                                        "ranks",
                                        "n_spheres",
                                        "wall_s",
                                        "steps",
                                        "particle_steps",
                                        "million_particle_steps_s"};
    for (size_t k = 0; k < sizeof first / sizeof *first; k++)
        sheet_heading(sheet, "%s", first[k]);
    for (int p = 0; p < N_PHASES; p++) {
        sheet_heading(sheet, "%s.min_s", phases[p]);
        sheet_heading(sheet, "%s.mean_s", phases[p]);
        sheet_heading(sheet, "%s.max_s", phases[p]);
    }
    for (int k = 0; k < N_SUMMED; k++)
        sheet_heading(sheet, "%s", summed[k]);
    for (int k = 0; k < N_AVERAGED; k++)
        sheet_heading(sheet, "%s", averaged[k]);
    sheet_heading(sheet, "memory.max");
}

static void fill_row(struct sheet *sheet, const struct stats *stats)
{
    char ranks[NAME_SIZE];
    write_ranks(ranks, stats);
    sheet_cell(sheet, "%s", stats->run);
    sheet_cell(sheet, "%s", ranks);
    sheet_cell(sheet, "%.0f", records_last(&stats->rows, "n_spheres"));
    sheet_cell(sheet, "%.9g", stats->wall);
    sheet_cell(sheet, "%.0f", stats->steps);
    sheet_cell(sheet, "%.0f", stats->particle_steps);
    sheet_cell(sheet, "%.6g", million_per_second(stats));
    for (int p = 0; p < N_PHASES; p++) {
        sheet_cell(sheet, "%.6g", stats->phases[p].least);
        sheet_cell(sheet, "%.6g", stats->phases[p].mean);
        sheet_cell(sheet, "%.6g", stats->phases[p].most);
    }
    for (int k = 0; k < N_SUMMED; k++)
        sheet_cell(sheet, "%.9g", records_sum(&stats->rows, summed[k]));
    for (int k = 0; k < N_AVERAGED; k++)
        sheet_cell(sheet, "%.9g", records_mean(&stats->rows, averaged[k]));
    sheet_cell(sheet, "%.9g", records_max(&stats->rows, "memory.max"));
}

static int write_csv(int n, const struct stats *runs, const char *path)
{
    struct sheet sheet;
    sheet_init(&sheet);
    fill_headings(&sheet);
    for (int i = 0; i < n; i++)
        fill_row(&sheet, &runs[i]);
    const int status = sheet_write_csv(&sheet, path);
    sheet_clear(&sheet);
    return status;
}

/* Shows the runs that can be read; the status is the worst of theirs. */
static int show(int n_paths, char **paths, const char *csv)
{
    struct stats *runs = array_allocate((size_t)n_paths, sizeof *runs);
    int n = 0, worst = REPORT_FINISHED;
    for (int i = 0; i < n_paths; i++) {
        const int status = read_stats(&runs[n], paths[i]);
        worst = status > worst ? status : worst;
        if (status != REPORT_FINISHED)
            continue;
        if (n > 0)
            printf("\n");
        print_stats(&runs[n++]);
    }
    if (n > 1)
        print_speed_up(n, runs);
    if (csv != NULL && n > 0) {
        const int status = write_csv(n, runs, csv);
        worst = status > worst ? status : worst;
    }
    for (int i = 0; i < n; i++)
        series_clear(&runs[i].rows);
    free(runs);
    return worst;
}

int main(int argc, char **argv)
{
    const char *csv = NULL;
    const struct arguments_entry entries[] = {
        {"csv", 0, ARGUMENTS_TEXT, &csv, "FILE",
         "writes one line of comma-separated values a run", NULL},
    };
    const struct arguments_page page = {
        "tremie-runstats",
        "RUN... [--csv FILE]",
        "Shows where the time of each run went, phase by phase over its ranks, how often it searched and\n"
        "redistributed, what a rank holds; and for several runs the speed-up over the one on the fewest\n"
        "ranks.  RUN is a run's folder.\n"
        "\n"
        "Exit status: 0 shown; 1 a run has made no steps yet; 2 bad arguments; 4 a file cannot be read\n"
        "or written.\n",
        sizeof entries / sizeof *entries,
        entries,
        1,
        RUNS_MOST};
    int n;
    const int status = arguments_read(&page, argc, argv, &n);
    return status == ARGUMENTS_GO_ON ? show(n, argv + 1, csv) : status;
}
