/* See halo.h. */
#include "domain/halo.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "contact/candidates.h"
#include "domain/boxes.h"
#include "model/sphere.h"

enum { LEVELS = CANDIDATES_LEVELS, MOTION = 9 };

/* The owned centres of one level on one rank; low > high when there are none. */
struct level_box {
    double low[3], high[3], reach;
};

struct rank_boxes {
    struct level_box level[LEVELS];
};

void halo_init(struct halo *halo, const struct comm *comm)
{
    *halo = (struct halo){0};
    halo->peers = array_allocate((size_t)comm->n_ranks, sizeof *halo->peers);
    halo->requests = array_allocate(2 * (size_t)comm->n_ranks, sizeof(MPI_Request));
    halo->all_boxes = array_allocate((size_t)comm->n_ranks, sizeof(struct rank_boxes));
    comm_mail_init(&halo->mail, comm);
}

void halo_clear(struct halo *halo)
{
    for (int p = 0; p < halo->mail.n_ranks; p++) {
        free(halo->peers[p].send);
        free(halo->peers[p].receive);
        free(halo->peers[p].image);
        free(halo->peers[p].out);
        free(halo->peers[p].in);
    }
    comm_mail_clear(&halo->mail);
    free(halo->peers);
    free(halo->requests);
    free(halo->all_boxes);
    *halo = (struct halo){0};
}

static int level_of(double reach, double least)
{
    int level = 0;
    while (!(reach < least * candidates_level_bound[level]) && level < LEVELS - 1)
        level++;
    return level;
}

static struct rank_boxes own_boxes(const struct comm *comm, const struct spheres *spheres)
{
    struct rank_boxes boxes;
    for (int l = 0; l < LEVELS; l++)
        boxes.level[l] =
            (struct level_box){{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}, 0.0};
    double least = 1e300;
    for (int i = 0; i < spheres->n_owned; i++) {
        const double reach = sphere_reach(spheres, i);
        least = reach < least ? reach : least;
    }
    comm_min(comm, &least, 1);
    for (int i = 0; i < spheres->n_owned; i++) {
        const double reach = sphere_reach(spheres, i), *x = sphere_position(spheres, i);
        struct level_box *box = &boxes.level[level_of(reach, least)];
        for (int k = 0; k < 3; k++) {
            box->low[k] = x[k] < box->low[k] ? x[k] : box->low[k];
            box->high[k] = x[k] > box->high[k] ? x[k] : box->high[k];
        }
        box->reach = reach > box->reach ? reach : box->reach;
    }
    return boxes;
}

/* May a sphere at x with this reach touch a centre in the box within its reach? */
static bool meets(const struct level_box *box, const double *x, double reach)
{
    double distance2 = 0.0;
    for (int k = 0; k < 3; k++) {
        const double below = box->low[k] - x[k], above = x[k] - box->high[k];
        const double off = below > above ? below : above;
        distance2 += off > 0.0 ? off * off : 0.0;
    }
    const double sum = reach + box->reach;
    /* A little more than needed, so that rounding loses nothing. */
    return distance2 <= sum * sum * 1.000001;
}

/* May anything of ours touch anything of that rank's? */
static bool boxes_meet(const struct level_box *a, const struct level_box *b)
{
    for (int k = 0; k < 3; k++) {
        const double sum = (a->reach + b->reach) * 1.000001;
        if (a->low[k] > b->high[k] + sum || b->low[k] > a->high[k] + sum)
            return false;
    }
    return true;
}

static bool ranks_meet(const struct rank_boxes *a, const struct rank_boxes *b)
{
    for (int k = 0; k < LEVELS * LEVELS; k++) {
        const struct level_box *p = &a->level[k / LEVELS], *q = &b->level[k % LEVELS];
        if (p->low[0] <= p->high[0] && q->low[0] <= q->high[0] && boxes_meet(p, q))
            return true;
    }
    return false;
}

static struct rank_boxes shifted(const struct rank_boxes *boxes, const double shift[3])
{
    struct rank_boxes there = *boxes;
    for (int l = 0; l < LEVELS; l++) {
        for (int k = 0; k < 3; k++) {
            there.level[l].low[k] += shift[k];
            there.level[l].high[k] += shift[k];
        }
    }
    return there;
}

