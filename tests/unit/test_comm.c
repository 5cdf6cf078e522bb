/* Communication: typed reductions, and mail that arrives whole.
 *
 * ranks: 1 2 3
 */
#include "base/comm.h"

#include <stdlib.h>

#include "base/array.h"
#include "check.h"

TEST(reductions)
{
    const struct comm comm = comm_world();
    const int n = comm.n_ranks, me = comm.rank;
    double most[2] = {me, -me}, least[2] = {me, -me};
    comm_max(&comm, most, 2);
    comm_min(&comm, least, 2);
    EXPECT(most[0] == n - 1 && most[1] == 0.0);
    EXPECT(least[0] == 0.0 && least[1] == 1 - n);
    int64_t counts[2] = {me, ((int64_t)1 << 40) + me};
    comm_max_int(&comm, counts, 1);
    EXPECT(counts[0] == n - 1);
    comm_sum_int(&comm, counts + 1, 1);
    EXPECT(counts[1] == ((int64_t)n << 40) + n * (n - 1) / 2);
    EXPECT(comm_sum_before(&comm, me + 1) == me * (me + 1) / 2);
    EXPECT(comm_agree(&comm, me == n - 1 ? 4 : 0) == 4);
}

TEST(broadcast_and_gather)
{
    const struct comm comm = comm_world();
    char word[8] = "mine";
    if (comm.rank == 0)
        (void)snprintf(word, sizeof word, "rank 0");
    comm_broadcast(&comm, word, sizeof word);
    EXPECT_STRING(word, "rank 0");
    const int own[2] = {comm.rank, 10 * comm.rank};
    int *all = array_allocate((size_t)comm.n_ranks, sizeof own);
    comm_gather_all(&comm, own, all, sizeof own);
    for (int q = 0; q < comm.n_ranks; q++)
        EXPECT(all[2 * q] == q && all[2 * q + 1] == 10 * q);
    free(all);
}

/* Letters of the round `round` from rank p to rank q: as many as this, so that some boxes are
 * empty and sizes differ both ways. */
static int letters(int round, int p, int q)
{
    return round * (3 * p + q) % 7;
}

TEST(mail_arrives_whole_and_in_order)
{
    const struct comm comm = comm_world();
    struct comm_mail mail;
    comm_mail_init(&mail, &comm);
    for (int round = 0; round < 9; round++) { /* boxes shrink and grow and are used again */
        comm_mail_begin(&mail);
        for (int q = 0; q < comm.n_ranks; q++)
            for (int k = 0; k < letters(round, comm.rank, q); k++) {
                const int64_t number = 10000 * comm.rank + 100 * q + k;
                const char mark = (char)('a' + k);
                comm_mail_pack(&mail, q, &number, sizeof number);
                comm_mail_pack(&mail, q, &mark, sizeof mark);
            }
        comm_mail_exchange(&mail, &comm);
        for (int p = 0; p < comm.n_ranks; p++) {
            int n = 0;
            for (; comm_mail_waits(&mail, p); n++) {
                int64_t number = -1;
                char mark = 0;
                comm_mail_unpack(&mail, p, &number, sizeof number);
                comm_mail_unpack(&mail, p, &mark, sizeof mark);
                EXPECT(number == 10000 * p + 100 * comm.rank + n && mark == 'a' + n);
            }
            EXPECT(n == letters(round, p, comm.rank));
        }
    }
    comm_mail_clear(&mail);
}

/* Along a line of ranks, so that those at the ends have one to write to and others two. */
TEST(mail_between_some_goes_to_these_alone)
{
    const struct comm comm = comm_world();
    struct comm_mail mail;
    int ranks[2], n = 0;
    for (int q = comm.rank - 1; q <= comm.rank + 1; q += 2)
        if (q >= 0 && q < comm.n_ranks)
            ranks[n++] = q;
    comm_mail_init(&mail, &comm);
    for (int round = 0; round < 9; round++) {
        comm_mail_begin(&mail);
        for (int k = 0; k < n; k++)
            for (int l = 0; l < letters(round, comm.rank, ranks[k]); l++)
                comm_mail_pack(&mail, ranks[k], &(char){(char)('a' + round)}, 1);
        comm_mail_exchange_with(&mail, &comm, n, ranks);
        for (int k = 0; k < n; k++) {
            int arrived = 0;
            for (char mark; comm_mail_waits(&mail, ranks[k]); arrived++) {
                comm_mail_unpack(&mail, ranks[k], &mark, 1);
                EXPECT(mark == 'a' + round);
            }
            EXPECT(arrived == letters(round, ranks[k], comm.rank));
        }
    }
    comm_mail_clear(&mail);
}

TEST(mail_carries_large_letters)
{
    enum { SIZE = 3 * 1000 * 1000 }; /* [bytes], far beyond what is sent eagerly */
    const struct comm comm = comm_world();
    struct comm_mail mail;
    comm_mail_init(&mail, &comm);
    comm_mail_begin(&mail);
    unsigned char *letter = array_allocate(SIZE, 1);
    for (int q = 0; q < comm.n_ranks; q++) {
        for (int i = 0; i < SIZE; i++)
            letter[i] = (unsigned char)(i % 251 + comm.rank + 2 * q);
        comm_mail_pack(&mail, q, letter, SIZE);
    }
    comm_mail_exchange(&mail, &comm);
    for (int p = 0; p < comm.n_ranks; p++) {
        comm_mail_unpack(&mail, p, letter, SIZE);
        int n_wrong = 0;
        for (int i = 0; i < SIZE; i++)
            n_wrong += letter[i] != (unsigned char)(i % 251 + p + 2 * comm.rank);
        EXPECT(n_wrong == 0);
        EXPECT(!comm_mail_waits(&mail, p));
    }
    free(letter);
    comm_mail_clear(&mail);
}

TEST(mail_that_nobody_wrote_is_empty)
{
    const struct comm comm = comm_world();
    struct comm_mail mail;
    comm_mail_init(&mail, &comm);
    comm_mail_begin(&mail);
    comm_mail_exchange(&mail, &comm);
    for (int p = 0; p < comm.n_ranks; p++)
        EXPECT(!comm_mail_waits(&mail, p));
    comm_mail_clear(&mail);
}

int main(int argc, char **argv)
{
    MPI_Init(&argc, &argv);
    const int status = check_run(argc, argv);
    MPI_Finalize();
    return status;
}
