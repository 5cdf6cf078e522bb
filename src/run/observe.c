/* See observe.h. */
#include "run/observe.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/rigid.h"
#include "physics/contact_law.h"
#include "run/reactions.h"
#include "run/simulation.h"

/* Energies of one instant, in the order of the table's columns. */
enum energy {
    ENERGY_TRANSLATION,
    ENERGY_ROTATION,
    ENERGY_POTENTIAL,
    ENERGY_ELASTIC,
    ENERGY_FRICTION,
    ENERGY_DAMPING,
    ENERGY_TANGENTIAL,
    ENERGY_PLASTIC, /* by plastic flow of bodies that deform; a column where there are any */
    ENERGY_WORK,    /* put in by prescribed motion */
    N_ENERGIES,
    ENERGY_SPRINGS = N_ENERGIES, /* of the elastic, that in springs with a memory */
    N_SUMMED,
};

static const double OVERLAP_SCALE = 0x1p40;
/* Half of the unit of an exact sum. [J] */
static const double SUM_ROUNDING = 0x1p-71;

/* What comes into the run and leaves it. */
static void add_exchange_columns(struct series *table, const struct simulation *sim)
{
    const struct job *job = sim->job;
    for (int k = 0; k < sim->insertions.n; k++) {
        const char *name = job->insertions[k].name;
        const bool by_mass = job->insertions[k].by_mass;
        series_add_column(table, by_mass ? "kg" : "1", "what its rate asks for so far",
                          "%s.%s_asked", name, by_mass ? "mass" : "count");
        tally_add_columns(&sim->insertions.list[k].tally.split, job, table, name, "_inserted",
                          "that came in");
    }
    for (int k = 0; k < sim->removals.n; k++)
        tally_add_columns(&sim->removals.list[k].taken.split, job, table, job->removals[k].name,
                          "_removed", "that were taken out");
    if (job->domain.leavers == JOB_LEAVERS_REMOVE)
        tally_add_columns(&sim->removals.leavers.split, job, table, "domain", "_left",
                          "that left the domain");
}

/* Where a body that forces move is, and how fast. */
static void add_forced_columns(struct series *table, const struct body *body)
{
    static const char axes[] = "xyz", parts[] = "wxyz";
    const bool turns = body->rigid->kind == RIGID_TURN;
    if (body->rigid->kind != RIGID_FREE) {
        series_add_column(table, turns ? "rad" : "m", "from the place at the start", "%s.way",
                          body->name);
        series_add_column(table, turns ? "rad/s" : "m/s", "along or about the axis", "%s.speed",
                          body->name);
        return;
    }
    for (int k = 0; k < 3; k++)
        series_add_column(table, "m", "centre of mass", "%s.centre_%c", body->name, axes[k]);
    for (int k = 0; k < 4; k++)
        series_add_column(table, "1", "orientation since the start, a unit quaternion",
                          "%s.turn_%c", body->name, parts[k]);
    for (int k = 0; k < 3; k++)
        series_add_column(table, "m/s", "velocity of the centre", "%s.velocity_%c", body->name,
                          axes[k]);
    for (int k = 0; k < 3; k++)
        series_add_column(table, "kg m2/s", "angular momentum about the centre",
                          "%s.momentum_%c", body->name, axes[k]);
}

/* Is there work to tell of a body: does it move, or its surface run, as prescribed? */
static bool has_work(const struct simulation *sim, int b)
{
    const struct body *body = &sim->bodies.list[b];
    return sim->job->energy_ledger && body->rigid == NULL && body->skin == NULL &&
           (body->moves || body->surface != NULL);
}

