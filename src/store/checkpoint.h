/*
 * Checkpoints: one HDF5 file with all that the next step needs, written collectively, the same
 * bytes whatever the number of ranks, readable on any number of ranks.
 *
 * Layout (all rows sorted by id, units and descriptions as attributes `unit`, `description`):
 *   /run             attributes: format, format_version, step, time [s], dt [s], next_id,
 *                    n_spheres, n_contacts, n_facet_contacts, n_monitors, title; job: the job
 *                    text as used
 *   /spheres/NAME    one data set per saved field of sphere_fields[] (n or n x width)
 *   /contacts/       first_id, second_id, tangential_force (n x 3), contact_radius,
 *                    normal_velocity; with the ledger dashpot_force (n x 3); of a job with
 *                    rolling, twisting or static friction rolling_force (n x 3),
 *                    twisting_force, sliding; touching contacts, first_id < second_id, sorted
 *                    by (first_id, second_id)
 *   /facet_contacts/ id, body, feature, the same of their history; sorted
 *   /nodes/, /elements/  of a job with bodies that deform: their fields (solid/solid.h), by id
 *   /node_contacts/  of one whose bodies touch bodies: as facet_contacts, of corners of skins
 *   /monitors/       names (one a line), sums (n x 5 int64: struct exact_sum as totals)
 *   /state/          where there is any: small named numbers (store/notes.h)
 *   /checksums/      under the same paths: CRC-32 (as zlib's) of each block of 256 rows; job,
 *                    names and sums have theirs as attribute `checksum`
 * Nothing in it depends on rank count, machine or clock (those are in the log and the series).
 *
 * Format versions count up.  Until there is a release a program reads its own alone and says
 * which one a file has; since version 5 there are totals of what bodies lose that touch bodies.
 *
 * Writing: space is reserved and agreed on, the file is written under a temporary name, forced
 * to the disk, renamed, its folder forced to the disk.  Reading verifies every checksum.
 */
#ifndef TREMIE_STORE_CHECKPOINT_H
#define TREMIE_STORE_CHECKPOINT_H

#include <stdbool.h>
#include <stdint.h>

#include "base/exact_sum.h"
#include "base/field.h"
#include "contact/contact_set.h"
#include "contact/facet_contact.h"
#include "store/notes.h"

struct comm;
struct run_folder;
struct spheres;
struct table;

enum { CHECKPOINT_FORMAT_VERSION = 5, CHECKPOINT_NAME_SIZE = 64 };

struct checkpoint_monitor {
    char name[CHECKPOINT_NAME_SIZE];
    struct exact_sum sum;
};

/* Where the contacts to be written come from: each asks for the records whose (lower) id lies
 * in begin .. end - 1, in any order; *records, NULL before, becomes theirs (free it), and
 * their number is returned. */
struct checkpoint_contacts {
    const void *from;
    int (*pairs)(const void *from, int64_t begin, int64_t end, struct contact_record **records);
    int (*facets)(const void *from, int64_t begin, int64_t end,
                  struct facet_contact_record **records);
};

/* A further table, of what a job has besides spheres: rows of an id and fields, in /NAME, one
 * for each id 0 .. n_ids - 1; or, of `contacts`, struct facet_contact_record, as many as there
 * are.  Reading gives all rows, sorted, to every rank. */
struct checkpoint_more {
    const char *name;
    bool contacts;
    int n_fields;
    const struct field *fields;
    int64_t n_ids;
    int64_t n_rows; /* of contacts: here, to write; in all, as read */
    /* To write: as in store/table.h; each row on exactly one rank. */
    void (*collect)(struct table *table, const void *from, int64_t begin, int64_t end);
    const void *from;
    /* As read: an int64 id, then the fields, without gaps. */
    size_t record_size;
    unsigned char *records;
};

enum { CHECKPOINT_MORE = 3 /* at most */ };

struct checkpoint {
    const struct run_folder *folder; /* the run's that writes it, NULL: nobody's */
    int64_t step;                    /* steps done: positions are those at step * dt */
    double dt;                       /* [s] */
    int64_t next_id;                 /* ids below were given */
    char *title;
    char *job_text;          /* the job as used (job_write) */
    struct spheres *spheres; /* owned ones are state */
    bool full, ledger;       /* which lanes of history there are: set before reading, too */
    bool removals;           /* are some spheres to be taken out?  Likewise */
    int n_slice;             /* as read: spheres that this rank was given, and their ids */
    int64_t *slice;
    int n_contacts; /* to write: records held here, see below */
    int n_facet_contacts;
    struct facet_contact_record *facet_contacts; /* as read */
    struct checkpoint_contacts held;             /* to write */
    int n_monitors; /* the same names on all ranks; sums are this rank's shares */
    struct checkpoint_monitor *monitors;
    struct notes notes; /* the same on all ranks */
    int n_more;         /* tables: set before reading, too */
    struct checkpoint_more more[CHECKPOINT_MORE];
};

/*
 * Writes the state to `path`.  Each touching contact must be held by exactly one rank (that of
 * the owner of the lower id); facet contacts by the owner of the sphere.  Returns
 * REPORT_FINISHED, or REPORT_STORAGE with the reason said, the same on all ranks; then no file
 * of that name was touched.  Collective.
 */
int checkpoint_write(const struct comm *comm, const char *path,
                     const struct checkpoint *checkpoint);

/*
 * Reads `path`, but for contacts between spheres, into a cleared `checkpoint`, whose `spheres`
 * points to an initialised struct spheres; each rank gets a slice of the ids as its owned
 * spheres (fields only: sphere_complete is the caller's), and all facet contact records of
 * them.  Materials, bodies and features are not compared with the job: the
 * caller knows it.  Monitor totals are given to rank 0, zeros to the others.  Returns
 * REPORT_FINISHED, or REPORT_STORAGE with the reason said (missing, truncated, checksum, newer
 * format), the same on all ranks.  Collective.
 */
int checkpoint_read(const struct comm *comm, const char *path, struct checkpoint *checkpoint);

/* Gets records of contacts, which it may change and not keep; called as often on all ranks. */
typedef void checkpoint_take(void *into, int n, struct contact_record *records);

/* Reads the contacts between spheres, part by part, after checkpoint_read() of the same file:
 * each rank gets the records in which a sphere of its slice takes part (sorted within a part).
 * Returns a status as checkpoint_read(); some may have been taken before the file turns out to
 * be damaged.  Collective. */
int checkpoint_read_contacts(const struct comm *comm, const char *path,
                             const struct checkpoint *checkpoint, checkpoint_take *take,
                             void *into);

/* Frees what checkpoint_read allocated, except the spheres. */
void checkpoint_clear(struct checkpoint *checkpoint);

/* Only step, dt, next_id, title and job_text, on one process, without MPI (tools, resume).
 * Returns false with the reason in `why` (caller frees). */
bool checkpoint_read_header(const char *path, struct checkpoint *checkpoint, char **why);

#endif
