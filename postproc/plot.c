/* See plot.h. */
#include "plot.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/report.h"
#include "ticks.h"

enum {
    WIDTH = 860,
    PANEL_HEIGHT = 300,
    LEFT = 86,
    RIGHT = 24,
    TOP = 44,
    GAP = 62,
    LEGEND_STEP = 17
};

static const char *const palette[PLOT_COLOURS] = {"#2b6ca3", "#c8553d", "#3d8b5f", "#8a5aa8",
                                                  "#b8862b", "#3a9aa5", "#9a4a6a", "#5c636e"};

/* A panel's place on the page and the numbers at its edges. */
struct frame {
    double left, right, top, bottom; /* [SVG units] */
    double x[2], y[2];
};

void plot_add_curve(struct plot_panel *panel, struct plot_curve curve)
{
    if (panel->n_curves < PLOT_CURVES_MAX)
        panel->curves[panel->n_curves++] = curve;
}

void plot_add_band(struct plot_panel *panel, struct plot_band band)
{
    if (panel->n_bands < PLOT_BANDS_MAX)
        panel->bands[panel->n_bands++] = band;
}

static const char *colour_of(int colour)
{
    return palette[colour % PLOT_COLOURS];
}

static void write_text(FILE *stream, double x, double y, const char *style, const char *text)
{
    fprintf(stream, "<text x=\"%.1f\" y=\"%.1f\" %s>", x, y, style);
    for (; *text != '\0'; text++) {
        if (*text == '<')
            fputs("&lt;", stream);
        else if (*text == '>')
            fputs("&gt;", stream);
        else if (*text == '&')
            fputs("&amp;", stream);
        else if ((unsigned char)*text >= ' ')
            fputc(*text, stream);
    }
    fputs("</text>\n", stream);
}

static void extend(double range[2], int n, const double *values)
{
    for (int i = 0; i < n; i++) {
        if (values[i] < range[0])
            range[0] = values[i];
        if (isfinite(values[i]) && values[i] > range[1])
            range[1] = values[i];
    }
}

/* A range that is empty or a single number gets some width; others this share of it as air
 * above, and below where they go below zero. */
static void relax(double range[2], double air)
{
    if (!(range[0] <= range[1])) {
        range[0] = 0.0;
        range[1] = 1.0;
    }
    const double width = range[1] - range[0];
    const double least = 1e-12 * (fabs(range[0]) + fabs(range[1]));
    if (!(width > least)) {
        const double half = range[0] != 0.0 ? 0.1 * fabs(range[0]) : 0.5;
        range[0] -= half;
        range[1] += half;
        return;
    }
    range[1] += air * width;
    if (range[0] < 0.0)
        range[0] -= air * width;
}

static struct frame frame_of(const struct plot_panel *panel, int index)
{
    const double top = TOP + index * (PANEL_HEIGHT + GAP);
    struct frame frame = {
        LEFT, WIDTH - RIGHT, top, top + PANEL_HEIGHT, {INFINITY, -INFINITY}, {0.0, -INFINITY}};
    double legend = 0.0; /* its height as a share of the panel's */
    for (int i = 0; i < panel->n_curves; i++) {
        extend(frame.x, panel->curves[i].n, panel->curves[i].x);
        extend(frame.y, panel->curves[i].n, panel->curves[i].y);
        legend += panel->curves[i].label != NULL ? (double)LEGEND_STEP / PANEL_HEIGHT : 0.0;
    }
    relax(frame.x, 0.0);
    relax(frame.y, 0.06 + 1.2 * (legend < 0.5 ? legend : 0.5));
    return frame;
}

static double page_x(const struct frame *frame, double x)
{
    const double share = (x - frame->x[0]) / (frame->x[1] - frame->x[0]);
    const double inside = share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0;
    return frame->left + inside * (frame->right - frame->left);
}

static double page_y(const struct frame *frame, double y)
{
    const double share = (y - frame->y[0]) / (frame->y[1] - frame->y[0]);
    const double inside = share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0;
    return frame->bottom - inside * (frame->bottom - frame->top);
}

