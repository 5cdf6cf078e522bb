/*
 * See advise.h.  A body is a wall, where its thickness is known and small beside the distance
 * between what holds it, and then its panels are taken for plates (physics/plate.h); or a block
 * that is pressed.  Of loads there are two: a bed that rests on it, and the hardest strike that
 * can be foreseen.  What a model neglects is told apart for them: of a strike the share of the
 * force or of the restitution, of a bed the share that would move on to what yields less.
 *
 * Drawbacks: a bed is taken to cover what its spheres cover at the start, so what narrows below
 * is not known; friction on walls bears nothing; a heap that is spread out presses less.
 */
#include "run/advise.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#include "base/array.h"
#include "base/report.h"
#include "job/job.h"
#include "model/body.h"
#include "model/geometry.h"
#include "model/gravity.h"
#include "model/material.h"
#include "model/packing.h"
#include "model/solid_mesh.h"
#include "physics/critical_step.h"
#include "physics/plate.h"
#include "physics/shell_element.h"
#include "run/limits.h"
#include "run/panels.h"
#include "run/solid_step.h"
#include "run/solid_survey.h"

static const double TOLERANCE = 0.05; /* of force, restitution or load: what may be neglected */
static const double PACKED = 0.6;     /* of a bed is solid [-] */
static const double SIDEWAYS = 0.5;   /* of the pressure above acts on upright walls [-] */
static const double THICK = 1.0 / 3.0; /* of the span: no plate any more */

enum { CLAMPED, HINGED, N_EDGES };
enum { STRIKE, BED, N_LOADS };
enum { N_MODELS = 4 };
enum { TEXT = 128 };
/* From the least to the most that is modelled. */
static const enum job_model ORDER[N_MODELS] = {JOB_MODEL_RIGID, JOB_MODEL_MEMBRANE,
                                               JOB_MODEL_SHELL, JOB_MODEL_SOLID};

static const char *name_of(enum job_model model)
{
    return model == JOB_MODEL_RIGID      ? "rigid"
           : model == JOB_MODEL_MEMBRANE ? "membrane"
           : model == JOB_MODEL_SHELL    ? "shell"
                                         : "solid";
}

/* A body and what it is made of. */
struct subject {
    const struct job *job;
    const struct job_body *body;
    const struct job_material *material;
    int b;
    bool is_wall, is_known; /* neither: nothing can be said */
    int n_panels;           /* of a wall */
    struct plate plate;     /* of a wall: the panel that yields most */
    double tilt;            /* of the pressure above that acts on it [-] */
    double area, volume;    /* of all its panels, of all of it [m2], [m3] */
    double length, section; /* of a block, along and across what presses it [m], [m2] */
};

/* What acts on it. */
struct load {
    struct limits_strike strike; /* a force of 0: none */
    double speed;                /* [m/s] */
    const struct material_pair *pair;
    double mass, cover; /* of the bed, and what it covers [kg], [m2] */
    double pressure;    /* under the bed [Pa] */
    double overlaps;    /* by how much it yields itself, all contacts above each other [m] */
};

/* How it yields and what models neglect. */
struct verdict {
    double deflection[N_LOADS][N_EDGES]; /* [m] */
    double zener, restitution, blow;     /* what of these is left of a strike [-] */
    double errors[N_MODELS][N_LOADS];    /* in the order of enum job_model */
    bool fits[N_MODELS];                 /* the model is one for such a body */
};

/* What a model costs. */
struct price {
    double n_elements, step, seconds; /* the last of the whole run [s] */
    double cell;                      /* width of an element [m] */
};

/* -------------------------------------------------------------------------------- loads */

/* Across gravity, the area of a box [m2]. */
static double plan_of(struct vec3 low, struct vec3 high, struct vec3 g)
{
    const struct vec3 s = vec3_sub(high, low);
    const double across = fabs(g.x) * s.y * s.z + fabs(g.y) * s.x * s.z + fabs(g.z) * s.x * s.y;
    return across / vec3_norm(g);
}

/* Contacts of a bed that is so deep, one above the other; the lower ones bear more: their
 * overlaps, as the load to the power of 2/3, are 3/5 of the lowest in the mean. */
static double bed_overlaps(const struct load *load, const struct materials *materials,
                           double depth)
{
    const struct limits_strike *strike = &load->strike;
    const double r = strike->radius, room = 4.0 * r * r;
    const double force = load->pressure * (room < load->cover ? room : load->cover);
    const struct material_pair *own =
        &materials->pairs[strike->material * materials->n + strike->material];
    const double wall = critical_step_rest_overlap(load->pair, force, 1.0 / r);
    const double layers = 0.5 * depth / r;
    const bool many = layers > 1.0 && own->normal > 0.0;
    return wall + (many ? 0.6 * layers * critical_step_rest_overlap(own, force, 2.0 / r) : 0.0);
}

