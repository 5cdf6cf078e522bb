/* Closest points by feature: see contact_geometry.h.
 *
 * A round surface is met in the half-plane through its axis and the centre, where bands are
 * segments and rings are points.
 *
 * Signed offsets from the border of a region are kept as products with the length of the edge
 * they belong to, and compared as squares: the common case needs neither root nor division. */
#include "physics/contact_geometry.h"

static const double SEAM = CONTACT_GEOMETRY_SEAM;

/* Does an offset, given as offset times the root of length_squared, go beyond `allowed`? */
static inline bool goes_beyond(double product, double length_squared, double allowed)
{
    return product > 0.0 && product * product > allowed * allowed * length_squared;
}

struct segment {
    struct vec3 from, along; /* [m] */
    double length_squared;   /* [m2] */
    double foot;             /* of the centre: place along the edge times its length [m2] */
};

static inline struct segment edge_segment(const struct mesh *mesh, int edge, struct vec3 centre)
{
    const int *ends = mesh->edges[edge].vertices;
    struct segment s;
    s.from = mesh->place[ends[0]];
    s.along = vec3_sub(mesh->place[ends[1]], s.from);
    s.length_squared = vec3_dot(s.along, s.along);
    s.foot = vec3_dot(vec3_sub(centre, s.from), s.along);
    return s;
}

/* How far the centre is inside a side of a face, times the side's length [m2]. */
static inline double inside_border(const struct mesh_border *border, struct vec3 centre)
{
    return vec3_dot(vec3_sub(centre, border->from), border->inward);
}

static inline double face_height(const struct mesh *mesh, int f, struct vec3 centre)
{
    return vec3_dot(vec3_sub(centre, mesh->face_borders[f][0].from), mesh->face_normal[f]);
}

static inline struct contact_geometry on_face(const struct mesh *mesh, int f,
                                              struct vec3 centre, double height)
{
    const struct vec3 normal = mesh->face_normal[f];
    return (struct contact_geometry){
        .point = vec3_axpy(centre, -height, normal),
        .normal = height < 0.0 ? vec3_scale(-1.0, normal) : normal,
        .distance = height < 0.0 ? -height : height,
    };
}

/* The facet kernel says the same in lanes. */
static bool face_touches(const struct mesh *mesh, int f, struct vec3 centre, double radius,
                         struct contact_geometry *at)
{
    const double height = face_height(mesh, f, centre);
    if (!(height < radius && height > -radius))
        return false;
    for (int k = 0; k < mesh->faces[f].n; k++) {
        const struct mesh_border *border = &mesh->face_borders[f][k];
        if (goes_beyond(-inside_border(border, centre), border->length_squared, SEAM * radius))
            return false;
    }
    *at = on_face(mesh, f, centre, height);
    return true;
}

/* From a point of an edge or vertex; where the centre lies on it, the surface's own normal
 * serves. */
static inline struct contact_geometry at_point(const struct mesh *mesh, int face,
                                               struct vec3 point, struct vec3 centre)
{
    const struct vec3 arm = vec3_sub(centre, point);
    const double distance = vec3_norm(arm);
    return (struct contact_geometry){
        .point = point,
        .normal = distance > 0.0 ? vec3_scale(1.0 / distance, arm) : mesh->face_normal[face],
        .distance = distance,
    };
}

static inline struct contact_geometry on_edge(const struct mesh *mesh, int edge,
                                              const struct segment *s, struct vec3 centre)
{
    const double part = s->foot / s->length_squared;
    const double within = part < 0.0 ? 0.0 : part > 1.0 ? 1.0 : part;
    const struct vec3 point = vec3_axpy(s->from, within, s->along);
    return at_point(mesh, mesh->edges[edge].faces[0], point, centre);
}

static int side_of_edge(const struct mesh_face *face, int edge)
{
    int k = 0;
    while (face->edges[k] != edge)
        k++;
    return k;
}

