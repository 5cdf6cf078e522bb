/* See critical_step.h. */
#include "physics/critical_step.h"

#include <math.h>

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

struct critical_step_spring critical_step_spring(const struct material_pair *pair,
                                                 double contact_radius, double mass)
{
    const double along = pair->friction > 0.0 ? 3.5 : 0.0;          /* [-] */
    const double k_n = 1.5 * pair->normal * contact_radius;         /* [N/m] (1.5) */
    const double k_t = along * pair->tangential * contact_radius;   /* [N/m] (1.9) */
    const double c_n = pair->damping * sqrt(contact_radius * mass); /* [kg/s] (1.6) */
    const double d_n = 4.0 * c_n, d_t = 2.0 * along * pair->damping_ratio * c_n;
    return (struct critical_step_spring){k_n > k_t ? k_n : k_t, d_n > d_t ? d_n : d_t};
}

void critical_step_add(struct critical_step_sums *sums,
                       const struct critical_step_spring *spring, double inverse_mass,
                       double inverse_mass_of_partner)
{
    const double shares[2] = {inverse_mass + sqrt(inverse_mass * inverse_mass_of_partner),
                              inverse_mass_of_partner > 0.0 ? 2.0 * inverse_mass
                                                            : inverse_mass}; /* [1/kg] */
    for (int k = 0; k < 2; k++) {
        sums->stiffness[k] += spring->stiffness * shares[k];
        sums->damping[k] += spring->damping * shares[k];
    }
}

double critical_step_bound(const struct critical_step_sums *sums, int k)
{
    const double a = sums->stiffness[k], b = sums->damping[k];
    return 8.0 / (b + sqrt(b * b + 16.0 * a)); /* of a dt^2 + b dt = 4 */
}

double critical_step_rest_overlap(const struct material_pair *pair, double weight,
                                  double inverse_radius)
{
    const double share = weight / pair->normal; /* a overlap [m2] */
    return elementary_exp(elementary_log(share * share * inverse_radius) / 3.0);
}

double critical_step_impact_overlap(const struct material_pair *pair, double mass,
                                    double inverse_radius, double speed)
{
    const double share = 1.25 * mass * speed * speed / pair->normal; /* a overlap^2 [m3] */
    return elementary_exp(0.2 * elementary_log(share * share * inverse_radius));
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
