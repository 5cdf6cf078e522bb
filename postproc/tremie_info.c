/*
 * tremie-info: what a checkpoint, a snapshot, a series file or a run's folder holds, and
 * whether it is whole.
 *
 * A checkpoint is read completely, which verifies all its checksums; so are the checkpoints of
 * a run.  Series carry the checksums of HDF5, which reading verifies as well.
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
#include "base/comm.h"
#include "base/report.h"
#include "content.h"
#include "records.h"
#include "scene.h"
#include "sheet.h"
#include "store/file.h"
#include "store/snapshot.h"

static const double PI = 3.14159265358979323846;

/* ------------------------------------------------------------------------------ checkpoints */

/* What a set of spheres amounts to. */
struct census {
    int64_t n;
    double least[3], most[3]; /* of the spheres' surfaces [m] */
    double radius[2];         /* smallest and largest [m] */
    double speed;             /* largest [m/s] */
    double volume;            /* [m3] */
    double mass;              /* [kg]; not a number without the job */
};

static struct census census_start(void)
{
    return (struct census){.least = {INFINITY, INFINITY, INFINITY},
                           .most = {-INFINITY, -INFINITY, -INFINITY},
                           .radius = {INFINITY, -INFINITY}};
}

static void count_sphere(struct census *census, const struct scene *scene, int i)
{
    const struct spheres *spheres = &scene->spheres;
    const double *x = sphere_position(spheres, i), *v = sphere_velocity(spheres, i);
    const double r = sphere_radius(spheres, i);
    const double speed = sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    const int material = spheres->material[i];
    for (int k = 0; k < 3; k++) {
        census->least[k] = fmin(census->least[k], x[k] - r);
        census->most[k] = fmax(census->most[k], x[k] + r);
    }
    census->radius[0] = fmin(census->radius[0], r);
    census->radius[1] = fmax(census->radius[1], r);
    census->speed = fmax(census->speed, speed);
    census->volume += 4.0 / 3.0 * PI * r * r * r;
    census->n++;
    if (scene->has_job && material >= 0 && material < scene->job.n_materials)
        census->mass += 4.0 / 3.0 * PI * r * r * r * scene->job.materials[material].density;
    else
        census->mass = (double)NAN;
}

static void print_census(const struct census *census)
{
    if (census->n == 0)
        return;
    printf("  radii             %.6g to %.6g m\n", census->radius[0], census->radius[1]);
    printf("  extent            %.5g to %.5g, %.5g to %.5g, %.5g to %.5g m\n", census->least[0],
           census->most[0], census->least[1], census->most[1], census->least[2],
           census->most[2]);
    printf("  largest speed     %.5g m/s\n", census->speed);
    printf("  volume            %.6g m3\n", census->volume);
    if (!isnan(census->mass))
        printf("  mass              %.6g kg\n", census->mass);
}

/* What a group is made of that came from another job: this one does not say. */
static const char *material_found(const struct scene *scene, int group)
{
    int found = -1;
    for (int i = 0; i < scene->spheres.n_owned; i++) {
        const int material = scene->spheres.material[i];
        if (scene->spheres.group[i] != group)
            continue;
        if (found >= 0 && material != found)
            return "a mix";
        found = material;
    }
    return found >= 0 && found < scene->job.n_materials ? scene->job.materials[found].name
                                                        : "no material";
}

static const char *material_of_group(const struct scene *scene, int group)
{
    const struct job *job = &scene->job;
    if (group < job->n_spheres)
        return job->materials[job->spheres[group].material].name;
    if (group >= job->n_spheres + job->n_insertions)
        return material_found(scene, group);
    const struct job_insertion *insertion = &job->insertions[group - job->n_spheres];
    return insertion->n_mix > 0 ? "a mix" : job->materials[insertion->material].name;
}

/* Groups of spheres as the job names them, insertions, and what another job has left. */
static void print_groups(const struct scene *scene)
{
    for (int g = 0; scene_group(scene, g) != NULL; g++) {
        struct census census = census_start();
        for (int i = 0; i < scene->spheres.n_owned; i++)
            if (scene->spheres.group[i] == g)
                count_sphere(&census, scene, i);
        printf("  group %-11s %" PRId64 " of %s, %.6g kg\n", scene_group(scene, g), census.n,
               material_of_group(scene, g), census.mass);
    }
}

