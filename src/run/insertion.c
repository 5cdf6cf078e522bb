/*
 * See insertion.h.  At an occasion the spheres that could be in the way of the regions are
 * gathered once (model/crowd.h); then rounds follow.  In a round each sphere that has no place
 * yet makes one attempt; a sphere that gets a place makes way for the next that is due.  Those
 * that used up their attempts keep their slot until the next occasion, so an insertion whose
 * region is full costs INSERTION_ATTEMPTS rounds and stops drawing.
 */
#include "run/insertion.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/random.h"
#include "base/report.h"
#include "job/job.h"
#include "model/order.h"
#include "run/simulation.h"
#include "store/notes.h"

static const double PI = 3.14159265358979323846;
/* What rounding of a rate times a time may take off a whole number. */
static const double HAIR = 1e-9;

/* Notes to which bodies' insides an insertion has no access. */
static void find_solids(struct insertions *insertions, struct insertion *insertion,
                        const struct bodies *bodies)
{
    insertion->solid = array_allocate((size_t)bodies->n, sizeof *insertion->solid);
    for (int b = 0; b < bodies->n; b++) {
        const struct mesh *mesh = &bodies->list[b].mesh;
        insertion->solid[b] = region_meets_solid(&insertion->region, &bodies->list[b]);
        if (insertion->solid[b] && insertions->surfaces[b] == NULL)
            insertions->surfaces[b] = region_surface_build(mesh, mesh->reference);
    }
}

void insertions_init(struct insertions *insertions, const struct job *job,
                     const struct bodies *bodies)
{
    struct periodic periodic;
    periodic_init(&periodic, job);
    *insertions = (struct insertions){.n = job->n_insertions, .n_surfaces = bodies->n};
    insertions->surfaces = array_allocate((size_t)bodies->n, sizeof(void *));
    insertions->list = array_allocate((size_t)insertions->n, sizeof *insertions->list);
    for (int i = 0; i < insertions->n; i++) {
        struct insertion *insertion = &insertions->list[i];
        const struct tally_split split = tally_split(job, job->insertions[i].by, 0, NULL);
        char *why = NULL;
        insertion->asked = &job->insertions[i];
        insertion->number = i;
        CHECK(region_build(&insertion->region, &insertion->asked->region, bodies, &why), "%s",
              why);
        region_repeat(&insertion->region, &periodic);
        find_solids(insertions, insertion, bodies);
        sizes_build(&insertion->sizes, &insertion->asked->sizes, insertion->asked->radius);
        tally_init(&insertion->tally, &split);
    }
}

void insertions_clear(struct insertions *insertions)
{
    for (int i = 0; i < insertions->n; i++) {
        region_clear(&insertions->list[i].region);
        sizes_clear(&insertions->list[i].sizes);
        tally_clear(&insertions->list[i].tally);
        free(insertions->list[i].solid);
    }
    for (int b = 0; b < insertions->n_surfaces; b++)
        region_surface_destroy(insertions->surfaces[b]);
    free(insertions->surfaces);
    free(insertions->list);
    free(insertions->new);
    *insertions = (struct insertions){0};
}

/* --------------------------------------------------------------------------------------
 * the k-th sphere */

static int draw_material(const struct job_insertion *asked, double share)
{
    double sum = 0.0, below = 0.0;
    for (int m = 0; m < asked->n_mix; m++)
        sum += asked->mix[m].share;
    for (int m = 0; m < asked->n_mix - 1; m++) {
        below += asked->mix[m].share;
        if (share * sum < below)
            return asked->mix[m].material;
    }
    return asked->n_mix > 0 ? asked->mix[asked->n_mix - 1].material : asked->material;
}

struct packing_sphere insertion_sphere(const struct job_insertion *asked, int number,
                                       const struct sizes *sizes, int64_t seed, int64_t k)
{
    const uint64_t materials = random_stream(RANDOM_INSERTION_MATERIALS, number);
    const uint64_t velocities = random_stream(RANDOM_INSERTION_VELOCITIES, number);
    double part[3]; /* of the spread, from -1 to 1 */
    for (int c = 0; c < 3; c++)
        part[c] =
            2.0 * random_unit((uint64_t)seed, velocities, 3 * (uint64_t)k + (uint64_t)c) - 1.0;
    return (struct packing_sphere){
        .radius =
            sizes_draw(sizes, (uint64_t)seed, random_stream(RANDOM_INSERTION_SIZES, number), k),
        .material = draw_material(asked, random_unit((uint64_t)seed, materials, (uint64_t)k)),
        .velocity = {asked->velocity.x + part[0] * asked->spread.x,
                     asked->velocity.y + part[1] * asked->spread.y,
                     asked->velocity.z + part[2] * asked->spread.z},
        .angular_velocity = asked->spin,
    };
}

