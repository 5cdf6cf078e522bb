/* What a ball covers of a surface that deforms: see facet_patch.h. */
#include "contact/facet_patch.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "physics/contact_patch.h"

/* A face that is covered. */
struct facet_patch_cut {
    int entry, face;
    struct contact_patch at;
};

void facet_patch_clear(struct facet_patch *patch)
{
    free(patch->parts);
    free(patch->corners);
    free(patch->ended);
    free(patch->cuts);
    free(patch->slots);
    *patch = (struct facet_patch){0};
}

/* The part that a smooth part of the surface is; what is new ends the list. */
static struct facet_patch_part *part_of(struct facet_patch *patch, int smooth)
{
    int p = 0;
    while (p < patch->n_parts && patch->parts[p].smooth != smooth)
        p++;
    if (p == patch->n_parts) {
        ARRAY_GROW(patch->parts, p + 1, patch->part_capacity);
        patch->parts[p] = (struct facet_patch_part){.smooth = smooth, .entry = -1};
        patch->n_parts++;
    }
    return &patch->parts[p];
}

/* The faces that are covered, and the parts that they make up; returns their volume [m3]. */
static double cut_faces(struct facet_patch *patch, const struct facet_contact *group,
                        const int *near, int n, const struct body *body, struct vec3 centre,
                        double radius)
{
    double volume = 0.0;
    patch->n_cuts = patch->n_parts = 0;
    for (int m = 0; m < n; m++) {
        struct facet_patch_cut cut = {.entry = near[m], .face = group[near[m]].feature};
        body_renew_face(body, cut.face);
        if (!contact_patch_cut(&body->mesh, cut.face, centre, radius, &cut.at))
            continue;
        struct facet_patch_part *part = part_of(patch, body->skin->smooth[cut.face]);
        const struct vec3 normal = body->mesh.face_normal[cut.face];
        part->area += cut.at.area;
        part->facing = vec3_axpy(part->facing, cut.at.area, normal);
        if (part->entry < 0 || (facet_contact_touched(&group[cut.entry]) &&
                                !facet_contact_touched(&group[part->entry])))
            part->entry = cut.entry;
        ARRAY_GROW(patch->cuts, patch->n_cuts + 1, patch->cut_capacity);
        patch->cuts[patch->n_cuts++] = cut;
        volume += cut.at.volume;
    }
    return volume;
}

double facet_patch_reach(const struct mesh *mesh, int face, struct vec3 centre, double radius)
{
    const struct mesh_border *border = mesh->face_borders[face];
    const double height = vec3_dot(vec3_sub(centre, border[0].from), mesh->face_normal[face]);
    if (!(height > 0.0 && height < radius))
        return 0.0;
    for (int k = 0; k < 3; k++)
        if (vec3_dot(vec3_sub(centre, border[k].from), border[k].inward) < 0.0)
            return 0.0;
    return radius - height;
}

/* Cosine of 120 degrees: faces that look so far apart are two sides of a body. */
static const double OPPOSITE = -0.5;

/* A ball that covers a face from behind has come out there if it also covers one opposite to it
 * from before. */
static double find_through(const struct facet_patch *patch, const struct mesh *mesh,
                           struct vec3 centre, double radius)
{
    double most = 0.0;
    for (int b = 0; b < patch->n_cuts; b++) {
        const struct vec3 behind = mesh->face_normal[patch->cuts[b].face];
        for (int c = 0; patch->cuts[b].at.volume < 0.0 && c < patch->n_cuts; c++) {
            const int face = patch->cuts[c].face;
            const double reach = facet_patch_reach(mesh, face, centre, radius);
            if (reach > most && vec3_dot(behind, mesh->face_normal[face]) < OPPOSITE)
                most = reach;
        }
    }
    return most;
}

static void add_corner(struct facet_patch *patch, const struct facet_patch_part *part,
                       int corner, double weight, struct vec3 normal)
{
    int *slot = &patch->slots[corner];
    if (*slot < 0) {
        *slot = patch->n_corners++;
        ARRAY_GROW(patch->corners, patch->n_corners, patch->corner_capacity);
        patch->corners[*slot] = (struct facet_patch_corner){.corner = corner};
    }
    patch->corners[*slot].weight += weight / part->area;
    patch->corners[*slot].pushed = vec3_axpy(patch->corners[*slot].pushed, weight, normal);
}

