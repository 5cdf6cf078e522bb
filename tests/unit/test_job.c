/* The job file: what is read, what is refused and with which words, round trips, libraries. */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "job/job_keys.h"

static struct job job;
static struct mistakes mistakes;
static char folder[200];

/* Writes a file into the scratch folder and returns its path. */
static const char *file_write(const char *name, const char *text)
{
    static char path[300];
    const char *scratch = getenv("SCRATCH");
    snprintf(folder, sizeof folder, "%s", scratch != NULL ? scratch : "/tmp");
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (file != NULL) {
        fputs(text, file);
        fclose(file);
    }
    return path;
}

/* Reads a job text with overrides, afresh. */
static bool job_from(const char *text, int n, const struct job_override *overrides)
{
    job_clear(&job);
    mistakes_clear(&mistakes);
    return job_read(&job, file_write("job.yaml", text), n, overrides, &mistakes);
}

/* Is there a mistake at this place with this text? */
static bool has_mistake(int line, int column, const char *text)
{
    for (int i = 0; i < mistakes.n; i++) {
        const struct mistake *m = &mistakes.list[i];
        if (m->line == line && m->column == column && strcmp(m->text, text) == 0)
            return true;
    }
    for (int i = 0; i < mistakes.n; i++)
        printf("  %d:%d: %s\n", mistakes.list[i].line, mistakes.list[i].column,
               mistakes.list[i].text);
    return false;
}

#define SPHERES                                                                                \
    "spheres:\n"                                                                               \
    "  - {name: heap, material: ore, radius: 0.1, packing: {kind: lattice, count: 10, "        \
    "spacing: 0.22, corner: [0, 0, 1], size: [1, 1]}}\n"
#define START                                                                                  \
    "time: {end: 1.5, step: 1.0e-5}\n"                                                         \
    "materials: {ore: {density: 2367, young: 6.25e10, poisson: 0.2}}\n"                        \
    "contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]}\n"
#define BODY(geometry) "bodies: [{name: wall, material: ore, geometry: {" geometry "}}]\n"

TEST(a_small_job_is_filled)
{
    EXPECT(job_from(START SPHERES, 0, NULL));
    EXPECT(job.time.end == 1.5 && job.time.step == 1e-5 && job.time.safety == 0.2);
    EXPECT(job.gravity.x == 0.0 && job.gravity.z == -9.81);
    EXPECT(job.n_materials == 1 && job.materials[0].young == 6.25e10);
    EXPECT(job.n_pairs == 1 && job.pairs[0].friction == 0.5);
    EXPECT(job.n_spheres == 1 && job.spheres[0].count == 10 && job.spheres[0].spacing == 0.22);
    EXPECT(job.spheres[0].corner.z == 1.0 && job.spheres[0].size[1] == 1.0);
    EXPECT(job.n_bodies == 0 && job.n_sections == 0 && job.energy_ledger);
    EXPECT(!job.domain.given && job.domain.leavers == JOB_LEAVERS_STOP);
    EXPECT(job.decomposition.buffer == 0.0 && job.decomposition.imbalance == 1.1);
    EXPECT(job.decomposition.fixed[0] == 0 && job.checkpoint.every_wall == 600.0);
    EXPECT(job.checkpoint.keep == 3 && job.watch.overlap == 0.1 && job.order_every == 4096);
    EXPECT_STRING(job.name, "job");
}

static const char shapes[] =

    START SPHERES
    "bodies:\n"
    "  - {name: a, material: ore, geometry: {kind: plane, point: [0, 0, 1 cm], normal: [0, 0, "
    "2],"
    " extent: 2}}\n"
    "  - {name: b, material: ore, geometry: {kind: box, min: [0, 0, 0], max: [1, 1, 1],"
    " open: [top, x_min]}}\n"
    "  - {name: c, material: ore, geometry: {kind: hopper, top: [6, 6], outlet: [1, 2], z: [3, "
    "6],"
    " centre: [1, 0]}, motion: {velocity: [1 mm/s, 0, 0], rotation: {point: [0, 0, 1],"
    " axis: [0, 3, 4], rate: 2}, start: 0.5, stop: 1}}\n"
    "  - {name: d, material: ore, geometry: {kind: mesh, vertices: [[0, 0, 0], [1, 0, 0], [1, "
    "1, 0],"
    " [0, 1 mm, 0]], facets: [[0, 1, 2], [0, 1, 2, 3]]}}\n";

