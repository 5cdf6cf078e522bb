/*
 * Elements of shells and membranes, as many side by side as a vector has lanes: see
 * shell_element.h.  Compiled once for each instruction set (base/isa.h).
 *
 * All four shapes are one text: a shape is a constant where it is compiled, and what does not
 * concern it vanishes.
 */
#include "physics/shell_element_blocks.h"

#include "physics/lanes_rows.h"
#include "physics/shell_element.h"
#include "physics/shell_geometry.h"
#include "physics/shell_law.h"
#include "physics/solid_element_rows.h"

enum { WIDTH = LANES_WIDTH, ROW = 8, ROWS = 3, STRAINS = SHELL_GEOMETRY_STRAINS, MODES = 10 };

/* What a list of elements has in common. */
struct list {
    const struct solid_element_work *work;
    struct shell_law law;
    struct shell_element_points points;
    int layers;
    bool shell, triangle, plastic;
};

/* What a block remembers: rows of both states. */
struct memory {
    lanes own[ROW], modes[ROW], sums[ROW]; /* solid_element_state */
    lanes rest[ROWS][ROW];                 /* shell_element_state */
};

LANES_INLINE void take_rest(const struct list *list, const int *elements, struct memory *memory)
{
    for (int k = 0; k < ROWS; k++) {
        const double *at[WIDTH];
        if (k == 1 && list->layers <= 2)
            continue;
#pragma GCC unroll 8
        for (int l = 0; l < WIDTH; l++)
            at[l] = (const double *)&list->work->shells[elements[l]] + (ptrdiff_t)ROW * k;
        lanes_take_rows(at, memory->rest[k]);
    }
}

LANES_INLINE void give_rest(const struct list *list, const int *elements, struct memory *memory)
{
    for (int k = 0; k < ROWS; k++) {
        double *at[WIDTH];
        if (k == 1 && list->layers <= 2)
            continue;
#pragma GCC unroll 8
        for (int l = 0; l < WIDTH; l++)
            at[l] = (double *)&list->work->shells[elements[l]] + (ptrdiff_t)ROW * k;
        lanes_give_rows(at, memory->rest[k]);
    }
}

LANES_INLINE void take_turns(const struct solid_element_work *work, const int *elements,
                             int n_corners, lanes turned[4][3])
{
    const lanes since = lanes_all(work->since);
#pragma GCC unroll 4
    for (int c = 0; c < n_corners; c++) {
        const double *at[WIDTH];
        lanes row[ROW];
#pragma GCC unroll 8
        for (int l = 0; l < WIDTH; l++)
            at[l] = work->spins[work->corners[elements[l]][c]].lane;
        lanes_take_rows(at, row);
#pragma GCC unroll 3
        for (int i = 0; i < 3; i++)
            turned[c][i] = row[i] * since;
    }
}

LANES_INLINE void geometry_of(bool triangle, lanes x[4][3], struct shell_geometry *g)
{
    if (triangle)
        shell_geometry_triangle(x, g);
    else
        shell_geometry_quad(x, g);
}

LANES_INLINE void strains_of(const struct list *list, const struct shell_geometry *g,
                             lanes moved[4][3], lanes turned[4][3], lanes strain[STRAINS])
{
    if (list->triangle && list->shell)
        shell_geometry_triangle_strain(g, moved, turned, strain);
    else if (list->triangle)
        shell_geometry_triangle_stretch(g, moved, strain);
    else if (list->shell)
        shell_geometry_quad_strain(g, moved, turned, strain);
    else
        shell_geometry_quad_stretch(g, moved, strain);
}

/* Means through the thickness. */
struct means {
    lanes acting[3], couple[3]; /* stress with that of damping; times place */
    lanes stress[3];
    lanes shear[2]; /* acting */
    lanes thinning, heat, damped;
};

