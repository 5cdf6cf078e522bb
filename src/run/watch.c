/* See watch.h. */
#include "run/watch.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "base/timer.h"
#include "job/job.h"
#include "model/rigid.h"
#include "physics/contact_geometry.h"
#include "physics/contact_law.h"
#include "physics/critical_step.h"
#include "run/control.h"
#include "run/simulation.h"
#include "run/solid_step.h"

/* Share of the overlap at rest by which a place may be rounded. */
static const double ROUNDING_BORNE = 0.01;
/* The part of its radius that a sphere may be in a sheet whose other side it comes out of: from
 * .18 on it is pushed the less the deeper it is, and beyond its middle to the other side.
 * (9.4) */
static const double THROUGH = 0.5;
/* Share of the critical step that is advised when a step is too large. */
static const double STEP_ADVISED = 0.5;

void watch_init(struct watch *watch, const struct job *job)
{
    *watch = (struct watch){.failure = WATCH_FINE};
    schedule_init(&watch->schedule, job, timer_now());
}

void watch_clear(struct watch *watch)
{
    free(watch->loads);
    watch->loads = NULL;
}

/* The first failure stands. */
static void fail(struct watch *watch, enum watch_failure failure)
{
    if (watch->failure == WATCH_FINE)
        watch->failure = failure;
}

/* --------------------------------------------------------------------------------------
 * contacts and places */

/* A touching contact: what it is, and how it is split between its spheres. */
struct split {
    struct critical_step_contact contact;
    struct critical_step_side side[2];
};

static struct split split_pair(const struct simulation *sim, int k)
{
    const struct contact_list *list = &sim->contacts.now;
    const struct spheres *spheres = &sim->spheres;
    const int i = list->first[k], j = list->second[k];
    const double w_i = sphere_inverse_mass(spheres, i), w_j = sphere_inverse_mass(spheres, j);
    const double u_i = sphere_curvature(spheres, i), u_j = sphere_curvature(spheres, j);
    const int pair = spheres->material[i] * sim->materials.n + spheres->material[j];
    return (struct split){
        critical_step_contact(&sim->materials.pairs[pair],
                              list->history[CONTACT_RADIUS_LANE][k], 1.0 / (w_i + w_j)),
        {critical_step_side(w_i, u_i, u_j), critical_step_side(w_j, u_j, u_i)}};
}

/* A contact with a body that yields: 1/m of the sphere, and so much more that the body's own
 * load by all of its contacts, divided evenly over time, is in it. (10.8) */
static double yielding_share(const struct critical_step_contact *contact, double share,
                             const struct critical_step_sums *load)
{
    const double k = load->stiffness / critical_step_stiffest(contact->stiffness);
    const double d = critical_step_stiffest(contact->damping) > 0.0
                         ? load->damping / critical_step_stiffest(contact->damping)
                         : 0.0;
    return share + (k > d ? k : d);
}

static struct split split_facet(const struct simulation *sim,
                                const struct facet_contact *contact)
{
    const struct spheres *spheres = &sim->spheres;
    const int i = contact->sphere, wall = sim->bodies.list[contact->body].material;
    const struct rigid *rigid = sim->bodies.list[contact->body].rigid;
    const double w = sphere_inverse_mass(spheres, i);
    const double yield =
        rigid != NULL ? rigid_yield_most(rigid, sphere_place(spheres, i)) : 0.0;
    struct split split = {
        critical_step_contact(
            &sim->materials.pairs[spheres->material[i] * sim->materials.n + wall],
            contact->history[CONTACT_RADIUS_LANE], 1.0 / (w + yield)),
        {critical_step_side(w, sphere_curvature(spheres, i), 0.0)}};
    if (rigid != NULL && sim->watch.loads != NULL)
        split.side[0].share = yielding_share(&split.contact, split.side[0].share,
                                             &sim->watch.loads[contact->body]);
    return split;
}

/* What contacts do to the bodies that forces move, exact over all ranks: any rank then judges
 * its spheres alone.  Nothing in jobs without such bodies.  Collective. */
