/*
 * Quantities as people write them: "2.5 mm", "1e-5 s", "70 GPa", "9.81 m/s2", "100 rpm".
 *
 * A plain number is taken to be in SI units already.  A unit is a product of symbols with
 * optional prefix and exponent, like kg/m3 or mm/s; its dimension must be the one that is
 * expected.  Prefixes move the decimal exponent before the number becomes binary, so "2.5 mm"
 * and "2.5e-3" are the same double.  Angles count as a dimension, so that "5 1/s" is no angular
 * velocity.
 */
#ifndef TREMIE_BASE_UNITS_H
#define TREMIE_BASE_UNITS_H

#include <stdbool.h>
#include <stddef.h>

/*
 * Reads a finite number with an optional unit into SI units.  `unit` is the SI unit expected
 * ("m", "kg/m3", ..., "1" for a plain number).  On failure returns false and writes into `what`
 * (size n) the reason as "what is wrong; what is expected".
 */
bool units_read(const char *text, const char *unit, double *value, char *what, size_t n);

/* What a quantity with this SI unit is called, with its article: "a length". */
const char *units_name(const char *unit);
/* How one might be written: "2.5 mm". */
const char *units_example(const char *unit);

#endif
