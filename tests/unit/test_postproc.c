/*
 * What the tools share: finding a steady rate, reading command lines, numbers on axes, cameras,
 * pictures, files' contents.  The tools themselves are tried in tests/cases/postproc.sh.
 */
#include <math.h>
#include <png.h>
#include <stdlib.h>
#include <unistd.h>

#include "../../postproc/arguments.h"
#include "../../postproc/camera.h"
#include "../../postproc/canvas.h"
#include "../../postproc/content.h"
#include "../../postproc/font.h"
#include "../../postproc/image.h"
#include "../../postproc/owners.h"
#include "../../postproc/plot.h"
#include "../../postproc/records.h"
#include "../../postproc/sheet.h"
#include "../../postproc/steady.h"
#include "../../postproc/ticks.h"
#include "base/array.h"
#include "base/report.h"
#include "check.h"
#include "model/sphere.h"
#include "store/file.h"
#include "store/series.h"

/* ----------------------------------------------------------------------------------- steady */

enum { N_SAMPLES = 401 };

/* A noise of mean 0 between -1 and 1 that is the same everywhere. */
static double noise(unsigned *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (double)(*state >> 8) / (double)(1 << 23) - 1.0;
}

struct flow {
    double time[N_SAMPLES], total[N_SAMPLES];
};

/* From 0 to 4 s: rises during [0.4, 0.8], stays at 100 until `fall`, then falls for half a
 * second. */
static void pour(struct flow *flow, double fall, double drift, double scatter)
{
    unsigned state = 7;
    flow->total[0] = 0.0;
    for (int i = 0; i < N_SAMPLES; i++) {
        const double t = flow->time[i] = 0.01 * i;
        const double rise = t < 0.4 ? 0.0 : t < 0.8 ? (t - 0.4) / 0.4 : 1.0;
        const double end = t < fall ? 1.0 : t < fall + 0.5 ? (fall + 0.5 - t) / 0.5 : 0.0;
        const double shape = rise < end ? rise : end;
        const double rate =
            100.0 * shape * (1.0 + drift * (t - 1.0)) * (1.0 + scatter * noise(&state));
        if (i > 0)
            flow->total[i] = flow->total[i - 1] + 0.01 * rate;
    }
}

TEST(the_steady_part_of_a_flow_is_found)
{
    struct flow flow;
    pour(&flow, 3.0, 0.0, 0.3);
    const struct steady steady = steady_find(N_SAMPLES, flow.time, flow.total);
    EXPECT(steady.flows && steady.found);
    EXPECT(steady.from > 0.7 && steady.from < 1.1);
    EXPECT(steady.to > 2.7 && steady.to < 3.1);
    EXPECT(steady.n_batches >= STEADY_BATCHES_LEAST);
    EXPECT_NEAR(steady.rate, 100.0, 2.0 * steady.half_width);
    EXPECT(steady.half_width > 0.1 && steady.half_width < 5.0);
}

TEST(an_even_flow_is_steady_throughout)
{
    struct flow flow;
    for (int i = 0; i < N_SAMPLES; i++) {
        flow.time[i] = 0.01 * i;
        flow.total[i] = 5.0 * flow.time[i];
    }
    const struct steady steady = steady_find(N_SAMPLES, flow.time, flow.total);
    EXPECT(steady.found);
    EXPECT_NEAR(steady.rate, 5.0, 1e-9);
    EXPECT(steady.half_width < 1e-9);
}

TEST(a_drifting_flow_is_not_steady)
{
    struct flow flow;
    pour(&flow, 3.4, 1.0, 0.02);
    const struct steady steady = steady_find(N_SAMPLES, flow.time, flow.total);
    EXPECT(steady.flows && !steady.found);
    EXPECT(steady.why[0] != '\0');
}

TEST(too_little_flow_is_not_steady)
{
    const double time[5] = {0, 1, 2, 3, 4}, none[5] = {0}, some[5] = {0, 0, 1, 2, 2};
    EXPECT(!steady_find(0, time, none).found);
    EXPECT(!steady_find(1, time, none).found);
    EXPECT(!steady_find(5, time, none).flows);
    const struct steady steady = steady_find(5, time, some);
    EXPECT(steady.flows && !steady.found);
    EXPECT_NEAR(steady.begin, 1.0, 0.0);
    EXPECT_NEAR(steady.end, 3.0, 0.0);
}