static void load_bodies(const struct simulation *sim)
{
    const int n = sim->bodies.n;
    if (sim->bodies.n_forced == 0)
        return;
    struct exact_sum *sums = array_allocate(2 * (size_t)n, sizeof *sums);
    memset(sim->watch.loads, 0, (size_t)n * sizeof *sim->watch.loads);
    for (int k = 0; k < sim->facets.n; k++) {
        const struct facet_contact *contact = &sim->facets.list[k];
        const struct body *body = &sim->bodies.list[contact->body];
        if (!facet_contact_touched(contact) || body->rigid == NULL)
            continue;
        const struct vec3 x = sphere_place(&sim->spheres, contact->sphere);
        const double yield = rigid_yield_most(body->rigid, x);
        const struct critical_step_contact felt = split_facet(sim, contact).contact;
        exact_sum_add(&sums[2 * contact->body], critical_step_stiffest(felt.stiffness) * yield);
        exact_sum_add(&sums[2 * contact->body + 1],
                      critical_step_stiffest(felt.damping) * yield);
    }
    touch_load_bodies(&sim->touch, &sim->bodies, sums);
    exact_sum_reduce(sim->comm, sums, 2 * n);
    for (int b = 0; b < n; b++) {
        sim->watch.loads[b].stiffness = exact_sum_value(&sums[2 * b]);
        sim->watch.loads[b].damping = exact_sum_value(&sums[2 * b + 1]);
    }
    free(sums);
}

/* Adds each contact to the sums of the spheres in it.  Owned spheres have all of theirs here;
 * ghosts have not and are not looked at. */
static void sum_contacts(const struct simulation *sim, struct critical_step_sums *sums)
{
    const struct contact_list *list = &sim->contacts.now;
    for (int k = 0; k < list->n; k++) {
        if (!contact_touches(list, k))
            continue;
        const struct split split = split_pair(sim, k);
        critical_step_add(&sums[list->first[k]], &split.contact, &split.side[0]);
        critical_step_add(&sums[list->second[k]], &split.contact, &split.side[1]);
    }
    for (int k = 0; k < sim->facets.n; k++) {
        const struct facet_contact *contact = &sim->facets.list[k];
        if (!facet_contact_touched(contact))
            continue;
        const struct split split = split_facet(sim, contact);
        critical_step_add(&sums[contact->sphere], &split.contact, &split.side[0]);
    }
}

/* The matrices of the spheres that have a slot (else -1). */
static void fill_matrices(const struct simulation *sim, const int *slots,
                          struct critical_step_matrix *matrices)
{
    const struct contact_list *list = &sim->contacts.now;
    for (int k = 0; k < list->n; k++) {
        const int sides[2] = {list->first[k], list->second[k]};
        if (!contact_touches(list, k) || (slots[sides[0]] < 0 && slots[sides[1]] < 0))
            continue;
        const double *a = sphere_position(&sim->spheres, sides[0]),
                     *b = sphere_position(&sim->spheres, sides[1]);
        const struct vec3 between = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        const struct split split = split_pair(sim, k);
        for (int s = 0; s < 2; s++) {
            const struct vec3 n =
                vec3_scale((s == 0 ? 1.0 : -1.0) / vec3_norm(between), between);
            if (slots[sides[s]] >= 0)
                critical_step_add_matrix(&matrices[slots[sides[s]]], &split.contact,
                                         &split.side[s], (double[3]){n.x, n.y, n.z});
        }
    }
    for (int k = 0; k < sim->facets.n; k++) {
        const struct facet_contact *contact = &sim->facets.list[k];
        if (!facet_contact_touched(contact) || slots[contact->sphere] < 0)
            continue;
        body_renew_face(&sim->bodies.list[contact->body], contact->feature);
        const struct vec3 n =
            contact_geometry_closest(&sim->bodies.list[contact->body].mesh, contact->feature,
                                     sphere_place(&sim->spheres, contact->sphere))
                .normal; /* from the feature to the centre */
        const struct split split = split_facet(sim, contact);
        critical_step_add_matrix(&matrices[slots[contact->sphere]], &split.contact,
                                 &split.side[0], (double[3]){-n.x, -n.y, -n.z});
    }
}

/* The critical step of the present contacts of this rank's spheres, where it is below `doubt`
 * [s]; else infinite.  Sums settle it for most spheres. */
static double find_critical(const struct simulation *sim, double doubt)
{
    const size_t n_all = (size_t)sim->spheres.n_all;
    struct critical_step_sums *sums = array_allocate(n_all, sizeof *sums);
    int *slots = array_allocate(n_all, sizeof *slots), n = 0;
    double least = INFINITY;
    sum_contacts(sim, sums);
    for (int i = 0; i < sim->spheres.n_all; i++) {
        const bool doubtful =
            i < sim->spheres.n_owned && critical_step_of_sums(&sums[i]) < doubt;
        slots[i] = doubtful ? n++ : -1;
    }
    if (n > 0) {
        struct critical_step_matrix *matrices = array_allocate((size_t)n, sizeof *matrices);
        fill_matrices(sim, slots, matrices);
        for (int m = 0; m < n; m++) {
            if (!(critical_step_load(&matrices[m], doubt) > 1.0))
                continue;
            const double critical = critical_step_of_matrix(&matrices[m]);
            least = critical < least ? critical : least;
        }
        free(matrices);
    }
    free(slots);
    free(sums);
    return least;
}

