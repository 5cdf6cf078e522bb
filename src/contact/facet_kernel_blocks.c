/*
 * The facet kernel, in blocks of as many contacts as a vector has lanes.  Compiled once for
 * each instruction set (base/isa.h).
 *
 * As in the pair kernel, rows of spheres and of history are loaded whole and transposed, the
 * law is taken in vectors, and what comes of it is transposed back and added row by row in the
 * order of the contacts.  What bodies feel goes to exact sums, whose order does not matter.
 */
#include "contact/facet_kernel_blocks.h"

#include "contact/facet_contact.h"
#include "contact/facet_kernel.h"
#include "model/body.h"
#include "physics/contact_geometry.h"
#include "physics/contact_law.h"
#include "physics/lanes_rows.h"

enum { WIDTH = LANES_WIDTH, PARTS = LANES_PARTS };

_Static_assert(FACET_KERNEL_BATCH % WIDTH == 0 && FACET_KERNEL_PAD % WIDTH == 0,
               "batches and runs are whole vectors");
_Static_assert((int)CONTACT_LANES == (int)CONTACT_LAW_LANES && (int)CONTACT_ROLLING_LANE == 8,
               "one idea of history; what a full law does not need is one row of it");

struct block {
    struct facet_contact *contact[WIDTH];
    int sphere[WIDTH];
    struct facet_kernel_load *load[WIDTH];
    const struct material_pair *pair[WIDTH];
    lanes motion[8], spin[8]; /* rows of the spheres */
    lanes normal[3], point[3], overlap, wall[3], turns[3], yield, width; /* as in a batch */
    bool one_load;  /* all lanes have the same */
    bool moves;     /* some body of the block does */
    lanes given[3]; /* force on the body, as its sums took it [N] */
};

LANES_INLINE void load_spheres(const struct facet_kernel_work *work, struct block *block)
{
    const double *motion[WIDTH], *spin[WIDTH];
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++) {
        motion[l] = work->motion[block->sphere[l]].lane;
        spin[l] = work->spin[block->sphere[l]].lane;
    }
    lanes_take_rows(motion, block->motion);
    lanes_take_rows(spin, block->spin);
}

LANES_INLINE void load_history(const struct block *block, bool full,
                               lanes history[CONTACT_LANES])
{
    const double *rows[WIDTH];
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++)
        rows[l] = block->contact[l]->history;
    lanes_take_rows(rows, history);
    if (full)
        for (int h = CONTACT_ROLLING_LANE; h < CONTACT_LANES; h++) {
            history[h] = lanes_all(0.0);
            for (int l = 0; l < WIDTH; l++)
                history[h][l] = rows[l][h];
        }
}

LANES_INLINE void store_history(const struct block *block, bool full,
                                lanes history[CONTACT_LANES])
{
    if (full)
        for (int h = CONTACT_ROLLING_LANE; h < CONTACT_LANES; h++)
            for (int l = 0; l < WIDTH; l++)
                block->contact[l]->history[h] = history[h][l];
    double *rows[WIDTH];
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++) {
        block->contact[l]->overlap = block->overlap[l];
        rows[l] = block->contact[l]->history;
    }
    lanes_give_rows(rows, history);
}

LANES_INLINE struct contact_law_constants constants_of(const struct block *block, bool full)
{
    bool one = true;
    for (int l = 1; l < WIDTH; l++)
        one = one && block->pair[l] == block->pair[0];
    return one ? contact_law_constants_of_one(block->pair[0])
               : contact_law_constants_of_each(block->pair, full);
}

LANES_INLINE void cross(const lanes a[3], const lanes b[3], lanes product[3])
{
    product[0] = a[1] * b[2] - a[2] * b[1];
    product[1] = a[2] * b[0] - a[0] * b[2];
    product[2] = a[0] * b[1] - a[1] * b[0];
}

LANES_INLINE void subtract(const lanes a[3], const lanes b[3], lanes difference[3])
{
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        difference[x] = a[x] - b[x];
}

/* |x| + |y| + |z| */
LANES_INLINE lanes size_of(const lanes a[3])
{
    lanes sum = lanes_all(0.0);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        sum += (lanes)((lanes_mask)a[x] & INT64_MAX);
    return sum;
}

