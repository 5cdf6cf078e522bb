/*
 * Areas and volumes: see contact_patch.h.
 *
 * Around the foot of the centre on the face's plane the covered area is made of triangles from
 * the foot to a piece of a side within the circle, and of sectors of the circle before the rest
 * of it.  Both count with the sign of their turn, so it does not matter where the foot is.
 */
#include "physics/contact_patch.h"

#include "base/elementary.h"

static const double PI = 3.14159265358979323846;

/* The circle in which the ball meets the plane, and what has been found in it so far. */
struct circle {
    struct vec3 normal;
    double radius, height; /* of the ball, of its centre over the plane [m] */
    double around;         /* radius of the circle [m] */
    double angle, area,
        solid;          /* of the sectors; of the triangles, there twice; as seen from the
                                  centre, there half [rad], [m2], [sr] */
    struct vec3 turned; /* sum over sectors of their ends' directions, last less first */
    struct vec3 moment; /* of the triangles, six times [m3] */
};

static void add_sector(struct circle *circle, struct vec3 from, struct vec3 to)
{
    const double turn = vec3_dot(circle->normal, vec3_cross(from, to));
    circle->angle += elementary_atan2(turn, vec3_dot(from, to));
    circle->turned = vec3_axpy(circle->turned, 1.0 / vec3_norm(to), to);
    circle->turned = vec3_axpy(circle->turned, -1.0 / vec3_norm(from), from);
}

static void add_triangle(struct circle *circle, struct vec3 from, struct vec3 to)
{
    const double twice = vec3_dot(circle->normal, vec3_cross(from, to));
    const double h = circle->height;
    const double a = sqrt(vec3_dot(from, from) + h * h), b = sqrt(vec3_dot(to, to) + h * h);
    circle->area += twice;
    circle->moment = vec3_axpy(circle->moment, twice, vec3_add(from, to));
    circle->solid += elementary_atan2(twice, a * b + h * (a + b) + vec3_dot(from, to) + h * h);
}

static double inside(const struct mesh_border *border, struct vec3 point)
{
    return vec3_dot(vec3_sub(point, border->from), border->inward);
}

/* What lies between the foot and a side of the face; false where the side is outside of the
 * circle.  Places on the side are counted from the one that is nearest to the foot, so that
 * sides much longer than the circle do no harm. */
static bool add_side(struct circle *circle, const struct mesh_border *border, struct vec3 foot)
{
    const double length = sqrt(border->length_squared), scale = 1.0 / length;
    const struct vec3 inward = vec3_scale(scale, border->inward);
    const struct vec3 along = vec3_cross(inward, circle->normal);
    const double apart = scale * inside(border, foot);
    const struct vec3 nearest = vec3_scale(-apart, inward);
    const double from = -vec3_dot(vec3_sub(foot, border->from), along), to = from + length;
    const double square = (circle->around - apart) * (circle->around + apart);
    const double chord = square > 0.0 ? sqrt(square) : 0.0; /* half of it */
    const double first = from > -chord ? from : -chord, last = to < chord ? to : chord;
    const struct vec3 start = vec3_axpy(nearest, from, along),
                      stop = vec3_axpy(nearest, to, along);
    if (!(first < last)) {
        add_sector(circle, start, stop);
        return false;
    }
    const struct vec3 begin = vec3_axpy(nearest, first, along),
                      end = vec3_axpy(nearest, last, along);
    if (from < first)
        add_sector(circle, start, begin);
    add_triangle(circle, begin, end);
    if (last < to)
        add_sector(circle, end, stop);
    return true;
}

/* The same where the circle goes past one side alone, between its ends: what is left of it is a
 * sector and a triangle on the chord.  False where it is not so. */
static bool cut_off(struct circle *circle, const struct mesh_border *border, struct vec3 foot)
{
    const double length = sqrt(border->length_squared), scale = 1.0 / length;
    const struct vec3 inward = vec3_scale(scale, border->inward);
    const struct vec3 along = vec3_cross(inward, circle->normal);
    const double apart = scale * inside(border, foot);
    const double from = -vec3_dot(vec3_sub(foot, border->from), along), to = from + length;
    const double chord = sqrt((circle->around - apart) * (circle->around + apart));
    const double h = circle->height, radius = circle->radius;
    if (!(from <= -chord && chord <= to))
        return false;
    circle->angle = 2.0 * (PI - elementary_atan2(chord, apart));
    circle->area = 2.0 * apart * chord;
    circle->solid = elementary_atan2(circle->area, (radius + h) * (radius + h) +
                                                       (apart - chord) * (apart + chord));
    circle->turned = vec3_scale(-2.0 * chord / circle->around, along);
    circle->moment = vec3_scale(-2.0 * circle->area * apart, inward);
    return true;
}

