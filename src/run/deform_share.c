/* See deform_share.h. */
#include "run/deform_share.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/solid_ball.h"
#include "run/deform_state.h"
#include "run/simulation.h"

/* Why a rank has a copy of a node. */
enum { FOR_ELEMENT = 1, TOUCHED = 2, FOR_NORMAL = 4 };

void deform_share_init(struct deform_share *share, const struct comm *comm, struct solid *solid)
{
    const size_t n = (size_t)solid->n_nodes;
    *share = (struct deform_share){.owner = array_allocate(n, sizeof *share->owner),
                                   .copy = array_allocate(n, sizeof *share->copy)};
    share->peers = array_allocate((size_t)comm->n_ranks, sizeof *share->peers);
    bool *moves = array_allocate(n, sizeof *moves);
    for (int i = 0; i < solid->n_nodes; i++) {
        share->owner[i] = (int)((int64_t)i * comm->n_ranks / solid->n_nodes);
        moves[i] = share->owner[i] == comm->rank;
    }
    solid_assign(solid, moves);
    for (int k = 0; k < solid->n_here; k++)
        share->copy[solid->here[k]] = FOR_ELEMENT;
    free(moves);
}

void deform_share_mark_rings(struct deform_body *deform)
{
    const struct skin *shape = &deform->skin.shape;
    unsigned char *copy = deform->share.copy;
    for (int r = 0; r < shape->n_rings; r++) {
        const struct skin_ring *ring = &shape->rings[r];
        const bool needed = (copy[ring->node] & (FOR_ELEMENT | TOUCHED)) != 0;
        for (int k = ring->begin; needed && k < ring->end; k++) {
            const int *corners = shape->sheets[shape->around[k]].corners;
            for (int c = 0; c < 4 && corners[c] >= 0; c++)
                copy[corners[c]] |= FOR_NORMAL;
        }
    }
}

void deform_share_clear(struct deform_share *share, const struct comm *comm)
{
    for (int q = 0; q < comm->n_ranks; q++) {
        free(share->peers[q].told);
        free(share->peers[q].heard);
        free(share->peers[q].pushed);
    }
    free(share->peers);
    free(share->owner);
    free(share->copy);
    free(share->touched);
    *share = (struct deform_share){0};
}

bool deform_share_has(const struct deform_body *deform, int node)
{
    return deform->solid.moves[node] || deform->share.copy[node] != 0;
}

static void append(int **list, int *n, int *capacity, int value)
{
    ARRAY_GROW(*list, *n + 1, *capacity);
    (*list)[(*n)++] = value;
}

/* What goes to a rank at a renewal: a face that its spheres may touch, or the state of a node
 * or an element, whose record follows. */
enum { FACE = DEFORM_STATE_N_KINDS };

struct item {
    int body, kind, index;
};

static void pack_item(struct simulation *sim, int to, struct item item)
{
    unsigned char record[DEFORM_STATE_MOST];
    comm_mail_pack(&sim->deform.mail, to, &item, sizeof item);
    if (item.kind == FACE)
        return;
    deform_state_pack(&sim->deform, &sim->deform.list[item.body].solid,
                      (enum deform_state_kind)item.kind, item.index, record);
    comm_mail_pack(&sim->deform.mail, to, record,
                   deform_state_size(&sim->deform, (enum deform_state_kind)item.kind));
}

/* ---- Which faces spheres may touch
 * ------------------------------------------------------------ */

struct extent {
    double low[3], high[3]; /* [m] */
};

static void widen(struct extent *extent, struct vec3 place, double margin)
{
    const double x[3] = {place.x, place.y, place.z};
    for (int k = 0; k < 3; k++) {
        extent->low[k] = x[k] - margin < extent->low[k] ? x[k] - margin : extent->low[k];
        extent->high[k] = x[k] + margin > extent->high[k] ? x[k] + margin : extent->high[k];
    }
}

