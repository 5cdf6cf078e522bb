/*
 * See xdmf.h.
 *
 * Each thing at each time is a text made once; a file is all of them, each thing's in a
 * collection over time, written anew with each snapshot: a thousand snapshots make a megabyte.
 * A collection a body, and not one of all bodies at a time, because readers number names that
 * come again.
 */
#include "store/xdmf.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "store/file.h"
#include "store/run_folder.h"
#include "store/snapshot.h"

static const char *const NAMES[XDMF_N_KINDS] = {"spheres", "bodies", "contacts", "solids"};

/* ------------------------------------------------------------------------------------ texts */

/* A data set of the file of a step. */
static void put_item(FILE *out, const struct field *field, int64_t n, int64_t step,
                     const char *group)
{
    const bool whole = field->type == FIELD_INT32 || field->type == FIELD_INT64;
    char *file = file_step_path("", step);
    fprintf(
        out,
        "<DataItem Format=\"HDF\" NumberType=\"%s\" Precision=\"%zu\" Dimensions=\"%" PRId64,
        whole ? "Int" : "Float", field_component_size(field->type), n);
    if (field->width > 1)
        fprintf(out, " %d", field->width);
    fprintf(out, "\">%s:/%s/%s</DataItem>", file + 1, group, field->name);
    free(file);
}

static void put_head(FILE *out, const char *name, double time)
{
    fprintf(out, "<Grid Name=\"%s\"><Time Value=\"%.17g\"/>\n", name, time);
}

/* Readers fail where there is no point at all, so nothing is a point that no cell shows. */
static void put_nothing(FILE *out)
{
    fprintf(out,
            " <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"0\"/>\n"
            " <Geometry GeometryType=\"XYZ\"><DataItem Format=\"XML\" NumberType=\"Float\" "
            "Dimensions=\"1 3\">0 0 0</DataItem></Geometry>\n</Grid>\n");
}

/* The columns of a table, on points or cells, but for places. */
static void put_attributes(FILE *out, const struct table *table, int64_t step,
                           const char *centre)
{
    for (int k = 0; k < table->n_columns; k++) {
        const struct field *field = &table->columns[k].field;
        if (strcmp(field->name, "position") == 0)
            continue;
        fprintf(out, " <Attribute Name=\"%s\" AttributeType=\"%s\" Center=\"%s\">", field->name,
                field->width == 1   ? "Scalar"
                : field->width == 3 ? "Vector"
                                    : "Matrix",
                centre);
        put_item(out, field, table->n_total, step, table->name);
        fprintf(out, "</Attribute>\n");
    }
}

/* Points that carry the columns of a table. */
static void put_table(FILE *out, const struct snapshot *snapshot, const struct table *table,
                      double time)
{
    const int64_t n = table->n_total;
    const int position = snapshot_column(table, "position");
    put_head(out, table->name, time);
    if (n == 0) {
        put_nothing(out);
        return;
    }
    fprintf(out, " <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"%" PRId64 "\"/>\n",
            n);
    fprintf(out, " <Geometry GeometryType=\"XYZ\">");
    put_item(out, &table->columns[position].field, n, snapshot->step, table->name);
    fprintf(out, "</Geometry>\n");
    put_attributes(out, table, snapshot->step, "Node");
    fprintf(out, "</Grid>\n");
}

static void put_body(FILE *out, const struct snapshot_body *body, double time)
{
    static const struct field points = {"points", "", "", FIELD_DOUBLE, 3, 0};
    static const struct field triangles = {"triangles", "", "", FIELD_INT32, 3, 0};
    char *group = array_format("bodies/%s", body->name);
    put_head(out, body->name, time);
    fprintf(out, " <Topology TopologyType=\"Triangle\" NumberOfElements=\"%" PRId64 "\">",
            body->n_triangles);
    put_item(out, &triangles, body->n_triangles, body->triangles_step, group);
    fprintf(out, "</Topology>\n <Geometry GeometryType=\"XYZ\">");
    put_item(out, &points, body->n_points, body->points_step, group);
    fprintf(out, "</Geometry>\n</Grid>\n");
    free(group);
}

