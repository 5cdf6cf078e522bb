/*
 * Meshes of shells and membranes: any surface's facets, each cut into elements.
 *
 * Facets that share a side have the same nodes on it: sides opposite to each other in a quad,
 * and all three of a triangle, are cut into as many pieces, and so on through the surface.
 */
#ifndef TREMIE_MODEL_SHEET_SHAPE_H
#define TREMIE_MODEL_SHEET_SHAPE_H

struct job_body;
struct solid_mesh;

/* How many elements there are. */
double sheet_shape_n_elements(const struct job_body *body);

/* Nodes, elements and the set `rim`, nodes of sides of a single facet; not scaled, rotated or
 * moved yet.  Local. */
void sheet_shape_build(struct solid_mesh *mesh, const struct job_body *body);

#endif