/* One layer of stress, at a place between -1 and 1.  (13.12) */
LANES_INLINE void add_layer(const struct list *list, lanes half_thickness, double place,
                            double weight, const lanes strain[STRAINS], lanes layer[4],
                            struct means *means)
{
    const struct shell_law *law = &list->law;
    const lanes w = lanes_all(weight), at = lanes_all(place), high = half_thickness * at;
    const lanes rate = lanes_all(list->work->material->damping / list->work->dt);
    lanes own[3], change[3], old[3], thinning = lanes_all(0.0), heat = lanes_all(0.0);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++)
        own[k] = list->shell ? strain[SHELL_GEOMETRY_STRETCH + k] +
                                   high * strain[SHELL_GEOMETRY_BEND + k]
                             : strain[SHELL_GEOMETRY_STRETCH + k];
    shell_law_elastic(law, own, change);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        old[k] = layer[k];
        layer[k] += change[k];
    }
    if (list->plastic)
        thinning = shell_law_return(law, old, layer, &heat);
    thinning -=
        lanes_all(law->poisson / law->young) * ((layer[0] + layer[1]) - (old[0] + old[1]));
    means->thinning += w * thinning;
    means->heat += w * heat;
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const lanes damping = change[k] * rate, acting = w * (layer[k] + damping);
        means->acting[k] += acting;
        means->couple[k] += at * acting;
        means->stress[k] += w * layer[k];
        means->damped += w * damping * own[k];
    }
}

/* Brings stress of all layers to the present. */
LANES_INLINE void stress_of(const struct list *list, const struct shell_geometry *g,
                            const lanes strain[STRAINS], struct memory *memory,
                            struct means *means)
{
    const lanes zero = lanes_all(0.0), one = lanes_all(1.0), half = lanes_all(0.5);
    const lanes thickness = memory->rest[2][6], volume = g->area * thickness;
    lanes most = zero;
    *means = (struct means){{zero, zero, zero},
                            {zero, zero, zero},
                            {zero, zero, zero},
                            {zero, zero},
                            zero,
                            zero,
                            zero};
    for (int l = 0; l < list->layers; l++) {
        lanes *layer = &memory->rest[l / 2][4 * (l % 2)];
        add_layer(list, thickness * half, list->points.place[l], list->points.weight[l], strain,
                  layer, means);
        most = lanes_where(layer[3] > most, layer[3], most);
    }
    if (list->shell) {
        const lanes across = shell_law_across(&list->law, g, thickness, list->triangle);
        const lanes rate = lanes_all(list->work->material->damping / list->work->dt);
        memory->rest[2][7] = across;
#pragma GCC unroll 2
        for (int k = 0; k < 2; k++) {
            const lanes own = strain[SHELL_GEOMETRY_SHEAR + k], change = across * own;
            memory->rest[2][4 + k] += change;
            means->shear[k] = memory->rest[2][4 + k] + change * rate;
            means->damped += change * rate * own;
        }
    }
    const lanes by = means->thinning * half;
    memory->rest[2][6] = thickness * ((one + by) / (one - by));
    memory->own[6] = most;
    memory->own[7] += means->heat * volume;
    memory->sums[6] += means->damped * volume;
}

LANES_INLINE lanes *mode_of(struct memory *memory, int mode)
{
    return mode < ROW ? &memory->modes[mode] : &memory->sums[mode - ROW];
}

/* Forces of the modes grow with what they moved.  (13.8) */
LANES_INLINE void modes_of(const struct list *list, const struct shell_geometry *g,
                           lanes thickness, const lanes strain[STRAINS], struct memory *memory)
{
    lanes stiffness[MODES], work = lanes_all(0.0);
    const int n = shell_law_n_modes(list->shell, list->triangle);
    shell_law_modes(&list->law, g, thickness, list->triangle, stiffness);
#pragma GCC unroll 10
    for (int a = 0; a < n; a++) {
        lanes *mode = mode_of(memory, a);
        const lanes moved = strain[SHELL_GEOMETRY_MODES + a], old = *mode;
        *mode += stiffness[a] * moved;
        work += (old + *mode) * moved;
    }
    memory->sums[4] += work * lanes_all(0.5);
}

