/*
 * See snapshot.h.  Written as store/shared_file.h says.
 *
 * Whether a mesh is still what it was is found by reading it back from the snapshot before: no
 * state, so a run that was resumed writes the same files as one that never stopped.  It costs
 * rank 0 the reading of the meshes, once a snapshot; one that cannot be read is written anew.
 */
#include "store/snapshot.h"

#include <limits.h>
#include <mpi.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/comm.h"
#include "model/solid_mesh.h"
#include "store/crc32.h"
#include "store/file.h"
#include "store/h5.h"
#include "store/shared_file.h"

static const char FORMAT[] = "tremie snapshot";

const struct field snapshot_fields[SNAPSHOT_N_FIELDS] = {
    [SNAPSHOT_ID] = {"id", "1", "global number, never reused", FIELD_INT64, 1, 0},
    [SNAPSHOT_POSITION] = {"position", "m", "centre", FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_RADIUS] = {"radius", "m", "radius", FIELD_DOUBLE, 1, 0},
    [SNAPSHOT_VELOCITY] = {"velocity", "m/s", "velocity", FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_ANGULAR_VELOCITY] = {"angular_velocity", "rad/s", "angular velocity",
                                   FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_FORCE] = {"force", "N", "sum of the forces of all contacts", FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_TORQUE] = {"torque", "N m", "torque of all contacts about the centre",
                         FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_MASS] = {"mass", "kg", "mass", FIELD_DOUBLE, 1, 0},
    [SNAPSHOT_MATERIAL] = {"material", "1", "material, counted from 0 in the order of the job",
                           FIELD_INT32, 1, 0},
    [SNAPSHOT_GROUP] = {"group", "1",
                        "group of spheres, counted from 0 in the order of the job", FIELD_INT32,
                        1, 0},
    [SNAPSHOT_DISSIPATED_FRICTION] = {"dissipated_friction", "J",
                                      "turned into heat by friction since birth", FIELD_DOUBLE,
                                      1, 0},
    [SNAPSHOT_DISSIPATED_DAMPING] = {"dissipated_damping", "J",
                                     "turned into heat by contact damping since birth",
                                     FIELD_DOUBLE, 1, 0},
};

const struct field snapshot_node_fields[SNAPSHOT_N_NODE_FIELDS] = {
    [SNAPSHOT_NODE_ID] = {"id", "1", "number of the node, from 0", FIELD_INT64, 1, 0},
    [SNAPSHOT_NODE_POSITION] = {"position", "m", "place", FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_NODE_DISPLACEMENT] = {"displacement", "m", "way from the place at the start",
                                    FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_NODE_VELOCITY] = {"velocity", "m/s", "velocity", FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_NODE_CONTACT_FORCE] = {"contact_force", "N",
                                     "of the contacts of this instant on the node",
                                     FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_NODE_CONTACT_PRESSURE] = {"contact_pressure", "Pa",
                                        "the contact force against the surface over the "
                                        "node's share of the area",
                                        FIELD_DOUBLE, 1, 0},
};

const struct field snapshot_element_fields[SNAPSHOT_N_ELEMENT_FIELDS] = {
    [SNAPSHOT_ELEMENT_ID] = {"id", "1", "number of the element, from 0", FIELD_INT64, 1, 0},
    [SNAPSHOT_ELEMENT_STRESS] = {"stress", "Pa", "Cauchy's, xx yy zz xy yz zx", FIELD_DOUBLE, 6,
                                 0},
    [SNAPSHOT_ELEMENT_VON_MISES] = {"von_mises", "Pa",
                                    "von Mises's equivalent stress; of shells the most of all "
                                    "layers",
                                    FIELD_DOUBLE, 1, 0},
    [SNAPSHOT_ELEMENT_PRINCIPAL_STRESS] = {"principal_stress", "Pa",
                                           "principal stresses, the greatest first",
                                           FIELD_DOUBLE, 3, 0},
    [SNAPSHOT_ELEMENT_PLASTIC_STRAIN] = {"plastic_strain", "1", "equivalent plastic strain",
                                         FIELD_DOUBLE, 1, 0},
    [SNAPSHOT_ELEMENT_THICKNESS] = {"thickness", "m",
                                    "of shells and membranes, 0 of other elements beside them",
                                    FIELD_DOUBLE, 1, 0},
    [SNAPSHOT_ELEMENT_ALIVE] = {"alive", "1", "1: it resists; 0: it has failed", FIELD_INT32, 1,
                                0},
};

