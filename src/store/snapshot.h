/*
 * Snapshots: what spheres and bodies look like at one instant, for people and their tools; no
 * run goes on from one.  One HDF5 file each, RUN/snapshots/step_000000050000.h5, the same bytes
 * whatever the number of ranks.
 *
 * Layout (spheres sorted by id; units and descriptions as attributes `unit`, `description`):
 *   /run             attributes: format, format_version, step, time [s], dt [s], next_id,
 *                    n_spheres, n_contacts, n_bodies, n_solids, title; bodies, solids: their
 *                    names, one a line
 *   /spheres/NAME    id, position, radius and those of snapshot_fields[] that were asked for;
 *                    material and group have the names of their values, one a line, as
 *                    attribute `names`
 *   /contacts/       first_id < second_id (sorted), position, force: where asked for
 *   /bodies/NAME/    of rigid bodies that are there: points (n x 3), triangles (n x 3, counted
 *                    from 0); attributes: material, points_step, triangles_step
 *   /solids/NAME/    of bodies that deform: reference (places of nodes at the start), corners
 *                    (n x 8 nodes of elements, as in model/solid_mesh.h, of a tetrahedron the
 *                    last four -1, of a quad of a shell or membrane -2 -1 -1 -1, of a triangle
 *                    with -1 before them; n x 4 where all are tetrahedra), triangles (of the
 *                    surface), cells (where not all elements are hexahedra, or tetrahedra:
 *                    XDMF's list of mixed cells);
 *                    attributes: material, reference_step and so on
 *   /solids/NAME/nodes/     id, position and those of snapshot_node_fields[] that were asked
 *                    for, by node
 *   /solids/NAME/elements/  id and those of snapshot_element_fields[], by element
 *   /checksums/      of spheres, contacts, nodes and elements, as in checkpoints; points,
 *                    triangles and other parts of meshes have theirs as attribute `checksum`
 * Numbers are doubles or, as asked for, rounded to 32 bits (not those of meshes).  Parts of
 * meshes that are the same as in the snapshot before are not written again: a link leads to
 * the file that holds them, that of points_step or triangles_step, so files are to be kept
 * together.
 *
 * The contact force on a node is that of the step's contacts, at the instant of the snapshot;
 * over all nodes it adds up to the force on the body.  Its contact pressure is the part of it
 * against the surface, over the node's share of the area.
 */
#ifndef TREMIE_STORE_SNAPSHOT_H
#define TREMIE_STORE_SNAPSHOT_H

#include <stdbool.h>
#include <stdint.h>

#include "store/table.h"

struct comm;
struct run_folder;

/* The first three are always there, the others as bit k - SNAPSHOT_FIRST_CHOICE asks. */
enum snapshot_field {
    SNAPSHOT_ID,
    SNAPSHOT_POSITION,
    SNAPSHOT_RADIUS,
    SNAPSHOT_VELOCITY,
    SNAPSHOT_ANGULAR_VELOCITY,
    SNAPSHOT_FORCE,
    SNAPSHOT_TORQUE,
    SNAPSHOT_MASS,
    SNAPSHOT_MATERIAL,
    SNAPSHOT_GROUP,
    SNAPSHOT_DISSIPATED_FRICTION,
    SNAPSHOT_DISSIPATED_DAMPING,
    SNAPSHOT_N_FIELDS,
    SNAPSHOT_FIRST_CHOICE = SNAPSHOT_VELOCITY,
};

enum snapshot_contact_field {
    SNAPSHOT_FIRST_ID,
    SNAPSHOT_SECOND_ID,
    SNAPSHOT_CONTACT_POSITION,
    SNAPSHOT_CONTACT_FORCE,
    SNAPSHOT_N_CONTACT_FIELDS
};

/* Of bodies that deform: the first two, or the id of elements, are always there, the others as
 * bits say, those of nodes first. */
enum snapshot_node_field {
    SNAPSHOT_NODE_ID,
    SNAPSHOT_NODE_POSITION,
    SNAPSHOT_NODE_DISPLACEMENT,
    SNAPSHOT_NODE_VELOCITY,
    SNAPSHOT_NODE_CONTACT_FORCE,
    SNAPSHOT_NODE_CONTACT_PRESSURE,
    SNAPSHOT_N_NODE_FIELDS,
    SNAPSHOT_NODE_FIRST_CHOICE = SNAPSHOT_NODE_DISPLACEMENT,
};