/* The least that sums alone allow on any rank [s]. */
static double find_least_of_sums(const struct simulation *sim)
{
    struct critical_step_sums *sums = array_allocate((size_t)sim->spheres.n_all, sizeof *sums);
    double least = INFINITY;
    sum_contacts(sim, sums);
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double step = critical_step_of_sums(&sums[i]);
        least = step < least ? step : least;
    }
    free(sums);
    comm_min(sim->comm, &least, 1);
    return least;
}

double watch_critical_step(const struct simulation *sim)
{
    enum { SUMS_OFF_BY = 3 }; /* what matrices allow at most, in what sums allow */
    load_bodies(sim);
    const double most = SUMS_OFF_BY * find_least_of_sums(sim);
    double critical = find_critical(sim, most);
    comm_min(sim->comm, &critical, 1);
    return critical < most ? critical : most;
}

/* Nobody leaves along a periodic direction. */
static bool is_outside(const struct simulation *sim, const double *x)
{
    const struct vec3 low = sim->job->domain.min, high = sim->job->domain.max;
    const double least[3] = {low.x, low.y, low.z}, most[3] = {high.x, high.y, high.z};
    bool inside = true;
    for (int k = 0; k < 3; k++)
        inside =
            inside && ((x[k] >= least[k] && x[k] <= most[k]) || sim->spheres.periodic.along[k]);
    return !inside;
}

/* The overlap that must be resolved: that of the sphere at rest on the stiffest partner;
 * without gravity there is none, and a small one is taken [m]. */
static double least_overlap(const struct simulation *sim, int i)
{
    enum { WEIGHTLESS = 100000 }; /* radii over overlap: of gentle impacts of stiff spheres */
    const struct materials *materials = &sim->materials;
    const double g = vec3_norm(sim->gravity), radius = sphere_radius(&sim->spheres, i);
    const struct material_pair *stiffest = NULL;
    for (int m = 0; m < materials->n; m++) {
        const struct material_pair *pair =
            &materials->pairs[sim->spheres.material[i] * materials->n + m];
        if (pair->normal > 0.0 && (stiffest == NULL || pair->normal > stiffest->normal))
            stiffest = pair;
    }
    if (!(g > 0.0) || stiffest == NULL)
        return radius / WEIGHTLESS;
    return critical_step_rest_overlap(stiffest, g / sphere_inverse_mass(&sim->spheres, i),
                                      1.0 / radius);
}

/* The largest step between neighbouring numbers at any sphere's place, over what its contacts
 * can bear: a hundredth of the overlap at rest. (9.3) */
static double find_rounding(const struct simulation *sim)
{
    const struct spheres *spheres = &sim->spheres;
    double most = 0.0, known_radius = 0.0, overlap = 0.0;
    int known_material = -1;
    for (int i = 0; i < spheres->n_owned; i++) {
        const double *x = sphere_position(spheres, i), radius = sphere_radius(spheres, i);
        double far = 0.0;
        for (int k = 0; k < 3; k++) {
            const double bound = spheres->periodic.quantum[k] * 0x1p52;
            far = fabs(x[k]) > far ? fabs(x[k]) : far;
            far = bound > far ? bound : far;
        }
        if (radius != known_radius || spheres->material[i] != known_material) {
            known_radius = radius;
            known_material = spheres->material[i];
            overlap = least_overlap(sim, i);
        }
        const double share = far * 0x1p-52 / (ROUNDING_BORNE * overlap);
        if (share > most && !is_outside(sim, x))
            most = share;
    }
    return most;
}

/* The step against what bodies that deform allow; of those that touch alone, if `touched`. */
static void watch_solids(struct watch *watch, const struct simulation *sim, bool touched)
{
    const struct deform_limit limit = deform_critical_step(sim, touched);
    if (sim->dt <= sim->job->watch.step * limit.step)
        return;
    fail(watch, WATCH_SOLID_STEP);
    const int n = deform_name_limit(sim, &limit, watch->what, (int)sizeof watch->what);
    if (n > 0)
        snprintf(watch->what + n, sizeof watch->what - (size_t)n,
                 ": time.step = %.4g s is %.3g of the critical step there%s, %.4g s; set "
                 "time.step to %.2g s or less, or to auto",
                 sim->dt, sim->dt / limit.step, limit.node >= 0 ? " with its contacts" : "",
                 limit.step, critical_step_round_down(STEP_ADVISED * limit.step));
}

