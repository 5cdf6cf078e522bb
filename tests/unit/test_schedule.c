/* Clocks: when a run saves, how early it stops, and what schedulers and people say of time. */
#include <math.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "base/array.h"
#include "base/process.h"
#include "check.h"
#include "job/job.h"
#include "run/schedule.h"
#include "run/wall_limit.h"

static struct schedule of(double wall, double mtbf)
{
    struct job *job = array_allocate(1, sizeof *job);
    struct schedule schedule;
    job->time.step = 1e-3;
    job->checkpoint.every_wall = wall;
    job->checkpoint.mtbf = mtbf;
    job->checkpoint.every_steps = 7;
    job->checkpoint.every_time = 0.01;
    schedule_init(&schedule, job, 100.0);
    free(job);
    return schedule;
}

TEST(by_steps_and_simulated_time)
{
    const struct schedule schedule = of(0.0, 0.0);
    int n = 0;
    for (int64_t step = 1; step <= 70; step++)
        n += schedule_has_step(&schedule, step);
    EXPECT(n == 10 + 7 - 1);
    EXPECT(schedule_has_step(&schedule, 14) && schedule_has_step(&schedule, 20));
    EXPECT(!schedule_is_due(&schedule, 1e12));
}

TEST(by_the_clock)
{
    struct schedule schedule = of(60.0, 0.0);
    EXPECT(!schedule_is_due(&schedule, 159.0) && schedule_is_due(&schedule, 161.0));
    schedule_saved(&schedule, 161.0, 1.0);
    EXPECT(!schedule_is_due(&schedule, 220.0) && schedule_is_due(&schedule, 222.0));
}

/* Time lost per unit of work, by the exact model for failures that come at random (Daly 2006):
 * M exp(R/M) (exp((t + C)/M) - 1) / t; its least is where the interval should be. */
static double lost(double interval, double cost, double mtbf)
{
    return mtbf * (exp((interval + cost) / mtbf) - 1.0) / interval;
}

TEST(by_failures)
{
    struct schedule schedule = of(60.0, 86400.0);
    for (int k = 0; k < 40; k++)
        schedule_saved(&schedule, 100.0, 20.0);
    const double interval = schedule_interval(&schedule);
    EXPECT_NEAR(interval, sqrt(2.0 * 20.0 * 86400.0), 1e-6);
    EXPECT(lost(interval, 20.0, 86400.0) < 1.0002 * lost(0.98 * interval, 20.0, 86400.0));
    EXPECT(lost(interval, 20.0, 86400.0) < lost(0.7 * interval, 20.0, 86400.0));
    EXPECT(lost(interval, 20.0, 86400.0) < lost(1.4 * interval, 20.0, 86400.0));
}

TEST(stops_in_time)
{
    struct schedule schedule = of(600.0, 0.0);
    EXPECT(!schedule_is_over(&schedule, 1e12)); /* nothing limits it */
    schedule = of(600.0, 0.0);
    schedule_limit(&schedule, 100.0, 3600.0);
    schedule_saved(&schedule, 200.0, 30.0);
    double now = 200.0;
    while (!schedule_is_over(&schedule, now))
        now += 2.0;
    /* Twice a checkpoint and a step, and the grace, before the end; a step later at most. */
    EXPECT(3700.0 - now >= 2.0 * 30.0 + 2.0 * 2.0 + 10.0 - 2.0);
    EXPECT(3700.0 - now <= 2.0 * 30.0 + 2.0 * 2.0 + 10.0);
}

TEST(a_slow_checkpoint_counts_at_once)
{
    struct schedule schedule = of(600.0, 0.0);
    schedule_saved(&schedule, 200.0, 30.0);
    EXPECT(schedule.cost == 30.0);
    schedule_saved(&schedule, 200.0, 10.0);
    EXPECT(schedule.cost == 20.0);
}

TEST(times_as_people_write_them)
{
    double seconds = 0.0;
    EXPECT(wall_limit_read("12:00:00", &seconds) && seconds == 43200.0);
    EXPECT(wall_limit_read("1:30", &seconds) && seconds == 90.0);
    EXPECT(wall_limit_read("30 min", &seconds) && seconds == 1800.0);
    EXPECT(wall_limit_read("45", &seconds) && seconds == 45.0);
    static const char *const wrong[] = {"0",    "-5",   "1:", ":30", "1:2:3:4",
                                        "1:-2", "soon", "",   "3 m"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++)
        EXPECT(!wall_limit_read(wrong[k], &seconds));
}

TEST(limits_of_schedulers)
{
    const char *whose;
    EXPECT(unsetenv("SLURM_JOB_END_TIME") == 0 && unsetenv("PBS_WALLTIME") == 0);
    EXPECT(isinf(wall_limit_left(0.0, &whose)));
    char *end = array_format("%lld", (long long)time(NULL) + 1000);
    EXPECT(setenv("SLURM_JOB_END_TIME", end, 1) == 0);
    EXPECT_NEAR(wall_limit_left(0.0, &whose), 1000.0, 5.0);
    EXPECT_STRING(whose, "SLURM_JOB_END_TIME");
    EXPECT_NEAR(wall_limit_left(500.0, &whose), 500.0 - process_age(getpid()), 5.0);
    EXPECT_STRING(whose, "--wall");
    EXPECT(unsetenv("SLURM_JOB_END_TIME") == 0);
    free(end);
    EXPECT(setenv("PBS_WALLTIME", "100000000", 1) == 0);
    EXPECT_NEAR(wall_limit_left(0.0, &whose), 1e8 - process_age(getsid(0)), 5.0);
    EXPECT_STRING(whose, "PBS_WALLTIME");
    EXPECT(setenv("PBS_WALLTIME", "1 day", 1) == 0);
    EXPECT(isinf(wall_limit_left(0.0, &whose)));
}

TEST(processes)
{
    int64_t started;
    EXPECT(process_lives(getpid(), &started) && started > 0);
    EXPECT(process_age(getpid()) >= 0.0 && process_age(getpid()) < 100.0);
    EXPECT(!process_lives(1 << 30, &started) && process_age(1 << 30) < 0.0);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