static struct load load_of(const struct subject *subject, const struct materials *materials,
                           const struct limits_spheres *spheres,
                           const struct advise_cloud *cloud)
{
    const struct job *job = subject->job;
    const struct vec3 g = gravity_at(job, 0.0);
    const double most = gravity_most(job);
    struct load load = {
        .strike = limits_hardest_strike(spheres, job, materials, subject->body->material),
        .speed = spheres->speed,
        .mass = spheres->mass};
    if (!(load.strike.force > 0.0))
        return load;
    load.pair =
        &materials->pairs[load.strike.material * materials->n + subject->body->material];
    if (!(vec3_norm(g) > 0.0 && cloud->low.x < cloud->high.x))
        return load;
    const double density = job->materials[load.strike.material].density;
    load.cover = plan_of(cloud->low, cloud->high, g);
    load.pressure = load.mass * most / load.cover;
    load.overlaps = bed_overlaps(&load, materials, load.pressure / (PACKED * density * most));
    return load;
}

/* ----------------------------------------------------------------------------- subjects */

/* Places of nodes that are held or moved; the caller frees them. */
static int find_held(const struct job_body *body, const struct solid_mesh *mesh,
                     struct vec3 **held)
{
    int n = 0;
    bool *is_held = array_allocate((size_t)mesh->n_nodes, sizeof *is_held);
    for (int k = 0; k < body->solid.n_boundary; k++) {
        const struct job_boundary *asked = &body->solid.boundary[k];
        const struct solid_mesh_set *set = solid_mesh_find(mesh, asked->set);
        for (int j = 0; set != NULL && job_boundary_holds(asked) && j < set->n_nodes; j++)
            is_held[set->nodes[j]] = true;
    }
    *held = array_allocate((size_t)mesh->n_nodes, sizeof **held);
    for (int i = 0; i < mesh->n_nodes; i++)
        if (is_held[i])
            (*held)[n++] = mesh->nodes[i];
    free(is_held);
    return n;
}

/* The surface as facets, also of what is round or will be cut into elements. */
static void build_facets(struct mesh *mesh, const struct job_body *body)
{
    enum { SEGMENTS = 64 };
    struct job_body plain = *body;
    plain.model = JOB_MODEL_RIGID;
    plain.segments = body->segments > 0 ? body->segments : SEGMENTS;
    geometry_build_mesh(mesh, &plain);
}

static struct plate plate_of(const struct subject *subject, double thickness,
                             const struct panel *panel)
{
    const double ratio = panel->span * panel->span / panel->area;
    return (struct plate){.thickness = thickness,
                          .young = subject->material->young,
                          .poisson = subject->material->poisson,
                          .density = subject->material->density,
                          .span = panel->span,
                          .ratio = ratio < 1.0 ? ratio : 1.0,
                          .curvature = panel->curvature};
}

/* Takes over the panel if it yields more than the one before. */
static void take_panel(struct subject *subject, double thickness, const struct panel *panel)
{
    const struct vec3 g = gravity_at(subject->job, 0.0);
    const double along =
        vec3_norm(g) > 0.0 ? vec3_dot(panel->normal, g) / vec3_norm(g) : 1.0; /* cosine */
    const double tilt = along * along + SIDEWAYS * (1.0 - along * along);
    const struct plate plate = plate_of(subject, thickness, panel);
    const double yields = tilt * plate_under_pressure(&plate, 1.0, true).deflection,
                 before = subject->tilt *
                          plate_under_pressure(&subject->plate, 1.0, true).deflection;
    subject->area += panel->area;
    if (subject->n_panels++ > 0 && !(plate.span > 0.0 && yields > before))
        return;
    subject->plate = plate;
    subject->tilt = tilt;
}

/* A shell, a membrane, or what of a rigid body could be one. */
static void look_at_sheet(struct subject *subject)
{
    const struct job_body *body = subject->body;
    const double thickness = body->sheet.thickness;
    struct solid_mesh own;
    struct panels panels;
    struct mesh mesh;
    struct vec3 *held = NULL;
    int n_held = 0;
    build_facets(&mesh, body);
    if (job_deforms(body)) {
        n_held = find_held(body, solid_mesh_borrow(body, &own), &held);
        solid_mesh_clear(&own);
    }
    panels_find(&panels, &mesh, !job_deforms(body), n_held, held);
    for (int p = 0; p < panels.n; p++)
        take_panel(subject, thickness, &panels.list[p]);
    subject->volume = subject->area * thickness;
    panels_clear(&panels);
    mesh_clear(&mesh);
    free(held);
}

