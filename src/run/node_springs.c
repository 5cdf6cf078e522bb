/*
 * See node_springs.h.  A contact on a surface that deforms is taken to act on the face whose
 * entry holds its memory, below the middle of the ball; that of a ball also on the two nodes
 * between which it is.  Sums are exact, so what the watch says does not depend on who has which
 * contact.
 */
#include "run/node_springs.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "model/solid_ball.h"
#include "physics/critical_step.h"
#include "run/simulation.h"

struct entry {
    int node;
    double stiffness, damping;
};

struct entries {
    int n, capacity;
    struct entry *list;
};

static void add(struct entries *entries, int node, double part, double stiffness,
                double damping)
{
    if (!(part > 0.0))
        return;
    ARRAY_GROW(entries->list, entries->n + 1, entries->capacity);
    struct entry *entry = &entries->list[entries->n++];
    memset(entry, 0, sizeof *entry);
    entry->node = node;
    entry->stiffness = part * stiffness;
    entry->damping = part * damping;
}

/* Parts of a face's vertices in the foot of a point, or in what is near it on the face. */
static void parts_of(const struct mesh *mesh, int face, struct vec3 point, double parts[3])
{
    const struct mesh_border *border = mesh->face_borders[face];
    double sum = 0.0;
    for (int k = 0; k < 3; k++) {
        const int v = (k + 2) % 3;
        const double inside = vec3_dot(vec3_sub(point, border[k].from), border[k].inward);
        parts[v] = inside > 0.0 ? inside : 0.0;
        sum += parts[v];
    }
    for (int v = 0; v < 3; v++)
        parts[v] = sum > 0.0 ? parts[v] / sum : 1.0 / 3.0;
}

/* What the corners of the mesh have of a face's contact. */
struct share {
    int n, corners[12];
    double parts[12];
};

static struct share share_of(const struct mesh *mesh, int face, struct vec3 point)
{
    struct share share = {.n = 0};
    double parts[3];
    parts_of(mesh, face, point, parts);
    for (int k = 0; k < 3; k++) {
        const int v = mesh->faces[face].vertices[k];
        const bool is_mean = v >= mesh->n_corners;
        for (int m = 0; m < (is_mean ? 4 : 1); m++) {
            share.corners[share.n] = is_mean ? mesh->mean_of[v - mesh->n_corners][m] : v;
            share.parts[share.n++] = is_mean ? 0.25 * parts[k] : parts[k];
        }
    }
    return share;
}

/* The contacts of spheres or balls with the body, and, of balls, those of the body's own. */
static void add_contacts(struct entries *entries, const struct simulation *sim, int b,
                         const struct facet_contacts *contacts, const struct spheres *spheres,
                         const struct materials *materials, bool are_balls)
{
    const struct deform_body *deform = &sim->deform.list[b];
    const struct body *body = &sim->bodies.list[deform->body];
    for (int k = 0; k < contacts->n; k++) {
        const struct facet_contact *contact = &contacts->list[k];
        const double width = contact->history[CONTACT_RADIUS_LANE];
        const int i = contact->sphere;
        const bool meets = contact->body == deform->body;
        const int ball = are_balls ? sim->touch.owned[i] - deform->first_ball : -1;
        const bool is_own = ball >= 0 && ball < deform->n_balls;
        struct share share = {.n = 0};
        double yield = sphere_inverse_mass(spheres, i);
        if (!(width > 0.0) || !(meets || is_own))
            continue;
        if (meets) {
            body_renew_face(body, contact->feature);
            share = share_of(&body->mesh, contact->feature, sphere_place(spheres, i));
        }
        for (int m = 0; m < share.n; m++)
            yield +=
                share.parts[m] * share.parts[m] * body->skin->inverse_mass[share.corners[m]];
        const int wall = sim->bodies.list[contact->body].material;
        const struct critical_step_contact felt = critical_step_contact(
            &materials->pairs[spheres->material[i] * materials->n + wall], width, 1.0 / yield);
        const double stiffness = critical_step_stiffest(felt.stiffness),
                     damping = critical_step_stiffest(felt.damping);
        for (int m = 0; m < share.n; m++)
            add(entries, deform->skin.nodes[share.corners[m]], share.parts[m], stiffness,
                damping);
        if (is_own) {
            const struct solid_ball *at = &deform->balls[ball];
            if (sim->bodies.list[contact->body].rigid != NULL && sim->watch.loads != NULL) {
                /* The body yields as well, to all of its contacts together. (10.8) */
                const struct critical_step_sums *load = &sim->watch.loads[contact->body];
                const double mass = deform->solid.mass[at->outer];
                add(entries, at->outer, mass, load->stiffness, load->damping);
            }
            add(entries, at->outer, 1.0 - at->part, stiffness, damping);
            for (int m = 0; m < at->n_inner; m++)
                add(entries, at->inner[m], at->part / at->n_inner, stiffness, damping);
        }
    }
}

