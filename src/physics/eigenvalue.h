/* The largest eigenvalue of small matrices, for bounds on frequencies. */
#ifndef TREMIE_PHYSICS_EIGENVALUE_H
#define TREMIE_PHYSICS_EIGENVALUE_H

enum { EIGENVALUE_SIZE = 18 /* at most */ };

/* Of a symmetric matrix of n rows without negative ones, or up to log(n)/4096 of it more. */
double eigenvalue_largest(int n, const double *matrix);
/* The same, or any bound on it that is found before and is at most `enough`. */
double eigenvalue_bound(int n, const double *matrix, double enough);

#endif
