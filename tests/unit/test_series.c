/* Series: what is written comes back, segment after segment, and damage costs no more than its
 * rows. */
#include "store/series.h"

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "check.h"
#include "store/file.h"

/* A run folder of our own. */
static char *new_run(void)
{
    const char *scratch = getenv("SCRATCH");
    char *run = array_format("%s/run_XXXXXX", scratch != NULL ? scratch : "/tmp");
    EXPECT(mkdtemp(run) != NULL);
    char *folder = array_format("%s/series", run);
    EXPECT(mkdir(folder, 0777) == 0);
    free(folder);
    return run;
}

static char *segment(const char *run, int step)
{
    char *folder = array_format("%s/series", run), *path = file_step_path(folder, step);
    free(folder);
    return path;
}

/* Rows begin .. end - 1 of a table t, t^2 (and t^3). */
static void write_rows(const char *run, int step, int begin, int end, bool cubes)
{
    struct series series, empty;
    series_init(&series, "series");
    series_add_column(&series, "s", "time", "time");
    series_add_column(&series, "s2", "its square", "square of %s", "time");
    if (cubes)
        series_add_column(&series, "s3", "its cube", "cube");
    for (double t = begin; t < end; t++)
        series_add_row(&series, (const double[]){t, t * t, t * t * t});
    series_init(&empty, "runtime");
    series_add_column(&empty, "s", "nothing yet", "step");
    char *path = segment(run, step);
    EXPECT(series_write_segment(NULL, path, "A title", 2,
                                (const struct series *const[]){&series, &empty}) ==
           REPORT_FINISHED);
    free(path);
    series_clear(&series);
    series_clear(&empty);
}

TEST(chain_of_segments)
{
    char *run = new_run(), *why;
    write_rows(run, 90, 0, 9, false);
    write_rows(run, 100, 9, 20000, false);
    write_rows(run, 200, 20000, 20000, false);
    write_rows(run, 300, 20000, 20001, false);
    struct series series;
    EXPECT(series_read(&series, run, "series", &why) && why == NULL);
    EXPECT(series.n_rows == 20001 && series.n_columns == 2);
    bool right = true;
    for (int i = 0; i < series.n_rows; i++)
        right = right && series.values[2 * i] == i && series.values[2 * i + 1] == (double)i * i;
    EXPECT(right);
    EXPECT(series_column_index(&series, "square of time") == 1);
    EXPECT(series_column_index(&series, "cube") == -1);
    EXPECT_STRING(series.columns[1].unit, "s2");
    EXPECT_STRING(series.columns[1].help, "its square");
    series_clear(&series);
    EXPECT(series_read(&series, run, "runtime", &why) && series.n_rows == 0 &&
           series.n_columns == 1);
    series_clear(&series);
    free(run);
}

TEST(outputs_that_change_on_resume)
{
    char *run = new_run(), *why;
    write_rows(run, 1, 0, 3, false);
    write_rows(run, 2, 3, 6, true);
    write_rows(run, 3, 6, 8, false);
    struct series series;
    EXPECT(series_read(&series, run, "series", &why));
    EXPECT(series.n_rows == 8 && series.n_columns == 3);
    for (int i = 0; i < 8; i++) {
        const double *row = series.values + (size_t)3 * (size_t)i;
        EXPECT(row[0] == i && row[1] == i * i);
        EXPECT(i >= 3 && i < 6 ? row[2] == i * i * i : isnan(row[2]) != 0);
    }
    series_clear(&series);
    free(run);
}

TEST(damage_costs_its_own_rows)
{
    char *run = new_run(), *why;
    write_rows(run, 1, 0, 100, false);
    write_rows(run, 2, 100, 200, false);
    write_rows(run, 3, 200, 300, false);
    char *path = segment(run, 2), *part = segment(run, 4);
    struct stat state;
    EXPECT(stat(path, &state) == 0 && truncate(path, state.st_size / 2) == 0);
    why = file_write(part, "no series at all", 16);
    EXPECT(why == NULL);
    report_init(false);
    struct series series;
    EXPECT(series_read(&series, run, "series", &why) && why == NULL);
    EXPECT(series.n_rows == 200 && series.values[2 * 100] == 200.0);
    series_clear(&series);
    for (int step = 1; step <= 3; step++) {
        char *gone = segment(run, step);
        EXPECT(unlink(gone) == 0);
        free(gone);
    }
    EXPECT(!series_read(&series, run, "series", &why));
    EXPECT(why != NULL && strstr(why, "signature") != NULL);
    free(why);
    report_init(true);
    free(path);
    free(part);
    free(run);
}

TEST(flipped_bits_are_noticed)
{
    char *run = new_run(), *why;
    write_rows(run, 1, 0, 500, false);
    char *path = segment(run, 1);
    FILE *stream = fopen(path, "r+b");
    EXPECT(stream != NULL);
    int n_wrong = 0;
    report_init(false);
    for (long at = 0; stream != NULL && at < 12000; at += 61) {
        fseek(stream, at, SEEK_SET);
        const int byte = fgetc(stream);
        if (byte == EOF)
            break;
        fseek(stream, at, SEEK_SET);
        fputc(byte ^ 4, stream);
        fflush(stream);
        struct series series;
        if (series_read(&series, run, "series", &why)) {
            for (int i = 0; i < series.n_rows; i++)
                n_wrong +=
                    series.values[2 * i] != i || series.values[2 * i + 1] != (double)i * i;
            n_wrong += series.n_rows != 500 || series.n_columns != 2;
            series_clear(&series);
        }
        free(why);
        fseek(stream, at, SEEK_SET);
        fputc(byte, stream);
        fflush(stream);
    }
    report_init(true);
    EXPECT(n_wrong == 0);
    if (stream != NULL)
        fclose(stream);
    free(path);
    free(run);
}

TEST(no_series)
{
    struct series series;
    char *why;
    EXPECT(!series_read(&series, "/nowhere", "series", &why) && why != NULL);
    free(why);
    char *run = new_run();
    write_rows(run, 1, 0, 1, false);
    EXPECT(!series_read(&series, run, "cake", &why) && strstr(why, "no table cake") != NULL);
    free(why);
    free(run);
}

TEST(unwritable_place)
{
    struct series series;
    series_init(&series, "series");
    series_add_column(&series, "s", "time", "time");
    report_init(false);
    EXPECT(series_write_segment(NULL, "/nowhere/step_000000000001.h5", "", 1,
                                (const struct series *const[]){&series}) == REPORT_STORAGE);
    report_init(true);
    series_clear(&series);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