LANES_INLINE struct contact_law_meeting meeting_of(const struct block *block)
{
    struct contact_law_meeting meeting = {.overlap = block->overlap,
                                          .inverse_radius = block->spin[3],
                                          .width = block->width,
                                          .inverse_mass = block->spin[7] + block->yield};
    lanes rolling[3]; /* R w x n [m/s] */
    cross(block->spin, block->normal, rolling);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        meeting.normal[x] = block->normal[x];
        meeting.velocity[x] = block->wall[x] - (block->motion[4 + x] + rolling[x]);
        meeting.spin[x] = block->turns[x] - block->spin[4 + x];
    }
    return meeting;
}

/* Adds a term in limbs to the sum `s` of each lane's load. */
LANES_INLINE void add_term(const struct block *block, int s, const lanes_mask limbs[3])
{
    if (block->one_load) {
        lanes_exact_add(&block->load[0]->sums[s], limbs);
        return;
    }
    for (int l = 0; l < WIDTH; l++)
        for (int k = 0; k < 3; k++)
            block->load[l]->sums[s].limb[k][l] += limbs[k][l];
}

/* Gives the bodies the force on them, its torque (`twist` besides the force's), the work of
 * their motion and what springs took up.  `force` becomes what the exact sums took, so that
 * the spheres' is the opposite to the last bit. */
LANES_INLINE void load_bodies(const struct facet_kernel_work *work, const struct block *block,
                              lanes force[3], const lanes twist[3], const lanes *wound)
{
    const lanes dt = lanes_all(work->dt), none = lanes_all(0.0);
    const lanes path[3] = {dt * block->wall[0], dt * block->wall[1], dt * block->wall[2]};
    const lanes turn[3] = {dt * block->turns[0], dt * block->turns[1], dt * block->turns[2]};
    const lanes reach = 1.0 + size_of(block->point) + size_of(path);
    lanes_mask fits = size_of(force) * reach + size_of(twist) * (1.0 + size_of(turn)) <
                      lanes_all(LANES_EXACT_LIMIT);
    lanes_mask limbs[3];
    lanes torque[3];

    if (wound != NULL)
        fits &= lanes_exact_fits(*wound);
    if (lanes_any(~fits)) /* something has run away: take note of it */
        for (int l = 0; l < WIDTH; l++)
            block->load[l]->n_overflow += fits[l] == 0;
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        force[x] = lanes_exact_round(lanes_keep(fits, force[x]), limbs);
        add_term(block, x, limbs);
    }
    cross(block->point, force, torque);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        lanes_exact_round(lanes_keep(fits, torque[x] + twist[x]), limbs);
        add_term(block, 3 + x, limbs);
    }
    if (block->moves) {
        const lanes done = (none - contact_law_dot(force, path)) - contact_law_dot(twist, turn);
        lanes_exact_round(lanes_keep(fits, done), limbs);
        add_term(block, 6, limbs);
    }
    if (wound != NULL) {
        lanes_exact_round(lanes_keep(fits, *wound), limbs);
        add_term(block, 7, limbs);
    }
    for (int l = 0; l < WIDTH; l++)
        block->load[l]->n_terms++;
}

/* Adds rows to the spheres' force rows, in order. */
LANES_INLINE void add_rows(const struct facet_kernel_work *work, const struct block *block,
                           lanes rows[8])
{
    lanes_transpose(rows);
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++) {
        double *f = work->force[block->sphere[l]].lane;
#pragma GCC unroll 4
        for (int part = 0; part < PARTS; part++)
            lanes_store(f + WIDTH * part,
                        lanes_load(f + WIDTH * part) + rows[WIDTH * part + l]);
    }
}

/* All that follows from where and how spheres touch. */
LANES_INLINE lanes press(const struct facet_kernel_work *work, struct block *block,
                         struct contact_law_choice choice, lanes deepest)
{
    const struct contact_law_meeting meeting = meeting_of(block);
    const struct contact_law_constants constants = constants_of(block, choice.full);
    const lanes none = lanes_all(0.0), relative = block->overlap * block->spin[3];
    lanes history[CONTACT_LANES], turn[3], force[3], twist[3], rows[8];
    struct contact_law_result result;