/* Values of printed tables. */
TEST(quantiles_of_student)
{
    EXPECT_NEAR(steady_student(5), 2.571, 2e-3);
    EXPECT_NEAR(steady_student(10), 2.228, 1e-3);
    EXPECT_NEAR(steady_student(30), 2.042, 1e-3);
}

TEST(intervals_are_written_to_their_second_digit)
{
    char text[STEADY_TEXT_SIZE];
    steady_write_interval(text, 29432.4, 712.3);
    EXPECT_STRING(text, "29430 +- 710");
    steady_write_interval(text, 1.23456, 0.0123);
    EXPECT_STRING(text, "1.235 +- 0.012");
}

/* ---------------------------------------------------------------------- axes, words, sheets */

TEST(ticks_are_round)
{
    const struct ticks ticks = ticks_between(0.0, 1.5, 5);
    EXPECT(ticks.n >= 3 && ticks.n <= 9);
    EXPECT_NEAR(ticks.values[0], 0.0, 0.0);
    EXPECT_STRING(ticks.texts[0], "0.0");
    EXPECT_NEAR(ticks_round_up(6.13), 10.0, 1e-12);
    EXPECT_NEAR(ticks_round_up(0.021), 0.025, 1e-12);
    EXPECT_NEAR(ticks_round_up(2.0), 2.0, 1e-12);
}

TEST(ticks_of_logarithms_are_round)
{
    const struct ticks wide = ticks_of_decades(-5.2, 1.1);
    EXPECT(wide.n == 7);
    EXPECT_STRING(wide.texts[0], "1e-5");
    EXPECT_STRING(wide.texts[6], "10");
    const struct ticks narrow = ticks_of_decades(log10(15.0), log10(120.0));
    EXPECT(narrow.n == 3); /* 20, 50, 100 */
    EXPECT_NEAR(narrow.values[1], 50.0, 1e-12);
}

TEST(every_character_has_a_glyph)
{
    for (int c = 1; c < 256; c++) {
        struct font_stroke strokes[2 * FONT_STROKES_MAX];
        const int n = font_strokes((char)c, strokes);
        EXPECT(n <= FONT_STROKES_MAX);
        EXPECT((n > 0) == (c != ' '));
    }
}

/* Everything in a stream. */
static char *text_of(FILE *stream)
{
    char *text = array_allocate(4096, 1);
    rewind(stream);
    const size_t n = fread(text, 1, 4095, stream);
    text[n] = '\0';
    fclose(stream);
    return text;
}

TEST(sheets_align_their_columns)
{
    struct sheet sheet;
    sheet_init(&sheet);
    sheet_heading(&sheet, "run");
    sheet_heading(&sheet, "time");
    sheet_cell(&sheet, "a long name");
    sheet_cell(&sheet, "%d", 7);
    FILE *stream = tmpfile();
    EXPECT(stream != NULL);
    sheet_print(&sheet, stream);
    char *text = text_of(stream);
    EXPECT_STRING(text, "run          time\na long name     7\n");
    free(text);
    sheet_clear(&sheet);
}

TEST(sheets_are_read_back)
{
    char path[] = "/tmp/tremie-sheet.XXXXXX";
    close(mkstemp(path));
    struct sheet sheet, read;
    sheet_init(&sheet);
    sheet_init(&read);
    sheet_heading(&sheet, "name, of what");
    sheet_heading(&sheet, "value");
    sheet_cell(&sheet, "says \"no\"");
    sheet_cell(&sheet, "%d", 7);
    sheet_cell(&sheet, " ");
    sheet_cell(&sheet, "%s", "");
    EXPECT(sheet_write_csv(&sheet, path) == REPORT_FINISHED);
    EXPECT(sheet_read_csv(&read, path) == REPORT_FINISHED);
    EXPECT(read.n_columns == 2 && read.n_cells == 4);
    for (int i = 0; i < 2; i++)
        EXPECT_STRING(read.headings[i], sheet.headings[i]);
    for (int i = 0; i < 4; i++)
        EXPECT_STRING(read.cells[i], sheet.cells[i]);
    EXPECT(sheet_column(&read, "value") == 1 && sheet_column(&read, "name") == -1);
    sheet_clear(&read);
    sheet_clear(&sheet);
    unlink(path);
}