static double mass_of(const struct simulation *sim, const struct packing_sphere *sphere)
{
    return sim->materials.density[sphere->material] * (4.0 / 3.0 * PI) *
           (sphere->radius * sphere->radius * sphere->radius);
}

static struct packing_sphere sphere_of(const struct simulation *sim,
                                       const struct insertion *insertion, int64_t k)
{
    return insertion_sphere(insertion->asked, insertion->number, &insertion->sizes,
                            sim->job->seed, k);
}

/* --------------------------------------------------------------------------------------
 * what is due */

double insertion_due(const struct job_insertion *asked, double time)
{
    const double until = time < asked->until_time ? time : asked->until_time;
    if (!(until > asked->start))
        return 0.0;
    if (asked->by_mass) {
        const double due = asked->mass_rate * (until - asked->start) * (1.0 + HAIR);
        return due < asked->until_mass ? due : asked->until_mass;
    }
    const double due = asked->number_rate * (until - asked->start) * (1.0 + HAIR);
    const double most = (double)asked->until_count;
    return asked->until_count > 0 && due > most ? most : due;
}

/* Is it that time, but for rounding? */
static bool has_come(double time, double now)
{
    return now * (1.0 + HAIR) >= time;
}

/* Is until.time later than this step, but not than the next? */
static bool is_last(const struct job_insertion *asked, int64_t step, double dt)
{
    return !has_come(asked->until_time, (double)step * dt) &&
           has_come(asked->until_time, (double)(step + 1) * dt);
}

double insertion_due_since(const struct job_insertion *asked, int64_t step, double dt)
{
    const bool over = has_come(asked->until_time, (double)(step + 1) * dt);
    return insertion_due(asked,
                         over ? asked->until_time : (double)(step - step % asked->every) * dt);
}

/* Is the next sphere due, which would bring this mass? */
static bool next_is_due(const struct insertion *insertion, double mass, double due)
{
    const struct job_insertion *asked = insertion->asked;
    if (asked->until_count > 0 && insertion->n_drawn >= asked->until_count)
        return false;
    if (!(insertion->mass_drawn + mass <= asked->until_mass))
        return false;
    return asked->by_mass ? insertion->mass_drawn + mass <= due
                          : (double)(insertion->n_drawn + 1) <= due;
}

/* Lets the next sphere join those that wait, where it is due. */
static bool draw_next(const struct simulation *sim, struct insertion *insertion, double due)
{
    if (insertion->n_waiting == INSERTION_WAITING)
        return false;
    const struct packing_sphere next = sphere_of(sim, insertion, insertion->n_drawn);
    const double mass = mass_of(sim, &next);
    if (!next_is_due(insertion, mass, due))
        return false;
    insertion->waiting[insertion->n_waiting++] =
        (struct insertion_waiting){insertion->n_drawn, 0};
    insertion->n_drawn++;
    insertion->mass_drawn += mass;
    return true;
}

/* Finds whether this step is an occasion at which something is due. */
static bool has_occasion(const struct simulation *sim, struct insertion *insertion)
{
    const double time = (double)sim->step * sim->dt;
    const struct job_insertion *asked = insertion->asked;
    const bool regular =
        sim->step % asked->every == 0 && time >= asked->start && time <= asked->until_time;
    insertion->occasion = false;
    if (!regular && !is_last(asked, sim->step, sim->dt))
        return false;
    insertion->due = insertion_due_since(asked, sim->step, sim->dt);
    (void)draw_next(sim, insertion, insertion->due);
    insertion->occasion = insertion->n_waiting > 0;
    return insertion->occasion;
}

/* --------------------------------------------------------------------------------------
 * room */

/* May a sphere there be in the way of what lies within the region? */
static bool is_near(const struct region *region, struct vec3 x, double radius)
{
    const struct vec3 low = region->low, high = region->high;
    return x.x > low.x - radius && x.y > low.y - radius && x.z > low.z - radius &&
           x.x < high.x + radius && x.y < high.y + radius && x.z < high.z + radius;
}

/* Adds a sphere, and its images over periodic boundaries, where they may be in the way of
 * insertions that have an occasion. */
