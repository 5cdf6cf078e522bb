/*
 * The surface of a body that deforms, as far as this rank has it.  Its corners are nodes, or
 * lie half a thickness beside nodes of sheets (model/skin.h); here are those of the elements
 * that this rank computes, and what spheres need (deform_share.h). All others are at no place
 * (NaN): search does not find them, and what needed one all the same would fail at once.
 */
#ifndef TREMIE_RUN_DEFORM_SKIN_H
#define TREMIE_RUN_DEFORM_SKIN_H

#include "model/skin.h"

struct body;
struct deform_body;
struct mesh;
struct simulation;
struct solid_mesh;

struct deform_skin {
    int *nodes;   /* of each corner of the mesh, and of points below that balls push */
    int n_points; /* all of these */
    int n_vertices, *vertices; /* here: corners, then mean points; ascending */
    int n_plain;               /* of these that are nodes */
    int n_faces, *faces;       /* all of whose vertices are here, ascending */
    unsigned char *is_here;    /* of each vertex */
    struct skin shape;
    int n_sheets, *sheets; /* here, ascending */
    int n_rings, *rings;   /* all of whose sheets are here, ascending */
    struct vec3 *normals;  /* of each sheet, where it is here */
    struct vec3 *arms;     /* from each ring's node to its vertex above, likewise [m] */
};

/* Nothing is here yet. */
void deform_skin_init(struct deform_skin *skin, const struct solid_mesh *mesh,
                      const struct body *body);
void deform_skin_clear(struct deform_skin *skin);
/* Makes nodes points that take forces, corners of the mesh or not; points[k] becomes that of
 * nodes[k], which may be -1: none, and be there several times. */
void deform_skin_add(struct deform_skin *skin, struct body *body, int n_nodes, int n,
                     const int *nodes, int *points);

/* Finds out what of the surface is here, and puts it where its nodes are.  Local. */
void deform_skin_renew(struct deform_body *deform, struct body *body);
/* Puts what is here where its nodes are, with their velocities.  Local. */
void deform_skin_place(const struct deform_body *deform, struct body *body);
/* Brings all faces here to where their corners are, before a search.  Local. */
void deform_skin_place_faces(const struct deform_body *deform, const struct body *body);
/* Contacts' forces on the vertices become those on nodes that are moved here, and moments where
 * these turn, and are taken from it.  Local. */
void deform_skin_take_forces(struct deform_body *deform, const struct body *body);
/* Gives back memory of what is not here. */
void deform_skin_forget(const struct deform_skin *skin, struct mesh *mesh);

/* All of all surfaces is here, without velocities, until deform_skin_hide().  Collective. */
void deform_skin_show(struct simulation *sim);
void deform_skin_hide(struct simulation *sim);

#endif