static void print_bodies(const struct scene *scene)
{
    for (int b = 0; b < scene->bodies.n; b++) {
        const struct body *body = &scene->bodies.list[b];
        int n = 0;
        for (int k = 0; k < scene->checkpoint.n_facet_contacts; k++)
            n += scene->checkpoint.facet_contacts[k].body == b;
        const int n_faces = body->mesh.n_faces + body->mesh.n_bands;
        printf("body %-14s %d %sface%s of %s, %s, %d contact%s\n", body->name, n_faces,
               body->mesh.n_bands > 0 ? "curved " : "", n_faces == 1 ? "" : "s",
               scene->job.materials[body->material].name, body->moves ? "moving" : "at rest", n,
               n == 1 ? "" : "s");
    }
}

static void print_scene(const struct scene *scene, bool listed)
{
    const struct checkpoint *checkpoint = &scene->checkpoint;
    struct census census = census_start();
    for (int i = 0; i < scene->spheres.n_owned; i++)
        count_sphere(&census, scene, i);
    printf("title               %s\n", checkpoint->title);
    printf("step                %" PRId64 " of %.6g s, so at %.9g s\n", checkpoint->step,
           checkpoint->dt, (double)checkpoint->step * checkpoint->dt);
    printf("spheres             %" PRId64 ", ids below %" PRId64 "\n", census.n,
           checkpoint->next_id);
    print_census(&census);
    print_groups(scene);
    printf("touching contacts   %d between spheres", checkpoint->n_contacts);
    if (census.n > 0)
        printf(" (%.3g on a sphere)", 2.0 * checkpoint->n_contacts / (double)census.n);
    printf(", %d with bodies\n", checkpoint->n_facet_contacts);
    print_bodies(scene);
    printf("sums kept           %d\n", checkpoint->n_monitors);
    for (int k = 0; k < checkpoint->n_monitors && listed; k++)
        printf("  %-32s %.9g\n", checkpoint->monitors[k].name,
               exact_sum_value(&checkpoint->monitors[k].sum));
}

static const char *unit_of(const struct field *field)
{
    return strcmp(field->unit, "1") == 0 ? "" : field->unit;
}

/* The greatest number of a column, where there is that. */
static void print_most(const struct table *table, const char *name)
{
    const int column = snapshot_column(table, name);
    double most = -INFINITY, value;
    for (int64_t i = 0; column >= 0 && i < table->n; i++) {
        snapshot_get(table, i, column, &value);
        most = fmax(most, value);
    }
    if (column >= 0 && table->n > 0)
        printf("  %-18sat most %.6g %s\n", name, most, unit_of(&table->columns[column].field));
}

static void print_solid(const struct snapshot_solid *solid)
{
    printf("solid %-13s %" PRId64 " elements, %" PRId64 " nodes of %s\n", solid->name,
           solid->n_elements, solid->n_nodes, solid->material);
    print_most(&solid->nodes, "contact_pressure");
    print_most(&solid->elements, "von_mises");
    print_most(&solid->elements, "plastic_strain");
}

static int show_snapshot(const char *path)
{
    struct snapshot snapshot;
    char *why = snapshot_read(path, &snapshot);
    if (why != NULL) {
        report_error("cannot read the snapshot %s: %s; use another one", path, why);
        free(why);
        return REPORT_STORAGE;
    }
    printf("%s: a snapshot; all checksums are right\n", path);
    printf("title               %s\n", snapshot.title);
    printf("step                %" PRId64 " of %.6g s, so at %.9g s\n", snapshot.step,
           snapshot.dt, (double)snapshot.step * snapshot.dt);
    printf("spheres             %" PRId64 "\n", snapshot.spheres.n_total);
    if (snapshot.has_contacts)
        printf("contacts            %" PRId64 " between spheres\n", snapshot.contacts.n_total);
    for (int b = 0; b < snapshot.n_bodies; b++) {
        const struct snapshot_body *body = &snapshot.bodies[b];
        printf("body %-14s %" PRId64 " triangles of %s", body->name, body->n_triangles,
               body->material);
        if (body->points_step != snapshot.step)
            printf(", as at step %" PRId64, body->points_step);
        printf("\n");
    }
    for (int s = 0; s < snapshot.n_solids; s++)
        print_solid(&snapshot.solids[s]);
    snapshot_clear(&snapshot);
    return REPORT_FINISHED;
}

static int show_checkpoint(const struct comm *comm, const char *path, bool listed)
{
    struct scene scene;
    const int status = scene_read(&scene, comm, path);
    if (status != REPORT_FINISHED)
        return status;
    printf("%s: a checkpoint; all checksums are right\n", path);
    print_scene(&scene, listed);
    scene_clear(&scene);
    return REPORT_FINISHED;
}