/* The panel spans x from 86 to 836 and y from 44 to 344 units of the page. */
TEST(logarithmic_axes_place_decades_evenly)
{
    char path[] = "/tmp/tremie-plot.XXXXXX";
    close(mkstemp(path));
    const double x[] = {10.0, -1.0}, y[] = {100.0, 1.0};
    struct plot plot = {.title = "", .n_panels = 1};
    plot.panels[0] = (struct plot_panel){.x_label = "",
                                         .y_label = "",
                                         .log_x = true,
                                         .log_y = true,
                                         .x_range = {1.0, 100.0},
                                         .y_range = {1.0, 1000.0}};
    plot_add_curve(&plot.panels[0],
                   (struct plot_curve){.n = 2, .x = x, .y = y, .markers = true, .bare = true});
    EXPECT(plot_write_svg(&plot, path) == REPORT_FINISHED);
    FILE *stream = fopen(path, "r");
    EXPECT(stream != NULL);
    char *text = text_of(stream), *dot = strstr(text, "<circle cx=\"461.00\" cy=\"144.00\"");
    EXPECT(dot != NULL);
    if (dot != NULL)
        EXPECT(strstr(dot + 1, "<circle") == NULL); /* -1 has no logarithm */
    free(text);
    unlink(path);
}

/* ---------------------------------------------------------------------------- command lines */

enum { WORD_SIZE = 64 };

static int read_line(int argc, const char *const *words, double *number, char name[WORD_SIZE],
                     bool *flag, int *n)
{
    const char *found = "";
    const struct arguments_entry entries[] = {
        {"number", 0, ARGUMENTS_NUMBER, number, "X", "", NULL},
        {"name", 'o', ARGUMENTS_TEXT, &found, "X", "", NULL},
        {"flag", 0, ARGUMENTS_FLAG, flag, NULL, "", NULL},
    };
    const struct arguments_page page = {"tool", "", "", 3, entries, 1, 2};
    char *argv[8] = {NULL};
    for (int i = 0; i < argc; i++)
        argv[i] = array_string(words[i]);
    char *all[8];
    memcpy(all, argv, sizeof all);
    const int status = arguments_read(&page, argc, argv, n);
    snprintf(name, WORD_SIZE, "%s", found);
    for (int i = 0; i < argc; i++)
        free(all[i]);
    return status;
}

TEST(command_lines_are_read)
{
    double number = 0.0;
    char name[WORD_SIZE];
    bool flag = false;
    int n;
    const char *const good[] = {"tool",  "first",  "--number=2.5", "-o",
                                "x.png", "--flag", "--",           "--second"};
    EXPECT(read_line(8, good, &number, name, &flag, &n) == ARGUMENTS_GO_ON);
    EXPECT(n == 2 && flag);
    EXPECT_NEAR(number, 2.5, 0.0);
    EXPECT_STRING(name, "x.png");
}

TEST(wrong_command_lines_are_refused)
{
    static const char *const wrong[][3] = {
        {"tool", "a", "--nmber=1"},   {"tool", "a", "--number=fast"},
        {"tool", "a", "--number"},    {"tool", "a", "--flag=1"},
        {"tool", "--flag", "--flag"}, {"tool", "a", "--number=nan"}};
    report_init(false);
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        double number = 0.0;
        char name[WORD_SIZE];
        bool flag = false;
        int n;
        EXPECT(read_line(3, wrong[i], &number, name, &flag, &n) == REPORT_BAD_INPUT);
    }
    report_init(true);
}

/* --------------------------------------------------------------------------------- pictures */