static int compare_entries(const void *a, const void *b)
{
    const struct entry *p = a, *q = b;
    return (p->node > q->node) - (p->node < q->node);
}

void node_springs_find(struct node_springs *springs, const struct simulation *sim, int deform)
{
    const size_t n = (size_t)sim->deform.list[deform].solid.n_nodes;
    struct entries own = {0};
    add_contacts(&own, sim, deform, &sim->facets, &sim->spheres, &sim->materials, false);
    if (sim->touch.n_balls > 0)
        add_contacts(&own, sim, deform, &sim->touch.contacts, &sim->touch.spheres,
                     &sim->touch.materials, true);
    struct entries all = {0};
    all.list = comm_gather_records(sim->comm, own.list, own.n, sizeof *own.list, &all.n);
    if (all.n > 1)
        qsort(all.list, (size_t)all.n, sizeof *all.list, compare_entries);
    *springs = (struct node_springs){array_allocate(n, sizeof *springs->stiffness),
                                     array_allocate(n, sizeof *springs->damping)};
    for (int k = 0, end; k < all.n; k = end) {
        struct exact_sum sums[2] = {{{0}, 0, 0}};
        for (end = k; end < all.n && all.list[end].node == all.list[k].node; end++) {
            exact_sum_add(&sums[0], all.list[end].stiffness);
            exact_sum_add(&sums[1], all.list[end].damping);
        }
        springs->stiffness[all.list[k].node] = exact_sum_value(&sums[0]);
        springs->damping[all.list[k].node] = exact_sum_value(&sums[1]);
    }
    free(own.list);
    free(all.list);
}

void node_springs_slow(const struct node_springs *springs, int n_nodes, int n)
{
    for (int i = 0; n > 1 && i < n_nodes; i++) {
        springs->stiffness[i] *= (double)n * n;
        springs->damping[i] *= n;
    }
}

void node_springs_touched(const struct simulation *sim, double *touched)
{
    const struct facet_contacts *lists[2] = {&sim->facets, &sim->touch.contacts};
    memset(touched, 0, (size_t)sim->deform.n * sizeof *touched);
    for (int l = 0; l < (sim->touch.n_balls > 0 ? 2 : 1); l++)
        for (int k = 0; k < lists[l]->n; k++) {
            const struct facet_contact *contact = &lists[l]->list[k];
            const int ball = l == 1 ? sim->touch.owned[contact->sphere] : -1;
            for (int b = 0; facet_contact_touched(contact) && b < sim->deform.n; b++) {
                const struct deform_body *deform = &sim->deform.list[b];
                const int own = ball - deform->first_ball;
                if (contact->body == deform->body ||
                    (ball >= 0 && own >= 0 && own < deform->n_balls))
                    touched[b] = 1.0;
            }
        }
}

void node_springs_clear(struct node_springs *springs)
{
    free(springs->stiffness);
    free(springs->damping);
    *springs = (struct node_springs){0};
}