void watch_contacts(struct watch *watch, const struct simulation *sim)
{
    const bool looks = sim->step % WATCH_CONTACTS_EVERY == 0;
    if (!looks && !watch->doubts_nodes)
        return;
    load_bodies(sim);
    watch_solids(watch, sim, !looks);
    if (!looks)
        return;
    watch->rate = 1.0 / find_critical(sim, sim->dt / sim->job->watch.step);
    watch->rounding = find_rounding(sim);
}

/* --------------------------------------------------------------------------------------
 * motion */

void watch_searched(struct watch *watch, const struct simulation *sim)
{
    double most = 0.0;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double share = sim->spheres.allowance[i] / sphere_radius(&sim->spheres, i);
        most = share > most ? share : most;
    }
    watch->allowance_most = most;
}

void watch_bodies(struct watch *watch, const struct simulation *sim)
{
    double radius_least = 1e300;
    for (int k = 0; k < sim->insertions.n; k++) {
        const double radius = sim->insertions.list[k].sizes.min;
        radius_least = radius < radius_least ? radius : radius_least;
    }
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double radius = sphere_radius(&sim->spheres, i);
        radius_least = radius < radius_least ? radius : radius_least;
    }
    comm_min(sim->comm, &radius_least, 1);
    watch->radius_least = radius_least;
    if (sim->bodies.n_forced > 0)
        watch->loads = array_allocate((size_t)sim->bodies.n, sizeof *watch->loads);
    for (int b = 0; b < sim->bodies.n && watch->failure == WATCH_FINE; b++) {
        const struct body *body = &sim->bodies.list[b];
        const bool runs = body->surface_speed_max > body->speed_max;
        const double speed = runs ? body->surface_speed_max : body->speed_max;
        const double motion = speed * sim->dt / radius_least;
        if (motion <= sim->job->watch.motion)
            continue;
        fail(watch, WATCH_MOTION);
        watch->motion = motion;
        snprintf(watch->what, sizeof watch->what,
                 "%sbody '%.60s' moves %.3g of the least radius in a step",
                 runs ? "the surface of " : "", body->name, motion);
    }
}

void watch_elements(struct watch *watch, const struct simulation *sim)
{
    if (sim->deform.n == 0)
        return;
    watch->doubts_nodes = sim->dt > solid_step_safe(sim->job, &sim->bodies);
    watch_solids(watch, sim, false);
}

void watch_forced(struct watch *watch, const struct simulation *sim)
{
    for (int b = 0; sim->bodies.n_forced > 0 && b < sim->bodies.n; b++) {
        const struct body *body = &sim->bodies.list[b];
        const double motion = body->speed_max * sim->dt / watch->radius_least;
        if (body->rigid == NULL || motion <= sim->job->watch.motion)
            continue;
        fail(watch, motion == motion ? WATCH_MOTION : WATCH_NOT_A_NUMBER);
        watch->motion = motion;
        snprintf(watch->what, sizeof watch->what,
                 "body '%.60s' moves %.3g of the least radius in a step", body->name, motion);
        return;
    }
}

/* The largest motion of the step just done over radius; 0 where the allowances, of which
 * `spent` has been used in this step, show that none comes near the limit.  What is found
 * therefore does not depend on the last search.  (9.1) */
static double find_motion(struct watch *watch, const struct simulation *sim, double spent)
{
    const struct spheres *spheres = &sim->spheres;
    if (spent * watch->allowance_most <= 0.9 * sim->job->watch.motion)
        return 0.0;
    double most2 = 0.0;
    int worst = -1;
    for (int i = 0; i < spheres->n_owned; i++) {
        const double *v = sphere_velocity(spheres, i), curvature = sphere_curvature(spheres, i);
        const double share2 =
            (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]) * (curvature * curvature);
        if (share2 > most2) {
            most2 = share2;
            worst = i;
        }
    }
    const double most = sqrt(most2) * sim->dt;
    if (worst >= 0 && most > sim->job->watch.motion)
        snprintf(watch->what, sizeof watch->what,
                 "sphere %lld moves %.3g of its radius in a step",
                 (long long)spheres->id[worst], most);
    return most;
}

/* --------------------------------------------------------------------------------------
 * agreement */

/* This rank's reason to stop. */
static enum watch_stop wish_to_stop(struct watch *watch, const struct simulation *sim)
{
    if (watch->stop_asked == WATCH_STOP_LOST)
        return WATCH_STOP_LOST;
    if (sim->comm->rank == 0 && schedule_is_over(&watch->schedule, timer_now()))
        return WATCH_STOP_TIME;
    return control_asked() != 0 ? WATCH_STOP_SIGNAL : watch->stop_asked;
}

