/*
 * Plots as SVG: panels one below the other, each with its axes, which may be logarithmic,
 * curves, their scatter, level bands, reference lines and a legend.
 *
 * Arrays and texts are the caller's and must live until plot_write_svg().  Values that are not
 * finite, or not positive on a logarithmic axis, leave a gap.
 */
#ifndef TREMIE_POSTPROC_PLOT_H
#define TREMIE_POSTPROC_PLOT_H

#include <stdbool.h>

enum {
    PLOT_PANELS_MAX = 6,
    PLOT_CURVES_MAX = 24,
    PLOT_BANDS_MAX = 24,
    PLOT_LINES_MAX = 8,
    PLOT_COLOURS = 8
};

struct plot_curve {
    const char *label; /* NULL: not in the legend */
    int n;
    const double *x, *y;
    int colour; /* number in the palette */
    bool dashed;
    bool steps;   /* y[i] holds from x[i-1] to x[i] */
    bool markers; /* a dot at each value */
    bool bare;    /* no line between values */
    /* Where the values scatter; NULL: nothing shown.  A band, or bars at each value. */
    const double *low, *high;
    bool bars;
};

/* A rectangle behind the curves. */
struct plot_band {
    double x[2], y[2]; /* infinite: to the panel's edge */
    int colour;
};

/* A straight line across the panel that values are held against. */
struct plot_line {
    const char *label; /* beside it; NULL: none */
    bool upright;      /* at this x, else at this y */
    double at;
};

struct plot_panel {
    const char *x_label, *y_label;
    const char *heading; /* above the panel; NULL: none */
    bool log_x, log_y;
    double x_range[2], y_range[2]; /* equal: what the curves need */
    int n_curves, n_bands, n_lines;
    struct plot_curve curves[PLOT_CURVES_MAX];
    struct plot_band bands[PLOT_BANDS_MAX];
    struct plot_line lines[PLOT_LINES_MAX];
};

struct plot {
    const char *title;
    bool legend_beside; /* right of the panels, else within them */
    int n_panels;
    struct plot_panel panels[PLOT_PANELS_MAX];
};

/* What does not fit the table is left out of a picture that nobody could read. */
void plot_add_curve(struct plot_panel *panel, struct plot_curve curve);
void plot_add_band(struct plot_panel *panel, struct plot_band band);
void plot_add_line(struct plot_panel *panel, struct plot_line line);
/* Returns a REPORT_ status, the reason said. */
int plot_write_svg(const struct plot *plot, const char *path);

#endif