static const struct camera_ball corners[] = {{{-3, -3, 0}, 0.1},
                                             {{3, -3, 0}, 0.0},
                                             {{3, 3, 1}, 0.5},
                                             {{-3, 3, 9}, 0.0},
                                             {{0, 0, 4}, 2.0}};
enum { N_CORNERS = sizeof corners / sizeof *corners };

TEST(cameras_see_the_whole_scene)
{
    const struct camera_frame frame = {10, 20, 410, 320};
    for (int view = 0; view < 24; view++) {
        const struct camera camera =
            camera_fit(15.0 * view, 7.5 * view - 90.0, 1.0, frame, N_CORNERS, corners);
        EXPECT_NEAR(vec3_dot(camera.up, camera.ahead), 0.0, 1e-12);
        double slack = 1e9;
        for (int i = 0; i < N_CORNERS; i++) {
            const struct vec3 p = camera_point(&camera, corners[i].centre);
            const double x = camera.centre[0] + camera.focal * p.x / p.z;
            const double y = camera.centre[1] - camera.focal * p.y / p.z;
            const double r = camera.focal * corners[i].radius / p.z;
            const double room[4] = {x - r - frame.left, frame.right - x - r, y - r - frame.top,
                                    frame.bottom - y - r};
            for (int k = 0; k < 4; k++)
                slack = room[k] < slack ? room[k] : slack;
        }
        EXPECT(slack > -0.5 && slack < 40.0);
    }
}

TEST(pictures_show_what_is_nearer)
{
    enum { SIZE = 64 };
    const struct camera_ball balls[2] = {{{0, 0, 0}, 1.0}, {{0, 3, 0}, 1.0}};
    const struct camera_frame frame = {0, 0, 2.0 * SIZE, 2.0 * SIZE};
    const struct camera camera = camera_fit(0, 0, 1.0, frame, 2, balls);
    struct canvas canvas;
    struct image image;
    canvas_init(&canvas, SIZE, SIZE);
    canvas_sphere(&canvas, &camera, balls[0].centre, 1.0, (struct colours_rgb){1, 0, 0});
    canvas_sphere(&canvas, &camera, balls[1].centre, 1.0, (struct colours_rgb){0, 0, 1});
    canvas_light(&canvas, &camera, 1.0);
    canvas_develop(&canvas, &image);
    const unsigned char *middle = image.pixels + (SIZE / 2 * SIZE + SIZE / 2) * 3;
    EXPECT(middle[0] > 100 && middle[2] < 80);
    EXPECT(image.pixels[0] > 230);

    char path[] = "/tmp/tremie-picture-XXXXXX";
    const int file = mkstemp(path);
    EXPECT(file >= 0);
    close(file);
    EXPECT(image_write_png(&image, path) == REPORT_FINISHED);
    png_image back = {.version = PNG_IMAGE_VERSION};
    EXPECT(png_image_begin_read_from_file(&back, path) != 0);
    EXPECT(back.width == SIZE && back.height == SIZE);
    png_image_free(&back);
    unlink(path);
    image_clear(&image);
    canvas_clear(&canvas);
}

/* ------------------------------------------------------------------------------------ files */

/* A run's folder with one segment of two rows; the caller frees the name. */
static char *make_run(void)
{
    char name[] = "/tmp/tremie-run-XXXXXX";
    EXPECT(mkdtemp(name) != NULL);
    char *folder = array_format("%s/series", name);
    char *why = file_make_folders(folder);
    EXPECT(why == NULL);
    struct series series;
    series_init(&series, "series");
    series_add_column(&series, "s", "time", "time");
    series_add_column(&series, "J", "energy", "energy");
    series_add_row(&series, (const double[]){0.0, 3.0});
    series_add_row(&series, (const double[]){0.5, 5.0});
    const struct series *tables[] = {&series};
    char *path = file_step_path(folder, 100);
    EXPECT(series_write_segment(NULL, path, "a title", 1, tables) == REPORT_FINISHED);
    series_clear(&series);
    free(path);
    free(folder);
    return array_string(name);
}

static void remove_run(char *run)
{
    char *folder = array_format("%s/series", run), *path = file_step_path(folder, 100);
    unlink(path);
    rmdir(folder);
    rmdir(run);
    free(path);
    free(folder);
    free(run);
}