TEST(bodies_of_all_shapes)
{
    EXPECT(job_from(shapes, 0, NULL));
    EXPECT(job.n_bodies == 4);
    EXPECT(job.bodies[0].point.z == 0.01 && job.bodies[0].normal.z == 1.0);
    EXPECT(job.bodies[0].n_motions == 0 && !job.bodies[0].free.given);
    EXPECT(job.bodies[1].open == (JOB_SIDE_TOP | JOB_SIDE_X_MIN));
    const struct job_motion *motion = job.bodies[2].motions;
    EXPECT(job.bodies[2].n_motions == 1 && motion->velocity.x == 1e-3 && motion->start == 0.5 &&
           motion->stop == 1.0);
    EXPECT(motion->axis.y == 0.6 && motion->axis.z == 0.8 && motion->pivot.z == 1.0);
    EXPECT(job.bodies[2].outlet[1] == 2.0 && job.bodies[2].centre[0] == 1.0);
    EXPECT(job.bodies[3].n_vertices == 4 && job.bodies[3].vertices[3].y == 1e-3);
    EXPECT(job.bodies[3].n_facets == 2 && job.bodies[3].facets[0][3] == -1);
    EXPECT(job.bodies[3].facets[1][3] == 3);
}

static const char solids[] =
    "time: {end: 1.5, step: 1.0e-5}\n"
    "materials:\n"
    "  ore: {density: 2367, young: 6.25e10, poisson: 0.2, yield: 2 MPa, hardening: 1 MPa}\n"
    "  tin: {density: 7310, young: 5e10, poisson: 0.3,"
    " hardening_table: [{strain: 0, stress: 9 MPa}, {strain: 0.5, stress: 20 MPa}]}\n"
    "contact: {pairs: [{between: [ore, ore], friction: 0.5, restitution: 0.5}]}\n" SPHERES
    "bodies:\n"
    "  - name: a\n"
    "    material: ore\n"
    "    model: solid\n"
    "    mesh: {kind: plate, corner: [0, 0, 9], size: [2, 1], thickness: 5 mm, cell: 2 mm,"
    " elements: tetrahedra, rotate: {axis: [0, 0, 2], angle: 90 deg}}\n"
    "    sets: [{name: half, region: {kind: box, min: [0, 0, 0], max: [1, 1, 9]}}]\n"
    "    boundary:\n"
    "      - {set: half, fixed: [x, z]}\n"
    "      - {set: top, direction: z, velocity: 0}\n"
    "      - {set: top, pressure_table: [{time: 0, pressure: 0}, {time: 1 ms, pressure: 2 bar}]}\n"
    "    velocity: [0, 0, -227]\n"
    "    damping: {stiffness: 1 us}\n"
    "    hourglass: {kind: viscous}\n"
    "  - {name: b, material: ore, model: solid, mesh: {kind: tube, from: [0, 0, 9], to: [0, 0, 8],"
    " inner: 1, outer: 2, cells: [12, 2, 3]}}\n";

TEST(solids_are_filled_and_written)
{
    struct job read;
    EXPECT(job_from(solids, 0, NULL));
    EXPECT(job.n_materials == 1 && job.materials[0].yield == 2e6); /* the tin is not used */
    EXPECT(job.bodies[0].model == JOB_MODEL_SOLID && job.bodies[0].place.line == 9);
    const struct job_solid *solid = &job.bodies[0].solid;
    EXPECT(solid->kind == JOB_MESH_PLATE && solid->elements == JOB_ELEMENTS_TETRAHEDRA);
    EXPECT(solid->thickness == 0.005 && solid->cell == 0.002 && solid->cells[0] == 0);
    EXPECT(solid->n_sets == 1 && solid->sets[0].region.max.x == 1.0);
    EXPECT(solid->n_boundary == 3 && solid->boundary[0].fixed == 5);
    EXPECT(solid->boundary[1].has_velocity && solid->boundary[1].direction == 2);
    EXPECT(solid->boundary[2].n_pressures == 2 && solid->boundary[2].pressures[1].value == 2e5);
    EXPECT(solid->boundary[2].place.line == 17 && solid->velocity.z == -227.0);
    EXPECT(solid->damping.mass == 0.0 && solid->damping.stiffness == 1e-6);
    EXPECT(solid->hourglass.kind == JOB_HOURGLASS_VISCOUS);
    EXPECT(solid->hourglass.coefficient == 0.05);
    EXPECT(job.bodies[1].solid.cells[2] == 3 && job.bodies[1].outer == 2.0);
    char *text = job_write(&job), *again = NULL;
    EXPECT(job_read_text(&read, "job.yaml", text, &mistakes));
    again = job_write(&read);
    EXPECT_STRING(again, text);
    EXPECT(job_difference(text, again) == NULL);
    job_clear(&read);
    free(text);
    free(again);
}

