/*
 * The index of a folder of snapshots that ParaView and other readers of XDMF open:
 * spheres.xmf and, where there are any, bodies.xmf, contacts.xmf, solids.xmf.  They hold no
 * numbers but times; they say which data sets of which files belong to which time.
 *
 * An index describes only files that are there: it is written after a new one, and before old
 * ones are moved away.
 */
#ifndef TREMIE_STORE_XDMF_H
#define TREMIE_STORE_XDMF_H

#include <stdint.h>

struct run_folder;
struct snapshot;

enum { XDMF_SPHERES, XDMF_BODIES, XDMF_CONTACTS, XDMF_SOLIDS, XDMF_N_KINDS };

/* One thing at one time. */
struct xdmf_grid {
    int kind;
    char *name; /* the same at all times */
    char *text;
};

struct xdmf_entry {
    int64_t step;
    double time; /* [s] */
    int n, capacity;
    struct xdmf_grid *grids;
};

struct xdmf {
    int n, capacity;
    struct xdmf_entry *entries; /* by step */
};

/* Describes the snapshots there are in a folder up to a step; warns of those that cannot be
 * read.  Local. */
void xdmf_open(struct xdmf *xdmf, const char *folder, int64_t last_step);
void xdmf_clear(struct xdmf *xdmf);
/* Adds a snapshot, later than all others or in place of one of the same step.  Local. */
void xdmf_add(struct xdmf *xdmf, const struct snapshot *snapshot);
/* Writes the files into a folder of the run's, each there whole or not at all.  Returns a
 * REPORT_ status, the reason said.  Local. */
int xdmf_write(const struct xdmf *xdmf, const struct run_folder *run, const char *folder);

#endif