TEST(records_are_summed)
{
    char *run = make_run();
    struct series series;
    EXPECT(records_read(&series, run, "series") == REPORT_FINISHED);
    EXPECT(series.n_rows == 2);
    EXPECT_NEAR(records_sum(&series, "energy"), 8.0, 0.0);
    EXPECT_NEAR(records_mean(&series, "energy"), 4.0, 0.0);
    EXPECT_NEAR(records_max(&series, "energy"), 5.0, 0.0);
    EXPECT_NEAR(records_last(&series, "time"), 0.5, 0.0);
    EXPECT(isnan(records_sum(&series, "nothing")));
    EXPECT(records_column(&series, "%s.mass", "nothing") == NULL);
    series_clear(&series);
    remove_run(run);
}

TEST(contents_are_listed)
{
    char *run = make_run(), *folder = array_format("%s/series", run);
    char *path = file_step_path(folder, 100);
    struct content content;
    char *why = content_open(&content, path);
    EXPECT(why == NULL);
    const struct content_item *item = content_find(&content, "/series/energy");
    EXPECT(item != NULL && item->kind == CONTENT_DOUBLE && item->n_rows == 2 &&
           item->width == 1);
    double *values = item != NULL ? content_doubles(&content, item) : NULL;
    EXPECT(values != NULL && values[1] == 5.0);
    free(values);
    char *unit = content_note(&content, "/series/energy", "unit");
    EXPECT_STRING(unit, "J");
    free(unit);
    item = content_find(&content, "/run@title");
    char *title = item != NULL ? content_text(&content, item) : NULL;
    EXPECT_STRING(title, "a title");
    free(title);
    EXPECT(content_find(&content, "/nothing") == NULL);
    content_clear(&content);
    free(path);
    free(folder);
    remove_run(run);
    why = content_open(&content, "/nowhere.h5");
    EXPECT(why != NULL);
    free(why);
}

/* A save on two ranks, cut at x = 1, or on one. */
static void add_boxes(struct series *series, double step, int n_ranks)
{
    for (int q = 0; q < n_ranks; q++) {
        const double row[] = {step,
                              q,
                              q > 0 ? 1.0 : -(double)INFINITY,
                              -(double)INFINITY,
                              -(double)INFINITY,
                              q + 1 < n_ranks ? 1.0 : (double)INFINITY,
                              (double)INFINITY,
                              (double)INFINITY};
        series_add_row(series, row);
    }
}

TEST(spheres_belong_to_the_box_they_lie_in)
{
    static const char *const names[] = {"step",  "rank",   "low_x",  "low_y",
                                        "low_z", "high_x", "high_y", "high_z"};
    static const double x[] = {0.5, 1.0, -1e9, 1e9};
    struct spheres spheres;
    spheres_init(&spheres);
    spheres_reserve(&spheres, 4);
    for (int i = 0; i < 4; i++)
        sphere_position(&spheres, i)[0] = x[i];
    spheres.n_owned = 4;
    struct series series;
    series_init(&series, "subdomains");
    int owner[4] = {-1, -1, -1, -1};
    EXPECT(owners_of_rows(owner, &spheres, &series, 10) == -1);
    for (int k = 0; k < 8; k++)
        series_add_column(&series, "1", "", "%s", names[k]);
    add_boxes(&series, 10.0, 2);
    add_boxes(&series, 20.0, 1);
    EXPECT(owners_of_rows(owner, &spheres, &series, 9) == -1);
    EXPECT(owners_of_rows(owner, &spheres, &series, 19) == 10);
    EXPECT(owner[0] == 0 && owner[1] == 1 && owner[2] == 0 && owner[3] == 1);
    EXPECT(owners_of_rows(owner, &spheres, &series, 20) == 20);
    EXPECT(owner[1] == 0 && owner[3] == 0);
    series.values[2] = 0.75; /* the first box lets go of its outer side */
    EXPECT(owners_of_rows(owner, &spheres, &series, 10) == -2);
    series_clear(&series);
    spheres_clear(&spheres);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
