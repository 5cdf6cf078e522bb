/* See solid_survey.h. */
#include "run/solid_survey.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "job/schema.h"
#include "model/gmsh.h"
#include "model/sheet_shape.h"
#include "model/solid_mesh.h"
#include "model/solid_quality.h"
#include "model/solid_shape.h"
#include "physics/critical_step.h"
#include "run/solid_step.h"
#include "solid/solid_plan.h"

enum { PATH = 96, TEXT = 160 };

/* ------------------------------------------------------------------------------- mistakes */

struct survey {
    const struct job *job;
    const struct job_body *body;
    const struct solid_mesh *mesh;
    int b;
    struct mistakes *mistakes;
};

/* Names of all sets, or of the file's physical volumes, in one line. */
static void list_names(char *text, size_t size, const char *const *names, int n)
{
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; k < n && used < size; k++)
        used += (size_t)snprintf(text + used, size - used, "%s%s", k > 0 ? ", " : "", names[k]);
}

/* Is the physical volume that the body names in its file? */
static bool group_is_there(const struct job_body *body, struct mistakes *mistakes)
{
    const struct job_volume *volume = &body->solid.volume;
    const char **names = array_allocate((size_t)volume->n_groups, sizeof *names);
    char all[TEXT];
    bool there = body->group == NULL;
    int n = 0;
    for (int g = 0; g < volume->n_groups; g++) {
        if (volume->groups[g].dimension != 3)
            continue;
        names[n++] = volume->groups[g].name;
        there = there || strcmp(names[n - 1], body->group) == 0;
    }
    list_names(all, sizeof all, names, n);
    if (!there)
        mistakes_add(mistakes, body->file, 0, 0,
                     "there is no physical volume '%s'; %s%s is expected", body->group,
                     n > 0 ? "one of " : "a file that has some", all);
    free(names);
    return there;
}

/* Lists at an item of the body. */
#define FIND(survey, place, ...)                                                               \
    mistakes_add((survey)->mistakes, (survey)->job->path, (place).line, (place).column,        \
                 __VA_ARGS__)

static void check_sets(const struct survey *survey)
{
    const struct job_solid *solid = &survey->body->solid;
    const int n_own = survey->mesh->n_sets - solid->n_sets;
    for (int k = 0; k < solid->n_sets; k++) {
        const struct job_set *set = &solid->sets[k];
        for (int j = 0; j < n_own; j++)
            if (strcmp(survey->mesh->sets[j].name, set->name) == 0)
                FIND(survey, set->place,
                     "bodies.%d.sets.%d.name is '%s', which the mesh has; another name is "
                     "expected",
                     survey->b, k, set->name);
        if (survey->mesh->sets[n_own + k].n_nodes == 0)
            FIND(survey, set->place,
                 "bodies.%d.sets.%d.region holds no node of body '%s'; one that does is "
                 "expected",
                 survey->b, k, survey->body->name);
    }
}

/* There is no such set: which are there?  `path` is the key's. */
static void refuse_set(const struct survey *survey, const char *path, const char *name,
                       struct job_place place)
{
    const struct solid_mesh *mesh = survey->mesh;
    const char **names = array_allocate((size_t)mesh->n_sets, sizeof *names);
    char all[TEXT];
    for (int j = 0; j < mesh->n_sets; j++)
        names[j] = mesh->sets[j].name;
    const char *near = schema_suggestion(name, names, mesh->n_sets);
    list_names(all, sizeof all, names, mesh->n_sets);
    FIND(survey, place, "%s: there is no set '%s'; %s%s is expected", path, name,
         near != NULL ? "" : "one of ", near != NULL ? near : all);
    free(names);
}

/* A set that is there must hold what is asked of it. */
static void check_set(const struct survey *survey, int k, const struct solid_mesh_set *set)
{
    const struct job_boundary *asked = &survey->body->solid.boundary[k];
    const bool presses = asked->has_pressure || asked->n_pressures > 0;
    if (set->n_nodes == 0)
        FIND(survey, asked->place,
             "bodies.%d.boundary.%d.set: set '%s' has no nodes; some are "
             "expected",
             survey->b, k, set->name);
    else if (presses && set->n_sides == 0)
        FIND(survey, asked->place,
             "bodies.%d.boundary.%d.set: set '%s' has no sides on the surface that a pressure "
             "could act on; some are expected",
             survey->b, k, set->name);
    else if (presses && set->n_strays > 0)
        FIND(survey, asked->place,
             "bodies.%d.boundary.%d.set: %d facets of set '%s' are no sides of elements on the "
             "surface; a pressure on the surface is expected",
             survey->b, k, set->n_strays, set->name);
}