void watch_agree(struct watch *watch, struct simulation *sim, double spent[2], bool bad)
{
    enum {
        SPENT_SEARCH,
        SPENT_INNER,
        SPENT_DEFORM,
        OVERLAP,
        DEPTH,
        MOTION,
        BAD,
        ELEMENT,
        RATE,
        ROUNDING,
        STOP,
        CHECKPOINT,
        N_VALUES
    };
    const double pairs = sim->overlap_max, facets = sim->facets.overlap_max;
    const bool due = sim->comm->rank == 0 && schedule_is_due(&watch->schedule, timer_now());
    const double motion = find_motion(watch, sim, spent[0]);
    double values[N_VALUES] = {
        [SPENT_SEARCH] = spent[0],
        [SPENT_INNER] = spent[1],
        [SPENT_DEFORM] = sim->deform.spent,
        [OVERLAP] = pairs > facets ? pairs : facets,
        [DEPTH] = sim->facets.through_max,
        [MOTION] = motion,
        [BAD] = bad ? 1.0 : 0.0,
        [ELEMENT] = sim->deform.failed ? 1.0 : 0.0,
        [RATE] = watch->rate,
        [ROUNDING] = watch->rounding,
        [STOP] = (double)wish_to_stop(watch, sim),
        [CHECKPOINT] = due ? 1.0 : 0.0,
    };
    comm_max(sim->comm, values, N_VALUES);
    spent[0] = values[SPENT_SEARCH];
    spent[1] = values[SPENT_INNER];
    sim->deform.spent = values[SPENT_DEFORM];
    watch->overlap = values[OVERLAP];
    watch->motion = values[MOTION];
    watch->rate = watch->rounding = 0.0;
    watch->stop = (enum watch_stop)values[STOP];
    watch->checkpoint_due = watch->checkpoint_due || values[CHECKPOINT] > 0.0;
    /* What fails later in this list often follows from what fails earlier. */
    if (values[ROUNDING] > 1.0)
        fail(watch, WATCH_FAR);
    if (sim->dt * values[RATE] > sim->job->watch.step)
        fail(watch, WATCH_STEP);
    if (watch->overlap > sim->job->watch.overlap || values[DEPTH] > THROUGH)
        fail(watch, WATCH_OVERLAP);
    if (watch->motion > sim->job->watch.motion && !isinf(watch->motion))
        fail(watch, WATCH_MOTION);
    if (values[BAD] > 0.0 || !(spent[0] >= 0.0) || !(watch->overlap >= 0.0))
        fail(watch, WATCH_NOT_A_NUMBER);
    if (values[ELEMENT] > 0.0)
        fail(watch, WATCH_ELEMENT);
}

void watch_full(struct watch *watch, const char *what)
{
    fail(watch, WATCH_FULL);
    snprintf(watch->what, sizeof watch->what, "%s", what);
}

void watch_energy(struct watch *watch, const struct simulation *sim)
{
    const double limit = sim->job->watch.energy, error = sim->observe.energy_error;
    if (!sim->job->energy_ledger)
        return;
    if (sim->deform.hourglass)
        fail(watch, WATCH_HOURGLASS);
    if (error != error)
        fail(watch, WATCH_SUMS);
    else if (limit > 0.0 && error > limit)
        fail(watch, WATCH_ENERGY);
}

/* --------------------------------------------------------------------------------------
 * leavers */

int64_t watch_leavers(struct watch *watch, struct simulation *sim, unsigned char *removed)
{
    int64_t n = 0;
    int first = -1;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        if (removed[i] || !is_outside(sim, sphere_position(&sim->spheres, i)))
            continue;
        removed[i] = 1;
        n++;
        first = first < 0 ? i : first;
        tally_add(&sim->removals.leavers, &sim->spheres, i);
    }
    if (first >= 0) {
        const double *x = sphere_position(&sim->spheres, first);
        snprintf(watch->what, sizeof watch->what, "sphere %lld is at (%.4g, %.4g, %.4g) m",
                 (long long)sim->spheres.id[first], x[0], x[1], x[2]);
    }
    comm_sum_int(sim->comm, &n, 1);
    if (n > 0 && sim->job->domain.leavers == JOB_LEAVERS_STOP) {
        fail(watch, WATCH_LEAVER);
        return 0;
    }
    watch->what[0] = '\0';
    return n;
}

/* --------------------------------------------------------------------------------------
 * diagnosis */