/* The least of what a solid measures, if it is one of the job's shapes [m]. */
static double thickness_of(const struct job_body *body, double volume, double area)
{
    const double scale = body->scale > 0.0 ? body->scale : 1.0;
    const struct vec3 size = vec3_sub(body->max, body->min);
    const double aside = size.x < size.y ? size.x : size.y;
    switch (body->solid.kind) {
    case JOB_MESH_PLATE:
        return scale * body->solid.thickness;
    case JOB_MESH_BOX:
        return scale * (size.z < aside ? size.z : aside);
    case JOB_MESH_TUBE:
        return scale * (body->outer - body->inner);
    case JOB_MESH_CYLINDER:
    case JOB_MESH_GMSH:
    default:
        return 2.0 * volume / area; /* of what is flat */
    }
}

static double longest_side(const struct mesh_survey *survey)
{
    const struct vec3 size = vec3_sub(survey->high, survey->low);
    const double side = size.x > size.y ? size.x : size.y;
    return size.z > side ? size.z : side;
}

/* Is it no column and no cube, of which 2 V/A is but a half and a third of the width? */
static bool is_flat(const struct job_body *body, double thickness, double width)
{
    const bool guessed =
        body->solid.kind == JOB_MESH_CYLINDER || body->solid.kind == JOB_MESH_GMSH;
    return thickness <= (guessed ? 0.25 * THICK : THICK) * width;
}

/* A block: its length, of which `reach` is free; 0: all of it. */
static void take_block(struct subject *subject, const struct mesh_survey *survey, double reach)
{
    const double longest = longest_side(survey);
    subject->volume = survey->volume;
    subject->section = survey->volume / longest;
    subject->length = reach > 0.0 && reach < longest ? reach : longest;
}

static void look_at_solid(struct subject *subject, const struct mesh *mesh)
{
    const struct job_body *body = subject->body;
    const struct mesh_survey survey = mesh_survey(mesh);
    const double thickness = thickness_of(body, survey.volume, survey.area);
    const double scale = body->scale > 0.0 ? body->scale : 1.0;
    struct solid_mesh own;
    struct vec3 *held;
    const int n_held = find_held(body, solid_mesh_borrow(body, &own), &held);
    const double farthest = panels_farthest(mesh->n_corners, mesh->reference, n_held, held);
    const double round = body->solid.kind == JOB_MESH_TUBE
                             ? 2.0 / (scale * (body->inner + body->outer))
                             : 0.0; /* [1/m] */
    const struct vec3 g = gravity_at(subject->job, 0.0);
    const double most = vec3_norm(g);
    const struct panel lying = {.area = survey.volume / thickness,
                                .span = 2.0 * farthest,
                                .curvature = round,
                                .normal = vec3_scale(most > 0.0 ? 1.0 / most : 0.0, g)};
    if (is_flat(body, thickness, lying.area / longest_side(&survey)))
        take_panel(subject, thickness, &lying);
    take_block(subject, &survey, farthest);
    solid_mesh_clear(&own);
    free(held);
}

/* What it is measured by: between what holds it, or as wide as it is where nothing does. */
static double span_of(const struct subject *subject)
{
    return subject->plate.span > 0.0 ? subject->plate.span : sqrt(subject->area);
}

/* Who holds all spheres is no block. */
static bool is_container(const struct mesh_survey *survey, const struct advise_cloud *cloud)
{
    const struct vec3 a = vec3_sub(cloud->low, survey->low),
                      b = vec3_sub(survey->high, cloud->high);
    return a.x >= 0.0 && a.y >= 0.0 && a.z >= 0.0 && b.x >= 0.0 && b.y >= 0.0 && b.z >= 0.0;
}

static struct subject subject_of(const struct job *job, const struct bodies *bodies, int b,
                                 const struct advise_cloud *cloud)
{
    const struct job_body *body = &job->bodies[b];
    struct subject subject = {
        .job = job, .body = body, .b = b, .material = &job->materials[body->material]};
    if (body->model == JOB_MODEL_SOLID) {
        look_at_solid(&subject, &bodies->list[b].mesh);
    } else if (body->sheet.thickness > 0.0) {
        look_at_sheet(&subject);
        subject.length = body->sheet.thickness;
        subject.section = span_of(&subject) * span_of(&subject);
    } else {
        const struct mesh_survey survey = mesh_survey(&bodies->list[b].mesh);
        if (survey.closed && survey.n_turned == 0 && survey.volume > 0.0 &&
            !is_container(&survey, cloud))
            take_block(&subject, &survey, 0.0);
    }
    subject.is_wall =
        subject.plate.thickness > 0.0 && subject.plate.thickness <= THICK * span_of(&subject);
    subject.is_known = subject.is_wall || subject.length > 0.0;
    return subject;
}