static const struct field contact_fields[SNAPSHOT_N_CONTACT_FIELDS] = {
    [SNAPSHOT_FIRST_ID] = {"first_id", "1", "sphere of the lower id", FIELD_INT64, 1, 0},
    [SNAPSHOT_SECOND_ID] = {"second_id", "1", "sphere of the higher id", FIELD_INT64, 1, 0},
    [SNAPSHOT_CONTACT_POSITION] = {"position", "m", "middle of the overlap", FIELD_DOUBLE, 3,
                                   0},
    [SNAPSHOT_CONTACT_FORCE] = {"force", "N",
                                "as felt by the second sphere; without contact.ledger that of "
                                "the springs alone",
                                FIELD_DOUBLE, 3, 0},
};

static const struct field POINTS = {"points",     "m", "vertices of the body's surface",
                                    FIELD_DOUBLE, 3,   0};
static const struct field TRIANGLES = {"triangles", "1", "numbers of their points, from 0",
                                       FIELD_INT32, 3,   0};

static const struct field PARTS[SNAPSHOT_N_PARTS] = {
    [SNAPSHOT_REFERENCE] = {"reference", "m", "places of the nodes at the start", FIELD_DOUBLE,
                            3, 0},
    [SNAPSHOT_CORNERS] = {"corners", "1", "nodes of each element, from 0", FIELD_INT32, 8, 0},
    [SNAPSHOT_TRIANGLES] = {"triangles", "1", "nodes of each triangle of the surface, from 0",
                            FIELD_INT32, 3, 0},
    [SNAPSHOT_CELLS] = {"cells", "1",
                        "of each element 9 (hexahedron) or 6 (tetrahedron), then its nodes",
                        FIELD_INT32, 1, 0},
};

/* ---------------------------------------------------------------------------------- content */

static int compare_ids(const void *a, const void *b, int n)
{
    int64_t p[2], q[2];
    memcpy(p, a, (size_t)n * sizeof *p);
    memcpy(q, b, (size_t)n * sizeof *q);
    for (int k = 0; k < n; k++)
        if (p[k] != q[k])
            return p[k] < q[k] ? -1 : 1;
    return 0;
}

static int compare_spheres(const void *a, const void *b)
{
    return compare_ids(a, b, 1);
}

static int compare_contacts(const void *a, const void *b)
{
    return compare_ids(a, b, 2);
}

static void add_column(struct table *table, struct field field, bool single)
{
    if (single && field.type == FIELD_DOUBLE)
        field.type = FIELD_FLOAT;
    table_add_column(table, &field, table->record_size);
    table->record_size += field_size(&field);
}

/* Adds columns of the fields before `first`, and of others that bits name. */
static void add_columns(struct table *table, const struct field *fields, int n, int first,
                        int chosen, bool single)
{
    for (int f = 0; f < n; f++)
        if (f < first || (chosen >> (f - first) & 1) != 0)
            add_column(table, fields[f], single);
}

static void tables_init(struct snapshot *snapshot)
{
    table_init(&snapshot->spheres, "spheres", 0, compare_spheres);
    table_init(&snapshot->contacts, "contacts", 0, compare_contacts);
}

void snapshot_init(struct snapshot *snapshot, int fields, bool contacts, bool single,
                   bool packed)
{
    *snapshot = (struct snapshot){.has_contacts = contacts};
    tables_init(snapshot);
    add_columns(&snapshot->spheres, snapshot_fields, SNAPSHOT_N_FIELDS, SNAPSHOT_FIRST_CHOICE,
                fields, single);
    for (int f = 0; f < SNAPSHOT_N_CONTACT_FIELDS && contacts; f++)
        add_column(&snapshot->contacts, contact_fields[f], single);
    snapshot->spheres.packed = snapshot->contacts.packed = packed;
}

static struct snapshot_solid *append_solid(struct snapshot *snapshot, const char *name)
{
    const size_t n = (size_t)snapshot->n_solids++;
    snapshot->solids = array_resize(snapshot->solids, n, n + 1, sizeof *snapshot->solids);
    struct snapshot_solid *solid = &snapshot->solids[n];
    *solid = (struct snapshot_solid){.name = array_string(name)};
    solid->names[0] = array_format("solids/%s/nodes", name);
    solid->names[1] = array_format("solids/%s/elements", name);
    table_init(&solid->nodes, solid->names[0], 0, compare_spheres);
    table_init(&solid->elements, solid->names[1], 0, compare_spheres);
    for (int p = 0; p < SNAPSHOT_N_PARTS; p++)
        solid->parts[p].width = PARTS[p].width;
    return solid;
}