void observe_init(struct observe *observe, const struct simulation *sim)
{
    *observe = (struct observe){0};
    observe->work_before = array_allocate((size_t)sim->bodies.n, sizeof *observe->work_before);
    struct series *table = &observe->table;
    series_init(table, "series");
    series_add_column(table, "1", "steps done", "step");
    series_add_column(table, "s", "simulated time", "time");
    series_add_column(table, "1", "spheres in the run", "n_spheres");
    series_add_column(table, "J", "kinetic energy of translation", "kinetic_translation");
    series_add_column(table, "J", "kinetic energy of rotation", "kinetic_rotation");
    series_add_column(table, "J", "potential energy in gravity, zero at the origin",
                      "potential");
    series_add_column(table, "J", "elastic energy in contacts", "elastic");
    series_add_column(table, "J", "dissipated by friction", "dissipated_friction");
    series_add_column(table, "J", "dissipated by contact and background damping",
                      "dissipated_damping");
    series_add_column(table, "J", "lost by the tangential law as its stiffness changes",
                      "dissipated_tangential");
    if (sim->deform.n > 0)
        series_add_column(table, "J", "dissipated by plastic flow", "dissipated_plastic");
    series_add_column(
        table, "J",
        "work of prescribed motion on the spheres, of forces applied to bodies and of gravity "
        "that changes",
        "work_bodies");
    series_add_column(table, "J", "energy carried away by spheres that left", "removed_energy");
    series_add_column(table, "J", "energy carried in by spheres that came in",
                      "inserted_energy");
    series_add_column(table, "J",
                      "energy now, dissipated and carried away, less energy at the start, "
                      "carried in and work",
                      "balance");
    series_add_column(table, "1", "largest overlap over radius since the row before",
                      "overlap_max");
    series_add_column(table, "m/s", "largest speed", "speed_max");
    series_add_column(table, "1", "touching pairs of spheres", "n_contacts");
    series_add_column(table, "1", "touching pairs of sphere and facet feature",
                      "n_facet_contacts");
    for (int b = 0; b < sim->bodies.n; b++) {
        static const char axes[] = "xyz";
        for (int k = 0; k < 3; k++)
            series_add_column(table, "N", "force on the body, mean since the row before",
                              "%s.force_%c", sim->bodies.list[b].name, axes[k]);
        for (int k = 0; k < 3; k++)
            series_add_column(table, "N m",
                              "torque on the body about the origin, mean since the row before",
                              "%s.torque_%c", sim->bodies.list[b].name, axes[k]);
        if (has_work(sim, b))
            series_add_column(table, "J", "work of the body's prescribed motion on the spheres",
                              "%s.work", sim->bodies.list[b].name);
        if (sim->bodies.list[b].rigid != NULL)
            add_forced_columns(table, &sim->bodies.list[b]);
    }
    reactions_add_columns(sim, table);
    probes_add_columns(&sim->probes, table);
    for (int s = 0; s < sim->sections.n; s++) {
        const char *name = sim->sections.list[s].name;
        const struct tally *passed = sim->sections.counts[s].passed;
        tally_add_columns(&passed[0].split, sim->job, table, name, "_forward",
                          "that passed along the normal");
        tally_add_columns(&passed[1].split, sim->job, table, name, "_backward",
                          "that passed against the normal");
    }
    contents_add_columns(&sim->contents, sim->job, table);
    add_exchange_columns(table, sim);
}

void observe_clear(struct observe *observe)
{
    series_clear(&observe->table);
    free(observe->work_before);
}

void observe_before(struct simulation *sim)
{
    for (int b = 0; b < sim->bodies.n; b++)
        sim->observe.work_before[b] = sim->facets.loads[b].work;
}

/* Half-step velocity brought to the step by half of what the step will add.
 * (5.4) */
void observe_motion(const struct simulation *sim, int i, double v[3], double w[3])
{
    const double *motion = sim->spheres.motion[i].lane, *spin = sim->spheres.spin[i].lane;
    const double *force = sim->spheres.force[i].lane;
    const double g[3] = {sim->gravity.x, sim->gravity.y, sim->gravity.z};
    const double half = 0.5 * sim->job->damping * sim->dt, push = 1.0 / (1.0 + half);
    const double keep = (1.0 - half) / (1.0 + half), inverse_mass = spin[7];
    const double turn = 2.5 * inverse_mass * spin[3] * spin[3];
    for (int k = 0; k < 3; k++) {
        const double after =
            keep * motion[4 + k] + push * sim->dt * (force[k] * inverse_mass + g[k]);
        const double spun = keep * spin[4 + k] + push * sim->dt * force[4 + k] * turn;
        v[k] = 0.5 * (motion[4 + k] + after);
        w[k] = 0.5 * (spin[4 + k] + spun);
    }
}