    load_history(block, choice.full, history);
    contact_law(&meeting, &constants, lanes_all(work->dt), choice, history, &result);
    store_history(block, choice.full, history);
    cross(block->normal, result.tangential, turn);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        force[x] = result.normal * block->normal[x] + result.tangential[x]; /* on the body */
        twist[x] = choice.full ? result.torque[x] : none;
        rows[4 + x] = -block->motion[3] * turn[x] - twist[x];
    }
    load_bodies(work, block, force, twist, choice.ledger ? &result.wound : NULL);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        block->given[x] = force[x];
        rows[x] = -force[x];
    }
    rows[3] = choice.ledger ? result.lost_friction : none;
    rows[7] = choice.ledger ? result.lost_damping : none;
    add_rows(work, block, rows);
    return lanes_where(relative > deepest, relative, deepest);
}

static void note_deepest(struct facet_kernel_work *work, lanes deepest)
{
    for (int l = 0; l < WIDTH; l++)
        work->overlap_max = deepest[l] > work->overlap_max ? deepest[l] : work->overlap_max;
}

/* ---- Batches
 * ---------------------------------------------------------------------------------- */

/* Lanes beyond the last contact: the dummy, which touches nothing. */
static void pad(const struct facet_kernel_work *work, struct facet_kernel_batch *batch)
{
    for (int k = batch->n; k % WIDTH != 0; k++) {
        batch->contact[k] = work->dummy;
        batch->sphere[k] = work->dummy->sphere;
        batch->load[k] = batch->load[batch->n - 1];
        batch->pair[k] = batch->pair[batch->n - 1];
        batch->overlap[k] = batch->yield[k] = batch->width[k] = 0.0;
        for (int x = 0; x < 3; x++)
            batch->normal[x][k] = batch->point[x][k] = batch->wall[x][k] = batch->turns[x][k] =
                0.0;
    }
}

LANES_INLINE void block_of_batch(struct block *block, const struct facet_kernel_batch *batch,
                                 int k)
{
    block->one_load = true;
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++) {
        block->contact[l] = batch->contact[k + l];
        block->sphere[l] = batch->sphere[k + l];
        block->load[l] = batch->load[k + l];
        block->pair[l] = batch->pair[k + l];
        block->one_load = block->one_load && block->load[l] == block->load[0];
    }
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        block->normal[x] = lanes_load(&batch->normal[x][k]);
        block->point[x] = lanes_load(&batch->point[x][k]);
        block->wall[x] = lanes_load(&batch->wall[x][k]);
        block->turns[x] = lanes_load(&batch->turns[x][k]);
    }
    block->overlap = lanes_load(&batch->overlap[k]);
    block->yield = lanes_load(&batch->yield[k]);
    block->width = lanes_load(&batch->width[k]);
    block->moves = true;
}

LANES_INLINE void apply_batch(struct facet_kernel_work *work, struct facet_kernel_batch *batch,
                              struct contact_law_choice choice)
{
    lanes deepest = lanes_all(0.0);

    pad(work, batch);
    for (int k = 0; k < batch->n; k += WIDTH) {
        struct block block;
        block_of_batch(&block, batch, k);
        load_spheres(work, &block);
        deepest = press(work, &block, choice, deepest);
#pragma GCC unroll 3
        for (int x = 0; x < 3; x++)
            lanes_store(&batch->force[x][k], block.given[x]);
    }
    note_deepest(work, deepest);
}

/* ---- Runs
 * ------------------------------------------------------------------------------------- */

/* A face, the same in all lanes: see face_touches() in physics/contact_geometry.c, which this
 * is in lanes. */
struct face {
    int n;
    lanes normal[3];
    lanes from[4][3], inward[4][3], length_squared[4];
};

static inline struct face face_of(const struct mesh *mesh, int f)
{
    struct face face = {.n = mesh->faces[f].n};
    const struct vec3 *normal = &mesh->face_normal[f];
    const double *n[3] = {&normal->x, &normal->y, &normal->z};
    for (int x = 0; x < 3; x++)
        face.normal[x] = lanes_all(*n[x]);
    for (int k = 0; k < face.n; k++) {
        const struct mesh_border *border = &mesh->face_borders[f][k];
        const double from[3] = {border->from.x, border->from.y, border->from.z};
        const double inward[3] = {border->inward.x, border->inward.y, border->inward.z};
        for (int x = 0; x < 3; x++) {
            face.from[k][x] = lanes_all(from[x]);
            face.inward[k][x] = lanes_all(inward[x]);
        }
        face.length_squared[k] = lanes_all(border->length_squared);
    }
    return face;
}