struct snapshot_solid *snapshot_add_solid(struct snapshot *snapshot, const char *name,
                                          int fields, bool sheets, bool single, bool packed)
{
    enum { N_NODE_CHOICES = SNAPSHOT_N_NODE_FIELDS - SNAPSHOT_NODE_FIRST_CHOICE };
    enum { THICKNESS = 1 << (SNAPSHOT_ELEMENT_THICKNESS - SNAPSHOT_ELEMENT_FIRST_CHOICE) };
    const int of_elements = fields >> N_NODE_CHOICES & (sheets ? ~0 : ~THICKNESS);
    struct snapshot_solid *solid = append_solid(snapshot, name);
    add_columns(&solid->nodes, snapshot_node_fields, SNAPSHOT_N_NODE_FIELDS,
                SNAPSHOT_NODE_FIRST_CHOICE, fields, single);
    add_columns(&solid->elements, snapshot_element_fields, SNAPSHOT_N_ELEMENT_FIELDS,
                SNAPSHOT_ELEMENT_FIRST_CHOICE, of_elements, single);
    solid->nodes.packed = solid->elements.packed = packed;
    return solid;
}

static void solid_clear(struct snapshot_solid *solid)
{
    free(solid->name);
    free(solid->material);
    table_clear(&solid->nodes);
    table_clear(&solid->elements);
    free(solid->names[0]);
    free(solid->names[1]);
    for (int p = 0; p < SNAPSHOT_N_PARTS; p++)
        free(solid->parts[p].rows);
}

void snapshot_clear(struct snapshot *snapshot)
{
    for (int s = 0; s < snapshot->n_solids; s++)
        solid_clear(&snapshot->solids[s]);
    free(snapshot->solids);
    for (int b = 0; b < snapshot->n_bodies; b++) {
        free(snapshot->bodies[b].name);
        free(snapshot->bodies[b].material);
        free(snapshot->bodies[b].points);
        free(snapshot->bodies[b].triangles);
    }
    free(snapshot->bodies);
    free(snapshot->title);
    free(snapshot->materials);
    free(snapshot->groups);
    table_clear(&snapshot->spheres);
    table_clear(&snapshot->contacts);
    *snapshot = (struct snapshot){0};
}

char *snapshot_add_name(char *names, const char *name)
{
    char *longer = array_format("%s%s\n", names, name);
    free(names);
    return longer;
}

static unsigned char *place_of(const struct table *table, int64_t i, int column)
{
    return table->records + (size_t)i * table->record_size + table->columns[column].offset;
}

void snapshot_put(struct table *table, int64_t i, int column, const void *values)
{
    const struct field *field = &table->columns[column].field;
    unsigned char *place = place_of(table, i, column);
    if (field->type != FIELD_FLOAT) {
        memcpy(place, values, field_size(field));
        return;
    }
    for (int k = 0; k < field->width; k++) {
        double value;
        memcpy(&value, (const double *)values + k, sizeof value);
        const float rounded = (float)value;
        memcpy(place + (size_t)k * sizeof rounded, &rounded, sizeof rounded);
    }
}

int snapshot_column(const struct table *table, const char *name)
{
    for (int k = 0; k < table->n_columns; k++)
        if (strcmp(table->columns[k].field.name, name) == 0)
            return k;
    return -1;
}

void snapshot_get(const struct table *table, int64_t i, int column, double *values)
{
    const struct field *field = &table->columns[column].field;
    const unsigned char *place = place_of(table, i, column);
    for (int k = 0; k < field->width; k++) {
        const unsigned char *at = place + (size_t)k * field_component_size(field->type);
        union {
            double number;
            float rounded;
            int64_t whole;
            int32_t small;
        } value;
        memcpy(&value, at, field_component_size(field->type));
        values[k] = field->type == FIELD_DOUBLE  ? value.number
                    : field->type == FIELD_FLOAT ? (double)value.rounded
                    : field->type == FIELD_INT64 ? (double)value.whole
                                                 : (double)value.small;
    }
}

static const int32_t *corners_of(const struct snapshot_solid *solid, int64_t element)
{
    const struct snapshot_rows *corners = &solid->parts[SNAPSHOT_CORNERS];
    return (const int32_t *)corners->rows + element * corners->width;
}

int snapshot_n_corners(const struct snapshot_solid *solid, int64_t element)
{
    const bool is_wide = solid->parts[SNAPSHOT_CORNERS].width == 8;
    return is_wide ? solid_mesh_n_corners(corners_of(solid, element)) : 4;
}

bool snapshot_is_sheet(const struct snapshot_solid *solid, int64_t element)
{
    return solid->parts[SNAPSHOT_CORNERS].width == 8 &&
           solid_mesh_is_sheet(corners_of(solid, element));
}

