/* See runtime.h.  Means are taken from integers, as all sums over ranks. */
#include "run/runtime.h"

#include <stdio.h>
#include <unistd.h>

#include "base/comm.h"
#include "base/report.h"
#include "base/timer.h"
#include "domain/boxes.h"

static const char *const PHASE_NAMES[RUNTIME_N_PHASES] = {
    "bodies", "facets", "pairs",        "integrate",   "solids", "halo",
    "watch",  "search", "redistribute", "repartition", "sample", "checkpoint",
};

enum { VALUES_MAX = 128, NANOSECONDS = 1000000000 };

static void add_columns(struct series *table)
{
    series_add_column(table, "1", "steps done when the row was made", "step");
    series_add_column(table, "s", "simulated time", "time");
    series_add_column(table, "s", "wall time since the row before", "wall");
    series_add_column(table, "1", "ranks", "ranks");
    series_add_column(table, "1", "steps since the row before", "steps");
    series_add_column(table, "1", "spheres in the run", "n_spheres");
    series_add_column(table, "1", "spheres times steps since the row before", "particle_steps");
    for (int p = 0; p < RUNTIME_N_PHASES; p++) {
        series_add_column(table, "s", "time in this phase, least over ranks", "%s.min",
                          PHASE_NAMES[p]);
        series_add_column(table, "s", "time in this phase, mean over ranks", "%s.mean",
                          PHASE_NAMES[p]);
        series_add_column(table, "s", "time in this phase, largest over ranks", "%s.max",
                          PHASE_NAMES[p]);
    }
    series_add_column(table, "1", "searches since the row before", "searches");
    series_add_column(table, "1", "renewals of the inner list", "prunes");
    series_add_column(table, "1", "redistributions that moved spheres (high level)",
                      "redistributions");
    series_add_column(table, "1", "repartitions (low level)", "repartitions");
    series_add_column(table, "1", "spheres that changed rank", "migrated");
    series_add_column(table, "1", "nodes of bodies that deform that changed rank",
                      "nodes_migrated");
    series_add_column(table, "bytes", "sent each step about such nodes, since the row before",
                      "nodes_told");
    series_add_column(table, "1", "largest over mean working time at the last verdict",
                      "imbalance");
    static const char *const sizes[] = {"owned",       "ghosts",      "internal",
                                        "interfacial", "candidates",  "contacts",
                                        "nodes",       "node_copies", "elements"};
    for (int k = 0; k < (int)(sizeof sizes / sizeof *sizes); k++) {
        series_add_column(table, "1", "number a rank, least", "%s.min", sizes[k]);
        series_add_column(table, "1", "number a rank, mean", "%s.mean", sizes[k]);
        series_add_column(table, "1", "number a rank, largest", "%s.max", sizes[k]);
    }
    series_add_column(table, "ns", "cost of a step as boxes are cut, of a rank, least",
                      "weight.min");
    series_add_column(table, "ns", "cost of a step as boxes are cut, of a rank, mean",
                      "weight.mean");
    series_add_column(table, "ns", "cost of a step as boxes are cut, of a rank, largest",
                      "weight.max");
    series_add_column(table, "bytes", "resident memory a rank, least", "memory.min");
    series_add_column(table, "bytes", "resident memory a rank, mean", "memory.mean");
    series_add_column(table, "bytes", "resident memory a rank, largest", "memory.max");
}

static void add_box_columns(struct series *table)
{
    static const char axes[] = "xyz";
    series_add_column(table, "1", "steps done", "step");
    series_add_column(table, "1", "rank that owns the box", "rank");
    for (int k = 0; k < 3; k++)
        series_add_column(table, "m", "least coordinate, -infinity where the box is open",
                          "low_%c", axes[k]);
    for (int k = 0; k < 3; k++)
        series_add_column(table, "m", "end, infinity where the box is open", "high_%c",
                          axes[k]);
}

