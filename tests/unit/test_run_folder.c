/* The run's folder: made, resumed, refused, locked, pruned, rewound. */
#include "store/run_folder.h"

#include <signal.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "check.h"
#include "store/file.h"

static const char JOB[] = "gravity: [0, 0, -9.81]\n";
static const char OTHER_JOB[] = "gravity: [0, 0, -1.62]\n";

/* A path, not yet there, in a folder of our own. */
static char *new_path(void)
{
    const char *scratch = getenv("SCRATCH");
    char *parent = array_format("%s/folder_XXXXXX", scratch != NULL ? scratch : "/tmp");
    EXPECT(mkdtemp(parent) != NULL);
    char *path = array_format("%s/runs/heap", parent);
    free(parent);
    return path;
}

static bool is_there(const char *folder, const char *name)
{
    char *path = array_format("%s/%s", folder, name);
    const bool there = access(path, F_OK) == 0;
    free(path);
    return there;
}

static void touch(const char *folder, const char *name)
{
    char *path = array_format("%s/%s", folder, name);
    EXPECT(run_folder_write_file(path, "x") == REPORT_FINISHED);
    free(path);
}

static int open_and_close(const char *path, const char *job, bool fresh, bool *resumes)
{
    struct run_folder folder;
    const int status = run_folder_open(&folder, path, job, fresh, resumes);
    if (status == REPORT_FINISHED)
        run_folder_close(&folder);
    return status;
}

static int open_quietly(const char *path, const char *job, bool fresh)
{
    bool resumes;
    report_init(false);
    const int status = open_and_close(path, job, fresh, &resumes);
    report_init(true);
    return status;
}

TEST(new_and_resumed)
{
    char *path = new_path(), *text, *file = array_format("%s/job.yaml", path);
    bool resumes = true;
    EXPECT(open_and_close(path, JOB, false, &resumes) == REPORT_FINISHED && !resumes);
    EXPECT(is_there(path, "checkpoints") && is_there(path, "series"));
    EXPECT(file_read(file, 1000, &text) == NULL);
    EXPECT_STRING(text, JOB);
    EXPECT(open_and_close(path, JOB, false, &resumes) == REPORT_FINISHED && resumes);
    free(text);
    free(file);
    free(path);
}

TEST(another_job_is_refused)
{
    char *path = new_path(), *text, *file = array_format("%s/job.yaml", path);
    bool resumes;
    EXPECT(open_and_close(path, JOB, false, &resumes) == REPORT_FINISHED);
    EXPECT(open_quietly(path, OTHER_JOB, false) == REPORT_BAD_INPUT);
    EXPECT(file_read(file, 1000, &text) == NULL);
    EXPECT_STRING(text, JOB);
    free(text);
    free(file);
    free(path);
}

TEST(fresh_sets_aside)
{
    char *path = new_path(), *text, *file = array_format("%s/set_aside_1/job.yaml", path);
    bool resumes;
    EXPECT(open_and_close(path, JOB, false, &resumes) == REPORT_FINISHED);
    touch(path, "checkpoints/step_000000000100.h5");
    touch(path, "log");
    EXPECT(open_quietly(path, OTHER_JOB, true) == REPORT_FINISHED);
    EXPECT(is_there(path, "set_aside_1/checkpoints/step_000000000100.h5"));
    EXPECT(is_there(path, "set_aside_1/log") && !is_there(path, "log"));
    EXPECT(is_there(path, "checkpoints"));
    EXPECT(!is_there(path, "checkpoints/step_000000000100.h5"));
    EXPECT(file_read(file, 1000, &text) == NULL);
    EXPECT_STRING(text, JOB);
    EXPECT(open_quietly(path, JOB, true) == REPORT_FINISHED);
    EXPECT(is_there(path, "set_aside_2/job.yaml"));
    char *new = array_format("%s/new", path);
    EXPECT(open_and_close(new, JOB, true, &resumes) == REPORT_FINISHED);
    EXPECT(!is_there(new, "set_aside_1"));
    free(new);
    free(text);
    free(file);
    free(path);
}

TEST(foreign_folders_are_refused)
{
    char *path = new_path();
    EXPECT(file_make_folders(path) == NULL);
    touch(path, "thesis.tex");
    EXPECT(open_quietly(path, JOB, false) == REPORT_BAD_INPUT);
    EXPECT(open_quietly(path, JOB, true) == REPORT_BAD_INPUT);
    EXPECT(!is_there(path, "lock") && !is_there(path, "checkpoints"));
    char *file = array_format("%s/thesis.tex", path);
    EXPECT(open_quietly(file, JOB, false) == REPORT_BAD_INPUT);
    EXPECT(open_quietly("/proc/nowhere/heap", JOB, false) == REPORT_STORAGE);
    free(file);
    free(path);
}

TEST(checkpoints_without_a_job_are_refused)
{
    char *path = new_path(), *job = array_format("%s/job.yaml", path);
    bool resumes;
    EXPECT(open_and_close(path, JOB, false, &resumes) == REPORT_FINISHED);
    EXPECT(unlink(job) == 0);
    EXPECT(open_and_close(path, JOB, false, &resumes) == REPORT_FINISHED && !resumes);
    EXPECT(unlink(job) == 0);
    touch(path, "checkpoints/step_000000000100.h5");
    EXPECT(open_quietly(path, JOB, false) == REPORT_BAD_INPUT);
    EXPECT(open_quietly(path, JOB, true) == REPORT_FINISHED);
    free(job);
    free(path);
}