static bool edge_touches(const struct mesh *mesh, int edge, struct vec3 centre, double radius,
                         struct contact_geometry *at)
{
    const struct segment s = edge_segment(mesh, edge, centre);
    const double hair = SEAM * radius;
    if (goes_beyond(-s.foot, s.length_squared, hair) ||
        goes_beyond(s.foot - s.length_squared, s.length_squared, hair))
        return false;
    const struct contact_geometry closest = on_edge(mesh, edge, &s, centre);
    if (!(closest.distance < radius))
        return false;
    for (int k = 0; k < 2; k++) {
        const int f = mesh->edges[edge].faces[k];
        if (f < 0)
            continue;
        const struct mesh_border *border =
            &mesh->face_borders[f][side_of_edge(&mesh->faces[f], edge)];
        if (goes_beyond(inside_border(border, centre), border->length_squared, hair))
            return false;
    }
    *at = closest;
    return true;
}

static inline struct contact_geometry on_vertex(const struct mesh *mesh, int vertex,
                                                struct vec3 centre)
{
    if (mesh->n_edges == 0) /* of a round surface: nothing touches it */
        return (struct contact_geometry){mesh->place[vertex], mesh->direction,
                                         vec3_norm(vec3_sub(centre, mesh->place[vertex]))};
    const int edge = mesh->edge_list[mesh->edge_begin[vertex]];
    return at_point(mesh, mesh->edges[edge].faces[0], mesh->place[vertex], centre);
}

static bool vertex_touches(const struct mesh *mesh, int vertex, struct vec3 centre,
                           double radius, struct contact_geometry *at)
{
    const struct vec3 arm = vec3_sub(centre, mesh->place[vertex]);
    if (mesh->n_edges == 0 || !(vec3_dot(arm, arm) < radius * radius))
        return false;
    for (int k = mesh->edge_begin[vertex]; k < mesh->edge_begin[vertex + 1]; k++) {
        const int edge = mesh->edge_list[k];
        const struct segment s = edge_segment(mesh, edge, centre);
        const double onto =
            mesh->edges[edge].vertices[0] == vertex ? s.foot : s.length_squared - s.foot;
        if (goes_beyond(onto, s.length_squared, SEAM * radius))
            return false;
    }
    *at = on_vertex(mesh, vertex, centre);
    return at->distance < radius;
}

/* ---- Bands and rings
 * -------------------------------------------------------------------------- */

/* A sphere nearer to the axis than this part of its overlap is held by the wall all around. */
static const double AROUND = 0.1;

/* The centre in the half-plane. */
struct section {
    double out, up;      /* from the axis, along it [m] */
    struct vec3 outward; /* unit vector */
};

static inline struct section section_of(const struct mesh *mesh, struct vec3 centre)
{
    const struct vec3 arm = vec3_sub(centre, mesh->origin);
    const double up = vec3_dot(arm, mesh->direction);
    const struct vec3 across = vec3_axpy(arm, -up, mesh->direction);
    const double out = vec3_norm(across);
    return (struct section){out, up, out > 0.0 ? vec3_scale(1.0 / out, across) : mesh->aside};
}

/* How far along a band the centre's foot is, and how far off the band it is. */
static inline double band_foot(const struct mesh *mesh, const struct mesh_band *band,
                               const struct section *c, double *height)
{
    const struct mesh_ring *from = &mesh->rings[band->rings[0]];
    const double out = c->out - from->radius, up = c->up - from->height;
    *height = out * band->along[1] - up * band->along[0];
    return out * band->along[0] + up * band->along[1];
}

static inline struct contact_geometry in_section(const struct mesh *mesh, struct vec3 centre,
                                                 const struct section *c, double normal_out,
                                                 double normal_up, double distance)
{
    struct contact_geometry at;
    at.normal = vec3_axpy(vec3_scale(normal_out, c->outward), normal_up, mesh->direction);
    at.point = vec3_axpy(centre, -distance, at.normal);
    at.distance = distance;
    return at;
}