/* ----------------------------------------------------------------------------------- meshes */

/* Does `path` hold these rows? */
static bool holds(struct h5 *h5, const char *path, const struct field *field, int64_t n,
                  const void *rows)
{
    if (!h5_has(h5, path) || h5_count_rows(h5, path, field) != n)
        return false;
    const size_t size = (size_t)n * field_size(field);
    void *there = array_allocate(size, 1);
    h5_read_rows(h5, path, field, 0, n, there);
    const bool same = h5->why == NULL && (size == 0 || memcmp(there, rows, size) == 0);
    free(there);
    return same;
}

/* The step of the file that holds these rows already, else the present one. */
static int64_t step_of(struct h5 *before, const struct snapshot *snapshot, const char *group,
                       const struct field *field, int64_t n, const void *rows)
{
    char *path = array_format("%s/%s", group, field->name);
    char *name = array_format("%s_step", field->name);
    int64_t step = snapshot->step;
    if (holds(before, path, field, n, rows))
        step = h5_get_int(before, group, name);
    free(name);
    free(path);
    return before->why == NULL && step >= 0 && step < snapshot->step ? step : snapshot->step;
}

/* A part of a solid's mesh as it is. */
static struct field part_field(const struct snapshot_solid *solid, int part)
{
    struct field field = PARTS[part];
    field.width = solid->parts[part].width;
    return field;
}

static bool has_part(const struct snapshot_solid *solid, int part)
{
    return part != SNAPSHOT_CELLS || solid->mixed;
}

/* The newest snapshot before this one; NULL when there is none. */
static char *find_before(const char *folder, int64_t step)
{
    int64_t *steps;
    int n = file_steps(folder, &steps);
    while (n > 0 && steps[n - 1] >= step)
        n--;
    char *path = n > 0 ? file_step_path(folder, steps[n - 1]) : NULL;
    free(steps);
    return path;
}

static void find_parts(struct h5 *before, const struct snapshot *snapshot,
                       struct snapshot_solid *solid)
{
    char *group = array_format("/solids/%s", solid->name);
    for (int p = 0; p < SNAPSHOT_N_PARTS; p++) {
        struct snapshot_rows *part = &solid->parts[p];
        const struct field field = part_field(solid, p);
        if (has_part(solid, p))
            part->step = step_of(before, snapshot, group, &field, part->n, part->rows);
    }
    free(group);
}

static void find_meshes(const char *folder, struct snapshot *snapshot)
{
    char *path = find_before(folder, snapshot->step);
    struct h5 before = {.file = -1, .memory = -1};
    if (path != NULL)
        h5_open(&before, path);
    for (int b = 0; b < snapshot->n_bodies; b++) {
        struct snapshot_body *body = &snapshot->bodies[b];
        body->points_step = body->triangles_step = snapshot->step;
        if (path == NULL)
            continue;
        char *group = array_format("/bodies/%s", body->name);
        body->points_step =
            step_of(&before, snapshot, group, &POINTS, body->n_points, body->points);
        body->triangles_step =
            step_of(&before, snapshot, group, &TRIANGLES, body->n_triangles, body->triangles);
        free(group);
    }
    for (int s = 0; s < snapshot->n_solids; s++) {
        for (int p = 0; p < SNAPSHOT_N_PARTS; p++)
            snapshot->solids[s].parts[p].step = snapshot->step;
        if (path != NULL)
            find_parts(&before, snapshot, &snapshot->solids[s]);
    }
    h5_close(&before);
    free(before.why);
    free(path);
}

/* ---------------------------------------------------------------------------------- writing */

static int64_t checksum(const void *bytes, size_t n)
{
    struct crc32 crc;
    crc32_init(&crc);
    return crc32_of(&crc, bytes, n);
}

static void put_run(struct h5 *h5, const struct snapshot *snapshot)
{
    static const char run[] = "/run";
    h5_group(h5, run);
    h5_put_text(h5, run, "format", FORMAT);
    h5_put_int(h5, run, "format_version", SNAPSHOT_FORMAT_VERSION);
    h5_put_int(h5, run, "step", snapshot->step);
    h5_put_double(h5, run, "time", (double)snapshot->step * snapshot->dt);
    h5_put_text(h5, run, "time_unit", "s");
    h5_put_double(h5, run, "dt", snapshot->dt);
    h5_put_text(h5, run, "dt_unit", "s");
    h5_put_int(h5, run, "next_id", snapshot->next_id);
    h5_put_int(h5, run, "n_spheres", snapshot->spheres.n_total);
    h5_put_int(h5, run, "n_contacts", snapshot->contacts.n_total);
    h5_put_int(h5, run, "n_bodies", snapshot->n_bodies);
    h5_put_int(h5, run, "n_solids", snapshot->n_solids);
    h5_put_text(h5, run, "title", snapshot->title);
}

