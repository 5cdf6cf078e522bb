/* Round numbers along an axis: multiples of 1, 2 or 5 times a power of ten. */
#ifndef TREMIE_POSTPROC_TICKS_H
#define TREMIE_POSTPROC_TICKS_H

enum { TICKS_MAX = 16, TICKS_TEXT_SIZE = 32 };

struct ticks {
    int n;
    double values[TICKS_MAX];
    char texts[TICKS_MAX][TICKS_TEXT_SIZE];
};

/* About `wanted` (2 to 8) ticks within [least, most], least < most. */
struct ticks ticks_between(double least, double most, int wanted);
/* Along a logarithmic axis from 10^least to 10^most: powers of ten, with 2 and 5 times them
 * where it is short. */
struct ticks ticks_of_decades(double least, double most);
/* The least round number (1, 2, 2.5, 5 times a power of ten) that is not below `value` > 0. */
double ticks_round_up(double value);

#endif
