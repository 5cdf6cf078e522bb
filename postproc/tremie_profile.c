/*
 * tremie-profile: stress, plastic strain and what presses on a deformable body against depth
 * below one of its sides, from a snapshot, or from several of a run in the mean.
 *
 * Depth is that of an element's middle at the start, so an element stays in its slice while the
 * body deforms.  Means are weighted by the elements' volume at the start, of shells and
 * membranes by their area; elements that have failed are left out.  The pressure on a sheet is
 * the mean of its corners', the stress in it that of its middle.
 */
#include <errno.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "arguments.h"
#include "base/array.h"
#include "base/report.h"
#include "plot.h"
#include "records.h"
#include "sheet.h"
#include "store/file.h"
#include "store/snapshot.h"

enum { SLICES_MOST = 100000, NOTHING_TO_REPORT = 1 };

/* What is shown, in this order, where the snapshot has it. */
enum { STRESSES = 6, MISES = STRESSES, PLASTIC, FLOWED, PRESSURE, N_VALUES };

static const struct {
    const char *name; /* of a column of the table */
    const char *heading, *unit;
    int component;
} VALUES[N_VALUES] = {
    {"stress", "stress_xx", "Pa", 0},     {"stress", "stress_yy", "Pa", 1},
    {"stress", "stress_zz", "Pa", 2},     {"stress", "stress_xy", "Pa", 3},
    {"stress", "stress_yz", "Pa", 4},     {"stress", "stress_zx", "Pa", 5},
    {"von_mises", "von_mises", "Pa", 0},  {"plastic_strain", "plastic_strain", "1", 0},
    {"plastic_strain", "flowed", "1", 0}, {"contact_pressure", "contact_pressure", "Pa", 0},
};

static const char *const sides[] = {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max", NULL};

struct profile {
    int n_snapshots;
    int n;                    /* slices */
    double *depth;            /* of their middles [m] */
    double *volume;           /* of the elements in each, or their area [m3], [m2] */
    double *count;            /* of these */
    double *values[N_VALUES]; /* means; NULL: not in the snapshot */
};

/* -------------------------------------------------------------------------------- finding */

static void corner_place(const struct snapshot_solid *solid, int64_t e, int c, double x[3])
{
    const int32_t *corners = solid->parts[SNAPSHOT_CORNERS].rows;
    const double(*places)[3] = (const double(*)[3])solid->parts[SNAPSHOT_REFERENCE].rows;
    memcpy(x, places[corners[e * solid->parts[SNAPSHOT_CORNERS].width + c]], 3 * sizeof *x);
}

static double tetrahedron_volume(const struct snapshot_solid *solid, int64_t e,
                                 const int corners[4])
{
    double x[4][3], d[3][3];
    for (int c = 0; c < 4; c++)
        corner_place(solid, e, corners[c], x[c]);
    for (int c = 0; c < 3; c++)
        for (int k = 0; k < 3; k++)
            d[c][k] = x[c + 1][k] - x[0][k];
    return fabs(d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
                d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
                d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0])) /
           6.0;
}

static double triangle_area(const struct snapshot_solid *solid, int64_t e, int b, int c)
{
    double x[3][3], d[2][3], sum = 0.0;
    corner_place(solid, e, 0, x[0]);
    corner_place(solid, e, b, x[1]);
    corner_place(solid, e, c, x[2]);
    for (int k = 0; k < 3; k++) {
        d[0][k] = x[1][k] - x[0][k];
        d[1][k] = x[2][k] - x[0][k];
    }
    for (int k = 0; k < 3; k++) {
        const double part = d[0][k] * d[1][(k + 1) % 3] - d[0][(k + 1) % 3] * d[1][k];
        sum += part * part;
    }
    return 0.5 * sqrt(sum);
}

