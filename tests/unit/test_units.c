/* Quantities with units: exact conversion, dimensions, and what is refused with which words. */
#include "check.h"

#include "base/units.h"

static double value;
static char what[256];

static bool reads(const char *text, const char *unit, double expected)
{
    return units_read(text, unit, &value, what, sizeof what) && value == expected;
}

static bool refuses(const char *text, const char *unit, const char *message)
{
    return !units_read(text, unit, &value, what, sizeof what) && strcmp(what, message) == 0;
}

TEST(plain_numbers_are_si)
{
    EXPECT(reads("1", "m", 1.0));
    EXPECT(reads("-2.5", "m", -2.5));
    EXPECT(reads("+.5", "1", 0.5));
    EXPECT(reads("5.", "1", 5.0));
    EXPECT(reads("1e-5", "s", 1e-5));
    EXPECT(reads("1.0E+05", "Pa", 1e5));
    EXPECT(reads("0.1", "m", 0.1));
}

TEST(prefixes_are_exact)
{
    EXPECT(reads("2.5 mm", "m", 2.5e-3));
    EXPECT(reads("2.5mm", "m", 2.5e-3));
    EXPECT(reads("0.3 um", "m", 0.3e-6));
    EXPECT(reads("0.3 \xc2\xb5m", "m", 0.3e-6));
    EXPECT(reads("7 cm", "m", 7e-2));
    EXPECT(reads("10 kPa", "Pa", 1e4));
    EXPECT(reads("62.5 GPa", "Pa", 6.25e10));
    EXPECT(reads("1e-2 ms", "s", 1e-5));
    EXPECT(reads("3 g", "kg", 3e-3));
    EXPECT(reads("3 t", "kg", 3e3));
}

TEST(products_and_powers)
{
    EXPECT(reads("9.81 m/s2", "m/s2", 9.81));
    EXPECT(reads("9.81 m/s^2", "m/s2", 9.81));
    EXPECT(reads("9.81 m s-2", "m/s2", 9.81));
    EXPECT(reads("9.81 N/kg", "m/s2", 9.81));
    EXPECT(reads("2.65 g/cm3", "kg/m3", 2650.0));
    EXPECT(reads("2 N/mm2", "Pa", 2e6));
    EXPECT(reads("5 1/s", "1/s", 5.0));
    EXPECT(reads("5 Hz", "1/s", 5.0));
    EXPECT(reads("36 km/h", "m/s", 36e3 * (1.0 / 3600.0)));
}

TEST(angles_and_minutes)
{
    EXPECT(reads("2 min", "s", 120.0));
    EXPECT(reads("2 h", "s", 7200.0));
    EXPECT(reads("2 rad/s", "rad/s", 2.0));
    EXPECT(units_read("180 deg", "rad", &value, what, sizeof what));
    EXPECT_NEAR(value, 3.14159265358979323846, 1e-15);
    EXPECT(units_read("60 rpm", "rad/s", &value, what, sizeof what));
    EXPECT_NEAR(value, 6.28318530717958647692, 1e-15);
    EXPECT(units_read("1 rev/s", "rad/s", &value, what, sizeof what));
    EXPECT_NEAR(value, 6.28318530717958647692, 1e-15);
}

TEST(other_dimensions_are_refused)
{
    EXPECT(refuses("5 s", "m", "'5 s' is a time; a length like 2.5 mm is expected"));
    EXPECT(refuses("5 1/s", "rad/s",
                   "'5 1/s' is a rate; an angular velocity like 100 rpm is expected"));
    EXPECT(refuses("5 m2", "m",
                   "'5 m2' is of another dimension; a length like 2.5 mm is expected"));
    EXPECT(refuses("5 m", "1", "'5 m' is a length; a number like 0.5 is expected"));
}

TEST(unknown_units_are_refused)
{
    EXPECT(refuses("5 mmm", "m",
                   "'5 mmm' has the unknown unit 'mmm'; a length like 2.5 mm is expected"));
    EXPECT(!units_read("5 kmin", "s", &value, what, sizeof what));
    EXPECT(!units_read("5 m/", "m", &value, what, sizeof what));
    EXPECT(!units_read("5 m^", "m", &value, what, sizeof what));
    EXPECT(!units_read("5 m0", "m", &value, what, sizeof what));
    EXPECT(!units_read("5 m12", "m", &value, what, sizeof what));
    EXPECT(!units_read("0,5", "m", &value, what, sizeof what));
    EXPECT(!units_read("1 2", "m", &value, what, sizeof what));
    EXPECT(!units_read("1e", "m", &value, what, sizeof what));
    EXPECT(!units_read("0x10", "m", &value, what, sizeof what));
    EXPECT(!units_read("1_000", "m", &value, what, sizeof what));
}

TEST(what_is_not_finite_is_refused)
{
    EXPECT(
        refuses("nan", "m", "'nan' is not a finite number; a length like 2.5 mm is expected"));
    EXPECT(
        refuses("1e400", "m",
                "'1e400' is beyond what a double can hold; a length like 2.5 mm is expected"));
    EXPECT(!units_read("inf", "m", &value, what, sizeof what));
    EXPECT(!units_read(".inf", "m", &value, what, sizeof what));
    EXPECT(!units_read("", "m", &value, what, sizeof what));
    EXPECT(!units_read("-", "m", &value, what, sizeof what));
    EXPECT(!units_read("1e99999999999999999999", "m", &value, what, sizeof what));
    EXPECT(reads("1e-99999", "m", 0.0));
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