static double sphere_energies(const struct simulation *sim, int i, double energies[N_ENERGIES])
{
    double v[3], w[3];
    observe_motion(sim, i, v, w);
    const double mass = 1.0 / sphere_inverse_mass(&sim->spheres, i),
                 radius = sphere_radius(&sim->spheres, i);
    const double *force = sim->spheres.force[i].lane;
    const struct vec3 x = sphere_place(&sim->spheres, i);
    const double speed2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
    const struct vec3 g = sim->gravity;
    energies[ENERGY_TRANSLATION] = 0.5 * mass * speed2;
    energies[ENERGY_ROTATION] =
        0.2 * mass * radius * radius * (w[0] * w[0] + w[1] * w[1] + w[2] * w[2]);
    energies[ENERGY_POTENTIAL] = -mass * (g.x * x.x + g.y * x.y + g.z * x.z);
    energies[ENERGY_FRICTION] = sim->spheres.dissipated_friction[i] + force[3];
    energies[ENERGY_DAMPING] = sim->spheres.dissipated_damping[i] + 0.5 * force[7];
    if (sim->job->energy_ledger) /* half of what background damping takes in this step */
        energies[ENERGY_DAMPING] += sim->job->damping * sim->dt *
                                    (energies[ENERGY_TRANSLATION] + energies[ENERGY_ROTATION]);
    return speed2;
}

/* Adds mass times way along each direction of all periods by which spheres lie beyond the
 * domain: a rounded share a period, so the moment of the bookkeeping does not show.  (7.3) */
static void add_crossings(const struct simulation *sim, struct exact_sum sums[3])
{
    const struct periodic *periodic = &sim->spheres.periodic;
    for (int i = 0; i < sim->spheres.n_owned && periodic->any; i++) {
        double place[3];
        int turns[3];
        memcpy(place, sphere_position(&sim->spheres, i), sizeof place);
        periodic_wrap(periodic, place, turns);
        for (int k = 0; k < 3; k++) {
            const double share = periodic->period[k] / sphere_inverse_mass(&sim->spheres, i);
            for (int n = turns[k]; n != 0; n += n > 0 ? -1 : 1)
                exact_sum_add(&sums[k], n > 0 ? share : -share);
        }
    }
}

void observe_crossings(struct simulation *sim)
{
    add_crossings(sim, &sim->observe.totals[OBSERVE_CROSSED_X]);
}

/* The same since step 0, of all ranks [kg m].  Collective. */
static struct vec3 crossings_total(const struct simulation *sim)
{
    struct exact_sum sums[3];
    if (!sim->spheres.periodic.any)
        return (struct vec3){0.0, 0.0, 0.0};
    memcpy(sums, &sim->observe.totals[OBSERVE_CROSSED_X], sizeof sums);
    add_crossings(sim, sums);
    exact_sum_reduce(sim->comm, sums, 3);
    return (struct vec3){exact_sum_value(&sums[0]), exact_sum_value(&sums[1]),
                         exact_sum_value(&sums[2])};
}

/* Elastic energy of the pairs whose first sphere is owned, of springs with a memory apart;
 * returns their number. */
static int64_t add_pair_energy(const struct simulation *sim, struct exact_sum *normal,
                               struct exact_sum *springs)
{
    const struct contact_list *list = &sim->contacts.now;
    int64_t n = 0;
    for (int k = 0; k < list->n; k++) {
        const int i = list->first[k], j = list->second[k];
        if (i >= sim->spheres.n_owned || !contact_touches(list, k))
            continue;
        const double *a = sim->spheres.motion[i].lane, *b = sim->spheres.motion[j].lane;
        const double dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
        const double overlap = a[3] + b[3] - sqrt(dx * dx + dy * dy + dz * dz);
        const double inverse_radius =
            sim->spheres.spin[i].lane[3] + sim->spheres.spin[j].lane[3];
        double history[CONTACT_LANES] = {0.0};
        for (int l = 0; l < CONTACT_LANES; l++)
            if (list->history[l] != NULL)
                history[l] = list->history[l][k];
        const struct material_pair *pair =
            &sim->materials
                 .pairs[sim->spheres.material[i] * sim->materials.n + sim->spheres.material[j]];
        exact_sum_add(normal, contact_law_normal_energy(overlap, inverse_radius, pair));
        exact_sum_add(springs, contact_law_spring_energy(pair, history));
        n++;
    }
    return n;
}

/* Total over ranks of a rank's share. */
static double total_of(const struct simulation *sim, const struct exact_sum *share)
{
    struct exact_sum sum = *share;
    exact_sum_reduce(sim->comm, &sum, 1);
    return exact_sum_value(&sum);
}

/* A force works in half of the interval before the step and half of the one after: at the step
 * half of what it adds is done, the mean of before and after. */