/* Directions in which an item prescribes motion, a set of enum job_direction. */
static int directions_of(const struct job_boundary *asked)
{
    const bool moves =
        asked->n_displacements > 0 || asked->has_velocity || asked->n_velocities > 0;
    return asked->n_motions > 0 ? 7 : moves ? 1 << asked->direction : asked->fixed;
}

/* A node may be held twice but not moved in two ways. */
static void check_conflicts(const struct survey *survey)
{
    const struct solid_mesh *mesh = survey->mesh;
    const struct job_solid *solid = &survey->body->solid;
    int(*holders)[3] = array_allocate((size_t)mesh->n_nodes, sizeof *holders); /* item + 1 */
    for (int k = 0; k < solid->n_boundary; k++) {
        const struct job_boundary *asked = &solid->boundary[k];
        const struct solid_mesh_set *set = solid_mesh_find(mesh, asked->set);
        const int directions = directions_of(asked);
        bool told = false;
        for (int j = 0; set != NULL && j < set->n_nodes; j++) {
            for (int d = 0; d < 3; d++) {
                int *holder = &holders[set->nodes[j]][d];
                if ((directions & 1 << d) == 0)
                    continue;
                const bool both_fixed =
                    *holder > 0 && asked->fixed != 0 && solid->boundary[*holder - 1].fixed != 0;
                if (*holder > 0 && !both_fixed && !told)
                    FIND(survey, asked->place,
                         "bodies.%d.boundary.%d moves node %lld along %c, which "
                         "bodies.%d.boundary.%d does too; one of them is expected",
                         survey->b, k, solid_quality_node_number(mesh, set->nodes[j]), "xyz"[d],
                         survey -> b, *holder - 1);
                told = told || (*holder > 0 && !both_fixed);
                *holder = k + 1;
            }
        }
    }
    free(holders);
}

/* A probe's set must be there and hold what the probe follows. */
static void check_probe(const struct survey *survey, int k)
{
    const struct job_probe *probe = &survey->job->output.probes[k];
    const char *name = probe->nodes != NULL ? probe->nodes : probe->elements;
    char path[PATH];
    if (name == NULL || strcmp(probe->body, survey->body->name) != 0)
        return;
    const struct solid_mesh_set *set = solid_mesh_find(survey->mesh, name);
    snprintf(path, sizeof path, "output.probes.%d.%s", k,
             probe->nodes != NULL ? "nodes" : "elements");
    if (set == NULL)
        refuse_set(survey, path, name, probe->place);
    else if ((probe->nodes != NULL ? set->n_nodes : set->n_elements) == 0)
        FIND(survey, probe->place, "%s: set '%s' has none; some are expected", path, name);
}

/* The set that item k of a list of the body names: it has some of these. */
static void check_named(const struct survey *survey, const char *list, int k, const char *name,
                        struct job_place place, bool nodes)
{
    const struct solid_mesh_set *set = solid_mesh_find(survey->mesh, name);
    char path[PATH];
    snprintf(path, sizeof path, "bodies.%d.%s.%d.set", survey->b, list, k);
    if (set == NULL)
        refuse_set(survey, path, name, place);
    else if ((nodes ? set->n_nodes : set->n_elements) == 0)
        FIND(survey, place, "%s: set '%s' has no %s; some are expected", path, set->name,
             nodes ? "nodes" : "elements");
}

static void check_shell(const struct survey *survey, int k)
{
    const struct job_shell *asked = &survey->body->solid.shells[k];
    const struct solid_mesh_set *set = solid_mesh_find(survey->mesh, asked->set);
    char path[PATH];
    snprintf(path, sizeof path, "bodies.%d.shells.%d.set", survey->b, k);
    if (set == NULL)
        refuse_set(survey, path, asked->set, asked->place);
    else if (set->n_sides + set->n_strays == 0)
        FIND(survey, asked->place,
             "%s: set '%s' has no sides on the surface that a shell could lie on; some are "
             "expected",
             path, set->name);
}

