/* See probes.h. */
#include "run/probes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/solid_mesh.h"
#include "model/solid_quality.h"
#include "run/simulation.h"

/* What a probe of nodes adds up: displacement and velocity; one of elements: stress, von Mises,
 * plastic strain, of which the last two have a greatest as well. */
enum { NODE_MEANS = 6, ELEMENT_MEANS = 8, STRESSES = 6, MOST = ELEMENT_MEANS - STRESSES };

/* What is added of nodes is that many times larger in sums, whose unit is 2^-70: small ways
 * lose nothing. */
static const double SCALE = 0x1p30;

static bool is_of_nodes(const struct probe *probe)
{
    return probe->asked->has_node || probe->asked->nodes != NULL;
}

static int n_means(const struct probe *probe)
{
    return is_of_nodes(probe) ? NODE_MEANS : ELEMENT_MEANS;
}

/* ------------------------------------------------------------------------------- building */

/* The node or middle of an element nearest to a point; the first of several. */
static int find_nearest(const struct solid_mesh *mesh, bool nodes, struct vec3 point)
{
    double least = (double)INFINITY;
    int nearest = 0;
    for (int k = 0; k < (nodes ? mesh->n_nodes : mesh->n_elements); k++) {
        const struct vec3 x = nodes ? mesh->nodes[k] : solid_quality_centre(mesh, k);
        const struct vec3 d = vec3_sub(x, point);
        if (vec3_dot(d, d) < least) {
            least = vec3_dot(d, d);
            nearest = k;
        }
    }
    return nearest;
}

static void find_items(struct probe *probe, const struct solid_mesh *mesh)
{
    const struct job_probe *asked = probe->asked;
    const bool nodes = is_of_nodes(probe);
    const char *name = nodes ? asked->nodes : asked->elements;
    if (name == NULL) {
        probe->n = 1;
        probe->items = array_allocate(1, sizeof *probe->items);
        probe->items[0] = find_nearest(mesh, nodes, nodes ? asked->node : asked->element);
        return;
    }
    const struct solid_mesh_set *set = solid_mesh_find(mesh, name);
    CHECK(set != NULL, "there is no set '%s'", name);
    probe->n = nodes ? set->n_nodes : set->n_elements;
    CHECK(probe->n > 0, "set '%s' has nothing for the probe '%s'", name, asked->name);
    probe->items = array_allocate((size_t)probe->n, sizeof *probe->items);
    memcpy(probe->items, nodes ? set->nodes : set->elements,
           (size_t)probe->n * sizeof *probe->items);
}

/* Nodes count alike, elements by their mass. */
static void share_out(struct probe *probe, const struct solid *solid)
{
    const bool nodes = is_of_nodes(probe);
    double all = 0.0;
    probe->share = array_allocate((size_t)probe->n, sizeof *probe->share);
    for (int k = 0; k < probe->n; k++) {
        probe->share[k] = nodes ? 1.0 : solid->element_mass[probe->items[k]];
        all += probe->share[k];
    }
    for (int k = 0; k < probe->n; k++)
        probe->share[k] /= all;
}

void probes_init(struct probes *probes, const struct simulation *sim)
{
    const struct job *job = sim->job;
    *probes = (struct probes){.n = job->output.n_probes};
    probes->list = array_allocate((size_t)probes->n, sizeof *probes->list);
    for (int k = 0; k < sim->deform.n && probes->n > 0; k++) {
        const struct job_body *body = &job->bodies[sim->deform.list[k].body];
        struct solid_mesh own;
        const struct solid_mesh *mesh = solid_mesh_borrow(body, &own);
        for (int p = 0; p < probes->n; p++) {
            if (strcmp(job->output.probes[p].body, body->name) != 0)
                continue;
            probes->list[p] = (struct probe){.asked = &job->output.probes[p], .deform = k};
            find_items(&probes->list[p], mesh);
            share_out(&probes->list[p], &sim->deform.list[k].solid);
        }
        solid_mesh_clear(&own);
    }
}

void probes_clear(struct probes *probes)
{
    for (int p = 0; p < probes->n; p++) {
        free(probes->list[p].items);
        free(probes->list[p].share);
    }
    free(probes->list);
    *probes = (struct probes){0};
}

/* -------------------------------------------------------------------------------- columns */

static void add_node_columns(const struct probe *probe, struct series *table)
{
    static const char axes[] = "xyz";
    const char *name = probe->asked->name;
    for (int d = 0; d < 3; d++)
        series_add_column(table, "m", "way from the place at the start", "%s.displacement_%c",
                          name, axes[d]);
    for (int d = 0; d < 3; d++)
        series_add_column(table, "m/s", "velocity", "%s.velocity_%c", name, axes[d]);
}

