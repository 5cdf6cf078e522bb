/*
 * Verification: single answers known from theory or publications, compared with what the real
 * step of the program (run/step.h) gives.
 *
 * A case is a program tests/verification/case_NAME.c.  It builds small scenes from job texts,
 * steps them, and records rows: what was expected, by whom, what came out, how much they may
 * differ and why.  `make test` prints a row as `ok NAME` or `FAIL NAME: ...`; `make verify`
 * asks with `--table` for lines of tab-separated fields and makes tests/verification/README.md
 * of them.  A case that takes longer than some seconds says so near its top in a comment that
 * holds nothing but the word `long`, and runs in `make verify` alone.
 *
 * Forces are not read but follow from what a step does to a velocity, m dv/dt, so that a row
 * speaks of the motion itself.
 */
#ifndef TREMIE_TESTS_VERIFICATION_VERIFY_H
#define TREMIE_TESTS_VERIFICATION_VERIFY_H

#include <stdint.h>

#include "base/vec3.h"

struct simulation;

enum verify_kind {
    VERIFY_RELATIVE, /* |measured - expected| <= tolerance |expected| */
    VERIFY_ABSOLUTE, /* |measured - expected| <= tolerance */
    VERIFY_AT_MOST,  /* measured <= expected + tolerance */
    VERIFY_AT_LEAST, /* measured >= expected - tolerance */
};

/* Starts MPI and the case. */
void verify_begin(int argc, char **argv, const char *title, const char *source);
/* From here on rows have another source. */
void verify_source(const char *source);
/* Records a row; the tolerance's reason in a few words.  NaN is never met. */
void verify_row(const char *quantity, const char *unit, double expected, double measured,
                double tolerance, enum verify_kind kind, const char *why);
/* Ends MPI; the status to exit with. */
int verify_end(void);

/* A scene at step 0 of the job's YAML text (printf format), which leaves out `time`: the step
 * [s] is given here and the end is far away.  `domain: {leavers: ignore}` is usual. */
struct simulation *verify_scene(double dt, const char *yaml_format, ...)
    __attribute__((format(printf, 2, 3)));
void verify_scene_free(struct simulation *sim);
/* The step that `step: auto` takes for the same text, as runs of the program get it [s]. */
double verify_automatic_step(const char *yaml);

/* An entry of the job's list `spheres`: one sphere.  The caller frees it. */
char *verify_sphere(const char *name, const char *material, double radius, struct vec3 position,
                    struct vec3 velocity, struct vec3 spin);

/* n steps; a failure that would stop a run ends the case as not met. */
void verify_steps(struct simulation *sim, int64_t n);

/* Sphere by id: place at the step [m], velocity [m/s] and angular velocity [rad/s] half a step
 * before it, mass [kg]. */
struct vec3 verify_position(const struct simulation *sim, int64_t id);
struct vec3 verify_velocity(const struct simulation *sim, int64_t id);
struct vec3 verify_spin(const struct simulation *sim, int64_t id);
double verify_mass(const struct simulation *sim, int64_t id);
/* Storage index of the sphere, for what the above does not give. */
int verify_index(const struct simulation *sim, int64_t id);

/* A column of the last sample that was taken (output.series.every says how often). */
double verify_series(const struct simulation *sim, const char *column);

/* A number between -1 and 1, the next of a fixed sequence. */
static inline double verify_random(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return 2.0 * (double)(*state >> 11) * 0x1p-53 - 1.0;
}

#endif