static void check_body(struct job *job, int b, struct mistakes *mistakes)
{
    struct job_body *body = &job->bodies[b];
    const struct job_solid *solid = &body->solid;
    const bool is_solid = body->model == JOB_MODEL_SOLID;
    const bool file = is_solid && solid->kind == JOB_MESH_GMSH;
    const struct job_place nowhere = {0, 0};
    const double n_elements = file       ? 0.0
                              : is_solid ? solid_shape_n_elements(body)
                                         : sheet_shape_n_elements(body);
    if (file && !group_is_there(body, mistakes))
        return;
    if (n_elements > (double)GMSH_ELEMENTS_MOST) {
        mistakes_add(mistakes, job->path, body->place.line, body->place.column,
                     "bodies.%d.%s makes %.3g elements; at most %d are expected", b,
                     is_solid ? "mesh" : "cell", n_elements, GMSH_ELEMENTS_MOST);
        return;
    }
    const struct solid_mesh *mesh = solid_mesh_keep(body);
    const struct survey survey = {job, body, mesh, b, mistakes};
    solid_quality_check(mesh, body->name, file ? body->file : job->path,
                        file ? nowhere : body->place, mistakes);
    check_sets(&survey);
    for (int k = 0; k < solid->n_boundary; k++) {
        const struct job_boundary *asked = &solid->boundary[k];
        const struct solid_mesh_set *set = solid_mesh_find(mesh, asked->set);
        char path[PATH];
        snprintf(path, sizeof path, "bodies.%d.boundary.%d.set", b, k);
        if (set == NULL)
            refuse_set(&survey, path, asked->set, asked->place);
        else
            check_set(&survey, k, set);
    }
    for (int k = 0; k < solid->n_shells; k++)
        check_shell(&survey, k);
    for (int k = 0; k < solid->n_thicknesses; k++)
        check_named(&survey, "thicknesses", k, solid->thicknesses[k].set,
                    solid->thicknesses[k].place, false);
    for (int k = 0; k < solid->n_masses; k++)
        check_named(&survey, "masses", k, solid->masses[k].set, solid->masses[k].place, true);
    for (int k = 0; k < job->output.n_probes; k++)
        check_probe(&survey, k);
    check_conflicts(&survey);
}

void solid_survey_check(struct job *job, struct mistakes *mistakes)
{
    for (int b = 0; b < job->n_bodies; b++)
        if (job_deforms(&job->bodies[b]))
            check_body(job, b, mistakes);
}

/* ------------------------------------------------------------------------ tremie check */

/* Speed of waves of compression in a large solid [m/s]. */
static double wave_speed(const struct job_material *material)
{
    const double nu = material->poisson;
    return sqrt(material->young * (1.0 - nu) /
                (material->density * (1.0 + nu) * (1.0 - 2.0 * nu)));
}

/* "element 12 at (0.1, 0.2, 0.3) m" */
static const char *element_name(const struct solid_mesh *mesh, int e, char text[TEXT])
{
    const struct vec3 x = solid_quality_centre(mesh, e);
    snprintf(text, TEXT, "element %lld at (%.4g, %.4g, %.4g) m",
             solid_quality_element_number(mesh, e), x.x, x.y, x.z);
    return text;
}

static void print_sets(const struct solid_mesh *mesh)
{
    for (int k = 0; k < mesh->n_sets; k++) {
        const struct solid_mesh_set *set = &mesh->sets[k];
        report_say("          set %s: %d nodes, %d sides, %d elements", set->name, set->n_nodes,
                   set->n_sides, set->n_elements);
    }
}

/* Who is stopped by flowing becomes narrower, and then allows less. */
static void print_flow(const struct job *job, const struct job_body *body)
{
    static const double MUCH = 0.05; /* strain */
    const double flow = solid_step_flow(job, body);
    if (flow > MUCH)
        report_say("          brought to rest it would flow by about %.3g in the mean, and by "
                   "more where it strikes: elements become narrower and allow less, which auto "
                   "foresees",
                   flow);
}

