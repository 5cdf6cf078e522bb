/* The sweep of a job: its variants, what they are called, what they make of the job, and what
 * is refused and where. */
#include "check.h"

#include <stdio.h>
#include <stdlib.h>

#include "base/report.h"
#include "job/job.h"
#include "job/sweep.h"

static struct sweep sweep;
static struct mistakes mistakes;
static char path[300];

#define JOB                                                                                    \
    "time: {end: 1.5, step: 1.0e-5}\n"                                                         \
    "materials: {ore: {density: 2367, young: 6.25e10, poisson: 0.2}}\n"                        \
    "contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]}\n"             \
    "spheres:\n"                                                                               \
    "  - {name: heap, material: ore, radius: 0.1, packing: {kind: lattice, count: 10, "        \
    "spacing: 0.22, corner: [0, 0, 1], size: [1, 1]}}\n"
enum { LINES = 5 }; /* of JOB */

static void write_job(const char *text)
{
    const char *scratch = getenv("SCRATCH");
    snprintf(path, sizeof path, "%s/job.yaml", scratch != NULL ? scratch : "/tmp");
    FILE *file = fopen(path, "w");
    if (file != NULL) {
        fprintf(file, "%s%s", JOB, text);
        fclose(file);
    }
}

/* Reads the sweep behind the job, afresh. */
static bool sweep_from(const char *text, int n, const struct job_override *overrides)
{
    sweep_clear(&sweep);
    mistakes_clear(&mistakes);
    write_job(text);
    return job_read_sweep(&sweep, path, n, overrides, &mistakes);
}

/* Is this the only mistake, at this place of the sweep's lines? */
static bool is_only_mistake(int line, int column, const char *text)
{
    const struct mistake *m = mistakes.list;
    if (mistakes.n == 1 && m->line == LINES + line && m->column == column &&
        strcmp(m->text, text) == 0)
        return true;
    for (int i = 0; i < mistakes.n; i++)
        printf("  %d:%d: %s\n", mistakes.list[i].line - LINES, mistakes.list[i].column,
               mistakes.list[i].text);
    return false;
}

TEST(no_sweep)
{
    EXPECT(sweep_from("", 0, NULL) && sweep.n_variants == 0);
    EXPECT(sweep_from("sweep: []\n", 0, NULL) && sweep.n_variants == 0);
    const struct job_override none = {"sweep=[]"};
    EXPECT(sweep_from("sweep: [{key: seed, values: [1, 2]}]\n", 1, &none) &&
           sweep.n_variants == 0);
}

TEST(a_grid)
{
    EXPECT(sweep_from("sweep:\n"
                      "  - {key: contact.pairs.0.friction, values: [0.3, 5e-1]}\n"
                      "  - {key: spheres.0.radius, from: 80 mm, to: 120 mm, count: 3}\n",
                      0, NULL));
    EXPECT(sweep.n_keys == 2 && sweep.n_variants == 6);
    EXPECT_STRING(sweep.names[0], "friction");
    EXPECT_STRING(sweep.keys[1], "spheres.0.radius");
    EXPECT_STRING(sweep_value(&sweep, 1, 1), "80 mm");
    EXPECT_STRING(sweep_value(&sweep, 2, 1), "100 mm");
    EXPECT_STRING(sweep_value(&sweep, 4, 0), "5e-1");
    EXPECT_STRING(sweep.folders[0], "friction_0.3_radius_80mm");
    EXPECT_STRING(sweep.folders[5], "friction_5e-1_radius_120mm");
}

TEST(ranges_are_rounded)
{
    EXPECT(sweep_from("sweep: [{key: damping, from: 0.1, to: 0.5, count: 5}]\n", 0, NULL));
    EXPECT_STRING(sweep_value(&sweep, 3, 0), "0.3"); /* not 0.30000000000000004 */
    EXPECT_STRING(sweep_value(&sweep, 5, 0), "0.5");
    EXPECT(sweep_from("sweep: [{key: damping, from: 1e-2, to: 100, count: 5, spacing: log}]\n",
                      0, NULL));
    EXPECT_STRING(sweep_value(&sweep, 1, 0), "1e-2");
    EXPECT_STRING(sweep_value(&sweep, 2, 0), "0.1");
    EXPECT_STRING(sweep_value(&sweep, 3, 0), "1");
    EXPECT_STRING(sweep_value(&sweep, 4, 0), "10");
    EXPECT(sweep_from("sweep: [{key: seed, from: 10, to: 2, count: 3}]\n", 0, NULL));
    EXPECT_STRING(sweep_value(&sweep, 2, 0), "6");
}