static void find_bad(const struct simulation *sim, char *what, size_t size)
{
    for (int i = 0; i < sim->spheres.n_owned && what[0] == '\0'; i++) {
        const double *motion = sim->spheres.motion[i].lane, *spin = sim->spheres.spin[i].lane;
        double sum = 0.0;
        for (int k = 0; k < 8; k++)
            sum += motion[k] + spin[k];
        if (!(sum - sum == 0.0))
            snprintf(what, size, "sphere %lld", (long long)sim->spheres.id[i]);
    }
}

/* The deepest contact of the last forces, on this rank; places have moved on since. */
struct deepest {
    double overlap;  /* over radius, as watched [-] */
    double softness; /* by how much stiffer it should be [-] */
    bool approaches;
    char what[160];
};

/* Overlap [m] of the last forces: of Hertz's contact from its radius, else from places, which
 * have moved on by a step. */
static double overlap_of(const struct material_pair *pair, double contact_radius,
                         double inverse_radius, double now)
{
    return pair->linear > 0.0 ? now : contact_radius * contact_radius * inverse_radius;
}

/* Stiffness over the present one with which the motion that is left would end at the limit:
 * the elastic energy there grows with the stiffness alone.  (9.2) */
static void judge_stiffness(struct deepest *deepest, const struct material_pair *pair,
                            double overlap, double inverse_radius, double mass, double speed,
                            double limit)
{
    const double held = contact_law_normal_energy(overlap, inverse_radius, pair);
    const double borne =
        contact_law_normal_energy(overlap * limit / deepest->overlap, inverse_radius, pair);
    deepest->approaches = speed < 0.0;
    deepest->softness =
        (held + (deepest->approaches ? 0.5 * mass * speed * speed : 0.0)) / borne;
}

static void find_deepest_pair(const struct simulation *sim, struct deepest *deepest)
{
    const struct contact_list *list = &sim->contacts.now;
    const struct spheres *spheres = &sim->spheres;
    for (int k = 0; k < list->n; k++) {
        if (!contact_touches(list, k))
            continue;
        const int i = list->first[k], j = list->second[k];
        const double *a = sphere_position(spheres, i), *b = sphere_position(spheres, j);
        const double curvature = sphere_curvature(spheres, i) + sphere_curvature(spheres, j);
        const struct material_pair *pair =
            &sim->materials
                 .pairs[spheres->material[i] * sim->materials.n + spheres->material[j]];
        const struct vec3 between = {b[0] - a[0], b[1] - a[1], b[2] - a[2]};
        const double overlap = overlap_of(
            pair, list->history[CONTACT_RADIUS_LANE][k], curvature,
            sphere_radius(spheres, i) + sphere_radius(spheres, j) - vec3_norm(between));
        const double relative = 0.5 * overlap * curvature;
        if (relative <= deepest->overlap)
            continue;
        /* Not a number where two centres were in one place. */
        deepest->overlap = relative == relative ? relative : sim->watch.overlap;
        snprintf(deepest->what, sizeof deepest->what,
                 "spheres %lld and %lld near (%.4g, %.4g, %.4g) m", (long long)spheres->id[i],
                 (long long)spheres->id[j], a[0], a[1], a[2]);
        judge_stiffness(deepest, pair, overlap, curvature,
                        1.0 /
                            (sphere_inverse_mass(spheres, i) + sphere_inverse_mass(spheres, j)),
                        list->history[CONTACT_LAW_VELOCITY][k], sim->job->watch.overlap);
    }
}

/* Overlap of an entry of the last forces; where a body deforms at least how far it is in by now
 * [m]. */
static double overlap_of_facet(const struct simulation *sim, int entry)
{
    const struct facet_contact *contact = &sim->facets.list[entry];
    const struct spheres *spheres = &sim->spheres;
    const struct body *body = &sim->bodies.list[contact->body];
    const int i = contact->sphere;
    if (body->skin != NULL) {
        const double reach = facet_contacts_reach(&sim->facets, spheres, &sim->bodies, entry);
        return reach > contact->overlap ? reach : contact->overlap;
    }
    const double distance =
        contact_geometry_closest(&body->mesh, contact->feature, sphere_place(spheres, i))
            .distance;
    return overlap_of(
        &sim->materials.pairs[spheres->material[i] * sim->materials.n + body->material],
        contact->history[CONTACT_RADIUS_LANE], sphere_curvature(spheres, i),
        sphere_radius(spheres, i) - distance);
}

