/* See comm.h. */
#include "base/comm.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"

void comm_check(int status, const char *call)
{
    if (status == MPI_SUCCESS)
        return;
    char text[MPI_MAX_ERROR_STRING];
    int length = 0;
    MPI_Error_string(status, text, &length);
    CHECK(status == MPI_SUCCESS, "%s failed: %.*s", call, length, text);
}

struct comm comm_world(void)
{
    struct comm comm = {.mpi = MPI_COMM_WORLD};
    COMM_CHECK(MPI_Comm_set_errhandler(comm.mpi, MPI_ERRORS_RETURN));
    COMM_CHECK(MPI_Comm_rank(comm.mpi, &comm.rank));
    COMM_CHECK(MPI_Comm_size(comm.mpi, &comm.n_ranks));
    return comm;
}

int comm_ranks_here(const struct comm *comm)
{
    MPI_Comm here;
    int n = 1;
    COMM_CHECK(MPI_Comm_split_type(comm->mpi, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &here));
    COMM_CHECK(MPI_Comm_size(here, &n));
    COMM_CHECK(MPI_Comm_free(&here));
    return n;
}

static void reduce(const struct comm *comm, void *values, int n, MPI_Datatype type, MPI_Op op)
{
    if (comm->n_ranks > 1)
        COMM_CHECK(MPI_Allreduce(MPI_IN_PLACE, values, n, type, op, comm->mpi));
}

void comm_max(const struct comm *comm, double *values, int n)
{
    reduce(comm, values, n, MPI_DOUBLE, MPI_MAX);
}

void comm_min(const struct comm *comm, double *values, int n)
{
    reduce(comm, values, n, MPI_DOUBLE, MPI_MIN);
}

void comm_max_int(const struct comm *comm, int64_t *values, int n)
{
    reduce(comm, values, n, MPI_INT64_T, MPI_MAX);
}

void comm_sum_int(const struct comm *comm, int64_t *values, int n)
{
    reduce(comm, values, n, MPI_INT64_T, MPI_SUM);
}

int64_t comm_sum_before(const struct comm *comm, int64_t value)
{
    int64_t before = 0;
    COMM_CHECK(MPI_Exscan(&value, &before, 1, MPI_INT64_T, MPI_SUM, comm->mpi));
    return comm->rank == 0 ? 0 : before;
}

int comm_agree(const struct comm *comm, int value)
{
    int64_t largest = value;
    comm_max_int(comm, &largest, 1);
    return (int)largest;
}

void comm_broadcast(const struct comm *comm, void *bytes, size_t n)
{
    enum { SLICE = 1 << 30 };
    for (size_t done = 0; done < n; done += SLICE) {
        const size_t part = n - done < SLICE ? n - done : SLICE;
        COMM_CHECK(MPI_Bcast((char *)bytes + done, (int)part, MPI_BYTE, 0, comm->mpi));
    }
}

void comm_gather_all(const struct comm *comm, const void *own, void *all, size_t n)
{
    CHECK(n <= INT_MAX, "%zu bytes a rank are too many to gather", n);
    COMM_CHECK(MPI_Allgather(own, (int)n, MPI_BYTE, all, (int)n, MPI_BYTE, comm->mpi));
}

void comm_gather_parts(const struct comm *comm, void *all, const int *sizes)
{
    int *begin = array_allocate((size_t)comm->n_ranks, sizeof *begin);
    for (int q = 1; q < comm->n_ranks; q++) {
        CHECK(sizes[q - 1] <= INT_MAX - begin[q - 1], "over 2 GiB to gather");
        begin[q] = begin[q - 1] + sizes[q - 1];
    }
    COMM_CHECK(MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all, sizes, begin, MPI_BYTE,
                              comm->mpi));
    free(begin);
}

void *comm_gather_records(const struct comm *comm, const void *own, int n_own, size_t size,
                          int *n)
{
    int *sizes = array_allocate((size_t)comm->n_ranks, sizeof *sizes), before = 0;
    CHECK((size_t)n_own <= INT32_MAX / size, "%d records at once", n_own);
    comm_gather_all(comm, &(int){n_own * (int)size}, sizes, sizeof *sizes);
    *n = 0;
    for (int q = 0; q < comm->n_ranks; q++) {
        before = q == comm->rank ? *n : before;
        *n += sizes[q] / (int)size;
    }
    unsigned char *all = array_allocate((size_t)*n, size);
    if (n_own > 0)
        memcpy(all + (size_t)before * size, own, (size_t)n_own * size);
    comm_gather_parts(comm, all, sizes);
    free(sizes);
    return all;
}

void comm_barrier(const struct comm *comm)
{
    COMM_CHECK(MPI_Barrier(comm->mpi));
}

/* ------------------------------------------------------------------------------------- mail */

void comm_mail_init(struct comm_mail *mail, const struct comm *comm)
{
    mail->n_ranks = comm->n_ranks;
    mail->out = array_allocate((size_t)comm->n_ranks, sizeof *mail->out);
    mail->in = array_allocate((size_t)comm->n_ranks, sizeof *mail->in);
}

