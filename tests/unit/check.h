/*
 * A unit test program: tests register themselves, check_run() runs them in the order of the
 * file and prints one line each, `ok NAME` or `FAIL NAME: file:line: expression`.
 *
 *     TEST(a_name)
 *     {
 *         EXPECT(1 + 1 == 2);
 *     }
 *
 *     int main(int argc, char **argv)
 *     {
 *         return check_run(argc, argv);
 *     }
 *
 * A program that needs ranks says so in a line of its own near its top,
 *     / * ranks: 1 2 3 * /            (without the inner spaces)
 * is then run under mpirun with each number, calls MPI_Init and MPI_Finalize in main around
 * check_run(), and runs every test on all ranks; a test fails when it does on any rank.  The
 * first failed EXPECT of a test is what gets reported; the test goes on, so that ranks stay in
 * step.  Arguments name the tests to run; none: all.
 */
#ifndef TREMIE_TESTS_CHECK_H
#define TREMIE_TESTS_CHECK_H

#include <mpi.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

enum { CHECK_TESTS_MAX = 256, CHECK_TEXT_SIZE = 512 };

static struct {
    const char *name;
    void (*run)(void);
} check_tests[CHECK_TESTS_MAX];
static int check_n_tests;
static char check_failure[CHECK_TEXT_SIZE]; /* of the test that runs; "" while it holds */

#define TEST(test_name)                                                                        \
    static void test_name(void);                                                               \
    __attribute__((constructor)) static void register_##test_name(void)                        \
    {                                                                                          \
        if (check_n_tests < CHECK_TESTS_MAX) {                                                 \
            check_tests[check_n_tests].name = #test_name;                                      \
            check_tests[check_n_tests++].run = test_name;                                      \
        }                                                                                      \
    }                                                                                          \
    static void test_name(void)

#define CHECK_FAIL(...)                                                                        \
    do {                                                                                       \
        if (check_failure[0] == '\0')                                                          \
            (void)snprintf(check_failure, sizeof check_failure, __VA_ARGS__);                  \
    } while (0)

#define EXPECT(condition)                                                                      \
    do {                                                                                       \
        if (!(condition))                                                                      \
            CHECK_FAIL("%s:%d: %s", __FILE__, __LINE__, #condition);                           \
    } while (0)

/* |a - b| <= tolerance; NaN fails. */
#define EXPECT_NEAR(a, b, tolerance)                                                           \
    do {                                                                                       \
        const double a_ = (a), b_ = (b), difference_ = a_ > b_ ? a_ - b_ : b_ - a_;            \
        if (!(difference_ <= (tolerance)))                                                     \
            CHECK_FAIL("%s:%d: %s is %.17g, %s is %.17g", __FILE__, __LINE__, #a, a_, #b, b_); \
    } while (0)

#define EXPECT_STRING(a, b)                                                                    \
    do {                                                                                       \
        const char *a_ = (a), *b_ = (b);                                                       \
        if (a_ == NULL || b_ == NULL || strcmp(a_, b_) != 0)                                   \
            CHECK_FAIL("%s:%d: %s is \"%s\", expected \"%s\"", __FILE__, __LINE__, #a,         \
                       a_ != NULL ? a_ : "(null)", b_ != NULL ? b_ : "(null)");                \
    } while (0)

static inline bool check_wanted(const char *name, int argc, char **argv)
{
    for (int i = 1; i < argc; i++)
        if (strcmp(argv[i], name) == 0)
            return true;
    return argc <= 1;
}

/* Every rank's failure to rank 0: the first that any rank has. */
static inline void check_share_failure(int n_ranks)
{
    for (int q = n_ranks - 1; q >= 0; q--) {
        char theirs[CHECK_TEXT_SIZE];
        memcpy(theirs, check_failure, sizeof theirs);
        MPI_Bcast(theirs, sizeof theirs, MPI_CHAR, q, MPI_COMM_WORLD);
        if (theirs[0] != '\0')
            memcpy(check_failure, theirs, sizeof theirs);
    }
}

static inline int check_run(int argc, char **argv)
{
    int n_failed = 0, initialized = 0, finalized = 0, rank = 0, n_ranks = 1;
    MPI_Initialized(&initialized);
    MPI_Finalized(&finalized);
    const bool parallel = initialized && !finalized;
    if (parallel) {
        MPI_Comm_rank(MPI_COMM_WORLD, &rank);
        MPI_Comm_size(MPI_COMM_WORLD, &n_ranks);
    }
    for (int i = 0; i < check_n_tests; i++) {
        if (!check_wanted(check_tests[i].name, argc, argv))
            continue;
        check_failure[0] = '\0';
        check_tests[i].run();
        if (parallel)
            check_share_failure(n_ranks);
        if (check_failure[0] != '\0')
            n_failed++;
        if (rank == 0 && check_failure[0] == '\0')
            printf("ok %s\n", check_tests[i].name);
        else if (rank == 0)
            printf("FAIL %s: %s\n", check_tests[i].name, check_failure);
        fflush(stdout);
    }
    return n_failed > 0;
}

#endif