TEST(all_mistakes_are_listed_at_once)
{
    EXPECT(!job_from("titel: x\n"
                     "time: {end: 1.5 m, step: -1, safty: 0.5}\n"
                     "materials: {ore: {density: 2367, young: 1e10, poisson: 0.5}}\n"
                     "contact:\n"
                     "  law: hertz\n"
                     "  pairs: [{between: [ore, oer], friction: .nan, restitution: 2}]\n"
                     "spheres:\n"
                     "  - {name: 1st, material: ore, packing: {kind: lattice, count: 10.5}}\n"
                     "sections: 3\n",
                     0, NULL));
    EXPECT(has_mistake(1, 1, "unknown key titel; 'title' is expected"));
    EXPECT(has_mistake(2, 13, "time.end: '1.5 m' is a length; a time like 10 us is expected"));
    EXPECT(has_mistake(
        2, 26, "time.step is '-1'; a time above 0 and at most 1000 s, or auto, is expected"));
    EXPECT(has_mistake(2, 30, "unknown key time.safty; 'safety' is expected"));
    EXPECT(has_mistake(3, 56,
                       "materials.ore.poisson is '0.5'; a number above -1 and below 0.5 is "
                       "expected"));
    EXPECT(
        has_mistake(5, 8, "contact.law is 'hertz'; one of hertz-mindlin, linear is expected"));
    EXPECT(has_mistake(
        6, 27, "contact.pairs.0.between: there is no material 'oer'; 'ore' is expected"));
    EXPECT(has_mistake(6, 43,
                       "contact.pairs.0.friction: '.nan' is not a finite number; a number like "
                       "0.5 is expected"));
    EXPECT(has_mistake(6, 62,
                       "contact.pairs.0.restitution is '2'; a number between 0.05 and 1 is "
                       "expected"));
    EXPECT(has_mistake(8, 12,
                       "spheres.0.name is '1st'; a name of letters, digits, - and _ (a letter "
                       "first, at most 40) is expected"));
    EXPECT(has_mistake(8, 64,
                       "spheres.0.packing.count is '10.5'; a whole number between 1 and "
                       "2e+09 is expected"));
    EXPECT(has_mistake(8, 41,
                       "spheres.0.packing.spacing is missing; a length above 0 and at most "
                       "1e+06 m is expected"));
    EXPECT(has_mistake(9, 11,
                       "sections is a single value; a list of at most 60 mappings (- key: "
                       "value) is expected"));
    EXPECT(mistakes.n == 15);
}

/* Reads START SPHERES with one more part that is wrong in one way. */
#define EXPECT_ONE(part, line, column, text)                                                   \
    do {                                                                                       \
        EXPECT(!job_from(START SPHERES part, 0, NULL));                                        \
        EXPECT(mistakes.n == 1);                                                               \
        EXPECT(has_mistake(line, column, text));                                               \
    } while (0)

TEST(yaml_that_is_no_plain_yaml)
{
    EXPECT_ONE("damping:\n\t1\n", 7, 1, "a tab indents this line; YAML wants spaces");
    EXPECT_ONE("damping: \"\xff\"\n", 6, 11,
               "byte 0xff is not valid UTF-8; text in UTF-8 is expected");
    EXPECT_ONE("damping: \x01\n", 6, 10,
               "there is a control character (0x01); text in UTF-8 is expected");
    EXPECT_ONE("damping: &a 1\n", 6, 10,
               "an anchor (&) is used; values written out are expected, aliases are not read");
    EXPECT_ONE("damping: *a\n", 6, 10,
               "an alias (*) is used; values written out are expected, aliases are not read");
    EXPECT_ONE("damping: !!float 1\n", 6, 10, "a tag (!) is used; plain values are expected");
    EXPECT_ONE("---\na: 1\n", 6, 1, "a second document begins (---); one is expected");
    EXPECT_ONE(
        "damping: [1\n", 7, 1,
        "did not find expected ',' or ']' (while parsing a flow sequence); valid YAML is "
        "expected");
    EXPECT_ONE("damping: 1\ndamping: 2\n", 7, 1,
               "the key 'damping' is given twice (before in line 6); once is expected");
    EXPECT_ONE("damping: [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[\n", 6, 41,
               "lists and mappings are nested more than 32 deep; fewer levels are expected");
}

