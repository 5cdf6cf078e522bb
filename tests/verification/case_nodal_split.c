/*
 * A force on a facet is shared out to the facet's nodes.  Whatever the facet and wherever on it
 * the force acts, the shares have its resultant and its moment, (2.3).
 *
 * Four thousand facets anywhere in space, down to an angle of about a degree, with ten forces
 * on each face, edge and vertex.  No scene is needed: the shares are asked for as elements
 * will.
 */
#include <math.h>
#include <stdio.h>

#include "model/mesh.h"
#include "physics/contact_geometry.h"
#include "verify.h"

enum { FACETS = 1300, FORCES = 10, KINDS = 3 };

static uint64_t seed = 5;

static struct vec3 random_vector(void)
{
    return (struct vec3){verify_random(&seed), verify_random(&seed), verify_random(&seed)};
}

/* A triangle (corners 3), or a quad that is flat or warped. */
static void build_facet(struct mesh *mesh, int corners, double warp)
{
    static const double x[4] = {0.0, 1.0, 1.0, 0.0}, y[4] = {0.0, 0.0, 1.0, 1.0};
    const struct vec3 origin = random_vector(), u = random_vector(),
                      normal = vec3_cross(u, random_vector()), v = vec3_cross(normal, u);
    const double thin = 0.51 + 0.49 * verify_random(&seed);
    struct vec3 vertices[4];
    for (int k = 0; k < 4; k++) {
        vertices[k] = vec3_axpy(origin, x[k] + 0.2 * verify_random(&seed), u);
        vertices[k] = vec3_axpy(vertices[k], thin * (y[k] + 0.2 * verify_random(&seed)), v);
        vertices[k] = vec3_axpy(vertices[k], 0.2 * warp * verify_random(&seed), normal);
    }
    const int quad[1][4] = {{0, 1, 2, 3}}, triangle[1][4] = {{0, 1, 2, -1}};
    mesh_build(mesh, 4, vertices, 1, corners == 3 ? triangle : quad);
}

/* Any weighted mean of a feature's vertices. */
static struct vec3 random_point(const struct mesh *mesh, int feature)
{
    const int edge = feature - mesh->n_faces, vertex = edge - mesh->n_edges;
    if (vertex >= 0)
        return mesh->place[vertex];
    const int n = edge >= 0 ? 2 : mesh->faces[feature].n;
    const int *vertices =
        edge >= 0 ? mesh->edges[edge].vertices : mesh->faces[feature].vertices;
    struct vec3 sum = {0.0, 0.0, 0.0};
    double total = 0.0;
    for (int k = 0; k < n; k++) {
        const double part = 0.5 + 0.5 * verify_random(&seed);
        sum = vec3_axpy(sum, part, mesh->place[vertices[k]]);
        total += part;
    }
    return vec3_scale(1.0 / total, sum);
}

struct off {
    double resultant; /* over the force */
    double moment;    /* about the origin, over the force times the farthest node's distance */
};

static void split(const struct mesh *mesh, int feature, struct off *off)
{
    const struct vec3 point = random_point(mesh, feature), force = random_vector();
    const struct contact_geometry_shares shares = contact_geometry_shares(mesh, feature, point);
    struct vec3 resultant = {0.0, 0.0, 0.0}, moment = {0.0, 0.0, 0.0};
    double farthest = 0.0;
    for (int j = 0; j < shares.n; j++) {
        const struct vec3 place = mesh->place[shares.vertices[j]],
                          share = vec3_scale(shares.parts[j], force);
        resultant = vec3_add(resultant, share);
        moment = vec3_add(moment, vec3_cross(place, share));
        farthest = fmax(farthest, vec3_norm(place));
    }
    const double size = vec3_norm(force);
    off->resultant = fmax(off->resultant, vec3_norm(vec3_sub(resultant, force)) / size);
    off->moment = fmax(off->moment, vec3_norm(vec3_sub(moment, vec3_cross(point, force))) /
                                        (size * farthest));
}

static void compare(const char *name, int corners, double warp)
{
    static const char *const kinds[KINDS] = {"face", "edges", "vertices"};
    struct off off[KINDS] = {{0.0, 0.0}};
    for (int k = 0; k < FACETS; k++) {
        struct mesh mesh;
        build_facet(&mesh, corners, warp);
        for (int feature = 0; feature < mesh_n_features(&mesh); feature++) {
            const int edge = feature - mesh.n_faces, vertex = edge - mesh.n_edges;
            for (int f = 0; f < FORCES; f++)
                split(&mesh, feature, &off[vertex >= 0 ? 2 : edge >= 0 ? 1 : 0]);
        }
        mesh_clear(&mesh);
    }
    for (int k = 0; k < KINDS; k++) {
        char row[128];
        snprintf(row, sizeof row, "%s, %s: resultant of the shares, off by", name, kinds[k]);
        verify_row(row, "of the force", 0.0, off[k].resultant, 1e-14, VERIFY_AT_MOST,
                   "asked for; some roundings of 1.1e-16");
        snprintf(row, sizeof row, "%s, %s: moment of the shares, off by", name, kinds[k]);
        verify_row(row, "of force and lever", 0.0, off[k].moment, 1e-14, VERIFY_AT_MOST,
                   "asked for; some roundings of 1.1e-16");
    }
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Forces on facets, shared out to nodes", "statics, (2.3)");
    compare("triangles", 3, 0.0);
    compare("flat quads", 4, 0.0);
    compare("warped quads", 4, 1.0);
    return verify_end();
}