void comm_mail_forget(struct comm_mail *mail)
{
    for (int q = 0; q < mail->n_ranks; q++) {
        free(mail->out[q].bytes);
        free(mail->in[q].bytes);
        mail->out[q] = mail->in[q] = (struct comm_box){0};
    }
}

void comm_mail_clear(struct comm_mail *mail)
{
    comm_mail_forget(mail);
    free(mail->out);
    free(mail->in);
    *mail = (struct comm_mail){0};
}

void comm_mail_begin(struct comm_mail *mail)
{
    for (int q = 0; q < mail->n_ranks; q++)
        mail->out[q].n = 0;
}

void comm_mail_pack(struct comm_mail *mail, int to_rank, const void *bytes, size_t n)
{
    struct comm_box *box = &mail->out[to_rank];
    if (n == 0)
        return;
    ARRAY_GROW(box->bytes, box->n + n, box->capacity);
    memcpy(box->bytes + box->n, bytes, n);
    box->n += n;
}

void comm_mail_exchange(struct comm_mail *mail, const struct comm *comm)
{
    const int n_ranks = mail->n_ranks;
    int64_t *n_out = array_allocate((size_t)n_ranks, sizeof *n_out);
    int64_t *n_in = array_allocate((size_t)n_ranks, sizeof *n_in);
    MPI_Request *requests = array_allocate(2 * (size_t)n_ranks, sizeof(MPI_Request));
    int n_requests = 0;
    for (int q = 0; q < n_ranks; q++)
        n_out[q] = (int64_t)mail->out[q].n;
    COMM_CHECK(MPI_Alltoall(n_out, 1, MPI_INT64_T, n_in, 1, MPI_INT64_T, comm->mpi));
    for (int q = 0; q < n_ranks; q++) {
        struct comm_box *in = &mail->in[q];
        in->n = (size_t)n_in[q];
        in->read = 0;
        CHECK(in->n <= INT_MAX && mail->out[q].n <= INT_MAX, "a message of over 2 GiB");
        if (q == comm->rank || in->n == 0)
            continue;
        ARRAY_GROW(in->bytes, in->n, in->capacity);
        COMM_CHECK(MPI_Irecv(in->bytes, (int)in->n, MPI_BYTE, q, 1, comm->mpi,
                             &requests[n_requests++]));
    }
    for (int k = 1; k < n_ranks; k++) {
        const int q = (comm->rank + k) % n_ranks;
        struct comm_box *out = &mail->out[q];
        if (out->n > 0)
            COMM_CHECK(MPI_Isend(out->bytes, (int)out->n, MPI_BYTE, q, 1, comm->mpi,
                                 &requests[n_requests++]));
    }
    const struct comm_box room = mail->in[comm->rank]; /* one's own changes hands as it is */
    mail->in[comm->rank] = mail->out[comm->rank];
    mail->in[comm->rank].read = 0;
    mail->out[comm->rank] = room;
    COMM_CHECK(MPI_Waitall(n_requests, requests, MPI_STATUSES_IGNORE));
    free(n_out);
    free(n_in);
    free(requests);
}

void comm_mail_exchange_with(struct comm_mail *mail, const struct comm *comm, int n,
                             const int *ranks)
{
    enum { TAG = 3 };
    MPI_Request *requests = array_allocate((size_t)n, sizeof(MPI_Request));
    for (int k = 0; k < n; k++) {
        struct comm_box *out = &mail->out[ranks[k]];
        CHECK(out->n <= INT_MAX, "a message of over 2 GiB");
        COMM_CHECK(MPI_Isend(out->bytes, (int)out->n, MPI_BYTE, ranks[k], TAG, comm->mpi,
                             &requests[k]));
    }
    for (int k = 0; k < n; k++) {
        struct comm_box *in = &mail->in[ranks[k]];
        MPI_Message message;
        MPI_Status status;
        int size = 0;
        COMM_CHECK(MPI_Mprobe(ranks[k], TAG, comm->mpi, &message, &status));
        COMM_CHECK(MPI_Get_count(&status, MPI_BYTE, &size));
        ARRAY_GROW(in->bytes, (size_t)size, in->capacity);
        COMM_CHECK(MPI_Mrecv(in->bytes, size, MPI_BYTE, &message, MPI_STATUS_IGNORE));
        in->n = (size_t)size;
        in->read = 0;
    }
    COMM_CHECK(MPI_Waitall(n, requests, MPI_STATUSES_IGNORE));
    free(requests);
}

void comm_mail_unpack(struct comm_mail *mail, int from_rank, void *bytes, size_t n)
{
    struct comm_box *box = &mail->in[from_rank];
    CHECK(box->read + n <= box->n, "rank %d sent %zu bytes, %zu more are asked for", from_rank,
          box->n, n);
    if (n == 0)
        return;
    memcpy(bytes, box->bytes + box->read, n);
    box->read += n;
}

bool comm_mail_waits(const struct comm_mail *mail, int from_rank)
{
    return mail->in[from_rank].read < mail->in[from_rank].n;
}