static void write_axes(FILE *stream, const struct plot_panel *panel, const struct frame *frame)
{
    const struct ticks across = ticks_between(frame->x[0], frame->x[1], 8);
    const struct ticks upwards = ticks_between(frame->y[0], frame->y[1], 5);
    for (int i = 0; i < across.n; i++) {
        const double x = page_x(frame, across.values[i]);
        fprintf(stream, "<path d=\"M%.1f %.1fV%.1f\" stroke=\"#e4e7eb\"/>\n", x, frame->top,
                frame->bottom);
        write_text(stream, x, frame->bottom + 17, "text-anchor=\"middle\"", across.texts[i]);
    }
    for (int i = 0; i < upwards.n; i++) {
        const double y = page_y(frame, upwards.values[i]);
        fprintf(stream, "<path d=\"M%.1f %.1fH%.1f\" stroke=\"#e4e7eb\"/>\n", frame->left, y,
                frame->right);
        write_text(stream, frame->left - 7, y + 4, "text-anchor=\"end\"", upwards.texts[i]);
    }
    fprintf(stream, "<path d=\"M%.1f %.1fV%.1fH%.1f\" fill=\"none\" stroke=\"#5c636e\"/>\n",
            frame->left, frame->top, frame->bottom, frame->right);
    write_text(stream, 0.5 * (frame->left + frame->right), frame->bottom + 36,
               "text-anchor=\"middle\"", panel->x_label);
    char style[96];
    const double middle = 0.5 * (frame->top + frame->bottom);
    snprintf(style, sizeof style, "text-anchor=\"middle\" transform=\"rotate(-90 20 %.1f)\"",
             middle);
    write_text(stream, 20, middle, style, panel->y_label);
}

static void write_band(FILE *stream, const struct frame *frame, const struct plot_band *band)
{
    const double left = page_x(frame, band->x[0]), right = page_x(frame, band->x[1]);
    const double top = page_y(frame, band->y[1]), bottom = page_y(frame, band->y[0]);
    fprintf(
        stream,
        "<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"%s\" fill-opacity=\"0.13\"/>\n",
        left, top, right - left, bottom - top, colour_of(band->colour));
}

static void write_curve(FILE *stream, const struct frame *frame, const struct plot_curve *curve)
{
    char pen = 'M'; /* lifted where a value is not a number */
    fputs("<path d=\"", stream);
    for (int i = 0; i < curve->n; i++) {
        if (!isfinite(curve->x[i]) || !isfinite(curve->y[i])) {
            pen = 'M';
            continue;
        }
        const double x = page_x(frame, curve->x[i]), y = page_y(frame, curve->y[i]);
        if (curve->steps && i > 0)
            fprintf(stream, "%c%.2f %.2f", pen, page_x(frame, curve->x[i - 1]), y);
        fprintf(stream, "%c%.2f %.2f", curve->steps && i > 0 ? 'L' : pen, x, y);
        pen = 'L';
    }
    fprintf(
        stream,
        "\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.6\" stroke-linejoin=\"round\"%s/>\n",
        colour_of(curve->colour), curve->dashed ? " stroke-dasharray=\"6 4\"" : "");
}

static void write_legend(FILE *stream, const struct plot_panel *panel,
                         const struct frame *frame)
{
    double y = frame->top + 14;
    for (int i = 0; i < panel->n_curves; i++) {
        const struct plot_curve *curve = &panel->curves[i];
        if (curve->label == NULL)
            continue;
        fprintf(stream, "<path d=\"M%.1f %.1fh24\" stroke=\"%s\" stroke-width=\"2\"%s/>\n",
                frame->left + 12, y, colour_of(curve->colour),
                curve->dashed ? " stroke-dasharray=\"6 4\"" : "");
        write_text(stream, frame->left + 43, y + 4,
                   "paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"3\"",
                   curve->label);
        y += LEGEND_STEP;
    }
}

static void write_panel(FILE *stream, const struct plot_panel *panel, int index)
{
    const struct frame frame = frame_of(panel, index);
    write_axes(stream, panel, &frame);
    for (int i = 0; i < panel->n_bands; i++)
        write_band(stream, &frame, &panel->bands[i]);
    for (int i = 0; i < panel->n_curves; i++)
        write_curve(stream, &frame, &panel->curves[i]);
    write_legend(stream, panel, &frame);
}

int plot_write_svg(const struct plot *plot, const char *path)
{
    FILE *stream = fopen(path, "w");
    if (stream == NULL) {
        report_error("cannot write %s: %s; check the folder", path, strerror(errno));
        return REPORT_STORAGE;
    }
    const int height = TOP + plot->n_panels * (PANEL_HEIGHT + GAP);
    fprintf(
        stream,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\" "
        "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"12.5\" fill=\"#2b2f36\">\n"
        "<rect width=\"%d\" height=\"%d\" fill=\"#ffffff\"/>\n",
        WIDTH, height, WIDTH, height, WIDTH, height);
    write_text(stream, LEFT, 26, "font-size=\"16\"", plot->title);
    for (int i = 0; i < plot->n_panels; i++)
        write_panel(stream, &plot->panels[i], i);
    fputs("</svg>\n", stream);
    const bool failed = ferror(stream) != 0;
    if (fclose(stream) != 0 || failed) {
        report_error("cannot write all of %s: %s; check the space on its disk", path,
                     strerror(errno));
        return REPORT_STORAGE;
    }
    return REPORT_FINISHED;
}
