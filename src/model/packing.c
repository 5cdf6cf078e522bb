/*
 * See packing.h.  A CSV file begins with a header that names its columns: x_m, y_m, z_m and,
 * where given, radius_m, material, vx_m_s, vy_m_s, vz_m_s; what it leaves out the group says.
 * The file is held in memory while the scene is built.
 */
#include "model/packing.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/random.h"
#include "job/job.h"

enum column {
    COLUMN_X,
    COLUMN_Y,
    COLUMN_Z,
    COLUMN_RADIUS,
    COLUMN_MATERIAL,
    COLUMN_VX,
    COLUMN_VY,
    COLUMN_VZ
};
enum { N_COLUMNS = 8, CELLS_MAX = 32, LINE_MAX_SIZE = 4096 };

/* Places and speeds beyond this are beyond any use; as in job files [m], [m/s]. */
static const double FAR = 1e6;

static const char *const COLUMN_NAMES[N_COLUMNS] = {"x_m",      "y_m",    "z_m",    "radius_m",
                                                    "material", "vx_m_s", "vy_m_s", "vz_m_s"};

struct reader {
    const char *path;
    int line;
    const char *start; /* of the line */
    int n_cells;
    int column[CELLS_MAX]; /* which column a cell of a row is; -1: none of ours */
    char **why;
};

static bool complain(struct reader *reader, const char *at, const char *what)
{
    const int column = (int)(at - reader->start) + 1;
    *reader->why = array_format("%s:%d:%d: %s", reader->path, reader->line, column, what);
    return false;
}

/* Splits a line at commas, in place; returns the number of cells. */
static int split(char *line, char *cells[CELLS_MAX])
{
    int n = 0;
    line[strcspn(line, "\r\n")] = '\0';
    for (char *at = line; n < CELLS_MAX; at++) {
        cells[n++] = at;
        at += strcspn(at, ",");
        if (*at == '\0')
            break;
        *at = '\0';
    }
    return n;
}

static bool read_header(struct reader *reader, char *line)
{
    char *cells[CELLS_MAX];
    int seen = 0;
    reader->n_cells = split(line, cells);
    for (int c = 0; c < reader->n_cells; c++) {
        reader->column[c] = -1;
        for (int k = 0; k < N_COLUMNS; k++) {
            if (strcmp(cells[c], COLUMN_NAMES[k]) == 0) {
                reader->column[c] = k;
                seen |= 1 << k;
            }
        }
    }
    if ((seen & 7) != 7)
        return complain(reader, line,
                        "the header names no places; columns x_m,y_m,z_m are expected");
    return true;
}

static bool read_number(struct reader *reader, const char *text, double *value)
{
    char *end;
    *value = strtod(text, &end);
    const bool whole = end != text && end[strspn(end, " \t")] == '\0';
    if (!whole || !(*value >= -FAR && *value <= FAR))
        return complain(reader, text,
                        "this is no number between -1e6 and 1e6; one is expected");
    return true;
}

static bool read_row(struct reader *reader, const struct job *job, char *line,
                     struct packing_sphere *sphere)
{
    char *cells[CELLS_MAX];
    if (split(line, cells) != reader->n_cells)
        return complain(
            reader, line,
            "this row has another number of cells than the header; as many are expected");
    double *const targets[N_COLUMNS] = {
        &sphere->position.x, &sphere->position.y, &sphere->position.z, &sphere->radius, NULL,
        &sphere->velocity.x, &sphere->velocity.y, &sphere->velocity.z};
    for (int c = 0; c < reader->n_cells; c++) {
        const int column = reader->column[c];
        if (column == COLUMN_MATERIAL) {
            sphere->material = -1;
            for (int m = 0; m < job->n_materials; m++)
                sphere->material =
                    strcmp(job->materials[m].name, cells[c]) == 0 ? m : sphere->material;
            if (sphere->material < 0)
                return complain(reader, cells[c],
                                "unknown material; one of the job's materials is expected");
        } else if (column >= 0 && !read_number(reader, cells[c], targets[column])) {
            return false;
        }
    }
    if (!(sphere->radius > 0.0))
        return complain(reader, line,
                        "the radius is not positive; a length above 0 is expected");
    return true;
}

