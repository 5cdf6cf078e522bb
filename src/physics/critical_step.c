/* See critical_step.h. */
#include "physics/critical_step.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/elementary.h"

double critical_step_rayleigh(double radius, double density, double young, double poisson)
{
    const double pi = 3.14159265358979323846;
    const double shear = young / (2.0 * (1.0 + poisson));
    return pi * radius * sqrt(density / shear) / (0.1631 * poisson + 0.8766);
}

double critical_step_hertz_duration(double mass, double radius, double young, double speed)
{
    return 2.87 *
           elementary_exp(0.2 * elementary_log(mass * mass / (radius * young * young * speed)));
}

struct critical_step_contact critical_step_contact(const struct material_pair *pair,
                                                   double contact_radius, double mass)
{
    const bool grips = pair->friction > 0.0 || pair->static_friction > 0.0;
    const bool rolls = grips && (pair->rolling > 0.0 || pair->twisting > 0.0);
    const double exponent = pair->linear > 0.0 ? 1.0 : 1.5;
    const double k_t = grips ? pair->tangential * contact_radius : 0.0; /* [N/m] (1.9) */
    const double c_n = pair->damping * sqrt(contact_radius * mass);     /* [kg/s] (1.6) */
    const double c_t = grips ? pair->damping_ratio * c_n : 0.0;         /* [kg/s] (1.12) */
    return (struct critical_step_contact){
        .stiffness = {exponent * pair->normal * contact_radius, k_t, rolls ? k_t : 0.0},
        .damping = {4.0 * c_n, 2.0 * c_t, rolls ? 2.0 * c_t : 0.0}};
}

struct critical_step_side critical_step_side(double inverse_mass, double curvature,
                                             double curvature_of_partner)
{
    const double part = curvature / (curvature + curvature_of_partner); /* R* over R */
    return (struct critical_step_side){inverse_mass / part, part * part};
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

void critical_step_add(struct critical_step_sums *sums,
                       const struct critical_step_contact *contact,
                       const struct critical_step_side *side)
{
    const double *k = contact->stiffness, *d = contact->damping, arm = 2.5 * side->arm;
    sums->stiffness += side->share * larger(k[0], 3.5 * k[1] + arm * k[2]);
    sums->damping += side->share * larger(d[0], 3.5 * d[1] + arm * d[2]);
}

double critical_step_of_sums(const struct critical_step_sums *sums)
{
    const double a = sums->stiffness, b = sums->damping;
    return 8.0 / (b + sqrt(b * b + 16.0 * a)); /* of a dt^2 + b dt = 4 */
}

/* Adds across n n + along (1 - n n) for places, 5/2 along (1 - n n) + 5/2 of what resists
 * rolling and twisting for turns, and what joins the two: a turn moves the surface. */
static void add_block(double m[6][6], const double k[3], const struct critical_step_side *side,
                      const double n[3])
{
    const double across = side->share * k[0], along = side->share * k[1];
    const double turn = side->share * side->arm * k[2];
    const double join = sqrt(2.5) * along;
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            const double nn = n[r] * n[c], rest = (r == c ? 1.0 : 0.0) - nn;
            m[r][c] += across * nn + along * rest;
            m[3 + r][3 + c] += 2.5 * (along * rest + (r == c ? turn : 0.0));
        }
        const int p = (r + 1) % 3, q = (r + 2) % 3;
        m[r][3 + p] += join * n[q];
        m[r][3 + q] -= join * n[p];
        m[3 + p][r] += join * n[q];
        m[3 + q][r] -= join * n[p];
    }
}

void critical_step_add_matrix(struct critical_step_matrix *matrix,
                              const struct critical_step_contact *contact,
                              const struct critical_step_side *side, const double normal[3])
{
    add_block(matrix->stiffness, contact->stiffness, side, normal);
    add_block(matrix->damping, contact->damping, side, normal);
}

