/*
 * tremie-render: a picture of a checkpoint or a snapshot.
 *
 * The spheres are shown as they are, coloured by what is asked for; bodies as panes of glass
 * with dark edges, those towards the viewer fainter so that they hide nothing.  The camera
 * stands where the whole scene fits: the spheres, without the few that flew far off, and the
 * bodies, without planes that are much larger than all the rest.  See canvas.h for how it is
 * drawn.
 */
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "base/array.h"
#include "base/comm.h"
#include "base/report.h"
#include "canvas.h"
#include "legend.h"
#include "owners.h"
#include "scene.h"
#include "ticks.h"

enum colour_by { BY_SPEED, BY_SIZE, BY_MATERIAL, BY_GROUP, BY_RANK, BY_ID };
enum { SIZE_LEAST = 64, SIZE_MOST = 4096, TEXT_SIZE = 160 };

static const double CREASE = 0.985;   /* cosine between faces below which their edge is drawn */
static const double HUGE_BODY = 4.0;  /* times the spheres' extent: not for the camera to fit */
static const double FAR_SHARE = 0.01; /* of the spheres at either side may be outliers */
static const struct colours_rgb INK = {0.17f, 0.19f, 0.22f};
static const struct colours_rgb GLASS = {0.42f, 0.50f, 0.60f};
static const struct colours_rgb EDGE = {0.24f, 0.28f, 0.34f};

struct wishes {
    const char *path, *like, *out, *size, *range;
    int by, view;
    double azimuth, elevation; /* [degrees]; not a number: the view's */
    double zoom;
    bool no_bodies;
    int width, height;  /* [pixels] */
    double least, most; /* of the colours; not a number: found */
};

/* ---------------------------------------------------------------------------------- colours */

/* Kinds are told apart by colours; the rest is a number on a scale. */
static bool is_kind(int by)
{
    return by == BY_MATERIAL || by == BY_GROUP || by == BY_RANK;
}

/* What a sphere shows by itself. */
static double value_of(const struct scene *scene, enum colour_by by, int i)
{
    const struct spheres *spheres = &scene->spheres;
    const double *v = sphere_velocity(spheres, i);
    switch (by) {
    case BY_SPEED:
        return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
    case BY_SIZE:
        return sphere_radius(spheres, i);
    case BY_MATERIAL:
        return spheres->material[i];
    case BY_GROUP:
        return spheres->group[i];
    case BY_RANK:
    case BY_ID:
        break;
    }
    return (double)spheres->id[i];
}

/* The value of each sphere, *values, which the caller frees.  Returns a REPORT_ status. */
static int find_values(const struct scene *scene, const struct wishes *wishes, const char *path,
                       double **values)
{
    const int n = scene->spheres.n_owned;
    int status = REPORT_FINISHED;
    *values = array_allocate((size_t)n, sizeof **values);
    for (int i = 0; i < n; i++)
        (*values)[i] = value_of(scene, (enum colour_by)wishes->by, i);
    if (wishes->by != BY_RANK)
        return status;
    int *owner = array_allocate((size_t)n, sizeof *owner);
    status = owners_find(owner, &scene->spheres, path, scene->checkpoint.step);
    for (int i = 0; i < n; i++)
        (*values)[i] = owner[i];
    free(owner);
    return status;
}

/* The value below which this share of n sorted values lies. */
static double quantile(const double *sorted, int n, double share)
{
    return sorted[(int)(share * (n - 1) + 0.5)];
}

/* The ends of the colour scale, those wished for or those that show most. */
static void find_range(const struct wishes *wishes, int n, const double *values,
                       double range[2])
{
    double *sorted = array_allocate((size_t)n, sizeof *sorted);
    memcpy(sorted, values, (size_t)n * sizeof *sorted);
    qsort(sorted, (size_t)n, sizeof *sorted, array_compare_doubles);
    range[0] = n > 0 ? sorted[0] : 0.0;
    range[1] = n > 0 ? sorted[n - 1] : 1.0;
    if (wishes->by == BY_SPEED) {
        const double most = n > 0 ? quantile(sorted, n, 0.99) : 0.0;
        range[0] = 0.0;
        range[1] = most > 1e-12 ? ticks_round_up(most) : 1e-12;
    } else if (!(range[1] > range[0])) {
        const double width = range[0] != 0.0 ? fabs(range[0]) : 1.0;
        range[0] -= 0.5 * width;
        range[1] += 0.5 * width;
    }
    if (!isnan(wishes->least)) {
        range[0] = wishes->least;
        range[1] = wishes->most;
    }
    free(sorted);
}

