/*
 * The number is split into mantissa and decimal exponent as text; prefixes add to the exponent,
 * and one strtod() then rounds once.  Only minutes, hours, turns and degrees multiply
 * afterwards.  See units.h.
 */
#include "base/units.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/report.h"

#define PI 3.14159265358979323846

enum { NUMBER_LENGTH = 400, SYMBOL_LENGTH = 15, EXPONENT_LIMIT = 100000 };

struct dimension {
    int metre, kilogram, second, radian;
};

/* A product of units: value in SI = number * scale * 10^ten. */
struct unit {
    struct dimension dimension;
    int ten;
    double scale;
};

static const struct {
    const char *symbol;
    bool prefixes; /* may a prefix stand before it? */
    struct unit unit;
} symbols[] = {
    {"m", true, {{1, 0, 0, 0}, 0, 1.0}},
    {"g", true, {{0, 1, 0, 0}, -3, 1.0}},
    {"t", true, {{0, 1, 0, 0}, 3, 1.0}},
    {"s", true, {{0, 0, 1, 0}, 0, 1.0}},
    {"min", false, {{0, 0, 1, 0}, 0, 60.0}},
    {"h", false, {{0, 0, 1, 0}, 0, 3600.0}},
    {"d", false, {{0, 0, 1, 0}, 0, 86400.0}},
    {"Hz", true, {{0, 0, -1, 0}, 0, 1.0}},
    {"N", true, {{1, 1, -2, 0}, 0, 1.0}},
    {"Pa", true, {{-1, 1, -2, 0}, 0, 1.0}},
    {"bar", true, {{-1, 1, -2, 0}, 5, 1.0}},
    {"J", true, {{2, 1, -2, 0}, 0, 1.0}},
    {"rad", true, {{0, 0, 0, 1}, 0, 1.0}},
    {"deg", false, {{0, 0, 0, 1}, 0, PI / 180.0}},
    {"rev", false, {{0, 0, 0, 1}, 0, 2.0 * PI}},
    {"rpm", false, {{0, 0, -1, 1}, 0, 2.0 * PI / 60.0}},
};

static const struct {
    const char *symbol;
    int ten;
} prefixes[] = {{"n", -9}, {"u", -6}, {"\xc2\xb5", -6}, {"\xce\xbc", -6}, {"m", -3},
                {"c", -2}, {"k", 3},  {"M", 6},         {"G", 9}};

static const struct {
    const char *unit, *name, *example;
} quantities[] = {
    {"1", "a number", "0.5"},
    {"m", "a length", "2.5 mm"},
    {"s", "a time", "10 us"},
    {"rad", "an angle", "30 deg"},
    {"kg", "a mass", "2 kg"},
    {"m/s", "a speed", "0.5 m/s"},
    {"m/s2", "an acceleration", "9.81 m/s2"},
    {"rad/s", "an angular velocity", "100 rpm"},
    {"1/s", "a rate", "5 1/s"},
    {"kg/s", "a mass flow", "5 kg/s"},
    {"kg/m3", "a density", "2.5 g/cm3"},
    {"Pa", "a pressure", "70 GPa"},
    {"N", "a force", "10 kN"},
    {"N/m", "a stiffness", "100 kN/m"},
    {"N m", "a torque", "5 N m"},
    {"kg m2", "a moment of inertia", "0.5 kg m2"},
    {"J", "an energy", "3 J"},
};

#define LENGTH_OF(array) (sizeof(array) / sizeof *(array))

/* The symbol, with prefix or without; false when nobody knows it. */
static bool symbol_find(const char *name, struct unit *unit)
{
    for (size_t k = 0; k < LENGTH_OF(symbols); k++) {
        if (strcmp(name, symbols[k].symbol) == 0) {
            *unit = symbols[k].unit;
            return true;
        }
    }
    for (size_t k = 0; k < LENGTH_OF(symbols); k++) {
        for (size_t p = 0; symbols[k].prefixes && p < LENGTH_OF(prefixes); p++) {
            const size_t length = strlen(prefixes[p].symbol);
            if (strncmp(name, prefixes[p].symbol, length) == 0 &&
                strcmp(name + length, symbols[k].symbol) == 0) {
                *unit = symbols[k].unit;
                unit->ten += prefixes[p].ten;
                return true;
            }
        }
    }
    return false;
}

/* Multiplies `product` by unit^power. */
static void unit_multiply(struct unit *product, const struct unit *unit, int power)
{
    product->dimension.metre += power * unit->dimension.metre;
    product->dimension.kilogram += power * unit->dimension.kilogram;
    product->dimension.second += power * unit->dimension.second;
    product->dimension.radian += power * unit->dimension.radian;
    product->ten += power * unit->ten;
    for (int i = 0; i < abs(power); i++)
        product->scale =
            power > 0 ? product->scale * unit->scale : product->scale / unit->scale;
}

/* An exponent behind a symbol: "2", "-3", "^2" or nothing.  Moves *text past it. */
static bool exponent_read(const char **text, int *power)
{
    const bool caret = **text == '^';
    *text += caret;
    const bool minus = **text == '-';
    *text += minus;
    *power = minus ? -1 : 1;
    if (!isdigit((unsigned char)**text))
        return !caret && !minus;
    *power *= **text - '0';
    (*text)++;
    return *power != 0 && !isdigit((unsigned char)**text);
}