enum snapshot_element_field {
    SNAPSHOT_ELEMENT_ID,
    SNAPSHOT_ELEMENT_STRESS,
    SNAPSHOT_ELEMENT_VON_MISES,
    SNAPSHOT_ELEMENT_PRINCIPAL_STRESS,
    SNAPSHOT_ELEMENT_PLASTIC_STRAIN,
    SNAPSHOT_ELEMENT_THICKNESS, /* where there are shells or membranes */
    SNAPSHOT_ELEMENT_ALIVE,
    SNAPSHOT_N_ELEMENT_FIELDS,
    SNAPSHOT_ELEMENT_FIRST_CHOICE = SNAPSHOT_ELEMENT_STRESS,
};

enum { SNAPSHOT_FORMAT_VERSION = 1 };

extern const struct field snapshot_fields[SNAPSHOT_N_FIELDS];
extern const struct field snapshot_node_fields[SNAPSHOT_N_NODE_FIELDS];
extern const struct field snapshot_element_fields[SNAPSHOT_N_ELEMENT_FIELDS];

struct snapshot_body {
    char *name, *material;
    int64_t n_points, n_triangles;
    double (*points)[3]; /* now [m] */
    int32_t (*triangles)[3];
    int64_t points_step, triangles_step; /* of the snapshots whose files hold them */
};

/* Parts of a solid's mesh. */
enum snapshot_part {
    SNAPSHOT_REFERENCE,
    SNAPSHOT_CORNERS,
    SNAPSHOT_TRIANGLES,
    SNAPSHOT_CELLS,
    SNAPSHOT_N_PARTS
};

struct snapshot_rows {
    int64_t n;
    int width;    /* numbers in a row */
    void *rows;   /* of doubles or int32; on rank 0 */
    int64_t step; /* of the snapshot whose file holds them */
};

struct snapshot_solid {
    char *name, *material;
    char *names[2];               /* of the tables */
    struct table nodes, elements; /* a column's name tells its field */
    int64_t n_nodes, n_elements;
    bool mixed; /* has it SNAPSHOT_CELLS? */
    struct snapshot_rows parts[SNAPSHOT_N_PARTS];
};

struct snapshot {
    const struct run_folder *folder; /* the run's that writes it, NULL: nobody's */
    int64_t step;
    double dt; /* [s] */
    int64_t next_id;
    char *title;
    char *materials, *groups; /* names, one a line */
    bool has_contacts;
    struct table spheres, contacts; /* a column's name tells its field */
    int n_bodies;                   /* on rank 0 */
    struct snapshot_body *bodies;
    int n_solids; /* on all ranks */
    struct snapshot_solid *solids;
};

/* A cleared snapshot whose tables have the columns of these fields: bits as above.  Local. */
void snapshot_init(struct snapshot *snapshot, int fields, bool contacts, bool single,
                   bool packed);
void snapshot_clear(struct snapshot *snapshot);
/* Adds a solid of this name, whose tables have the columns of these fields; `sheets`: some of
 * its elements are shells or membranes.  Local. */
struct snapshot_solid *snapshot_add_solid(struct snapshot *snapshot, const char *name,
                                          int fields, bool sheets, bool single, bool packed);
/* Adds a name to a list with one a line, which it takes; the caller frees the new one.
 * Local. */
char *snapshot_add_name(char *names, const char *name);
/* Puts numbers, of the field's type or doubles, into a column of record i.  Local. */
void snapshot_put(struct table *table, int64_t i, int column, const void *values);
/* The column of this name, -1 when there is none.  Local. */
int snapshot_column(const struct table *table, const char *name);
/* The numbers of a column of record i, as doubles.  Local. */
void snapshot_get(const struct table *table, int64_t i, int column, double *values);
/* Corners of an element; is it one of a shell or membrane?  Local. */
int snapshot_n_corners(const struct snapshot_solid *solid, int64_t element);
bool snapshot_is_sheet(const struct snapshot_solid *solid, int64_t element);

/* Writes arranged tables and bodies into the folder, over a snapshot of the same step; says
 * for each body where its mesh is.  Returns REPORT_FINISHED, or REPORT_STORAGE with the reason
 * said, the same on all ranks; then no file was touched.  Collective. */
int snapshot_write(const struct comm *comm, const char *folder, struct snapshot *snapshot);

/* Does the file say that it is one?  Local. */
bool snapshot_is(const char *path);
/* Reads a file, on one process: all but rows, points and triangles.  Returns NULL or the reason
 * (the caller frees it); then there is nothing to clear.  Local. */
char *snapshot_measure(const char *path, struct snapshot *snapshot);
/* The same with these, verifying checksums.  Local. */
char *snapshot_read(const char *path, struct snapshot *snapshot);

#endif