/* ------------------------------------------------------------------------------- errors */

/* A strike on what yields like a spring: what is left of the force, and of the restitution at
 * least, where all that the spring holds is lost.  (10.17) */
static void strike_spring(struct verdict *verdict, double yields)
{
    const double blow = yields < 1e6 ? plate_blow_on_spring(yields) : 0.0;
    const double kept = 1.0 - 1.25 * yields * blow * blow; /* of the energy [-] */
    const double restitution = blow > 0.0 && kept > 0.0 ? sqrt(kept) : 0.0;
    verdict->blow = blow > verdict->blow ? blow : verdict->blow;
    verdict->restitution =
        restitution > verdict->restitution ? restitution : verdict->restitution;
}

static double neglected(const struct verdict *verdict)
{
    const double less =
        verdict->blow < verdict->restitution ? verdict->blow : verdict->restitution;
    return 1.0 - less;
}

static void judge_block(struct verdict *verdict, const struct subject *subject,
                        const struct load *load)
{
    const double gives = subject->length / subject->material->young; /* [m/Pa] */
    double *errors = verdict->errors[JOB_MODEL_RIGID];
    for (int k = 0; k < N_EDGES; k++) {
        verdict->deflection[STRIKE][k] = load->strike.force * gives / subject->section;
        verdict->deflection[BED][k] = load->pressure * gives;
    }
    strike_spring(verdict, verdict->deflection[STRIKE][0] / load->strike.overlap);
    errors[STRIKE] = neglected(verdict);
    if (load->pressure > 0.0)
        errors[BED] =
            verdict->deflection[BED][0] / (verdict->deflection[BED][0] + load->overlaps);
    verdict->fits[JOB_MODEL_RIGID] = verdict->fits[JOB_MODEL_SOLID] = true;
}

/* Of the bed on a panel: all over it, or, where it covers less, as a force in the middle. */
static struct plate_sag under_bed(const struct subject *subject, const struct load *load,
                                  bool hinged)
{
    const double pressure = subject->tilt * load->pressure;
    const struct plate *plate = &subject->plate;
    const struct plate_sag over = plate_under_pressure(plate, pressure, hinged),
                           amid = plate_under_force(plate, pressure * load->cover, hinged);
    return over.deflection < amid.deflection ? over : amid;
}

/* How a wall yields to a load. */
static struct plate_sag sag_of(const struct subject *subject, const struct load *load,
                               int which, bool hinged)
{
    return which == BED ? under_bed(subject, load, hinged)
                        : plate_under_force(&subject->plate, load->strike.force, hinged);
}

/* What shells neglect of a strike, beside what rigid walls do: a quarter of the square of the
 * thickness over how far bending waves get.  (10.20) */
static double thick_share(const struct plate *plate, const struct load *load)
{
    const double reach = plate_reach(plate, load->strike.overlap, load->speed);
    const bool ends = plate->span > 0.0 && plate->span < reach;
    const double slender = plate->thickness / (ends ? plate->span : reach);
    return slender < 2.0 ? 0.25 * slender * slender : 1.0;
}

/* Of a bed; on a wall that something holds.  (10.18) to (10.20) */
static void judge_bed(struct verdict *verdict, const struct subject *subject,
                      const struct load *load)
{
    const struct plate *plate = &subject->plate;
    const double t = plate->thickness, flat = t / plate->span;
    const double bends = verdict->deflection[BED][HINGED], all = bends + load->overlaps;
    const double pressed = subject->tilt * load->pressure * t / plate->young; /* [m] */
    verdict->errors[JOB_MODEL_RIGID][BED] = bends / all;
    verdict->errors[JOB_MODEL_MEMBRANE][BED] = sag_of(subject, load, BED, false).bending;
    verdict->errors[JOB_MODEL_SHELL][BED] = (0.25 * flat * flat * bends + pressed) / all;
}