/* One factor: a symbol with prefix and exponent, or 1.  Moves *text past it. */
static bool factor_read(const char **text, bool divide, struct unit *product)
{
    if (**text == '1') {
        (*text)++;
        return true;
    }
    char name[SYMBOL_LENGTH + 1];
    size_t length = 0;
    while (isalpha((unsigned char)(*text)[length]) || ((*text)[length] & 0x80) != 0)
        length++;
    if (length == 0 || length > SYMBOL_LENGTH)
        return false;
    memcpy(name, *text, length);
    name[length] = '\0';
    *text += length;
    struct unit unit;
    int power = 1;
    if (!symbol_find(name, &unit) || !exponent_read(text, &power))
        return false;
    unit_multiply(product, &unit, divide ? -power : power);
    return true;
}

/* A whole unit such as "kg/m3", "kg m-3" or "N*m". */
static bool unit_read(const char *text, struct unit *unit)
{
    *unit = (struct unit){.scale = 1.0};
    bool divide = false;
    for (;;) {
        if (!factor_read(&text, divide, unit))
            return false;
        while (*text == ' ')
            text++;
        if (*text == '\0')
            return true;
        divide = *text == '/';
        if (*text == '/' || *text == '*')
            text++;
        while (*text == ' ')
            text++;
    }
}

static bool dimensions_equal(struct dimension a, struct dimension b)
{
    return a.metre == b.metre && a.kilogram == b.kilogram && a.second == b.second &&
           a.radian == b.radian;
}

static size_t quantity_find(struct dimension dimension)
{
    for (size_t k = 0; k < LENGTH_OF(quantities); k++) {
        struct unit unit;
        if (unit_read(quantities[k].unit, &unit) && dimensions_equal(unit.dimension, dimension))
            return k;
    }
    return LENGTH_OF(quantities);
}

static size_t quantity_of(const char *unit)
{
    struct unit parsed;
    CHECK(unit_read(unit, &parsed), "%s is not a unit", unit);
    const size_t k = quantity_find(parsed.dimension);
    CHECK(k < LENGTH_OF(quantities), "the quantity with unit %s has no name", unit);
    return k;
}

const char *units_name(const char *unit)
{
    return quantities[quantity_of(unit)].name;
}

const char *units_example(const char *unit)
{
    return quantities[quantity_of(unit)].example;
}

/* Splits "1.5e-3 mm" into mantissa text, decimal exponent and the rest; returns NULL when there
 * is no number at the start. */
static const char *number_split(const char *text, char mantissa[NUMBER_LENGTH], long *ten)
{
    size_t length = text[0] == '+' || text[0] == '-';
    bool digits = false, point = false;
    for (;; length++) {
        if (isdigit((unsigned char)text[length]))
            digits = true;
        else if (text[length] == '.' && !point)
            point = true;
        else
            break;
    }
    if (!digits || length >= NUMBER_LENGTH)
        return NULL;
    memcpy(mantissa, text, length);
    mantissa[length] = '\0';
    *ten = 0;
    text += length;
    const bool sign = (text[0] == 'e' || text[0] == 'E') && (text[1] == '+' || text[1] == '-');
    if ((text[0] == 'e' || text[0] == 'E') && isdigit((unsigned char)text[1 + sign])) {
        char *end;
        *ten = strtol(text + 1, &end, 10);
        text = end;
    }
    return text;
}

/* What the text is not. */
static bool refuse(char *what, size_t n, const char *text, const char *reason, const char *unit)
{
    const size_t k = quantity_of(unit);
    snprintf(what, n, "'%.40s' %s; %s like %s is expected", text, reason, quantities[k].name,
             quantities[k].example);
    return false;
}

bool units_read(const char *text, const char *unit, double *value, char *what, size_t n)
{
    struct unit expected, given = {.scale = 1.0};
    CHECK(unit_read(unit, &expected), "%s is not a unit", unit);

    char mantissa[NUMBER_LENGTH], decimal[NUMBER_LENGTH + 32];
    long ten;
    const char *rest = number_split(text, mantissa, &ten);
    if (rest == NULL)
        return refuse(what, n, text, "is not a finite number", unit);
    while (*rest == ' ')
        rest++;
    if (*rest != '\0' && !unit_read(rest, &given)) {
        char reason[96];
        snprintf(reason, sizeof reason, "has the unknown unit '%.40s'", rest);
        return refuse(what, n, text, reason, unit);
    }
    if (*rest != '\0' && !dimensions_equal(given.dimension, expected.dimension)) {
        const size_t k = quantity_find(given.dimension);
        char reason[96];
        snprintf(reason, sizeof reason, "is %s",
                 k < LENGTH_OF(quantities) ? quantities[k].name : "of another dimension");
        return refuse(what, n, text, reason, unit);
    }
    if (ten > EXPONENT_LIMIT || ten < -EXPONENT_LIMIT)
        return refuse(what, n, text, "is beyond what a double can hold", unit);
    snprintf(decimal, sizeof decimal, "%se%ld", mantissa, ten + given.ten);
    *value = strtod(decimal, NULL) * given.scale;
    if (!isfinite(*value))
        return refuse(what, n, text, "is beyond what a double can hold", unit);
    return true;
}