TEST(files_that_are_no_job)
{
    EXPECT(!job_from("", 0, NULL));
    EXPECT(has_mistake(1, 1, "there is nothing in it; 'key: value' lines are expected"));
    EXPECT(!job_from("# nothing\n", 0, NULL));
    EXPECT(has_mistake(1, 1, "there is nothing in it; 'key: value' lines are expected"));
    EXPECT(!job_from("- 1\n", 0, NULL));
    EXPECT(has_mistake(1, 1, "the file is a list; a mapping (key: value) is expected"));
    mistakes_clear(&mistakes);
    EXPECT(!job_read(&job, folder, 0, NULL, &mistakes));
    EXPECT(has_mistake(1, 1, "is a directory; a YAML file is expected"));
    mistakes_clear(&mistakes);
    EXPECT(!job_read(&job, "nowhere/job.yaml", 0, NULL, &mistakes));
    EXPECT(has_mistake(
        1, 1, "cannot be opened: No such file or directory; a readable file is expected"));
    mistakes_clear(&mistakes);
    EXPECT(!job_read(&job, "/dev/zero", 0, NULL, &mistakes));
    EXPECT(has_mistake(1, 1, "is not a regular file; a YAML file is expected"));
    char *large = array_allocate(10000001, 1);
    memset(large, 'x', 10000000);
    EXPECT(!job_from(large, 0, NULL));
    EXPECT(has_mistake(1, 1,
                       "has 10000000 bytes; at most 4194304 (4 MiB) are expected (many spheres "
                       "belong in a CSV file)"));
    free(large);
}

TEST(mistakes_are_cut_off_at_some_number)
{
    char *many = array_allocate(400000, 1);
    for (int i = 0; i < 10000; i++)
        sprintf(many + strlen(many), "key%d: [0]\n", i);
    EXPECT(!job_from(many, 0, NULL));
    EXPECT(mistakes.n == SCHEMA_MISTAKES + 1);
    free(many);
}

TEST(what_does_not_fit_together)
{
    EXPECT_ONE(
        BODY("kind: box, min: [0, 0, 0], max: [1, 0, 1]"), 6, 81,
        "bodies.0.geometry.max is not above min in x, y and z; a greater corner is expected");
    EXPECT_ONE(BODY("kind: hopper, top: [6, 6], outlet: [1, 1], z: [6, 3]"), 6, 95,
               "bodies.0.geometry.z does not ascend; the outlet's height and a greater one are "
               "expected");
    EXPECT_ONE(
        BODY("kind: mesh, vertices: [[0, 0, 0], [1, 0, 0], [2, 0, 0]], facets: [[0, 1, 2]]"), 6,
        115,
        "bodies.0.geometry.facets.0 has no area; 3 or 4 different vertices from 0 to 2 that "
        "span an area are expected");
    EXPECT_ONE(
        BODY("kind: mesh, vertices: [[0, 0, 0], [1, 0, 0], [2, 1, 0]], facets: [[0, 1, 3]]"), 6,
        115,
        "bodies.0.geometry.facets.0 names a vertex that is not there; 3 or 4 different "
        "vertices "
        "from 0 to 2 that span an area are expected");
    EXPECT_ONE(
        BODY("kind: plane, point: [0, 0, 0], normal: [0, 0, 0], extent: 1"), 6, 88,
        "bodies.0.geometry.normal is a list without a usable length; a direction, a list of 3 "
        "numbers that are not all 0, is expected");
    EXPECT_ONE(
        BODY("kind: plane, point: [0, 0, 0], normal: [0, 0, 1], extent: 1, z: [1, 2]"), 6, 110,
        "bodies.0.geometry.z does not go with kind plane; a key of that kind is expected");
    EXPECT_ONE("domain: {min: [0, 0, 0]}\n", 6, 9,
               "domain.max is missing; both corners, or none, are expected");
    EXPECT_ONE("sections:\n- {name: a, point: [0, 0, 0], normal: [0, 0, 1]}\n"
               "- {name: a, point: [0, 0, 0], normal: [0, 0, 1]}\n",
               8, 10,
               "sections.1.name is 'a' like that of sections.0; a name of its own is expected");
}