static void judge_wall(struct verdict *verdict, const struct subject *subject,
                       const struct load *load)
{
    const struct plate *plate = &subject->plate;
    const struct limits_strike *strike = &load->strike;
    for (int which = 0; which < N_LOADS; which++)
        for (int k = 0; k < N_EDGES; k++)
            verdict->deflection[which][k] =
                sag_of(subject, load, which, k == HINGED).deflection;
    verdict->zener = plate_zener(plate, strike->mass, strike->overlap, load->speed);
    verdict->restitution = plate_restitution(verdict->zener);
    verdict->blow = plate_blow(verdict->zener);
    strike_spring(verdict, verdict->deflection[STRIKE][HINGED] / strike->overlap);
    verdict->errors[JOB_MODEL_RIGID][STRIKE] = neglected(verdict);
    verdict->errors[JOB_MODEL_MEMBRANE][STRIKE] =
        plate->span > 0.0 ? sag_of(subject, load, STRIKE, false).bending : 1.0;
    verdict->errors[JOB_MODEL_SHELL][STRIKE] = thick_share(plate, load) * neglected(verdict);
    if (load->pressure > 0.0 && plate->span > 0.0)
        judge_bed(verdict, subject, load);
    for (int m = 0; m < N_MODELS; m++)
        verdict->fits[m] = true;
}

static double worst_error(const struct verdict *verdict, enum job_model model)
{
    const double *errors = verdict->errors[model];
    return errors[STRIKE] > errors[BED] ? errors[STRIKE] : errors[BED];
}

/* --------------------------------------------------------------------------------- cost */

/* What a body as it is, or all spheres, allow of the step, and what they cost. */
struct share {
    double step, seconds; /* infinite where it sets no limit [s]; a step [s] */
};

/* As a step that is found by itself would be. */
static double step_of_spheres(const struct job *job, const struct materials *materials,
                              const struct limits_spheres *spheres)
{
    struct limits_spheres sizes = *spheres; /* a copy in which sizes are noted */
    sizes.sizes = array_allocate((size_t)spheres->n_materials, sizeof *sizes.sizes);
    struct limits limits = limits_nothing(&sizes);
    for (int m = 0; m < 2 * spheres->n_materials; m++) {
        const struct limits_sizes *of = &spheres->sizes[m / 2];
        const struct packing_sphere sphere = {.material = m / 2,
                                              .radius = m % 2 == 0 ? of->least : of->most};
        if (of->most > 0.0)
            limits_add(&limits, job, materials, &sphere);
    }
    free(sizes.sizes);
    return limits.rayleigh < 1e299 ? limits_step(&limits, job->time.safety) : (double)INFINITY;
}

static struct share share_of_body(const struct job *job, const struct bodies *bodies,
                                  const struct materials *materials,
                                  const struct limits_spheres *spheres, int b)
{
    if (!job_deforms(&job->bodies[b]))
        return (struct share){(double)INFINITY, 0.0};
    return (struct share){SOLID_STEP_SHARE *
                              solid_step_with_contacts(job, bodies, materials, spheres, b).step,
                          solid_survey_cost_of(&job->bodies[b]).seconds};
}

/* All but body b: of all bodies, and last of the spheres. */
static struct share share_without(const struct job *job, const struct share *shares, int b)
{
    struct share all = {(double)INFINITY, 0.0};
    bool deform = false;
    for (int k = 0; k <= job->n_bodies; k++) {
        deform = deform || (k < job->n_bodies && job_deforms(&job->bodies[k]));
        if (k == b)
            continue;
        all.step = shares[k].step < all.step ? shares[k].step : all.step;
        all.seconds += shares[k].seconds;
    }
    if (!deform || isinf(all.step) || job->time.step > all.step)
        all.step = job->time.step; /* as asked for */
    return all;
}

/* Width of an element that shows how the panel yields, how round it is (a chord of R/4 is
 * R/128 off) and, of a shell, how waves run off. */
static double sheet_cell(const struct subject *subject, const struct load *load, bool rings)
{
    enum { ACROSS = 10, A_RADIUS = 4, A_REACH = 3 };
    const struct plate *plate = &subject->plate;
    double cell = span_of(subject) / ACROSS;
    if (A_RADIUS * cell * plate->curvature > 1.0)
        cell = 1.0 / (A_RADIUS * plate->curvature);
    const double reach = plate_reach(plate, load->strike.overlap, load->speed) / A_REACH;
    cell = rings && reach < cell ? reach : cell;
    return cell > plate->thickness ? cell : plate->thickness;
}

/* Corners of a cube; the first four are those of a square. */
static void cube(double x[SOLID_ELEMENT_CORNERS][3], double edge)
{
    for (int c = 0; c < SOLID_ELEMENT_CORNERS; c++) {
        x[c][0] = c % 4 == 1 || c % 4 == 2 ? edge : 0.0;
        x[c][1] = c % 4 >= 2 ? edge : 0.0;
        x[c][2] = c >= 4 ? edge : 0.0;
    }
}