/* Height over the plane of the centres in the block, and which of them touch. */
LANES_INLINE lanes_mask find_touching(const struct face *face, const struct block *block,
                                      lanes *height)
{
    const lanes *centre = block->motion, radius = block->motion[3];
    const lanes hair = CONTACT_GEOMETRY_SEAM * radius;
    lanes arm[3];

    subtract(centre, face->from[0], arm);
    *height = contact_law_dot(arm, face->normal);
    lanes_mask inside = (*height < radius) & (*height > -radius);
    for (int k = 0; k < face->n; k++) {
        subtract(centre, face->from[k], arm);
        const lanes beyond = -contact_law_dot(arm, face->inward[k]);
        inside &= ~((beyond > lanes_all(0.0)) &
                    (beyond * beyond > hair * hair * face->length_squared[k]));
    }
    return inside;
}

/* How the body moves, the same in all lanes. */
struct drift {
    lanes velocity[3], spin[3], pivot[3];
};

static inline void spread(struct vec3 a, lanes b[3])
{
    b[0] = lanes_all(a.x);
    b[1] = lanes_all(a.y);
    b[2] = lanes_all(a.z);
}

LANES_INLINE void find_wall(const struct drift *drift, struct block *block)
{
    lanes arm[3], swing[3];
    subtract(block->point, drift->pivot, arm);
    cross(drift->spin, arm, swing);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        block->wall[x] = block->moves ? drift->velocity[x] + swing[x] : lanes_all(0.0);
        block->turns[x] = block->moves ? drift->spin[x] : lanes_all(0.0);
    }
}

/* Finds out which spheres of the block touch the face; false where nothing begins, lasts or
 * ends. */
LANES_INLINE bool meet_face(const struct face *face, const struct drift *drift, bool exists,
                            struct block *block)
{
    lanes height, held = lanes_all(0.0);
    lanes_mask touches = find_touching(face, block, &height);
    if (!exists)
        touches = (lanes_mask){0};
    for (int l = 0; l < WIDTH; l++)
        held[l] = block->contact[l]->history[CONTACT_RADIUS_LANE];
    if (!lanes_any(touches | (held > lanes_all(0.0))))
        return false;
    const lanes_mask behind = height < lanes_all(0.0);
    block->overlap =
        lanes_keep(touches, block->motion[3] - lanes_where(behind, -height, height));
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        block->normal[x] = lanes_where(behind, face->normal[x], -face->normal[x]);
        block->point[x] = block->motion[x] + -height * face->normal[x];
    }
    find_wall(drift, block);
    return true;
}

/* Contacts and spheres of a run are far apart in memory. */
LANES_INLINE void fetch_ahead(const struct facet_kernel_work *work,
                              const struct facet_kernel_run *run, int k)
{
    for (int l = 0; l < WIDTH; l++) {
        const int ahead = k + FACET_KERNEL_AHEAD + l, i = run->spheres[ahead];
        __builtin_prefetch(run->contacts[ahead]->history);
        __builtin_prefetch(&run->contacts[ahead]->sphere);
        __builtin_prefetch(&work->motion[i]);
        __builtin_prefetch(&work->spin[i]);
        __builtin_prefetch(&work->force[i]);
    }
}

LANES_INLINE void apply_run(struct facet_kernel_work *work, const struct facet_kernel_run *run,
                            struct contact_law_choice choice)
{
    const struct body *body = run->body;
    const struct face face = face_of(&body->mesh, run->face);
    lanes deepest = lanes_all(0.0);
    struct block block = {.one_load = true,
                          .moves = body->moves,
                          .yield = lanes_all(0.0),
                          .width = lanes_all(1.0)};
    struct drift drift;

    spread(body->velocity_now, drift.velocity);
    spread(body->spin_now, drift.spin);
    spread(body->pivot_now, drift.pivot);
    for (int l = 0; l < WIDTH; l++)
        block.load[l] = run->load;
    for (int k = 0; k < run->n; k += WIDTH) {
        fetch_ahead(work, run, k);
#pragma GCC unroll 8
        for (int l = 0; l < WIDTH; l++) {
            const int i = run->spheres[k + l];
            block.contact[l] = run->contacts[k + l];
            block.sphere[l] = i;
            block.pair[l] =
                &work->pairs[work->material[i] * work->n_materials + body->material];
        }
        load_spheres(work, &block);
        if (meet_face(&face, &drift, body->exists, &block))
            deepest = press(work, &block, choice, deepest);
    }
    note_deepest(work, deepest);
}