TEST(steps_lattices_and_pairs)
{
    const struct job_override step = {"time.step=1.1e-5"},
                              spacing = {"spheres.0.packing.spacing=0.19"};
    const struct job_override pairs = {"contact.pairs=[]"},
                              size = {"spheres.0.packing.size=[0.1, 1]"};
    EXPECT(!job_from(START SPHERES, 1, &step));
    EXPECT(
        has_mistake(1, 13,
                    "time.end is 1.5 s, which is not a whole number of steps of 1.1e-05 s; a "
                    "multiple is expected"));
    EXPECT(!job_from(START SPHERES, 1, &spacing));
    EXPECT(has_mistake(1, 27,
                       "spheres.0.packing.spacing makes spheres overlap; at least two of the "
                       "greatest radii, 0.2 m, are expected"));
    EXPECT(!job_from(START SPHERES, 1, &size));
    EXPECT(has_mistake(1, 24,
                       "spheres.0.packing.size is narrower than a sphere; at least two radii, "
                       "0.2 m, are expected"));
    EXPECT(!job_from(START SPHERES, 1, &pairs));
    EXPECT(has_mistake(1, 15,
                       "contact.pairs say nothing about ore and ore, which can meet; {between: "
                       "[ore, ore], friction: ..., restitution: ...} is expected"));
}

TEST(overrides)
{
    const struct job_override good[] = {
        {"spheres.0.radius=90 mm"}, {"title=A: \"b\""}, {"time={end: 2}"}};
    EXPECT(!job_from(START SPHERES, 2, good));
    EXPECT(has_mistake(1, 7, "title is a mapping; a text is expected"));
    EXPECT(job_from(START SPHERES, 1, good));
    EXPECT(job.spheres[0].radius == 0.09);
    EXPECT(job_from(START SPHERES, 1, &good[2]));
    EXPECT(job.time.end == 2.0 && job.time.step == 0.0);
    const struct job_override bad[] = {
        {"spheres.1.radius=1"}, {"time.end"}, {"tiem.end=3"}, {"time.end=3 kg"}};
    EXPECT(!job_from(START SPHERES, 4, bad));
    EXPECT(has_mistake(
        1, 1,
        "'spheres.1.radius' leads nowhere; a path like spheres.0.radius is expected "
        "(lists count from 0)"));
    EXPECT(has_mistake(1, 1,
                       "'time.end' is not key=value; for instance time.end=0.5 is expected"));
    EXPECT(has_mistake(1, 1, "unknown key tiem; 'time' is expected"));
    EXPECT(has_mistake(1, 10, "time.end: '3 kg' is a mass; a time like 10 us is expected"));
}

#define LIBRARY                                                                                \
    "materials:\n"                                                                             \
    "  wood: {density: 600, young: 1e10, poisson: 0.3}\n"                                      \
    "  steel: {density: 7850, young: 2.1e11, poisson: 0.3}\n"                                  \
    "contact:\n"                                                                               \
    "  pairs:\n"                                                                               \
    "    - {between: [steel, steel], friction: 0.2, restitution: 0.6}\n"                       \
    "    - {between: [steel, wood], friction: 0.3, restitution: 0.4}\n"

TEST(what_the_job_says_wins_over_libraries)
{
    file_write("library.yaml", LIBRARY);
    EXPECT(job_from(
        "include: library.yaml\n"
        "time: {end: 1}\n"
        "materials: {steel: {young: 1e9}}\n"
        "contact: {pairs: [{between: [wood, steel], friction: 0.7, restitution: 0.8}]}\n"
        "spheres:\n"
        "  - {name: a, material: steel, radius: 1, packing: {kind: lattice, count: 1,"
        " spacing: 2, corner: [0, 0, 0], size: [2, 2]}}\n"
        "bodies: [{name: b, material: wood, geometry: {kind: plane, point: [0, 0, 0],"
        " normal: [0, 0, 1], extent: 1}}]\n",
        0, NULL));
    EXPECT(job.n_materials == 2 && job.materials[0].young == 1e9 &&
           job.materials[0].density == 7850.0);
    EXPECT_STRING(job.materials[1].name, "wood");
    EXPECT(job.n_pairs == 2 && job.pairs[0].friction == 0.2 && job.pairs[1].friction == 0.7);
    EXPECT(job.pairs[1].a == 0 && job.pairs[1].b == 1);
}

