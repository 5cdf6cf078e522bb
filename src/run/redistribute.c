/*
 * See redistribute.h.  Allowances: a sphere may go s = max(half buffer, 1.3 |v| K dt) before a
 * search is due, at most a few radii, fewer where so many are fast and near each other that
 * lists get long; the inner list has its own, much smaller ones.  The sum
 * over steps of the largest |v|/s dt bounds what has been used; when it exceeds 1 the exact
 * largest |x - x_search|/s decides.
 */
#include "run/redistribute.h"

#include <math.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "domain/rcb.h"
#include "job/job.h"
#include "model/order.h"
#include "run/simulation.h"

/* Steps that a search and an inner list should last at present speeds; measured to pay. */
static const double SEARCH_STEPS = 60.0, INNER_STEPS = 20.0;
static const double SPEED_MARGIN = 1.3;
/* Largest allowance and least inner allowance, in radii. */
static const double ALLOWANCE_MOST = 6.0, INNER_LEAST = 0.0015;
/* Candidates a sphere beyond which speeds give shorter allowances, for rarer searches do not
 * pay any more; how much shorter from search to search, and longer again; and the least that
 * speeds may ask for, in radii, which is where a run begins. */
static const double CANDIDATES_MOST = 12.0, SHORTER = 0.8, LONGER = 1.25, ASKED_LEAST = 1.0;
/* Largest allowance in shortest periods: images one period away are then all that is needed. */
static const double PERIOD_SHARE = 0.125;
/* Below this exact share a search can wait. */
static const double SPENT_FINE = 0.7;

static bool is_multiple(int64_t step, int64_t every)
{
    return every > 0 && step % every == 0;
}

bool redistribute_is_due(const struct simulation *sim)
{
    const struct job *job = sim->job;
    return !(sim->spent.search <= 1.0) || is_multiple(sim->step, job->order_every) ||
           is_multiple(sim->step, job->force.search_every) ||
           is_multiple(sim->step, job->force.redistribute_every) ||
           is_multiple(sim->step, job->force.repartition_every);
}

bool redistribute_inner_is_due(const struct simulation *sim)
{
    return !(sim->spent.inner <= 1.0);
}

static void choose_allowances(struct simulation *sim, int begin, int end)
{
    struct spheres *spheres = &sim->spheres;
    const double horizon = SPEED_MARGIN * SEARCH_STEPS * sim->dt;
    const double far = PERIOD_SHARE * spheres->periodic.shortest;
    for (int i = begin; i < end; i++) {
        const double *v = sphere_velocity(spheres, i);
        const double most = ALLOWANCE_MOST * sphere_radius(spheres, i);
        const double asked = horizon * sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        const double bearable = sim->asked_most * sphere_radius(spheres, i);
        const double reach = asked < bearable ? asked : bearable;
        double allowance = reach > sim->half_buffer ? reach : sim->half_buffer;
        allowance = allowance < most ? allowance : most;
        allowance = allowance < far ? allowance : far;
        spheres->allowance[i] = allowance;
        spheres->inverse_allowance[i][0] = 1.0 / allowance;
    }
}

static void choose_body_allowances(struct simulation *sim)
{
    const double least =
        sim->half_buffer < sim->touch.buffer ? sim->half_buffer : sim->touch.buffer;
    for (int b = 0; b < sim->bodies.n; b++) {
        /* A body that forces move or deform may be faster by the next search. */
        const struct body *body = &sim->bodies.list[b];
        const double margin = body->rigid != NULL || body->skin != NULL ? SPEED_MARGIN : 1.0;
        const double reach = margin * body->speed_max * SEARCH_STEPS * sim->dt;
        sim->body_allowance[b] = reach > least ? reach : least;
    }
}

/* Share of its allowance that the fastest moving body uses in a step, on any rank. */
static double bodies_spend(const struct simulation *sim)
{
    double most = sim->deform.spent;
    for (int b = 0; b < sim->bodies.n; b++) {
        if (sim->bodies.list[b].skin != NULL)
            continue;
        const double spent = sim->bodies.list[b].speed_max * sim->dt / sim->body_allowance[b];
        most = spent > most ? spent : most;
    }
    return most;
}

static void prune(struct simulation *sim, const int *moved)
{
    const double least = INNER_LEAST * 4.0 * sim->half_buffer;
    contact_set_prune(&sim->contacts, &sim->candidates, &sim->spheres, least,
                      INNER_STEPS * sim->dt, sim->job->force.search == JOB_SEARCH_ALL_PAIRS,
                      moved);
    sim->spent.inner = 0.0;
    sim->runtime.prunes++;
}

void redistribute_inner(struct simulation *sim)
{
    runtime_begin(&sim->runtime);
    prune(sim, NULL);
    runtime_end(&sim->runtime, RUNTIME_SEARCH);
}

