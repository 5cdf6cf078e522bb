/*
 * See motion.h.  Oscillations have the mean velocity of a step in closed form, so neither it
 * nor the place loses digits however long the run is; paths that bend within a step have the
 * mean of their pieces.
 */
#include "model/motion.h"

#include <stddef.h>

#include "base/elementary.h"
#include "job/job.h"

static const double TWO_PI = 6.283185307179586;
static const struct vec3 STILL = {0.0, 0.0, 0.0};

static bool is_direction(struct vec3 v)
{
    return vec3_norm(v) > 0.0;
}

static double size_of(double x)
{
    return x < 0.0 ? -x : x;
}

/* The axis and the pivot of what turns, rotation, swing or path. */
static void find_axis(const struct job_motion *motion, struct vec3 *pivot, struct vec3 *axis)
{
    *pivot = motion->pivot;
    *axis = motion->axis;
    if (is_direction(motion->swing.axis)) {
        *pivot = motion->swing.pivot;
        *axis = motion->swing.axis;
    } else if (is_direction(motion->path.axis)) {
        *pivot = motion->path.pivot;
        *axis = motion->path.axis;
    }
}

bool motion_moves(const struct job_motion *motion)
{
    return motion->stop > motion->start &&
           (motion_speed_most(motion) > 0.0 || motion_spin_most(motion) > 0.0);
}

double motion_duration(const struct job_motion *motion, double time)
{
    const double until = time < motion->stop ? time : motion->stop;
    return until > motion->start ? until - motion->start : 0.0;
}

/* ----------------------------------------------------------------------------- oscillation */

/* sin(2 pi f t + phase) - sin(phase) (3.3) */
static double wave(double frequency, double phase, double t)
{
    return elementary_sin(TWO_PI * frequency * t + phase) - elementary_sin(phase);
}

/* Its mean rate of change between two times of the motion, over dt [1/s] (3.4) */
static double wave_rate(double frequency, double phase, double from, double to, double dt)
{
    const double middle = TWO_PI * frequency * (0.5 * (from + to)) + phase;
    const double half = 0.5 * TWO_PI * frequency * (to - from);
    return 2.0 * elementary_sin(half) * elementary_cos(middle) / dt;
}

/* ------------------------------------------------------------------------------- path */

/* The piece of the path in which a time lies: its first point; the first or last piece where it
 * lies before or behind all. */
