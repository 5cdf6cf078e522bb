/*
 * Communication between ranks: typed helpers around MPI.  Raw MPI stays in this module and in
 * the few files that must have it (parallel HDF5).  There is no floating-point sum: what many
 * ranks add up is either an integer or an exact_sum (base/exact_sum.h).
 */
#ifndef TREMIE_BASE_COMM_H
#define TREMIE_BASE_COMM_H

#include <mpi.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

struct comm {
    MPI_Comm mpi;
    int rank, n_ranks;
};

/* Stops all ranks with MPI's own words when a call failed. */
void comm_check(int status, const char *call);
#define COMM_CHECK(call) comm_check((call), #call)

/* MPI_COMM_WORLD with errors returned.  Collective. */
struct comm comm_world(void);

/* Ranks on the machine of this one, itself included.  Collective. */
int comm_ranks_here(const struct comm *comm);

/* In-place reductions of n values.  Collective. */
void comm_max(const struct comm *comm, double *values, int n);
void comm_min(const struct comm *comm, double *values, int n);
void comm_max_int(const struct comm *comm, int64_t *values, int n);
void comm_sum_int(const struct comm *comm, int64_t *values, int n);
/* Sum of `value` over the ranks before this one.  Collective. */
int64_t comm_sum_before(const struct comm *comm, int64_t value);
/* Largest of everybody's `value`: agreement on a status.  Collective. */
int comm_agree(const struct comm *comm, int value);
/* Rank 0's bytes to all.  Collective. */
void comm_broadcast(const struct comm *comm, void *bytes, size_t n);
/* Everybody's n bytes to everybody, in rank order: `all` holds n * n_ranks bytes.
 * Collective. */
void comm_gather_all(const struct comm *comm, const void *own, void *all, size_t n);
/* Everybody's sizes[rank] bytes to everybody: `all` has room for them side by side in rank
 * order, and the own ones in their place; all ranks know the sizes.  Collective. */
void comm_gather_parts(const struct comm *comm, void *all, const int *sizes);
/* Everybody's n_own records of `size` bytes to everybody, in rank order: *n of them, which the
 * caller frees.  Collective. */
void *comm_gather_records(const struct comm *comm, const void *own, int n_own, size_t size,
                          int *n);
void comm_barrier(const struct comm *comm);

/*
 * Mail: bytes packed for each rank, sent to it, unpacked there.  What was packed is what is
 * sent; no size is computed elsewhere.  Boxes are kept between uses, so a steady run does not
 * allocate.
 */
struct comm_box {
    unsigned char *bytes;
    size_t n, capacity; /* [bytes] */
    size_t read;        /* place of the next unpack */
};

struct comm_mail {
    int n_ranks;
    struct comm_box *out, *in; /* one a rank */
};

void comm_mail_init(struct comm_mail *mail, const struct comm *comm);
void comm_mail_clear(struct comm_mail *mail);
/* Gives back the boxes' memory. */
void comm_mail_forget(struct comm_mail *mail);
/* Empties the outgoing boxes. */
void comm_mail_begin(struct comm_mail *mail);
void comm_mail_pack(struct comm_mail *mail, int to_rank, const void *bytes, size_t n);
/* Sends all; afterwards in[q] holds what rank q packed for this one.  Collective. */
void comm_mail_exchange(struct comm_mail *mail, const struct comm *comm);
/* The same between this rank and the n others named, each of which names this one: what is
 * packed for these is sent, be it nothing, and what is packed for others is not.  Collective
 * among these. */
void comm_mail_exchange_with(struct comm_mail *mail, const struct comm *comm, int n,
                             const int *ranks);
/* Takes n bytes out of in[q]. */
void comm_mail_unpack(struct comm_mail *mail, int from_rank, void *bytes, size_t n);
/* Is there something left in in[q]? */
bool comm_mail_waits(const struct comm_mail *mail, int from_rank);

#endif