static bool read_rows(struct packing *packing, const struct job *job, FILE *file,
                      struct reader *reader)
{
    const struct job_spheres *group = packing->group;
    int64_t capacity = 0;
    char line[LINE_MAX_SIZE];
    reader->start = line;
    while (fgets(line, sizeof line, file) != NULL) {
        reader->line++;
        if (reader->line == 1) {
            if (!read_header(reader, line))
                return false;
            continue;
        }
        if (line[strspn(line, " \t\r\n")] == '\0')
            continue;
        ARRAY_GROW(packing->rows, packing->n + 1, capacity);
        struct packing_sphere *sphere = &packing->rows[packing->n];
        *sphere = (struct packing_sphere){.velocity = group->velocity,
                                          .angular_velocity = group->spin,
                                          .radius = group->radius,
                                          .material = group->material};
        if (!read_row(reader, job, line, sphere))
            return false;
        packing->n++;
    }
    if (packing->n == 0)
        return complain(
            reader, line,
            "there are no spheres in it; a header and at least one row are expected");
    return true;
}

bool packing_open(struct packing *packing, const struct job *job, int group, char **why)
{
    *packing = (struct packing){.group = &job->spheres[group],
                                .seed = (uint64_t)job->seed,
                                .sizes_stream = random_stream(RANDOM_PACKING_SIZES, group)};
    *why = NULL;
    sizes_build(&packing->sizes, &packing->group->sizes, packing->group->radius);
    if (packing->group->packing != JOB_PACKING_CSV) {
        if (packing->group->packing == JOB_PACKING_LATTICE ||
            packing->group->packing == JOB_PACKING_HEXAGONAL)
            packing->n = packing->group->count;
        return true;
    }
    struct reader reader = {.path = packing->group->file, .why = why};
    FILE *file = fopen(reader.path, "r");
    if (file == NULL) {
        *why = array_format("%s: cannot be read (%s); a CSV file of spheres is expected",
                            reader.path, strerror(errno));
        packing_close(packing);
        return false;
    }
    const bool fine = read_rows(packing, job, file, &reader);
    fclose(file);
    if (!fine)
        packing_close(packing);
    return fine;
}

void packing_close(struct packing *packing)
{
    sizes_clear(&packing->sizes);
    free(packing->rows);
    packing->rows = NULL;
    packing->n = 0;
}

/* As many places as fit, with a hair's breadth for what 5.28 / 0.22 does not divide to. */
static int64_t places(double room)
{
    const int64_t n = (int64_t)(room + 1e-9);
    return n > 0 ? n : 1;
}

/* The k-th place of a cubic lattice, in spacings from the corner. */
static struct vec3 cubic_place(const struct job_spheres *group, int64_t k)
{
    const int64_t n = places(group->size[0] / group->spacing);
    const int64_t m = places(group->size[1] / group->spacing);
    const int64_t layer = k / (n * m), row = k / n % m, column = k % n;
    return (struct vec3){(double)column + 0.5, (double)row + 0.5, (double)layer + 0.5};
}

/* Of hexagonal close packing: every other row half a spacing along, every other layer over the
 * gaps of the one below. */
static struct vec3 hexagonal_place(const struct job_spheres *group, int64_t k)
{
    const double row_height = sqrt(3.0) / 2.0, layer_height = sqrt(6.0) / 3.0;
    const double along = group->size[0] / group->spacing;
    const double across = group->size[1] / group->spacing;
    const int64_t n = places(along - 0.5);
    const int64_t m = places((across - 1.0 - row_height / 3.0) / row_height + 1.0);
    const int64_t layer = k / (n * m), row = k / n % m, column = k % n;
    const double odd = (double)(layer % 2);
    return (struct vec3){(double)column + 0.5 * (double)((row + layer) % 2) + 0.5,
                         row_height * ((double)row + odd / 3.0) + 0.5,
                         layer_height * (double)layer + 0.5};
}

static struct packing_sphere lattice_sphere(const struct packing *packing, int64_t k)
{
    const struct job_spheres *group = packing->group;
    const struct vec3 steps = group->packing == JOB_PACKING_HEXAGONAL
                                  ? hexagonal_place(group, k)
                                  : cubic_place(group, k);
    return (struct packing_sphere){
        .position = vec3_axpy(group->corner, group->spacing, steps),
        .velocity = group->velocity,
        .angular_velocity = group->spin,
        .radius = sizes_draw(&packing->sizes, packing->seed, packing->sizes_stream, k),
        .material = group->material};
}

struct packing_sphere packing_get(const struct packing *packing, int64_t k)
{
    return packing->rows != NULL ? packing->rows[k] : lattice_sphere(packing, k);
}

double packing_greatest(const struct packing *packing)
{
    double most = packing->sizes.max;
    for (int64_t k = 0; packing->rows != NULL && k < packing->n; k++)
        most = packing->rows[k].radius > most ? packing->rows[k].radius : most;
    return most;
}