TEST(unused_materials_are_left_out)
{
    file_write("library.yaml", LIBRARY);
    EXPECT(job_from("include: [library.yaml]\n" START SPHERES, 0, NULL));
    EXPECT(job.n_materials == 1 && job.n_pairs == 1 && job.spheres[0].material == 0);
}

TEST(mistakes_in_libraries)
{
    file_write("library.yaml",
               "time: {end: 1}\nmaterials: {x: {density: 1, young: 0, poisson: 0}}\n");
    EXPECT(!job_from("include: [library.yaml, nowhere.yaml]\n" START SPHERES, 0, NULL));
    EXPECT(
        has_mistake(1, 1,
                    "'time' does not belong in a library; materials and contact: {pairs: ...} "
                    "are expected"));
    EXPECT(has_mistake(2, 36,
                       "materials.x.young is '0'; a pressure above 0 and at most 1e+15 Pa is "
                       "expected"));
    EXPECT(mistakes.n == 3);
}

TEST(csv_files)
{
    const struct job_override csv[] = {{"spheres.0.packing={kind: csv, file: SCRATCH}"}};
    char text[300];
    EXPECT(!job_from(START SPHERES, 1, csv));
    EXPECT(mistakes.n == 1);
    file_write("spheres.csv", "x_m,y_m,z_m,material\n0,0,0,ore\n0,0,1,tin\n");
    snprintf(text, sizeof text, "spheres.0.packing={kind: csv, file: %s/spheres.csv}", folder);
    const struct job_override given[] = {{text}};
    EXPECT(!job_from(START SPHERES, 1, given));
    EXPECT(has_mistake(3, 1,
                       "there is no such material as in column 4; one of the job is expected"));
    file_write("spheres.csv", "x_m,y_m,z_m\n0,0,0\n");
    EXPECT(job_from(START SPHERES, 1, given));
    EXPECT(job.spheres[0].file != NULL && job.spheres[0].file[0] == '/');
    EXPECT(!job_from(
        "time: {end: 1}\nmaterials: {}\nspheres: [{name: a, material: b, packing: {kind: "
        "csv, file: spheres.csv}}]\n",
        0, NULL));
    EXPECT(
        has_mistake(3, 31,
                    "spheres.0.material: there is no material 'b'; the name of a material is "
                    "expected"));
}

/* Writes, reads and writes again. */
static bool is_stable(void)
{
    struct job again;
    char *first = job_write(&job);
    mistakes_clear(&mistakes);
    bool same = job_read_text(&again, job.path, first, &mistakes);
    if (same) {
        char *second = job_write(&again), *difference = job_difference(first, second);
        same = strcmp(first, second) == 0 && difference == NULL &&
               strcmp(again.name, job.name) == 0;
        free(second);
        free(difference);
        job_clear(&again);
    }
    free(first);
    return same;
}