TEST(what_killed_runs_leave_is_removed)
{
    char *path = new_path();
    bool resumes;
    EXPECT(open_and_close(path, JOB, false, &resumes) == REPORT_FINISHED);
    touch(path, ".job.yaml.part");
    touch(path, "checkpoints/.step_000000000100.h5.part");
    EXPECT(open_and_close(path, JOB, false, &resumes) == REPORT_FINISHED && resumes);
    EXPECT(!is_there(path, ".job.yaml.part"));
    EXPECT(!is_there(path, "checkpoints/.step_000000000100.h5.part"));
    free(path);
}

/* A process that holds the lock until it is killed. */
static pid_t start_holder(const char *path)
{
    int ready[2];
    char byte = 0;
    EXPECT(pipe(ready) == 0);
    const pid_t child = fork();
    if (child == 0) {
        struct run_folder folder;
        bool resumes;
        if (run_folder_open(&folder, path, JOB, false, &resumes) == REPORT_FINISHED &&
            write(ready[1], "r", 1) == 1)
            pause();
        _exit(1);
    }
    close(ready[1]);
    EXPECT(read(ready[0], &byte, 1) == 1);
    close(ready[0]);
    return child;
}

TEST(lock_of_the_living_and_the_dead)
{
    char *path = new_path();
    bool resumes;
    const pid_t holder = start_holder(path);
    EXPECT(open_quietly(path, JOB, false) == REPORT_BAD_INPUT);
    EXPECT(open_quietly(path, JOB, true) == REPORT_BAD_INPUT);
    EXPECT(kill(holder, SIGKILL) == 0);
    EXPECT(open_and_close(path, JOB, false, &resumes) == REPORT_FINISHED && resumes);
    EXPECT(waitpid(holder, NULL, 0) == holder);
    free(path);
}

TEST(checkpoints_listed_and_pruned)
{
    struct run_folder folder;
    char *path = new_path();
    bool resumes;
    EXPECT(run_folder_open(&folder, path, JOB, false, &resumes) == REPORT_FINISHED);
    const int64_t given[] = {5, 1000000000000, 300, 200};
    for (int i = 0; i < 4; i++) {
        char *file = run_folder_checkpoint_path(&folder, given[i]);
        EXPECT(run_folder_write_file(file, "x") == REPORT_FINISHED);
        free(file);
    }
    touch(path, "checkpoints/step_12.h5");
    touch(path, "checkpoints/step_000000000007.h5.old");
    touch(path, "checkpoints/notes");
    int64_t *steps;
    EXPECT(run_folder_checkpoints(&folder, &steps) == 4);
    EXPECT(steps[0] == 1000000000000 && steps[1] == 300 && steps[2] == 200 && steps[3] == 5);
    free(steps);
    run_folder_prune(&folder, 2);
    EXPECT(run_folder_checkpoints(&folder, &steps) == 2 && steps[1] == 300);
    EXPECT(is_there(path, "checkpoints/notes"));
    free(steps);
    run_folder_close(&folder);
    free(path);
}

TEST(rewinding)
{
    struct run_folder folder;
    char *path = new_path();
    bool resumes;
    EXPECT(run_folder_open(&folder, path, JOB, false, &resumes) == REPORT_FINISHED);
    EXPECT(run_folder_rewind(&folder, 0) == REPORT_FINISHED);
    EXPECT(!is_there(path, "set_aside_1"));
    for (int64_t step = 100; step <= 300; step += 100) {
        char *checkpoint = run_folder_checkpoint_path(&folder, step);
        char *series = run_folder_series_path(&folder, step);
        EXPECT(run_folder_write_file(checkpoint, "x") == REPORT_FINISHED);
        EXPECT(run_folder_write_file(series, "x") == REPORT_FINISHED);
        free(checkpoint);
        free(series);
    }
    report_init(false);
    EXPECT(run_folder_rewind(&folder, 200) == REPORT_FINISHED);
    report_init(true);
    EXPECT(is_there(path, "checkpoints/step_000000000200.h5"));
    EXPECT(!is_there(path, "checkpoints/step_000000000300.h5"));
    EXPECT(is_there(path, "set_aside_1/checkpoints/step_000000000300.h5"));
    EXPECT(is_there(path, "set_aside_1/series/step_000000000300.h5"));
    EXPECT(is_there(path, "series/step_000000000200.h5"));
    run_folder_close(&folder);
    free(path);
}

TEST(status_is_replaced)
{
    struct run_folder folder;
    char *path = new_path(), *file = array_format("%s/status", path), *text;
    bool resumes;
    EXPECT(run_folder_open(&folder, path, JOB, false, &resumes) == REPORT_FINISHED);
    run_folder_status(&folder, "step 1\n");
    run_folder_status(&folder, "step 2\n");
    EXPECT(file_read(file, 1000, &text) == NULL);
    EXPECT_STRING(text, "step 2\n");
    run_folder_close(&folder);
    free(text);
    free(file);
    free(path);
}

/* What cannot be read is not taken for empty. */
TEST(a_folder_that_cannot_be_read)
{
    int64_t *steps;
    char *path =
        array_format("%s/no_folder", getenv("SCRATCH") != NULL ? getenv("SCRATCH") : "/tmp");
    EXPECT(run_folder_write_file(path, "x") == REPORT_FINISHED);
    EXPECT(file_steps(path, &steps) == -1 && steps == NULL);
    unlink(path);
    EXPECT(file_steps(path, &steps) == 0 && steps == NULL);
    free(path);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
