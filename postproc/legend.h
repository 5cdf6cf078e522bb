/* What the colours of a picture mean: a bar with numbers, or swatches with names. */
#ifndef TREMIE_POSTPROC_LEGEND_H
#define TREMIE_POSTPROC_LEGEND_H

#include "canvas.h"

struct legend {
    const char *title;  /* with its unit */
    double least, most; /* of the bar */
    int n_names;        /* > 0: swatches instead of a bar */
    const char *const *names;
};

/* Draws it into this part of the canvas, text of this height [samples]. */
void legend_draw(struct canvas *canvas, const struct legend *legend, struct camera_frame frame,
                 double height);

#endif