static const char everything[] =

    "title: \"a \\\"quoted\\\" \\\\ title\\twith \xc3\xa9 and # more\"\n" START
    "gravity: [1.1, 0.30000000000000004, -9.806650000000001]\n"
    "damping: 1e-300\n"
    "spheres:\n"
    "  - {name: true, material: ore, radius: 33 mm, velocity: [1, 2, 3], spin: [0, 100 rpm, 0],"
    " packing: {kind: lattice, count: 1, spacing: 1, corner: [0, 0, 0], size: [1, 1]}}\n"
    "bodies:\n"
    "  - {name: a, material: ore, geometry: {kind: plane, point: [0, 0, 0.1], normal: [1, 2, "
    "3],"
    " extent: 2}, motion: {rotation: {point: [0.1, 0.2, 0.3], axis: [1, 1, 1], rate: 33 rpm}, "
    "stop: 1}}\n"
    "  - {name: b, material: ore, geometry: {kind: box, min: [0, 0, 0], max: [1, 1, 1], open: "
    "top}}\n"
    "  - {name: c, material: ore, geometry: {kind: hopper, top: [6, 6], outlet: [1, 2], z: [3, "
    "6]}}\n"
    "  - {name: d, material: ore, geometry: {kind: mesh, vertices: [[0, 0, 0], [1, 0, 0], [1, "
    "1, 0],"
    " [0, 0.1, 1e-17]], facets: [[0, 1, 2], [0, 1, 2, 3]]}}\n"
    "  - {name: e, material: ore, geometry: {kind: cylinder, from: [0, 0, 0], to: [0, 1, 0], "
    "radius: 1},"
    " surface: {velocity: [0, 1 mm/s, 0], rotation: {point: [0.1, 0.2, 0.3], axis: [1, 1, 1], "
    "rate: 33 rpm}, stop: 1}}\n"
    "sections: [{name: s, point: [0, 0, 0.7], normal: [1, 1, 0]},"
    " {name: t, kind: disc, point: [0, 0, 0.7], normal: [1, 1, 0], radius: 0.1, by: [size]},"
    " {name: u, kind: rectangle, point: [0, 0, 0.7], normal: [1, 1, 0], across: [0, 0, 3],"
    " size: [1, 2], by: [material, size], classes: [0.1, 0.30000000000000004]}]\n"
    "insert:\n"
    "  - {name: feed, mix: [{material: ore, share: 0.1}], radius: 1 cm, velocity: [1, 0, 0],"
    " region: {kind: cylinder, from: [0, 0, 0], to: [0, 0, 1], radius: 3}, rate: {mass: 2},"
    " start: 0.1, until: {mass: 100, time: 1}, every: 10, when_full: stop, by: material}\n"
    "  - {name: dust, material: ore, sizes: {kind: list, by: mass, radii: [{radius: 1 mm, "
    "share: 1}, {radius: 3 mm, share: 2}]}, region: {kind: inside, body: b}, rate: {number: "
    "5}, until: {count: 3}}\n"
    "remove: [{name: out, region: {kind: box, min: [0, 0, 0], max: [1, 1, 1]}, stop: 2}]\n"
    "contents: [{name: in, region: {kind: sphere, centre: [0, 0, 1], radius: 2}}]\n"
    "domain: {min: [-1, -1, -1], max: [9, 9, 9], leavers: remove}\n"
    "decomposition: {buffer: 1 cm, weights: candidates, grid: [2, 1, 3]}\n"
    "testing: {search: all-pairs, search_every: 7}\n";

TEST(what_is_written_reads_back_equal)
{
    EXPECT(job_from(START SPHERES, 0, NULL));
    EXPECT(is_stable());
    EXPECT(job_from(everything, 0, NULL));
    EXPECT(job.damping == 1e-300 && job.decomposition.fixed[2] == 3 &&
           job.force.search_every == 7);
    EXPECT(job.n_insertions == 2 && job.insertions[0].until_mass == 100.0);
    EXPECT(job.insertions[1].until_count == 3 && job.insertions[1].sizes.n == 2);
    EXPECT(is_stable());
}

TEST(size_classes_lie_between_the_radii_that_are_named)
{
    EXPECT(job_from(everything, 0, NULL));
    const struct job_section *auto_classes = &job.sections[1];
    /* 1 mm, 3 mm, 1 cm and 33 mm */
    EXPECT(job.sections[0].n_classes == 0 && auto_classes->n_classes == 3);
    EXPECT_NEAR(auto_classes->classes[0], 0.002, 1e-15);
    EXPECT_NEAR(auto_classes->classes[1], 0.0065, 1e-15);
    EXPECT_NEAR(auto_classes->classes[2], 0.0215, 1e-15);
    EXPECT(job.sections[2].n_classes == 2 && job.sections[2].classes[1] == 0.1 + 0.2);
}

/* A distribution between two radii has eight classes, a curve those of its radii; a radius
 * beyond has its own. */
#define DISTRIBUTED(sizes, more)                                                               \
    START "spheres:\n  - {name: s, material: ore, sizes: " sizes ", packing: {kind: random, "  \
          "count: 5, region: {kind: box, min: [0, 0, 0], max: [9, 9, 9]}}}\n" more             \
          "sections: [{name: t, point: [0, 0, 0.7], normal: [1, 1, 0], by: size}]\n"