/* ---- Circles
 * ---------------------------------------------------------------------------------- */

/* A triangle in each lane: see mesh_update_face() in model/mesh.c, which this is in lanes. */
struct triangles {
    lanes normal[3], inverse_area; /* of twice its area [1/m2] */
    lanes from[3][3], inward[3][3], length_squared[3];
};

/* Those of bodies of which each has these corners. */
LANES_INLINE void find_triangles(const struct vec3 *const place[WIDTH],
                                 const int *const corners[WIDTH], struct triangles *triangles)
{
    lanes along[3][3], across[3], area[3];
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        const double *at[WIDTH];
        lanes four[4];
#pragma GCC unroll 8
        for (int l = 0; l < WIDTH; l++)
            at[l] = &place[l][corners[l][k]].x;
        lanes_take_fours(at, four);
#pragma GCC unroll 3
        for (int x = 0; x < 3; x++)
            triangles->from[k][x] = four[x];
    }
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++)
        subtract(triangles->from[(k + 1) % 3], triangles->from[k], along[k]);
    subtract(triangles->from[2], triangles->from[0], across);
    cross(along[0], across, area);
    triangles->inverse_area = 1.0 / lanes_sqrt(contact_law_dot(area, area));
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        triangles->normal[x] = triangles->inverse_area * area[x];
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        cross(triangles->normal, along[k], triangles->inward[k]);
        triangles->length_squared[k] = contact_law_dot(along[k], along[k]);
    }
}

/* How balls are before their triangles: see look() in physics/contact_patch.c. */
struct before {
    lanes_mask circle, apart;
    lanes height, within[3];
};

LANES_INLINE void look(const struct triangles *triangles, const lanes motion[8],
                       struct before *before)
{
    const lanes radius = motion[3], none = lanes_all(0.0);
    lanes arm[3];
    subtract(motion, triangles->from[0], arm);
    before->height = contact_law_dot(arm, triangles->normal);
    const lanes above = lanes_where(before->height < none, -before->height, before->height);
    const lanes square = (radius - above) * (radius + above);
    before->apart = ~((before->height > -radius) & (before->height < radius));
    before->circle = before->height >= none;
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        subtract(motion, triangles->from[k], arm);
        const lanes within = contact_law_dot(arm, triangles->inward[k]);
        const lanes_mask is_cut = within * within < square * triangles->length_squared[k];
        before->within[k] = within;
        before->apart |= ~is_cut & (within < none);
        before->circle &= ~is_cut;
    }
    before->circle &= ~before->apart;
}

/* Of those that come soon. */
LANES_INLINE void fetch_circles(const struct facet_kernel_work *work,
                                const struct facet_kernel_circles *circles, int k)
{
    for (int ahead = k; ahead < k + WIDTH && ahead < circles->n; ahead++) {
        const struct facet_kernel_entry *entry = &circles->list[ahead];
        __builtin_prefetch(entry->contact->history);
        __builtin_prefetch(&entry->contact->overlap);
        __builtin_prefetch(&work->motion[entry->sphere]);
        __builtin_prefetch(&work->spin[entry->sphere]);
        __builtin_prefetch(&work->force[entry->sphere]);
    }
}

/* Which are as near as they must be to where they were. */
LANES_INLINE lanes_mask find_near(const struct facet_kernel_entry *const entry[WIDTH],
                                  double travelled, const lanes motion[8])
{
    const double *at[WIDTH];
    lanes from[4], way[3];
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++)
        at[l] = entry[l]->from;
    lanes_take_fours(at, from);
    subtract(motion, from, way);
    const lanes left = from[3] - lanes_all(travelled);
    return (left > lanes_all(0.0)) & (contact_law_dot(way, way) < left * left);
}

/* A block of entries from the k-th on as they are now; sets their kinds and returns as bits
 * which are circles. */