/* What elements allow of the step by themselves, and with the contacts that may be expected. */
static void print_step(const struct job *job, const struct solid_mesh *mesh, int b,
                       const struct bodies *bodies, const struct materials *materials,
                       const struct limits_spheres *spheres)
{
    const struct job_body *body = &job->bodies[b];
    const struct solid_step alone = solid_step_alone(job, b);
    const struct solid_step met = solid_step_with_contacts(job, bodies, materials, spheres, b);
    const double step = job->time.step;
    char name[TEXT];
    report_say("          waves run at %.4g m/s, fastest through %s: critical step %.4g s "
               "without contacts, the step is %.3g of it",
               wave_speed(&job->materials[body->material]),
               element_name(mesh, alone.element, name), alone.step, step / alone.step);
    if (met.node < 0)
        return;
    report_say("          with contacts of %s%s%s, most on node %lld of %s: about %.3g s, the "
               "step is %.3g of it",
               met.of_spheres ? "spheres" : "", met.of_spheres && met.of_bodies ? " and " : "",
               met.of_bodies ? "bodies" : "", solid_quality_node_number(mesh, met.node),
               element_name(mesh, met.element, name), met.step, step / met.step);
}

/* "64 hexahedra, 12 quads" */
static void list_kinds(const struct solid_quality *q, char text[TEXT])
{
    const struct {
        int n;
        const char *name;
    } kinds[] = {{q->n_hexahedra, "hexahedra"},
                 {q->n_tetrahedra, "tetrahedra"},
                 {q->n_quads, "quads"},
                 {q->n_triangles, "triangles"}};
    size_t used = 0;
    text[0] = '\0';
    for (int k = 0; k < 4; k++)
        if (kinds[k].n > 0)
            used += (size_t)snprintf(text + used, TEXT - used, "%s%d %s", used > 0 ? ", " : "",
                                     kinds[k].n, kinds[k].name);
}

static double mass_of(const struct job *job, const struct job_body *body,
                      const struct solid_mesh *mesh)
{
    double mass = 0.0;
    for (int e = 0; e < mesh->n_elements; e++)
        mass += solid_quality_volume(mesh, e) *
                job->materials[solid_mesh_material(mesh, e, body->material)].density;
    for (int k = 0; k < body->solid.n_masses; k++)
        mass += body->solid.masses[k].mass;
    return mass;
}

void solid_survey_print(const struct job *job, const struct bodies *bodies,
                        const struct materials *materials, const struct limits_spheres *spheres,
                        int b)
{
    const struct job_body *body = &job->bodies[b];
    const struct job_material *material = &job->materials[body->material];
    struct solid_mesh own;
    char aspect[TEXT], jacobian[TEXT];
    const struct solid_mesh *mesh = solid_mesh_borrow(body, &own);
    const struct solid_quality q = solid_quality_of(mesh);
    char kinds[TEXT];
    list_kinds(&q, kinds);
    report_say("body      %s: %s, %s, %s, %d nodes, mass %.6g kg", body->name,
               body->model == JOB_MODEL_SOLID   ? "solid"
               : body->model == JOB_MODEL_SHELL ? "shell"
                                                : "membrane",
               material->name, kinds, mesh->n_nodes, mass_of(job, body, mesh));
    report_say("          x %.4g .. %.4g, y %.4g .. %.4g, z %.4g .. %.4g m", q.low.x, q.high.x,
               q.low.y, q.high.y, q.low.z, q.high.z);
    report_say("          volume %.6g m3, surface %.4g m2 in %d sides", q.volume, q.area,
               q.n_sides);
    report_say("          longest over shortest edge up to %.3g, of %s", q.aspect,
               element_name(mesh, q.aspect_worst, aspect));
    report_say("          scaled Jacobian %.3g in the mean, least %.3g, of %s", q.jacobian_mean,
               q.jacobian_least, element_name(mesh, q.jacobian_worst, jacobian));
    if (q.warp > 0.0)
        report_say("          quads are warped by up to %.3g of their width, most %s", q.warp,
                   element_name(mesh, q.warp_worst, aspect));
    if (mesh->sheets != NULL)
        report_say("          %.4g to %.4g m thick", q.thickness_least, q.thickness_most);
    print_step(job, mesh, b, bodies, materials, spheres);
    print_flow(job, body);
    print_sets(mesh);
    solid_mesh_clear(&own);
}