static const struct extent EMPTY = {{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};

/* Is it this rank that moves the face's first corner? */
static bool face_counts(const struct deform_body *deform, const struct mesh *mesh, int f)
{
    int k = 0;
    while (mesh->faces[f].vertices[k] >= mesh->n_corners)
        k++;
    return deform->solid.moves[deform->skin.nodes[mesh->faces[f].vertices[k]]];
}

/* A reference that looks at all pairs has all faces everywhere. */
static bool is_reached(const struct simulation *sim, int rank, const struct extent *extent)
{
    return sim->job->force.search == JOB_SEARCH_ALL_PAIRS ||
           halo_reaches(&sim->halo, rank, extent->low, extent->high) ||
           touch_reaches(&sim->touch, rank, extent->low, extent->high);
}

static void offer_faces(struct simulation *sim, int b)
{
    const struct deform_body *deform = &sim->deform.list[b];
    const struct mesh *mesh = &sim->bodies.list[deform->body].mesh;
    const double allowance = sim->body_allowance[deform->body];
    struct extent *extents = array_allocate((size_t)deform->skin.n_faces, sizeof *extents);
    int *faces = array_allocate((size_t)deform->skin.n_faces, sizeof *faces), n = 0;
    struct extent all = EMPTY;
    for (int k = 0; k < deform->skin.n_faces; k++) {
        const int f = deform->skin.faces[k];
        if (!face_counts(deform, mesh, f))
            continue;
        extents[n] = EMPTY;
        for (int c = 0; c < mesh->faces[f].n; c++) {
            widen(&extents[n], mesh->place[mesh->faces[f].vertices[c]], allowance);
            widen(&all, mesh->place[mesh->faces[f].vertices[c]], allowance);
        }
        faces[n++] = f;
    }
    for (int q = 0; n > 0 && q < sim->comm->n_ranks; q++)
        for (int k = 0; is_reached(sim, q, &all) && k < n; k++)
            if (is_reached(sim, q, &extents[k]))
                pack_item(sim, q, (struct item){b, FACE, faces[k]});
    free(extents);
    free(faces);
}

/* ---- Who moves what
 * --------------------------------------------------------------------------- */

struct change {
    int body, node, owner;
};

/* Nodes that have left their owners' subdomains, of all ranks. */
static struct change *find_changes(const struct simulation *sim, int *n)
{
    const struct comm *comm = sim->comm;
    int n_own = 0, capacity = 0;
    struct change *own = NULL;
    for (int b = 0; b < sim->deform.n; b++) {
        const struct solid *solid = &sim->deform.list[b].solid;
        for (int k = 0; k < solid->n_here; k++) {
            const int i = solid->here[k];
            const int owner =
                solid->moves[i] ? boxes_owner(&sim->boxes, solid_place(solid, i)) : comm->rank;
            if (owner == comm->rank)
                continue;
            ARRAY_GROW(own, n_own + 1, capacity);
            own[n_own++] = (struct change){b, i, owner};
        }
    }
    struct change *all = comm_gather_records(comm, own, n_own, sizeof *own, n);
    free(own);
    return all;
}

static bool is_among(const int *ranks, int n, int rank)
{
    for (int k = 0; k < n; k++)
        if (ranks[k] == rank)
            return true;
    return false;
}

/* An element's state to those who compute it from now on, and have not until now. */
static void hand_over_element(struct simulation *sim, int b, int e, const int *next)
{
    const struct solid *solid = &sim->deform.list[b].solid;
    const int n = solid_element_corners(solid->shape[e]), *corners = solid->corners[e];
    int had[SOLID_ELEMENT_CORNERS], n_had = 0;
    for (int c = 0; c < n; c++)
        had[n_had++] = sim->deform.list[b].share.owner[corners[c]];
    int given[SOLID_ELEMENT_CORNERS], n_given = 0;
    for (int c = 0; c < n; c++) {
        const int q = next[corners[c]];
        if (is_among(had, n_had, q) || is_among(given, n_given, q))
            continue;
        pack_item(sim, q, (struct item){b, DEFORM_STATE_ELEMENT, e});
        given[n_given++] = q;
    }
}

/* Is `node` the first of the element's corners that others move from now on? */
static bool changes_first_by(const struct deform_body *deform, int e, const int *next, int node)
{
    const int *corners = deform->solid.corners[e];
    int c = 0;
    while (next[corners[c]] == deform->share.owner[corners[c]])
        c++;
    return corners[c] == node;
}

/* Sends the state of what others have from now on. */
static void hand_over(struct simulation *sim, const struct change *changes, int n,
                      int *const *next)
{
    for (int k = 0; k < n; k++) {
        const struct change *change = &changes[k];
        const struct deform_body *deform = &sim->deform.list[change->body];
        const struct solid *solid = &deform->solid;
        const int i = change->node;
        if (solid->moves[i])
            pack_item(sim, change->owner, (struct item){change->body, DEFORM_STATE_NODE, i});
        for (int m = solid->first[i]; m < solid->first[i + 1]; m++) {
            const int e = solid->meets[m] / SOLID_ELEMENT_CORNERS;
            if (solid_counts(solid, e) && changes_first_by(deform, e, next[change->body], i))
                hand_over_element(sim, change->body, e, next[change->body]);
        }
        sim->runtime.nodes_migrated += solid->moves[i];
    }
}

static void take_items(struct simulation *sim)
{
    unsigned char record[DEFORM_STATE_MOST];
    struct comm_mail *mail = &sim->deform.mail;
    struct item item;
    for (int q = 0; q < sim->comm->n_ranks; q++)
        while (comm_mail_waits(mail, q)) {
            comm_mail_unpack(mail, q, &item, sizeof item);
            struct deform_body *deform = &sim->deform.list[item.body];
            if (item.kind == FACE) {
                append(&deform->share.touched, &deform->share.n_touched,
                       &deform->share.touched_capacity, item.index);
                continue;
            }
            const enum deform_state_kind kind = (enum deform_state_kind)item.kind;
            comm_mail_unpack(mail, q, record, deform_state_size(&sim->deform, kind));
            deform_state_unpack(&sim->deform, &deform->solid, kind, item.index, record);
        }
}

/* Makes `next` who moves the nodes of a body; frees what was. */
static void assign(struct deform_body *deform, int rank, int *next)
{
    const int n = deform->solid.n_nodes;
    bool *moves = array_allocate((size_t)n, sizeof *moves);
    for (int i = 0; i < n; i++)
        moves[i] = next[i] == rank;
    solid_assign(&deform->solid, moves);
    free(moves);
    free(deform->share.owner);
    deform->share.owner = next;
    deform->share.n_changes++;
}

static void exchange_owners(struct simulation *sim)
{
    int n;
    struct change *changes = find_changes(sim, &n);
    int **next = array_allocate((size_t)sim->deform.n, sizeof *next);
    for (int k = 0; k < n; k++) {
        const struct deform_body *deform = &sim->deform.list[changes[k].body];
        const size_t n_nodes = (size_t)deform->solid.n_nodes;
        int **mine = &next[changes[k].body];
        if (*mine == NULL) {
            *mine = array_allocate(n_nodes, sizeof **mine);
            memcpy(*mine, deform->share.owner, n_nodes * sizeof **mine);
        }
        (*mine)[changes[k].node] = changes[k].owner;
        sim->deform.list[changes[k].body].share.n_left++;
    }
    hand_over(sim, changes, n, next);
    comm_mail_exchange(&sim->deform.mail, sim->comm);
    take_items(sim);
    for (int b = 0; b < sim->deform.n; b++)
        if (next[b] != NULL)
            assign(&sim->deform.list[b], sim->comm->rank, next[b]);
    free(next);
    free(changes);
}

/* ---- Who needs copies
 * ------------------------------------------------------------------------- */

/* The corners of a face that spheres may touch. */
static void mark_face(struct deform_body *deform, const struct mesh *mesh, int f)
{
    for (int k = 0; k < mesh->faces[f].n; k++) {
        const int v = mesh->faces[f].vertices[k];
        const bool is_mean = v >= mesh->n_corners;
        const int *corners = is_mean ? mesh->mean_of[v - mesh->n_corners] : &v;
        for (int c = 0; c < (is_mean ? 4 : 1); c++)
            deform->share.copy[deform->skin.nodes[corners[c]]] |= TOUCHED;
    }
}

struct request {
    int body, node;
    bool pushes;
};

static void request_copies(struct simulation *sim, int b)
{
    struct deform_body *deform = &sim->deform.list[b];
    struct deform_share *share = &deform->share;
    const struct solid *solid = &deform->solid;
    const struct mesh *mesh = &sim->bodies.list[deform->body].mesh;
    struct request request;
    memset(&request, 0, sizeof request);
    memset(share->copy, 0, (size_t)solid->n_nodes);
    for (int k = 0; k < solid->n_here; k++)
        share->copy[solid->here[k]] = FOR_ELEMENT;
    for (int t = 0; t < share->n_touched; t++)
        mark_face(deform, mesh, share->touched[t]);
    deform_share_mark_rings(deform);
    for (int k = 0; k < deform->n_balls; k++)
        for (int m = 0; solid->moves[deform->balls[k].outer] && m < deform->balls[k].n_inner;
             m++)
            share->copy[deform->balls[k].inner[m]] |= TOUCHED;
    for (int i = 0; i < solid->n_nodes; i++) {
        struct deform_share_peer *peer = &share->peers[share->owner[i]];
        if (share->copy[i] == 0 || solid->moves[i])
            continue;
        append(&peer->heard, &peer->n_heard, &peer->heard_capacity, i);
        request.body = b;
        request.node = i;
        request.pushes = (share->copy[i] & TOUCHED) != 0;
        comm_mail_pack(&sim->deform.mail, share->owner[i], &request, sizeof request);
    }
    for (int v = 0; v < deform->skin.n_points; v++) {
        const int i = deform->skin.nodes[v];
        struct deform_share_peer *peer = &share->peers[share->owner[i]];
        if ((share->copy[i] & TOUCHED) != 0 && !solid->moves[i])
            append(&peer->pushed, &peer->n_pushed, &peer->pushed_capacity, v);
    }
}

static void take_requests(struct simulation *sim, int q)
{
    struct request request;
    while (comm_mail_waits(&sim->deform.mail, q)) {
        comm_mail_unpack(&sim->deform.mail, q, &request, sizeof request);
        struct deform_share_peer *peer = &sim->deform.list[request.body].share.peers[q];
        CHECK(sim->deform.list[request.body].solid.moves[request.node],
              "node %d is asked for where it is not moved", request.node);
        append(&peer->told, &peer->n_told, &peer->told_capacity, request.node);
        peer->pushes = peer->pushes || request.pushes;
    }
}

/* Lists whom there is something to tell or push. */
static void list_ranks(struct simulation *sim)
{
    struct deform *deform = &sim->deform;
    deform->n_near = deform->n_pushing = 0;
    for (int q = 0; q < sim->comm->n_ranks; q++) {
        bool near = false, pushing = false;
        for (int b = 0; b < deform->n; b++) {
            const struct deform_share_peer *peer = &deform->list[b].share.peers[q];
            near = near || peer->n_told > 0 || peer->n_heard > 0;
            pushing = pushing || peer->n_pushed > 0 || peer->pushes;
        }
        if (near)
            deform->near[deform->n_near++] = q;
        if (pushing)
            deform->pushing[deform->n_pushing++] = q;
    }
}

static void exchange_requests(struct simulation *sim)
{
    comm_mail_begin(&sim->deform.mail);
    for (int b = 0; b < sim->deform.n; b++)
        request_copies(sim, b);
    comm_mail_exchange(&sim->deform.mail, sim->comm);
    for (int q = 0; q < sim->comm->n_ranks; q++)
        take_requests(sim, q);
    list_ranks(sim);
}

/* What others have by now takes no memory here, as far as that comes in whole pages. */
static void forget(struct deform_body *deform, struct mesh *mesh)
{
    enum { SOME = 8 }; /* below that part of all nodes it does not pay */
    const int n = deform->solid.n_nodes;
    if (deform->share.n_left < n / SOME)
        return;
    deform->share.n_left = 0;
    bool *keep = array_allocate((size_t)n, sizeof *keep);
    for (int i = 0; i < n; i++)
        keep[i] = deform_share_has(deform, i);
    solid_forget(&deform->solid, keep);
    deform_skin_forget(&deform->skin, mesh);
    free(keep);
}

void deform_share_renew(struct simulation *sim)
{
    struct deform *deform = &sim->deform;
    if (sim->comm->n_ranks == 1 || deform->n == 0)
        return;
    touch_find_extents(sim);
    comm_mail_begin(&deform->mail);
    for (int b = 0; b < deform->n; b++) {
        struct deform_share *share = &deform->list[b].share;
        share->n_touched = 0;
        for (int q = 0; q < sim->comm->n_ranks; q++) {
            struct deform_share_peer *peer = &share->peers[q];
            peer->n_told = peer->n_heard = peer->n_pushed = 0;
            peer->pushes = false;
        }
        offer_faces(sim, b);
    }
    exchange_owners(sim);
    exchange_requests(sim);
    deform_share_tell(sim);
    for (int b = 0; b < deform->n; b++) {
        struct body *body = &sim->bodies.list[deform->list[b].body];
        deform_skin_renew(&deform->list[b], body);
        forget(&deform->list[b], &body->mesh);
    }
}

/* ---- Each step
 * -------------------------------------------------------------------------------- */

/* Exchanges what was packed, and counts it. */
static void exchange(struct simulation *sim, int n, const int *ranks)
{
    for (int k = 0; k < n; k++)
        sim->runtime.told += (int64_t)sim->deform.mail.out[ranks[k]].n;
    comm_mail_exchange_with(&sim->deform.mail, sim->comm, n, ranks);
}

void deform_share_tell(struct simulation *sim)
{
    enum { HALF = 3 * sizeof(double) };
    struct deform *deform = &sim->deform;
    struct comm_mail *mail = &deform->mail;
    comm_mail_begin(mail);
    for (int k = 0; k < deform->n_near; k++)
        for (int b = 0; b < deform->n; b++) {
            const struct deform_share_peer *peer =
                &deform->list[b].share.peers[deform->near[k]];
            const struct solid *solid = &deform->list[b].solid;
            for (int m = 0; m < peer->n_told; m++) {
                comm_mail_pack(mail, deform->near[k], solid_place(solid, peer->told[m]), HALF);
                comm_mail_pack(mail, deform->near[k], solid_velocity(solid, peer->told[m]),
                               HALF);
                if (solid->turns.n_nodes > 0)
                    comm_mail_pack(mail, deform->near[k],
                                   solid_turn_spin(&solid->turns, peer->told[m]), HALF);
            }
        }
    exchange(sim, deform->n_near, deform->near);
    for (int k = 0; k < deform->n_near; k++)
        for (int b = 0; b < deform->n; b++) {
            const struct deform_share_peer *peer =
                &deform->list[b].share.peers[deform->near[k]];
            struct solid *solid = &deform->list[b].solid;
            for (int m = 0; m < peer->n_heard; m++) {
                comm_mail_unpack(mail, deform->near[k], solid_place(solid, peer->heard[m]),
                                 HALF);
                comm_mail_unpack(mail, deform->near[k], solid_velocity(solid, peer->heard[m]),
                                 HALF);
                if (solid->turns.n_nodes > 0)
                    comm_mail_unpack(mail, deform->near[k],
                                     solid_turn_spin(&solid->turns, peer->heard[m]), HALF);
            }
        }
}

/* What spheres here do to a corner of a skin. */
struct push {
    int body, vertex;
    struct exact_vector force;
};

static void pack_pushes(struct simulation *sim, int b, int q)
{
    const struct deform_body *deform = &sim->deform.list[b];
    const struct body_skin *skin = sim->bodies.list[deform->body].skin;
    const struct deform_share_peer *peer = &deform->share.peers[q];
    struct push push;
    memset(&push, 0, sizeof push);
    push.body = b;
    for (int m = 0; m < peer->n_pushed; m++) {
        push.vertex = peer->pushed[m];
        if (!skin->pushed[push.vertex])
            continue;
        push.force = skin->force[push.vertex];
        comm_mail_pack(&sim->deform.mail, q, &push, sizeof push);
    }
}

void deform_share_push(struct simulation *sim)
{
    struct deform *deform = &sim->deform;
    struct push push;
    comm_mail_begin(&deform->mail);
    for (int k = 0; k < deform->n_pushing; k++)
        for (int b = 0; b < deform->n; b++)
            pack_pushes(sim, b, deform->pushing[k]);
    exchange(sim, deform->n_pushing, deform->pushing);
    for (int k = 0; k < deform->n_pushing; k++)
        while (comm_mail_waits(&deform->mail, deform->pushing[k])) {
            comm_mail_unpack(&deform->mail, deform->pushing[k], &push, sizeof push);
            struct body_skin *skin = sim->bodies.list[deform->list[push.body].body].skin;
            exact_vector_merge(body_skin_push(skin, push.vertex), &push.force);
        }
}