static void add_twice_work(const struct simulation *sim, int b, struct exact_sum *sum)
{
    exact_sum_merge(sum, &sim->observe.work_before[b]);
    exact_sum_merge(sum, &sim->facets.loads[b].work);
}

/* Of bodies that forces move; all ranks know them. */
static void add_forced_energies(const struct simulation *sim, double energies[N_ENERGIES])
{
    for (int b = 0; sim->bodies.n_forced > 0 && b < sim->bodies.n; b++) {
        const struct rigid *rigid = sim->bodies.list[b].rigid;
        if (rigid == NULL)
            continue;
        energies[ENERGY_TRANSLATION] += rigid->energies.kinetic_translation;
        energies[ENERGY_ROTATION] += rigid->energies.kinetic_rotation;
        energies[ENERGY_POTENTIAL] += rigid->energies.potential;
        energies[ENERGY_FRICTION] += rigid->energies.rubbed;
        energies[ENERGY_DAMPING] += rigid->energies.damped;
        energies[ENERGY_WORK] += rigid->energies.work;
    }
}

/* Of bodies that deform, of all ranks: potential energy is less what gravity has done. */
static void add_solid_energies(struct simulation *sim, double energies[N_ENERGIES])
{
    struct solid_energies solids = {.sums = {{{0}, 0, 0}}};
    double value[SOLID_N_ENERGIES];
    if (sim->deform.n == 0)
        return;
    deform_energies(sim, &solids);
    for (int e = 0; e < SOLID_N_ENERGIES; e++)
        value[e] = solid_energy_value(&solids, (enum solid_energy)e);
    energies[ENERGY_TRANSLATION] += value[SOLID_ENERGY_KINETIC];
    energies[ENERGY_POTENTIAL] -= value[SOLID_ENERGY_GRAVITY];
    energies[ENERGY_ELASTIC] += value[SOLID_ENERGY_ELASTIC] + value[SOLID_ENERGY_HOURGLASS];
    energies[ENERGY_DAMPING] += value[SOLID_ENERGY_HOURGLASS_DAMPED] +
                                value[SOLID_ENERGY_DAMPED] + value[SOLID_ENERGY_BACKGROUND];
    energies[ENERGY_PLASTIC] = value[SOLID_ENERGY_PLASTIC];
    energies[ENERGY_WORK] += value[SOLID_ENERGY_LOADS] + value[SOLID_ENERGY_SUPPORTS];
}

void observe_taken_over(struct simulation *sim)
{
    struct exact_sum normal = {{0}, 0, 0}, *wound = &sim->observe.totals[OBSERVE_WOUND];
    if (!sim->job->energy_ledger)
        return;
    add_pair_energy(sim, &normal, wound);
    facet_contacts_elastic_energy(&sim->facets, &sim->spheres, &sim->bodies, &sim->materials,
                                  &normal, wound);
}