/* What one element of this model allows, as wide as this, struck at a node [s]. */
static double element_step(const struct subject *subject, const struct load *load,
                           enum job_model model, double cell)
{
    enum { LAYERS = 3 };
    const bool solid = model == JOB_MODEL_SOLID;
    const double t = subject->plate.thickness, density = subject->material->density;
    const double mass = density * cell * cell * (solid ? cell : t);
    const double node = solid ? 0.5 * mass : mass; /* of the surface [kg] */
    struct solid_element_material material = {.density = density, .hourglass_stiffness = 0.05};
    double x[SOLID_ELEMENT_CORNERS][3];
    solid_element_elastic(&material, subject->material->young, subject->material->poisson);
    cube(x, cell);
    const struct solid_element_load bound =
        solid ? solid_element_load(SOLID_ELEMENT_HEXAHEDRON, x, mass, &material)
              : shell_element_load(model == JOB_MODEL_SHELL ? SOLID_ELEMENT_SHELL_QUAD
                                                            : SOLID_ELEMENT_MEMBRANE_QUAD,
                                   x, mass, t, LAYERS, &material, 0.0);
    const struct critical_step_contact contact =
        critical_step_contact(load->pair, load->strike.struck, node);
    return solid_element_critical_step(&bound, contact.stiffness[0] / node,
                                       contact.damping[0] / node);
}

/* The elements that the body would have. */
static struct price price_of_elements(const struct subject *subject, const struct load *load,
                                      enum job_model model, double *seconds)
{
    enum { THROUGH = 3 }; /* elements, at least */
    struct price price = {.n_elements = 0.0, .step = 1e300};
    *seconds = 0.0;
    if (model == JOB_MODEL_RIGID)
        return price;
    const bool solid = model == JOB_MODEL_SOLID;
    const double side = sqrt(subject->section);
    const double least = subject->is_wall         ? subject->plate.thickness
                         : subject->length < side ? subject->length
                                                  : side;
    const double cell =
        solid ? least / THROUGH : sheet_cell(subject, load, model == JOB_MODEL_SHELL);
    price.cell = cell;
    price.n_elements =
        solid ? subject->volume / (cell * cell * cell) : ceil(subject->area / (cell * cell));
    price.step = SOLID_STEP_SHARE * element_step(subject, load, model, cell);
    *seconds = price.n_elements * solid_survey_seconds(solid ? SOLID_ELEMENT_HEXAHEDRON
                                                             : SOLID_ELEMENT_SHELL_QUAD);
    return price;
}

/* Those that it has, in the model that the job asks for. */
static struct price price_as_it_is(const struct subject *subject, double *seconds)
{
    const struct solid_survey_cost cost = solid_survey_cost_of(subject->body);
    *seconds = cost.seconds;
    return (struct price){.n_elements = cost.n_elements, .step = subject->job->time.step};
}

static struct price price_of(const struct subject *subject, const struct load *load,
                             enum job_model model, const struct share *others)
{
    double seconds;
    const bool is_it = model == subject->body->model && model != JOB_MODEL_RIGID;
    struct price price = is_it ? price_as_it_is(subject, &seconds)
                               : price_of_elements(subject, load, model, &seconds);
    if (!is_it)
        price.step = others->step < price.step ? others->step : price.step;
    price.seconds = subject->job->time.end / price.step * (others->seconds + seconds);
    return price;
}

/* ------------------------------------------------------------------------------- saying */

static void say_subject(const struct subject *subject)
{
    const struct job_body *body = subject->body;
    const struct plate *plate = &subject->plate;
    const char *holders = body->model == JOB_MODEL_SOLID ? "what holds it"
                          : job_deforms(body)            ? "folds and what holds it"
                                                         : "its borders and folds";
    char between[TEXT] = "held by nothing";
    if (plate->span > 0.0)
        snprintf(between, sizeof between, "%.3g m between %s", plate->span, holders);
    if (subject->is_wall)
        report_say("advise    %s: a wall of %s, %.3g m thick, %s; %d panel%s of %.3g m2",
                   body->name, subject->material->name, plate->thickness, between,
                   subject->n_panels, subject->n_panels == 1 ? "" : "s", subject->area);
    else
        report_say("advise    %s: a block of %s, %.3g m long, %.3g m2 across%s", body->name,
                   subject->material->name, subject->length, subject->section,
                   body->model == JOB_MODEL_RIGID && !(body->sheet.thickness > 0.0)
                       ? ", if it is not hollow; if it is, give its thickness"
                       : "");
}

/* "1.2e-05 to 3.4e-05 m, edges clamped to hinged" */
static const char *range_of(const struct subject *subject, const double w[N_EDGES],
                            char text[TEXT])
{
    if (subject->is_wall)
        snprintf(text, TEXT, "%.3g to %.3g m, edges clamped to hinged", w[CLAMPED], w[HINGED]);
    else
        snprintf(text, TEXT, "%.3g m", w[CLAMPED]);
    return text;
}

