/* See solid_mesh.h.  Sides find each other through a table hashed by their nodes, so that the
 * work grows with their number however a file joins them.  A side's place in it is not far
 * from that of its least node: most meshes are numbered so that neighbours then meet in the
 * cache.
 */
#include "model/solid_mesh.h"

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/geometry.h"
#include "model/region.h"
#include "model/sheet_shape.h"
#include "model/solid_shape.h"

/* ---------------------------------------------------------------------------------- sides */

int solid_mesh_side_corners(int n_corners, int side, int corners[4])
{
    static const int hexahedron[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                         {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    static const int tetrahedron[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    if (side < 0 || side >= (n_corners == 8 ? 6 : 4))
        return 0;
    const int n = n_corners == 8 ? 4 : 3;
    for (int k = 0; k < n; k++)
        corners[k] = n == 4 ? hexahedron[side][k] : tetrahedron[side][k];
    return n;
}

int solid_mesh_side_nodes(const int element[8], int side, int nodes[4])
{
    if (solid_mesh_is_sheet(element)) {
        memcpy(nodes, element, 4 * sizeof *nodes);
        return side == 0 ? solid_mesh_n_corners(element) : 0;
    }
    const int n = solid_mesh_side_corners(solid_mesh_n_corners(element), side, nodes);
    for (int k = 0; k < n; k++)
        nodes[k] = element[nodes[k]];
    for (int k = n; k < 4; k++)
        nodes[k] = -1;
    return n;
}

/* All sides of all elements that are no sheets, by their nodes. */
struct side_table {
    int n_heads, per_node;
    int *heads, *next; /* numbers of sides; -1: none */
};

/* The nodes of a side or facet in ascending order. */
static void sort_four(const int nodes[4], int sorted[4])
{
    memcpy(sorted, nodes, 4 * sizeof *sorted);
    for (int k = 1; k < 4; k++)
        for (int j = k; j > 0 && sorted[j] < sorted[j - 1]; j--) {
            const int swap = sorted[j];
            sorted[j] = sorted[j - 1];
            sorted[j - 1] = swap;
        }
}

enum { SPREAD = 4096 };

static int head_of(const struct side_table *table, const int sorted[4])
{
    uint64_t hash = 0;
    for (int k = 0; k < 4; k++)
        hash = (hash ^ (uint64_t)(uint32_t)sorted[k]) * UINT64_C(0x9e3779b97f4a7c15) ^
               (hash >> 29);
    const int least = sorted[0] >= 0 ? sorted[0] : sorted[1];
    const uint64_t place = (uint64_t)least * (uint64_t)table->per_node + (hash >> 20) % SPREAD;
    return (int)(place % (uint64_t)table->n_heads);
}

static void sorted_nodes(const struct solid_mesh *mesh, int number, int sorted[4])
{
    int nodes[4];
    solid_mesh_side_nodes(mesh->elements[number / SOLID_MESH_SIDES], number % SOLID_MESH_SIDES,
                          nodes);
    sort_four(nodes, sorted);
}

static void table_build(struct side_table *table, const struct solid_mesh *mesh)
{
    const size_t n = (size_t)mesh->n_elements * SOLID_MESH_SIDES;
    table->n_heads = (int)(n / 2 + 1);
    table->per_node = mesh->n_nodes > 0 && mesh->n_nodes < table->n_heads
                          ? table->n_heads / mesh->n_nodes
                          : 1;
    table->heads = array_allocate((size_t)table->n_heads, sizeof *table->heads);
    table->next = array_allocate(n, sizeof *table->next);
    memset(table->heads, -1, (size_t)table->n_heads * sizeof *table->heads);
    for (int e = mesh->n_elements - 1; e >= 0; e--) { /* so that lists ascend */
        const bool is_sheet = solid_mesh_is_sheet(mesh->elements[e]);
        for (int s = is_sheet ? -1 : solid_mesh_n_sides(mesh->elements[e]) - 1; s >= 0; s--) {
            const int number = SOLID_MESH_SIDES * e + s;
            int sorted[4];
            sorted_nodes(mesh, number, sorted);
            int *head = &table->heads[head_of(table, sorted)];
            table->next[number] = *head;
            *head = number;
        }
    }
}

static void table_clear(struct side_table *table)
{
    free(table->heads);
    free(table->next);
}

/* The first side with these nodes from `number` on in its list; -1: none. */
static int find_side(const struct side_table *table, const struct solid_mesh *mesh, int number,
                     const int sorted[4])
{
    for (; number >= 0; number = table->next[number]) {
        int theirs[4];
        sorted_nodes(mesh, number, theirs);
        if (memcmp(theirs, sorted, sizeof theirs) == 0)
            return number;
    }
    return -1;
}

static int find_first(const struct side_table *table, const struct solid_mesh *mesh,
                      const int nodes[4])
{
    int sorted[4];
    sort_four(nodes, sorted);
    return find_side(table, mesh, table->heads[head_of(table, sorted)], sorted);
}

/* Sides with the same nodes as this one, the first of them: they become partners. */
static void join(const struct side_table *table, const struct solid_mesh *mesh, int first,
                 int *partners)
{
    int sorted[4];
    sorted_nodes(mesh, first, sorted);
    const int second = find_side(table, mesh, table->next[first], sorted);
    if (second < 0)
        return;
    partners[first] = second;
    partners[second] = first;
    for (int more = find_side(table, mesh, table->next[second], sorted); more >= 0;
         more = find_side(table, mesh, table->next[more], sorted))
        partners[first] = partners[second] = partners[more] = SOLID_MESH_SEVERAL;
}

int *solid_mesh_partners(const struct solid_mesh *mesh)
{
    struct side_table table;
    int *partners =
        array_allocate((size_t)mesh->n_elements * SOLID_MESH_SIDES, sizeof *partners);
    table_build(&table, mesh);
    for (int e = 0; e < mesh->n_elements; e++)
        for (int s = 0; s < SOLID_MESH_SIDES; s++)
            partners[SOLID_MESH_SIDES * e + s] = s < solid_mesh_n_sides(mesh->elements[e])
                                                     ? SOLID_MESH_OUTSIDE
                                                     : SOLID_MESH_NO_SIDE;
    for (int number = 0; number < SOLID_MESH_SIDES * mesh->n_elements; number++)
        if (partners[number] == SOLID_MESH_OUTSIDE &&
            !solid_mesh_is_sheet(mesh->elements[number / SOLID_MESH_SIDES]))
            join(&table, mesh, number, partners);
    table_clear(&table);
    return partners;
}

int *solid_mesh_covered(const struct solid_mesh *mesh)
{
    struct side_table table;
    int *covered = array_allocate((size_t)mesh->n_elements, sizeof *covered);
    memset(covered, -1, (size_t)mesh->n_elements * sizeof *covered);
    if (mesh->sheets == NULL)
        return covered;
    table_build(&table, mesh);
    for (int e = 0; e < mesh->n_elements; e++)
        covered[e] = solid_mesh_is_sheet(mesh->elements[e])
                         ? find_first(&table, mesh, mesh->elements[e])
                         : -1;
    table_clear(&table);
    return covered;
}

int solid_mesh_surface(const struct solid_mesh *mesh, struct solid_mesh_side **sides)
{
    int *partners = solid_mesh_partners(mesh);
    int n = 0;
    for (int number = 0; number < SOLID_MESH_SIDES * mesh->n_elements; number++)
        n += partners[number] == SOLID_MESH_OUTSIDE;
    *sides = array_allocate((size_t)n, sizeof **sides);
    n = 0;
    for (int number = 0; number < SOLID_MESH_SIDES * mesh->n_elements; number++)
        if (partners[number] == SOLID_MESH_OUTSIDE)
            (*sides)[n++] =
                (struct solid_mesh_side){number / SOLID_MESH_SIDES, number % SOLID_MESH_SIDES};
    free(partners);
    return n;
}

/* ----------------------------------------------------------------------------------- sets */

void solid_mesh_list_add(struct solid_mesh_list *list, int item)
{
    ARRAY_GROW(list->items, list->n + 1, list->capacity);
    list->items[list->n++] = item;
}

/* The list in order, everything once. */
static int *sorted_list(const struct solid_mesh_list *list, int *n)
{
    int *items = array_allocate((size_t)list->n, sizeof *items);
    *n = 0;
    if (list->n == 0)
        return items;
    memcpy(items, list->items, (size_t)list->n * sizeof *items);
    qsort(items, (size_t)list->n, sizeof *items, array_compare_ints);
    for (int k = 0; k < list->n; k++)
        if (*n == 0 || items[k] > items[*n - 1])
            items[(*n)++] = items[k];
    return items;
}

void solid_mesh_add_set(struct solid_mesh *mesh, const char *name,
                        const struct solid_mesh_list *nodes,
                        const struct solid_mesh_list *sides,
                        const struct solid_mesh_list *elements)
{
    mesh->sets = array_resize(mesh->sets, (size_t)mesh->n_sets, (size_t)mesh->n_sets + 1,
                              sizeof *mesh->sets);
    struct solid_mesh_set *set = &mesh->sets[mesh->n_sets++];
    set->name = array_string(name);
    set->nodes = sorted_list(nodes, &set->n_nodes);
    set->elements = sorted_list(elements, &set->n_elements);
    int *numbers = sorted_list(sides, &set->n_sides);
    set->sides = array_allocate((size_t)set->n_sides, sizeof *set->sides);
    for (int k = 0; k < set->n_sides; k++)
        set->sides[k] = (struct solid_mesh_side){numbers[k] / SOLID_MESH_SIDES,
                                                 numbers[k] % SOLID_MESH_SIDES};
    free(numbers);
}

const struct solid_mesh_set *solid_mesh_find(const struct solid_mesh *mesh, const char *name)
{
    for (int k = 0; k < mesh->n_sets; k++)
        if (strcmp(mesh->sets[k].name, name) == 0)
            return &mesh->sets[k];
    return NULL;
}

static void add_all(struct solid_mesh *mesh)
{
    struct solid_mesh_list nodes = {0}, sides = {0}, elements = {0};
    for (int k = 0; k < mesh->n_nodes; k++)
        solid_mesh_list_add(&nodes, k);
    for (int e = 0; e < mesh->n_elements; e++)
        solid_mesh_list_add(&elements, e);
    solid_mesh_add_set(mesh, "all", &nodes, &sides, &elements);
    free(nodes.items);
    free(elements.items);
}

static void add_side_nodes(const struct solid_mesh *mesh, struct solid_mesh_side side,
                           struct solid_mesh_list *nodes)
{
    int corners[4];
    const int n = solid_mesh_side_nodes(mesh->elements[side.element], side.side, corners);
    for (int k = 0; k < n; k++)
        solid_mesh_list_add(nodes, corners[k]);
}

static void add_surface(struct solid_mesh *mesh, int n, const struct solid_mesh_side *surface)
{
    struct solid_mesh_list nodes = {0}, sides = {0}, elements = {0};
    for (int k = 0; k < n; k++) {
        solid_mesh_list_add(&sides, SOLID_MESH_SIDES * surface[k].element + surface[k].side);
        add_side_nodes(mesh, surface[k], &nodes);
    }
    solid_mesh_add_set(mesh, "surface", &nodes, &sides, &elements);
    free(nodes.items);
    free(sides.items);
}

/* Part of the mesh's width by which a node may miss the border of a region and still count. */
static const double ROUNDING = 1e-9;

static double width_of(const struct solid_mesh *mesh)
{
    double most = 0.0;
    for (int k = 0; k < mesh->n_nodes; k++) {
        const double far = vec3_norm(vec3_sub(mesh->nodes[k], mesh->nodes[0]));
        most = far > most ? far : most;
    }
    return most;
}

static bool all_inside(int n, const int *nodes, const bool *inside)
{
    for (int c = 0; c < n; c++)
        if (!inside[nodes[c]])
            return false;
    return true;
}

static void add_region(struct solid_mesh *mesh, const struct job_set *asked, int n,
                       const struct solid_mesh_side *surface)
{
    struct solid_mesh_list nodes = {0}, sides = {0}, elements = {0};
    bool *inside = array_allocate((size_t)mesh->n_nodes, sizeof *inside);
    const double margin = -ROUNDING * width_of(mesh);
    struct region region;
    char *why;
    CHECK(region_build(&region, &asked->region, NULL, &why), "set '%s': %s", asked->name, why);
    for (int k = 0; k < mesh->n_nodes; k++) {
        inside[k] = region_contains(&region, mesh->nodes[k], margin);
        if (inside[k])
            solid_mesh_list_add(&nodes, k);
    }
    for (int k = 0; k < n; k++) {
        int corners[4];
        const int m =
            solid_mesh_side_nodes(mesh->elements[surface[k].element], surface[k].side, corners);
        if (all_inside(m, corners, inside))
            solid_mesh_list_add(&sides,
                                SOLID_MESH_SIDES * surface[k].element + surface[k].side);
    }
    for (int e = 0; e < mesh->n_elements; e++)
        if (all_inside(solid_mesh_n_corners(mesh->elements[e]), mesh->elements[e], inside))
            solid_mesh_list_add(&elements, e);
    region_clear(&region);
    solid_mesh_add_set(mesh, asked->name, &nodes, &sides, &elements);
    free(inside);
    free(nodes.items);
    free(sides.items);
    free(elements.items);
}

/* ----------------------------------------------------------------------------------- files */

/* Is there a group of this name and dimension? */
static const struct job_volume_group *find_group(const struct job_volume *volume,
                                                 const char *name, int dimension)
{
    for (int g = 0; g < volume->n_groups; g++)
        if (volume->groups[g].dimension == dimension &&
            strcmp(volume->groups[g].name, name) == 0)
            return &volume->groups[g];
    return NULL;
}

/* Which nodes and elements of the file the body takes: their new numbers from 1; 0: not. */
struct choice {
    int *nodes, *elements;
};

/* Nodes of facets that become sheets are taken, too. */
static void choose_facets(struct choice *choice, const struct job_volume *volume,
                          const struct job_solid *solid)
{
    for (int k = 0; k < solid->n_shells; k++) {
        const struct job_volume_group *group = find_group(volume, solid->shells[k].set, 2);
        for (int i = 0; group != NULL && i < group->n; i++)
            for (int c = 0; c < 4 && volume->items[group->first + i][c] >= 0; c++)
                choice->nodes[volume->items[group->first + i][c]] = 1;
    }
}

static void choose(struct choice *choice, const struct job_volume *volume,
                   const struct job_solid *solid, const char *name)
{
    const struct job_volume_group *group = name != NULL ? find_group(volume, name, 3) : NULL;
    int n_nodes = 0, n_elements = 0;
    choice->nodes = array_allocate((size_t)volume->n_nodes, sizeof *choice->nodes);
    choice->elements = array_allocate((size_t)volume->n_elements, sizeof *choice->elements);
    for (int e = 0; e < volume->n_elements; e++)
        choice->elements[e] = name == NULL;
    for (int k = 0; group != NULL && k < group->n; k++)
        choice->elements[volume->items[group->first + k][0]] = 1;
    for (int k = 0; k < volume->n_nodes; k++)
        choice->nodes[k] = name == NULL;
    for (int e = 0; e < volume->n_elements; e++) {
        if (choice->elements[e] == 0)
            continue;
        choice->elements[e] = ++n_elements;
        for (int c = 0; c < solid_mesh_n_corners(volume->elements[e]); c++)
            choice->nodes[volume->elements[e][c]] = 1;
    }
    choose_facets(choice, volume, solid);
    for (int k = 0; k < volume->n_nodes; k++)
        if (choice->nodes[k] != 0)
            choice->nodes[k] = ++n_nodes;
}

static void take_file(struct solid_mesh *mesh, const struct job_volume *volume,
                      const struct choice *choice)
{
    mesh->nodes = array_allocate((size_t)volume->n_nodes, sizeof *mesh->nodes);
    mesh->node_numbers = array_allocate((size_t)volume->n_nodes, sizeof *mesh->node_numbers);
    mesh->elements = array_allocate((size_t)volume->n_elements, sizeof *mesh->elements);
    mesh->element_numbers =
        array_allocate((size_t)volume->n_elements, sizeof *mesh->element_numbers);
    for (int k = 0; k < volume->n_nodes; k++) {
        if (choice->nodes[k] == 0)
            continue;
        mesh->node_numbers[mesh->n_nodes] = volume->node_numbers[k];
        mesh->nodes[mesh->n_nodes++] = volume->nodes[k];
    }
    for (int e = 0; e < volume->n_elements; e++) {
        if (choice->elements[e] == 0)
            continue;
        mesh->element_numbers[mesh->n_elements] = volume->element_numbers[e];
        int *element = mesh->elements[mesh->n_elements++];
        for (int c = 0; c < 8; c++)
            element[c] =
                volume->elements[e][c] >= 0 ? choice->nodes[volume->elements[e][c]] - 1 : -1;
    }
}

/* What a set of the file holds, while its groups are gathered. */
struct gathering {
    struct solid_mesh_list nodes, sides, elements;
    int n_strays, stray_capacity, (*strays)[4];
};

/* An item of a group of points, curves or surfaces, as far as the body has its nodes. */
static void gather_item(struct gathering *set, const struct solid_mesh *mesh,
                        const struct side_table *table, const int item[4],
                        const struct choice *choice, int dimension)
{
    int nodes[4] = {-1, -1, -1, -1};
    for (int c = 0; c < 4 && item[c] >= 0; c++) {
        nodes[c] = choice->nodes[item[c]] - 1;
        if (nodes[c] < 0)
            return;
    }
    for (int c = 0; c < 4 && nodes[c] >= 0; c++)
        solid_mesh_list_add(&set->nodes, nodes[c]);
    if (dimension != 2)
        return;
    const int side = find_first(table, mesh, nodes);
    int sorted[4];
    sort_four(nodes, sorted);
    if (side >= 0 && find_side(table, mesh, table->next[side], sorted) < 0)
        solid_mesh_list_add(&set->sides, side);
    else {
        ARRAY_GROW(set->strays, set->n_strays + 1, set->stray_capacity);
        memcpy(set->strays[set->n_strays++], nodes, sizeof nodes);
    }
}

static void gather(struct gathering *set, const struct solid_mesh *mesh,
                   const struct side_table *table, const struct job_volume *volume,
                   const struct choice *choice, const struct job_volume_group *group)
{
    for (int k = 0; k < group->n; k++) {
        const int *item = volume->items[group->first + k];
        if (group->dimension < 3) {
            gather_item(set, mesh, table, item, choice, group->dimension);
            continue;
        }
        const int e = choice->elements[item[0]] - 1;
        if (e < 0)
            continue;
        solid_mesh_list_add(&set->elements, e);
        for (int c = 0; c < solid_mesh_n_corners(mesh->elements[e]); c++)
            solid_mesh_list_add(&set->nodes, mesh->elements[e][c]);
    }
}

/* Groups of one name, whatever their dimensions, are one set. */
static void add_groups(struct solid_mesh *mesh, const struct job_volume *volume,
                       const struct choice *choice)
{
    struct side_table table;
    table_build(&table, mesh);
    for (int g = 0; g < volume->n_groups; g++) {
        const char *name = volume->groups[g].name;
        struct gathering set = {.n_strays = 0};
        if (solid_mesh_find(mesh, name) != NULL)
            continue;
        for (int h = g; h < volume->n_groups; h++)
            if (strcmp(volume->groups[h].name, name) == 0)
                gather(&set, mesh, &table, volume, choice, &volume->groups[h]);
        solid_mesh_add_set(mesh, name, &set.nodes, &set.sides, &set.elements);
        mesh->sets[mesh->n_sets - 1].n_strays = set.n_strays;
        mesh->sets[mesh->n_sets - 1].strays = set.strays;
        free(set.nodes.items);
        free(set.sides.items);
        free(set.elements.items);
    }
    table_clear(&table);
}

static void build_file(struct solid_mesh *mesh, const struct job_body *body)
{
    const struct job_volume *volume = &body->solid.volume;
    struct choice choice;
    choose(&choice, volume, &body->solid, body->group);
    take_file(mesh, volume, &choice);
    add_groups(mesh, volume, &choice);
    free(choice.nodes);
    free(choice.elements);
}

/* ------------------------------------------------------------------------------------ all */

/* A set that is not there is told of elsewhere. */
static void set_thickness(struct solid_mesh *mesh, const struct job_thickness *asked)
{
    const struct solid_mesh_set *set = solid_mesh_find(mesh, asked->set);
    for (int k = 0; set != NULL && k < set->n_elements; k++)
        if (solid_mesh_is_sheet(mesh->elements[set->elements[k]]))
            mesh->sheets[set->elements[k]].thickness = asked->thickness;
}

/* Appends to a list that ascends. */
static void append(int **list, int *n, int item)
{
    *list = array_resize(*list, (size_t)*n, (size_t)*n + 1, sizeof **list);
    (*list)[(*n)++] = item;
}

/* Sets have what lies in them whole. */
static void add_to_sets(struct solid_mesh *mesh, int element)
{
    const int *corners = mesh->elements[element];
    for (int k = 0; k < mesh->n_sets; k++) {
        struct solid_mesh_set *set = &mesh->sets[k];
        bool all = true;
        for (int c = 0; c < solid_mesh_n_corners(corners); c++)
            all = all && bsearch(&corners[c], set->nodes, (size_t)set->n_nodes,
                                 sizeof *set->nodes, array_compare_ints) != NULL;
        if (all)
            append(&set->elements, &set->n_elements, element);
    }
}

static void add_shell(struct solid_mesh *mesh, const struct job_body *body,
                      const struct job_shell *asked, const int nodes[4])
{
    const int e = mesh->n_elements++,
              element[8] = {nodes[0],         nodes[1], nodes[2], nodes[3],
                            SOLID_MESH_SHEET, -1,       -1,       -1};
    memcpy(mesh->elements[e], element, sizeof element);
    mesh->sheets[e] = (struct solid_mesh_sheet){
        .thickness = asked->thickness,
        .membrane = asked->model == JOB_SHELL_MEMBRANE,
        .material = asked->has_material ? asked->material : body->material};
    if (mesh->element_numbers != NULL)
        mesh->element_numbers[e] = e > 0 ? mesh->element_numbers[e - 1] + 1 : 1;
}

/* Sheets from this one on that lie on no side of a solid are on the surface themselves. */
static void add_free_sides(struct solid_mesh *mesh, int first)
{
    int *covered = solid_mesh_covered(mesh);
    for (int k = 0; k < mesh->n_sets; k++) {
        struct solid_mesh_set *set = &mesh->sets[k];
        const bool is_surface = strcmp(set->name, "surface") == 0;
        for (int e = first; e < mesh->n_elements; e++) {
            int s = is_surface ? -1 : set->n_strays - 1;
            while (s >= 0 && memcmp(set->strays[s], mesh->elements[e], 4 * sizeof(int)) != 0)
                s--;
            if (covered[e] >= 0 || (!is_surface && s < 0))
                continue;
            set->sides = array_resize(set->sides, (size_t)set->n_sides,
                                      (size_t)set->n_sides + 1, sizeof *set->sides);
            set->sides[set->n_sides++] = (struct solid_mesh_side){e, 0};
            if (!is_surface)
                memcpy(set->strays[s], set->strays[--set->n_strays], sizeof *set->strays);
        }
    }
    free(covered);
}

/* Room for sheets on all that shells are asked for; those that are there are none. */
static void reserve_shells(struct solid_mesh *mesh, const struct job_body *body)
{
    const size_t had = (size_t)mesh->n_elements;
    size_t n = had;
    for (int k = 0; k < body->solid.n_shells; k++) {
        const struct solid_mesh_set *set = solid_mesh_find(mesh, body->solid.shells[k].set);
        n += set != NULL ? (size_t)(set->n_sides + set->n_strays) : 0;
    }
    mesh->elements = array_resize(mesh->elements, had, n, sizeof *mesh->elements);
    mesh->sheets = array_allocate(n, sizeof *mesh->sheets);
    if (mesh->element_numbers != NULL)
        mesh->element_numbers =
            array_resize(mesh->element_numbers, had, n, sizeof *mesh->element_numbers);
    for (size_t e = 0; e < had; e++)
        mesh->sheets[e].material = body->material;
}

/* A set that is not there, or has nothing, is told of elsewhere. */
static void add_shells(struct solid_mesh *mesh, const struct job_body *body)
{
    if (body->solid.n_shells == 0)
        return;
    const int first = mesh->n_elements;
    reserve_shells(mesh, body);
    for (int k = 0; k < body->solid.n_shells; k++) {
        const struct job_shell *asked = &body->solid.shells[k];
        const struct solid_mesh_set *set = solid_mesh_find(mesh, asked->set);
        for (int s = 0; set != NULL && s < set->n_sides; s++) {
            int nodes[4];
            solid_mesh_side_nodes(mesh->elements[set->sides[s].element], set->sides[s].side,
                                  nodes);
            add_shell(mesh, body, asked, nodes);
        }
        for (int s = 0; set != NULL && s < set->n_strays; s++)
            add_shell(mesh, body, asked, set->strays[s]);
    }
    add_free_sides(mesh, first);
    for (int e = first; e < mesh->n_elements; e++)
        add_to_sets(mesh, e);
}

void solid_mesh_build(struct solid_mesh *mesh, const struct job_body *body)
{
    const struct job_solid *solid = &body->solid;
    struct solid_mesh_side *surface;
    *mesh = (struct solid_mesh){0};
    if (body->model != JOB_MODEL_SOLID)
        sheet_shape_build(mesh, body);
    else if (solid->kind == JOB_MESH_GMSH)
        build_file(mesh, body);
    else
        solid_shape_build(mesh, body);
    geometry_place(body, mesh->n_nodes, mesh->nodes);
    const int n = solid_mesh_surface(mesh, &surface);
    if (solid_mesh_find(mesh, "all") == NULL)
        add_all(mesh);
    if (solid_mesh_find(mesh, "surface") == NULL)
        add_surface(mesh, n, surface);
    for (int k = 0; k < solid->n_sets; k++)
        add_region(mesh, &solid->sets[k], n, surface);
    if (body->model == JOB_MODEL_SOLID)
        add_shells(mesh, body);
    for (int k = 0; k < solid->n_thicknesses; k++)
        set_thickness(mesh, &solid->thicknesses[k]);
    free(surface);
}

void solid_mesh_clear(struct solid_mesh *mesh)
{
    for (int k = 0; k < mesh->n_sets; k++) {
        free(mesh->sets[k].name);
        free(mesh->sets[k].nodes);
        free(mesh->sets[k].sides);
        free(mesh->sets[k].elements);
        free(mesh->sets[k].strays);
    }
    free(mesh->sets);
    free(mesh->nodes);
    free(mesh->elements);
    free(mesh->node_numbers);
    free(mesh->element_numbers);
    free(mesh->sheets);
    *mesh = (struct solid_mesh){0};
}

/* --------------------------------------------------------------------------------- keeping */

const struct solid_mesh *solid_mesh_keep(struct job_body *body)
{
    if (body->solid.mesh == NULL) {
        struct solid_mesh *mesh = array_allocate(1, sizeof *mesh);
        solid_mesh_build(mesh, body);
        body->solid.mesh = mesh;
    }
    return body->solid.mesh;
}

const struct solid_mesh *solid_mesh_borrow(const struct job_body *body, struct solid_mesh *own)
{
    *own = (struct solid_mesh){0};
    if (body->solid.mesh != NULL)
        return body->solid.mesh;
    solid_mesh_build(own, body);
    return own;
}

void solid_mesh_release(struct job *job)
{
    for (int b = 0; b < job->n_bodies; b++) {
        struct solid_mesh *mesh = job->bodies[b].solid.mesh;
        if (mesh != NULL)
            solid_mesh_clear(mesh);
        free(mesh);
        job->bodies[b].solid.mesh = NULL;
    }
}
