/*
 * See solid.h.  Elements are computed part by part of some hundred, in each in lists by shape
 * and material.  A part's forces are added to its nodes in ascending order of elements while
 * they are in the cache, before the next part is computed; so a node's sum is in that order
 * too, and forces of elements are never kept.
 */
#include "solid/solid.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"

const struct field solid_node_fields[SOLID_NODE_N_FIELDS] = {
    [SOLID_NODE_POSITION] = {"position", "m", "place at this step", FIELD_DOUBLE, 3,
                             FIELD_GHOST | FIELD_MOTION | FIELD_SAVED | FIELD_PLOTTED},
    [SOLID_NODE_VELOCITY] = {"velocity", "m/s", "velocity half a step earlier", FIELD_DOUBLE, 3,
                             FIELD_GHOST | FIELD_MOTION | FIELD_SAVED | FIELD_PLOTTED},
    [SOLID_NODE_WORK] =
        {"work", "J",
         "done up to the middle of the last step: taken up by elements; done by "
         "loads, contacts, gravity, supports; taken by mass-proportional "
         "damping",
         FIELD_DOUBLE, SOLID_N_WORKS, FIELD_SAVED},
    [SOLID_NODE_SPIN] = {"angular_velocity", "rad/s", "half a step earlier, of nodes of shells",
                         FIELD_DOUBLE, 3, FIELD_GHOST | FIELD_MOTION | FIELD_SAVED},
};

const struct field solid_element_fields[SOLID_ELEMENT_N_FIELDS] = {
    [SOLID_ELEMENT_STRESS] = {"stress", "Pa", "Cauchy's, xx yy zz xy yz zx, a step earlier",
                              FIELD_DOUBLE, 6, FIELD_GHOST | FIELD_SAVED | FIELD_PLOTTED},
    [SOLID_ELEMENT_PLASTIC_STRAIN] = {"plastic_strain", "1", "equivalent plastic strain",
                                      FIELD_DOUBLE, 1,
                                      FIELD_GHOST | FIELD_SAVED | FIELD_PLOTTED},
    [SOLID_ELEMENT_PLASTIC_WORK] = {"plastic_work", "J",
                                    "turned into heat by plastic flow since the start",
                                    FIELD_DOUBLE, 1, FIELD_GHOST | FIELD_SAVED},
    [SOLID_ELEMENT_HOURGLASS] = {"hourglass", "N", "forces of the four hourglass modes",
                                 FIELD_DOUBLE, 12, FIELD_GHOST | FIELD_SAVED},
    [SOLID_ELEMENT_HOURGLASS_WORK] = {"hourglass_work", "J",
                                      "taken up by hourglass stiffness since the start",
                                      FIELD_DOUBLE, 1,
                                      FIELD_GHOST | FIELD_SAVED | FIELD_PLOTTED},
    [SOLID_ELEMENT_HOURGLASS_DAMPED] = {"hourglass_damped", "J",
                                        "turned into heat by hourglass viscosity since the "
                                        "start",
                                        FIELD_DOUBLE, 1, FIELD_GHOST | FIELD_SAVED},
    [SOLID_ELEMENT_DAMPED] = {"damped", "J",
                              "turned into heat by stiffness-proportional damping since the "
                              "start",
                              FIELD_DOUBLE, 1, FIELD_GHOST | FIELD_SAVED},
    [SOLID_ELEMENT_ALIVE] = {"alive", "1", "1: it resists; 0: it has failed", FIELD_INT32, 1,
                             FIELD_GHOST | FIELD_SAVED | FIELD_PLOTTED},
    [SOLID_ELEMENT_LAYERS] = {"layers", "Pa",
                              "stress xx yy xy in the element's frame and plastic strain of "
                              "each of five layers, a step earlier",
                              FIELD_DOUBLE, 4 * SHELL_ELEMENT_LAYERS,
                              FIELD_GHOST | FIELD_SAVED},
    [SOLID_ELEMENT_SHEAR] = {"shear", "Pa", "mean stress xz yz in the element's frame",
                             FIELD_DOUBLE, 2, FIELD_GHOST | FIELD_SAVED},
    [SOLID_ELEMENT_THICKNESS] = {"thickness", "m", "now", FIELD_DOUBLE, 1,
                                 FIELD_GHOST | FIELD_SAVED | FIELD_PLOTTED},
};

