/* Vectors of three doubles, for everything that is not a hot kernel. */
#ifndef TREMIE_BASE_VEC3_H
#define TREMIE_BASE_VEC3_H

#include <math.h>

struct vec3 {
    double x, y, z;
};

static inline struct vec3 vec3_add(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}
static inline struct vec3 vec3_sub(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.x - b.x, a.y - b.y, a.z - b.z};
}
static inline struct vec3 vec3_scale(double s, struct vec3 a)
{
    return (struct vec3){s * a.x, s * a.y, s * a.z};
}
static inline double vec3_dot(struct vec3 a, struct vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
static inline struct vec3 vec3_cross(struct vec3 a, struct vec3 b)
{
    return (struct vec3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static inline double vec3_norm(struct vec3 a)
{
    return sqrt(vec3_dot(a, a));
}
/* a + s b */
static inline struct vec3 vec3_axpy(struct vec3 a, double s, struct vec3 b)
{
    return vec3_add(a, vec3_scale(s, b));
}

#endif