/* Rows of a mesh, or a link to where they are. */
static void put_rows(struct h5 *h5, const char *group, const struct field *field, bool packed,
                     int64_t step, int64_t now, int64_t n, const void *rows)
{
    char *path = array_format("%s/%s", group, field->name);
    char *name = array_format("%s_step", field->name), *file = file_step_path("", step);
    h5_put_int(h5, group, name, step);
    if (step != now) {
        h5_link(h5, path, file + 1, path);
    } else {
        if (packed)
            h5_declare_packed_rows(h5, path, field, n);
        else
            h5_declare_rows(h5, path, field, n);
        h5_write_rows(h5, path, field, 0, n, rows);
        h5_put_int(h5, path, "checksum", checksum(rows, (size_t)n * field_size(field)));
    }
    free(file);
    free(name);
    free(path);
}

static void put_body(struct h5 *h5, const struct snapshot *snapshot,
                     const struct snapshot_body *body)
{
    char *group = array_format("/bodies/%s", body->name);
    const bool packed = snapshot->spheres.packed;
    h5_group(h5, group);
    h5_put_text(h5, group, "material", body->material);
    put_rows(h5, group, &POINTS, packed, body->points_step, snapshot->step, body->n_points,
             body->points);
    put_rows(h5, group, &TRIANGLES, packed, body->triangles_step, snapshot->step,
             body->n_triangles, body->triangles);
    free(group);
}

static void put_solid(struct h5 *h5, const struct snapshot *snapshot,
                      const struct snapshot_solid *solid)
{
    char *group = array_format("/solids/%s", solid->name);
    h5_put_text(h5, group, "material", solid->material);
    for (int p = 0; p < SNAPSHOT_N_PARTS; p++) {
        const struct snapshot_rows *part = &solid->parts[p];
        const struct field field = part_field(solid, p);
        if (has_part(solid, p))
            put_rows(h5, group, &field, solid->nodes.packed, part->step, snapshot->step,
                     part->n, part->rows);
    }
    free(group);
}

static void put_solids(struct h5 *h5, const struct snapshot *snapshot)
{
    char *names = array_string("");
    if (snapshot->n_solids > 0) {
        h5_group(h5, "/solids");
        h5_group(h5, "/checksums/solids");
    }
    for (int s = 0; s < snapshot->n_solids; s++) {
        const struct snapshot_solid *solid = &snapshot->solids[s];
        char *group = array_format("/solids/%s", solid->name);
        char *sums = array_format("/checksums/solids/%s", solid->name);
        names = snapshot_add_name(names, solid->name);
        h5_group(h5, group);
        h5_group(h5, sums);
        table_declare(&solid->nodes, h5);
        table_declare(&solid->elements, h5);
        put_solid(h5, snapshot, solid);
        free(sums);
        free(group);
    }
    h5_put_document(h5, "/run/solids", names);
    free(names);
}

static void put_all(struct h5 *h5, const void *content)
{
    const struct snapshot *snapshot = content;
    put_run(h5, snapshot);
    h5_group(h5, "/checksums");
    table_declare(&snapshot->spheres, h5);
    if (snapshot_column(&snapshot->spheres, "material") >= 0)
        h5_put_text(h5, "/spheres/material", "names", snapshot->materials);
    if (snapshot_column(&snapshot->spheres, "group") >= 0)
        h5_put_text(h5, "/spheres/group", "names", snapshot->groups);
    if (snapshot->has_contacts)
        table_declare(&snapshot->contacts, h5);
    char *names = array_string("");
    for (int b = 0; b < snapshot->n_bodies; b++)
        names = snapshot_add_name(names, snapshot->bodies[b].name);
    h5_group(h5, "/bodies");
    h5_put_document(h5, "/run/bodies", names);
    for (int b = 0; b < snapshot->n_bodies; b++)
        put_body(h5, snapshot, &snapshot->bodies[b]);
    free(names);
    put_solids(h5, snapshot);
}