static void find_deepest_facet(const struct simulation *sim, struct deepest *deepest)
{
    const struct spheres *spheres = &sim->spheres;
    for (int k = 0; k < sim->facets.n; k++) {
        const struct facet_contact *contact = &sim->facets.list[k];
        if (!facet_contact_touched(contact))
            continue;
        const int i = contact->sphere;
        const struct body *body = &sim->bodies.list[contact->body];
        const struct material_pair *pair =
            &sim->materials.pairs[spheres->material[i] * sim->materials.n + body->material];
        const struct vec3 x = sphere_place(spheres, i);
        const double curvature = sphere_curvature(spheres, i);
        const double overlap = overlap_of_facet(sim, k);
        if (!(overlap * curvature > deepest->overlap))
            continue;
        deepest->overlap = overlap * curvature;
        snprintf(deepest->what, sizeof deepest->what,
                 "sphere %lld at (%.4g, %.4g, %.4g) m and body '%.40s'",
                 (long long)spheres->id[i], x.x, x.y, x.z, body->name);
        judge_stiffness(deepest, pair, overlap, curvature,
                        1.0 / sphere_inverse_mass(spheres, i),
                        contact->history[CONTACT_LAW_VELOCITY], sim->job->watch.overlap);
    }
}

/* The deepest contact of all ranks, on all ranks. */
static struct deepest find_deepest(const struct simulation *sim)
{
    struct deepest own = {0}, deepest;
    find_deepest_pair(sim, &own);
    find_deepest_facet(sim, &own);
    struct deepest *all = array_allocate((size_t)sim->comm->n_ranks, sizeof *all);
    comm_gather_all(sim->comm, &own, all, sizeof own);
    deepest = all[0];
    for (int q = 1; q < sim->comm->n_ranks; q++)
        deepest = all[q].overlap > deepest.overlap ? all[q] : deepest;
    free(all);
    return deepest;
}

double watch_deepest(const struct simulation *sim, char *what, size_t size)
{
    const struct deepest deepest = find_deepest(sim);
    snprintf(what, size, "%s", deepest.what);
    return deepest.overlap;
}

/* The first rank's words that has any, on all ranks. */
static void tell_all(const struct comm *comm, char *what, size_t size)
{
    char *all = array_allocate((size_t)comm->n_ranks, size);
    comm_gather_all(comm, what, all, size);
    for (int q = comm->n_ranks - 1; q >= 0; q--) {
        if (all[(size_t)q * size] != '\0')
            memcpy(what, all + (size_t)q * size, size);
    }
    free(all);
}

/* A body that was not there before the step just done; NULL where there is none. */
static const char *find_appeared(const struct simulation *sim)
{
    for (int b = 0; b < sim->bodies.n; b++) {
        const struct body *body = &sim->bodies.list[b];
        if (body->comes_and_goes && sim->step > 1 &&
            body_exists(body, sim->step - 1, sim->dt) &&
            !body_exists(body, sim->step - 2, sim->dt))
            return body->name;
    }
    return NULL;
}

/* An overlap has one of three causes; at a stable step and after the start the contact is too
 * soft. */
static void explain_overlap(const struct simulation *sim, const char *when,
                            const struct deepest *deepest)
{
    const double limit = sim->job->watch.overlap;
    if (sim->step <= 1)
        report_error("overlap at the start: %s overlap by %.3g of a radius, more than "
                     "watch.overlap = %.3g; place them farther apart",
                     deepest->what, deepest->overlap, limit);
    else if (deepest->overlap <= limit)
        report_error("contact too soft at %s: %s overlap by %.3g of a radius, more than the "
                     "body is thick, so that the sphere goes through; use a larger young, "
                     "twice say, a greater thickness, or lower speeds and loads",
                     when, deepest->what, deepest->overlap);
    else if (deepest->approaches)
        report_error("contact too soft at %s: %s overlap by %.3g of a radius, more than "
                     "watch.overlap = %.3g, and still approach; use young at least %.2g times "
                     "as large, or lower speeds and loads",
                     when, deepest->what, deepest->overlap, limit, 1.1 * deepest->softness);
    else
        report_error("contact too soft at %s: %s overlap by %.3g of a radius, more than "
                     "watch.overlap = %.3g; use a larger young, twice say, or lower loads",
                     when, deepest->what, deepest->overlap, limit);
}

static void explain_step(const struct simulation *sim, const char *when, double critical,
                         const struct deepest *deepest, const char *what)
{
    report_error("step too large at %s: time.step = %.4g s is %.3g of the critical step of the "
                 "present contacts, %.4g s%s%s; the deepest, %s, overlap by %.2g of a radius; "
                 "set time.step to %.2g s or less, or to auto, and start with --fresh",
                 when, sim->dt, sim->dt / critical, critical, what[0] != '\0' ? "; " : "", what,
                 deepest->what, deepest->overlap,
                 critical_step_round_down(STEP_ADVISED * critical));
}

