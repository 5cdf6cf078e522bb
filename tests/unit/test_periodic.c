/* Periodic space: places and periods are multiples of a quantum, so shifts are exact. */
#include "model/periodic.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

#include "check.h"
#include "job/job.h"
#include "random_cloud.h"

static struct periodic space(double min, double max, int directions)
{
    const struct job job = {
        .domain = {true, {min, 2.0 * min, -1.0}, {max, 2.0 * max, 1.0}, directions, 0}};
    struct periodic periodic;
    periodic_init(&periodic, &job);
    return periodic;
}

static void settle(const struct periodic *periodic, double x[3])
{
    const struct vec3 place = periodic_settled(periodic, (struct vec3){x[0], x[1], x[2]});
    memcpy(x, &place.x, 3 * sizeof *x);
}

static bool is_multiple(double x, double quantum)
{
    const double count = x / quantum; /* a power of two: exact */
    return fabs(count) < 9007199254740992.0 && count == (double)(int64_t)count;
}

TEST(nothing_is_periodic)
{
    const struct periodic none = space(-1.0, 1.0, 0);
    const double x[3] = {1e9, -3.7, 0.1};
    double settled[3] = {1e9, -3.7, 0.1}, shifts[PERIODIC_IMAGES][3];
    settle(&none, settled);
    const struct vec3 place = periodic_place(&none, x);
    EXPECT(!none.any && !(none.shortest < 1e300));
    EXPECT(memcmp(settled, x, sizeof x) == 0 && place.x == x[0] && place.y == x[1]);
    EXPECT(periodic_shifts(&none, shifts) == 1);
    EXPECT(shifts[0][0] == 0.0 && shifts[0][1] == 0.0 && shifts[0][2] == 0.0);
}

/* Every place in the domain, its images and all their differences are exact. */
TEST(shifts_are_exact)
{
    const double domains[][2] = {
        {-0.1, 0.2}, {0.0, 1.0 / 3.0}, {1e3, 1e3 + 0.7}, {-1e6, 1e6}, {-7e-5, 1e-6}};
    struct cloud_random random = {5};
    for (int d = 0; d < 5; d++) {
        const struct periodic p = space(domains[d][0], domains[d][1], 3);
        EXPECT(p.any && p.along[0] && p.along[1] && !p.along[2] && p.period[2] == 0.0);
        EXPECT(p.shortest == p.period[0] && p.high[0] == p.low[0] + p.period[0]);
        EXPECT(is_multiple(p.low[0], p.quantum[0]) && is_multiple(p.period[0], p.quantum[0]));
        EXPECT(fabs(p.low[0] - domains[d][0]) <= p.quantum[0]);
        for (int n = 0; n < 1000; n++) {
            double x[3], y[3];
            for (int k = 0; k < 3; k++) {
                x[k] = cloud_between(&random, 3.0 * domains[d][0], 3.0 * domains[d][1]);
                y[k] = cloud_between(&random, domains[d][0], domains[d][1]);
            }
            settle(&p, x);
            settle(&p, y);
            for (int k = 0; k < 2; k++) {
                EXPECT(x[k] >= p.low[k] && x[k] < p.high[k] && is_multiple(x[k], p.quantum[k]));
                const double image = x[k] + p.period[k];
                EXPECT(image - p.period[k] == x[k]);
                EXPECT(image - y[k] == x[k] - (y[k] - p.period[k]));
                EXPECT(is_multiple(image - y[k], p.quantum[k]));
            }
        }
    }
}

TEST(wrapping_undoes_any_number_of_turns)
{
    const struct periodic p = space(-0.3, 0.7, 5);
    struct cloud_random random = {6};
    for (int n = 0; n < 1000; n++) {
        const int by = (int)cloud_between(&random, -2.0, 2.99);
        double x[3] = {cloud_between(&random, -0.3, 0.7), 12.3,
                       cloud_between(&random, -1.0, 1.0)};
        int turns[3];
        settle(&p, x);
        double there[3] = {x[0] + by * p.period[0], x[1], x[2] - by * p.period[2]};
        periodic_wrap(&p, there, turns);
        EXPECT(turns[0] == by && turns[1] == 0 && turns[2] == -by);
        EXPECT(memcmp(there, x, sizeof x) == 0);
    }
    double edges[3] = {p.high[0], 0.0, p.low[2]};
    int turns[3];
    periodic_wrap(&p, edges, turns);
    EXPECT(edges[0] == p.low[0] && turns[0] == 1 && edges[2] == p.low[2] && turns[2] == 0);
    double lost[3] = {(double)NAN, 0.0, (double)INFINITY};
    periodic_wrap(&p, lost, turns);
    EXPECT(lost[0] != lost[0] && lost[2] == (double)INFINITY && turns[0] == 0 && turns[2] == 0);
}

TEST(images_on_all_sides)
{
    static const int directions[] = {1, 2, 3, 6, 7}, counts[] = {3, 3, 9, 9, 27};
    for (int d = 0; d < 5; d++) {
        const struct periodic p = space(-1.0, 1.0, directions[d]);
        double shifts[PERIODIC_IMAGES][3];
        const int n = periodic_shifts(&p, shifts);
        EXPECT(n == counts[d] && shifts[0][0] == 0.0 && shifts[0][1] == 0.0);
        for (int a = 0; a < n; a++) {
            bool opposite = false;
            for (int b = 0; b < n; b++) {
                opposite = opposite ||
                           (shifts[a][0] == -shifts[b][0] && shifts[a][1] == -shifts[b][1] &&
                            shifts[a][2] == -shifts[b][2]);
                EXPECT(a == b || memcmp(shifts[a], shifts[b], sizeof shifts[a]) != 0);
            }
            EXPECT(opposite);
        }
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