/* Energies summed over ranks. */
static void sum_energies(struct simulation *sim, double energies[N_ENERGIES], double *speed_max,
                         int64_t counts[3])
{
    struct exact_sum sums[N_SUMMED] = {{{0}, 0, 0}};
    double speed2_max = 0.0, own[N_ENERGIES] = {0.0};
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const double speed2 = sphere_energies(sim, i, own);
        speed2_max = speed2 > speed2_max ? speed2 : speed2_max;
        for (int e = 0; e < N_ENERGIES; e++) {
            if (e != ENERGY_ELASTIC && e != ENERGY_WORK && e != ENERGY_TANGENTIAL &&
                e != ENERGY_PLASTIC)
                exact_sum_add(&sums[e], own[e]);
        }
    }
    counts[0] = sim->spheres.n_owned;
    counts[1] = add_pair_energy(sim, &sums[ENERGY_ELASTIC], &sums[ENERGY_SPRINGS]);
    counts[2] = facet_contacts_count(&sim->facets) + touch_count(&sim->touch);
    facet_contacts_elastic_energy(&sim->facets, &sim->spheres, &sim->bodies, &sim->materials,
                                  &sums[ENERGY_ELASTIC], &sums[ENERGY_SPRINGS]);
    for (int b = 0; b < sim->facets.n_bodies; b++)
        if (sim->bodies.list[b].rigid == NULL && sim->bodies.list[b].skin == NULL)
            add_twice_work(sim, b, &sums[ENERGY_WORK]);
    const struct exact_sum *totals = sim->observe.totals;
    exact_sum_merge(&sums[ENERGY_FRICTION], &totals[OBSERVE_REMOVED_FRICTION]);
    exact_sum_merge(&sums[ENERGY_DAMPING], &totals[OBSERVE_REMOVED_DAMPING]);
    exact_sum_merge(&sums[ENERGY_FRICTION], &totals[OBSERVE_TOUCH_FRICTION]);
    exact_sum_merge(&sums[ENERGY_DAMPING], &totals[OBSERVE_TOUCH_DAMPING]);
    touch_energies(sim, &sums[ENERGY_ELASTIC], &sums[ENERGY_SPRINGS], &sums[ENERGY_FRICTION],
                   &sums[ENERGY_DAMPING]);
    exact_sum_merge(&sums[ENERGY_TANGENTIAL], &totals[OBSERVE_WOUND]);
    for (int b = 0; b < sim->facets.n_bodies; b++)
        exact_sum_merge(&sums[ENERGY_TANGENTIAL], &sim->facets.loads[b].wound);
    exact_sum_reduce(sim->comm, sums, N_SUMMED);
    comm_sum_int(sim->comm, counts, 3);
    comm_max(sim->comm, &speed2_max, 1);
    for (int e = 0; e < N_ENERGIES; e++)
        energies[e] = exact_sum_value(&sums[e]);
    const double springs = exact_sum_value(&sums[ENERGY_SPRINGS]);
    energies[ENERGY_ELASTIC] += springs;
    if (sim->job->energy_ledger)
        energies[ENERGY_TANGENTIAL] -= springs;
    energies[ENERGY_POTENTIAL] -= vec3_dot(sim->gravity, crossings_total(sim));
    energies[ENERGY_WORK] *= 0.5;
    if (sim->gravity_varies)
        energies[ENERGY_WORK] += total_of(sim, &sim->observe.totals[OBSERVE_GRAVITY_WORK]);
    add_forced_energies(sim, energies);
    add_solid_energies(sim, energies);
    *speed_max = sqrt(speed2_max);
}

/* What is there now, gone to heat or `carried` away less carried in, less what was put in. */
static double energy_held(const double energies[N_ENERGIES], double carried)
{
    double held = carried - energies[ENERGY_WORK];
    for (int e = 0; e < ENERGY_WORK; e++)
        held += energies[e];
    return held;
}

/* What errors of the balance are measured by: energy that has been turned over, and what
 * rounding can do to the sums. [J] */
static double energy_scale(const struct simulation *sim, const double energies[N_ENERGIES],
                           double removed)
{
    const double roundings = (double)sim->n_spheres * (double)(sim->step + 16);
    double scale =
        fabs(removed) + 1e-10 * fabs(energies[ENERGY_POTENTIAL]) + roundings * SUM_ROUNDING;
    for (int e = 0; e < N_ENERGIES; e++)
        scale += e != ENERGY_POTENTIAL ? fabs(energies[e]) : 0.0;
    return scale;
}

/* Closes the balance: notes what there was at the start, and the error.  carried[] is what
 * spheres carried away and in. */
static void close_balance(struct simulation *sim, const double energies[N_ENERGIES],
                          double carried[2], double *balance)
{
    struct observe *observe = &sim->observe;
    carried[0] = total_of(sim, &observe->totals[OBSERVE_REMOVED_ENERGY]);
    carried[1] = total_of(sim, &observe->totals[OBSERVE_INSERTED_ENERGY]);
    const double held = energy_held(energies, carried[0] - carried[1]);
    if (sim->step == 0 && sim->comm->rank == 0) {
        observe->totals[OBSERVE_ENERGY_START] = (struct exact_sum){0};
        exact_sum_add(&observe->totals[OBSERVE_ENERGY_START], held);
    }
    *balance = held - total_of(sim, &observe->totals[OBSERVE_ENERGY_START]);
    /* The most so far: all of it may be potential energy just now. */
    const double turned = energy_scale(sim, energies, carried[0]);
    const double before = total_of(sim, &observe->totals[OBSERVE_TURNED]);
    const double scale = turned > before ? turned : before;
    if (turned > before && sim->comm->rank == 0) {
        observe->totals[OBSERVE_TURNED] = (struct exact_sum){0};
        exact_sum_add(&observe->totals[OBSERVE_TURNED], turned);
    }
    observe->energy_error = scale > 0.0 ? fabs(*balance) / scale : fabs(*balance);
}

