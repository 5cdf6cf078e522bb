/* See gravity.h.  A table is searched from its beginning: it is short and asked once a step. */
#include "model/gravity.h"

#include "base/elementary.h"
#include "job/job.h"

static bool turns(const struct job *job)
{
    return vec3_norm(job->gravity_turn.axis) > 0.0;
}

bool gravity_varies(const struct job *job)
{
    return turns(job) || job->n_gravity_table > 1;
}

static struct vec3 turned(const struct job *job, double time)
{
    const double until = time < job->gravity_turn.stop ? time : job->gravity_turn.stop;
    const double t = until > job->gravity_turn.start ? until - job->gravity_turn.start : 0.0;
    const double angle = job->gravity_turn.rate * t;
    const double sine = elementary_sin(angle), cosine = elementary_cos(angle);
    const struct vec3 g = job->gravity, a = job->gravity_turn.axis;
    const struct vec3 along = vec3_scale(vec3_dot(a, g) * (1.0 - cosine), a);
    return vec3_add(vec3_add(vec3_scale(cosine, g), vec3_scale(sine, vec3_cross(a, g))), along);
}

static struct vec3 tabulated(const struct job *job, double time)
{
    const struct job_gravity *rows = job->gravity_table;
    int k = 0;
    while (k < job->n_gravity_table && rows[k].time <= time)
        k++;
    if (k == 0 || k == job->n_gravity_table)
        return rows[k == 0 ? 0 : k - 1].gravity;
    const double share = (time - rows[k - 1].time) / (rows[k].time - rows[k - 1].time);
    return vec3_axpy(rows[k - 1].gravity, share,
                     vec3_sub(rows[k].gravity, rows[k - 1].gravity));
}

struct vec3 gravity_at(const struct job *job, double time)
{
    if (job->n_gravity_table > 0)
        return tabulated(job, time);
    return turns(job) ? turned(job, time) : job->gravity;
}

double gravity_most(const struct job *job)
{
    double most = job->n_gravity_table > 0 ? 0.0 : vec3_norm(job->gravity);
    for (int k = 0; k < job->n_gravity_table; k++) {
        const double size = vec3_norm(job->gravity_table[k].gravity);
        most = size > most ? size : most;
    }
    return most;
}