/* Names of the kinds by which the spheres are told apart; returns how many. */
static int list_names(const struct scene *scene, enum colour_by by, int n_kinds, char ***names)
{
    *names = array_allocate((size_t)n_kinds, sizeof **names);
    for (int k = 0; k < n_kinds; k++) {
        const char *name = NULL;
        if (by == BY_MATERIAL && scene->has_job && k < scene->job.n_materials)
            name = scene->job.materials[k].name;
        else if (by == BY_GROUP)
            name = scene_group(scene, k);
        (*names)[k] = name != NULL ? array_string(name) : array_format("%d", k);
    }
    return n_kinds;
}

/* ------------------------------------------------------------------------------- the camera */

/* The spheres' extent along each axis without outliers: a few that flew off must not shrink the
 * rest. */
static void find_extent(const struct spheres *spheres, double least[3], double most[3])
{
    const int n = spheres->n_owned;
    double *sorted = array_allocate((size_t)n, sizeof *sorted);
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < n; i++)
            sorted[i] = sphere_position(spheres, i)[k];
        qsort(sorted, (size_t)n, sizeof *sorted, array_compare_doubles);
        const double low = quantile(sorted, n, FAR_SHARE),
                     high = quantile(sorted, n, 1.0 - FAR_SHARE);
        const double air = 0.25 * (high - low) + 3.0 * sphere_radius(spheres, 0);
        least[k] = low - air > sorted[0] ? low - air : sorted[0];
        most[k] = high + air < sorted[n - 1] ? high + air : sorted[n - 1];
    }
    free(sorted);
}

static double diagonal(const double least[3], const double most[3])
{
    return vec3_norm((struct vec3){most[0] - least[0], most[1] - least[1], most[2] - least[2]});
}

static double body_size(const struct body *body)
{
    double least[3] = {INFINITY, INFINITY, INFINITY},
           most[3] = {-INFINITY, -INFINITY, -INFINITY};
    for (int v = 0; v < body->mesh.n_vertices; v++) {
        const double place[3] = {body->mesh.place[v].x, body->mesh.place[v].y,
                                 body->mesh.place[v].z};
        for (int k = 0; k < 3; k++) {
            least[k] = place[k] < least[k] ? place[k] : least[k];
            most[k] = place[k] > most[k] ? place[k] : most[k];
        }
    }
    return diagonal(least, most);
}

struct balls {
    int n, capacity;
    struct camera_ball *list;
};

static void add_ball(struct balls *balls, struct vec3 centre, double radius)
{
    ARRAY_GROW(balls->list, balls->n + 1, balls->capacity);
    balls->list[balls->n++] = (struct camera_ball){centre, radius};
}

static void add_spheres(struct balls *balls, const struct spheres *spheres,
                        const double least[3], const double most[3])
{
    for (int i = 0; i < spheres->n_owned; i++) {
        const double *x = sphere_position(spheres, i);
        bool inside = true;
        for (int k = 0; k < 3; k++)
            inside = inside && x[k] >= least[k] && x[k] <= most[k];
        if (inside)
            add_ball(balls, (struct vec3){x[0], x[1], x[2]}, sphere_radius(spheres, i));
    }
}

/* All that must be in the picture. */
static struct balls gather_balls(const struct scene *scene, bool no_bodies)
{
    struct balls balls = {0};
    double least[3], most[3], extent = INFINITY;
    if (scene->spheres.n_owned > 0) {
        find_extent(&scene->spheres, least, most);
        add_spheres(&balls, &scene->spheres, least, most);
        extent = diagonal(least, most) + 2.0 * sphere_radius(&scene->spheres, 0);
    }
    for (int b = 0; b < scene->bodies.n && !no_bodies; b++) {
        const struct body *body = &scene->bodies.list[b];
        if (!body->exists || body_size(body) > HUGE_BODY * extent)
            continue;
        for (int v = 0; v < body->mesh.n_vertices; v++)
            add_ball(&balls, body->mesh.place[v], 0.0);
    }
    if (balls.n == 0)
        add_ball(&balls, (struct vec3){0, 0, 0}, 1.0);
    return balls;
}

/* ----------------------------------------------------------------------------------- bodies */

/* Does the plane of a facet part the viewer from the middle of the scene? */
static bool facet_is_before(const struct vec3 *corners, struct vec3 eye, struct vec3 middle)
{
    const struct vec3 corner = corners[0];
    const struct vec3 normal =
        vec3_cross(vec3_sub(corners[1], corner), vec3_sub(corners[2], corner));
    return vec3_dot(normal, vec3_sub(eye, corner)) *
               vec3_dot(normal, vec3_sub(middle, corner)) <
           0.0;
}