static void add_to_crowd(struct insertions *all, struct vec3 place, double radius, int n_shifts,
                         double shifts[PERIODIC_IMAGES][3])
{
    for (int s = 0; s < n_shifts; s++) {
        const struct vec3 shift = {shifts[s][0], shifts[s][1], shifts[s][2]};
        const struct vec3 x = vec3_add(place, shift);
        bool near = false;
        for (int k = 0; k < all->n && !near; k++)
            near = all->list[k].occasion && is_near(&all->list[k].region, x, radius);
        if (near)
            crowd_add(&all->crowd, x, radius);
    }
}

/* The owned spheres that could be in the way of the insertions that have an occasion. */
static void fill_crowd(struct simulation *sim, const unsigned char *removed)
{
    struct insertions *all = &sim->insertions;
    const struct spheres *spheres = &sim->spheres;
    double shifts[PERIODIC_IMAGES][3];
    const int n_shifts = periodic_shifts(&spheres->periodic, shifts);
    all->radius_max = 0.0;
    for (int i = 0; i < spheres->n_owned; i++) {
        const double radius = sphere_radius(spheres, i);
        all->radius_max = radius > all->radius_max ? radius : all->radius_max;
    }
    double greatest = all->radius_max;
    for (int k = 0; k < all->n; k++) {
        const double most = all->list[k].sizes.max;
        greatest = all->list[k].occasion && most > greatest ? most : greatest;
    }
    crowd_init(&all->crowd, greatest);
    for (int i = 0; i < spheres->n_owned; i++) {
        if (removed == NULL || !removed[i])
            add_to_crowd(all, sphere_place(spheres, i), sphere_radius(spheres, i), n_shifts,
                         shifts);
    }
    comm_max(sim->comm, &all->radius_max, 1);
}

/* Draws places until one holds the sphere; false after many. */
static bool draw_place(const struct simulation *sim, struct insertion *insertion, double radius,
                       struct vec3 *place)
{
    enum { MOST = 1000 };
    const uint64_t stream = random_stream(RANDOM_INSERTION_PLACES, insertion->number);
    for (int n = 0; n < MOST; n++) {
        *place = region_point(&insertion->region, radius, (uint64_t)sim->job->seed, stream,
                              (uint64_t)insertion->n_attempts++);
        if (!region_contains(&insertion->region, *place, radius))
            continue;
        *place = periodic_settled(&sim->spheres.periodic, *place);
        return true;
    }
    return false;
}

/* Brings the surfaces of solid bodies to where they are. */
static void move_solids(struct simulation *sim)
{
    struct region_surface **surfaces = sim->insertions.surfaces;
    for (int b = 0; b < sim->bodies.n; b++) {
        const struct body *body = &sim->bodies.list[b];
        if (surfaces[b] == NULL || !body->moves)
            continue;
        region_surface_destroy(surfaces[b]);
        surfaces[b] = region_surface_build(&body->mesh, body->mesh.place);
    }
}

/* Is the place inside a solid body? */
static bool is_buried(const struct simulation *sim, const struct insertion *insertion,
                      struct vec3 place)
{
    for (int b = 0; b < sim->bodies.n; b++)
        if (insertion->solid[b] && sim->bodies.list[b].exists &&
            region_surface_holds(sim->insertions.surfaces[b], place))
            return true;
    return false;
}

/* Is something of this rank in the way?  Bodies are everywhere: ranks take turns with them. */
static bool is_blocked(struct simulation *sim, const struct insertion *insertion,
                       struct vec3 place, double radius, int64_t turn)
{
    if (!crowd_has_room(&sim->insertions.crowd, place, radius, 0.0))
        return true;
    return turn % sim->comm->n_ranks == sim->comm->rank &&
           (facet_contacts_meet(&sim->facets, &sim->bodies, place, radius) ||
            is_buried(sim, insertion, place));
}

/* --------------------------------------------------------------------------------------
 * rounds */

/* One attempt of each sphere that has not used up its own. */
struct round {
    int n;
    int slot[INSERTION_WAITING]; /* among those that wait */
    struct packing_sphere spheres[INSERTION_WAITING];
    int64_t blocked[INSERTION_WAITING];
};

