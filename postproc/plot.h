/*
 * Line plots as SVG: panels one below the other, each with its axes, curves, level bands and a
 * legend.
 *
 * Arrays and texts are the caller's and must live until plot_write_svg().
 */
#ifndef TREMIE_POSTPROC_PLOT_H
#define TREMIE_POSTPROC_PLOT_H

#include <stdbool.h>

enum { PLOT_PANELS_MAX = 4, PLOT_CURVES_MAX = 24, PLOT_BANDS_MAX = 24, PLOT_COLOURS = 8 };

struct plot_curve {
    const char *label; /* NULL: not in the legend */
    int n;
    const double *x, *y;
    int colour; /* number in the palette */
    bool dashed;
    bool steps; /* y[i] holds from x[i-1] to x[i] */
};

/* A rectangle behind the curves. */
struct plot_band {
    double x[2], y[2]; /* infinite: to the panel's edge */
    int colour;
};

struct plot_panel {
    const char *x_label, *y_label;
    int n_curves, n_bands;
    struct plot_curve curves[PLOT_CURVES_MAX];
    struct plot_band bands[PLOT_BANDS_MAX];
};

struct plot {
    const char *title;
    int n_panels;
    struct plot_panel panels[PLOT_PANELS_MAX];
};

/* What does not fit the table is left out of a picture that nobody could read. */
void plot_add_curve(struct plot_panel *panel, struct plot_curve curve);
void plot_add_band(struct plot_panel *panel, struct plot_band band);
/* Returns a REPORT_ status, the reason said. */
int plot_write_svg(const struct plot *plot, const char *path);

#endif
