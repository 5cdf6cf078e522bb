/*
 * Meshes of simple solids: box, plate, cylinder, tube, of hexahedra or of tetrahedra.
 */
#ifndef TREMIE_MODEL_SOLID_SHAPE_H
#define TREMIE_MODEL_SOLID_SHAPE_H

struct job_body;
struct solid_mesh;

/* How many cells there are along each of the three ways that `cells` counts. */
void solid_shape_cells(const struct job_body *body, double cells[3]);
/* How many elements they make. */
double solid_shape_n_elements(const struct job_body *body);

/* Nodes, elements and sets of a shape, not scaled, rotated or moved yet.  Local. */
void solid_shape_build(struct solid_mesh *mesh, const struct job_body *body);

#endif