LANES_INLINE unsigned look_at_block(const struct facet_kernel_work *work,
                                    struct facet_kernel_circles *circles, int k,
                                    struct triangles *triangles, struct before *before)
{
    const struct facet_kernel_entry *entry[WIDTH];
    const struct vec3 *place[WIDTH];
    const int *corners[WIDTH];
    const double *rows[WIDTH];
    lanes motion[8], held = lanes_all(0.0);
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++) {
        entry[l] = &circles->list[k + l < circles->n ? k + l : k];
        place[l] = entry[l]->body->mesh.place;
        corners[l] = entry[l]->triangle.corners;
        rows[l] = work->motion[entry[l]->sphere].lane;
        held[l] = entry[l]->contact->history[CONTACT_RADIUS_LANE];
    }
    lanes_take_rows(rows, motion);
    find_triangles(place, corners, triangles);
    look(triangles, motion, before);
    const lanes_mask near = find_near(entry, circles->travelled, motion);
    const unsigned seen = lanes_bits(near), circle = lanes_bits(near & before->circle);
    const unsigned nothing = lanes_bits(before->apart & ~(held > lanes_all(0.0)));
    for (int l = 0; l < WIDTH; l++)
        circles->kind[k + l] = (unsigned char)((seen >> l & 1) == 0 ? FACET_KERNEL_GONE
                                               : circle >> l & 1    ? FACET_KERNEL_CIRCLE
                                               : nothing >> l & 1   ? FACET_KERNEL_NOTHING
                                                                    : FACET_KERNEL_OTHER);
    return k + WIDTH < circles->n ? circle : circle & ~(~0U << (circles->n - k));
}

static void find_kinds(const struct facet_kernel_work *work,
                       struct facet_kernel_circles *circles)
{
    struct triangles triangles;
    struct before before;
    for (int k = 0; k < circles->n; k += WIDTH)
        (void)look_at_block(work, circles, k, &triangles, &before);
}

/* Keeps what follows of the circles among a block, for those to come. */
LANES_INLINE void keep_circles(const struct triangles *triangles, const struct before *before,
                               struct facet_kernel_circle circles[WIDTH])
{
    lanes row[8];
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++)
        row[x] = triangles->normal[x];
    row[3] = before->height;
    row[4] = before->within[1] * triangles->inverse_area;
    row[5] = before->within[0] * triangles->inverse_area;
    row[6] = row[7] = lanes_all(0.0);
    double *at[WIDTH];
    for (int l = 0; l < WIDTH; l++)
        at[l] = circles[l].normal;
    lanes_give_rows(at, row);
}

/* Finds kinds, and keeps those that are circles; returns how many, padded with the last. */
LANES_INLINE int find_circles(const struct facet_kernel_work *work,
                              struct facet_kernel_circles *circles)
{
    int n = 0;
    for (int k = 0; k < circles->n; k += WIDTH) {
        struct triangles triangles;
        struct before before;
        struct facet_kernel_circle kept[WIDTH];
        fetch_circles(work, circles, k + FACET_KERNEL_AHEAD);
        unsigned found = look_at_block(work, circles, k, &triangles, &before);
        if (found == 0)
            continue;
        keep_circles(&triangles, &before, kept);
        for (; found != 0; found &= found - 1) {
            const int l = __builtin_ctz(found);
            circles->found[n] = k + l;
            circles->circle[n++] = kept[l];
        }
    }
    for (int pad = n; n > 0 && pad % WIDTH != 0; pad++) {
        circles->found[pad] = circles->found[n - 1];
        circles->circle[pad] = circles->circle[n - 1];
    }
    return n;
}

/* The corners that bear a circle's force, a triangle's three; where the third is the mean point
 * of a quad, its four. */
struct bearers {
    int n[WIDTH], corner[WIDTH][4];
    lanes weight[4]; /* together 1 */
};

/* By where the foot is. */
LANES_INLINE void find_bearers(const struct facet_kernel_entry *const entry[WIDTH], lanes first,
                               lanes third, struct bearers *bearers)
{
    const lanes second = (1.0 - first) - third;
    lanes has_mean = lanes_all(0.0);
    for (int l = 0; l < WIDTH; l++) {
        const struct facet_kernel_triangle *triangle = &entry[l]->triangle;
        int *corner = bearers->corner[l];
        const bool one = triangle->bearers[1] < 0;
        corner[0] = triangle->corners[0];
        corner[1] = triangle->corners[1];
        corner[2] = triangle->bearers[0];
        corner[3] = triangle->bearers[one ? 0 : 1];
        bearers->n[l] = one ? 3 : 4;
        has_mean[l] = one ? 0.0 : 1.0;
    }
    const lanes_mask mean = has_mean > lanes_all(0.0);
    const lanes passed = lanes_keep(mean, 0.25 * third);
    bearers->weight[0] = first + passed;
    bearers->weight[1] = second + passed;
    bearers->weight[2] = lanes_where(mean, passed, third);
    bearers->weight[3] = passed;
}