static void draw_faces(struct canvas *canvas, const struct camera *camera,
                       const struct mesh *mesh, struct vec3 middle)
{
    for (int before = 0; before < 2; before++)
        for (int f = 0; f < mesh_n_shown(mesh); f++) {
            const int *vertices;
            const int n = mesh_shown(mesh, f, &vertices);
            struct vec3 corners[4] = {{0.0, 0.0, 0.0}};
            for (int k = 0; k < n; k++)
                corners[k] = mesh->place[vertices[k]];
            if ((int)facet_is_before(corners, camera->eye, middle) == before)
                canvas_facet(canvas, camera, n, corners, GLASS, before ? 0.07 : 0.20);
        }
}

/* Free edges, creases and outlines are drawn; seams of a smooth surface are not. */
static bool edge_shows(const struct mesh *mesh, const struct mesh_edge *edge, struct vec3 eye)
{
    if (edge->faces[0] < 0 || edge->faces[1] < 0)
        return true;
    const struct vec3 a = mesh->face_normal[edge->faces[0]],
                      b = mesh->face_normal[edge->faces[1]];
    const struct vec3 view = vec3_sub(eye, mesh->place[edge->vertices[0]]);
    return !(vec3_dot(a, b) > CREASE) || vec3_dot(a, view) * vec3_dot(b, view) < 0.0;
}

static void draw_bodies(struct canvas *canvas, const struct camera *camera,
                        const struct bodies *bodies, struct vec3 middle, double radius)
{
    const double width = canvas->height / 800.0 > 1.6 ? canvas->height / 800.0 : 1.6;
    for (int b = 0; b < bodies->n; b++)
        if (bodies->list[b].exists)
            draw_faces(canvas, camera, &bodies->list[b].mesh, middle);
    for (int b = 0; b < bodies->n; b++) {
        if (!bodies->list[b].exists)
            continue;
        const struct mesh *mesh = &bodies->list[b].mesh;
        for (int e = 0; e < mesh->n_edges; e++)
            if (edge_shows(mesh, &mesh->edges[e], camera->eye))
                canvas_edge(canvas, camera, mesh->place[mesh->edges[e].vertices[0]],
                            mesh->place[mesh->edges[e].vertices[1]], width, 0.1 * radius, EDGE);
    }
}

/* ------------------------------------------------------------------------------ the picture */

static void draw_spheres(struct canvas *canvas, const struct camera *camera,
                         const struct scene *scene, const struct wishes *wishes,
                         const double *values, const double range[2])
{
    const struct spheres *spheres = &scene->spheres;
    const bool kinds = is_kind(wishes->by);
    double sum = 0.0;
    for (int i = 0; i < spheres->n_owned; i++) {
        const double *x = sphere_position(spheres, i);
        const struct colours_rgb colour =
            kinds ? colours_of_kind((int)values[i])
                  : colours_of_share((values[i] - range[0]) / (range[1] - range[0]));
        canvas_sphere(canvas, camera, (struct vec3){x[0], x[1], x[2]},
                      sphere_radius(spheres, i), colour);
        sum += sphere_radius(spheres, i);
    }
    if (spheres->n_owned > 0)
        canvas_light(canvas, camera, 2.5 * sum / spheres->n_owned);
}

static void draw_captions(struct canvas *canvas, const struct scene *scene, double margin,
                          double height)
{
    const struct checkpoint *checkpoint = &scene->checkpoint;
    char title[TEXT_SIZE], state[TEXT_SIZE];
    snprintf(title, sizeof title, "%s", checkpoint->title);
    size_t length = strlen(title);
    while (length > 3 && canvas_text_width(1.2 * height, title) > canvas->width - 2.0 * margin)
        memcpy(title + --length - 3, "...", 4);
    snprintf(state, sizeof state, "t = %.6g s    %d spheres",
             (double)checkpoint->step * checkpoint->dt, scene->spheres.n_owned);
    canvas_text(canvas, margin, margin + 1.2 * height, 1.2 * height, CANVAS_LEFT, INK, title);
    canvas_text(canvas, margin, canvas->height - margin, height, CANVAS_LEFT, INK, state);
}