static void propose(struct simulation *sim, struct insertion *insertion, struct round *round)
{
    round->n = 0;
    for (int w = 0; w < insertion->n_waiting; w++) {
        struct insertion_waiting *waiting = &insertion->waiting[w];
        if (waiting->n_tried == INSERTION_ATTEMPTS)
            continue;
        waiting->n_tried++;
        struct packing_sphere *sphere = &round->spheres[round->n];
        *sphere = sphere_of(sim, insertion, waiting->k);
        const int64_t turn = insertion->n_attempts;
        round->slot[round->n] = w;
        round->blocked[round->n++] =
            !draw_place(sim, insertion, sphere->radius, &sphere->position) ||
            is_blocked(sim, insertion, sphere->position, sphere->radius, turn);
    }
    comm_max_int(sim->comm, round->blocked, round->n);
}

static void take_in(struct simulation *sim, struct insertion *insertion,
                    const struct packing_sphere *sphere)
{
    struct insertions *all = &sim->insertions;
    ARRAY_GROW(all->new, all->n_new + 1, all->new_capacity);
    all->new[all->n_new++] = (struct insertion_new){*sphere, sim->next_id++,
                                                    sim->job->n_spheres + insertion->number};
    all->radius_max = sphere->radius > all->radius_max ? sphere->radius : all->radius_max;
    insertion->n_inserted++;
    if (sim->comm->rank == 0)
        tally_add_one(&insertion->tally, sphere->material, sphere->radius,
                      mass_of(sim, sphere));
}

static bool overlap(const struct periodic *periodic, const struct packing_sphere *a,
                    const struct packing_sphere *b)
{
    const struct vec3 apart = periodic_shortest(periodic, vec3_sub(b->position, a->position));
    const double reach = a->radius + b->radius;
    return vec3_dot(apart, apart) < reach * reach;
}

/* Accepts in order what nothing blocks and what overlaps none that this round has accepted. */
static void accept(struct simulation *sim, struct insertion *insertion, struct round *round)
{
    const struct periodic *periodic = &sim->spheres.periodic;
    double shifts[PERIODIC_IMAGES][3];
    const int n_shifts = periodic_shifts(periodic, shifts);
    bool placed[INSERTION_WAITING] = {false};
    int n = 0;
    for (int a = 0; a < round->n; a++) {
        const struct packing_sphere *sphere = &round->spheres[a];
        bool free = !round->blocked[a];
        for (int b = 0; b < a && free; b++)
            free = !placed[round->slot[b]] || !overlap(periodic, &round->spheres[b], sphere);
        if (!free)
            continue;
        placed[round->slot[a]] = true;
        take_in(sim, insertion, sphere);
    }
    for (int a = 0; a < round->n; a++)
        if (placed[round->slot[a]])
            add_to_crowd(&sim->insertions, round->spheres[a].position, round->spheres[a].radius,
                         n_shifts, shifts);
    for (int w = 0; w < insertion->n_waiting; w++)
        if (!placed[w])
            insertion->waiting[n++] = insertion->waiting[w];
    insertion->n_waiting = n;
}

static double mass_waiting(const struct simulation *sim, const struct insertion *insertion)
{
    double mass = 0.0;
    for (int w = 0; w < insertion->n_waiting; w++) {
        const struct packing_sphere sphere = sphere_of(sim, insertion, insertion->waiting[w].k);
        mass += mass_of(sim, &sphere);
    }
    return mass;
}

/* Says that an insertion lacks room, and again whenever twice as much is lacking; or fails. */
static void report_full(struct simulation *sim, struct insertion *insertion)
{
    const struct job_insertion *asked = insertion->asked;
    const double due = insertion->due;
    char text[160];
    if (asked->by_mass)
        snprintf(text, sizeof text, "insertion '%.40s': asked %.6g kg so far, inserted %.6g kg",
                 asked->name, due, insertion->mass_drawn - mass_waiting(sim, insertion));
    else
        snprintf(text, sizeof text,
                 "insertion '%.40s': asked %lld spheres so far, inserted %lld", asked->name,
                 (long long)due, (long long)insertion->n_inserted);
    if (asked->full == JOB_FULL_STOP) {
        watch_full(&sim->watch, text);
        return;
    }
    const int64_t lacked =
        asked->by_mass ? insertion->n_waiting : (int64_t)due - insertion->n_inserted;
    if (lacked < 2 * insertion->n_lacked)
        return;
    insertion->n_lacked = lacked;
    report_warn("%s at step %lld (%.6g s); the region is full: it falls behind until there is "
                "room; enlarge it, let spheres leave it faster or lower the rate",
                text, (long long)sim->step, (double)sim->step * sim->dt);
}