/* As `make bench-elements` measures (tests/bench/README.md): forces, and nodes as they are
 * moved, of elements that do not stay in the cache. */
static const double SECONDS_A_HEXAHEDRON = 136e-9, SECONDS_A_TETRAHEDRON = 62e-9,
                    SECONDS_A_SHEET = 160e-9;
/* Most memory at any time of a million hexahedra and of 750 000 tetrahedra (there too), 720 and
 * 404 bytes an element, shared out to elements and nodes. */
enum { BYTES_AN_ELEMENT = 340, BYTES_A_NODE = 370 };

double solid_survey_seconds(enum solid_element_shape shape)
{
    return shape == SOLID_ELEMENT_HEXAHEDRON    ? SECONDS_A_HEXAHEDRON
           : shape == SOLID_ELEMENT_TETRAHEDRON ? SECONDS_A_TETRAHEDRON
                                                : SECONDS_A_SHEET;
}

struct solid_survey_cost solid_survey_cost_of(const struct job_body *body)
{
    struct solid_survey_cost cost = {0.0, 0.0, 0.0};
    struct solid_mesh own;
    if (!job_deforms(body))
        return cost;
    const struct solid_mesh *mesh = solid_mesh_borrow(body, &own);
    for (int e = 0; e < mesh->n_elements; e++)
        cost.seconds += solid_survey_seconds(solid_plan_shape(mesh, e));
    cost.n_elements = mesh->n_elements;
    cost.bytes =
        (double)mesh->n_elements * BYTES_AN_ELEMENT + (double)mesh->n_nodes * BYTES_A_NODE;
    solid_mesh_clear(&own);
    return cost;
}

struct solid_survey_cost solid_survey_cost(const struct job *job)
{
    struct solid_survey_cost all = {0.0, 0.0, 0.0};
    for (int b = 0; b < job->n_bodies; b++) {
        const struct solid_survey_cost cost = solid_survey_cost_of(&job->bodies[b]);
        all.n_elements += cost.n_elements;
        all.seconds += cost.seconds;
        all.bytes += cost.bytes;
    }
    return all;
}

/* Limits beyond which no usual material lies: probably other units. */
static void warn_of_material(const struct job *job, const struct job_body *body)
{
    static const double DENSITY[2] = {5.0, 25000.0}; /* [kg/m3] foam, osmium */
    static const double SPEED[2] = {1.0, 25000.0};   /* [m/s] jelly, diamond */
    const struct job_material *material = &job->materials[body->material];
    const double speed = wave_speed(material);
    if (!(material->density >= DENSITY[0] && material->density <= DENSITY[1]))
        report_warn("body '%s': %s has a density of %.3g kg/m3, as no solid has; is its unit "
                    "right?",
                    body->name, material->name, material->density);
    if (!(speed >= SPEED[0] && speed <= SPEED[1]))
        report_warn(
            "body '%s': waves would run at %.3g m/s in %s, as in no solid; are the units "
            "of density and young right?",
            body->name, speed, material->name);
    if (material->yield > 0.1 * material->young)
        report_warn("body '%s': %s yields at %.3g Pa, more than a tenth of young; are their "
                    "units right?",
                    body->name, material->name, material->yield);
}

/* A one-point hexahedron feels no bending: layers of them do. */
static void warn_of_layers(const struct job_body *body)
{
    enum { LAYERS = 3 };
    double cells[3];
    const struct job_solid *solid = &body->solid;
    if (body->model != JOB_MODEL_SOLID || solid->kind != JOB_MESH_PLATE ||
        solid->elements != JOB_ELEMENTS_HEXAHEDRA)
        return;
    solid_shape_cells(body, cells);
    if (cells[2] < LAYERS)
        report_warn("body '%s': %.0f cell%s through the thickness: hourglass control bears the "
                    "bending; %d or more are better",
                    body->name, cells[2], cells[2] == 1.0 ? "" : "s", LAYERS);
}