static void draw_legend(struct canvas *canvas, const struct scene *scene,
                        const struct wishes *wishes, const double *values,
                        const double range[2], double margin, double height)
{
    static const char *const titles[] = {"speed [m/s]", "radius [m]", "material",
                                         "group",       "rank",       "id"};
    const bool kinds = is_kind(wishes->by);
    int n_kinds = 0;
    char **names = NULL;
    for (int i = 0; kinds && i < scene->spheres.n_owned; i++)
        n_kinds = values[i] >= n_kinds ? (int)values[i] + 1 : n_kinds;
    if (kinds)
        list_names(scene, (enum colour_by)wishes->by, n_kinds, &names);
    struct legend legend = {titles[wishes->by], range[0], range[1], n_kinds,
                            (const char *const *)names};
    const double left = canvas->width - margin - 9.5 * height;
    const double top = 0.24 * canvas->height, bottom = 0.76 * canvas->height;
    if (!kinds || n_kinds > 0)
        legend_draw(canvas, &legend, (struct camera_frame){left, top, left, bottom}, height);
    for (int k = 0; k < n_kinds; k++)
        free(names[k]);
    free(names);
}

/* What is drawn, and its colours. */
struct subject {
    struct scene scene;
    double *values; /* of each sphere */
};

/* `like` gives the camera and the ends of the colour scale. */
static void draw(struct canvas *canvas, const struct subject *subject,
                 const struct subject *like, const struct wishes *wishes)
{
    const struct scene *scene = &subject->scene;
    const double *values = subject->values;
    const int n = scene->spheres.n_owned;
    const double margin = 0.035 * canvas->height;
    const double height = canvas->height / 75.0 > 16.0 ? canvas->height / 75.0 : 16.0;
    struct balls balls = gather_balls(&like->scene, wishes->no_bodies);
    const struct camera camera =
        camera_fit(wishes->azimuth, wishes->elevation, wishes->zoom,
                   (struct camera_frame){margin, margin + 3.0 * height,
                                         canvas->width - margin - 11.0 * height,
                                         canvas->height - margin - 2.5 * height},
                   balls.n, balls.list);
    double range[2];
    find_range(wishes, like->scene.spheres.n_owned, like->values, range);
    draw_spheres(canvas, &camera, scene, wishes, values, range);
    if (!wishes->no_bodies)
        draw_bodies(canvas, &camera, &scene->bodies, camera_middle(balls.n, balls.list),
                    n > 0 ? sphere_radius(&scene->spheres, 0) : 0.0);
    draw_captions(canvas, scene, margin, height);
    draw_legend(canvas, scene, wishes, values, range, margin, height);
    free(balls.list);
}

static int render(const struct subject *subject, const struct subject *like,
                  const struct wishes *wishes)
{
    const struct scene *scene = &subject->scene;
    struct canvas canvas;
    struct image image;
    canvas_init(&canvas, wishes->width, wishes->height);
    draw(&canvas, subject, like, wishes);
    canvas_develop(&canvas, &image);
    canvas_clear(&canvas);
    const int status = image_write_png(&image, wishes->out);
    image_clear(&image);
    if (status == REPORT_FINISHED)
        printf("%s: %d spheres at %.6g s\n", wishes->out, scene->spheres.n_owned,
               (double)scene->checkpoint.step * scene->checkpoint.dt);
    return status;
}

/* --------------------------------------------------------------------------------- the tool */

enum { N_VIEWS = 7 };
static const char *const views[N_VIEWS + 1] = {"corner", "front", "back",   "left",
                                               "right",  "top",   "bottom", NULL};

/* Completes and checks what was wished for. */
static bool settle(struct wishes *wishes)
{
    static const double directions[N_VIEWS][2] = {{30, 14}, {0, 0},  {180, 0}, {-90, 0},
                                                  {90, 0},  {0, 90}, {0, -90}};
    char rest;
    if (isnan(wishes->azimuth))
        wishes->azimuth = directions[wishes->view][0];
    if (isnan(wishes->elevation))
        wishes->elevation = directions[wishes->view][1];
    if (wishes->out == NULL) {
        report_error("there is no name for the picture; give -o FILE.png");
    } else if (sscanf(wishes->size, "%dx%d%c", &wishes->width, &wishes->height, &rest) != 2 ||
               wishes->width < SIZE_LEAST || wishes->width > SIZE_MOST ||
               wishes->height < SIZE_LEAST || wishes->height > SIZE_MOST) {
        report_error("--size is given \"%s\"; give WxH, each from %d to %d", wishes->size,
                     SIZE_LEAST, SIZE_MOST);
    } else if (wishes->range != NULL &&
               (sscanf(wishes->range, "%lf:%lf%c", &wishes->least, &wishes->most, &rest) != 2 ||
                !(wishes->most > wishes->least) || !isfinite(wishes->most - wishes->least))) {
        report_error("--range is given \"%s\"; give LEAST:MOST", wishes->range);
    } else if (!(wishes->zoom >= 0.01 && wishes->zoom <= 100.0)) {
        report_error("--zoom is given %g; give a number from 0.01 to 100", wishes->zoom);
    } else if (!(wishes->elevation >= -90.0 && wishes->elevation <= 90.0)) {
        report_error("--elevation is given %g; give a number from -90 to 90",
                     wishes->elevation);
    } else {
        return true;
    }
    return false;
}