/* Hertz's greatest pressure beyond which what is below begins to flow, over the yield stress:
 * Johnson, Contact Mechanics, 1985, 4.2. */
static void say_flow(const struct subject *subject, const struct load *load)
{
    static const double BEGINS = 1.6;
    const struct job_material *material = subject->material;
    const struct limits_strike *strike = &load->strike;
    const double yield =
        material->n_hardening_table > 0 ? material->hardening_table[0].stress : material->yield;
    const double area = 3.14159265358979323846 * strike->struck * strike->struck;
    const double pressure = 1.5 * strike->force / area; /* [Pa] */
    if (yield > 0.0 && !(load->pair->linear > 0.0) && pressure > BEGINS * yield)
        report_say("          strikes press with %.3g Pa and %s flows at %.3g Pa: dents need "
                   "model: solid, what they take off else has to be in the restitution",
                   pressure, material->name, yield);
}

static void say_load(const struct subject *subject, const struct load *load,
                     const struct verdict *verdict)
{
    const struct limits_strike *strike = &load->strike;
    const bool free = subject->is_wall && !(subject->plate.span > 0.0);
    char range[TEXT];
    report_say("          struck with %.3g N at %.3g m/s, contacts yield by %.3g m%s%s",
               strike->force, load->speed, strike->overlap, free ? "" : ", it at most by ",
               free ? "" : range_of(subject, verdict->deflection[STRIKE], range));
    if (subject->is_wall)
        report_say("          and rings (Zener's lambda is %.3g): %.3g of the restitution and "
                   "%.3g of the force are left",
                   verdict->zener, verdict->restitution, verdict->blow);
    if (load->pressure > 0.0 && !free)
        report_say("          under a bed of %.3g kg on %.3g m2, %.3g Pa, contacts yield by "
                   "%.3g m, it by %s",
                   load->mass, load->cover, load->pressure, load->overlaps,
                   range_of(subject, verdict->deflection[BED], range));
    say_flow(subject, load);
}

/* "12 %" */
static const char *percent(double share, char text[16])
{
    snprintf(text, 16,
             share < 1e-6  ? "0 %%"
             : share < 0.1 ? "%.2g %%"
                           : "%.0f %%",
             100.0 * share);
    return text;
}

static void say_row(const struct verdict *verdict, enum job_model model,
                    const struct price *price, const struct price *rigid)
{
    char strike[16], bed[16];
    if (!verdict->fits[model])
        report_say("          %-9s for thin walls alone", name_of(model));
    else
        report_say("          %-9s %-9s %-9s %-9.3g %-9.2g %-9.2g %.2g", name_of(model),
                   percent(verdict->errors[model][STRIKE], strike),
                   percent(verdict->errors[model][BED], bed), price->n_elements, price->step,
                   price->step / rigid->step, price->seconds);
}

static const char *neglects(enum job_model model)
{
    return model == JOB_MODEL_RIGID      ? "all yielding"
           : model == JOB_MODEL_MEMBRANE ? "bending"
           : model == JOB_MODEL_SHELL    ? "compression through the thickness"
                                         : "nothing of these";
}

static void say_advice(const struct subject *subject, const struct verdict *verdict,
                       enum job_model best, const struct price *price)
{
    const double *errors = verdict->errors[best];
    char error[16], how[64] = "";
    if (best == subject->body->model)
        snprintf(how, sizeof how, ", as it is");
    else if (price->cell > 0.0)
        snprintf(how, sizeof how, ", of elements of %.2g m", price->cell);
    report_say(
        "          advised: model: %s%s; it neglects %s, %s of %s where %.0f %% are borne",
        name_of(best), how, neglects(best), percent(worst_error(verdict, best), error),
        errors[BED] > errors[STRIKE] ? "what yields under the bed" : "a strike",
        100.0 * TOLERANCE);
}

static void say_models(const struct subject *subject, const struct load *load,
                       const struct verdict *verdict, const struct share *others)
{
    struct price prices[N_MODELS] = {{0.0, 0.0, 0.0, 0.0}};
    enum job_model best = JOB_MODEL_SOLID;
    report_say("          neglected of one sphere's strike: force or restitution; of a bed: "
               "how far it and contacts yield, not the force, which is its weight");
    report_say(
        "          model     strike    bed       elements  step [s]  of rigid  cost [s]");
    for (int k = 0; k < N_MODELS; k++) {
        const enum job_model m = ORDER[k];
        if (verdict->fits[m])
            prices[m] = price_of(subject, load, m, others);
        say_row(verdict, m, &prices[m], &prices[JOB_MODEL_RIGID]);
    }
    for (int k = N_MODELS - 1; k >= 0; k--) {
        const enum job_model m = ORDER[k];
        if (verdict->fits[m] && worst_error(verdict, m) <= TOLERANCE &&
            prices[m].seconds <= prices[best].seconds)
            best = m;
    }
    say_advice(subject, verdict, best, &prices[best]);
}