/* What a pulled membrane's warp is pulled back with.  (13.10) */
LANES_INLINE void flatten(const struct shell_geometry *g, const struct means *means,
                          lanes thickness, lanes moved, struct memory *memory)
{
    const lanes *n = means->stress;
    const lanes pull = (n[0] * (g->xi[0] * g->xi[0] + g->eta[0] * g->eta[0]) +
                        n[1] * (g->xi[1] * g->xi[1] + g->eta[1] * g->eta[1])) +
                       lanes_all(2.0) * n[2] * (g->xi[0] * g->xi[1] + g->eta[0] * g->eta[1]);
    const lanes old = memory->modes[2];
    memory->modes[2] = lanes_keep(pull > lanes_all(0.0), pull) *
                       (g->area * thickness * lanes_all(1.0 / 12.0)) * g->warp;
    memory->sums[4] += (old + memory->modes[2]) * moved * lanes_all(0.5);
}

/* The mean stress in space. */
LANES_INLINE void show_stress(const struct shell_geometry *g, const lanes s[3], lanes own[ROW])
{
    lanes along[2][3];
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        along[0][i] = s[0] * g->axis[0][i] + s[2] * g->axis[1][i];
        along[1][i] = s[2] * g->axis[0][i] + s[1] * g->axis[1][i];
    }
#pragma GCC unroll 3
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3;
        own[i] = along[0][i] * g->axis[0][i] + along[1][i] * g->axis[1][i];
        own[3 + i] = along[0][i] * g->axis[0][j] + along[1][i] * g->axis[1][j];
    }
}

/* Stress resultants and forces of modes, against strains at the present geometry. */
LANES_INLINE void resultants_of(const struct shell_geometry *g, const struct means *means,
                                struct memory *memory, lanes thickness, lanes f[STRAINS])
{
    const lanes volume = g->area * thickness, half = thickness * lanes_all(0.5);
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        f[SHELL_GEOMETRY_STRETCH + k] = means->acting[k] * volume;
        f[SHELL_GEOMETRY_BEND + k] = means->couple[k] * volume * half;
    }
#pragma GCC unroll 2
    for (int k = 0; k < 2; k++)
        f[SHELL_GEOMETRY_SHEAR + k] = means->shear[k] * volume;
#pragma GCC unroll 10
    for (int a = 0; a < MODES; a++)
        f[SHELL_GEOMETRY_MODES + a] = *mode_of(memory, a);
}

/* Writes two groups of three for each element, at a place of its force. */
LANES_INLINE lanes give_pair(struct solid_element_force *force_at, int place,
                             const lanes first[3], const lanes second[3])
{
    double *at[WIDTH];
    lanes row[ROW] = {first[0],  first[1],  first[2],  lanes_all(0.0),
                      second[0], second[1], second[2], lanes_all(0.0)};
    const lanes odd = ((row[0] + row[1]) + row[2]) + ((row[4] + row[5]) + row[6]);
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++)
        at[l] = force_at[l].corner[place];
    lanes_give_rows(at, row);
    return odd * lanes_all(0.0);
}

/* Forces on the corners, and moments; returns not 0 where they are no numbers. */
LANES_INLINE lanes give_corners(const struct list *list, const struct shell_geometry *g,
                                const lanes f[STRAINS], struct solid_element_force *force_at)
{
    lanes force[4][3], moment[4][3], odd = lanes_all(0.0);
    const int n = list->triangle ? 3 : 4;
    if (list->triangle && list->shell)
        shell_geometry_triangle_resist(g, f, force, moment);
    else if (list->triangle)
        shell_geometry_triangle_pull(g, f, force);
    else if (list->shell)
        shell_geometry_quad_resist(g, f, force, moment);
    else
        shell_geometry_quad_pull(g, f, force);
    if (list->shell) {
#pragma GCC unroll 4
        for (int c = 0; c < n; c++)
            odd += give_pair(force_at, 2 * c, force[c], moment[c]);
    } else {
        odd += give_pair(force_at, 0, force[0], force[1]);
        odd += give_pair(force_at, 2, force[2], force[n - 1]);
    }
    return odd;
}