/* How the surface moves there, and how easily it yields. */
LANES_INLINE void move_with_corners(const struct facet_kernel_entry *const entry[WIDTH],
                                    const struct bearers *bearers, struct block *block)
{
    block->yield = block->wall[0] = block->wall[1] = block->wall[2] = lanes_all(0.0);
    for (int c = 0; c < 4; c++) {
        const double *velocities[WIDTH];
        lanes velocity[4], inverse_mass = lanes_all(0.0);
#pragma GCC unroll 8
        for (int l = 0; l < WIDTH; l++) {
            const struct body_skin *skin = entry[l]->body->skin;
            velocities[l] = &skin->velocity[bearers->corner[l][c]].x;
            inverse_mass[l] = skin->inverse_mass[bearers->corner[l][c]];
        }
        lanes_take_fours(velocities, velocity);
        const lanes weight = bearers->weight[c];
#pragma GCC unroll 3
        for (int x = 0; x < 3; x++)
            block->wall[x] += weight * velocity[x];
        block->yield += weight * weight * inverse_mass;
    }
}

/* Gives each corner its part of the force; the last has what is left. */
LANES_INLINE void push_corners(const struct facet_kernel_entry *const entry[WIDTH], int n,
                               const struct bearers *bearers, const lanes force[3])
{
    double f[3][WIDTH], weight[3][WIDTH];
    for (int k = 0; k < 3; k++) {
        lanes_store(f[k], force[k]);
        lanes_store(weight[k], bearers->weight[k]);
    }
    for (int l = 0; l < n; l++) {
        const struct body_skin *skin = entry[l]->body->skin;
        const int *corner = bearers->corner[l];
        const lanes_four all = {f[0][l], f[1][l], f[2][l], 0.0};
        const lanes_four first = weight[0][l] * all, second = weight[1][l] * all;
        lanes_four left = (all - first) - second;
        lanes_exact_add_vector(body_skin_push(skin, corner[0]), first);
        lanes_exact_add_vector(body_skin_push(skin, corner[1]), second);
        if (bearers->n[l] > 3) {
            const lanes_four third = weight[2][l] * all;
            lanes_exact_add_vector(body_skin_push(skin, corner[3]), left - third);
            left = third;
        }
        lanes_exact_add_vector(body_skin_push(skin, corner[2]), left);
    }
}

/* A block of them, the first n of which are not padding. */
LANES_INLINE void block_of_circles(const struct facet_kernel_work *work,
                                   const struct facet_kernel_entry *const entry[WIDTH], int n,
                                   struct block *block)
{
    block->one_load = true;
    block->moves = true;
    block->width = lanes_all(1.0);
#pragma GCC unroll 8
    for (int l = 0; l < WIDTH; l++) {
        const int i = l < n ? entry[l]->sphere : work->dummy->sphere;
        block->contact[l] = l < n ? entry[l]->contact : work->dummy;
        block->sphere[l] = i;
        block->load[l] = entry[l]->load;
        block->pair[l] = &work->pairs[work->material[entry[l]->sphere] * work->n_materials +
                                      entry[l]->body->material];
        block->one_load = block->one_load && block->load[l] == block->load[0];
        if (work->width != NULL && l < n)
            block->width[l] = work->width[i];
    }
}

