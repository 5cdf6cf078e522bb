/* See verify.h. */
#include "verify.h"

#include <math.h>
#include <mpi.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "job/job.h"
#include "model/solid_mesh.h"
#include "run/check.h"
#include "run/simulation.h"
#include "run/step.h"

static struct {
    const char *title, *source;
    struct comm comm;
    bool table;
    int n_rows, n_failed;
} verify;

void verify_begin(int argc, char **argv, const char *title, const char *source)
{
    COMM_CHECK(MPI_Init(&argc, &argv));
    verify.comm = comm_world();
    report_init(true);
    verify.title = title;
    verify.source = source;
    verify.table = argc > 1 && strcmp(argv[1], "--table") == 0;
}

void verify_source(const char *source)
{
    verify.source = source;
}

static bool is_met(double error, double expected, double tolerance, enum verify_kind kind)
{
    switch (kind) {
    case VERIFY_AT_MOST:
        return error <= tolerance;
    case VERIFY_AT_LEAST:
        return error >= -tolerance;
    case VERIFY_RELATIVE:
        return fabs(error) <= tolerance * fabs(expected);
    case VERIFY_ABSOLUTE:
    default:
        return fabs(error) <= tolerance;
    }
}

/* What stands before an expected value that is a limit. */
static const char *limit_word(enum verify_kind kind)
{
    return kind == VERIFY_AT_MOST ? "at most " : kind == VERIFY_AT_LEAST ? "at least " : "";
}

/* Error and tolerance as people read them: shares as such, else in the quantity's unit. */
static void print_table_line(const char *quantity, const char *unit, double expected,
                             double measured, double tolerance, enum verify_kind kind,
                             const char *why, bool met)
{
    const double error = measured - expected;
    const char *limit = limit_word(kind);
    const char *space = unit[0] != '\0' ? " " : "", *of = "";
    double shown = error;
    if (kind == VERIFY_RELATIVE) {
        shown = expected != 0.0 ? error / fabs(expected) : error;
        of = " rel.";
    }
    printf("%s\t%s\t%s\t%s%.6g%s%s\t%.6g%s%s\t%.1e%s\t%.2g%s\t%s\t%s\n", verify.title, quantity,
           verify.source, limit, expected, space, unit, measured, space, unit, shown, of,
           tolerance, of, why, met ? "met" : "not met");
}

void verify_row(const char *quantity, const char *unit, double expected, double measured,
                double tolerance, enum verify_kind kind, const char *why)
{
    const bool met = is_met(measured - expected, expected, tolerance, kind);
    verify.n_rows++;
    verify.n_failed += !met;
    if (verify.table)
        print_table_line(quantity, unit, expected, measured, tolerance, kind, why, met);
    else if (met)
        printf("ok %s\n", quantity);
    else
        printf("FAIL %s: measured %.10g %s, expected %s%.10g, tolerance %.3g%s\n", quantity,
               measured, unit, limit_word(kind), expected, tolerance,
               kind == VERIFY_RELATIVE ? " of it" : "");
    fflush(stdout);
}

int verify_end(void)
{
    if (verify.table)
        puts("end");
    COMM_CHECK(MPI_Finalize());
    return verify.n_rows == 0 || verify.n_failed > 0;
}

/* ------------------------------------------------------------------------------- scenes */

struct scene {
    struct simulation sim; /* first: what callers hold is a pointer to it */
    struct job job;
};

/* Reads a job, and completes it where that is asked for. */
static void read_job(struct job *job, const char *text, bool complete)
{
    struct mistakes mistakes;
    mistakes_init(&mistakes);
    if (!job_read_text(job, "verification.yaml", text, &mistakes) ||
        (complete && !check_complete(job, 1, &mistakes))) {
        mistakes_print(&mistakes);
        CHECK(false, "the job of '%s' is not valid", verify.title);
    }
    mistakes_clear(&mistakes);
}