/* What this rank has to share out, which the caller frees; returns how many. */
static int weigh(const struct simulation *sim, struct rcb_point **points)
{
    int n = sim->spheres.n_owned;
    *points = array_allocate((size_t)(n + deform_sizes(&sim->deform).n_nodes), sizeof **points);
    balance_spheres(*points, &sim->spheres, sim->job->decomposition.weights, &sim->contacts.now,
                    &sim->candidates, &sim->facets);
    for (int b = 0; b < sim->deform.n; b++)
        n += balance_nodes(*points + n, &sim->deform.list[b].solid);
    return n;
}

int64_t redistribute_weight(const struct simulation *sim)
{
    struct rcb_point *points;
    int64_t sum = 0;
    const int n = weigh(sim, &points);
    for (int i = 0; i < n; i++)
        sum += points[i].weight;
    free(points);
    return sum;
}

/* The low level: boxes are cut anew where work has drifted apart, or at first. */
static void repartition(struct simulation *sim)
{
    struct rcb_point *points;
    const int n = weigh(sim, &points);
    rcb_partition(&sim->boxes, sim->comm, n, points);
    free(points);
    sim->runtime.repartitions++;
}

static bool has_fixed_grid(const struct simulation *sim)
{
    return sim->job->decomposition.fixed[0] > 0;
}

/* History of contacts that came with spheres from other ranks or from a file.  Where spheres
 * left the run, contacts with them end; their partner's rank cannot always know that before.
 * Returns how many are of spheres that are not near each other. */
static int restore(struct simulation *sim, int n, const struct contact_record *records,
                   bool some_left_run)
{
    const struct migrate *migrate = &sim->migrate;
    int n_strange = 0;
    for (int r = 0; r < n; r++) {
        const struct contact_record *record = &records[r];
        const int first = lookup_find(&migrate->lookup, record->first_id);
        const int second = lookup_find(&migrate->lookup, record->second_id);
        if (some_left_run && (first < 0 || second < 0))
            continue;
        if (first < 0 || second < 0 ||
            !contact_set_restore(&sim->contacts, &sim->candidates, &sim->spheres, record, first,
                                 second))
            n_strange++;
    }
    return n_strange;
}

static int restore_arrivals(struct simulation *sim, bool some_left_run)
{
    struct migrate *migrate = &sim->migrate;
    const int n = migrate->n_contacts;
    migrate->n_contacts = 0;
    return restore(sim, n, migrate->contacts, some_left_run);
}

int redistribute_restore(struct simulation *sim, int n, const struct contact_record *records)
{
    if (sim->comm->n_ranks == 1)
        return restore(sim, n, records, false);
    migrate_follow(&sim->migrate, sim->comm, n, records);
    return restore_arrivals(sim, false);
}

static void restore_facets(struct simulation *sim)
{
    struct migrate *migrate = &sim->migrate;
    int *spheres = array_allocate((size_t)migrate->n_facets, sizeof *spheres);
    for (int r = 0; r < migrate->n_facets; r++) {
        const int i = lookup_find(&migrate->lookup, migrate->facets[r].id);
        spheres[r] = i < sim->spheres.n_owned ? i : -1;
    }
    facet_contacts_forget(&sim->facets);
    facet_contacts_restore(&sim->facets, migrate->n_facets, migrate->facets, spheres);
    free(spheres);
}

/* Adapts how much speeds may ask for at the next search to how long lists are at this one; the
 * same on all ranks, as a ghost's allowance is its owner's.  Collective. */
static void adapt_allowances(struct simulation *sim)
{
    int64_t n = sim->candidates.n;
    comm_sum_int(sim->comm, &n, 1);
    const bool many = (double)n > CANDIDATES_MOST * (double)sim->n_spheres;
    const double most = sim->asked_most * (many ? SHORTER : LONGER);
    sim->asked_most = most < ASKED_LEAST      ? ASKED_LEAST
                      : most > ALLOWANCE_MOST ? ALLOWANCE_MOST
                                              : most;
}

/* Global search with the present owners and ghosts; moved as for contact_set_prune(). Returns
 * how many contacts that arrived do not fit. */
static int search(struct simulation *sim, const int *moved, bool some_left_run)
{
    struct spheres *spheres = &sim->spheres;
    const bool all_pairs = sim->job->force.search == JOB_SEARCH_ALL_PAIRS;
    spheres_pad(spheres);
    candidates_search(&sim->candidates, spheres, all_pairs);
    if (!all_pairs)
        adapt_allowances(sim);
    prune(sim, moved);
    const int n_strange = restore_arrivals(sim, some_left_run);
    facet_contacts_search(&sim->facets, spheres, &sim->bodies, sim->body_allowance, all_pairs);
    touch_search(sim, all_pairs);
    sections_search(&sim->sections, spheres);
    removals_search(&sim->removals, spheres);
    for (int i = 0; i < spheres->n_owned; i++) {
        for (int k = 0; k < 3; k++)
            spheres->searched_at[i][k] = sphere_position(spheres, i)[k];
    }
    sim->spent = (struct simulation_spent){0.0, 0.0, 0.0};
    sim->runtime.searches++;
    watch_searched(&sim->watch, sim);
    return n_strange;
}

