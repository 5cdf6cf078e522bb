/*
 * The job loader, fed with anything.  What it takes must be written as a job that it takes too,
 * and that writes the same again; the scene is not made, nor are files read that the text names
 * by a path that leads out of an empty folder.
 */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/report.h"
#include "fuzz.h"
#include "job/job.h"

int LLVMFuzzerInitialize(int *argc, char ***argv)
{
    (void)argc;
    (void)argv;
    report_init(false);
    return 0;
}

/* Reads a text, as a file or as the job of a run; the text that it is written as, or NULL. */
static char *rewrite(const char *path, const char *text)
{
    struct job job;
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    const bool fine = text == NULL ? job_read(&job, path, 0, NULL, &mistakes)
                                   : job_read_text(&job, path, text, &mistakes);
    char *written = fine ? job_write(&job) : NULL;
    job_clear(&job);
    mistakes_clear(&mistakes);
    return written;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    /* Files in other places are not for fuzzing: a pipe would be waited for. */
    if (memchr(data, '/', size) != NULL)
        return 0;
    char *first = rewrite(fuzz_file(data, size), NULL);
    if (first == NULL)
        return 0;
    char *second = rewrite("job.yaml", first);
    CHECK(second != NULL && strcmp(first, second) == 0, "written and read it is another job");
    free(first);
    free(second);
    return 0;
}