TEST(size_classes_divide_distributions)
{
    static const char single[] = "  - {name: big, material: ore, radius: 1, packing: {kind: "
                                 "lattice, count: 1, spacing: 2, corner: [0, 0, 0], size: "
                                 "[2, 2]}}\n";
    EXPECT(job_from(DISTRIBUTED("{kind: uniform, min: 0.01, max: 0.16}", ""), 0, NULL));
    EXPECT(job.sections[0].n_classes == 7);
    for (int k = 0; k < 7; k++)
        EXPECT_NEAR(job.sections[0].classes[k], 0.01 * pow(16.0, (k + 1) / 8.0), 1e-15);
    EXPECT(is_stable());
    char text[4096];
    snprintf(text, sizeof text,
             DISTRIBUTED("{kind: table, radii: [{radius: 0.1, share: 0}, {radius: 0.2, share: "
                         "0.5}, {radius: 0.3, share: 1}]}",
                         "%s"),
             single);
    EXPECT(job_from(text, 0, NULL));
    EXPECT(job.sections[0].n_classes == 2);
    EXPECT(job.sections[0].classes[0] == 0.2 && job.sections[0].classes[1] == 0.3);
}

TEST(jobs_and_library_of_the_project)
{
    static const char *const paths[] = {"jobs/hopper.yaml", "jobs/hopper_empty.yaml"};
    for (int i = 0; i < 2; i++) {
        job_clear(&job);
        mistakes_clear(&mistakes);
        EXPECT(job_read(&job, paths[i], 0, NULL, &mistakes));
        EXPECT(job.spheres != NULL && job.spheres[0].count == 8768);
        EXPECT(is_stable());
    }
}

TEST(differences_that_matter_on_a_resume)
{
    const struct job_override other[] = {{"time.end=3"},
                                         {"title=other"},
                                         {"decomposition.buffer=0.3"},
                                         {"checkpoint.keep=9"},
                                         {"output.series.every=1"},
                                         {"watch.motion=0.5"},
                                         {"testing.search_every=3"},
                                         {"contact.pairs.0.friction=0.6"}};
    EXPECT(job_from(START SPHERES, 0, NULL));
    char *was = job_write(&job);
    EXPECT(job_from(START SPHERES, 7, other));
    char *now = job_write(&job);
    EXPECT(job_difference(was, now) == NULL);
    free(now);
    EXPECT(job_from(START SPHERES, 8, other));
    now = job_write(&job);
    char *difference = job_difference(was, now);
    EXPECT_STRING(difference, "contact.pairs.0.friction: was 0.5, now 0.6");
    free(difference);
    free(now);
    EXPECT(job_from(START SPHERES "domain: {min: [0, 0, 0], max: [1, 1, 1]}\n", 0, NULL));
    now = job_write(&job);
    difference = job_difference(was, now);
    EXPECT_STRING(difference, "domain.min: was not given, now a list of 3");
    free(difference);
    free(now);
    free(was);
}

/* Every key has a meaning, and a name of its own in its table. */
static bool is_described(const struct schema_key *table)
{
    for (const struct schema_key *key = table; key->name != NULL; key++) {
        if (key->help == NULL || key->help[0] == '\0')
            return false;
        for (const struct schema_key *other = table; other != key; other++)
            if (strcmp(other->name, key->name) == 0)
                return false;
        if (key->inside != NULL && !is_described(key->inside))
            return false;
    }
    return true;
}

TEST(every_key_has_a_meaning)
{
    EXPECT(is_described(job_keys));
}

TEST(the_reference_page_is_the_one_in_jobs)
{
    char *page = job_reference_page();
    char *file = array_allocate(1 << 20, 1);
    FILE *in = fopen("jobs/README.md", "r");
    EXPECT(in != NULL);
    if (in != NULL) {
        EXPECT(fread(file, 1, (1 << 20) - 1, in) > 0);
        fclose(in);
    }
    EXPECT(strcmp(page, file) == 0); /* else: bin/tremie reference > jobs/README.md */
    free(page);
    free(file);
}

int main(int argc, char **argv)
{
    const int status = check_run(argc, argv);
    job_clear(&job);
    mistakes_clear(&mistakes);
    return status;
}
