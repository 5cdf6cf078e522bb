/* Principal values of a symmetric matrix. */
#ifndef TREMIE_PHYSICS_PRINCIPAL_H
#define TREMIE_PHYSICS_PRINCIPAL_H

/* Of xx yy zz xy yz zx, as stress is kept; the greatest first. */
void principal_values(const double matrix[6], double values[3]);

#endif
