/*
 * What a sphere does to facets that deform is shared out to their nodes.  Whatever the facet
 * and wherever the sphere presses on it, the shares of the spring's pressure have its resultant
 * and its moment, and those of friction and damping act where they should, (2.4).
 *
 * Four thousand facets anywhere in space, down to an angle of about a degree, with ten spheres
 * on each.
 */
#include <math.h>
#include <stdio.h>

#include "contact/facet_patch.h"
#include "physics/contact_patch.h"
#include "verify.h"

enum { FACETS = 1300, SPHERES = 10, FACES = 4 };

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
    mesh_build_skin(mesh, corners, vertices, 1, corners == 3 ? triangle : quad);
}

struct off {
    double resultant; /* over the force */
    double moment;    /* about the origin, over the force times the farthest node's distance */
    double place;     /* of friction's resultant, over that distance */
};

/* The same from the covered areas, face by face. */
static void sum_faces(const struct mesh *mesh, struct vec3 centre, double radius,
                      struct vec3 *force, struct vec3 *moment, struct vec3 *middle)
{
    double area = 0.0;
    *force = *moment = *middle = (struct vec3){0.0, 0.0, 0.0};
    for (int f = 0; f < mesh->n_faces; f++) {
        struct contact_patch at;
        if (!contact_patch_cut(mesh, f, centre, radius, &at))
            continue;
        const struct vec3 push = vec3_scale(at.area, mesh->face_normal[f]);
        *force = vec3_add(*force, push);
        *moment = vec3_add(*moment, vec3_cross(at.middle, push));
        *middle = vec3_axpy(*middle, at.area, at.middle);
        area += at.area;
    }
    *middle = vec3_scale(1.0 / area, *middle);
}

static void press(const struct body *body, struct facet_patch *patch, struct off *off)
{
    static const int near[FACES] = {0, 1, 2, 3};
    const struct mesh *mesh = &body->mesh;
    struct facet_contact group[FACES] = {{.feature = 0}};
    for (int f = 0; f < mesh->n_faces; f++)
        group[f].feature = f;
    const double radius = 0.05 + fabs(verify_random(&seed)), over = verify_random(&seed);
    struct vec3 centre =
        vec3_axpy(mesh->place[0], 0.5 * (1.0 + over), vec3_sub(mesh->place[2], mesh->place[0]));
    centre = vec3_axpy(centre, 0.9 * radius, mesh->face_normal[0]);
    facet_patch_search(patch, group, near, mesh->n_faces, body, centre, radius);
    if (patch->n_parts != 1)
        return;
    struct vec3 force, moment, middle;
    sum_faces(mesh, centre, radius, &force, &moment, &middle);
    const double size = vec3_norm(force);
    double farthest = 0.0;
    for (int k = 0; k < patch->n_corners; k++) {
        const struct facet_patch_corner *corner = &patch->corners[k];
        const struct vec3 place = mesh->place[corner->corner];
        force = vec3_sub(force, corner->pushed);
        moment = vec3_sub(moment, vec3_cross(place, corner->pushed));
        middle = vec3_axpy(middle, -corner->weight, place);
        farthest = fmax(farthest, vec3_norm(place));
    }
    off->resultant = fmax(off->resultant, vec3_norm(force) / size);
    off->moment = fmax(off->moment, vec3_norm(moment) / (size * farthest));
    off->place = fmax(off->place, vec3_norm(middle) / farthest);
}

static void compare(const char *name, int corners, double warp)
{
    static const char *const kinds[] = {"resultant of the pressure's shares, off by",
                                        "moment of the pressure's shares, off by",
                                        "place of friction's shares, off by"};
    static const char *const units[] = {"of the force", "of force and lever", "of the lever"};
    struct off off = {0};
    struct facet_patch patch = {0};
    for (int k = 0; k < FACETS; k++) {
        struct body body = {0};
        build_facet(&body.mesh, corners, warp);
        body.skin = body_skin_build(&body.mesh);
        for (int f = 0; f < SPHERES; f++)
            press(&body, &patch, &off);
        body_skin_free(body.skin);
        mesh_clear(&body.mesh);
    }
    facet_patch_clear(&patch);
    const double got[] = {off.resultant, off.moment, off.place};
    for (int k = 0; k < 3; k++) {
        char row[128];
        snprintf(row, sizeof row, "%s: %s", name, kinds[k]);
        verify_row(row, units[k], 0.0, got[k], 1e-13, VERIFY_AT_MOST,
                   "asked for; some roundings of 1.1e-16");
    }
}

int main(int argc, char **argv)
{
    verify_begin(argc, argv, "Pressure on facets, shared out to nodes", "statics, (2.4)");
    compare("triangles", 3, 0.0);
    compare("flat quads", 4, 0.0);
    compare("warped quads", 4, 1.0);
    return verify_end();
}