/* What put_all() writes besides tables, at most. */
static int64_t content_size(const struct snapshot *snapshot)
{
    enum { BODY = 1 << 12, SOLID = 1 << 15, NAME = 1 << 8 };
    int64_t size = (int64_t)(strlen(snapshot->title) + strlen(snapshot->materials) +
                             strlen(snapshot->groups));
    for (int b = 0; b < snapshot->n_bodies; b++) {
        const struct snapshot_body *body = &snapshot->bodies[b];
        size += BODY + NAME;
        if (body->points_step == snapshot->step)
            size += body->n_points * (int64_t)field_size(&POINTS);
        if (body->triangles_step == snapshot->step)
            size += body->n_triangles * (int64_t)field_size(&TRIANGLES);
    }
    for (int k = 0; k < snapshot->n_solids; k++) {
        const struct snapshot_solid *solid = &snapshot->solids[k];
        size += SOLID + NAME;
        for (int p = 0; p < SNAPSHOT_N_PARTS; p++) {
            const struct field field = part_field(solid, p);
            if (solid->parts[p].step == snapshot->step)
                size += solid->parts[p].n * (int64_t)field_size(&field);
        }
    }
    return size;
}

int snapshot_write(const struct comm *comm, const char *folder, struct snapshot *snapshot)
{
    if (comm->rank == 0)
        find_meshes(folder, snapshot);
    char *path = file_step_path(folder, snapshot->step);
    struct table *tables = array_allocate(2 + 2 * (size_t)snapshot->n_solids, sizeof *tables);
    int n_tables = 0;
    tables[n_tables++] = snapshot->spheres;
    if (snapshot->has_contacts)
        tables[n_tables++] = snapshot->contacts;
    for (int s = 0; s < snapshot->n_solids; s++) {
        tables[n_tables++] = snapshot->solids[s].nodes;
        tables[n_tables++] = snapshot->solids[s].elements;
    }
    const struct shared_file file = {
        .folder = snapshot->folder,
        .path = path,
        .what = "snapshot",
        .remedy = "checkpoints are untouched: free some space or mend the disk, then run the "
                  "same command again",
        .lay_out = put_all,
        .content = snapshot,
        .size = content_size(snapshot),
        .n_tables = n_tables,
        .tables = tables,
    };
    const int status = shared_file_write(comm, &file);
    free(tables);
    free(path);
    return status;
}

/* ---------------------------------------------------------------------------------- reading */

static void check_format(struct h5 *h5)
{
    if (h5->why == NULL && !h5_has(h5, "/run")) {
        h5_fail(h5, "it is not a snapshot of tremie");
        return;
    }
    char *format = h5_get_text(h5, "/run", "format");
    const int64_t version = h5_get_int(h5, "/run", "format_version");
    if (strcmp(format, FORMAT) != 0)
        h5_fail(h5, "it is not a snapshot of tremie");
    else if (version < 1 || version > SNAPSHOT_FORMAT_VERSION)
        h5_fail(h5, "its format is newer than this program");
    free(format);
}

bool snapshot_is(const char *path)
{
    struct h5 h5;
    h5_open(&h5, path);
    char *format = h5_has(&h5, "/run") ? h5_get_text(&h5, "/run", "format") : NULL;
    const bool is = format != NULL && strcmp(format, FORMAT) == 0;
    h5_close(&h5);
    free(h5.why);
    free(format);
    return is;
}

/* Those of the fields that are in the file. */
static void find_columns(struct h5 *h5, struct table *table, const struct field *fields, int n)
{
    for (int f = 0; f < n && h5->why == NULL; f++) {
        char *path = array_format("/%s/%s", table->name, fields[f].name);
        struct field field = fields[f];
        if (h5_has(h5, path)) {
            (void)h5_find_rows(h5, path, &field);
            if (field.width != fields[f].width ||
                (field.type != fields[f].type &&
                 (field.type != FIELD_FLOAT || fields[f].type != FIELD_DOUBLE)))
                h5_fail(h5, "%s has another type or shape than it should have", path);
            add_column(table, field, false);
        }
        free(path);
    }
    if (h5->why == NULL && table->n_columns > 0)
        table_measure(table, h5);
}

/* The number of rows of a mesh. */
static int64_t measure_rows(struct h5 *h5, const char *group, const struct field *field,
                            int64_t *step)
{
    char *path = array_format("%s/%s", group, field->name);
    char *name = array_format("%s_step", field->name);
    const int64_t n = h5_count_rows(h5, path, field);
    *step = h5_get_int(h5, group, name);
    if (n > INT_MAX)
        h5_fail(h5, "%s is larger than any mesh", path);
    free(name);
    free(path);
    return n;
}