/* Gives the part's corners what they have of its faces; a mean point of a quad passes it on. */
static void share_out(struct facet_patch *patch, struct facet_patch_part *part,
                      const struct body *body)
{
    const struct mesh *mesh = &body->mesh;
    part->begin = patch->n_corners;
    for (int c = 0; c < patch->n_cuts; c++) {
        const struct facet_patch_cut *cut = &patch->cuts[c];
        const struct vec3 normal = mesh->face_normal[cut->face];
        if (body->skin->smooth[cut->face] != part->smooth)
            continue;
        for (int k = 0; k < 3; k++) {
            const int v = mesh->faces[cut->face].vertices[k];
            if (v < mesh->n_corners) {
                add_corner(patch, part, v, cut->at.weights[k], normal);
                continue;
            }
            for (int m = 0; m < 4; m++)
                add_corner(patch, part, mesh->mean_of[v - mesh->n_corners][m],
                           0.25 * cut->at.weights[k], normal);
        }
    }
    part->end = patch->n_corners;
    for (int k = part->begin; k < part->end; k++)
        patch->slots[patch->corners[k].corner] = -1;
}

/* What a part remembers goes to the entry that holds it now; parts that are not covered any
 * more end. */
static void hand_over(struct facet_patch *patch, struct facet_contact *group, const int *near,
                      int n, const struct body_skin *skin)
{
    patch->n_ended = 0;
    for (int m = 0; m < n; m++) {
        struct facet_contact *old = &group[near[m]];
        int p = 0;
        if (!facet_contact_touched(old))
            continue;
        while (p < patch->n_parts && patch->parts[p].smooth != skin->smooth[old->feature])
            p++;
        if (p == patch->n_parts) {
            ARRAY_GROW(patch->ended, patch->n_ended + 1, patch->ended_capacity);
            patch->ended[patch->n_ended++] = near[m];
        } else if (patch->parts[p].entry != near[m]) {
            memcpy(group[patch->parts[p].entry].history, old->history, sizeof old->history);
            memset(old->history, 0, sizeof old->history);
        }
    }
}

static void reserve_slots(struct facet_patch *patch, int n_corners)
{
    const int had = patch->slot_capacity;
    ARRAY_GROW(patch->slots, n_corners, patch->slot_capacity);
    for (int c = had; c < patch->slot_capacity; c++)
        patch->slots[c] = -1;
}

static void take_cuts(struct facet_patch *patch, const struct body *body, double volume,
                      double radius)
{
    reserve_slots(patch, body->mesh.n_corners);
    patch->n_corners = 0;
    if (volume > 0.0)
        patch->depth = contact_patch_depth(volume, radius);
    else
        patch->n_parts = 0;
    for (int p = 0; p < patch->n_parts; p++)
        share_out(patch, &patch->parts[p], body);
}

void facet_patch_search(struct facet_patch *patch, struct facet_contact *group, const int *near,
                        int n, const struct body *body, struct vec3 centre, double radius)
{
    const double volume = cut_faces(patch, group, near, n, body, centre, radius);
    patch->through = find_through(patch, &body->mesh, centre, radius);
    patch->is_circle = patch->n_cuts == 1 && patch->cuts->at.is_circle;
    take_cuts(patch, body, volume, radius);
    hand_over(patch, group, near, n, body->skin);
}

void facet_patch_whole(struct facet_patch *patch, const struct body *body, int face)
{
    const struct mesh *mesh = &body->mesh;
    const double third = 1.0 / 3.0;
    patch->n_cuts = patch->n_corners = patch->n_parts = 0;
    reserve_slots(patch, mesh->n_corners);
    ARRAY_GROW(patch->cuts, 1, patch->cut_capacity);
    patch->cuts[patch->n_cuts++] =
        (struct facet_patch_cut){.face = face, .at = {.weights = {third, third, third}}};
    struct facet_patch_part *part = part_of(patch, body->skin->smooth[face]);
    part->area = 1.0;
    part->facing = mesh->face_normal[face];
    share_out(patch, part, body);
}