/* A ball's volume behind the plane, in a unit of angle around the foot [m3]. */
static double sector_volume(const struct circle *circle)
{
    const double depth = circle->radius - circle->height;
    return depth * depth * (2.0 * circle->radius + circle->height) / 6.0;
}

static bool finish(const struct circle *circle, struct vec3 foot, struct contact_patch *patch)
{
    const double square = circle->around * circle->around, cube = square * circle->around;
    const double ball = circle->radius * circle->radius * circle->radius;
    patch->area = 0.5 * (circle->angle * square + circle->area);
    patch->volume = circle->angle * sector_volume(circle) +
                    (2.0 * ball * circle->solid - 0.5 * circle->height * circle->area) / 3.0;
    if (!(patch->area > 0.0))
        return false;
    const struct vec3 sectors = vec3_cross(circle->turned, circle->normal);
    const struct vec3 moment =
        vec3_axpy(vec3_scale(1.0 / 6.0, circle->moment), cube / 3.0, sectors);
    patch->middle = vec3_axpy(foot, 1.0 / patch->area, moment);
    return true;
}

/* Shares the area out to the vertices by its middle: shape functions are linear. */
static void weigh(const struct mesh *mesh, int face, struct contact_patch *patch)
{
    const struct mesh_border *border = mesh->face_borders[face];
    double left = patch->area;
    for (int k = 0; k < 2; k++) { /* side k faces vertex k + 2 */
        const double whole = inside(&border[k], border[(k + 2) % 3].from);
        patch->weights[(k + 2) % 3] = patch->area * inside(&border[k], patch->middle) / whole;
        left -= patch->weights[(k + 2) % 3];
    }
    patch->weights[1] = left;
}

/* How a ball is before a face. */
struct before {
    bool meets, is_whole; /* does it reach it?  All of the circle? */
    int n_cuts, cut;      /* sides whose line cuts the circle; the last of them */
    double height;        /* of the centre over the plane, of its normal's sign [m] */
    double square;        /* of the circle's radius [m2] */
};

/* contact/facet_kernel_blocks.c has the same in lanes. */
static struct before look(const struct mesh *mesh, int face, struct vec3 centre, double radius)
{
    const struct mesh_border *border = mesh->face_borders[face];
    const double height = vec3_dot(vec3_sub(centre, border[0].from), mesh->face_normal[face]);
    const double above = height < 0.0 ? -height : height;
    struct before before = {.meets = height > -radius && height < radius,
                            .is_whole = true,
                            .height = height,
                            .square = (radius - above) * (radius + above)};
    for (int k = 0; k < 3 && before.meets; k++) {
        const double within = inside(&border[k], centre);
        const bool is_cut = within * within < before.square * border[k].length_squared;
        before.meets = is_cut || !(within < 0.0);
        before.is_whole = before.is_whole && !is_cut;
        before.n_cuts += is_cut;
        before.cut = is_cut ? k : before.cut;
    }
    return before;
}

bool contact_patch_cut(const struct mesh *mesh, int face, struct vec3 centre, double radius,
                       struct contact_patch *patch)
{
    const struct vec3 normal = mesh->face_normal[face];
    const struct before before = look(mesh, face, centre, radius);
    if (!before.meets)
        return false;
    struct circle circle = {.normal = normal,
                            .radius = radius,
                            .height = before.height < 0.0 ? -before.height : before.height};
    const struct vec3 foot = vec3_axpy(centre, -before.height, normal);
    patch->is_circle = before.is_whole && before.height >= 0.0;
    if (before.is_whole) {
        patch->area = PI * before.square;
        patch->volume = 2.0 * PI * sector_volume(&circle);
        patch->middle = foot;
    } else {
        circle.around = sqrt(before.square);
        /* A circle that goes past a corner meets no side.  Angles about its middle then add up
         * to nothing, but for rounding. */
        const struct mesh_border *border = mesh->face_borders[face];
        const bool one = before.n_cuts == 1 && cut_off(&circle, &border[before.cut], foot);
        bool meets = one;
        for (int k = 0; k < 3 && !one; k++)
            meets = add_side(&circle, &border[k], foot) || meets;
        if (!meets || !finish(&circle, foot, patch))
            return false;
    }
    patch->volume = before.height < 0.0 ? -patch->volume : patch->volume;
    weigh(mesh, face, patch);
    return true;
}

double contact_patch_depth(double volume, double radius)
{
    enum { STEPS = 5 }; /* from a first guess that is good to 2 % */
    const double part = volume / (PI * radius * radius * radius), root = sqrt(part);
    double x = root + part * (1.0 / 6.0); /* depth over radius: x^2 (1 - x/3) = part */
    for (int k = 0; k < STEPS; k++) {
        x = x < 1.0 ? x : 1.0;
        x -= (x * x * (1.0 - x / 3.0) - part) / (x * (2.0 - x));
    }
    return radius * (x < 1.0 ? x : 1.0);
}
