/*
 * Ghosts: copies of other ranks' spheres that may touch ours.
 *
 * Who needs a copy (the reach rule): an owned sphere is sent to a rank when its own reach
 * (radius and allowance) meets the box of that rank's owned centres grown by their largest
 * reach, level by level of reach, neighbours or not.  Then whatever pair may touch before the
 * next search is complete on every rank that owns a part of it, also with walls off the cut,
 * spheres larger than a subdomain and subdomains thinner than a radius.  The boxes of centres
 * are known to all: O(ranks) numbers.
 *
 * Where space is periodic, an image is a ghost too, shifted by whole periods; a rank may hold
 * images of its own spheres, and several copies of one.  Shifts are exact (model/periodic.h),
 * so a contact over the boundary is like any other between two ranks.
 *
 * The paper's classes are counted by the way, with its half-buffer boxes: internal (the sphere
 * lies within the subdomain shrunk by half the buffer), interfacial (its centre is ours but it
 * reaches the buffer), external (a copy).
 */
#ifndef TREMIE_DOMAIN_HALO_H
#define TREMIE_DOMAIN_HALO_H

#include <stdbool.h>
#include <stdint.h>

#include "base/comm.h"
#include "model/order.h"
#include "model/periodic.h"

struct boxes;
struct materials;
struct spheres;

struct halo_peer {
    int rank;
    int n_send, send_capacity, n_receive, receive_capacity;
    int n_plain;          /* those of `send` that go as they are come first, then images */
    int *send;            /* storage indices of owned spheres, in canonical order each shift */
    unsigned char *image; /* which of the shifts each takes */
    int image_capacity;
    int *receive; /* storage indices of ghosts, in the sender's order */
    double *out, *in;
    int out_capacity, in_capacity;
};

struct halo {
    int n_peers;                       /* ranks with which ghosts are exchanged */
    struct halo_peer *peers;           /* room for every rank */
    MPI_Request *requests;             /* two a peer */
    int n_shifts;                      /* 1 where nothing is periodic */
    double shifts[PERIODIC_IMAGES][3]; /* of images; the first is none [m] */
    struct comm_mail mail;
    void *all_boxes; /* scratch: every rank's boxes of centres */
    int n_internal, n_interfacial;
};

void halo_init(struct halo *halo, const struct comm *comm);
void halo_clear(struct halo *halo);

/* Makes all ghosts anew from the owned spheres' places and allowances; owned spheres stay where
 * they are in memory.  half_buffer [m] is for the paper's classes.  Collective. */
void halo_build(struct halo *halo, const struct comm *comm, const struct boxes *boxes,
                struct spheres *spheres, const struct materials *materials, double half_buffer);

/* May an owned sphere of that rank touch what lies within low .. high, itself or as an image,
 * before the next search?  After halo_build() on several ranks.  Local. */
bool halo_reaches(const struct halo *halo, int rank, const double low[3], const double high[3]);

/* Gives every ghost its owner's present motion.  Collective among peers. */
void halo_refresh(struct halo *halo, const struct comm *comm, struct spheres *spheres);

#endif