/* The force of n of those found, from the k-th on. */
LANES_INLINE lanes press_circles(struct facet_kernel_work *work,
                                 const struct facet_kernel_circles *circles, int k, int n,
                                 struct contact_law_choice choice, lanes deepest)
{
    const struct facet_kernel_entry *entry[WIDTH];
    const double *rows[WIDTH];
    struct block block;
    struct bearers bearers;
    lanes circle[8], real = lanes_all(0.0);
    for (int l = 0; l < WIDTH; l++) {
        entry[l] = &circles->list[circles->found[k + l]];
        rows[l] = circles->circle[k + l].normal;
    }
    lanes_take_rows(rows, circle);
    block_of_circles(work, entry, n, &block);
    load_spheres(work, &block);
    find_bearers(entry, circle[4], circle[5], &bearers);
    move_with_corners(entry, &bearers, &block);
    for (int l = 0; l < n; l++)
        real[l] = 1.0;
    block.overlap = lanes_keep(real > lanes_all(0.0), block.motion[3] - circle[3]);
#pragma GCC unroll 3
    for (int x = 0; x < 3; x++) {
        block.normal[x] = -circle[x];
        block.point[x] = block.motion[x] + -circle[3] * circle[x];
        block.turns[x] = lanes_all(0.0);
    }
    deepest = press(work, &block, choice, deepest);
    push_corners(entry, n, &bearers, block.given);
    return deepest;
}

LANES_INLINE void apply_circles(struct facet_kernel_work *work,
                                struct facet_kernel_circles *circles,
                                struct contact_law_choice choice)
{
    const int n = find_circles(work, circles);
    lanes deepest = lanes_all(0.0);
    for (int k = 0; k < n; k += WIDTH)
        deepest =
            press_circles(work, circles, k, n - k < WIDTH ? n - k : WIDTH, choice, deepest);
    note_deepest(work, deepest);
}

/* Before or behind: the circle is near every side's line, or within. */
LANES_INLINE lanes_mask reach_triangles(const struct triangles *triangles,
                                        const lanes centre[3], lanes radius)
{
    const lanes none = lanes_all(0.0);
    lanes arm[3];
    subtract(centre, triangles->from[0], arm);
    const lanes height = contact_law_dot(arm, triangles->normal);
    const lanes square = (radius - height) * (radius + height);
    lanes_mask reaches = square > none;
#pragma GCC unroll 3
    for (int k = 0; k < 3; k++) {
        subtract(centre, triangles->from[k], arm);
        const lanes within = contact_law_dot(arm, triangles->inward[k]);
        reaches &= (within > none) | (within * within < square * triangles->length_squared[k]);
    }
    return reaches;
}

static void find_reaches(const struct body *body, int n, const struct facet_contact *entries,
                         struct vec3 centre, double radius, bool *reaches)
{
    lanes x[3];
    spread(centre, x);
    for (int k = 0; k < n; k += WIDTH) {
        const struct vec3 *place[WIDTH];
        const int *corners[WIDTH];
        struct triangles triangles;
#pragma GCC unroll 8
        for (int l = 0; l < WIDTH; l++) {
            const int face = entries[k + l < n ? k + l : k].feature;
            place[l] = body->mesh.place;
            corners[l] = body->mesh.faces[face].vertices;
        }
        find_triangles(place, corners, &triangles);
        const unsigned bits = lanes_bits(reach_triangles(&triangles, x, lanes_all(radius)));
        for (int l = 0; l < WIDTH && k + l < n; l++)
            reaches[k + l] = (bits >> l & 1) != 0;
    }
}

#define APPLY(name, ...)                                                                       \
    static void name##_batch(struct facet_kernel_work *work, struct facet_kernel_batch *batch) \
    {                                                                                          \
        apply_batch(work, batch, (struct contact_law_choice){__VA_ARGS__});                    \
    }                                                                                          \
    static void name##_run(struct facet_kernel_work *work, const struct facet_kernel_run *run) \
    {                                                                                          \
        apply_run(work, run, (struct contact_law_choice){__VA_ARGS__});                        \
    }                                                                                          \
    static void name##_circles(struct facet_kernel_work *work,                                 \
                               struct facet_kernel_circles *circles)                           \
    {                                                                                          \
        apply_circles(work, circles, (struct contact_law_choice){__VA_ARGS__});                \
    }
#define KERNEL(name)                                                                           \
    {                                                                                          \
        name##_batch, name##_run, find_reaches, find_kinds, name##_circles                     \
    }
APPLY(apply_plain, .ledger = false)
APPLY(apply_ledger, .ledger = true)
APPLY(apply_full, .full = true)
APPLY(apply_full_ledger, .full = true, .ledger = true)

struct facet_kernel_blocks ISA_OFFER(facet_kernel_blocks)(void)
{
    return (struct facet_kernel_blocks){{{KERNEL(apply_plain), KERNEL(apply_ledger)},
                                         {KERNEL(apply_full), KERNEL(apply_full_ledger)}}};
}