/* The high level: spheres that crossed move, copies are made anew. */
static void update_subdomains(struct simulation *sim, bool moves, bool sort_all,
                              const unsigned char *removed, const struct contact_set *contacts)
{
    struct spheres *spheres = &sim->spheres;
    if (moves) {
        migrate_spheres(&sim->migrate, sim->comm, &sim->boxes, spheres, contacts, &sim->facets,
                        &sim->materials, removed, sort_all);
        sim->runtime.migrated += sim->migrate.n_left;
        sim->runtime.redistributions++;
    }
    choose_allowances(sim, 0, spheres->n_owned);
    halo_build(&sim->halo, sim->comm, &sim->boxes, spheres, &sim->materials, sim->half_buffer);
    choose_allowances(sim, spheres->n_owned, spheres->n_all);
    deform_agree(sim);
    choose_body_allowances(sim);
    deform_share_renew(sim);
    if (!moves)
        return;
    migrate_find_moved(&sim->migrate, spheres);
    if (sim->migrate.owned_moved)
        restore_facets(sim);
}

/* Brings all places into the domain, with note of who crossed a periodic boundary. */
static void wrap_places(struct simulation *sim)
{
    struct spheres *spheres = &sim->spheres;
    int turns[3];
    if (!spheres->periodic.any)
        return;
    observe_crossings(sim);
    for (int i = 0; i < spheres->n_owned; i++)
        periodic_wrap(&spheres->periodic, sphere_position(spheres, i), turns);
}

void redistribute(struct simulation *sim, const unsigned char *removed)
{
    const struct job *job = sim->job;
    runtime_begin(&sim->runtime);
    const bool renew = is_multiple(sim->step, job->order_every);
    deform_place_faces(sim);
    wrap_places(sim);
    if (renew)
        order_renew(&sim->spheres, sim->comm);
    const bool lost = balance_is_lost(&sim->balance, sim->comm, job->decomposition.imbalance);
    if (!has_fixed_grid(sim) && (lost || is_multiple(sim->step, job->force.repartition_every)))
        repartition(sim);
    runtime_end(&sim->runtime, RUNTIME_REPARTITION);
    const bool born = sim->insertions.n_new > 0;
    if (born)
        insertions_place(sim);
    const bool moves =
        sim->comm->n_ranks > 1 || renew || removed != NULL || born || sim->spheres.periodic.any;
    update_subdomains(sim, moves, renew, removed, &sim->contacts);
    migrate_forget_before(&sim->migrate);
    runtime_end(&sim->runtime, RUNTIME_REDISTRIBUTE);
    const int n_strange = search(sim, moves ? sim->migrate.moved : NULL, removed != NULL);
    CHECK(n_strange == 0, "%d contacts of spheres that are not here", n_strange);
    migrate_forget(&sim->migrate);
    runtime_end(&sim->runtime, RUNTIME_SEARCH);
}

void redistribute_first(struct simulation *sim)
{
    sim->asked_most = ASKED_LEAST;
    deform_place_faces(sim);
    if (has_fixed_grid(sim))
        boxes_set_grid(&sim->boxes, sim->job->decomposition.fixed, sim->job->domain.min,
                       sim->job->domain.max);
    else
        repartition(sim);
    boxes_update(&sim->boxes);
    update_subdomains(sim, true, true, NULL, NULL);
    spheres_fit(&sim->spheres);
    search(sim, sim->migrate.moved, false);
}

void redistribute_spend(struct simulation *sim, const double spent[2])
{
    const double by_bodies = bodies_spend(sim);
    sim->spent.bodies += by_bodies;
    sim->spent.search += spent[0] > by_bodies ? spent[0] : by_bodies;
    sim->spent.inner += spent[1];
    if (sim->spent.search <= 1.0)
        return;
    double most2 = 0.0;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double *x = sphere_position(&sim->spheres, i), *was = sim->spheres.searched_at[i];
        const double inverse = sim->spheres.inverse_allowance[i][0];
        const double dx = x[0] - was[0], dy = x[1] - was[1], dz = x[2] - was[2];
        const double share2 = (dx * dx + dy * dy + dz * dz) * inverse * inverse;
        most2 = share2 > most2 ? share2 : most2;
    }
    comm_max(sim->comm, &most2, 1);
    const double by_spheres = sqrt(most2);
    const double most = by_spheres > sim->spent.bodies ? by_spheres : sim->spent.bodies;
    if (most < SPENT_FINE)
        sim->spent.search = most;
}