TEST(keys_together)
{
    EXPECT(sweep_from("sweep:\n"
                      "  - together:\n"
                      "      - {key: spheres.0.packing.size.0, name: x, values: [1, 2]}\n"
                      "      - {key: spheres.0.packing.size.1, name: y, values: [3, 4]}\n"
                      "  - {key: gravity, values: [[0, 0, -1], [0, 0, -9.81]]}\n",
                      0, NULL));
    EXPECT(sweep.n_keys == 3 && sweep.n_variants == 4);
    EXPECT_STRING(sweep_value(&sweep, 3, 0), "2");
    EXPECT_STRING(sweep_value(&sweep, 3, 1), "4");
    EXPECT_STRING(sweep_value(&sweep, 3, 2), "[0, 0, -1]");
    EXPECT_STRING(sweep.folders[2], "x_2_y_4_gravity_v1");
    char *text = sweep_describe(&sweep, 2);
    EXPECT_STRING(text, "x 1, y 3, gravity [0, 0, -9.81]");
    free(text);
}

TEST(values_that_do_not_fit_a_line)
{
    EXPECT(sweep_from("sweep: [{key: title, values: [a/b, \"\\e[0m\"]},\n"
                      "        {key: gravity.2, name: pull, values: [-1]}]\n",
                      0, NULL));
    EXPECT_STRING(sweep_value(&sweep, 1, 0), "a/b");
    EXPECT_STRING(sweep_value(&sweep, 2, 0), "v2");
    EXPECT_STRING(sweep.folders[1], "title_v2_pull_-1");
}

TEST(a_variant_is_the_job_with_its_values)
{
    struct job variant, by_hand;
    const struct job_override values[] = {
        {"contact.pairs.0.friction=0.25"}, {"spheres.0.radius=90 mm"}, {"time.safety=0.1"}};
    const char text[] = "sweep:\n"
                        "  - {key: contact.pairs.0.friction, values: [0.1, 0.25]}\n"
                        "  - {key: spheres.0.radius, values: [90 mm]}\n"
                        "  - {key: time.safety, values: [0.1]}\n"; /* which the job lacks */
    mistakes_clear(&mistakes);
    write_job(text);
    EXPECT(job_read_variant(&variant, path, 0, NULL, 2, &mistakes));
    write_job("");
    EXPECT(job_read(&by_hand, path, 3, values, &mistakes));
    char *one = job_write(&variant), *other = job_write(&by_hand);
    EXPECT_STRING(one, other);
    EXPECT(strstr(one, "sweep") == NULL && strstr(one, "friction: 0.25") != NULL);
    free(one);
    free(other);
    job_clear(&variant);
    job_clear(&by_hand);
}

TEST(a_bad_value_is_named_where_it_stands)
{
    struct job job;
    write_job("sweep:\n"
              "  - key: contact.pairs.0.friction\n"
              "    values: [0.1, -2]\n"
              "  - {key: spheres.3.radius, values: [1]}\n"
              "  - {key: spheres.0.radios, values: [1]}\n");
    mistakes_clear(&mistakes);
    EXPECT(!job_read_variant(&job, path, 0, NULL, 2, &mistakes) && mistakes.n == 3);
    EXPECT(mistakes.n == 3 && mistakes.list[0].line == LINES + 4 &&
           mistakes.list[0].column == 11);
    EXPECT_STRING(mistakes.list[0].text, "'spheres.3.radius' leads nowhere; a path like "
                                         "spheres.0.radius is expected (lists count from 0)");
    for (int i = 1; i < mistakes.n; i++)
        if (mistakes.list[i].line == LINES + 3)
            EXPECT(mistakes.list[i].column == 19 &&
                   strncmp(mistakes.list[i].text, "contact.pairs.0.friction is '-2'", 32) == 0);
        else
            EXPECT(mistakes.list[i].line == LINES + 5 && mistakes.list[i].column == 11 &&
                   strstr(mistakes.list[i].text, "unknown key spheres.0.radios") != NULL);
}