static void insert(struct simulation *sim, struct insertion *insertion)
{
    struct round round;
    for (int w = 0; w < insertion->n_waiting; w++)
        insertion->waiting[w].n_tried = 0;
    do {
        while (draw_next(sim, insertion, insertion->due))
            continue;
        propose(sim, insertion, &round);
        accept(sim, insertion, &round);
    } while (round.n > 0);
    if (insertion->n_waiting > 0)
        report_full(sim, insertion);
}

int insertions_try(struct simulation *sim, const unsigned char *removed)
{
    struct insertions *all = &sim->insertions;
    bool any = false;
    all->n_new = 0;
    for (int k = 0; k < all->n; k++)
        any = has_occasion(sim, &all->list[k]) || any;
    if (!any)
        return 0;
    deform_skin_show(sim);
    deform_place_faces(sim);
    facet_contacts_refit(&sim->facets, &sim->bodies);
    move_solids(sim);
    fill_crowd(sim, removed);
    for (int k = 0; k < all->n; k++)
        if (all->list[k].occasion)
            insert(sim, &all->list[k]);
    deform_skin_hide(sim);
    crowd_clear(&all->crowd);
    return all->n_new;
}

void insertions_place(struct simulation *sim)
{
    struct insertions *all = &sim->insertions;
    struct spheres *spheres = &sim->spheres;
    int n = 0;
    for (int k = 0; k < all->n_new; k++) {
        const struct insertion_new *new = &all->new[k];
        const double x[3] = {new->sphere.position.x, new->sphere.position.y,
                             new->sphere.position.z};
        if (boxes_owner(&sim->boxes, x) != sim->comm->rank)
            continue;
        const int i = spheres->n_all + n++;
        spheres_reserve(spheres, i + 1);
        simulation_set_sphere(sim, i, new->id, new->group, &new->sphere);
        spheres->order_cell[i] = order_cell_at(x, all->radius_max);
        sphere_complete(spheres, i, &sim->materials);
        observe_inserted(sim, i);
    }
    sim->migrate.n_born = n;
    all->n_new = 0;
}

/* --------------------------------------------------------------------------------------
 * checkpoints */

void insertions_put_notes(const struct insertions *insertions, struct notes *notes)
{
    for (int i = 0; i < insertions->n; i++) {
        const struct insertion *insertion = &insertions->list[i];
        const int64_t counts[4] = {insertion->n_attempts, insertion->n_drawn,
                                   insertion->n_inserted, insertion->n_waiting};
        int64_t waiting[INSERTION_WAITING];
        char name[NOTES_NAME_SIZE];
        for (int w = 0; w < INSERTION_WAITING; w++)
            waiting[w] = w < insertion->n_waiting ? insertion->waiting[w].k : -1;
        snprintf(name, sizeof name, "insertion_%d.counts", i);
        notes_add_ints(notes, name, 4, counts);
        snprintf(name, sizeof name, "insertion_%d.waiting", i);
        notes_add_ints(notes, name, INSERTION_WAITING, waiting);
        snprintf(name, sizeof name, "insertion_%d.mass", i);
        notes_add(notes, name, 1, &insertion->mass_drawn);
    }
}

bool insertions_take_notes(struct insertions *insertions, const struct notes *notes)
{
    for (int i = 0; i < insertions->n; i++) {
        struct insertion *insertion = &insertions->list[i];
        int64_t counts[4], waiting[INSERTION_WAITING];
        char name[3][NOTES_NAME_SIZE];
        snprintf(name[0], sizeof name[0], "insertion_%d.counts", i);
        snprintf(name[1], sizeof name[1], "insertion_%d.waiting", i);
        snprintf(name[2], sizeof name[2], "insertion_%d.mass", i);
        if (!notes_take_ints(notes, name[0], 4, counts) ||
            !notes_take_ints(notes, name[1], INSERTION_WAITING, waiting) ||
            !notes_take(notes, name[2], 1, &insertion->mass_drawn))
            return false;
        if (counts[3] < 0 || counts[3] > INSERTION_WAITING)
            return false;
        insertion->n_attempts = counts[0];
        insertion->n_drawn = counts[1];
        insertion->n_inserted = counts[2];
        insertion->n_waiting = (int)counts[3];
        for (int w = 0; w < insertion->n_waiting; w++)
            insertion->waiting[w] = (struct insertion_waiting){waiting[w], 0};
    }
    return true;
}
