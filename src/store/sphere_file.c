/* See sphere_file.h.  Columns are read whole, one after the other. */
#include "store/sphere_file.h"

#include <stdlib.h>

#include "base/array.h"
#include "model/sphere.h"
#include "store/h5.h"

/* Places and speeds beyond this are beyond any use; as in job files [m], [m/s], [rad/s]. */
static const double FAR = 1e6;

/* Where a field of the table of state lies in a packing's sphere. */
static double *member(struct packing_sphere *sphere, enum sphere_field field)
{
    return field == SPHERE_POSITION   ? &sphere->position.x
           : field == SPHERE_VELOCITY ? &sphere->velocity.x
           : field == SPHERE_RADIUS   ? &sphere->radius
                                      : &sphere->angular_velocity.x;
}

/* Reads a column into all spheres; the first column tells how many there are. */
static void read_column(struct h5 *h5, enum sphere_field number, int64_t *n,
                        struct packing_sphere **rows, const struct packing_sphere *standard)
{
    const struct field *field = &sphere_fields[number];
    const size_t width = (size_t)field->width;
    char *path = array_format("/spheres/%s", field->name);
    const int64_t n_rows = h5_count_rows(h5, path, field);
    if (*rows == NULL) {
        *n = n_rows;
        *rows = array_allocate((size_t)n_rows, sizeof **rows);
        for (int64_t k = 0; k < n_rows; k++)
            (*rows)[k] = *standard;
    }
    if (n_rows != *n)
        h5_fail(h5, "%s has %lld rows, /spheres/position %lld", path, (long long)n_rows,
                (long long)*n);
    double *values = array_allocate((size_t)n_rows * width, sizeof *values);
    h5_read_rows(h5, path, field, 0, n_rows, values);
    for (int64_t k = 0; h5->why == NULL && k < n_rows; k++) {
        for (size_t c = 0; c < width; c++) {
            const double value = values[(size_t)k * width + c];
            member(&(*rows)[k], number)[c] = value;
            if (!(value >= -FAR && value <= FAR))
                h5_fail(h5, "%s: row %lld is no number between -1e6 and 1e6", path,
                        (long long)k);
        }
    }
    free(values);
    free(path);
}

char *sphere_file_read(const char *path, const struct packing_sphere *standard, int64_t *n,
                       struct packing_sphere **rows)
{
    static const enum sphere_field optional[] = {SPHERE_RADIUS, SPHERE_VELOCITY,
                                                 SPHERE_ANGULAR_VELOCITY};
    struct h5 h5;
    *n = 0;
    *rows = NULL;
    h5_open(&h5, path);
    read_column(&h5, SPHERE_POSITION, n, rows, standard);
    for (size_t f = 0; f < sizeof optional / sizeof *optional; f++) {
        char *column = array_format("/spheres/%s", sphere_fields[optional[f]].name);
        if (h5.why == NULL && h5_has(&h5, column))
            read_column(&h5, optional[f], n, rows, standard);
        free(column);
    }
    h5_close(&h5);
    if (h5.why == NULL && *n == 0)
        h5_fail(&h5, "there are no spheres in it");
    for (int64_t k = 0; h5.why == NULL && k < *n; k++)
        if (!((*rows)[k].radius > 0.0))
            h5_fail(&h5, "the radius of row %lld is not above 0, or there is none",
                    (long long)k);
    if (h5.why == NULL)
        return NULL;
    char *why = array_format(
        "%s: %s; an HDF5 file with /spheres/position and radius is expected", path, h5.why);
    free(h5.why);
    free(*rows);
    *rows = NULL;
    *n = 0;
    return why;
}
