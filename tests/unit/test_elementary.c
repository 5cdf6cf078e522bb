/* Our elementary functions against the C library's in long double, in units of the last
 * place. */
#include "base/elementary.h"
#include "check.h"

#include <math.h>

static double ulps(double got, long double expected)
{
    const double magnitude = fabs((double)expected);
    const double unit = nextafter(magnitude, INFINITY) - magnitude;
    return (double)fabsl(((long double)got - expected) / (long double)unit);
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

TEST(sin_and_cos_are_good_to_two_units)
{
    double worst = 0.0;
    for (int i = -200000; i <= 200000; i++) {
        const double x = (double)i * 7.3e-4 * (1.0 + (double)(i % 7));
        worst = larger(worst, ulps(elementary_sin(x), sinl((long double)x)));
        worst = larger(worst, ulps(elementary_cos(x), cosl((long double)x)));
    }
    EXPECT(worst < 2.0);
}

TEST(sin_and_cos_hold_near_multiples_of_a_right_angle)
{
    double worst = 0.0;
    for (int n = 1; n < 400000000; n = n * 3 / 2 + 1) {
        const double x = (double)((long double)n * 1.57079632679489661923132169163975144L);
        worst = larger(worst, ulps(elementary_sin(x), sinl((long double)x)));
        worst = larger(worst, ulps(elementary_cos(x), cosl((long double)x)));
    }
    EXPECT(worst < 2.0);
}

TEST(sin_and_cos_at_special_values)
{
    EXPECT(elementary_sin(0.0) == 0.0 && !signbit(elementary_sin(0.0)));
    EXPECT(signbit(elementary_sin(-0.0)) != 0);
    EXPECT(elementary_cos(0.0) == 1.0);
    EXPECT(elementary_sin(1e-300) == 1e-300);
    EXPECT(isnan(elementary_sin(1e9)));
    EXPECT(isnan(elementary_cos((double)NAN)));
}

TEST(atan2_is_good_to_two_units)
{
    double worst = 0.0;
    for (int i = -100000; i <= 100000; i++) {
        const double y = (double)i * 1.3e-5, far = ldexp(y, i % 500);
        for (int side = -1; side <= 1; side += 2) {
            const double x = (double)side * (0.01 + (double)(i % 11) * 0.1);
            worst = larger(worst, ulps(elementary_atan2(y, x), atan2l(y, x)));
            worst = larger(worst, ulps(elementary_atan2(far, x), atan2l(far, x)));
        }
    }
    EXPECT(worst < 2.0);
    EXPECT(elementary_atan2(0.0, 0.0) == 0.0);
    EXPECT(elementary_atan2(0.0, 2.0) == 0.0);
    EXPECT(elementary_atan2(0.0, -2.0) == acos(-1.0));
    EXPECT(isnan(elementary_atan2((double)NAN, 1.0)));
}

TEST(log_is_good_to_two_units)
{
    double worst = 0.0;
    for (int i = 1; i <= 300000; i++) {
        const double near = (double)i * 1.1e-5, far = ldexp(near, i % 1800 - 900);
        worst = larger(worst, ulps(elementary_log(near), logl((long double)near)));
        worst = larger(worst, ulps(elementary_log(far), logl((long double)far)));
    }
    EXPECT(worst < 2.0);
    EXPECT(elementary_log(1.0) == 0.0);
    EXPECT(elementary_log(0.0) < -1e308);
    EXPECT(isnan(elementary_log(-1.0)));
    EXPECT(ulps(elementary_log(5e-324), logl((long double)5e-324)) < 2.0);
}

TEST(exp_is_good_to_two_units)
{
    double worst = 0.0;
    for (int i = -300000; i <= 300000; i++) {
        const double x = (double)i * 2.3e-3;
        worst = larger(worst, ulps(elementary_exp(x), expl((long double)x)));
        worst = larger(worst, ulps(elementary_exp(x * 1e-4), expl((long double)(x * 1e-4))));
    }
    EXPECT(worst < 2.0);
    EXPECT(elementary_exp(0.0) == 1.0);
    EXPECT(elementary_exp(-800.0) == 0.0);
    EXPECT(isinf(elementary_exp(710.0)));
    EXPECT(isnan(elementary_exp((double)NAN)));
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