static int find_piece(const struct job_path_point *points, int n, double t)
{
    int low = 0, high = n - 1; /* points[low] is not behind t, points[high] is, or the ends */
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        if (points[middle].time <= t)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* What has come of place and angle since the first point. */
static struct job_path_point path_place(const struct job_motion *motion, double t)
{
    const struct job_path_point *points = motion->path.points;
    const int n = motion->path.n;
    if (t <= points[0].time)
        return (struct job_path_point){t, STILL, 0.0};
    const int k = find_piece(points, n, t);
    const struct job_path_point *a = &points[k], *b = &points[k + 1];
    const double share = t < b->time ? (t - a->time) / (b->time - a->time) : 1.0;
    const struct vec3 place = vec3_axpy(a->place, share, vec3_sub(b->place, a->place));
    return (struct job_path_point){t, vec3_sub(place, points[0].place),
                                   a->angle + share * (b->angle - a->angle) - points[0].angle};
}

/* Velocity and rate (as angle) of a piece. */
static struct job_path_point path_slope(const struct job_path_point *points, int k)
{
    const double per_time = 1.0 / (points[k + 1].time - points[k].time);
    return (struct job_path_point){
        0.0, vec3_scale(per_time, vec3_sub(points[k + 1].place, points[k].place)),
        per_time * (points[k + 1].angle - points[k].angle)};
}

/* Mean velocity and rate over dt between two times of the motion: that of the piece in which
 * both lie, else the mean of the pieces between. (3.5) */
static struct job_path_point path_rate(const struct job_motion *motion, double from, double to,
                                       double dt)
{
    const struct job_path_point *points = motion->path.points;
    struct job_path_point mean = {0.0, STILL, 0.0};
    const int last = motion->path.n - 2;
    for (int k = find_piece(points, motion->path.n, from); k <= last; k++) {
        const double begin = points[k].time > from ? points[k].time : from;
        const double end = points[k + 1].time < to ? points[k + 1].time : to;
        if (begin >= end) {
            if (points[k].time >= to)
                break;
            continue;
        }
        const struct job_path_point slope = path_slope(points, k);
        const bool all = begin == from && end == to && to - from > 0.999999999 * dt;
        const double share = all ? 1.0 : (end - begin) / dt;
        mean.place = vec3_axpy(mean.place, share, slope.place);
        mean.angle += share * slope.angle;
    }
    return mean;
}

/* ------------------------------------------------------------------------------- together */

struct motion_place motion_place(const struct job_motion *motion, double time)
{
    const double t = motion_duration(motion, time);
    struct motion_place place = {.shift = vec3_scale(t, motion->velocity)};
    double angle = motion->rate * t;
    find_axis(motion, &place.pivot, &place.axis);
    if (is_direction(motion->oscillation.direction))
        place.shift =
            vec3_axpy(place.shift,
                      motion->oscillation.amplitude *
                          wave(motion->oscillation.frequency, motion->oscillation.phase, t),
                      motion->oscillation.direction);
    if (is_direction(motion->swing.axis))
        angle = motion->swing.amplitude * wave(motion->swing.frequency, motion->swing.phase, t);
    if (motion->path.n > 0) {
        const struct job_path_point point = path_place(motion, t);
        place.shift = vec3_add(place.shift, point.place);
        if (is_direction(motion->path.axis))
            angle = point.angle;
    }
    place.sine = elementary_sin(angle);
    place.cosine = elementary_cos(angle);
    return place;
}

struct motion_rate motion_rate(const struct job_motion *motion, double half, double dt)
{
    const double from = motion_duration(motion, half - 0.5 * dt);
    const double to = motion_duration(motion, half + 0.5 * dt);
    const bool steady = half > motion->start && half < motion->stop;
    struct motion_rate rate = {.velocity = steady ? motion->velocity : STILL};
    struct vec3 pivot, axis;
    double spin = steady ? motion->rate : 0.0;
    find_axis(motion, &pivot, &axis);
    if (is_direction(motion->oscillation.direction))
        rate.velocity = vec3_axpy(rate.velocity,
                                  motion->oscillation.amplitude *
                                      wave_rate(motion->oscillation.frequency,
                                                motion->oscillation.phase, from, to, dt),
                                  motion->oscillation.direction);
    if (is_direction(motion->swing.axis))
        spin = motion->swing.amplitude *
               wave_rate(motion->swing.frequency, motion->swing.phase, from, to, dt);
    if (motion->path.n > 0 && to > from) {
        const struct job_path_point mean = path_rate(motion, from, to, dt);
        rate.velocity = vec3_add(rate.velocity, mean.place);
        if (is_direction(motion->path.axis))
            spin = mean.angle;
    }
    rate.spin = vec3_scale(spin, axis);
    return rate;
}

/* r turned by an angle about an axis of length 1 (Rodrigues). (3.1) */
struct vec3 motion_turn(const struct motion_place *place, struct vec3 r)
{
    const struct vec3 along =
        vec3_scale(vec3_dot(place->axis, r) * (1.0 - place->cosine), place->axis);
    const struct vec3 across = vec3_scale(place->sine, vec3_cross(place->axis, r));
    return vec3_add(vec3_add(vec3_scale(place->cosine, r), across), along);
}

struct vec3 motion_apply(const struct motion_place *place, struct vec3 x)
{
    if (place->sine != 0.0 || place->cosine != 1.0)
        x = vec3_add(place->pivot, motion_turn(place, vec3_sub(x, place->pivot)));
    return vec3_add(x, place->shift);
}

/* ------------------------------------------------------------------------------- bounds */

/* The largest slope of the path, as a speed or as a rate. */
static double steepest(const struct job_motion *motion, bool angle)
{
    double most = 0.0;
    for (int k = 0; k + 1 < motion->path.n; k++) {
        const struct job_path_point slope = path_slope(motion->path.points, k);
        const double size = angle ? size_of(slope.angle) : vec3_norm(slope.place);
        most = size > most ? size : most;
    }
    return most;
}

double motion_speed_most(const struct job_motion *motion)
{
    return vec3_norm(motion->velocity) +
           TWO_PI * motion->oscillation.frequency * motion->oscillation.amplitude +
           steepest(motion, false);
}

double motion_spin_most(const struct job_motion *motion)
{
    struct vec3 pivot, axis;
    find_axis(motion, &pivot, &axis);
    if (!is_direction(axis))
        return 0.0;
    return size_of(motion->rate) + TWO_PI * motion->swing.frequency * motion->swing.amplitude +
           steepest(motion, true);
}

double motion_shift_most(const struct job_motion *motion, double until)
{
    const struct job_path_point *points = motion->path.points;
    double most = vec3_norm(motion->velocity) * motion_duration(motion, until) +
                  2.0 * motion->oscillation.amplitude,
           path = 0.0;
    for (int k = 1; k < motion->path.n; k++) {
        const double size = vec3_norm(vec3_sub(points[k].place, points[0].place));
        path = size > path ? size : path;
    }
    most += path;
    return most;
}