void observe_energy(struct simulation *sim)
{
    double energies[N_ENERGIES], speed_max, carried[2], balance;
    int64_t counts[3];
    if (!sim->job->energy_ledger)
        return;
    sum_energies(sim, energies, &speed_max, counts);
    close_balance(sim, energies, carried, &balance);
}

static int add_energy_values(struct simulation *sim, double *row, int n,
                             const double energies[N_ENERGIES])
{
    double carried[2], balance;
    close_balance(sim, energies, carried, &balance);
    for (int e = 0; e < N_ENERGIES; e++)
        if (e != ENERGY_PLASTIC || sim->deform.n > 0)
            row[n++] = energies[e];
    row[n++] = carried[0];
    row[n++] = carried[1];
    row[n++] = sim->job->energy_ledger ? balance : (double)NAN;
    return n;
}

/* As add_forced_columns() names them; velocities are those of the step. (5.4) */
static int add_forced_values(const struct rigid *rigid, double *row, int n)
{
    const struct rigid_state *a = &rigid->state, *b = &rigid->next;
    if (rigid->kind != RIGID_FREE) {
        row[n++] = a->way;
        row[n++] = 0.5 * (a->speed + b->speed);
        return n;
    }
    const struct vec3 vectors[3] = {a->centre,
                                    vec3_scale(0.5, vec3_add(a->velocity, b->velocity)),
                                    vec3_scale(0.5, vec3_add(a->momentum, b->momentum))};
    for (int k = 0; k < 3; k++) {
        row[n++] = vectors[k].x;
        row[n++] = vectors[k].y;
        row[n++] = vectors[k].z;
        for (int q = 0; k == 0 && q < 4; q++)
            row[n++] = a->turn[q];
    }
    return n;
}

static int add_body_values(struct simulation *sim, double *row, int n, double n_steps)
{
    for (int b = 0; b < sim->bodies.n; b++) {
        struct body_load *load = &sim->facets.loads[b];
        for (int k = 0; k < 6; k++) {
            struct exact_sum *sum = k < 3 ? &load->force[k] : &load->torque[k - 3];
            row[n++] = total_of(sim, sum) / n_steps;
            *sum = (struct exact_sum){0};
        }
        if (has_work(sim, b)) {
            struct exact_sum twice = {0};
            add_twice_work(sim, b, &twice);
            row[n++] = 0.5 * total_of(sim, &twice);
        }
        if (sim->bodies.list[b].rigid != NULL)
            n = add_forced_values(sim->bodies.list[b].rigid, row, n);
    }
    return n;
}

static int add_section_values(struct simulation *sim, double *row, int n)
{
    for (int s = 0; s < sim->sections.n; s++) {
        const struct tally *passed = sim->sections.counts[s].passed;
        n = tally_totals(&passed[0], sim->comm, row, n);
        n = tally_totals(&passed[1], sim->comm, row, n);
    }
    return n;
}

static int add_content_values(struct simulation *sim, double *row, int n)
{
    double v[3], w[3];
    contents_begin(&sim->contents, &sim->bodies, (double)sim->step * sim->dt);
    for (int i = 0; sim->contents.n > 0 && i < sim->spheres.n_owned; i++) {
        observe_motion(sim, i, v, w);
        contents_add(&sim->contents, &sim->spheres, i, v);
    }
    return contents_values(&sim->contents, sim->comm, row, n);
}

static int add_exchange_values(struct simulation *sim, double *row, int n)
{
    for (int k = 0; k < sim->insertions.n; k++) {
        row[n++] = insertion_due(&sim->job->insertions[k], (double)sim->step * sim->dt);
        n = tally_totals(&sim->insertions.list[k].tally, sim->comm, row, n);
    }
    for (int k = 0; k < sim->removals.n; k++)
        n = tally_totals(&sim->removals.list[k].taken, sim->comm, row, n);
    if (sim->job->domain.leavers == JOB_LEAVERS_REMOVE)
        n = tally_totals(&sim->removals.leavers, sim->comm, row, n);
    return n;
}