LANES_INLINE lanes_mask block(const struct list *list, const int *elements,
                              struct solid_element_force *force_at)
{
    const struct solid_element_work *work = list->work;
    const int n = list->triangle ? 3 : 4;
    const lanes zero = lanes_all(0.0);
    lanes x[4][3], moved[4][3], middle[4][3], turned[4][3], strain[STRAINS], f[STRAINS];
    struct shell_geometry before, now;
    struct memory memory;
    struct means means;

    solid_element_take_corners(work, elements, n, x, moved);
    solid_element_midway(n, x, moved, middle);
    if (list->shell)
        take_turns(work, elements, n, turned);
    geometry_of(list->triangle, middle, &before);
    strains_of(list, &before, moved, turned, strain);
    solid_element_take_state(work, elements, 0, memory.own);
    solid_element_take_state(work, elements, 1, memory.modes);
    solid_element_take_state(work, elements, 2, memory.sums);
    take_rest(list, elements, &memory);
    stress_of(list, &before, strain, &memory, &means);
    const lanes thickness = memory.rest[2][6];
    modes_of(list, &before, thickness, strain, &memory);

    geometry_of(list->triangle, x, &now);
    if (!list->shell && !list->triangle)
        flatten(&now, &means, thickness, strain[SHELL_GEOMETRY_MODES + 2], &memory);
    show_stress(&now, means.stress, memory.own);
    memory.sums[7] = now.area * thickness;
    resultants_of(&now, &means, &memory, thickness, f);
    const lanes odd = give_corners(list, &now, f, force_at);
    solid_element_give_state(work, elements, 0, memory.own);
    solid_element_give_state(work, elements, 1, memory.modes);
    solid_element_give_state(work, elements, 2, memory.sums);
    give_rest(list, elements, &memory);
    const lanes facing = solid_gradient_dot(before.axis[2], now.axis[2]);
    return ~((before.area > zero) & (now.area > zero) & (thickness > zero) & (facing > zero) &
             (odd == zero));
}

LANES_INLINE void all_blocks(struct solid_element_work *work, bool shell, bool triangle,
                             bool plastic)
{
    const struct solid_element_work own = *work;
    const struct list list = {.work = &own,
                              .law = shell_law_of(own.material),
                              .points = shell_element_points(shell ? own.layers : 1),
                              .layers = shell ? own.layers : 1,
                              .shell = shell,
                              .triangle = triangle,
                              .plastic = plastic};
    lanes_mask failed = {0};
    for (int k = 0; k < own.n; k += WIDTH)
        failed |= block(&list, own.elements + k, own.force + k);
    work->failed = lanes_any(failed);
}

#define APPLY(name, shell, triangle)                                                           \
    static void apply_##name(struct solid_element_work *work)                                  \
    {                                                                                          \
        if (work->material->n_yield > 0)                                                       \
            all_blocks(work, shell, triangle, true);                                           \
        else                                                                                   \
            all_blocks(work, shell, triangle, false);                                          \
    }

APPLY(shell_quads, true, false)
APPLY(shell_triangles, true, true)
APPLY(membrane_quads, false, false)
APPLY(membrane_triangles, false, true)

struct solid_element_kernel ISA_OFFER(shell_element_blocks)(void)
{
    return (struct solid_element_kernel){
        {[SOLID_ELEMENT_SHELL_QUAD] = apply_shell_quads,
         [SOLID_ELEMENT_SHELL_TRIANGLE] = apply_shell_triangles,
         [SOLID_ELEMENT_MEMBRANE_QUAD] = apply_membrane_quads,
         [SOLID_ELEMENT_MEMBRANE_TRIANGLE] = apply_membrane_triangles}};
}
