/* See surface_file.h.  A file is held in memory as a whole, so that its checksum is that of
 * what was read. */
#include "store/surface_file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/array.h"
#include "base/comm.h"
#include "job/job.h"
#include "model/gmsh.h"
#include "model/stl.h"
#include "store/crc32.h"

enum { LARGEST = 1 << 30 }; /* bytes */

static const double FAR = 1e6; /* as in job files [m] */

bool surface_file_has(const struct job_body *body)
{
    if (body->model == JOB_MODEL_SOLID)
        return body->solid.kind == JOB_MESH_GMSH;
    return body->geometry == JOB_GEOMETRY_STL || body->geometry == JOB_GEOMETRY_GMSH;
}

/* All bytes of a file and a zero after them. */
static char *read_bytes(const char *path, char **bytes, size_t *n)
{
    struct stat about;
    *bytes = NULL;
    FILE *in = fopen(path, "rbe");
    if (in == NULL || fstat(fileno(in), &about) != 0) {
        char *why = array_format("%s: cannot be read (%s); a file with a surface is expected",
                                 path, strerror(errno));
        if (in != NULL)
            fclose(in);
        return why;
    }
    char *why = NULL;
    if (S_ISDIR(about.st_mode)) {
        why = array_format("%s: is a folder; a file with a surface is expected", path);
    } else if (about.st_size > LARGEST) {
        why = array_format("%s: is %.3g GB large; at most %.3g GB are expected", path,
                           (double)about.st_size * 1e-9, (double)LARGEST * 1e-9);
    } else {
        *bytes = array_allocate((size_t)about.st_size + 1, 1);
        *n = fread(*bytes, 1, (size_t)about.st_size, in);
        if (ferror(in))
            why = array_format("%s: cannot be read (%s); a file with a surface is expected",
                               path, strerror(errno));
    }
    fclose(in);
    return why;
}

/* The first vertex that is farther out than lengths in a job may be. */
static char *find_far(const struct job_body *body, int n, const struct vec3 *vertices)
{
    const double scale = body->scale > 0.0 ? body->scale : 1.0, most = FAR / scale;
    for (int v = 0; v < n; v++) {
        const struct vec3 x = vertices[v];
        if (!(x.x >= -most && x.x <= most && x.y >= -most && x.y <= most && x.z >= -most &&
              x.z <= most))
            return array_format("%s: vertex %d at (%.3g, %.3g, %.3g) with scale %.3g; "
                                "coordinates within %.0e m are expected",
                                body->file, v + 1, x.x, x.y, x.z, scale, FAR);
    }
    return NULL;
}

/* Takes a solid out of the bytes of its file. */
static char *take_solid(struct job_body *body, const char *bytes, size_t n)
{
    struct job_volume volume;
    char *why = NULL;
    if (gmsh_read_solid(&volume, body->file, bytes, n, &why))
        why = find_far(body, volume.n_nodes, volume.nodes);
    if (why != NULL) {
        job_volume_clear(&volume);
        return why;
    }
    job_volume_clear(&body->solid.volume);
    body->solid.volume = volume;
    return NULL;
}

/* The same with a surface. */
static char *take_surface(struct job_body *body, const char *bytes, size_t n)
{
    struct surface surface;
    char *why = NULL;
    const bool fine = body->geometry == JOB_GEOMETRY_STL
                          ? stl_read(&surface, body->file, bytes, n, &why)
                          : gmsh_read(&surface, body->file, bytes, n, body->group, &why);
    if (fine)
        why = find_far(body, surface.n_vertices, surface.vertices);
    if (why != NULL) {
        surface_clear(&surface);
        return why;
    }
    free(body->vertices);
    free(body->facets);
    body->n_vertices = surface.n_vertices;
    body->vertices = surface.vertices;
    body->n_facets = surface.n_facets;
    body->facets = surface.facets;
    return NULL;
}

char *surface_file_read(struct job_body *body)
{
    char *bytes;
    size_t n = 0;
    char *why = read_bytes(body->file, &bytes, &n);
    if (why == NULL)
        why = body->model == JOB_MODEL_SOLID ? take_solid(body, bytes, n)
                                             : take_surface(body, bytes, n);
    if (why == NULL) {
        struct crc32 crc;
        crc32_init(&crc);
        body->sum = (int64_t)crc32_of(&crc, bytes, n);
    }
    free(bytes);
    return why;
}

/* An array of n elements that rank 0 has; the others get memory for it. */
static void *share(const struct comm *comm, void *array, int n, size_t size)
{
    if (comm->rank != 0)
        array = array_allocate((size_t)n, size);
    comm_broadcast(comm, array, (size_t)n * size);
    return array;
}

static void share_volume(const struct comm *comm, struct job_volume *v)
{
    int n[4] = {v->n_nodes, v->n_elements, v->n_groups, v->n_items};
    comm_broadcast(comm, n, sizeof n);
    v->n_nodes = n[0];
    v->n_elements = n[1];
    v->n_groups = n[2];
    v->n_items = n[3];
    v->nodes = share(comm, v->nodes, n[0], sizeof *v->nodes);
    v->node_numbers = share(comm, v->node_numbers, n[0], sizeof *v->node_numbers);
    v->elements = share(comm, v->elements, n[1], sizeof *v->elements);
    v->element_numbers = share(comm, v->element_numbers, n[1], sizeof *v->element_numbers);
    v->groups = share(comm, v->groups, n[2], sizeof *v->groups);
    v->items = share(comm, v->items, n[3], sizeof *v->items);
}

void surface_file_share(struct job *job, const struct comm *comm)
{
    for (int b = 0; b < job->n_bodies; b++) {
        struct job_body *body = &job->bodies[b];
        if (!surface_file_has(body))
            continue;
        if (body->model == JOB_MODEL_SOLID) {
            share_volume(comm, &body->solid.volume);
            continue;
        }
        int n[2] = {body->n_vertices, body->n_facets};
        comm_broadcast(comm, n, sizeof n);
        body->n_vertices = n[0];
        body->n_facets = n[1];
        body->vertices = share(comm, body->vertices, n[0], sizeof *body->vertices);
        body->facets = share(comm, body->facets, n[1], sizeof *body->facets);
    }
}
