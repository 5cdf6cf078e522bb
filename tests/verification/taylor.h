/* Taylor's impact of a copper cylinder on a wall without friction. */
#ifndef TREMIE_TESTS_VERIFICATION_TAYLOR_H
#define TREMIE_TESTS_VERIFICATION_TAYLOR_H

struct taylor_result {
    double length, foot; /* at the end: length, radius at the wall [m] */
    double plastic_most; /* plastic strain [-] */
    double hourglass;    /* energy over internal [-] */
    double held;         /* internal energy that no part of it accounts for, over it [-] */
    double balance;      /* over the energy at the start [-] */
};

/* L 32.4 mm, R 3.2 mm, 227 m/s, to 80 us; a quarter of it, `across` cells along a radius twice
 * over and `along` its length. */
struct taylor_result taylor_run(int across, int along);
/* Rows that both cases of it have, of such a run. */
void taylor_rows(const struct taylor_result *result, int across, int along);

#endif