/* One box around all levels' centres and reaches. */
static struct level_box around(const struct rank_boxes *boxes)
{
    struct level_box all = {{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}, 0.0};
    for (int l = 0; l < LEVELS; l++) {
        const struct level_box *box = &boxes->level[l];
        for (int k = 0; k < 3; k++) {
            all.low[k] = box->low[k] < all.low[k] ? box->low[k] : all.low[k];
            all.high[k] = box->high[k] > all.high[k] ? box->high[k] : all.high[k];
        }
        all.reach = box->reach > all.reach ? box->reach : all.reach;
    }
    return all;
}

static bool is_needed(const double *x, double reach, const struct rank_boxes *there)
{
    for (int l = 0; l < LEVELS; l++) {
        const struct level_box *box = &there->level[l];
        if (box->low[0] <= box->high[0] && meets(box, x, reach))
            return true;
    }
    return false;
}

/* A little more than searches look for, so that rounding loses nothing. */
static bool box_reaches(const struct level_box *box, const double shift[3], const double low[3],
                        const double high[3])
{
    const double reach = box->reach * 1.00001;
    for (int k = 0; k < 3; k++)
        if (low[k] > box->high[k] + shift[k] + reach ||
            high[k] < box->low[k] + shift[k] - reach)
            return false;
    return true;
}

bool halo_reaches(const struct halo *halo, int rank, const double low[3], const double high[3])
{
    const struct rank_boxes *all = halo->all_boxes;
    for (int l = 0; l < LEVELS; l++) {
        const struct level_box *box = &all[rank].level[l];
        for (int s = 0; box->low[0] <= box->high[0] && s < halo->n_shifts; s++)
            if (box_reaches(box, halo->shifts[s], low, high))
                return true;
    }
    return false;
}

static void add_send(struct halo_peer *peer, int i, int shift)
{
    ARRAY_GROW(peer->send, peer->n_send + 1, peer->send_capacity);
    ARRAY_GROW(peer->image, peer->n_send + 1, peer->image_capacity);
    peer->image[peer->n_send] = (unsigned char)shift;
    peer->send[peer->n_send++] = i;
}

/* Spheres that a rank needs as they are. */
static void choose_plain(struct halo_peer *peer, const struct spheres *spheres,
                         const struct rank_boxes *there)
{
    for (int i = 0; i < spheres->n_owned; i++) {
        if (is_needed(sphere_position(spheres, i), sphere_reach(spheres, i), there))
            add_send(peer, i, 0);
    }
    peer->n_plain = peer->n_send;
}

/* Images of spheres that a rank needs.  Most spheres are far from the boundary: one look says
 * so. */
static void choose_images(struct halo_peer *peer, const struct spheres *spheres,
                          const struct rank_boxes *there, const double shift[3], int code)
{
    const struct level_box near = around(there);
    for (int i = 0; i < spheres->n_owned; i++) {
        const double *x = sphere_position(spheres, i), reach = sphere_reach(spheres, i);
        const double image[3] = {x[0] + shift[0], x[1] + shift[1], x[2] + shift[2]};
        if (meets(&near, image, reach) && is_needed(image, reach, there))
            add_send(peer, i, code);
    }
}

static void choose_sends(struct halo *halo, const struct comm *comm,
                         const struct spheres *spheres)
{
    const struct rank_boxes own = own_boxes(comm, spheres);
    struct rank_boxes *all = halo->all_boxes;
    comm_gather_all(comm, &own, all, sizeof own);
    halo->n_peers = 0;
    halo->n_shifts = periodic_shifts(&spheres->periodic, halo->shifts);
    for (int q = 0; q < comm->n_ranks; q++) {
        struct halo_peer *peer = &halo->peers[halo->n_peers];
        bool is_peer = false;
        peer->rank = q;
        peer->n_send = peer->n_plain = 0;
        if (q != comm->rank && ranks_meet(&own, &all[q])) {
            choose_plain(peer, spheres, &all[q]);
            is_peer = true;
        }
        for (int s = 1; s < halo->n_shifts; s++) {
            const struct rank_boxes image = shifted(&own, halo->shifts[s]);
            if (!ranks_meet(&image, &all[q]))
                continue;
            choose_images(peer, spheres, &all[q], halo->shifts[s], s);
            is_peer = true;
        }
        halo->n_peers += is_peer;
    }
}

