/*
 * Snapshots: what spheres and bodies look like at one instant, for people and their tools; no
 * run goes on from one.  One HDF5 file each, RUN/snapshots/step_000000050000.h5, the same bytes
 * whatever the number of ranks.
 *
 * Layout (spheres sorted by id; units and descriptions as attributes `unit`, `description`):
 *   /run             attributes: format, format_version, step, time [s], dt [s], next_id,
 *                    n_spheres, n_contacts, n_bodies, title; bodies: their names, one a line
 *   /spheres/NAME    id, position, radius and those of snapshot_fields[] that were asked for;
 *                    material and group have the names of their values, one a line, as
 *                    attribute `names`
 *   /contacts/       first_id < second_id (sorted), position, force: where asked for
 *   /bodies/NAME/    of bodies that are there: points (n x 3), triangles (n x 3, counted from
 *                    0); attributes: material, points_step, triangles_step
 *   /checksums/      of spheres and contacts, as in checkpoints; points and triangles have
 *                    theirs as attribute `checksum`
 * Numbers are doubles or, as asked for, rounded to 32 bits (not those of bodies).  Points or
 * triangles that are the same as in the snapshot before are not written again: a link leads to
 * the file that holds them, that of points_step or triangles_step, so files are to be kept
 * together.
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

enum { SNAPSHOT_FORMAT_VERSION = 1 };

extern const struct field snapshot_fields[SNAPSHOT_N_FIELDS];

struct snapshot_body {
    char *name, *material;
    int64_t n_points, n_triangles;
    double (*points)[3]; /* now [m] */
    int32_t (*triangles)[3];
    int64_t points_step, triangles_step; /* of the snapshots whose files hold them */
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
};

/* A cleared snapshot whose tables have the columns of these fields: bits as above.  Local. */
void snapshot_init(struct snapshot *snapshot, int fields, bool contacts, bool single,
                   bool packed);
void snapshot_clear(struct snapshot *snapshot);
/* Puts numbers, of the field's type or doubles, into a column of record i.  Local. */
void snapshot_put(struct table *table, int64_t i, int column, const void *values);
/* The column of this name, -1 when there is none.  Local. */
int snapshot_column(const struct table *table, const char *name);
/* The numbers of a column of record i, as doubles.  Local. */
void snapshot_get(const struct table *table, int64_t i, int column, double *values);

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