static inline struct contact_geometry on_band(const struct mesh *mesh, int b,
                                              struct vec3 centre, const struct section *c)
{
    const struct mesh_band *band = &mesh->bands[b];
    double height;
    band_foot(mesh, band, c, &height);
    const double side = height < 0.0 ? -1.0 : 1.0;
    return in_section(mesh, centre, c, side * band->along[1], -side * band->along[0],
                      side * height);
}

static inline struct contact_geometry on_ring(const struct mesh *mesh, int r,
                                              struct vec3 centre, const struct section *c)
{
    const struct mesh_ring *ring = &mesh->rings[r];
    const double out = c->out - ring->radius, up = c->up - ring->height;
    const double distance = sqrt(out * out + up * up);
    if (!(distance > 0.0))
        return on_band(mesh, ring->bands[0], centre, c);
    return in_section(mesh, centre, c, out / distance, up / distance, distance);
}

/* Near the axis the wall is about as near on all sides: there the normal turns to the axis
 * (THEORY.md 2.2). */
static void turn_to_axis(const struct mesh *mesh, struct vec3 centre, const struct section *c,
                         double radius, struct contact_geometry *at)
{
    const double width = AROUND * (radius - at->distance);
    if (!(c->out < width))
        return;
    const double out = vec3_dot(at->normal, c->outward),
                 up = vec3_dot(at->normal, mesh->direction);
    if (!(out < 0.0) || !(up * up > AROUND * AROUND * out * out))
        return;
    const double less = out * c->out / width;
    const double scale = 1.0 / sqrt(less * less + up * up);
    *at = in_section(mesh, centre, c, scale * less, scale * up, at->distance);
}

static bool band_touches(const struct mesh *mesh, int b, struct vec3 centre, double radius,
                         struct contact_geometry *at)
{
    const struct section c = section_of(mesh, centre);
    const double hair = SEAM * radius;
    double height;
    const double foot = band_foot(mesh, &mesh->bands[b], &c, &height);
    if (!(height < radius && height > -radius && foot >= -hair &&
          foot <= mesh->bands[b].length + hair))
        return false;
    *at = on_band(mesh, b, centre, &c);
    turn_to_axis(mesh, centre, &c, radius, at);
    return true;
}

static bool ring_touches(const struct mesh *mesh, int r, struct vec3 centre, double radius,
                         struct contact_geometry *at)
{
    const struct mesh_ring *ring = &mesh->rings[r];
    const struct section c = section_of(mesh, centre);
    const struct contact_geometry closest = on_ring(mesh, r, centre, &c);
    if (!(closest.distance < radius))
        return false;
    for (int k = 0; k < 2 && ring->bands[k] >= 0; k++) {
        const struct mesh_band *band = &mesh->bands[ring->bands[k]];
        double height;
        const double foot = band_foot(mesh, band, &c, &height);
        const double inside = band->rings[0] == r ? foot : band->length - foot;
        if (inside > SEAM * radius)
            return false;
    }
    *at = closest;
    turn_to_axis(mesh, centre, &c, radius, at);
    return true;
}

/* ---- Any feature
 * ------------------------------------------------------------------------------ */

bool contact_geometry_touches(const struct mesh *mesh, int feature, struct vec3 centre,
                              double radius, struct contact_geometry *at)
{
    if (feature < mesh->n_faces)
        return face_touches(mesh, feature, centre, radius, at);
    const int edge = feature - mesh->n_faces;
    if (edge < mesh->n_edges)
        return edge_touches(mesh, edge, centre, radius, at);
    const int vertex = edge - mesh->n_edges;
    if (vertex < mesh->n_vertices)
        return vertex_touches(mesh, vertex, centre, radius, at);
    const int band = vertex - mesh->n_vertices;
    if (band < mesh->n_bands)
        return band_touches(mesh, band, centre, radius, at);
    return ring_touches(mesh, band - mesh->n_bands, centre, radius, at);
}