/* ------------------------------------------------------------------------------------ files */

/* Reads an item, which makes HDF5 verify what checksums it has. */
static bool item_reads(const struct content *content, const struct content_item *item)
{
    void *values = NULL;
    switch (item->kind) {
    case CONTENT_INT:
        values = content_ints(content, item);
        break;
    case CONTENT_DOUBLE:
        values = content_doubles(content, item);
        break;
    case CONTENT_TEXT:
        values = content_text(content, item);
        break;
    case CONTENT_OTHER:
        return true;
    }
    const bool read = values != NULL;
    free(values);
    return read;
}

static void list_item(struct sheet *sheet, const struct content *content,
                      const struct content_item *item)
{
    static const char *const kinds[] = {"integers", "doubles", "text", "other"};
    char *unit = content_note(content, item->path, "unit");
    char *help = content_note(content, item->path, "description");
    sheet_cell(sheet, "%s", item->path);
    sheet_cell(sheet, "%s", kinds[item->kind]);
    sheet_cell(sheet, "%" PRId64, item->n_rows);
    sheet_cell(sheet, "%" PRId64, item->width);
    sheet_cell(sheet, "%s", unit);
    sheet_cell(sheet, "%s", help);
    free(unit);
    free(help);
}

/* Lists the data sets of a file; says which cannot be read. */
static int list_items(const struct content *content, bool shown)
{
    static const char *const headings[] = {"data", "kind", "rows", "each", "unit", "what"};
    struct sheet sheet;
    int status = REPORT_FINISHED;
    sheet_init(&sheet);
    for (size_t i = 0; i < sizeof headings / sizeof *headings; i++)
        sheet_heading(&sheet, "%s", headings[i]);
    for (int i = 0; i < content->n; i++) {
        const struct content_item *item = &content->items[i];
        if (!item_reads(content, item)) {
            report_error("%s is damaged; use another copy of the file", item->path);
            status = REPORT_STORAGE;
        }
        if (strchr(item->path, '@') == NULL && strncmp(item->path, "/checksums/", 11) != 0)
            list_item(&sheet, content, item);
    }
    if (shown)
        sheet_print(&sheet, stdout);
    sheet_clear(&sheet);
    return status;
}

static char *format_of(const struct content *content)
{
    const struct content_item *item = content_find(content, "/run@format");
    char *format = item != NULL ? content_text(content, item) : NULL;
    return format != NULL ? format : array_string("");
}

static int show_file(const struct comm *comm, const char *path, bool listed)
{
    struct content content;
    char *why = content_open(&content, path);
    if (why != NULL) {
        report_error("%s; give a checkpoint, a snapshot, a series file or the folder of a run",
                     why);
        free(why);
        return REPORT_STORAGE;
    }
    char *format = format_of(&content);
    int status = REPORT_FINISHED;
    if (strcmp(format, "tremie checkpoint") == 0) {
        status = show_checkpoint(comm, path, listed);
    } else if (strcmp(format, "tremie snapshot") == 0) {
        status = show_snapshot(path);
        listed = true;
    } else if (strcmp(format, "tremie series") == 0) {
        printf("%s: a segment of a run's series\n", path);
        listed = true;
    } else {
        report_error(
            "%s was not written by tremie; give a checkpoint, a snapshot, a series file or the folder of a run",
            path);
        status = REPORT_STORAGE;
    }
    if (status == REPORT_FINISHED)
        status = list_items(&content, listed);
    free(format);
    content_clear(&content);
    return status;
}

/* ------------------------------------------------------------------------------------- runs */

static void print_last(const struct series *series)
{
    for (int k = 0; k < series->n_columns; k++)
        printf("  %-28s %.9g %s\n", series->columns[k].name,
               records_last(series, series->columns[k].name),
               strcmp(series->columns[k].unit, "1") == 0 ? "" : series->columns[k].unit);
}

/* All samples; headings have the unit at the end, as in time_s, speed_max_m_s. */
static int write_csv(const struct series *series, const char *path)
{
    struct sheet sheet;
    sheet_init(&sheet);
    for (int k = 0; k < series->n_columns; k++) {
        const struct series_column *column = &series->columns[k];
        char *unit = records_unit(column->unit);
        sheet_heading(&sheet, "%s%s", column->name, unit);
        free(unit);
    }
    for (int i = 0; i < series->n_rows * series->n_columns; i++)
        sheet_cell(&sheet, "%.12g", series->values[i]);
    const int status = sheet_write_csv(&sheet, path);
    sheet_clear(&sheet);
    return status;
}