static void add_element_columns(const struct probe *probe, struct series *table)
{
    static const char *const parts[STRESSES] = {"xx", "yy", "zz", "xy", "yz", "zx"};
    const char *name = probe->asked->name;
    for (int k = 0; k < STRESSES; k++)
        series_add_column(table, "Pa", "Cauchy's stress", "%s.stress_%s", name, parts[k]);
    series_add_column(table, "Pa", "von Mises's equivalent stress", "%s.von_mises", name);
    series_add_column(table, "1", "equivalent plastic strain", "%s.plastic_strain", name);
    if (probe->asked->elements == NULL)
        return;
    series_add_column(table, "Pa", "greatest of von Mises's equivalent stresses",
                      "%s.von_mises_max", name);
    series_add_column(table, "1", "greatest equivalent plastic strain", "%s.plastic_strain_max",
                      name);
}

void probes_add_columns(const struct probes *probes, struct series *table)
{
    for (int p = 0; p < probes->n; p++)
        if (is_of_nodes(&probes->list[p]))
            add_node_columns(&probes->list[p], table);
        else
            add_element_columns(&probes->list[p], table);
}

/* --------------------------------------------------------------------------------- values */

static void add_node(const struct solid *solid, int i, double dt, double share,
                     struct exact_sum *sums)
{
    double v[3];
    solid_velocity_now(solid, i, dt, v);
    for (int d = 0; d < 3; d++) {
        const double way = solid_place(solid, i)[d] - solid->reference[i][d];
        exact_sum_add(&sums[d], SCALE * (share * way));
        exact_sum_add(&sums[3 + d], SCALE * (share * v[d]));
    }
}

static void add_element(const struct solid *solid, int e, double share, struct exact_sum *sums,
                        double most[MOST])
{
    const struct solid_element_state *state = &solid->state[e];
    const double last[MOST] = {solid_mises(solid, e), state->plastic_strain};
    for (int k = 0; k < STRESSES; k++)
        exact_sum_add(&sums[k], share * state->stress[k]);
    for (int k = 0; k < MOST; k++) {
        exact_sum_add(&sums[STRESSES + k], share * last[k]);
        most[k] = last[k] > most[k] ? last[k] : most[k];
    }
}

static void add_items(const struct simulation *sim, const struct probe *probe,
                      struct exact_sum *sums, double most[MOST])
{
    const struct solid *solid = &sim->deform.list[probe->deform].solid;
    for (int k = 0; k < probe->n; k++) {
        const int i = probe->items[k];
        if (is_of_nodes(probe)) {
            if (solid->moves[i])
                add_node(solid, i, deform_dt(&sim->deform, sim->dt), probe->share[k], sums);
        } else if (solid_counts(solid, i)) {
            add_element(solid, i, probe->share[k], sums, most);
        }
    }
}

int probes_values(struct simulation *sim, double *row, int n)
{
    const struct probes *probes = &sim->probes;
    int at = 0;
    if (probes->n == 0)
        return n;
    const size_t n_sums = (size_t)probes->n * ELEMENT_MEANS;
    struct exact_sum *sums = array_allocate(n_sums, sizeof *sums);
    double *most = array_allocate((size_t)probes->n * MOST, sizeof *most);
    for (int k = 0; k < sim->deform.n; k++)
        solid_supports_set(&sim->deform.list[k].solid.supports,
                           deform_step(&sim->deform, sim->step) + 1,
                           deform_dt(&sim->deform, sim->dt));
    for (int p = 0; p < probes->n; p++) {
        add_items(sim, &probes->list[p], sums + at, most + (ptrdiff_t)MOST * p);
        at += n_means(&probes->list[p]);
    }
    exact_sum_reduce(sim->comm, sums, at);
    comm_max(sim->comm, most, MOST * probes->n);
    at = 0;
    for (int p = 0; p < probes->n; p++) {
        const struct probe *probe = &probes->list[p];
        const double scale = is_of_nodes(probe) ? SCALE : 1.0;
        for (int k = 0; k < n_means(probe); k++)
            row[n++] = exact_sum_value(&sums[at++]) / scale;
        for (int k = 0; k < MOST && probe->asked->elements != NULL; k++)
            row[n++] = most[MOST * p + k];
    }
    free(most);
    free(sums);
    return n;
}