void observe_sample(struct simulation *sim)
{
    struct observe *observe = &sim->observe;
    double *row = array_allocate((size_t)observe->table.n_columns, sizeof *row);
    double energies[N_ENERGIES], speed_max;
    int64_t counts[3];
    sum_energies(sim, energies, &speed_max, counts);
    int n = 0;
    row[n++] = (double)sim->step;
    row[n++] = (double)sim->step * sim->dt;
    row[n++] = (double)counts[0];
    n = add_energy_values(sim, row, n, energies);
    row[n++] = total_of(sim, &observe->totals[OBSERVE_OVERLAP]) / OVERLAP_SCALE;
    row[n++] = speed_max;
    row[n++] = (double)counts[1];
    row[n++] = (double)counts[2];
    const double last = total_of(sim, &observe->totals[OBSERVE_LAST_STEP]);
    const double n_steps = (double)(sim->step + 1) - last;
    n = add_body_values(sim, row, n, n_steps);
    n = reactions_values(sim, n_steps, row, n);
    n = probes_values(sim, row, n);
    n = add_section_values(sim, row, n);
    n = add_content_values(sim, row, n);
    n = add_exchange_values(sim, row, n);
    CHECK(n == observe->table.n_columns, "%d values for %d columns", n,
          observe->table.n_columns);
    if (sim->comm->rank == 0) {
        series_add_row(&observe->table, row);
        observe->totals[OBSERVE_LAST_STEP] = (struct exact_sum){0};
        exact_sum_add(&observe->totals[OBSERVE_LAST_STEP], (double)(sim->step + 1));
    }
    observe->totals[OBSERVE_OVERLAP] = (struct exact_sum){0};
    free(row);
}

void observe_overlap(struct simulation *sim, double overlap)
{
    struct exact_sum *largest = &sim->observe.totals[OBSERVE_OVERLAP];
    if (sim->comm->rank != 0 || !(overlap * OVERLAP_SCALE > exact_sum_value(largest)))
        return;
    *largest = (struct exact_sum){0};
    exact_sum_add(largest, overlap * OVERLAP_SCALE);
}

void observe_gone(struct simulation *sim)
{
    bool goes = false;
    for (int b = 0; b < sim->bodies.n; b++) {
        const struct body *body = &sim->bodies.list[b];
        goes = goes ||
               (!body->exists && sim->step > 0 && body_exists(body, sim->step - 1, sim->dt));
    }
    if (goes && sim->job->energy_ledger)
        facet_contacts_held(&sim->facets, &sim->spheres, &sim->bodies, &sim->materials, sim->dt,
                            &sim->observe.totals[OBSERVE_REMOVED_ENERGY]);
}

/* Places of the middle of the step before, as gravity has changed in it. (7.2) */
void observe_gravity(struct simulation *sim)
{
    const struct vec3 dg = sim->gravity_change;
    if (!sim->job->energy_ledger || !(vec3_norm(dg) > 0.0))
        return;
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        const struct vec3 x = sphere_place(&sim->spheres, i);
        const double *v = sphere_velocity(&sim->spheres, i);
        const double half = 0.5 * sim->dt, mass = 1.0 / sphere_inverse_mass(&sim->spheres, i);
        const double rise = dg.x * (x.x - half * v[0]) + dg.y * (x.y - half * v[1]) +
                            dg.z * (x.z - half * v[2]);
        exact_sum_add(&sim->observe.totals[OBSERVE_GRAVITY_WORK], -mass * rise);
    }
    const double crossed = vec3_dot(dg, crossings_total(sim));
    if (sim->comm->rank == 0)
        exact_sum_add(&sim->observe.totals[OBSERVE_GRAVITY_WORK], -crossed);
}

void observe_removed(struct simulation *sim, int i)
{
    double energies[N_ENERGIES] = {0.0};
    struct exact_sum *totals = sim->observe.totals;
    sphere_energies(sim, i, energies);
    exact_sum_add(&totals[OBSERVE_REMOVED_ENERGY], energies[ENERGY_TRANSLATION] +
                                                       energies[ENERGY_ROTATION] +
                                                       energies[ENERGY_POTENTIAL]);
    exact_sum_add(&totals[OBSERVE_REMOVED_FRICTION], energies[ENERGY_FRICTION]);
    exact_sum_add(&totals[OBSERVE_REMOVED_DAMPING], energies[ENERGY_DAMPING]);
}

/* Background damping takes the whole of this step: half of it stands in the energies now. */
void observe_inserted(struct simulation *sim, int i)
{
    double energies[N_ENERGIES] = {0.0};
    sphere_energies(sim, i, energies);
    exact_sum_add(&sim->observe.totals[OBSERVE_INSERTED_ENERGY],
                  energies[ENERGY_TRANSLATION] + energies[ENERGY_ROTATION] +
                      energies[ENERGY_POTENTIAL] + energies[ENERGY_DAMPING]);
}