static int show_series(const char *run, const char *table, const char *csv)
{
    struct series series;
    char *why;
    int status = REPORT_FINISHED;
    if (!series_read(&series, run, table, &why)) {
        printf("series              none (%s)\n", why);
        if (csv != NULL) {
            report_error("no %s is written: %s has no series", csv, run);
            status = REPORT_STORAGE;
        }
        free(why);
        return status;
    }
    printf("series              %d samples; the last one:\n", series.n_rows);
    print_last(&series);
    if (csv != NULL)
        status = write_csv(&series, csv);
    series_clear(&series);
    return status;
}

/* One line for each checkpoint of the run; the newest is described in full. */
static int show_checkpoints(const struct comm *comm, const char *run)
{
    char *folder = array_format("%s/checkpoints", run);
    int64_t *steps;
    const int n = file_steps(folder, &steps);
    int worst = n < 0 ? REPORT_STORAGE : REPORT_FINISHED;
    if (n < 0)
        report_error("cannot read %s: %s", folder, strerror(errno));
    printf("checkpoints         %d\n", n < 0 ? 0 : n);
    for (int i = 0; i < n; i++) {
        char *path = file_step_path(folder, steps[i]);
        struct stat entry = {0};
        struct scene scene;
        const int status = scene_read(&scene, comm, path);
        const bool sized = stat(path, &entry) == 0;
        printf("  %s: %.1f MiB, %s\n", path, sized ? (double)entry.st_size / 1048576.0 : 0.0,
               status == REPORT_FINISHED ? "all checksums are right" : "cannot be used");
        if (status == REPORT_FINISHED && i == n - 1)
            print_scene(&scene, false);
        if (status == REPORT_FINISHED)
            scene_clear(&scene);
        worst = status > worst ? status : worst;
        free(path);
    }
    free(steps);
    free(folder);
    return worst;
}

static int show_run(const struct comm *comm, const char *run, const char *table,
                    const char *csv)
{
    char *job = array_format("%s/job.yaml", run), *segments = array_format("%s/series", run);
    struct stat entry;
    int status = REPORT_BAD_INPUT;
    if (stat(job, &entry) != 0 && stat(segments, &entry) != 0) {
        report_error(
            "%s is not the folder of a run; give one, or a checkpoint, or a series file", run);
    } else {
        printf("%s: a run\n", run);
        status = show_checkpoints(comm, run);
        const int shown = show_series(run, table, csv);
        status = shown > status ? shown : status;
    }
    free(job);
    free(segments);
    return status;
}

int main(int argc, char **argv)
{
    bool listed = false;
    const char *csv = NULL, *table = "series";
    const struct arguments_entry entries[] = {
        {"csv", 0, ARGUMENTS_TEXT, &csv, "FILE",
         "writes all samples of a run's series as comma-separated values", NULL},
        {"table", 0, ARGUMENTS_TEXT, &table, "NAME",
         "which of a run's series: series (as when left out), or runtime", NULL},
        {"list", 0, ARGUMENTS_FLAG, &listed, NULL,
         "lists the sums and data sets of a checkpoint as well", NULL},
    };
    const struct arguments_page page = {
        "tremie-info",
        "FILE|RUN [--csv FILE] [--table NAME] [--list]",
        "Shows what a checkpoint, a snapshot, a series file or the folder of a run holds: step,\n"
        "time, counts, extents, masses, energies; and verifies the checksums.\n"
        "\n"
        "Exit status: 0 shown and whole; 2 bad arguments; 4 a file is damaged or cannot be read.\n",
        sizeof entries / sizeof *entries,
        entries,
        1,
        1};
    int n;
    int status = arguments_read(&page, argc, argv, &n);
    if (status != ARGUMENTS_GO_ON)
        return status;
    struct stat entry;
    if (stat(argv[1], &entry) != 0) {
        report_error(
            "there is no %s; give a checkpoint, a snapshot, a series file or the folder of a run",
            argv[1]);
        return REPORT_BAD_INPUT;
    }
    if (csv != NULL && !S_ISDIR(entry.st_mode)) {
        report_error("--csv goes with a run, and %s is a file; give the folder of a run",
                     argv[1]);
        return REPORT_BAD_INPUT;
    }
    COMM_CHECK(MPI_Init(NULL, NULL));
    const struct comm comm = comm_world();
    status = S_ISDIR(entry.st_mode) ? show_run(&comm, argv[1], table, csv)
                                    : show_file(&comm, argv[1], listed);
    COMM_CHECK(MPI_Finalize());
    return status;
}
