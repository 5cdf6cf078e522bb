/*
 * Every check finds the place of its message by the path of the key
 * ("spheres.0.packing.spacing") in the tree that the file gave; where the key is not written,
 * the nearest thing around it stands for it.
 */
#include "job/job_check.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/elementary.h"
#include "base/report.h"
#include "job/job.h"
#include "job/schema.h"
#include "job/yaml_tree.h"

struct check {
    const struct job *job;
    const struct yaml_tree_node *root;
    struct mistakes *mistakes;
    int n_before; /* mistakes that the schema listed */
    bool *used;
};

/* Lists "path: what; expected" at the place of the path. */
static void mistake(const struct check *check, const char *path, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

static void mistake(const struct check *check, const char *path, const char *format, ...)
{
    const struct yaml_tree_node *node = yaml_tree_nearest(check->root, path);
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    mistakes_add(check->mistakes, node->file, node->line, node->column, "%s %s", path, text);
}

/* Did the schema find nothing wrong below this path? */
static bool is_clean(const struct check *check, const char *path)
{
    if (check->n_before >= SCHEMA_MISTAKES)
        return false; /* some are not listed */
    for (int i = 0; i < check->n_before; i++)
        if (strstr(check->mistakes->list[i].text, path) != NULL)
            return false;
    return true;
}

/* A mapping of materials that is refused leaves names that mean nothing. */
static bool is_material(const struct check *check, int material)
{
    return material >= 0 && material < check->job->n_materials;
}

#define PATH(...) snprintf(path, sizeof path, __VA_ARGS__)

/* ------------------------------------------------------------------------------- time,
 * names */

static void time_check(const struct check *check)
{
    const double end = check->job->time.end, step = check->job->time.step;
    if (!is_clean(check, "time") || step == 0.0)
        return;
    const double n_steps = end / step;
    char a[SCHEMA_DOUBLE], b[SCHEMA_DOUBLE];
    if (!(n_steps <= 1e15)) {
        mistake(check, "time.end", "is more than 1e15 steps away; fewer are expected");
        return;
    }
    const double whole = (double)(int64_t)(n_steps + 0.5);
    if (whole < 1.0 || !(fabs(n_steps - whole) <= 1e-9 * n_steps))
        mistake(check, "time.end",
                "is %s s, which is not a whole number of steps of %s s; a multiple is expected",
                schema_double(a, end), schema_double(b, step));
}

/* A name and where it stands in its list. */
struct named {
    const char *name;
    int i;
};

static int compare_names(const void *a, const void *b)
{
    const struct named *p = a, *q = b;
    const int order = strcmp(p->name, q->name);
    return order != 0 ? order : p->i - q->i;
}

/* Lists names that a list holds twice; a name is the first member of each element. */
static void names_check(const struct check *check, const char *list, int n,
                        const void *elements, size_t size)
{
    struct named *names = array_allocate((size_t)n, sizeof *names);
    int n_names = 0;
    for (int i = 0; i < n; i++) {
        const char *name =
            *(char *const *)(const void *)((const char *)elements + (size_t)i * size);
        if (name != NULL)
            names[n_names++] = (struct named){name, i};
    }
    qsort(names, (size_t)n_names, sizeof *names, compare_names);
    for (int k = 1; k < n_names; k++) {
        char path[64];
        PATH("%s.%d.name", list, names[k].i);
        if (strcmp(names[k - 1].name, names[k].name) == 0)
            mistake(check, path, "is '%s' like that of %s.%d; a name of its own is expected",
                    names[k].name, list, names[k - 1].i);
    }
    free(names);
}

/* A list whose elements begin with a name. */
struct named_list {
    const char *path;
    int n;
    const void *elements;
    size_t size;
};

static const char *name_in(const struct named_list *list, int i)
{
    return *(char *const *)(const void *)((const char *)list->elements +
                                          (size_t)i * list->size);
}

/* Lists names of one list that another one has too. */
static void names_apart_check(const struct check *check, const struct named_list *list,
                              const struct named_list *other)
{
    for (int i = 0; i < list->n; i++)
        for (int k = 0; k < other->n; k++) {
            const char *name = name_in(list, i), *theirs = name_in(other, k);
            char path[64];
            if (name == NULL || theirs == NULL || strcmp(name, theirs) != 0)
                continue;
            PATH("%s.%d.name", list->path, i);
            mistake(check, path, "is '%s' like that of %s.%d; a name of its own is expected",
                    name, other->path, k);
        }
}

/* What has columns of the same kind in the series: contents, bodies that forces move,
 * probes. */
static void columns_check(const struct check *check)
{
    const struct job *job = check->job;
    const struct named_list bodies = {"bodies", job->n_bodies, job->bodies,
                                      sizeof *job->bodies};
    const struct named_list contents = {"contents", job->n_contents, job->contents,
                                        sizeof *job->contents};
    const struct named_list probes = {"output.probes", job->output.n_probes, job->output.probes,
                                      sizeof *job->output.probes};
    names_apart_check(check, &contents, &bodies);
    names_apart_check(check, &probes, &bodies);
    names_apart_check(check, &probes, &contents);
}

/* ------------------------------------------------------------------------------- CSV files */

/* What is longer is no line of ours; the rest of it is taken for another one, which has too few
 * cells. */
enum { CSV_LINE_MOST = 4096 };

/* Column of a name in a comma-separated line, -1 where there is none. */
static int column_find(const char *line, const char *name)
{
    const size_t length = strlen(name);
    for (int column = 0;; column++) {
        const size_t width = strcspn(line, ",\r\n");
        const size_t blank = strspn(line, " \t");
        if (width >= blank + length && strncmp(line + blank, name, length) == 0 &&
            strspn(line + blank + length, " \t") == width - blank - length)
            return column;
        if (line[width] != ',')
            return -1;
        line += width + 1;
    }
}

/* The material that a line names in a column, -1 where there is no such material. */
static int material_find(const struct job *job, const char *line, int column)
{
    for (int k = 0; k < column; k++) {
        line += strcspn(line, ",\r\n");
        line += *line == ',';
    }
    line += strspn(line, " \t");
    size_t length = strcspn(line, ",\r\n");
    while (length > 0 && (line[length - 1] == ' ' || line[length - 1] == '\t'))
        length--;
    for (int m = 0; m < job->n_materials; m++)
        if (strncmp(job->materials[m].name, line, length) == 0 &&
            job->materials[m].name[length] == '\0')
            return m;
    return -1;
}

/* Marks the materials that the lines of a file name. */
static void csv_materials(const struct check *check, const char *file, FILE *in, int column,
                          bool *group)
{
    char line[CSV_LINE_MOST];
    int n_unknown = 0;
    for (int number = 2; n_unknown < 20 && fgets(line, sizeof line, in) != NULL; number++) {
        if (line[strspn(line, " \t\r\n")] == '\0')
            continue;
        const int material = material_find(check->job, line, column);
        if (material >= 0) {
            group[material] = true;
        } else {
            mistakes_add(
                check->mistakes, file, number, 1,
                "there is no such material as in column %d; one of the job is expected",
                column + 1);
            n_unknown++;
        }
    }
}

/* Looks at the file of a group: can it be read, does it have the columns that are needed, which
 * materials does it name?  The numbers are read when the spheres are made. */
static void csv_check(const struct check *check, int i, bool *group)
{
    const struct job_spheres *spheres = &check->job->spheres[i];
    char path[64], header[CSV_LINE_MOST];
    PATH("spheres.%d.packing.file", i);
    FILE *in = fopen(spheres->file, "r");
    if (in == NULL || fgets(header, sizeof header, in) == NULL) {
        mistake(check, path, "is '%.200s', which cannot be read: %s; a CSV file is expected",
                spheres->file, in == NULL ? strerror(errno) : "there is nothing in it");
    } else {
        if (column_find(header, "x_m") < 0 || column_find(header, "y_m") < 0 ||
            column_find(header, "z_m") < 0)
            mistakes_add(
                check->mistakes, spheres->file, 1, 1,
                "the columns x_m, y_m and z_m are not all there; a first line that names them "
                "is expected");
        PATH("spheres.%d.radius", i);
        if (spheres->radius == 0.0 && column_find(header, "radius_m") < 0)
            mistake(check, path,
                    "is missing, and %.200s has no column radius_m; one of them is expected",
                    spheres->file);
        const int column = column_find(header, "material");
        if (column >= 0)
            csv_materials(check, spheres->file, in, column, group);
        else
            group[spheres->material] = true;
    }
    if (in != NULL)
        fclose(in);
}

/* ------------------------------------------------------------------------------- regions,
 * sizes */

/* What the schema cannot know of a region at this path ("spheres.0.packing.region"). */
static void region_check(const struct check *check, const char *path,
                         const struct job_region *region)
{
    const struct job *job = check->job;
    const struct vec3 along = vec3_sub(region->to, region->from);
    bool found = region->body == NULL; /* that was told */
    if (region->kind == JOB_REGION_BOX &&
        !(region->min.x < region->max.x && region->min.y < region->max.y &&
          region->min.z < region->max.z))
        mistake(check, path,
                "has a max that is not above min in x, y and z; a greater corner "
                "is expected");
    if (region->kind == JOB_REGION_CYLINDER && !(vec3_norm(along) > 0.0))
        mistake(check, path, "has an axis without length; two different ends are expected");
    for (int b = 0; region->kind == JOB_REGION_INSIDE && b < job->n_bodies; b++)
        found = found ||
                (job->bodies[b].name != NULL && strcmp(job->bodies[b].name, region->body) == 0);
    if (region->kind == JOB_REGION_INSIDE && !found)
        mistake(check, path, "names '%s', which is no body; the name of a body is expected",
                region->body);
}

static void radii_check(const struct check *check, const char *path,
                        const struct job_sizes *sizes)
{
    double sum = 0.0;
    bool ascends = true;
    for (int k = 0; k < sizes->n; k++) {
        const struct job_size *size = &sizes->list[k];
        sum += size->share;
        ascends = ascends &&
                  (k == 0 || (size->radius > size[-1].radius && size->share >= size[-1].share));
    }
    if (sizes->kind == JOB_SIZES_LIST && !(sum > 0.0))
        mistake(check, path, "have no shares above 0; at least one is expected");
    if (sizes->kind == JOB_SIZES_TABLE && !ascends)
        mistake(check, path,
                "do not ascend in radius and share; a cumulative curve is expected");
    else if (sizes->kind == JOB_SIZES_TABLE &&
             (sizes->n < 2 || sizes->list[0].share != 0.0 ||
              !(fabs(sizes->list[sizes->n - 1].share - 1.0) <= 1e-9)))
        mistake(check, path,
                "do not lead from share 0 to share 1; a whole cumulative curve is "
                "expected");
}

/* Further from the mean there is less than a sphere in 1e9. */
static const double DEVIATIONS = 6.0;

/* What the schema cannot know of sizes at this path. */
static void sizes_check(const struct check *check, const char *path,
                        const struct job_sizes *sizes)
{
    char inner[80];
    if (sizes->kind == JOB_SIZES_LIST || sizes->kind == JOB_SIZES_TABLE) {
        snprintf(inner, sizeof inner, "%s.radii", path);
        radii_check(check, inner, sizes);
        return;
    }
    snprintf(inner, sizeof inner, "%s.max", path);
    if (!(sizes->min < sizes->max))
        mistake(check, inner, "is not above min; a greater radius is expected");
    const double share = sizes->deviation / sizes->mean;
    const double variance =
        elementary_log(1.0 + share * share); /* of the logarithm    (11.2) */
    const double wide = DEVIATIONS * sqrt(variance);
    const bool normal = sizes->kind == JOB_SIZES_NORMAL;
    const double low = normal ? sizes->mean - DEVIATIONS * sizes->deviation
                              : sizes->mean * elementary_exp(-0.5 * variance - wide);
    const double high = normal ? sizes->mean + DEVIATIONS * sizes->deviation
                               : sizes->mean * elementary_exp(wide - 0.5 * variance);
    snprintf(inner, sizeof inner, "%s.mean", path);
    if (sizes->kind != JOB_SIZES_UNIFORM && !(sizes->min <= high && sizes->max >= low))
        mistake(
            check, inner,
            "lies so far from min and max that hardly a sphere would be left; limits within "
            "six deviations of it are expected");
}

/* ------------------------------------------------------------------------------- spheres,
 * bodies */

/* The greatest radius that a group may have. */
static double greatest_radius(const struct job_spheres *spheres)
{
    double most = spheres->sizes.max;
    if (!spheres->sizes.given)
        return spheres->radius;
    for (int k = 0; k < spheres->sizes.n; k++)
        most = spheres->sizes.list[k].radius > most ? spheres->sizes.list[k].radius : most;
    return most;
}

static void lattice_check(const struct check *check, int i)
{
    const struct job_spheres *spheres = &check->job->spheres[i];
    const double diameter = 2.0 * greatest_radius(spheres);
    char path[64], number[SCHEMA_DOUBLE];
    PATH("spheres.%d.packing.count", i);
    if (spheres->count == 0)
        mistake(check, path, "is missing; a whole number between 1 and 2e9 is expected");
    PATH("spheres.%d.packing.spacing", i);
    if (spheres->spacing < diameter * (1.0 - 1e-12))
        mistake(check, path,
                "makes spheres overlap; at least two of the greatest radii, %s m, are "
                "expected",
                schema_double(number, diameter));
    PATH("spheres.%d.packing.size", i);
    if (spheres->size[0] < diameter * (1.0 - 1e-12) ||
        spheres->size[1] < diameter * (1.0 - 1e-12))
        mistake(check, path,
                "is narrower than a sphere; at least two radii, %s m, are expected",
                schema_double(number, diameter));
}

static void random_check(const struct check *check, int i)
{
    const struct job_spheres *spheres = &check->job->spheres[i];
    const int n = (spheres->count > 0) + (spheres->mass > 0.0) + (spheres->fraction > 0.0);
    char path[64];
    PATH("spheres.%d.packing", i);
    if (n != 1)
        mistake(check, path, "says %s; one of count, mass and fraction is expected",
                n == 0 ? "not how many spheres there are" : "twice how many spheres there are");
    PATH("spheres.%d.packing.region", i);
    region_check(check, path, &spheres->region);
}

/* A group has a radius or sizes; a CSV file may have the radii. */
static bool radii_are_fine(const struct check *check, int i)
{
    const struct job_spheres *spheres = &check->job->spheres[i];
    const bool in_file =
        spheres->packing == JOB_PACKING_CSV || spheres->packing == JOB_PACKING_HDF5;
    const int n_before = check->mistakes->n;
    char path[64];
    PATH("spheres.%d.sizes", i);
    if (spheres->sizes.given && in_file)
        mistake(check, path,
                "do not go with a packing from a file; the file's radii, or "
                "radius, is expected");
    else if (spheres->sizes.given && spheres->radius > 0.0)
        mistake(check, path, "are given besides a radius; one of the two is expected");
    else if (spheres->sizes.given)
        sizes_check(check, path, &spheres->sizes);
    PATH("spheres.%d.radius", i);
    if (!in_file && !spheres->sizes.given && spheres->radius == 0.0)
        mistake(check, path, "is missing; a length above 0 m, or sizes, is expected");
    return check->mistakes->n == n_before;
}

static void spheres_check(const struct check *check, bool read_files, bool *falling)
{
    const struct job *job = check->job;
    double total = 0.0;
    for (int i = 0; i < job->n_spheres; i++) {
        char path[64];
        PATH("spheres.%d.", i);
        if (!is_clean(check, path) || !is_material(check, job->spheres[i].material))
            continue;
        check->used[job->spheres[i].material] = true; /* even where a CSV file names others */
        const enum job_packing packing = job->spheres[i].packing;
        if (radii_are_fine(check, i) &&
            (packing == JOB_PACKING_LATTICE || packing == JOB_PACKING_HEXAGONAL))
            lattice_check(check, i);
        if (packing == JOB_PACKING_RANDOM)
            random_check(check, i);
        if (job->spheres[i].packing == JOB_PACKING_CSV && read_files)
            csv_check(check, i, falling);
        else
            falling[job->spheres[i].material] = true;
        total += (double)job->spheres[i].count;
    }
    if (total > 2e9)
        mistake(check, "spheres", "are more than 2e9 in all; fewer are expected");
}

/* The key under which the shape of a body stands. */
static const char *block_of(const struct job_body *body)
{
    return body->model == JOB_MODEL_SOLID ? "mesh" : "geometry";
}

static void box_check(const struct check *check, const struct job_body *body, int i)
{
    char path[64];
    PATH("bodies.%d.%s.max", i, block_of(body));
    if (!(body->min.x < body->max.x && body->min.y < body->max.y && body->min.z < body->max.z))
        mistake(check, path, "is not above min in x, y and z; a greater corner is expected");
    PATH("bodies.%d.geometry.open", i);
    if (body->open == 63)
        mistake(check, path, "leaves no side; at most five open sides are expected");
}

static void hopper_check(const struct check *check, const struct job_body *body, int i)
{
    char path[64];
    PATH("bodies.%d.geometry.z", i);
    if (!(body->z[0] < body->z[1]))
        mistake(check, path,
                "does not ascend; the outlet's height and a greater one are expected");
}

static void axis_check(const struct check *check, const struct job_body *body, int i)
{
    char path[64];
    PATH("bodies.%d.%s.to", i, block_of(body));
    if (!(vec3_norm(vec3_sub(body->to, body->from)) > 0.0))
        mistake(check, path, "is where from is; another place is expected");
}

static void cone_check(const struct check *check, const struct job_body *body, int i)
{
    char path[64];
    PATH("bodies.%d.geometry.radii", i);
    if (!(body->radii[0] + body->radii[1] > 0.0))
        mistake(check, path, "are both 0; at least one above 0 m is expected");
}

static void tube_check(const struct check *check, const struct job_body *body, int i)
{
    char path[64];
    PATH("bodies.%d.%s.outer", i, block_of(body));
    if (!(body->inner < body->outer))
        mistake(check, path, "is not above inner; a greater radius is expected");
}

static struct vec3 corner_product(const struct job_body *body, const int *facet, int a, int b,
                                  int c)
{
    const struct vec3 *p = body->vertices;
    return vec3_cross(vec3_sub(p[facet[b]], p[facet[a]]), vec3_sub(p[facet[c]], p[facet[a]]));
}

/* What is wrong with a facet; NULL when nothing is. */
static const char *facet_fault(const struct job_body *body, const int *facet)
{
    const int n = facet[3] < 0 ? 3 : 4;
    for (int a = 0; a < n; a++) {
        if (facet[a] >= body->n_vertices)
            return "names a vertex that is not there";
        for (int b = 0; b < a; b++)
            if (facet[a] == facet[b])
                return "names a vertex twice";
    }
    if (vec3_norm(corner_product(body, facet, 0, 1, 2)) == 0.0 ||
        (n == 4 && vec3_norm(corner_product(body, facet, 0, 2, 3)) == 0.0))
        return "has no area";
    return NULL;
}

static void mesh_check(const struct check *check, const struct job_body *body, int i)
{
    char path[64];
    PATH("bodies.%d.geometry.facets", i);
    if (body->n_facets == 0)
        mistake(check, path, "is empty; at least one facet is expected");
    int n_wrong = 0;
    for (int f = 0; f < body->n_facets && n_wrong < 20; f++) {
        const char *fault = facet_fault(body, body->facets[f]);
        PATH("bodies.%d.geometry.facets.%d", i, f);
        if (fault != NULL) {
            mistake(check, path,
                    "%s; 3 or 4 different vertices from 0 to %d that span an area are expected",
                    fault, body->n_vertices - 1);
            n_wrong++;
        }
    }
}

/* The place of motion m of a list in messages, with a key of it: as the file has it, one
 * mapping or an element of a list. */
static void motion_path(const struct check *check, const char *list, int m, const char *key,
                        char *path, size_t size)
{
    const struct yaml_tree_node *node = yaml_tree_nearest(check->root, list);
    if (node->kind == YAML_TREE_LIST)
        snprintf(path, size, "%s.%d.%s", list, m, key);
    else
        snprintf(path, size, "%s.%s", list, key);
}

static void path_check(const struct check *check, const struct job_motion *motion,
                       const char *list, int m)
{
    const struct job_path_point *points = motion->path.points;
    char path[160];
    bool turns = false;
    motion_path(check, list, m, "path.points", path, sizeof path);
    if (motion->path.n > 0 && motion->path.file != NULL)
        mistake(check, path, "stands beside a file; one of them is expected");
    else if (motion->path.n < 2)
        mistake(check, path, "has fewer than 2 points; at least 2, or a file, are expected");
    for (int k = 0; k < motion->path.n; k++)
        turns = turns || points[k].angle != 0.0;
    for (int k = 1; k < motion->path.n; k++) {
        if (points[k - 1].time < points[k].time)
            continue;
        char point[32];
        snprintf(point, sizeof point, "path.points.%d.time", k);
        motion_path(check, list, m, point, path, sizeof path);
        mistake(check, path,
                "does not ascend; a time after that of the point before is expected");
        break;
    }
    motion_path(check, list, m, "path.axis", path, sizeof path);
    if (turns && vec3_norm(motion->path.axis) == 0.0)
        mistake(check, path, "is missing; the axis of the path's angles is expected");
}

/* The motions under the key `list`. */
static void motions_check(const struct check *check, int n, const struct job_motion *motions,
                          const char *list)
{
    char path[160];
    for (int m = 0; m < n; m++) {
        const struct job_motion *motion = &motions[m];
        const int n_turns = (vec3_norm(motion->axis) > 0.0) +
                            (vec3_norm(motion->swing.axis) > 0.0) +
                            (vec3_norm(motion->path.axis) > 0.0);
        motion_path(check, list, m, "stop", path, sizeof path);
        if (!(motion->start < motion->stop))
            mistake(check, path, "is not after start; a later time is expected");
        motion_path(check, list, m, "rotation", path, sizeof path);
        if (n_turns > 1)
            mistake(check, path,
                    "is one of several turns in a motion; one of rotation, swing and path.axis "
                    "is expected, others in motions of their own");
        if (motion->path.given)
            path_check(check, motion, list, m);
    }
}

/* Is a symmetric matrix (xx, yy, zz, xy, xz, yz) positive? */
static bool is_positive(const double m[6])
{
    const double minor = m[0] * m[1] - m[3] * m[3];
    const double all = m[0] * (m[1] * m[2] - m[5] * m[5]) - m[3] * (m[3] * m[2] - m[5] * m[4]) +
                       m[4] * (m[3] * m[5] - m[1] * m[4]);
    return m[0] > 0.0 && minor > 0.0 && all > 0.0;
}

/* Half the trace less the tensor is the second moment of mass, which cannot be negative: then
 * no principal moment is larger than the other two together. */
static bool is_inertia(const double m[6])
{
    const double half = 0.5 * (m[0] + m[1] + m[2]), hair = 1e-9 * half;
    const double moments[6] = {
        half - m[0] + hair, half - m[1] + hair, half - m[2] + hair, -m[3], -m[4], -m[5]};
    return is_positive(m) && is_positive(moments);
}

static void free_check(const struct check *check, const struct job_free *asked, int i)
{
    char path[64];
    const bool masses = asked->mass > 0.0 || asked->has_inertia || asked->has_centre;
    PATH("bodies.%d.free", i);
    if (asked->density > 0.0
            ? masses
            : !(asked->mass > 0.0) || !asked->has_inertia || !asked->has_centre)
        mistake(check, path,
                "has no mass, or two; density, or mass, inertia and centre, are expected");
    PATH("bodies.%d.free.inertia", i);
    if (asked->has_inertia && !is_inertia(asked->inertia))
        mistake(check, path,
                "is that of no body; positive principal moments, none larger than the other "
                "two together, are expected");
}

/* A surface that runs. */
static void running_check(const struct check *check, const struct job_body *body, int i)
{
    const struct job_motion *motion = &body->surface.motion;
    char path[64];
    if (!body->surface.given)
        return;
    PATH("bodies.%d.surface", i);
    if (body->driven.given || body->free.given)
        mistake(
            check, path,
            "is that of a body that forces move; one at rest, or with a motion, is expected");
    if (vec3_norm(motion->velocity) == 0.0 && vec3_norm(motion->axis) == 0.0)
        mistake(check, path, "does not run; a velocity or a rotation is expected");
    PATH("bodies.%d.surface.stop", i);
    if (!(motion->start < motion->stop))
        mistake(check, path, "is not after start; a later time is expected");
}

/* What moves a body besides a motion. */
static void forced_check(const struct check *check, const struct job_body *body, int i)
{
    const struct job_driven *driven = &body->driven;
    char path[64];
    const int n_ways = (body->n_motions > 0) + driven->given + body->free.given;
    PATH("bodies.%d.%s", i, driven->given ? "driven" : "free");
    if (n_ways > 1)
        mistake(
            check, path,
            "stands beside another way to move; one of motion, driven and free is expected");
    const bool slides = driven->kind == JOB_DRIVE_SLIDE;
    const double *limits = slides ? driven->travel : driven->angles;
    PATH("bodies.%d.driven.%s", i, slides ? "travel" : "angles");
    if (driven->given && driven->limited &&
        !(limits[0] <= 0.0 && limits[1] >= 0.0 && limits[0] < limits[1]))
        mistake(check, path,
                "does not ascend from 0 or less to 0 or more; 0 is where the body starts");
    const bool waits =
        (driven->given && driven->start > 0.0) || (body->free.given && body->free.start > 0.0);
    const bool runs = driven->speed != 0.0 || driven->rate != 0.0 ||
                      vec3_norm(body->free.velocity) > 0.0 || vec3_norm(body->free.spin) > 0.0;
    PATH("bodies.%d.%s.start", i, driven->given ? "driven" : "free");
    if (waits && runs)
        mistake(check, path, "holds a body that has a speed at the start; none is expected");
    if (body->free.given)
        free_check(check, &body->free, i);
}

static void gravity_check(const struct check *check)
{
    const struct job *job = check->job;
    const bool turns = vec3_norm(job->gravity_turn.axis) > 0.0;
    char path[64];
    if (!is_clean(check, "gravity"))
        return;
    if (job->n_gravity_table > 0 && turns)
        mistake(check, "gravity_table", "stands beside gravity_turn; one of them is expected");
    if (turns && !(job->gravity_turn.start < job->gravity_turn.stop))
        mistake(check, "gravity_turn.stop", "is not after start; a later time is expected");
    for (int k = 1; k < job->n_gravity_table; k++) {
        PATH("gravity_table.%d.time", k);
        if (!(job->gravity_table[k - 1].time < job->gravity_table[k].time))
            mistake(check, path, "does not ascend; a time after the one before is expected");
    }
}

/* Can the file of a body be opened?  What is in it is looked at when it is read. */
static void surface_check(const struct check *check, const struct job_body *body, int i)
{
    char path[64];
    struct stat about;
    const char *what = body->model == JOB_MODEL_SOLID ? "mesh" : "surface";
    PATH("bodies.%d.%s.file", i, block_of(body));
    FILE *in = fopen(body->file, "rb");
    if (in == NULL || fstat(fileno(in), &about) != 0)
        mistake(check, path,
                "is '%.200s', which cannot be read: %s; a file with a %s is expected",
                body->file, strerror(errno), what);
    else if (S_ISDIR(about.st_mode))
        mistake(check, path, "is '%.200s', which is a folder; a file with a %s is expected",
                body->file, what);
    if (in != NULL)
        fclose(in);
}

/* What the members of a shape ask of each other. */
static void shape_check(const struct check *check, const struct job_body *body, int i,
                        bool read_files)
{
    switch (body->geometry) {
    case JOB_GEOMETRY_PLANE:
        break;
    case JOB_GEOMETRY_BOX:
        box_check(check, body, i);
        break;
    case JOB_GEOMETRY_HOPPER:
        hopper_check(check, body, i);
        break;
    case JOB_GEOMETRY_CONICAL_HOPPER:
        hopper_check(check, body, i);
        cone_check(check, body, i);
        break;
    case JOB_GEOMETRY_CONE:
        axis_check(check, body, i);
        cone_check(check, body, i);
        break;
    case JOB_GEOMETRY_CYLINDER:
        axis_check(check, body, i);
        break;
    case JOB_GEOMETRY_TUBE:
        axis_check(check, body, i);
        tube_check(check, body, i);
        break;
    case JOB_GEOMETRY_MESH:
        mesh_check(check, body, i);
        break;
    case JOB_GEOMETRY_STL:
    case JOB_GEOMETRY_GMSH:
        if (read_files)
            surface_check(check, body, i);
        break;
    }
}

/* ------------------------------------------------------------------------------- solids */

/* Times of a table that do not ascend. */
static void table_check(const struct check *check, const char *item, const char *table, int n,
                        const struct job_value *rows)
{
    char path[160];
    for (int k = 1; k < n; k++) {
        if (rows[k - 1].time < rows[k].time)
            continue;
        PATH("%s.%s.%d.time", item, table, k);
        mistake(check, path,
                "does not ascend; a time after that of the row before is expected");
        return;
    }
}

/* One item of the boundary of a body that deforms. */
static void condition_check(const struct check *check, const char *item, bool turns,
                            const struct job_boundary *asked)
{
    char path[160];
    const int moved = (asked->n_displacements > 0) + asked->has_velocity +
                      (asked->n_velocities > 0) + asked->has_force + (asked->n_forces > 0);
    const int pressed = asked->has_pressure + (asked->n_pressures > 0);
    const int held = (asked->fixed != 0 || asked->fixed_turns != 0) + (asked->n_motions > 0);
    if (moved + pressed + held != 1)
        mistake(check, item,
                "prescribes %s; one of fixed with fixed_turns, motion, displacement_table, "
                "velocity, force, pressure or one of their tables is expected, others in items "
                "of their own",
                moved + pressed + held == 0 ? "nothing" : "several things");
    else if ((moved == 1) != asked->has_direction)
        mistake(check, item,
                "has %s; x, y or z is expected beside displacement, velocity and "
                "force alone",
                moved == 1 ? "no direction" : "a direction that says nothing");
    PATH("%s.fixed_turns", item);
    if (asked->fixed_turns != 0 && !turns)
        mistake(check, path, "holds what does not turn; nodes of a shell are expected");
    PATH("%s.motion", item);
    motions_check(check, asked->n_motions, asked->motions, path);
    table_check(check, item, "displacement_table", asked->n_displacements,
                asked->displacements);
    table_check(check, item, "velocity_table", asked->n_velocities, asked->velocities);
    table_check(check, item, "force_table", asked->n_forces, asked->forces);
    table_check(check, item, "pressure_table", asked->n_pressures, asked->pressures);
    PATH("%s.displacement_table.0.displacement", item);
    if (asked->n_displacements > 0 && asked->displacements[0].value != 0.0)
        mistake(check, path, "is not 0, so the nodes would jump at the start; 0 is expected");
}

static void solid_shape_check(const struct check *check, const struct job_body *body, int i,
                              bool read_files)
{
    const bool cells = body->solid.cells[0] > 0, cell = body->solid.cell > 0.0;
    char path[64];
    switch (body->solid.kind) {
    case JOB_MESH_BOX:
        box_check(check, body, i);
        break;
    case JOB_MESH_PLATE:
        break;
    case JOB_MESH_CYLINDER:
        axis_check(check, body, i);
        break;
    case JOB_MESH_TUBE:
        axis_check(check, body, i);
        tube_check(check, body, i);
        PATH("bodies.%d.mesh.cells", i);
        if (cells && body->solid.cells[0] < 3)
            mistake(check, path, "has fewer than 3 around the axis; at least 3 are expected");
        break;
    case JOB_MESH_GMSH:
        if (read_files)
            surface_check(check, body, i);
        return;
    }
    PATH("bodies.%d.mesh", i);
    if (cells == cell)
        mistake(check, path,
                "says %s how many cells there are; one of cells and cell is "
                "expected",
                cells ? "twice" : "not");
}

static bool is_round(const struct job_body *body)
{
    return body->geometry == JOB_GEOMETRY_CYLINDER || body->geometry == JOB_GEOMETRY_CONE ||
           body->geometry == JOB_GEOMETRY_CONICAL_HOPPER || body->geometry == JOB_GEOMETRY_TUBE;
}

/* What bodies that deform have besides their shapes. */
static void parts_check(const struct check *check, const struct job_body *body, int i)
{
    const struct job_solid *solid = &body->solid;
    char path[64];
    PATH("bodies.%d.thickness", i);
    if (body->model != JOB_MODEL_SOLID && !(body->sheet.thickness > 0.0))
        mistake(check, path, "is missing; a number above 0 is expected");
    PATH("bodies.%d.sets", i);
    names_check(check, path, solid->n_sets, solid->sets, sizeof *solid->sets);
    for (int k = 0; k < solid->n_sets; k++) {
        PATH("bodies.%d.sets.%d.region", i, k);
        if (solid->sets[k].region.kind == JOB_REGION_INSIDE)
            mistake(check, path,
                    "is the inside of a body; a box, cylinder or sphere is "
                    "expected");
        else
            region_check(check, path, &solid->sets[k].region);
    }
    for (int k = 0; k < solid->n_boundary; k++) {
        PATH("bodies.%d.boundary.%d", i, k);
        condition_check(check, path, job_turns(body), &solid->boundary[k]);
    }
    for (int k = 0; k < solid->n_masses; k++) {
        PATH("bodies.%d.masses.%d.inertia", i, k);
        if (solid->masses[k].inertia > 0.0 && !job_turns(body))
            mistake(check, path, "is of what does not turn; nodes of a shell are expected");
    }
}

/* What the members of a material ask of each other. */
static void materials_check(const struct check *check)
{
    for (int m = 0; m < check->job->n_materials; m++) {
        const struct job_material *material = &check->job->materials[m];
        const struct job_hardening *rows = material->hardening_table;
        char path[96];
        PATH("materials.%s.", material->name);
        if (!is_clean(check, path))
            continue;
        PATH("materials.%s.hardening", material->name);
        if (material->hardening > 0.0 && material->yield == 0.0)
            mistake(check, path, "has no yield beside it; one is expected");
        PATH("materials.%s.hardening_table", material->name);
        if (material->n_hardening_table > 0 &&
            (material->yield > 0.0 || material->hardening > 0.0))
            mistake(check, path, "stands beside yield or hardening; one of them is expected");
        if (material->n_hardening_table > 0 && rows[0].strain != 0.0)
            mistake(check, path,
                    "does not begin at strain 0; the first row is the stress at "
                    "which the material begins to flow");
        for (int k = 1; k < material->n_hardening_table; k++) {
            PATH("materials.%s.hardening_table.%d", material->name, k);
            if (rows[k].strain > rows[k - 1].strain && rows[k].stress >= rows[k - 1].stress)
                continue;
            mistake(check, path,
                    "does not ascend; a greater strain than in the row before, and no less "
                    "stress, are expected");
            break;
        }
    }
}

static void bodies_check(const struct check *check, bool read_files, bool *standing)
{
    const struct job *job = check->job;
    int n_forced = 0;
    for (int i = 0; i < job->n_bodies; i++) {
        const struct job_body *body = &job->bodies[i];
        char path[64];
        PATH("bodies.%d.", i);
        if (!is_clean(check, path) || !is_material(check, job->bodies[i].material))
            continue;
        standing[body->material] = true;
        for (int k = 0; k < body->solid.n_shells; k++)
            if (body->solid.shells[k].has_material &&
                is_material(check, body->solid.shells[k].material))
                check->used[body->solid.shells[k].material] = true;
        if (body->model == JOB_MODEL_SOLID)
            solid_shape_check(check, body, i, read_files);
        else
            shape_check(check, body, i, read_files);
        if (job_deforms(body))
            parts_check(check, body, i);
        PATH("bodies.%d.geometry.segments", i);
        if (job_deforms(body) && is_round(body) && body->segments == 0)
            mistake(check, path,
                    "is exact, the curved surface itself, which has no elements; a number of "
                    "facets around the axis is expected");
        PATH("bodies.%d.motion", i);
        motions_check(check, body->n_motions, body->motions, path);
        forced_check(check, body, i);
        running_check(check, body, i);
        PATH("bodies.%d.active", i);
        if (body->comes_and_goes && !(body->active[0] < body->active[1]))
            mistake(check, path,
                    "does not ascend; two times, the later one last, are expected");
        n_forced += body->driven.given || body->free.given;
    }
    if (n_forced > JOB_FORCED_MOST)
        mistake(check, "bodies", "has %d that are driven or free; at most %d are expected",
                n_forced, JOB_FORCED_MOST);
}

/* Numbers of a list that do not ascend. */
static void ascent_check(const struct check *check, const char *path, int n,
                         const double *values)
{
    for (int k = 1; k < n; k++)
        if (!(values[k - 1] < values[k])) {
            mistake(check, path, "do not ascend; each above the one before is expected");
            return;
        }
}

/* Which materials an insertion brings. */
static void insertion_materials(const struct check *check, int i, bool *falling)
{
    const struct job_insertion *insertion = &check->job->insertions[i];
    char path[64];
    PATH("insert.%d", i);
    if (insertion->has_material == (insertion->n_mix > 0))
        mistake(check, path, "names %s; a material or a mix is expected",
                insertion->has_material ? "a material and a mix" : "no material");
    else if (insertion->has_material && is_material(check, insertion->material))
        falling[insertion->material] = true;
    for (int k = 0; k < insertion->n_mix; k++)
        if (is_material(check, insertion->mix[k].material))
            falling[insertion->mix[k].material] = true;
}

static void insertions_check(const struct check *check, bool *falling)
{
    for (int i = 0; i < check->job->n_insertions; i++) {
        const struct job_insertion *insertion = &check->job->insertions[i];
        char path[64];
        PATH("insert.%d.", i);
        if (!is_clean(check, path))
            continue;
        insertion_materials(check, i, falling);
        PATH("insert.%d", i);
        if ((insertion->radius > 0.0) == insertion->sizes.given)
            mistake(check, path, "gives %s; a radius or sizes are expected",
                    insertion->sizes.given ? "a radius and sizes" : "no radius");
        PATH("insert.%d.sizes", i);
        if (insertion->sizes.given)
            sizes_check(check, path, &insertion->sizes);
        PATH("insert.%d.region", i);
        region_check(check, path, &insertion->region);
        PATH("insert.%d.rate", i);
        if (insertion->by_number == insertion->by_mass)
            mistake(check, path, "gives %s; a number or a mass in a second is expected",
                    insertion->by_mass ? "a number and a mass" : "nothing");
        PATH("insert.%d.until.time", i);
        if (!(insertion->until_time > insertion->start))
            mistake(check, path, "is not after start; a later time is expected");
    }
}

static void removals_check(const struct check *check)
{
    for (int i = 0; i < check->job->n_removals; i++) {
        const struct job_removal *removal = &check->job->removals[i];
        char path[64];
        PATH("remove.%d.", i);
        if (!is_clean(check, path))
            continue;
        PATH("remove.%d.region", i);
        region_check(check, path, &removal->region);
        PATH("remove.%d.stop", i);
        if (!(removal->start < removal->stop))
            mistake(check, path, "is not after start; a later time is expected");
    }
}

/* Has a body a frame: is it rigid, or is a part of it moved like one? */
static bool has_frame(const struct job_body *body)
{
    bool follows = body->model == JOB_MODEL_RIGID;
    for (int k = 0; k < body->solid.n_boundary; k++)
        follows = follows || body->solid.boundary[k].n_motions > 0;
    return follows;
}

/* A region moves with such a body. */
static void follows_check(const struct check *check, const char *path, const char *name)
{
    const struct job_body *body = NULL;
    for (int b = 0; name != NULL && b < check->job->n_bodies; b++)
        if (check->job->bodies[b].name != NULL && strcmp(check->job->bodies[b].name, name) == 0)
            body = &check->job->bodies[b];
    if (name != NULL && (body == NULL || !has_frame(body)))
        mistake(
            check, path,
            "names '%s', which is no rigid body, nor one of which a set follows a motion; the "
            "name of one is expected",
            name);
}

static void contents_check(const struct check *check)
{
    for (int i = 0; i < check->job->n_contents; i++) {
        char path[64];
        PATH("contents.%d.", i);
        if (!is_clean(check, path))
            continue;
        PATH("contents.%d.region", i);
        region_check(check, path, &check->job->contents[i].region);
        PATH("contents.%d.follows", i);
        follows_check(check, path, check->job->contents[i].follows);
    }
}

/* The deformable body of this name; NULL: there is none. */
static const struct job_body *solid_find(const struct job *job, const char *name)
{
    for (int b = 0; b < job->n_bodies; b++)
        if (job_deforms(&job->bodies[b]) && job->bodies[b].name != NULL &&
            strcmp(job->bodies[b].name, name) == 0)
            return &job->bodies[b];
    return NULL;
}

/* Sets are looked for when the mesh is known. */
static void probes_check(const struct check *check)
{
    for (int i = 0; i < check->job->output.n_probes; i++) {
        const struct job_probe *probe = &check->job->output.probes[i];
        char path[64];
        PATH("output.probes.%d.", i);
        if (!is_clean(check, path))
            continue;
        PATH("output.probes.%d", i);
        if (probe->has_node + probe->has_element + (probe->nodes != NULL) +
                (probe->elements != NULL) !=
            1)
            mistake(check, path, "has %s; one of node, nodes, element, elements is expected",
                    probe->has_node || probe->has_element || probe->nodes != NULL ||
                            probe->elements != NULL
                        ? "several places"
                        : "no place");
        PATH("output.probes.%d.body", i);
        if (solid_find(check->job, probe->body) == NULL)
            mistake(check, path,
                    "names '%s', which is no body that deforms; the name of one is "
                    "expected",
                    probe->body);
    }
}

static void sections_check(const struct check *check)
{
    for (int i = 0; i < check->job->n_sections; i++) {
        const struct job_section *section = &check->job->sections[i];
        char path[64];
        PATH("sections.%d.", i);
        if (!is_clean(check, path))
            continue;
        PATH("sections.%d.across", i);
        if (section->kind == JOB_SECTION_RECTANGLE &&
            !(vec3_norm(vec3_cross(section->normal, section->across)) > 1e-6))
            mistake(check, path, "is along the normal; a direction in the plane is expected");
        PATH("sections.%d.classes", i);
        ascent_check(check, path, section->n_classes, section->classes);
        if (section->n_classes > 0 && (section->by & JOB_SPLIT_SIZE) == 0)
            mistake(check, path, "have no use without `by: size`; it is expected beside them");
    }
}

static void domain_check(const struct check *check)
{
    const struct job *job = check->job;
    const struct yaml_tree_node *domain = yaml_tree_find(check->root, "domain");
    const bool min = yaml_tree_find(domain, "min") != NULL,
               max = yaml_tree_find(domain, "max") != NULL;
    if (!is_clean(check, "domain"))
        return;
    if (min != max)
        mistake(check, min ? "domain.max" : "domain.min",
                "is missing; both corners, or none, are expected");
    else if (!min && job->domain.periodic != 0)
        mistake(check, "domain.periodic",
                "repeats a region that is not given; domain.min and domain.max are expected");
    else if (min &&
             !(job->domain.min.x < job->domain.max.x && job->domain.min.y < job->domain.max.y &&
               job->domain.min.z < job->domain.max.z))
        mistake(check, "domain.max",
                "is not above min in x, y and z; a greater corner is expected");
}

/* A plane oblique to a periodic direction would not meet its own image. */
static void periods_check(const struct check *check)
{
    const struct job *job = check->job;
    for (int s = 0; s < job->n_sections; s++) {
        const struct vec3 n = job->sections[s].normal;
        const double normal[3] = {n.x, n.y, n.z};
        char path[64];
        PATH("sections.%d.", s);
        bool fits = !is_clean(check, path);
        bool along = false;
        for (int k = 0; k < 3; k++) {
            fits = fits || fabs(normal[k]) == 1.0;
            along = along || ((job->domain.periodic & 1 << k) != 0 && normal[k] != 0.0);
        }
        PATH("sections.%d.normal", s);
        if (along && !fits)
            mistake(check, path,
                    "is oblique to a periodic direction; one along or across all of "
                    "domain.periodic is expected");
    }
}

/* ------------------------------------------------------------------------------- pairs */

/* May a body that is made of one material touch another, or itself? */
static bool bodies_meet(const struct job *job, int a, int b)
{
    for (int k = 0; k < job->n_bodies; k++) {
        const enum job_touches what = job->bodies[k].solid.touches.what;
        for (int m = 0; m < job->n_bodies && what != JOB_TOUCHES_SPHERES; m++) {
            const int p = job->bodies[k].material, q = job->bodies[m].material;
            if ((m != k || what == JOB_TOUCHES_ITSELF) &&
                ((p == a && q == b) || (p == b && q == a)))
                return true;
        }
    }
    return false;
}

/* Lists pairs of materials that are given twice or are missing.  `falling` are the spheres'
 * materials, `standing` those of bodies. */
static void pairs_check(const struct check *check, const bool *falling, const bool *standing)
{
    const struct job *job = check->job;
    const size_t n = (size_t)job->n_materials;
    int *given = array_allocate(n * n, sizeof *given); /* which pair says it, from 1 */
    for (int k = 0; k < job->n_pairs; k++) {
        const struct job_pair *pair = &job->pairs[k];
        char path[64];
        PATH("contact.pairs.%d", k);
        if (!is_material(check, pair->a) || !is_material(check, pair->b))
            continue;
        const size_t a = (size_t)(pair->a < pair->b ? pair->a : pair->b);
        const size_t b = (size_t)(pair->a < pair->b ? pair->b : pair->a);
        if (given[a * n + b] != 0)
            mistake(check, path,
                    "is about the same materials as contact.pairs.%d; one pair is expected",
                    given[a * n + b] - 1);
        given[a * n + b] = k + 1;
    }
    for (size_t a = 0; a < n && is_clean(check, "contact"); a++) {
        for (size_t b = a; b < n; b++) {
            const bool meet = (falling[a] && (falling[b] || standing[b])) ||
                              (standing[a] && falling[b]) || bodies_meet(job, (int)a, (int)b);
            const char *p = job->materials[a].name, *q = job->materials[b].name;
            if (meet && given[a * n + b] == 0)
                mistake(check, "contact.pairs",
                        "say nothing about %s and %s, which can meet; {between: [%s, %s], "
                        "friction: ..., "
                        "restitution: ...} is expected",
                        p, q, p, q);
        }
    }
    free(given);
}

/* What the members of a pair ask of each other. */
static void laws_check(const struct check *check)
{
    const struct job *job = check->job;
    char path[64];

    for (int k = 0; k < job->n_pairs && is_clean(check, "contact"); k++) {
        const struct job_pair *pair = &job->pairs[k];
        const enum job_law law = pair->law == JOB_LAW_DEFAULT ? job->law : pair->law;
        PATH("contact.pairs.%d", k);
        if (law == JOB_LAW_LINEAR && pair->stiffness == 0.0 && job->stiffness == 0.0)
            mistake(check, path,
                    "has the linear law but no stiffness; stiffness: ... in N/m is expected, "
                    "here or in contact");
        if (pair->static_friction >= 0.0 && pair->static_friction < pair->friction)
            mistake(check, path,
                    "has a static_friction below its friction; at least as much is expected");
    }
}

static bool has_solid(const struct job *job)
{
    for (int b = 0; b < job->n_bodies; b++)
        if (job_deforms(&job->bodies[b]))
            return true;
    return false;
}

void job_check(const struct job *job, const struct yaml_tree_node *root, bool read_files,
               bool *used, struct mistakes *mistakes)
{
    const struct check check = {job, root, mistakes, mistakes->n, used};
    bool *falling = array_allocate((size_t)job->n_materials, sizeof *falling);
    bool *standing = array_allocate((size_t)job->n_materials, sizeof *standing);
    time_check(&check);
    names_check(&check, "spheres", job->n_spheres, job->spheres, sizeof *job->spheres);
    names_check(&check, "bodies", job->n_bodies, job->bodies, sizeof *job->bodies);
    names_check(&check, "sections", job->n_sections, job->sections, sizeof *job->sections);
    names_check(&check, "contents", job->n_contents, job->contents, sizeof *job->contents);
    columns_check(&check);
    names_check(&check, "output.probes", job->output.n_probes, job->output.probes,
                sizeof *job->output.probes);
    names_check(&check, "insert", job->n_insertions, job->insertions, sizeof *job->insertions);
    names_check(&check, "remove", job->n_removals, job->removals, sizeof *job->removals);
    materials_check(&check);
    spheres_check(&check, read_files, falling);
    bodies_check(&check, read_files, standing);
    if (job->n_spheres == 0 && job->n_insertions == 0 && !job->start.given && !has_solid(job) &&
        is_clean(&check, "spheres") && is_clean(&check, "insert"))
        mistake(&check, "spheres",
                "are missing; a group of spheres, `insert`, or a solid body is expected");
    insertions_check(&check, falling);
    removals_check(&check);
    contents_check(&check);
    probes_check(&check);
    sections_check(&check);
    gravity_check(&check);
    for (int r = 0; r < job->n_damping_regions; r++) {
        char path[64];
        PATH("damping_regions.%d.region", r);
        if (is_clean(&check, path))
            region_check(&check, path, &job->damping_regions[r].region);
    }
    domain_check(&check);
    periods_check(&check);
    pairs_check(&check, falling, standing);
    laws_check(&check);
    for (int m = 0; m < job->n_materials; m++)
        used[m] = used[m] || falling[m] || standing[m] || job->start.given;
    free(falling);
    free(standing);
}
