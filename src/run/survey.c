/* See survey.h.  Only surfaces that people or other programs have drawn are suspected; the
 * shapes of a job are what they are. */
#include "run/survey.h"

#include <stdio.h>
#include <string.h>

#include "base/comm.h"
#include "base/report.h"
#include "job/job.h"
#include "model/body.h"
#include "model/geometry.h"
#include "model/rigid.h"
#include "model/sphere.h"
#include "run/rigidity.h"
#include "run/solid_survey.h"

/* A drawing wider than this many radii is probably in other units; or one that is wider than
 * this many clouds of spheres, and not small beside a sphere. */
static const double WIDE = 2e4, WIDE_BESIDE_CLOUD = 200.0, NOT_SMALL = 1e3;

enum { PLACE = 96, NAME = 300 };

static bool is_drawn(const struct job_body *body)
{
    if (body->model == JOB_MODEL_SOLID)
        return body->solid.kind == JOB_MESH_GMSH;
    return body->geometry == JOB_GEOMETRY_MESH || body->geometry == JOB_GEOMETRY_STL ||
           body->geometry == JOB_GEOMETRY_GMSH;
}

/* "body 'drum', drum.stl" */
static const char *name_of(const struct job_body *body, char text[NAME])
{
    const char *slash = body->file != NULL ? strrchr(body->file, '/') : NULL;
    snprintf(text, NAME, "body '%s'%s%.200s", body->name, body->file != NULL ? ", " : "",
             slash != NULL        ? slash + 1
             : body->file != NULL ? body->file
                                  : "");
    return text;
}

void survey_check(const struct job *job, const struct bodies *bodies, struct mistakes *mistakes)
{
    for (int b = 0; b < bodies->n; b++) {
        const struct mesh *mesh = &bodies->list[b].mesh;
        const struct job_body *body = &job->bodies[b];
        char name[NAME];
        if (mesh->n_faces == 0 && mesh->n_bands == 0)
            mistakes_add(mistakes, body->file != NULL ? body->file : job->path, 0, 0,
                         "%s: none of %d facets has an area; a surface is expected",
                         name_of(body, name), mesh->n_degenerate);
    }
}

static double largest_side(const struct mesh_survey *survey)
{
    const struct vec3 size = vec3_sub(survey->high, survey->low);
    double side = size.x > size.y ? size.x : size.y;
    return size.z > side ? size.z : side;
}

/* How a body that forces move yields. */
static void print_forced(const struct body *body)
{
    const struct rigid *rigid = body->rigid;
    if (rigid == NULL)
        return;
    if (rigid->kind == RIGID_SLIDE)
        report_say("          slides along (%.3g, %.3g, %.3g), %.6g kg, under %.6g N",
                   rigid->axis.x, rigid->axis.y, rigid->axis.z, rigid->mass, rigid->load);
    else if (rigid->kind == RIGID_TURN)
        report_say("          turns about (%.3g, %.3g, %.3g), %.6g kg m2, under %.6g N m",
                   rigid->axis.x, rigid->axis.y, rigid->axis.z, rigid->inertia, rigid->load);
    else
        report_say("          free, %.6g kg about (%.6g, %.6g, %.6g) m; it does not feel other "
                   "bodies",
                   rigid->mass, rigid->centre.x, rigid->centre.y, rigid->centre.z);
}

static void print_body(const struct job *job, const struct body *body,
                       const struct materials *materials, const struct limits_spheres *spheres)
{
    const struct mesh *mesh = &body->mesh;
    const struct mesh_survey survey = mesh_survey(mesh);
    const int n = mesh->n_faces + mesh->n_bands;
    report_say("body      %s: rigid, %s, %d %s%s%s", body->name,
               job->materials[body->material].name, n,
               mesh->n_bands > 0 ? "curved surface" : "facet", n == 1 ? "" : "s",
               body->moves && body->rigid == NULL ? ", moves as prescribed" : "");
    print_forced(body);
    if (body->surface != NULL)
        report_say("          its surface runs, at most at %.4g m/s", body->surface_speed_max);
    if (body->comes_and_goes)
        report_say("          there from %.6g s to %.6g s", body->active[0], body->active[1]);
    report_say("          x %.4g .. %.4g, y %.4g .. %.4g, z %.4g .. %.4g m", survey.low.x,
               survey.high.x, survey.low.y, survey.high.y, survey.low.z, survey.high.z);
    if (survey.closed && survey.n_turned == 0)
        report_say("          area %.4g m2, closed, volume %.4g m3", survey.area,
                   survey.volume);
    else
        report_say("          area %.4g m2, %s", survey.area,
                   survey.closed ? "closed, facets look both ways" : "open");
    rigidity_print(job, body, &survey, materials, spheres);
}

void survey_print(const struct job *job, const struct bodies *bodies,
                  const struct materials *materials, const struct limits_spheres *spheres)
{
    for (int b = 0; b < bodies->n; b++)
        if (job_deforms(&job->bodies[b]))
            solid_survey_print(job, bodies, materials, spheres, b);
        else
            print_body(job, &bodies->list[b], materials, spheres);
}

/* The middle of an edge, in words. */
static const char *place_of(const struct mesh *mesh, int edge, char text[PLACE])
{
    const int *ends = mesh->edges[edge].vertices;
    const struct vec3 x =
        vec3_scale(0.5, vec3_add(mesh->reference[ends[0]], mesh->reference[ends[1]]));
    snprintf(text, PLACE, "(%.4g, %.4g, %.4g) m", x.x, x.y, x.z);
    return text;
}