static void measure_bodies(struct h5 *h5, struct snapshot *snapshot)
{
    int capacity = 0;
    char *names = h5_get_document(h5, "/run/bodies"), *rest = names;
    for (char *name; h5->why == NULL && (name = strsep(&rest, "\n")) != NULL;) {
        if (*name == '\0')
            continue;
        ARRAY_GROW(snapshot->bodies, snapshot->n_bodies + 1, capacity);
        struct snapshot_body *body = &snapshot->bodies[snapshot->n_bodies++];
        char *group = array_format("/bodies/%s", name);
        *body = (struct snapshot_body){.name = array_string(name)};
        body->material = h5_get_text(h5, group, "material");
        body->n_points = measure_rows(h5, group, &POINTS, &body->points_step);
        body->n_triangles = measure_rows(h5, group, &TRIANGLES, &body->triangles_step);
        free(group);
    }
    free(names);
}

/* One of a solid's parts, of whatever width. */
static void measure_part(struct h5 *h5, struct snapshot_solid *solid, int p)
{
    char *group = array_format("/solids/%s", solid->name);
    char *path = array_format("%s/%s", group, PARTS[p].name);
    struct field field = PARTS[p];
    (void)h5_find_rows(h5, path, &field);
    if (h5->why == NULL && field.width != PARTS[p].width &&
        (p != SNAPSHOT_CORNERS || field.width != 4))
        h5_fail(h5, "%s has another shape than it should have", path);
    solid->parts[p].width = field.width;
    field = part_field(solid, p);
    solid->parts[p].n = measure_rows(h5, group, &field, &solid->parts[p].step);
    free(path);
    free(group);
}

static void measure_solid(struct h5 *h5, struct snapshot_solid *solid)
{
    char *group = array_format("/solids/%s", solid->name);
    char *cells = array_format("%s/%s", group, PARTS[SNAPSHOT_CELLS].name);
    solid->material = h5_get_text(h5, group, "material");
    solid->mixed = h5_has(h5, cells);
    for (int p = 0; p < SNAPSHOT_N_PARTS; p++)
        if (has_part(solid, p))
            measure_part(h5, solid, p);
    solid->n_nodes = solid->parts[SNAPSHOT_REFERENCE].n;
    solid->n_elements = solid->parts[SNAPSHOT_CORNERS].n;
    find_columns(h5, &solid->nodes, snapshot_node_fields, SNAPSHOT_N_NODE_FIELDS);
    find_columns(h5, &solid->elements, snapshot_element_fields, SNAPSHOT_N_ELEMENT_FIELDS);
    if (h5->why == NULL &&
        (solid->nodes.n_total != solid->n_nodes ||
         solid->elements.n_total != solid->n_elements ||
         snapshot_column(&solid->nodes, "id") != SNAPSHOT_NODE_ID ||
         snapshot_column(&solid->nodes, "position") != SNAPSHOT_NODE_POSITION ||
         snapshot_column(&solid->elements, "id") != SNAPSHOT_ELEMENT_ID))
        h5_fail(h5, "%s lacks some column, or rows of it", group);
    free(cells);
    free(group);
}

/* Snapshots of earlier versions have no list of them. */
static void measure_solids(struct h5 *h5, struct snapshot *snapshot)
{
    if (h5->why != NULL || !h5_has(h5, "/run/solids"))
        return;
    char *names = h5_get_document(h5, "/run/solids"), *rest = names;
    for (char *name; h5->why == NULL && (name = strsep(&rest, "\n")) != NULL;)
        if (*name != '\0')
            measure_solid(h5, append_solid(snapshot, name));
    free(names);
}

static char *names_of(struct h5 *h5, const struct snapshot *snapshot, const char *column)
{
    char *path = array_format("/spheres/%s", column);
    char *names = snapshot_column(&snapshot->spheres, column) >= 0
                      ? h5_get_text(h5, path, "names")
                      : array_string("");
    free(path);
    return names;
}

static void measure(struct h5 *h5, struct snapshot *snapshot)
{
    *snapshot = (struct snapshot){0};
    tables_init(snapshot);
    check_format(h5);
    snapshot->step = h5_get_int(h5, "/run", "step");
    snapshot->dt = h5_get_double(h5, "/run", "dt");
    snapshot->next_id = h5_get_int(h5, "/run", "next_id");
    snapshot->title = h5_get_text(h5, "/run", "title");
    find_columns(h5, &snapshot->spheres, snapshot_fields, SNAPSHOT_N_FIELDS);
    for (int f = 0; f < SNAPSHOT_FIRST_CHOICE && h5->why == NULL; f++)
        if (snapshot_column(&snapshot->spheres, snapshot_fields[f].name) != f)
            h5_fail(h5, "/spheres/%s is missing", snapshot_fields[f].name);
    snapshot->materials = names_of(h5, snapshot, "material");
    snapshot->groups = names_of(h5, snapshot, "group");
    snapshot->has_contacts = h5_has(h5, "/contacts");
    find_columns(h5, &snapshot->contacts, contact_fields, SNAPSHOT_N_CONTACT_FIELDS);
    if (snapshot->has_contacts && snapshot->contacts.n_columns < SNAPSHOT_N_CONTACT_FIELDS)
        h5_fail(h5, "/contacts lacks some column");
    measure_bodies(h5, snapshot);
    measure_solids(h5, snapshot);
}