/* An unstructured grid; cells of both kinds are listed one behind the other. */
static void put_solid(FILE *out, const struct snapshot_solid *solid, int64_t step, double time)
{
    const int listed = solid->mixed ? SNAPSHOT_CELLS : SNAPSHOT_CORNERS;
    const struct snapshot_rows *cells = &solid->parts[listed];
    const struct field field = {
        solid->mixed ? "cells" : "corners", "", "", FIELD_INT32, cells->width, 0};
    char *group = array_format("solids/%s", solid->name);
    put_head(out, solid->name, time);
    fprintf(out, " <Topology TopologyType=\"%s\" NumberOfElements=\"%" PRId64 "\">",
            solid->mixed        ? "Mixed"
            : cells->width == 4 ? "Tetrahedron"
                                : "Hexahedron",
            solid->n_elements);
    put_item(out, &field, cells->n, cells->step, group);
    fprintf(out, "</Topology>\n <Geometry GeometryType=\"XYZ\">");
    put_item(out, &solid->nodes.columns[SNAPSHOT_NODE_POSITION].field, solid->n_nodes, step,
             solid->nodes.name);
    fprintf(out, "</Geometry>\n");
    put_attributes(out, &solid->nodes, step, "Node");
    put_attributes(out, &solid->elements, step, "Cell");
    fprintf(out, "</Grid>\n");
    free(group);
}

/* ---------------------------------------------------------------------------------- entries */

static void entry_clear(struct xdmf_entry *entry)
{
    for (int g = 0; g < entry->n; g++) {
        free(entry->grids[g].name);
        free(entry->grids[g].text);
    }
    free(entry->grids);
    *entry = (struct xdmf_entry){0};
}

void xdmf_clear(struct xdmf *xdmf)
{
    for (int i = 0; i < xdmf->n; i++)
        entry_clear(&xdmf->entries[i]);
    free(xdmf->entries);
    *xdmf = (struct xdmf){0};
}

/* Adds a table, or the body or solid of this number. */
static void add_grid(struct xdmf_entry *entry, const struct snapshot *snapshot, int kind,
                     int number)
{
    const double time = (double)snapshot->step * snapshot->dt;
    size_t size = 0;
    ARRAY_GROW(entry->grids, entry->n + 1, entry->capacity);
    struct xdmf_grid *grid = &entry->grids[entry->n++];
    *grid = (struct xdmf_grid){.kind = kind};
    FILE *out = open_memstream(&grid->text, &size);
    CHECK(out != NULL, "no memory for the index of snapshots");
    if (kind == XDMF_BODIES) {
        grid->name = array_string(snapshot->bodies[number].name);
        put_body(out, &snapshot->bodies[number], time);
    } else if (kind == XDMF_SOLIDS) {
        grid->name = array_string(snapshot->solids[number].name);
        put_solid(out, &snapshot->solids[number], snapshot->step, time);
    } else {
        grid->name = array_string(NAMES[kind]);
        put_table(out, snapshot,
                  kind == XDMF_SPHERES ? &snapshot->spheres : &snapshot->contacts, time);
    }
    CHECK(fclose(out) == 0, "no memory for the index of snapshots");
}

void xdmf_add(struct xdmf *xdmf, const struct snapshot *snapshot)
{
    if (xdmf->n > 0 && xdmf->entries[xdmf->n - 1].step == snapshot->step)
        entry_clear(&xdmf->entries[--xdmf->n]);
    CHECK(xdmf->n == 0 || xdmf->entries[xdmf->n - 1].step < snapshot->step,
          "snapshot %" PRId64 " comes after later ones", snapshot->step);
    ARRAY_GROW(xdmf->entries, xdmf->n + 1, xdmf->capacity);
    struct xdmf_entry *entry = &xdmf->entries[xdmf->n++];
    *entry = (struct xdmf_entry){.step = snapshot->step,
                                 .time = (double)snapshot->step * snapshot->dt};
    add_grid(entry, snapshot, XDMF_SPHERES, -1);
    for (int b = 0; b < snapshot->n_bodies; b++)
        add_grid(entry, snapshot, XDMF_BODIES, b);
    if (snapshot->has_contacts)
        add_grid(entry, snapshot, XDMF_CONTACTS, -1);
    for (int s = 0; s < snapshot->n_solids; s++)
        add_grid(entry, snapshot, XDMF_SOLIDS, s);
}