static void warn_of_facets(const struct job_body *body, const struct mesh *mesh)
{
    char name[NAME];
    if (mesh->n_degenerate > 0)
        report_warn("%s: %d facet%s without area left out, the first is number %d",
                    name_of(body, name), mesh->n_degenerate, mesh->n_degenerate == 1 ? "" : "s",
                    mesh->first_degenerate + 1);
    if (mesh->n_duplicates > 0)
        report_warn(
            "%s: %d facet%s left out that had been there before, the first is number %d",
            name_of(body, name), mesh->n_duplicates, mesh->n_duplicates == 1 ? "" : "s",
            mesh->first_duplicate + 1);
}

/* Part of a drawing's width: vertices nearer than this were probably meant to be one. */
static const double MEANT_AS_ONE = 1e-5;

/* Warns of holes; tries whether vertices that nearly meet are the reason. */
static void warn_of_holes(const struct job_body *body, const struct mesh *mesh,
                          const struct mesh_survey *survey)
{
    char name[NAME], place[PLACE], remedy[PLACE] = "";
    struct mesh merged;
    struct job_body other = *body;
    const double scale = body->scale > 0.0 ? body->scale : 1.0;
    other.merge = MEANT_AS_ONE * largest_side(survey) / scale;
    geometry_build_mesh(&merged, &other);
    const int n_left = mesh_survey(&merged).n_open;
    mesh_clear(&merged);
    if (n_left < survey->n_open && body->merge < other.merge)
        snprintf(remedy, sizeof remedy, "; vertices nearly meet: merge: %.1g would leave %d",
                 other.merge, n_left);
    report_warn("%s: %d open edge%s, the first at %s: the surface has holes or a border%s",
                name_of(body, name), survey->n_open, survey->n_open == 1 ? "" : "s",
                place_of(mesh, survey->first_open, place), remedy);
}

static void warn_of_edges(const struct job_body *body, const struct mesh *mesh,
                          const struct mesh_survey *survey)
{
    char name[NAME], place[PLACE];
    if (survey->n_open > 0 && body->file != NULL) /* who lists facets knows of borders */
        warn_of_holes(body, mesh, survey);
    if (survey->n_shared > 0)
        report_warn("%s: %d edge%s of more than two facets, the first at %s",
                    name_of(body, name), survey->n_shared, survey->n_shared == 1 ? "" : "s",
                    place_of(mesh, survey->first_shared, place));
    if (survey->n_turned > 0)
        report_warn("%s: at %d edge%s facets look to opposite sides, the first at %s",
                    name_of(body, name), survey->n_turned, survey->n_turned == 1 ? "" : "s",
                    place_of(mesh, survey->first_turned, place));
}

/* The spheres of all ranks in short; the largest radius is 0 where there are none. */
struct cloud {
    double least, most; /* radii [m] */
    double width;       /* largest side of the box around them [m] */
};

static struct cloud find_cloud(const struct spheres *spheres, const struct comm *comm)
{
    double high[3] = {-1e300, -1e300, -1e300},
           low[3] = {-1e300, -1e300, -1e300}; /* low: minus */
    double radii[2] = {-1e300, 0.0};          /* minus the least, the largest */
    for (int i = 0; i < spheres->n_owned; i++) {
        const double radius = sphere_radius(spheres, i), *x = sphere_position(spheres, i);
        radii[0] = -radius > radii[0] ? -radius : radii[0];
        radii[1] = radius > radii[1] ? radius : radii[1];
        for (int k = 0; k < 3; k++) {
            high[k] = x[k] + radius > high[k] ? x[k] + radius : high[k];
            low[k] = radius - x[k] > low[k] ? radius - x[k] : low[k];
        }
    }
    comm_max(comm, radii, 2);
    comm_max(comm, high, 3);
    comm_max(comm, low, 3);
    struct cloud cloud = {-radii[0], radii[1], 0.0};
    for (int k = 0; k < 3; k++)
        cloud.width = high[k] + low[k] > cloud.width ? high[k] + low[k] : cloud.width;
    return cloud;
}

static void warn_of_units(const struct job_body *body, const struct mesh_survey *survey,
                          const struct cloud *cloud)
{
    char name[NAME];
    const double side = largest_side(survey);
    if (side > WIDE * cloud->most ||
        (side > WIDE_BESIDE_CLOUD * cloud->width && side > NOT_SMALL * cloud->most))
        report_warn("%s: is %.3g m wide, %.2g radii of the largest sphere; a file in mm takes "
                    "scale: 0.001",
                    name_of(body, name), side, side / cloud->most);
    else if (side < 2.0 * cloud->least)
        report_warn("%s: is %.3g m wide, less than the smallest sphere; is its scale right?",
                    name_of(body, name), side);
}

void survey_warn(const struct job *job, const struct bodies *bodies,
                 const struct spheres *spheres, const struct comm *comm)
{
    const struct cloud cloud = find_cloud(spheres, comm);
    for (int b = 0; b < bodies->n && comm->rank == 0; b++) {
        const struct mesh *mesh = &bodies->list[b].mesh;
        if (job_deforms(&job->bodies[b]))
            solid_survey_warn(job, bodies, b);
        if (!is_drawn(&job->bodies[b]))
            continue;
        const struct mesh_survey survey = mesh_survey(mesh);
        warn_of_facets(&job->bodies[b], mesh);
        warn_of_edges(&job->bodies[b], mesh, &survey);
        if (cloud.most > 0.0)
            warn_of_units(&job->bodies[b], &survey, &cloud);
    }
}