/* A hexahedron is six tetrahedra about its diagonal. */
static double volume_of(const struct snapshot_solid *solid, int64_t e)
{
    static const int parts[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                    {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
    static const int whole[4] = {0, 1, 2, 3};
    double volume = 0.0;
    if (snapshot_is_sheet(solid, e))
        return triangle_area(solid, e, 1, 2) +
               (snapshot_n_corners(solid, e) == 4 ? triangle_area(solid, e, 2, 3) : 0.0);
    if (snapshot_n_corners(solid, e) == 4)
        return tetrahedron_volume(solid, e, whole);
    for (int t = 0; t < 6; t++)
        volume += tetrahedron_volume(solid, e, parts[t]);
    return volume;
}

/* The body's extent along an axis at the start. */
static void find_extent(const struct snapshot_solid *solid, int axis, double extent[2])
{
    const double(*places)[3] = (const double(*)[3])solid->parts[SNAPSHOT_REFERENCE].rows;
    extent[0] = (double)INFINITY;
    extent[1] = -(double)INFINITY;
    for (int64_t i = 0; i < solid->n_nodes; i++) {
        extent[0] = fmin(extent[0], places[i][axis]);
        extent[1] = fmax(extent[1], places[i][axis]);
    }
}

static bool is_alive(const struct snapshot_solid *solid, int64_t e)
{
    const int column = snapshot_column(&solid->elements, "alive");
    double alive = 1.0;
    if (column >= 0)
        snapshot_get(&solid->elements, e, column, &alive);
    return alive > 0.0;
}

/* Mean of what presses on the corners. */
static double pressure_on(const struct snapshot_solid *solid, int64_t e)
{
    const int column = snapshot_column(&solid->nodes, "contact_pressure");
    const int width = solid->parts[SNAPSHOT_CORNERS].width, n = snapshot_n_corners(solid, e);
    const int32_t *corners = (const int32_t *)solid->parts[SNAPSHOT_CORNERS].rows + e * width;
    double sum = 0.0;
    for (int c = 0; c < n; c++) {
        double pressure;
        snapshot_get(&solid->nodes, corners[c], column, &pressure);
        sum += pressure;
    }
    return sum / n;
}

static void add_element(struct profile *profile, const struct snapshot_solid *solid, int64_t e,
                        int slice)
{
    const double volume = volume_of(solid, e);
    profile->volume[slice] += volume;
    profile->count[slice] += 1.0;
    for (int v = 0; v < N_VALUES; v++) {
        double numbers[STRESSES];
        if (profile->values[v] == NULL)
            continue;
        if (v == PRESSURE) {
            profile->values[v][slice] +=
                snapshot_is_sheet(solid, e) ? volume * pressure_on(solid, e) : 0.0;
            continue;
        }
        snapshot_get(&solid->elements, e, snapshot_column(&solid->elements, VALUES[v].name),
                     numbers);
        const double number = numbers[VALUES[v].component];
        profile->values[v][slice] += volume * (v == FLOWED ? number > 0.0 : number);
    }
}

/* Depth of an element's middle below a side. */
static double depth_of(const struct snapshot_solid *solid, int64_t e, int side,
                       const double extent[2])
{
    const int n = snapshot_n_corners(solid, e);
    double sum = 0.0, x[3];
    for (int c = 0; c < n; c++) {
        corner_place(solid, e, c, x);
        sum += x[side / 2];
    }
    return side % 2 == 0 ? sum / n - extent[0] : extent[1] - sum / n;
}

static void begin_profile(struct profile *profile, const struct snapshot_solid *solid,
                          bool has_sheets, double width, int n)
{
    const size_t size = (size_t)n;
    profile->n = n;
    profile->depth = array_allocate(size, sizeof *profile->depth);
    profile->volume = array_allocate(size, sizeof *profile->volume);
    profile->count = array_allocate(size, sizeof *profile->count);
    for (int v = 0; v < N_VALUES; v++)
        if (v == PRESSURE ? has_sheets && snapshot_column(&solid->nodes, VALUES[v].name) >= 0
                          : snapshot_column(&solid->elements, VALUES[v].name) >= 0)
            profile->values[v] = array_allocate(size, sizeof *profile->values[v]);
    for (int k = 0; k < n; k++)
        profile->depth[k] = (k + 0.5) * width;
}

/* Makes means of sums; slices without an element, finer than the mesh, are dropped. */
static void finish_profile(struct profile *profile)
{
    int n = 0;
    for (int k = 0; k < profile->n; k++) {
        if (!(profile->count[k] > 0.0))
            continue;
        profile->depth[n] = profile->depth[k];
        profile->count[n] = profile->count[k] / profile->n_snapshots;
        for (int v = 0; v < N_VALUES; v++)
            if (profile->values[v] != NULL)
                profile->values[v][n] = profile->values[v][k] / profile->volume[k];
        n++;
    }
    profile->n = n;
}

/* Adds a snapshot to the sums; the first one begins them. */
static void add_snapshot(struct profile *profile, const struct snapshot_solid *solid, int side,
                         int n)
{
    double extent[2];
    bool has_sheets = false;
    find_extent(solid, side / 2, extent);
    const double width = (extent[1] - extent[0]) / n;
    for (int64_t e = 0; e < solid->n_elements; e++)
        has_sheets = has_sheets || snapshot_is_sheet(solid, e);
    if (profile->n_snapshots++ == 0)
        begin_profile(profile, solid, has_sheets, width, n);
    for (int64_t e = 0; e < solid->n_elements; e++) {
        const int slice = (int)(depth_of(solid, e, side, extent) / width);
        if (is_alive(solid, e))
            add_element(profile, solid, e, slice < n ? slice : n - 1);
    }
}

static void clear_profile(struct profile *profile)
{
    free(profile->depth);
    free(profile->volume);
    free(profile->count);
    for (int v = 0; v < N_VALUES; v++)
        free(profile->values[v]);
}

/* -------------------------------------------------------------------------------- showing */

static void fill_sheet(struct sheet *sheet, const struct profile *profile, int digits)
{
    sheet_init(sheet);
    sheet_heading(sheet, "depth_m");
    sheet_heading(sheet, "elements");
    for (int v = 0; v < N_VALUES; v++) {
        char *unit = records_unit(VALUES[v].unit);
        if (profile->values[v] != NULL)
            sheet_heading(sheet, "%s%s", VALUES[v].heading, unit);
        free(unit);
    }
    for (int k = 0; k < profile->n; k++) {
        sheet_cell(sheet, "%.*g", digits, profile->depth[k]);
        sheet_cell(sheet, "%.0f", profile->count[k]);
        for (int v = 0; v < N_VALUES; v++)
            if (profile->values[v] != NULL)
                sheet_cell(sheet, "%.*g", digits, profile->values[v][k]);
    }
}

static int write_svg(const struct profile *profile, const char *name, const char *path)
{
    char *title = array_format("Means over slices of %s", name);
    struct plot plot = {.title = title,
                        .legend_beside = true,
                        .n_panels = 1,
                        .panels = {{.x_label = "depth [m]", .y_label = "stress [Pa]"},
                                   {.x_label = "depth [m]", .y_label = "plastic strain [-]"}}};
    for (int v = 0; v < N_VALUES; v++) {
        const struct plot_curve curve = {.label = v == PLASTIC ? NULL : VALUES[v].heading,
                                         .n = profile->n,
                                         .x = profile->depth,
                                         .y = profile->values[v],
                                         .colour = v,
                                         .markers = true};
        if (profile->values[v] == NULL)
            continue;
        plot_add_curve(&plot.panels[v == PLASTIC], curve);
        plot.n_panels = v == PLASTIC ? 2 : plot.n_panels;
    }
    const int status = plot_write_svg(&plot, path);
    free(title);
    return status;
}

struct request {
    const char *path, *body, *csv, *svg;
    int side;
    double slices, since;
};

static int show(const struct request *request, struct profile *profile, const char *name,
                double time)
{
    struct sheet sheet;
    finish_profile(profile);
    if (profile->n_snapshots > 1)
        printf("%s, mean of %d snapshots up to %.6g s, depth below %s\n\n", name,
               profile->n_snapshots, time, sides[request->side]);
    else
        printf("%s at %.6g s, depth below %s\n\n", name, time, sides[request->side]);
    fill_sheet(&sheet, profile, 5);
    sheet_print(&sheet, stdout);
    sheet_clear(&sheet);
    int status = REPORT_FINISHED;
    if (request->csv != NULL) {
        fill_sheet(&sheet, profile, 12);
        status = sheet_write_csv(&sheet, request->csv);
        sheet_clear(&sheet);
    }
    if (request->svg != NULL && status == REPORT_FINISHED)
        status = write_svg(profile, name, request->svg);
    return status;
}

static void say_which(const struct request *request, const struct snapshot *snapshot)
{
    char *names = array_string("");
    for (int s = 0; s < snapshot->n_solids; s++) {
        char *longer =
            array_format("%s%s%s", names, s > 0 ? ", " : "", snapshot->solids[s].name);
        free(names);
        names = longer;
    }
    report_error("%s; give --body one of %s",
                 request->body != NULL ? "there is no such deformable body"
                                       : "there are several deformable bodies",
                 names);
    free(names);
}

/* The body asked for, or the only one; NULL with what is wrong said. */
static const struct snapshot_solid *choose(const struct request *request,
                                           const struct snapshot *snapshot, int *status)
{
    *status = NOTHING_TO_REPORT;
    for (int s = 0; s < snapshot->n_solids; s++) {
        const struct snapshot_solid *solid = &snapshot->solids[s];
        if (request->body != NULL ? strcmp(solid->name, request->body) != 0
                                  : snapshot->n_solids > 1)
            continue;
        if (snapshot_column(&solid->elements, "stress") >= 0 ||
            snapshot_column(&solid->elements, "von_mises") >= 0 ||
            snapshot_column(&solid->elements, "plastic_strain") >= 0)
            return solid;
        printf("the snapshot has neither stress nor plastic strain of %s; ask for it in "
               "output.snapshots.solids\n",
               solid->name);
        return NULL;
    }
    if (snapshot->n_solids == 0) {
        printf("%s has no deformable body\n", request->path);
        return NULL;
    }
    say_which(request, snapshot);
    *status = REPORT_BAD_INPUT;
    return NULL;
}

/* Reads a snapshot and adds it, unless it is too early. */
static int add_file(const struct request *request, const char *path, bool is_last,
                    struct profile *profile, char **name, double *time)
{
    struct snapshot snapshot;
    char *why = snapshot_read(path, &snapshot);
    int status = REPORT_STORAGE;
    if (why != NULL) {
        report_error("cannot read the snapshot %s: %s; use another one", path, why);
        free(why);
        return status;
    }
    const struct snapshot_solid *solid = choose(request, &snapshot, &status);
    if (solid != NULL) {
        status = REPORT_FINISHED;
        *time = (double)snapshot.step * snapshot.dt;
        if (is_last || *time >= request->since)
            add_snapshot(profile, solid, request->side, (int)request->slices);
        free(*name);
        *name = array_string(solid->name);
    }
    snapshot_clear(&snapshot);
    return status;
}

/* The file, or the newest snapshot of a run, or all of them that are late enough. */
static int add_all(const struct request *request, struct profile *profile, char **name,
                   double *time)
{
    struct stat entry;
    if (stat(request->path, &entry) != 0) {
        report_error("there is no %s; give a snapshot or the folder of a run", request->path);
        return REPORT_BAD_INPUT;
    }
    if (!S_ISDIR(entry.st_mode))
        return add_file(request, request->path, true, profile, name, time);
    char *folder = array_format("%s/snapshots", request->path);
    int64_t *steps;
    const int n = file_steps(folder, &steps);
    int status = n > 0 ? REPORT_FINISHED : REPORT_BAD_INPUT;
    if (n == 0)
        report_error("%s has no snapshot; ask for some with output.snapshots in the job",
                     request->path);
    for (int k = isfinite(request->since) ? 0 : n - 1; k < n && status == REPORT_FINISHED;
         k++) {
        char *path = file_step_path(folder, steps[k]);
        status = add_file(request, path, k == n - 1, profile, name, time);
        free(path);
    }
    free(steps);
    free(folder);
    return status;
}

static int run(const struct request *request)
{
    struct profile profile = {.n = 0};
    char *name = NULL;
    double time;
    int status = add_all(request, &profile, &name, &time);
    if (status == REPORT_FINISHED)
        status = show(request, &profile, name, time);
    clear_profile(&profile);
    free(name);
    return status;
}

int main(int argc, char **argv)
{
    struct request request = {.side = 5, .slices = 20.0, .since = (double)INFINITY};
    const struct arguments_entry entries[] = {
        {"body", 0, ARGUMENTS_TEXT, &request.body, "NAME",
         "the deformable body; needed where there are several", NULL},
        {"from", 0, ARGUMENTS_CHOICE, &request.side, "SIDE",
         "the side from which depth is counted, by default z_max", sides},
        {"slices", 0, ARGUMENTS_NUMBER, &request.slices, "N",
         "into how many slices the body is cut, by default 20; those without an element's "
         "middle are left out",
         NULL},
        {"since", 0, ARGUMENTS_NUMBER, &request.since, "TIME",
         "of a run's folder the mean of all snapshots from this time on [s]", NULL},
        {"csv", 0, ARGUMENTS_TEXT, &request.csv, "FILE",
         "writes the slices as comma-separated values", NULL},
        {"svg", 0, ARGUMENTS_TEXT, &request.svg, "FILE",
         "draws stress and plastic strain against depth", NULL},
    };
    const struct arguments_page page = {
        "tremie-profile",
        "SNAPSHOT|RUN [--body NAME] [--from SIDE] [--slices N] [--since TIME]\n"
        "    [--csv FILE] [--svg FILE]",
        "Shows mean stress and plastic strain of a deformable body's elements in slices below one\n"
        "of its sides, and the share of them that has flowed, weighted by volume; of shells and\n"
        "membranes by area, and the mean pressure of what touches them.  Depth is that at the\n"
        "start.  Of a run's folder the newest snapshot is taken.\n"
        "\n"
        "Exit status: 0 shown; 1 nothing to show (no deformable body, no stress); 2 bad arguments;\n"
        "4 a file cannot be read or written.\n",
        sizeof entries / sizeof *entries,
        entries,
        1,
        1};
    int n;
    const int status = arguments_read(&page, argc, argv, &n);
    if (status != ARGUMENTS_GO_ON)
        return status;
    request.path = argv[1];
    if (!(request.slices >= 1.0 && request.slices <= SLICES_MOST)) {
        report_error("--slices is %g; give a number from 1 to %d", request.slices, SLICES_MOST);
        return REPORT_BAD_INPUT;
    }
    return run(&request);
}