struct contact_geometry contact_geometry_closest(const struct mesh *mesh, int feature,
                                                 struct vec3 centre)
{
    if (feature < mesh->n_faces)
        return on_face(mesh, feature, centre, face_height(mesh, feature, centre));
    const int edge = feature - mesh->n_faces;
    if (edge < mesh->n_edges) {
        const struct segment s = edge_segment(mesh, edge, centre);
        return on_edge(mesh, edge, &s, centre);
    }
    const int vertex = edge - mesh->n_edges, band = vertex - mesh->n_vertices;
    if (vertex < mesh->n_vertices)
        return on_vertex(mesh, vertex, centre);
    const struct section c = section_of(mesh, centre);
    return band < mesh->n_bands ? on_band(mesh, band, centre, &c)
                                : on_ring(mesh, band - mesh->n_bands, centre, &c);
}

/* ---- Reach
 * ------------------------------------------------------------------------------------ */

static bool face_reaches(const struct mesh *mesh, int f, struct vec3 centre, double reach)
{
    const double height = face_height(mesh, f, centre);
    if (!(height <= reach && height >= -reach)) /* nor does a face whose place is not known */
        return false;
    for (int k = 0; k < mesh->faces[f].n; k++) {
        const struct mesh_border *border = &mesh->face_borders[f][k];
        if (goes_beyond(-inside_border(border, centre), border->length_squared, reach))
            return false;
    }
    return true;
}

static bool edge_reaches(const struct mesh *mesh, int edge, struct vec3 centre, double reach)
{
    const struct segment s = edge_segment(mesh, edge, centre);
    if (goes_beyond(-s.foot, s.length_squared, reach) ||
        goes_beyond(s.foot - s.length_squared, s.length_squared, reach))
        return false;
    return !(on_edge(mesh, edge, &s, centre).distance > reach);
}

/* The skin's corners, by which the speed of a body is known, lag behind its rim by less than
 * this part. */
static const double SKIN = 1.01;

/* The distance to a segment of the half-plane. */
static bool band_reaches(const struct mesh *mesh, int b, struct vec3 centre, double reach)
{
    const struct mesh_band *band = &mesh->bands[b];
    const struct section c = section_of(mesh, centre);
    double height;
    const double foot = band_foot(mesh, band, &c, &height), wide = SKIN * reach;
    const double beyond = foot < 0.0 ? -foot : foot > band->length ? foot - band->length : 0.0;
    return !(height * height + beyond * beyond > wide * wide);
}

static bool ring_reaches(const struct mesh *mesh, int r, struct vec3 centre, double reach)
{
    const struct section c = section_of(mesh, centre);
    return !(on_ring(mesh, r, centre, &c).distance > SKIN * reach);
}

bool contact_geometry_reaches(const struct mesh *mesh, int feature, struct vec3 centre,
                              double reach)
{
    if (feature < mesh->n_faces)
        return face_reaches(mesh, feature, centre, reach);
    const int edge = feature - mesh->n_faces;
    if (edge < mesh->n_edges)
        return edge_reaches(mesh, edge, centre, reach);
    const int vertex = edge - mesh->n_edges, band = vertex - mesh->n_vertices;
    if (vertex < mesh->n_vertices) {
        const struct vec3 arm = vec3_sub(centre, mesh->place[vertex]);
        return !(vec3_dot(arm, arm) > reach * reach);
    }
    return band < mesh->n_bands ? band_reaches(mesh, band, centre, reach)
                                : ring_reaches(mesh, band - mesh->n_bands, centre, reach);
}

bool contact_geometry_reaches_side(const struct mesh *mesh, int face, int side,
                                   struct vec3 centre, double reach)
{
    const struct mesh_border *border = &mesh->face_borders[face][side];
    return !goes_beyond(inside_border(border, centre), border->length_squared, reach);
}