double verify_automatic_step(const char *yaml)
{
    char *text = array_format("time: {end: 1, step: auto}\n%s", yaml);
    struct job job;
    read_job(&job, text, true);
    const double step = job.time.step;
    solid_mesh_release(&job);
    job_clear(&job);
    free(text);
    return step;
}

struct simulation *verify_scene(double dt, const char *yaml_format, ...)
{
    char *rest = NULL;
    va_list arguments;
    va_start(arguments, yaml_format);
    CHECK(vasprintf(&rest, yaml_format, arguments) >= 0, "no memory for a job's text");
    va_end(arguments);
    char *text = array_format("time: {end: %.17g, step: %.17g}\n%s", 1e12 * dt, dt, rest);
    struct scene *scene = array_allocate(1, sizeof *scene);
    read_job(&scene->job, text, false);
    simulation_create(&scene->sim, &verify.comm, &scene->job, ISA_AUTO);
    free(rest);
    free(text);
    return &scene->sim;
}

void verify_scene_free(struct simulation *sim)
{
    struct scene *scene = (struct scene *)(void *)sim;
    simulation_destroy(sim);
    job_clear(&scene->job);
    free(scene);
}

char *verify_sphere(const char *name, const char *material, double radius, struct vec3 position,
                    struct vec3 velocity, struct vec3 spin)
{
    return array_format("  - {name: %s, material: %s, radius: %.17g, "
                        "velocity: [%.17g, %.17g, %.17g], spin: [%.17g, %.17g, %.17g], "
                        "packing: {kind: lattice, count: 1, spacing: %.17g, "
                        "corner: [%.17g, %.17g, %.17g], size: [%.17g, %.17g]}}\n",
                        name, material, radius, velocity.x, velocity.y, velocity.z, spin.x,
                        spin.y, spin.z, 2.0 * radius, position.x - radius, position.y - radius,
                        position.z - radius, 2.0 * radius, 2.0 * radius);
}

void verify_steps(struct simulation *sim, int64_t n)
{
    for (int64_t k = 0; k < n; k++) {
        step(sim);
        if (sim->watch.failure != WATCH_FINE) {
            watch_explain(&sim->watch, sim);
            fprintf(stderr, "that was a scene of '%s', after %d rows\n", verify.title,
                    verify.n_rows);
            printf("FAIL %s: a run stops at step %lld of %g s, see what was said\n",
                   verify.title, (long long)sim->step, sim->dt);
            COMM_CHECK(MPI_Finalize());
            exit(1);
        }
    }
}

int verify_index(const struct simulation *sim, int64_t id)
{
    for (int i = 0; i < sim->spheres.n_owned; i++) {
        if (sim->spheres.id[i] == id)
            return i;
    }
    CHECK(false, "there is no sphere %lld", (long long)id);
    return -1;
}

static struct vec3 lanes_vector(const double *lanes)
{
    return (struct vec3){lanes[0], lanes[1], lanes[2]};
}

struct vec3 verify_position(const struct simulation *sim, int64_t id)
{
    return lanes_vector(sphere_position(&sim->spheres, verify_index(sim, id)));
}

struct vec3 verify_velocity(const struct simulation *sim, int64_t id)
{
    return lanes_vector(sphere_velocity(&sim->spheres, verify_index(sim, id)));
}

struct vec3 verify_spin(const struct simulation *sim, int64_t id)
{
    return lanes_vector(sphere_angular_velocity(&sim->spheres, verify_index(sim, id)));
}

double verify_mass(const struct simulation *sim, int64_t id)
{
    return 1.0 / sphere_inverse_mass(&sim->spheres, verify_index(sim, id));
}

double verify_series(const struct simulation *sim, const char *column)
{
    const struct series *table = &sim->observe.table;
    const int c = series_column_index(table, column);
    CHECK(c >= 0 && table->n_rows > 0, "no sample has a column %s", column);
    return table->values[(table->n_rows - 1) * table->n_columns + c];
}