static void square(double m[6][6])
{
    double s[6][6];
    for (int r = 0; r < 6; r++) {
        for (int c = 0; c < 6; c++) {
            s[r][c] = 0.0;
            for (int k = 0; k < 6; k++)
                s[r][c] += m[r][k] * m[k][c];
        }
    }
    memcpy(m, s, sizeof s);
}

/* The 32nd root of the trace of the 32nd power: the largest eigenvalue, as none is negative, or
 * up to 6^(1/32) = 1.058 times it. */
double critical_step_load(const struct critical_step_matrix *matrix, double dt)
{
    double m[6][6], trace = 0.0, sum = 0.0;
    for (int r = 0; r < 6; r++) {
        for (int c = 0; c < 6; c++)
            m[r][c] = 0.25 * dt * (dt * matrix->stiffness[r][c] + matrix->damping[r][c]);
        trace += m[r][r];
    }
    if (!(trace > 0.0))
        return trace;
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++)
            m[r][c] /= trace;
    for (int k = 0; k < 4; k++)
        square(m);
    for (int r = 0; r < 6; r++)
        for (int c = 0; c < 6; c++)
            sum += m[r][c] * m[r][c];
    return trace * sqrt(sqrt(sqrt(sqrt(sqrt(sum)))));
}

double critical_step_of_matrix(const struct critical_step_matrix *matrix)
{
    enum { HALVINGS = 40 };
    struct critical_step_sums sums = {0.0, 0.0};
    for (int k = 0; k < 6; k++) {
        sums.stiffness += matrix->stiffness[k][k];
        sums.damping += matrix->damping[k][k];
    }
    double low = critical_step_of_sums(&sums), high = 4.0 * low; /* a trace is six at most */
    if (!(low < 1e300))
        return low;
    for (int k = 0; k < HALVINGS; k++) {
        const double middle = 0.5 * (low + high);
        if (critical_step_load(matrix, middle) <= 1.0)
            low = middle;
        else
            high = middle;
    }
    return low;
}

struct critical_step_sums critical_step_amid(const struct critical_step_contact *contact,
                                             double inverse_mass, int n)
{
    const double share = 2.0 * inverse_mass * n / 3.0, *k = contact->stiffness,
                 *d = contact->damping;
    const double turn = 7.5 * 0.25; /* of three axes, at an arm of half a radius */
    return (struct critical_step_sums){
        share * larger(k[0] + 2.0 * k[1], 5.0 * k[1] + turn * k[2]),
        share * larger(d[0] + 2.0 * d[1], 5.0 * d[1] + turn * d[2])};
}

double critical_step_rest_overlap(const struct material_pair *pair, double weight,
                                  double inverse_radius)
{
    const double share = weight / pair->normal; /* a overlap [m2]; or the overlap [m] */
    if (pair->linear > 0.0)
        return share;
    return elementary_exp(elementary_log(share * share * inverse_radius) / 3.0);
}

double critical_step_impact_overlap(const struct material_pair *pair, double mass,
                                    double inverse_radius, double speed)
{
    if (pair->linear > 0.0)
        return speed * sqrt(mass / pair->normal);
    const double share = 1.25 * mass * speed * speed / pair->normal; /* a overlap^2 [m3] */
    return elementary_exp(0.2 * elementary_log(share * share * inverse_radius));
}

double critical_step_duration(const struct material_pair *pair, double mass,
                              double inverse_radius, double speed)
{
    if (pair->linear > 0.0)
        return 3.14159265358979323846 * sqrt(mass / pair->normal);
    return critical_step_hertz_duration(mass, 1.0 / inverse_radius, 0.75 * pair->normal, speed);
}

/* Compares quotients, which are correctly rounded; products with powers of ten would make 11 of
 * 12. */
double critical_step_round_down(double x)
{
    double scale = 1.0;
    while (10.0 / scale > x)
        scale *= 10.0;
    while (100.0 / scale <= x)
        scale /= 10.0;
    double digits = (double)(int)(x * scale) + 1.0;
    while (digits / scale > x)
        digits -= 1.0;
    return digits / scale;
}
