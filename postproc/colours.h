/*
 * Colours of pictures: a scale for numbers, from dark violet over teal to yellow, whose
 * lightness grows evenly (so that it also reads in grey and for most colour-blind people), and
 * a palette for kinds.
 */
#ifndef TREMIE_POSTPROC_COLOURS_H
#define TREMIE_POSTPROC_COLOURS_H

struct colours_rgb {
    float r, g, b; /* 0 to 1, as displayed */
};

enum { COLOURS_KINDS = 10 };

/* `share` from 0 to 1; outside it the end's colour. */
struct colours_rgb colours_of_share(double share);
/* Repeats after COLOURS_KINDS. */
struct colours_rgb colours_of_kind(int kind);

#endif
