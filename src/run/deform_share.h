/*
 * Who moves which nodes of bodies that deform, and what ranks tell each other of them.
 *
 * A node belongs to the rank in whose subdomain it is, as a sphere does; that rank moves it.
 * Elements with a node here are computed here (solid/solid.h).  Who moves what changes at
 * redistributions: state goes to those who have not had it, of a node from the rank that moved
 * it, of an element from that which counted it.
 *
 * A rank has copies of others' nodes where elements that it computes need them, and where its
 * spheres may touch the facet before the next search.  An edge or a corner that they may touch
 * belongs to all facets around it, so these are there too.  The one that moves a facet's first
 * corner finds out which ranks' spheres reach it, by the boxes of their centres
 * (domain/halo.h).  Each step a node's place and velocity go to the ranks with copies of it,
 * and what spheres do to copies goes, as exact sums, to the rank that moves the node.
 *
 * Every rank knows the mesh and who moves what in all of it, which is some 140 bytes an element
 * wherever that is; and it goes through lists of all of the body at each search.  State takes
 * memory only where it is needed, as far as that leaves whole pages.
 */
#ifndef TREMIE_RUN_DEFORM_SHARE_H
#define TREMIE_RUN_DEFORM_SHARE_H

#include <stdbool.h>
#include <stdint.h>

struct comm;
struct deform_body;
struct simulation;
struct solid;

/* What this rank and another one have to do with each other. */
struct deform_share_peer {
    int n_told, told_capacity;
    int *told; /* nodes moved here of which it has copies */
    int n_heard, heard_capacity;
    int *heard; /* copies here of nodes that it moves, in its order */
    int n_pushed, pushed_capacity;
    int *pushed; /* corners of the skin among these that spheres here may touch */
    bool pushes; /* may spheres there touch nodes moved here? */
};

struct deform_share {
    int *owner;          /* rank that moves each node */
    unsigned char *copy; /* why there is a copy of each node here; 0: there is none */
    struct deform_share_peer *peers; /* one a rank */
    int64_t n_changes;               /* how often who moves what of this body has changed */
    int64_t n_left;                  /* nodes that changed rank since memory was given back */
    int n_touched, touched_capacity;
    int *touched; /* faces that spheres here may touch before the next search */
};

/* At first ranks move as many nodes each, by their numbers. */
void deform_share_init(struct deform_share *share, const struct comm *comm,
                       struct solid *solid);
/* Vertices of sheets are where normals of all elements around their nodes say, so what has
 * such a node for an element or a touch needs these elements' nodes, too.  Local. */
void deform_share_mark_rings(struct deform_body *deform);
void deform_share_clear(struct deform_share *share, const struct comm *comm);

/* Is the node here, moved or as a copy?  Local. */
bool deform_share_has(const struct deform_body *deform, int node);

/* Gives nodes to the ranks in whose subdomains they are, and finds out who needs copies.  At a
 * search, after halo_build(), with surfaces as they are and allowances as they will be.
 * Collective. */
void deform_share_renew(struct simulation *sim);
/* Gives copies the places and velocities of their nodes.  Collective among those concerned. */
void deform_share_tell(struct simulation *sim);
/* Takes what spheres did to copies to those who move the nodes.  Collective among those
 * concerned. */
void deform_share_push(struct simulation *sim);

#endif