static void explain_others(enum watch_failure failure, const struct simulation *sim,
                           const char *when, const char *what)
{
    switch (failure) {
    case WATCH_NOT_A_NUMBER:
        report_error("not a number at %s: %s has no place or velocity any more; look for "
                     "speeds, stiffnesses and masses that are not meant",
                     when, what);
        break;
    case WATCH_MOTION:
        report_error(
            "motion too fast at %s: %s, more than watch.motion = %.3g, so contacts "
            "could be missed; use time.step = %.2g s or less, or lower speeds",
            when, what, sim->job->watch.motion,
            critical_step_round_down(sim->dt * sim->job->watch.motion / sim->watch.motion));
        break;
    case WATCH_FAR:
        report_error("too far from the origin at %s: places are rounded to more than %.2g of "
                     "the overlap at rest; shift the scene towards the origin",
                     when, ROUNDING_BORNE);
        break;
    case WATCH_LEAVER:
        report_error("sphere left the domain at %s: %s; close the bodies, enlarge domain.min "
                     "and domain.max, or set domain.leavers to remove or ignore",
                     when, what);
        break;
    case WATCH_FULL:
        report_error(
            "region full at %s: %s; enlarge it, let spheres leave it faster, lower the "
            "rate, or set when_full to wait",
            when, what);
        break;
    case WATCH_ENERGY:
        report_error("energy balance at %s: off by %.3g of the energy turned over, more than "
                     "watch.energy = %.3g, so the step is too large for these impacts; use a "
                     "time.step half as large, or auto",
                     when, sim->observe.energy_error, sim->job->watch.energy);
        break;
    case WATCH_SUMS:
        report_error("a force or energy at %s is beyond 1e18; check the units of the job",
                     when);
        break;
    case WATCH_ELEMENT:
        report_error(
            "solid failed at %s: %s; lower the loads or speeds, make the mesh finer or "
            "more regular, or time.step smaller",
            when, what);
        break;
    case WATCH_SOLID_STEP:
        report_error("step too large at %s: %s, and start with --fresh; softer contacts and "
                     "coarser elements allow more",
                     when, what);
        break;
    case WATCH_HOURGLASS:
        report_error(
            "hourglass modes at %s: %s, more than watch.hourglass = %.3g; make the mesh finer "
            "where it is loaded, or the load less concentrated",
            when, what, sim->job->watch.hourglass);
        break;
    case WATCH_FINE:
    case WATCH_OVERLAP:
    case WATCH_STEP:
    default:
        break;
    }
}

void watch_explain(const struct watch *watch, const struct simulation *sim)
{
    struct watch own = *watch;
    char when[64];
    if (watch->failure == WATCH_FINE)
        return;
    if (watch->failure == WATCH_NOT_A_NUMBER)
        find_bad(sim, own.what, sizeof own.what);
    tell_all(sim->comm, own.what, sizeof own.what);
    const struct deepest deepest = find_deepest(sim);
    const double critical = watch_critical_step(sim);
    snprintf(when, sizeof when, "step %lld (%.6g s)", (long long)sim->step,
             (double)sim->step * sim->dt);
    /* Spheres in one place have no normal between them: what comes of it is not a number. */
    const bool too_deep =
        watch->failure == WATCH_OVERLAP ||
        ((watch->failure == WATCH_NOT_A_NUMBER || watch->failure == WATCH_SUMS) &&
         deepest.overlap > sim->job->watch.overlap);
    const char *appeared = find_appeared(sim);
    const bool starts_deep = too_deep && sim->step <= 1;
    const bool by_contacts = watch->failure != WATCH_FAR && watch->failure != WATCH_LEAVER &&
                             watch->failure != WATCH_FULL && watch->failure != WATCH_ELEMENT &&
                             watch->failure != WATCH_HOURGLASS &&
                             watch->failure != WATCH_SOLID_STEP;
    /* Whatever rang: beyond the critical step the step is to blame. */
    if (appeared != NULL && deepest.overlap > 0.0 && watch->failure != WATCH_LEAVER)
        report_error("body '%s' appeared where spheres are, at %s: %s overlap by %.3g of a "
                     "radius; clear its place first, or let it come at another time",
                     appeared, when, deepest.what, deepest.overlap);
    else if (watch->failure == WATCH_STEP ||
             (sim->dt > critical && by_contacts && !starts_deep))
        explain_step(sim, when, critical, &deepest, own.what);
    else if (too_deep)
        explain_overlap(sim, when, &deepest);
    else
        explain_others(watch->failure, sim, when, own.what);
}
