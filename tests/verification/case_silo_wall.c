/*
 * A silo whose wall is a shell, jobs/silo_wall.yaml as users run it: what grain presses on the
 * wall, and what the wall bears, from the run's files and tremie-profile.
 */
/* long */
#include <math.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../../postproc/sheet.h"
#include "base/array.h"
#include "base/report.h"
#include "verify.h"

/* Of the job. */
static const double GRAVITY = 9.81, GRAIN = 350.0, RADIUS = 0.252, INSIDE = 0.25, THICK = 0.004,
                    WALL_DENSITY = 950.0, FRICTION = 0.4;

enum { SLICES = 10 }; /* of the wall's height, from the top */

struct slice {
    double depth, hoop, upright, pressure; /* [m], [Pa]; tension and pressure positive */
};

struct silo {
    double borne; /* by wall, floor and what stands above, grain at rest [N] */
    double foot;  /* of the wall, less what grain puts on it [N] */
    double density;
    struct slice slices[SLICES];
};

static void shell(char *command)
{
    char name[] = "sh", option[] = "-c";
    char *const words[] = {name, option, command, NULL};
    pid_t child;
    int status = 0;
    CHECK(posix_spawnp(&child, name, NULL, NULL, words, environ) == 0 &&
              waitpid(child, &status, 0) == child && status == 0,
          "'%s' does not end well", command);
}

/* A number of a table, of the first row where the first column is at least `from`. */
static double find(const struct sheet *table, const char *first, double from, const char *name)
{
    const int key = sheet_column(table, first), column = sheet_column(table, name);
    CHECK(key >= 0 && column >= 0, "a table is without '%s' or '%s'", first, name);
    for (int row = 0; row < table->n_cells; row += table->n_columns)
        if (strtod(table->cells[row + key], NULL) >= from)
            return strtod(table->cells[row + column], NULL);
    CHECK(false, "a table ends before %s is %g", first, from);
    return NAN;
}

static void read_table(struct sheet *table, const char *folder, const char *name)
{
    char *path = array_format("%s/%s", folder, name);
    sheet_init(table);
    CHECK(sheet_read_csv(table, path) == 0, "%s cannot be read", path);
    free(path);
}

static double at_rest(const struct sheet *series, const char *name)
{
    return find(series, "time_s", 1.979, name);
}

static void read_series(const char *folder, struct silo *silo)
{
    struct sheet series;
    read_table(&series, folder, "series.csv");
    const double wall = at_rest(&series, "wall.force_z_N");
    silo->borne =
        -wall - at_rest(&series, "floor.force_z_N") - at_rest(&series, "above.force_z_N");
    silo->foot = at_rest(&series, "wall.base.reaction_z_N") + wall;
    silo->density = at_rest(&series, "middle.mass_kg") / (M_PI * INSIDE * INSIDE);
    sheet_clear(&series);
}

static void read_slices(const char *folder, struct slice slices[SLICES])
{
    struct sheet wall;
    read_table(&wall, folder, "wall.csv");
    for (int k = 0; k < SLICES; k++) {
        const double depth = k > 0 ? slices[k - 1].depth + 1e-6 : 0.0;
        slices[k] = (struct slice){find(&wall, "depth_m", depth, "depth_m"),
                                   find(&wall, "depth_m", depth, "stress_xx_Pa") +
                                       find(&wall, "depth_m", depth, "stress_yy_Pa"),
                                   find(&wall, "depth_m", depth, "stress_zz_Pa"),
                                   -find(&wall, "depth_m", depth, "contact_pressure_Pa")};
    }
    sheet_clear(&wall);
}

/* Runs the job; before MPI starts here, which programs that it starts would not like. */
static void run(struct silo *silo)
{
    const char *bin = getenv("BIN"), *scratch = getenv("TMPDIR");
    CHECK(bin != NULL, "BIN does not say where the programs are");
    char *folder = array_format("%s/tremie-silo.XXXXXX", scratch != NULL ? scratch : "/tmp");
    CHECK(mkdtemp(folder) != NULL, "no folder %s", folder);
    char *command = array_format(
        "exec > %s/said 2>&1; set -e; %s/tremie run jobs/silo_wall.yaml --out %s/run; "
        "%s/tremie-info %s/run --csv %s/series.csv; "
        "%s/tremie-profile %s/run --body wall --since 2.3 --slices %d --csv %s/wall.csv",
        folder, bin, folder, bin, folder, folder, bin, folder, SLICES, folder);
    shell(command);
    free(command);
    read_series(folder, silo);
    read_slices(folder, silo->slices);
    command = array_format("rm -r %s", folder);
    shell(command);
    free(command);
    free(folder);
}

/* What grain that slides pulls the wall down with from slice a to slice b [Pa]. */
static double friction(const struct slice *slices, int a, int b)
{
    const double growth =
        (slices[a].upright - slices[b].upright) / (slices[b].depth - slices[a].depth);
    return (growth - WALL_DENSITY * GRAVITY) * THICK;
}

static double mean_pressure(const struct slice *slices, int a, int b)
{
    double sum = 0.0;
    for (int k = a; k <= b; k++)
        sum += slices[k].pressure;
    return sum / (b - a + 1);
}

int main(int argc, char **argv)
{
    struct silo silo;
    run(&silo);
    const struct slice *slices = silo.slices;
    verify_begin(argc, argv, "A silo with a wall of shells (`jobs/silo_wall.yaml`)", "statics");
    verify_row("grain at rest: borne by wall, floor and what stands above", "N",
               GRAIN * GRAVITY, silo.borne, 2e-4, VERIFY_RELATIVE, "it still settles");
    verify_row("grain at rest: the wall's foot, less what grain puts on the wall", "N",
               WALL_DENSITY * 2.0 * M_PI * RADIUS * 2.0 * THICK * GRAVITY, silo.foot, 0.004,
               VERIFY_RELATIVE, "24 sides, not round");
    verify_source("a pipe: p R / t");
    for (int k = 0; k < SLICES - 1; k++) { /* the last one is held by the foot */
        char text[128];
        snprintf(text, sizeof text, "hoop stress %.1f m below the top", slices[k].depth);
        verify_row(text, "Pa", slices[k].pressure * RADIUS / THICK, slices[k].hoop, 0.04,
                   VERIFY_RELATIVE, "bending, 24 sides, instants 20 ms apart");
    }
    verify_source("Janssen, Z. VDI 39, 1895, 1045");
    const double at_most = silo.density * GRAVITY * INSIDE / 2.0;
    const double mobilised = friction(slices, 2, 8) / mean_pressure(slices, 2, 8);
    verify_row("friction on the wall over pressure, 0.5 to 1.7 m below the top", "", FRICTION,
               mobilised, 0.0, VERIFY_AT_MOST, "grain slides, some of it rolls");
    verify_row("pressure 1.3 to 1.7 m below the top", "Pa", at_most / mobilised,
               mean_pressure(slices, 6, 8), 0.1, VERIFY_RELATIVE,
               "grain bridges from side to side, 12 spheres");
    verify_row("pressure 1.7 m below the top over that of a liquid as heavy", "", 0.25,
               slices[8].pressure / (silo.density * GRAVITY * slices[8].depth), 0.0,
               VERIFY_AT_MOST, "a limit is reached");
    return verify_end();
}