/* Reads a file and what its spheres show.  Returns a REPORT_ status; there is nothing to clear
 * after a failure. */
static int subject_read(struct subject *subject, const struct comm *comm, const char *path,
                        const struct wishes *wishes)
{
    int status = scene_read(&subject->scene, comm, path);
    if (status != REPORT_FINISHED)
        return status;
    status = find_values(&subject->scene, wishes, path, &subject->values);
    if (status != REPORT_FINISHED) {
        free(subject->values);
        scene_clear(&subject->scene);
    }
    return status;
}

static void subject_clear(struct subject *subject)
{
    free(subject->values);
    scene_clear(&subject->scene);
}

static int show_like(const struct comm *comm, const struct subject *subject,
                     const struct wishes *wishes)
{
    struct subject like;
    int status = subject_read(&like, comm, wishes->like, wishes);
    if (status == REPORT_FINISHED) {
        status = render(subject, &like, wishes);
        subject_clear(&like);
    }
    return status;
}

static int show(struct wishes *wishes)
{
    COMM_CHECK(MPI_Init(NULL, NULL));
    const struct comm comm = comm_world();
    struct subject subject;
    int status = subject_read(&subject, &comm, wishes->path, wishes);
    if (status == REPORT_FINISHED) {
        status = wishes->like != NULL ? show_like(&comm, &subject, wishes)
                                      : render(&subject, &subject, wishes);
        subject_clear(&subject);
    }
    COMM_CHECK(MPI_Finalize());
    return status;
}

int main(int argc, char **argv)
{
    static const char *const colours[] = {"speed", "size", "material", "group",
                                          "rank",  "id",   NULL};
    struct wishes wishes = {.size = "1200x900",
                            .azimuth = (double)NAN,
                            .elevation = (double)NAN,
                            .zoom = 1.0,
                            .least = (double)NAN,
                            .most = (double)NAN};
    const struct arguments_entry entries[] = {
        {"out", 'o', ARGUMENTS_TEXT, &wishes.out, "FILE.png", "the picture", NULL},
        {"color", 0, ARGUMENTS_CHOICE, &wishes.by, "BY", "what colours show", colours},
        {"range", 0, ARGUMENTS_TEXT, &wishes.range, "LEAST:MOST", "ends of the colour scale",
         NULL},
        {"like", 0, ARGUMENTS_TEXT, &wishes.like, "FILE",
         "camera and colour scale as in a picture of FILE, for series of pictures", NULL},
        {"view", 0, ARGUMENTS_CHOICE, &wishes.view, "SIDE", "where to look from", views},
        {"azimuth", 0, ARGUMENTS_NUMBER, &wishes.azimuth, "DEG",
         "the same freely: from the front to the right", NULL},
        {"elevation", 0, ARGUMENTS_NUMBER, &wishes.elevation, "DEG", "and above the horizon",
         NULL},
        {"zoom", 0, ARGUMENTS_NUMBER, &wishes.zoom, "X", "times as large (1)", NULL},
        {"size", 0, ARGUMENTS_TEXT, &wishes.size, "WxH", "of the picture in pixels (1200x900)",
         NULL},
        {"no-bodies", 0, ARGUMENTS_FLAG, &wishes.no_bodies, NULL, "leaves bodies out", NULL},
    };
    const struct arguments_page page = {
        "tremie-render",
        "CHECKPOINT|SNAPSHOT|RUN -o FILE.png [options]",
        "Draws a checkpoint or a snapshot, or the newest checkpoint of a run's folder: spheres,\n"
        "bodies, and what the colours mean.  Ranks are those in whose subdomains the spheres lay\n"
        "when the run wrote the checkpoint, as the series in its folder tell.\n"
        "\n"
        "Exit status: 0 drawn; 2 bad arguments; 4 a file cannot be read or written.\n",
        sizeof entries / sizeof *entries,
        entries,
        1,
        1};
    int n;
    const int status = arguments_read(&page, argc, argv, &n);
    if (status != ARGUMENTS_GO_ON)
        return status;
    wishes.path = argv[1];
    return settle(&wishes) ? show(&wishes) : REPORT_BAD_INPUT;
}