static void add_monitor(struct observe_monitor **monitors, int *n, int *capacity,
                        struct exact_sum *sum, const char *owner, const char *what)
{
    ARRAY_GROW(*monitors, *n + 1, *capacity);
    struct observe_monitor *monitor = &(*monitors)[(*n)++];
    snprintf(monitor->name, sizeof monitor->name, "%s.%s", owner, what);
    monitor->sum = sum;
}

/* Part 0 as section_0.count_forward, part 2 as section_0.2.count_forward. */
static void add_tally(struct observe_monitor **monitors, int *n, int *capacity,
                      const struct tally *tally, const char *owner, const char *suffix)
{
    for (int part = 0; part < tally->n_parts; part++) {
        char whose[48], what[32];
        snprintf(whose, sizeof whose, part > 0 ? "%s.%d" : "%s", owner, part);
        snprintf(what, sizeof what, "count%s", suffix);
        add_monitor(monitors, n, capacity, &tally->number[part], whose, what);
        snprintf(what, sizeof what, "mass%s", suffix);
        add_monitor(monitors, n, capacity, &tally->mass[part], whose, what);
    }
}

/* What the supports of a body that deforms have done. */
static void add_supports(struct observe_monitor **monitors, int *n, int *capacity,
                         struct deform_body *deform)
{
    static const char *const forces[] = {"force_x", "force_y", "force_z"};
    for (int s = 0; s < deform->solid.supports.n; s++) {
        struct solid_support *support = &deform->solid.supports.list[s];
        char owner[48];
        snprintf(owner, sizeof owner, "body_%d.support_%d", deform->body, s);
        for (int d = 0; d < 3; d++)
            if (solid_support_pushes(support, d))
                add_monitor(monitors, n, capacity, &support->force[d], owner, forces[d]);
        if (support->kind != SOLID_SUPPORT_FIXED)
            add_monitor(monitors, n, capacity, &support->work, owner, "work");
    }
}

int observe_monitors(struct simulation *sim, struct observe_monitor **monitors)
{
    static const char *const totals[OBSERVE_N_TOTALS] = {
        "energy_start",    "removed_energy", "removed_friction", "removed_damping",
        "tangential",      "last_step",      "turned",           "overlap",
        "inserted_energy", "crossed_x",      "crossed_y",        "crossed_z",
        "gravity_work",    "touch_friction", "touch_damping",
    };
    static const char *const loads[] = {"force_x",  "force_y",  "force_z",
                                        "torque_x", "torque_y", "torque_z"};
    int n = 0, capacity = 0;
    *monitors = NULL;
    for (int t = 0; t < OBSERVE_N_TOTALS; t++)
        add_monitor(monitors, &n, &capacity, &sim->observe.totals[t], "run", totals[t]);
    for (int b = 0; b < sim->bodies.n; b++) {
        struct body_load *load = &sim->facets.loads[b];
        char owner[32];
        snprintf(owner, sizeof owner, "body_%d", b);
        for (int k = 0; k < 6; k++)
            add_monitor(monitors, &n, &capacity, k < 3 ? &load->force[k] : &load->torque[k - 3],
                        owner, loads[k]);
        add_monitor(monitors, &n, &capacity, &load->work, owner, "work");
        add_monitor(monitors, &n, &capacity, &load->wound, owner, "wound");
    }
    for (int k = 0; k < sim->deform.n; k++)
        add_supports(monitors, &n, &capacity, &sim->deform.list[k]);
    for (int s = 0; s < sim->sections.n; s++) {
        const struct tally *passed = sim->sections.counts[s].passed;
        char owner[32];
        snprintf(owner, sizeof owner, "section_%d", s);
        add_tally(monitors, &n, &capacity, &passed[0], owner, "_forward");
        add_tally(monitors, &n, &capacity, &passed[1], owner, "_backward");
    }
    for (int k = 0; k < sim->insertions.n; k++) {
        char owner[32];
        snprintf(owner, sizeof owner, "insertion_%d", k);
        add_tally(monitors, &n, &capacity, &sim->insertions.list[k].tally, owner, "");
    }
    for (int k = 0; k < sim->removals.n; k++) {
        char owner[32];
        snprintf(owner, sizeof owner, "removal_%d", k);
        add_tally(monitors, &n, &capacity, &sim->removals.list[k].taken, owner, "");
    }
    add_tally(monitors, &n, &capacity, &sim->removals.leavers, "leavers", "");
    return n;
}