void xdmf_open(struct xdmf *xdmf, const char *folder, int64_t last_step)
{
    int64_t *steps;
    const int n = file_steps(folder, &steps);
    *xdmf = (struct xdmf){0};
    for (int i = 0; i < n && steps[i] <= last_step; i++) {
        struct snapshot snapshot;
        char *path = file_step_path(folder, steps[i]);
        char *why = snapshot_measure(path, &snapshot);
        if (why == NULL && snapshot.step == steps[i])
            xdmf_add(xdmf, &snapshot);
        else
            report_warn("%s is left out of the index of snapshots: %s", path,
                        why != NULL ? why : "it is of another step");
        if (why == NULL)
            snapshot_clear(&snapshot);
        free(why);
        free(path);
    }
    free(steps);
}

/* ------------------------------------------------------------------------------------ files */

/* The grid of this name, most likely at place `guess`. */
static const struct xdmf_grid *find_grid(const struct xdmf_entry *entry, const char *name,
                                         int kind, int guess)
{
    for (int k = 0; k < entry->n; k++) {
        const struct xdmf_grid *grid = &entry->grids[(guess + k) % entry->n];
        if (grid->kind == kind && strcmp(grid->name, name) == 0)
            return grid;
    }
    return NULL;
}

/* All times of one thing, which the entry `first` has; nothing where it is not there, for
 * readers would show what was there before. */
static void put_history(FILE *out, const struct xdmf *xdmf, int first, int place)
{
    const struct xdmf_grid *sample = &xdmf->entries[first].grids[place];
    fprintf(out, "<Grid Name=\"%s\" GridType=\"Collection\" CollectionType=\"Temporal\">\n",
            sample->name);
    for (int i = 0; i < xdmf->n; i++) {
        const struct xdmf_grid *grid =
            find_grid(&xdmf->entries[i], sample->name, sample->kind, place);
        if (grid != NULL) {
            fputs(grid->text, out);
        } else {
            put_head(out, sample->name, xdmf->entries[i].time);
            put_nothing(out);
        }
    }
    fputs("</Grid>\n", out);
}

/* Is there this grid in an entry before? */
static bool is_known(const struct xdmf *xdmf, int entry, int place)
{
    const struct xdmf_grid *grid = &xdmf->entries[entry].grids[place];
    for (int i = entry - 1; i >= 0; i--)
        if (find_grid(&xdmf->entries[i], grid->name, grid->kind, place) != NULL)
            return true;
    return false;
}

/* The caller frees it; NULL where there is nothing of the kind. */
static char *compose(const struct xdmf *xdmf, int kind, size_t *size)
{
    char *text = NULL;
    int n = 0;
    FILE *out = open_memstream(&text, size);
    CHECK(out != NULL, "no memory for the index of snapshots");
    fputs("<?xml version=\"1.0\"?>\n<Xdmf Version=\"2.0\"><Domain>\n", out);
    for (int i = 0; i < xdmf->n; i++)
        for (int g = 0; g < xdmf->entries[i].n; g++)
            if (xdmf->entries[i].grids[g].kind == kind && !is_known(xdmf, i, g)) {
                put_history(out, xdmf, i, g);
                n++;
            }
    fputs("</Domain></Xdmf>\n", out);
    CHECK(fclose(out) == 0, "no memory for the index of snapshots");
    if (n > 0)
        return text;
    free(text);
    return NULL;
}

int xdmf_write(const struct xdmf *xdmf, const struct run_folder *run, const char *folder)
{
    int status = REPORT_FINISHED;
    for (int kind = 0; kind < XDMF_N_KINDS && status == REPORT_FINISHED; kind++) {
        char *path = array_format("%s/%s.xmf", folder, NAMES[kind]);
        size_t size = 0;
        char *text = compose(xdmf, kind, &size), *why = NULL;
        bool done = true;
        if (text != NULL)
            done = run_folder_replace(run, path, text, size, &why);
        else
            (void)unlink(path);
        if (!done)
            status = REPORT_STORAGE;
        if (why != NULL)
            report_error("cannot write %s: %s; free some space or mend the disk, then run the "
                         "same command again",
                         path, why);
        free(why);
        free(text);
        free(path);
    }
    return status;
}