/* Rows of a mesh in the group `kind` (bodies, solids); the caller frees them. */
static void *read_mesh(struct h5 *h5, const char *kind, const char *name,
                       const struct field *field, int64_t n)
{
    char *path = array_format("/%s/%s/%s", kind, name, field->name);
    const size_t size = field_size(field);
    void *rows = array_allocate((size_t)n, size);
    h5_read_rows(h5, path, field, 0, n, rows);
    if (h5_get_int(h5, path, "checksum") != checksum(rows, (size_t)n * size))
        h5_fail(h5, "%s: the checksum is wrong", path);
    free(path);
    return rows;
}

/* Is it the number of a node, or what may stand for none? */
static bool is_node(const struct snapshot_solid *solid, const int32_t *row, int width, int c)
{
    const bool is_sheet = width == 8 && row[4] == SOLID_MESH_SHEET;
    if (row[c] >= 0)
        return row[c] < solid->n_nodes && (c < 4 || row[4] >= 0);
    if (c == 4)
        return row[c] == -1 || is_sheet;
    return row[c] == -1 && (c > 4 ? row[4] < 0 : c == 3 && is_sheet);
}

static void check_nodes(struct h5 *h5, const struct snapshot_solid *solid, int p)
{
    const struct snapshot_rows *part = &solid->parts[p];
    for (int64_t k = 0; k < part->n; k++) {
        const int32_t *row = (const int32_t *)part->rows + k * part->width;
        for (int c = 0; c < part->width; c++)
            if (!is_node(solid, row, part->width, c))
                h5_fail(h5, "/solids/%s/%s: there is no node %d", solid->name, PARTS[p].name,
                        (int)row[c]);
    }
}

static void read_solid(struct h5 *h5, struct snapshot_solid *solid, const struct comm *alone)
{
    table_read(&solid->nodes, h5, alone, solid->n_nodes);
    if (h5->why == NULL)
        table_read(&solid->elements, h5, alone, solid->n_elements);
    for (int p = 0; p < SNAPSHOT_N_PARTS && h5->why == NULL; p++) {
        const struct field field = part_field(solid, p);
        if (has_part(solid, p))
            solid->parts[p].rows =
                read_mesh(h5, "solids", solid->name, &field, solid->parts[p].n);
    }
    if (h5->why == NULL) {
        check_nodes(h5, solid, SNAPSHOT_CORNERS);
        check_nodes(h5, solid, SNAPSHOT_TRIANGLES);
    }
}

static void read_rows(struct h5 *h5, struct snapshot *snapshot)
{
    const struct comm alone = {MPI_COMM_SELF, 0, 1};
    if (h5->why == NULL)
        table_read(&snapshot->spheres, h5, &alone, snapshot->next_id);
    if (h5->why == NULL && snapshot->has_contacts)
        table_read(&snapshot->contacts, h5, &alone, snapshot->next_id);
    for (int b = 0; b < snapshot->n_bodies && h5->why == NULL; b++) {
        struct snapshot_body *body = &snapshot->bodies[b];
        body->points = read_mesh(h5, "bodies", body->name, &POINTS, body->n_points);
        body->triangles = read_mesh(h5, "bodies", body->name, &TRIANGLES, body->n_triangles);
        for (int64_t k = 0; k < 3 * body->n_triangles; k++) {
            const int32_t point = body->triangles[k / 3][k % 3];
            if (point < 0 || point >= body->n_points)
                h5_fail(h5, "/bodies/%s: there is no point %d", body->name, (int)point);
        }
    }
    for (int s = 0; s < snapshot->n_solids && h5->why == NULL; s++)
        read_solid(h5, &snapshot->solids[s], &alone);
}

static char *read_file(const char *path, struct snapshot *snapshot, bool rows)
{
    struct h5 h5;
    h5_open(&h5, path);
    measure(&h5, snapshot);
    if (rows)
        read_rows(&h5, snapshot);
    h5_close(&h5);
    if (h5.why != NULL)
        snapshot_clear(snapshot);
    return h5.why;
}

char *snapshot_measure(const char *path, struct snapshot *snapshot)
{
    return read_file(path, snapshot, false);
}

char *snapshot_read(const char *path, struct snapshot *snapshot)
{
    return read_file(path, snapshot, true);
}