/* A sphere's field as the peer is to see it: images lie elsewhere. */
static void pack_field(struct halo *halo, const struct halo_peer *peer, int k, int f,
                       const struct field_view *view)
{
    const void *value = field_at(view, peer->send[k]);
    double place[3];
    if (f == SPHERE_POSITION && k >= peer->n_plain) {
        memcpy(place, value, sizeof place);
        for (int c = 0; c < 3; c++)
            place[c] += halo->shifts[peer->image[k]][c];
        value = place;
    }
    comm_mail_pack(&halo->mail, peer->rank, value, field_size(&sphere_fields[f]));
}

static void send_ghosts(struct halo *halo, const struct comm *comm,
                        const struct spheres *spheres)
{
    comm_mail_begin(&halo->mail);
    for (int p = 0; p < halo->n_peers; p++) {
        const struct halo_peer *peer = &halo->peers[p];
        for (int k = 0; k < peer->n_send; k++) {
            for (int f = 0; f < SPHERE_N_FIELDS; f++) {
                const struct field_view view = sphere_view(spheres, f);
                if (sphere_fields[f].use & FIELD_GHOST)
                    pack_field(halo, peer, k, f, &view);
            }
        }
    }
    comm_mail_exchange(&halo->mail, comm);
}

static void receive_ghosts(struct halo *halo, struct spheres *spheres)
{
    int n = spheres->n_owned;
    for (int p = 0; p < halo->n_peers; p++) {
        struct halo_peer *peer = &halo->peers[p];
        peer->n_receive = 0;
        while (comm_mail_waits(&halo->mail, peer->rank)) {
            spheres_reserve(spheres, n + 1);
            for (int f = 0; f < SPHERE_N_FIELDS; f++) {
                const struct field_view view = sphere_view(spheres, f);
                if (sphere_fields[f].use & FIELD_GHOST)
                    comm_mail_unpack(&halo->mail, peer->rank, field_at(&view, n),
                                     field_size(&sphere_fields[f]));
                else
                    memset(field_at(&view, n), 0, field_size(&sphere_fields[f]));
            }
            ARRAY_GROW(peer->receive, peer->n_receive + 1, peer->receive_capacity);
            peer->receive[peer->n_receive++] = n++;
        }
    }
    spheres->n_all = n;
    comm_mail_forget(&halo->mail);
}

/* Brings the ghosts into canonical order and tells the peers' lists where they went. */
static void sort_ghosts(struct halo *halo, struct spheres *spheres)
{
    const int n_owned = spheres->n_owned, n = spheres->n_all - n_owned;
    struct order_key *keys = array_allocate((size_t)n, sizeof *keys);
    int *went = array_allocate((size_t)n, sizeof *went);
    for (int g = 0; g < n; g++) {
        const int i = n_owned + g;
        keys[g] = (struct order_key){spheres->order_cell[i], spheres->id[i], i};
    }
    order_arrange(spheres, n_owned, keys, n);
    for (int g = 0; g < n; g++)
        went[keys[g].index - n_owned] = n_owned + g;
    for (int p = 0; p < halo->n_peers; p++) {
        struct halo_peer *peer = &halo->peers[p];
        for (int k = 0; k < peer->n_receive; k++)
            peer->receive[k] = went[peer->receive[k] - n_owned];
    }
    free(went);
    free(keys);
}

static void count_classes(struct halo *halo, const struct comm *comm, const struct boxes *boxes,
                          const struct spheres *spheres, double half_buffer)
{
    const struct periodic *periodic = &spheres->periodic;
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        const double least = boxes->low[comm->rank][k], most = boxes->high[comm->rank][k];
        low[k] = periodic->along[k] && periodic->low[k] > least ? periodic->low[k] : least;
        high[k] = periodic->along[k] && periodic->high[k] < most ? periodic->high[k] : most;
    }
    halo->n_internal = 0;
    for (int i = 0; i < spheres->n_owned; i++) {
        const double *x = sphere_position(spheres, i),
                     margin = sphere_radius(spheres, i) + half_buffer;
        bool internal = true;
        for (int k = 0; k < 3; k++)
            internal = internal && x[k] - margin >= low[k] && x[k] + margin <= high[k];
        halo->n_internal += internal;
    }
    halo->n_interfacial = spheres->n_owned - halo->n_internal;
}