/* Thick, thin and warped sheets. */
static void warn_of_sheets(const struct job_body *body, const struct solid_mesh *mesh,
                           const struct solid_quality *q)
{
    static const double WARP = 0.1, THICK = 1.0; /* of the width of an element */
    static const double LIKELY[2] = {1e-5, 0.1}; /* of the body's size */
    const double size = vec3_norm(vec3_sub(q->high, q->low));
    char name[TEXT];
    if (mesh->sheets == NULL)
        return;
    if (!(q->thickness_least >= LIKELY[0] * size && q->thickness_most <= LIKELY[1] * size))
        report_warn(
            "body '%s': it is %.3g to %.3g m thick and %.3g m large; is the unit of its "
            "thickness right?",
            body->name, q->thickness_least, q->thickness_most, size);
    if (q->thick > THICK)
        report_warn("body '%s': %s is %.3g times as thick as wide; where sheets meet so thick "
                    "ones are in each other, and solids are better",
                    body->name, element_name(mesh, q->thick_worst, name), q->thick);
    if (q->warp > WARP)
        report_warn("body '%s': %s is warped by %.2g of its width; below %.1f is better, or "
                    "triangles",
                    body->name, element_name(mesh, q->warp_worst, name), q->warp, WARP);
}

/* Springs against hourglass modes hold what ought to flow. */
static void warn_of_flow(const struct job *job, const struct job_body *body)
{
    const struct job_material *material = &job->materials[body->material];
    const bool flows = material->yield > 0.0 || material->n_hardening_table > 0;
    if (flows && body->model == JOB_MODEL_SOLID &&
        body->solid.elements == JOB_ELEMENTS_HEXAHEDRA &&
        body->solid.hourglass.kind == JOB_HOURGLASS_STIFFNESS &&
        body->solid.hourglass.coefficient > 0.0)
        report_warn("body '%s': %s flows, and springs against hourglass modes do not: elements "
                    "are too stiff then; hourglass: {kind: viscous} is better",
                    body->name, material->name);
}

/* The step against what elements allow by themselves, or as their nodes touch. */
static void warn_of_step(const struct job *job, const struct bodies *bodies,
                         const struct solid_mesh *mesh, int b)
{
    const struct job_body *body = &job->bodies[b];
    const struct solid_step alone = solid_step_alone(job, b);
    const struct solid_step met = solid_step_touching(job, bodies, b);
    const double step = job->time.step;
    char name[TEXT];
    if (step > alone.step)
        report_warn("body '%s': time.step is %.3g of the critical step of %s; it would be "
                    "unstable",
                    body->name, step / alone.step, element_name(mesh, alone.element, name));
    else if (met.node >= 0 && step > job->watch.step * met.step)
        report_warn(
            "body '%s': time.step is about %.3g of what node %lld of %s allows as it "
            "touches bodies; the run stops there if it is too much. auto, or %.2g s, is "
            "safe",
            body->name, step / met.step, solid_quality_node_number(mesh, met.node),
            element_name(mesh, met.element, name),
            critical_step_round_down(solid_step_safe(job, bodies)));
}

void solid_survey_warn(const struct job *job, const struct bodies *bodies, int b)
{
    static const double JACOBIAN = 0.1, ASPECT = 20.0;
    const struct job_body *body = &job->bodies[b];
    struct solid_mesh own;
    char name[TEXT];
    const struct solid_mesh *mesh = solid_mesh_borrow(body, &own);
    const struct solid_quality q = solid_quality_of(mesh);
    warn_of_material(job, body);
    warn_of_layers(body);
    warn_of_flow(job, body);
    warn_of_step(job, bodies, mesh, b);
    warn_of_sheets(body, mesh, &q);
    if (q.jacobian_least < JACOBIAN)
        report_warn(
            "body '%s': %s is nearly folded or flat, its scaled Jacobian is %.2g; above "
            "%.1f is better",
            body->name, element_name(mesh, q.jacobian_worst, name), q.jacobian_least, JACOBIAN);
    if (q.aspect > ASPECT)
        report_warn(
            "body '%s': the edges of %s differ by a factor of %.3g; below %.0f is better",
            body->name, element_name(mesh, q.aspect_worst, name), q.aspect, ASPECT);
    if (q.n_parts > 1)
        report_warn("body '%s': its mesh falls into %d parts that have no node in common",
                    body->name, q.n_parts);
    solid_mesh_clear(&own);
}