/* What loads stretch it by: flat it becomes a bow, longer by 8/3 (w/a)^2, and round, under a
 * bed, a wider ring, w/R.  Of a strike there is what the wall lets it be. */
static double strain_of(const struct subject *subject, const struct load *load, double blow)
{
    const struct plate *plate = &subject->plate;
    const double struck = plate_under_force(plate, blow * load->strike.force, false).deflection,
                 loaded = under_bed(subject, load, false).deflection;
    const double slope = (loaded > struck ? loaded : struck) / plate->span;
    return 8.0 / 3.0 * slope * slope + loaded * plate->curvature;
}

/* Beyond this nothing holds: well past where it flows; else no sheet is so strong, steel's best
 * wires apart, nor a hard plastic so yielding. */
static double most_strain(const struct job_material *material)
{
    static const double MUCH = 0.1, STRONG = 2e9, YIELDS = 10.0; /* [-], [Pa], [-] */
    if (material->yield > 0.0)
        return YIELDS * material->yield / material->young;
    return MUCH * material->young < STRONG ? MUCH : STRONG / material->young;
}

/* A thickness as nothing has that stands in a scene: probably in other units.  Bending alone
 * does not tell: what is thin bears by stretching and what is round by its hoops (10.11);
 * EN 1993-1-6 goes as far as R/t = 5000. */
static void warn_of_thickness(const struct subject *subject, const struct load *load,
                              double blow)
{
    static const double LIKELY[2] = {1e-4, 0.25}; /* of the span */
    const struct plate *plate = &subject->plate;
    const double t = subject->body->sheet.thickness, span = span_of(subject);
    const double radius = plate->curvature > 0.0 ? 1.0 / plate->curvature : span;
    const double wide = radius < span ? radius : span;
    const char *name = subject->body->name;
    if (subject->body->model == JOB_MODEL_SOLID || !(t > 0.0))
        return;
    if (t > LIKELY[1] * span)
        report_warn("body '%s': its thickness, %.3g m, is more than a quarter of the %.3g m "
                    "that it spans; is its unit right?",
                    name, t, span);
    if (!subject->is_wall || !(plate->span > 0.0))
        return;
    const double strain = strain_of(subject, load, blow);
    if (subject->body->model != JOB_MODEL_MEMBRANE && t < LIKELY[0] * wide)
        report_warn("body '%s': its thickness, %.3g m, is less than a ten-thousandth of the "
                    "%.3g m that it %s; is its unit right?",
                    name, t, wide, radius < span ? "is round by" : "spans");
    else if (strain > most_strain(subject->material))
        report_warn("body '%s': its thickness, %.3g m, lets loads stretch it by %.2g; is its "
                    "unit right?",
                    name, t, strain);
}

static void advise_body(const struct subject *subject, const struct load *load,
                        const struct share *others)
{
    struct verdict verdict = {.blow = 0.0};
    if (subject->is_wall)
        judge_wall(&verdict, subject, load);
    else
        judge_block(&verdict, subject, load);
    say_subject(subject);
    say_load(subject, load, &verdict);
    say_models(subject, load, &verdict, others);
    warn_of_thickness(subject, load, verdict.blow);
}

void advise_print(const struct job *job, const struct bodies *bodies,
                  const struct materials *materials, const struct limits_spheres *spheres,
                  const struct advise_cloud *cloud)
{
    struct share *shares = array_allocate((size_t)job->n_bodies + 1, sizeof *shares);
    for (int b = 0; b < job->n_bodies; b++)
        shares[b] = share_of_body(job, bodies, materials, spheres, b);
    shares[job->n_bodies] =
        (struct share){step_of_spheres(job, materials, spheres), cloud->seconds};
    for (int b = 0; b < job->n_bodies; b++) {
        const struct subject subject = subject_of(job, bodies, b, cloud);
        const struct load load = load_of(&subject, materials, spheres, cloud);
        const struct share others = share_without(job, shares, b);
        if (!subject.is_known)
            report_say("advise    %s: nothing can be said, for how thick it is is not known; "
                       "give bodies.%d.thickness",
                       job->bodies[b].name, b);
        else if (!(load.strike.force > 0.0))
            report_say("advise    %s: no sphere meets it", job->bodies[b].name);
        else
            advise_body(&subject, &load, &others);
    }
    free(shares);
}