void halo_build(struct halo *halo, const struct comm *comm, const struct boxes *boxes,
                struct spheres *spheres, const struct materials *materials, double half_buffer)
{
    spheres->n_all = spheres->n_owned;
    halo->n_peers = 0;
    if (comm->n_ranks > 1 || spheres->periodic.any) {
        choose_sends(halo, comm, spheres);
        send_ghosts(halo, comm, spheres);
        receive_ghosts(halo, spheres);
        sort_ghosts(halo, spheres);
    }
    count_classes(halo, comm, boxes, spheres, half_buffer);
    for (int i = spheres->n_owned; i < spheres->n_all; i++) {
        sphere_complete(spheres, i, materials);
        spheres->force[i] = (struct sphere_row){{0.0}};
    }
    for (int p = 0; p < halo->n_peers; p++) {
        struct halo_peer *peer = &halo->peers[p];
        ARRAY_GROW(peer->out, MOTION * peer->n_send, peer->out_capacity);
        ARRAY_GROW(peer->in, MOTION * peer->n_receive, peer->in_capacity);
    }
}

static void pack_motion(const struct halo *halo, struct halo_peer *peer,
                        const struct spheres *spheres)
{
    for (int k = 0; k < peer->n_send; k++) {
        const double *motion = spheres->motion[peer->send[k]].lane;
        double *out = peer->out + MOTION * k;
        memcpy(out, motion, 3 * sizeof *out);
        memcpy(out + 3, motion + 4, 3 * sizeof *out);
        memcpy(out + 6, spheres->spin[peer->send[k]].lane + 4, 3 * sizeof *out);
    }
    for (int k = peer->n_plain; k < peer->n_send; k++) {
        for (int c = 0; c < 3; c++)
            peer->out[MOTION * k + c] += halo->shifts[peer->image[k]][c];
    }
}

static void unpack_motion(const struct halo_peer *peer, const double *all,
                          struct spheres *spheres)
{
    for (int k = 0; k < peer->n_receive; k++) {
        double *motion = spheres->motion[peer->receive[k]].lane,
               *spin = spheres->spin[peer->receive[k]].lane;
        const double *in = all + MOTION * k, radius = motion[3];
        memcpy(motion, in, 3 * sizeof *in);
        memcpy(motion + 4, in + 3, 3 * sizeof *in);
        for (int c = 0; c < 3; c++) {
            spin[c] = radius * in[6 + c];
            spin[4 + c] = in[6 + c];
        }
    }
}

void halo_refresh(struct halo *halo, const struct comm *comm, struct spheres *spheres)
{
    int n = 0;
    for (int p = 0; p < halo->n_peers; p++) {
        struct halo_peer *peer = &halo->peers[p];
        if (peer->n_receive > 0 && peer->rank != comm->rank)
            COMM_CHECK(MPI_Irecv(peer->in, MOTION * peer->n_receive, MPI_DOUBLE, peer->rank, 2,
                                 comm->mpi, &halo->requests[n++]));
    }
    for (int p = 0; p < halo->n_peers; p++) {
        struct halo_peer *peer = &halo->peers[p];
        pack_motion(halo, peer, spheres);
        if (peer->n_send > 0 && peer->rank != comm->rank)
            COMM_CHECK(MPI_Isend(peer->out, MOTION * peer->n_send, MPI_DOUBLE, peer->rank, 2,
                                 comm->mpi, &halo->requests[n++]));
    }
    COMM_CHECK(MPI_Waitall(n, halo->requests, MPI_STATUSES_IGNORE));
    for (int p = 0; p < halo->n_peers; p++) {
        const struct halo_peer *peer = &halo->peers[p];
        unpack_motion(peer, peer->rank == comm->rank ? peer->out : peer->in, spheres);
    }
}