/* Corners of the element that pads: about a cube, of which the first four are a tetrahedron. */
static const double PADDING[SOLID_ELEMENT_CORNERS][3] = {
    {0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {1.0, 1.0, 0.0}, {0.0, 1.0, 0.5},
    {0.0, 0.0, 1.0}, {1.0, 0.0, 1.0}, {1.0, 1.0, 1.0}, {0.0, 1.0, 1.0}};

/* ------------------------------------------------------------------------------- building */

static struct solid_element_material build_material(const struct solid_material *from)
{
    struct solid_element_material material = {.density = from->density,
                                              .damping = from->damping,
                                              .hourglass_stiffness = from->hourglass_stiffness,
                                              .hourglass_viscosity = from->hourglass_viscosity,
                                              .n_yield = from->n_yield};
    solid_element_elastic(&material, from->young, from->poisson);
    if (from->n_yield == 0)
        return material;
    CHECK(from->yield[0].strain == 0.0, "a yield curve begins at a plastic strain of %g",
          from->yield[0].strain);
    struct solid_element_yield *pieces = array_allocate((size_t)from->n_yield, sizeof *pieces);
    for (int k = 0; k < from->n_yield; k++) {
        const struct solid_yield_point *a = &from->yield[k], *b = a + 1;
        const double slope = k + 1 < from->n_yield
                                 ? (b->stress - a->stress) / (b->strain - a->strain)
                                 : from->hardening;
        pieces[k] = (struct solid_element_yield){a->strain, a->stress, slope,
                                                 1.0 / (3.0 * material.mu + slope)};
    }
    material.yield = pieces;
    return material;
}

static void build_nodes(struct solid *solid, const struct solid_parts *mesh)
{
    const size_t n = (size_t)mesh->n_nodes;
    solid->n_nodes = mesh->n_nodes;
    solid->reference = array_allocate(n, sizeof *solid->reference);
    solid->node = array_allocate_sparse(n + SOLID_ELEMENT_CORNERS, sizeof *solid->node);
    solid->mass = array_allocate(n, sizeof *solid->mass);
    solid->internal = array_allocate(n, sizeof *solid->internal);
    solid->external = array_allocate(n, sizeof *solid->external);
    solid->contact = array_allocate(n, sizeof *solid->contact);
    solid->work = array_allocate(n, sizeof *solid->work);
    solid->moves = array_allocate(n, sizeof *solid->moves);
    memcpy(solid->reference, mesh->places, n * sizeof *solid->reference);
    for (size_t i = 0; i < n; i++)
        memcpy(solid->node[i].lane, mesh->places[i], sizeof mesh->places[i]);
    for (size_t c = 0; c < SOLID_ELEMENT_CORNERS; c++)
        memcpy(solid->node[n + c].lane, PADDING[c], sizeof PADDING[c]);
}

static void build_elements(struct solid *solid, const struct solid_parts *mesh)
{
    const size_t n = (size_t)mesh->n_elements, padded = n + 1;
    solid->n_elements = mesh->n_elements;
    solid->shape = array_allocate(n, sizeof *solid->shape);
    solid->corners = array_allocate(padded, sizeof *solid->corners);
    solid->material = array_allocate(n, sizeof *solid->material);
    solid->alive = array_allocate(n, sizeof *solid->alive);
    solid->element_mass = array_allocate(padded, sizeof *solid->element_mass);
    solid->state = array_allocate_sparse(padded, sizeof *solid->state);
    solid->slot = array_allocate(n, sizeof *solid->slot);
    memcpy(solid->shape, mesh->shapes, n * sizeof *solid->shape);
    memcpy(solid->corners, mesh->corners, n * sizeof *solid->corners);
    if (mesh->materials != NULL)
        memcpy(solid->material, mesh->materials, n * sizeof *solid->material);
    for (int c = 0; c < SOLID_ELEMENT_CORNERS; c++)
        solid->corners[n][c] = solid->n_nodes + c;
    solid->element_mass[n] = 1.0;
}

static void build_shells(struct solid *solid, const struct solid_parts *mesh)
{
    const size_t n = (size_t)mesh->n_elements;
    bool turn = false;
    for (int e = 0; e < solid->n_elements; e++)
        turn |= shell_element_turns(solid->shape[e]);
    if (mesh->thickness == NULL)
        return;
    solid->layers = mesh->layers;
    solid->shell = array_allocate_rows(n + 1, sizeof *solid->shell);
    for (size_t e = 0; e < n; e++)
        if (shell_element_is(solid->shape[e])) {
            CHECK(mesh->thickness[e] > 0.0, "element %zu is %g m thick", e, mesh->thickness[e]);
            solid->shell[e] =
                shell_element_begin(mesh->thickness[e], &solid->materials[solid->material[e]]);
        }
    solid->shell[n] = shell_element_begin(1.0, &solid->materials[0]);
    CHECK(!turn || (solid->layers >= 1 && solid->layers <= SHELL_ELEMENT_LAYERS),
          "a shell of %d layers", solid->layers);
    if (turn)
        solid_turns_init(&solid->turns, solid->n_nodes);
}

/* [m3]; not of shells and membranes that have failed */
static double volume_of(const struct solid *solid, int element, double x[][3])
{
    const enum solid_element_shape shape = solid->shape[element];
    if (!shell_element_is(shape))
        return solid_element_volume(shape, x);
    CHECK(solid->shell != NULL, "element %d has no thickness", element);
    return shell_element_area(shape, x) * solid->shell[element].thickness;
}

/* Shares of mass are added in ascending order of elements. */
static void build_mass(struct solid *solid)
{
    for (int e = 0; e < solid->n_elements; e++) {
        double x[SOLID_ELEMENT_CORNERS][3];
        const int n = solid_corner_places(solid, e, x);
        CHECK(solid->material[e] >= 0 && solid->material[e] < solid->n_materials,
              "element %d is of the material %d", e, solid->material[e]);
        solid->alive[e] = 1;
        solid->element_mass[e] =
            solid->materials[solid->material[e]].density * volume_of(solid, e, x);
        for (int c = 0; c < n; c++)
            solid->mass[solid->corners[e][c]] += solid->element_mass[e] / n;
        if (shell_element_turns(solid->shape[e])) {
            const double inertia =
                shell_element_inertia(solid->shape[e], x, solid->shell[e].thickness);
            for (int c = 0; c < n; c++)
                solid->turns.inertia[solid->corners[e][c]] +=
                    solid->element_mass[e] / n * inertia;
        }
    }
}

/* Which corners meet at each node, by counting. */
static void build_meets(struct solid *solid)
{
    int *next = array_allocate((size_t)solid->n_nodes + 1, sizeof *next);
    solid->first = array_allocate((size_t)solid->n_nodes + 1, sizeof *solid->first);
    for (int e = 0; e < solid->n_elements; e++)
        for (int c = 0; c < solid_element_corners(solid->shape[e]); c++)
            solid->first[solid->corners[e][c] + 1]++;
    for (int i = 0; i < solid->n_nodes; i++)
        next[i + 1] = solid->first[i + 1] += solid->first[i];
    solid->meets = array_allocate((size_t)solid->first[solid->n_nodes], sizeof *solid->meets);
    for (int e = 0; e < solid->n_elements; e++)
        for (int c = 0; c < solid_element_corners(solid->shape[e]); c++)
            solid->meets[next[solid->corners[e][c]]++] = e * SOLID_ELEMENT_CORNERS + c;
    free(next);
}

void solid_create(struct solid *solid, const struct solid_parts *mesh, int n_materials,
                  const struct solid_material *materials, enum isa isa)
{
    *solid = (struct solid){.n_materials = n_materials, .kernel = solid_element_choose(isa)};
    solid->materials = array_allocate((size_t)n_materials, sizeof *solid->materials);
    for (int m = 0; m < n_materials; m++)
        solid->materials[m] = build_material(&materials[m]);
    build_nodes(solid, mesh);
    build_elements(solid, mesh);
    build_shells(solid, mesh);
    build_mass(solid);
    build_meets(solid);
    solid_supports_init(&solid->supports, solid->n_nodes);
    if (solid->turns.n_nodes > 0)
        solid_supports_init_turns(&solid->supports);
    solid_assign(solid, NULL);
}

void solid_destroy(struct solid *solid)
{
    for (int m = 0; m < solid->n_materials; m++)
        free(solid->materials[m].yield);
    solid_supports_clear(&solid->supports);
    solid_loads_clear(&solid->loads);
    solid_turns_clear(&solid->turns);
    free(solid->reference);
    free(solid->node);
    free(solid->mass);
    free(solid->internal);
    free(solid->external);
    free(solid->contact);
    free(solid->work);
    free(solid->moves);
    free(solid->shape);
    free(solid->corners);
    free(solid->material);
    free(solid->alive);
    free(solid->element_mass);
    free(solid->state);
    free(solid->shell);
    free(solid->first);
    free(solid->meets);
    free(solid->materials);
    free(solid->lists);
    free(solid->listed);
    free(solid->here);
    free(solid->slot);
    free(solid->force);
    *solid = (struct solid){0};
}

struct field_view solid_node_view(const struct solid *solid, enum solid_node_field field)
{
    switch (field) {
    case SOLID_NODE_POSITION:
        return (struct field_view){(unsigned char *)solid->node, sizeof *solid->node};
    case SOLID_NODE_VELOCITY:
        return (struct field_view){(unsigned char *)(solid->node->lane + 4),
                                   sizeof *solid->node};
    case SOLID_NODE_WORK:
        return (struct field_view){(unsigned char *)solid->work, sizeof *solid->work};
    case SOLID_NODE_SPIN:
        return (struct field_view){(unsigned char *)solid->turns.spin,
                                   sizeof *solid->turns.spin};
    case SOLID_NODE_N_FIELDS:
    default:
        CHECK(false, "there is no field %d", (int)field);
        return (struct field_view){NULL, 0};
    }
}

struct field_view solid_element_view(const struct solid *solid, enum solid_element_field field)
{
#define VIEW(member)                                                                           \
    ((struct field_view){(unsigned char *)solid->state +                                       \
                             offsetof(struct solid_element_state, member),                     \
                         sizeof *solid->state})
#define SHEET(member)                                                                          \
    ((struct field_view){solid->shell == NULL                                                  \
                             ? NULL                                                            \
                             : (unsigned char *)solid->shell +                                 \
                                   offsetof(struct shell_element_state, member),               \
                         sizeof *solid->shell})
    switch (field) {
    case SOLID_ELEMENT_STRESS:
        return VIEW(stress);
    case SOLID_ELEMENT_PLASTIC_STRAIN:
        return VIEW(plastic_strain);
    case SOLID_ELEMENT_PLASTIC_WORK:
        return VIEW(plastic_work);
    case SOLID_ELEMENT_HOURGLASS:
        return VIEW(hourglass);
    case SOLID_ELEMENT_HOURGLASS_WORK:
        return VIEW(hourglass_work);
    case SOLID_ELEMENT_HOURGLASS_DAMPED:
        return VIEW(hourglass_damped);
    case SOLID_ELEMENT_DAMPED:
        return VIEW(damped);
    case SOLID_ELEMENT_ALIVE:
        return (struct field_view){(unsigned char *)solid->alive, sizeof *solid->alive};
    case SOLID_ELEMENT_LAYERS:
        return SHEET(layer);
    case SOLID_ELEMENT_SHEAR:
        return SHEET(shear);
    case SOLID_ELEMENT_THICKNESS:
        return SHEET(thickness);
    case SOLID_ELEMENT_N_FIELDS:
    default:
        CHECK(false, "there is no field %d", (int)field);
        return (struct field_view){NULL, 0};
    }
#undef VIEW
#undef SHEET
}

double solid_mises(const struct solid *solid, int element)
{
    const enum solid_element_shape shape = solid->shape[element];
    return shell_element_is(shape)
               ? shell_element_mises(&solid->shell[element], shape, solid->layers)
               : solid_element_mises(&solid->state[element]);
}

int solid_corner_places(const struct solid *solid, int element,
                        double x[SOLID_ELEMENT_CORNERS][3])
{
    const int n = solid_element_corners(solid->shape[element]);
    for (int c = 0; c < n; c++)
        memcpy(x[c], solid_place(solid, solid->corners[element][c]), sizeof x[c]);
    return n;
}

/* ------------------------------------------------------------------- who computes */

static bool has_moved_corner(const struct solid *solid, int element)
{
    for (int c = 0; c < solid_element_corners(solid->shape[element]); c++)
        if (solid->moves[solid->corners[element][c]])
            return true;
    return false;
}

/* Elements of one shape and material from `begin` to `end`, if any are computed here. */
static void list_part(struct solid *solid, int part, enum solid_element_shape shape,
                      int material, int *n_slots)
{
    const int begin = part * SOLID_PART, end = begin + SOLID_PART;
    struct solid_list list = {part, shape, material, solid->n_listed, 0};
    for (int e = begin; e < end && e < solid->n_elements; e++) {
        if (solid->shape[e] != shape || solid->material[e] != material || !solid->alive[e] ||
            !has_moved_corner(solid, e))
            continue;
        solid->slot[e] = *n_slots + list.n++;
        ARRAY_GROW(solid->listed, solid->n_listed + 1, solid->listed_capacity);
        solid->listed[solid->n_listed++] = e;
    }
    if (list.n == 0)
        return;
    for (; list.n % SOLID_ELEMENT_PAD != 0; list.n++) {
        ARRAY_GROW(solid->listed, solid->n_listed + 1, solid->listed_capacity);
        solid->listed[solid->n_listed++] = solid->n_elements;
    }
    *n_slots += list.n;
    ARRAY_GROW(solid->lists, solid->n_lists + 1, solid->lists_capacity);
    solid->lists[solid->n_lists++] = list;
}

static int n_parts(const struct solid *solid)
{
    return (solid->n_elements + SOLID_PART - 1) / SOLID_PART;
}

static void list_nodes(struct solid *solid)
{
    bool *is_here = array_allocate((size_t)solid->n_nodes, sizeof *is_here);
    memcpy(is_here, solid->moves, (size_t)solid->n_nodes * sizeof *is_here);
    for (int e = 0; e < solid->n_elements; e++)
        for (int c = 0; solid->slot[e] >= 0 && c < solid_element_corners(solid->shape[e]); c++)
            is_here[solid->corners[e][c]] = true;
    solid->n_here = 0;
    for (int i = 0; i < solid->n_nodes; i++) {
        if (!is_here[i])
            continue;
        ARRAY_GROW(solid->here, solid->n_here + 1, solid->here_capacity);
        solid->here[solid->n_here++] = i;
    }
    free(is_here);
}

void solid_assign(struct solid *solid, const bool *moves)
{
    int slots_most = 0;
    for (int i = 0; i < solid->n_nodes; i++)
        solid->moves[i] = moves == NULL || moves[i];
    for (int e = 0; e < solid->n_elements; e++)
        solid->slot[e] = -1;
    solid->n_lists = solid->n_listed = 0;
    for (int part = 0; part < n_parts(solid); part++) {
        int n_slots = 0;
        for (int material = 0; material < solid->n_materials; material++)
            for (int shape = 0; shape < SOLID_ELEMENT_N_SHAPES; shape++)
                list_part(solid, part, (enum solid_element_shape)shape, material, &n_slots);
        slots_most = n_slots > slots_most ? n_slots : slots_most;
    }
    list_nodes(solid);
    if (slots_most > solid->force_capacity) {
        free(solid->force);
        solid->force = array_allocate_rows((size_t)slots_most, sizeof *solid->force);
        solid->force_capacity = slots_most;
    }
}

void solid_forget(struct solid *solid, const bool *keep)
{
    const size_t n_nodes = (size_t)solid->n_nodes, n_elements = (size_t)solid->n_elements;
    bool *here = array_allocate(n_nodes + n_elements, sizeof *here), *elements = here + n_nodes;
    memcpy(here, keep, n_nodes * sizeof *here);
    for (int k = 0; k < solid->n_here; k++)
        here[solid->here[k]] = true;
    for (int e = 0; e < solid->n_elements; e++)
        elements[e] = has_moved_corner(solid, e); /* of failed ones too: what they took up */
    array_forget(solid->node, n_nodes, sizeof *solid->node, here);
    array_forget(solid->internal, n_nodes, sizeof *solid->internal, here);
    array_forget(solid->external, n_nodes, sizeof *solid->external, here);
    array_forget(solid->contact, n_nodes, sizeof *solid->contact, here);
    array_forget(solid->work, n_nodes, sizeof *solid->work, here);
    array_forget(solid->state, n_elements, sizeof *solid->state, elements);
    free(here);
}

void solid_kill(struct solid *solid, int element)
{
    solid->alive[element] = 0;
    memset(solid->state[element].stress, 0, sizeof solid->state[element].stress);
    memset(solid->state[element].hourglass, 0, sizeof solid->state[element].hourglass);
    if (shell_element_is(solid->shape[element])) {
        struct shell_element_state *shell = &solid->shell[element];
        memset(shell->layer, 0, sizeof shell->layer);
        memset(shell->shear, 0, sizeof shell->shear);
    }
}

void solid_add_mass(struct solid *solid, int node, double mass, double inertia)
{
    solid->mass[node] += mass;
    if (solid->turns.n_nodes > 0 && solid->turns.inertia[node] > 0.0)
        solid->turns.inertia[node] += inertia;
}

bool solid_counts(const struct solid *solid, int element)
{
    return solid->moves[solid->corners[element][0]];
}

/* ------------------------------------------------------------------------------- the step */

static void add_shell(struct solid *solid, int e, int n,
                      const struct solid_element_force *force)
{
    for (int c = 0; c < n; c++) {
        const int i = solid->corners[e][c];
#pragma GCC unroll 3
        for (int d = 0; d < 3; d++) {
            solid->internal[i][d] -= force->corner[2 * c][d];
            solid->turns.internal[i][d] -= force->corner[2 * c + 1][d];
        }
    }
}

/* Adds what the elements of a part do to their nodes, in ascending order of elements. */
static void add_part(struct solid *solid, int part)
{
    const int begin = part * SOLID_PART, end = begin + SOLID_PART;
    for (int e = begin; e < end && e < solid->n_elements; e++) {
        if (solid->slot[e] < 0)
            continue;
        const struct solid_element_force *force = &solid->force[solid->slot[e]];
        const int n = solid_element_corners(solid->shape[e]);
        if (solid->turns.n_nodes > 0 && shell_element_turns(solid->shape[e])) {
            add_shell(solid, e, n, force);
            continue;
        }
        for (int c = 0; c < n; c++) {
            double *sum = solid->internal[solid->corners[e][c]];
            for (int d = 0; d < 3; d++)
                sum[d] -= force->corner[c][d];
        }
    }
}

/* Forces of the lists of one part; returns the first list behind it. */
static int compute_part(struct solid *solid, int k, int64_t step, double dt, bool *failed)
{
    const int part = solid->lists[k].part;
    struct solid_element_force *force = solid->force;
    for (; k < solid->n_lists && solid->lists[k].part == part; k++) {
        const struct solid_list *list = &solid->lists[k];
        struct solid_element_work work = {.n = list->n,
                                          .elements = solid->listed + list->first,
                                          .nodes = solid->node,
                                          .corners = solid->corners,
                                          .mass = solid->element_mass,
                                          .state = solid->state,
                                          .force = force,
                                          .material = &solid->materials[list->material],
                                          .spins = solid->turns.spin,
                                          .shells = solid->shell,
                                          .layers = solid->layers,
                                          .dt = dt,
                                          .since = step > 0 ? dt : 0.0};
        solid->kernel.apply[list->shape](&work);
        *failed |= work.failed;
        force += list->n;
    }
    add_part(solid, part);
    return k;
}

bool solid_forces(struct solid *solid, int64_t step, double dt)
{
    bool failed = false;
    const bool loaded = solid->loads.n > 0; /* else `external` never changes */
    for (int k = 0; k < solid->n_here; k++) {
        memset(solid->internal[solid->here[k]], 0, sizeof *solid->internal);
        if (loaded)
            memset(solid->external[solid->here[k]], 0, sizeof *solid->external);
    }
    solid_turns_begin(&solid->turns, loaded);
    for (int k = 0; k < solid->n_lists;)
        k = compute_part(solid, k, step, dt, &failed);
    solid_loads_apply(solid, (double)step * dt, solid->external);
    if (solid->turns.n_nodes > 0)
        solid_loads_apply_moments(solid, (double)step * dt, solid->turns.external);
    return !failed;
}

/* Velocities of what is held lead to where it is.  (12.15) */
static void hold(const struct solid *solid, int i, double dt, const double force[3],
                 struct solid_advance *advance)
{
    const int *held = solid->supports.of_node[i];
    const double *x = solid_place(solid, i), *v = solid_velocity(solid, i);
    solid_supports_place(&solid->supports, i, solid->reference[i], advance->place);
    for (int k = 0; k < 3; k++) {
        if (held[k] < 0)
            continue;
        advance->velocity[k] = (advance->place[k] - x[k]) / dt;
        advance->support[k] =
            solid->mass[i] *
                ((advance->velocity[k] - v[k]) / dt +
                 solid->damping * (0.5 * (advance->velocity[k] + v[k])) - solid->gravity[k]) -
            force[k];
    }
}

/* Force on a node along k, without gravity. */
static inline double force_at(const struct solid *solid, int i, int k)
{
    return (solid->internal[i][k] + solid->external[i][k]) + solid->contact[i][k];
}

/* Its velocity half a step later, if nothing holds it. */
static inline double velocity_at(const struct solid *solid, int i, int k, double force,
                                 double per_mass, const struct solid_pace *pace)
{
    return solid_velocity(solid, i)[k] * pace->keep +
           pace->kick * (force * per_mass + solid->gravity[k]);
}

static struct solid_advance advance_at(const struct solid *solid, int i,
                                       const struct solid_pace *pace)
{
    const double *x = solid_place(solid, i);
    const double per_mass = 1.0 / solid->mass[i];
    struct solid_advance advance;
    double force[3];
    for (int k = 0; k < 3; k++) {
        force[k] = force_at(solid, i, k);
        advance.velocity[k] = velocity_at(solid, i, k, force[k], per_mass, pace);
        advance.place[k] = x[k] + pace->dt * advance.velocity[k];
        advance.support[k] = 0.0;
    }
    if (solid_supports_hold(solid->supports.of_node[i]))
        hold(solid, i, pace->dt, force, &advance);
    return advance;
}

struct solid_advance solid_advance(const struct solid *solid, int i, double dt)
{
    const struct solid_pace pace = solid_pace_of(solid, dt);
    return advance_at(solid, i, &pace);
}

void solid_power(const struct solid *solid, int i, const struct solid_advance *advance,
                 const double v[3], double power[SOLID_N_WORKS])
{
    const double *before = solid_velocity(solid, i);
    for (int w = 0; w < SOLID_N_WORKS; w++)
        power[w] = 0.0;
    for (int k = 0; k < 3; k++) {
        const double now = 0.5 * (before[k] + advance->velocity[k]);
        power[SOLID_WORK_INTERNAL] -= solid->internal[i][k] * v[k];
        power[SOLID_WORK_LOADS] += solid->external[i][k] * v[k];
        power[SOLID_WORK_CONTACT] += solid->contact[i][k] * v[k];
        power[SOLID_WORK_GRAVITY] += solid->mass[i] * solid->gravity[k] * v[k];
        power[SOLID_WORK_SUPPORTS] += advance->support[k] * v[k];
        power[SOLID_WORK_DAMPING] += solid->damping * solid->mass[i] * now * v[k];
    }
}

void solid_velocity_now(const struct solid *solid, int i, double dt, double v[3])
{
    const struct solid_advance advance = solid_advance(solid, i, dt);
    const double *before = solid_velocity(solid, i);
    for (int k = 0; k < 3; k++)
        v[k] = 0.5 * (before[k] + advance.velocity[k]);
}

/* Work of a step's forces over the half step before and the one behind it.  (12.14) */
static void count_work(struct solid *solid, int i, const struct solid_advance *advance,
                       const struct solid_pace *pace)
{
    const double *before = solid_velocity(solid, i);
    double v[3], power[SOLID_N_WORKS];
    for (int k = 0; k < 3; k++)
        v[k] = pace->earlier * before[k] + 0.5 * advance->velocity[k];
    solid_power(solid, i, advance, v, power);
    for (int w = 0; w < SOLID_N_WORKS; w++)
        solid->work[i][w] += power[w] * pace->dt;
    solid_supports_book(&solid->supports, i, advance->support, v, pace->dt);
}

static void move_held(struct solid *solid, int i, const struct solid_pace *pace)
{
    const struct solid_advance advance = advance_at(solid, i, pace);
    count_work(solid, i, &advance, pace);
    memcpy(solid_place(solid, i), advance.place, sizeof advance.place);
    memcpy(solid_velocity(solid, i), advance.velocity, sizeof advance.velocity);
}

/* The same, component by component, where no support has to be known. */
static void move_free(struct solid *solid, int i, const struct solid_pace *pace)
{
    const double mass = solid->mass[i], per_mass = 1.0 / mass;
    double *x = solid_place(solid, i), *v = solid_velocity(solid, i), *work = solid->work[i];
    double internal = 0.0, loads = 0.0, contact = 0.0, gravity = 0.0, damping = 0.0;
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const double before = v[k];
        const double after = velocity_at(solid, i, k, force_at(solid, i, k), per_mass, pace);
        const double mean = pace->earlier * before + 0.5 * after;
        internal -= solid->internal[i][k] * mean;
        loads += solid->external[i][k] * mean;
        contact += solid->contact[i][k] * mean;
        gravity += mass * solid->gravity[k] * mean;
        damping += solid->damping * mass * (0.5 * (before + after)) * mean;
        x[k] += pace->dt * after;
        v[k] = after;
    }
    work[SOLID_WORK_INTERNAL] += internal * pace->dt;
    work[SOLID_WORK_LOADS] += loads * pace->dt;
    work[SOLID_WORK_CONTACT] += contact * pace->dt;
    work[SOLID_WORK_GRAVITY] += gravity * pace->dt;
    work[SOLID_WORK_DAMPING] += damping * pace->dt;
}

static void move(struct solid *solid, int64_t step, double dt, bool forget)
{
    struct solid_pace pace = solid_pace_of(solid, dt);
    pace.earlier = step > 0 ? 0.5 : 0.0; /* nothing was done before the start */
    solid_supports_set(&solid->supports, step + 1, dt);
    for (int k = 0; k < solid->n_here; k++) {
        const int i = solid->here[k];
        if (!solid->moves[i])
            continue;
        if (solid_supports_hold(solid->supports.of_node[i]))
            move_held(solid, i, &pace);
        else
            move_free(solid, i, &pace);
        if (forget)
            memset(solid->contact[i], 0, sizeof solid->contact[i]);
    }
    if (solid->turns.n_nodes > 0)
        solid_turns_move(solid, &pace, forget);
}

void solid_move(struct solid *solid, int64_t step, double dt)
{
    move(solid, step, dt, true);
}

void solid_move_on(struct solid *solid, int64_t step, double dt)
{
    move(solid, step, dt, false);
}