void runtime_subdomains(struct runtime *runtime, const struct boxes *boxes, int64_t step)
{
    for (int q = 0; q < boxes->n_ranks; q++) {
        const double *low = boxes->low[q], *high = boxes->high[q];
        const double row[] = {(double)step, q,       low[0],  low[1],
                              low[2],       high[0], high[1], high[2]};
        series_add_row(&runtime->subdomains, row);
    }
}

void runtime_init(struct runtime *runtime, int64_t step)
{
    *runtime = (struct runtime){.row_step = step};
    runtime->started = runtime->row_started = runtime->mark = timer_now();
    series_init(&runtime->table, "runtime");
    add_columns(&runtime->table);
    series_init(&runtime->subdomains, "subdomains");
    add_box_columns(&runtime->subdomains);
}

void runtime_clear(struct runtime *runtime)
{
    series_clear(&runtime->table);
    series_clear(&runtime->subdomains);
}

void runtime_begin(struct runtime *runtime)
{
    runtime->mark = timer_now();
}

void runtime_end(struct runtime *runtime, enum runtime_phase phase)
{
    const double now = timer_now();
    runtime->phase[phase] += now - runtime->mark;
    runtime->mark = now;
}

double runtime_memory(void)
{
    long pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file == NULL)
        return 0.0;
    const int n = fscanf(file, "%*s %ld", &pages);
    fclose(file);
    return n == 1 ? (double)pages * (double)sysconf(_SC_PAGESIZE) : 0.0;
}

/* Appends least, mean and largest of an integer over ranks. */
static void spread(const struct comm *comm, double *row, int *n, int64_t value, double unit)
{
    int64_t sum = value, extremes[2] = {value, -value};
    comm_sum_int(comm, &sum, 1);
    comm_max_int(comm, extremes, 2);
    row[(*n)++] = (double)-extremes[1] * unit;
    row[(*n)++] = (double)sum * unit / comm->n_ranks;
    row[(*n)++] = (double)extremes[0] * unit;
}

void runtime_row(struct runtime *runtime, const struct comm *comm, int64_t step, double time,
                 const struct runtime_sizes *sizes)
{
    const double now = timer_now();
    double row[VALUES_MAX] = {(double)step,
                              time,
                              now - runtime->row_started,
                              comm->n_ranks,
                              (double)(step - runtime->row_step),
                              (double)sizes->n_spheres,
                              (double)runtime->particle_steps};
    int n = 7;
    for (int p = 0; p < RUNTIME_N_PHASES; p++)
        spread(comm, row, &n, (int64_t)(runtime->phase[p] * NANOSECONDS), 1.0 / NANOSECONDS);
    int64_t sums[] = {runtime->migrated, runtime->nodes_migrated, runtime->told};
    comm_sum_int(comm, sums, 3);
    const double counts[] = {(double)runtime->searches,
                             (double)runtime->prunes,
                             (double)runtime->redistributions,
                             (double)runtime->repartitions,
                             (double)sums[0],
                             (double)sums[1],
                             (double)sums[2],
                             sizes->imbalance};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++)
        row[n++] = counts[k];
    const int64_t numbers[] = {sizes->n_owned,       sizes->n_ghosts,     sizes->n_internal,
                               sizes->n_interfacial, sizes->n_candidates, sizes->n_contacts,
                               sizes->n_nodes,       sizes->n_copies,     sizes->n_elements};
    for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
        spread(comm, row, &n, numbers[k], 1.0);
    spread(comm, row, &n, sizes->weight, 1.0);
    spread(comm, row, &n, (int64_t)runtime_memory(), 1.0);
    CHECK(n == runtime->table.n_columns, "%d values for %d columns", n,
          runtime->table.n_columns);
    if (comm->rank == 0)
        series_add_row(&runtime->table, row);
    for (int p = 0; p < RUNTIME_N_PHASES; p++)
        runtime->phase[p] = 0.0;
    runtime->searches = runtime->prunes = runtime->redistributions = runtime->repartitions = 0;
    runtime->migrated = runtime->particle_steps = 0;
    runtime->nodes_migrated = runtime->told = 0;
    runtime->row_step = step;
    runtime->row_started = now;
}