TEST(what_is_refused)
{
    static const struct {
        const char *text;
        int line, column;
        const char *mistake;
    } cases[] = {
        {"sweep: {key: seed}\n", 1, 8,
         "sweep is no list of at most 100 mappings (- key: value); that is expected"},
        {"sweep: [{key: seed}]\n", 1, 9,
         "sweep.0.from is missing; values, or from, to and count, are expected"},
        {"sweep: [{values: [1]}]\n", 1, 9,
         "sweep.0.key is missing; the key that varies, like spheres.0.radius, is expected"},
        {"sweep: [{key: seed, values: []}]\n", 1, 29,
         "sweep.0.values is no list of them; a list of 1 to 10000 is expected"},
        {"sweep: [{key: seed, values: [1, 2, 1]}]\n", 1, 36,
         "sweep.0: value 3 is the same as value 1; values that differ are expected"},
        {"sweep: [{key: seed, values: [1], count: 3}]\n", 1, 9,
         "sweep.0 has values and a range; values, or from, to and count, are expected"},
        {"sweep: [{key: seed, vales: [1]}]\n", 1, 21,
         "unknown key sweep.0.vales; 'values' is expected"},
        {"sweep: [{key: seed, from: 1, to: many, count: 3}]\n", 1, 34,
         "sweep.0.to is 'many'; a number, with or without a unit, is expected"},
        {"sweep: [{key: seed, from: 1 mm, to: 1 m, count: 3}]\n", 1, 37,
         "sweep.0.to is in another unit than sweep.0.from; the same is expected"},
        {"sweep: [{key: seed, from: 1, to: 3}]\n", 1, 9,
         "sweep.0.count is missing; a whole number from 2 on is expected"},
        {"sweep: [{key: seed, from: 0, to: 3, count: 3, spacing: log}]\n", 1, 27,
         "sweep.0: equal ratios do not reach 0; values above it are expected"},
        {"sweep: [{key: \"spheres/../\\e[0m\", values: [1]}]\n", 1, 15,
         "sweep.0.key is 'spheres/../?[0m'; a path like spheres.0.radius is expected"},
        {"sweep: [{key: sweep.0.key, values: [1]}]\n", 1, 15,
         "sweep.0.key is the sweep itself; another key is expected"},
        {"sweep:\n  - {key: gravity, values: [[0, 0, 0]]}\n"
         "  - {key: gravity.2, values: [1, 2]}\n",
         3, 11,
         "'gravity.2' and 'gravity' (line 7) vary the same; keys that have nothing in common "
         "are expected"},
        {"sweep:\n  - {key: spheres.0.radius, values: [1]}\n"
         "  - {key: spheres.1.radius, values: [1]}\n",
         3, 11,
         "both this and the key in line 7 are called 'radius'; a name of its own, name: ..., "
         "is expected"},
        {"sweep:\n  - together:\n      - {key: seed, values: [1, 2]}\n"
         "      - {key: damping, values: [1, 2, 3]}\n",
         4, 9, "sweep.0.together: 'damping' has 3 values and 'seed' 2; as many are expected"},
        {"sweep: [{together: [{key: seed, values: [1]}], name: x}]\n", 1, 9,
         "sweep.0.together stands beside other keys, or is empty; keys that vary together, in "
         "it alone, are expected"},
        {"sweep:\n  - {key: seed, from: 1, to: 1000, count: 1000}\n"
         "  - {key: damping, from: 1, to: 1000, count: 1000}\n",
         2, 3, "sweep has more than 10000 variants; fewer are expected"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        EXPECT(!sweep_from(cases[k].text, 0, NULL));
        EXPECT(is_only_mistake(cases[k].line, cases[k].column, cases[k].mistake));
        EXPECT(sweep.n_variants == 0);
    }
}

TEST(what_varies_is_not_set)
{
    const struct job_override inside = {"gravity.2=-1"}, beside = {"seed=3"};
    const char text[] = "sweep: [{key: gravity, values: [[0, 0, 0]]}]\n";
    EXPECT(sweep_from(text, 1, &beside) && sweep.n_variants == 1);
    EXPECT(!sweep_from(text, 1, &inside));
    EXPECT(mistakes.n == 1 && strcmp(mistakes.list[0].file, "--set") == 0);
    sweep_clear(&sweep);
    mistakes_clear(&mistakes);
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
