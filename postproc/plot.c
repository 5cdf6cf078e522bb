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
    BESIDE = 190, /* for legends right of the panels */
    TOP = 44,
    GAP = 66,
    LEGEND_STEP = 17
};

static const char *const palette[PLOT_COLOURS] = {"#2b6ca3", "#c8553d", "#3d8b5f", "#8a5aa8",
                                                  "#b8862b", "#3a9aa5", "#9a4a6a", "#5c636e"};

/* A panel's place on the page and the numbers at its edges, or their logarithms. */
struct frame {
    double left, right, top, bottom; /* [SVG units] */
    double x[2], y[2];
    bool log_x, log_y, legend_beside;
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

void plot_add_line(struct plot_panel *panel, struct plot_line line)
{
    if (panel->n_lines < PLOT_LINES_MAX)
        panel->lines[panel->n_lines++] = line;
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

static double scaled(bool logarithmic, double value)
{
    return logarithmic ? log10(value) : value;
}

static void extend(double range[2], bool logarithmic, int n, const double *values)
{
    for (int i = 0; values != NULL && i < n; i++) {
        const double value = scaled(logarithmic, values[i]);
        if (isfinite(value) && value < range[0])
            range[0] = value;
        if (isfinite(value) && value > range[1])
            range[1] = value;
    }
}

/* A range that is empty or a single number gets some width; others this share of it as air
 * above, and below where they go below zero or `below` asks for it. */
static void relax(double range[2], double air, double below)
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
    if (range[0] < 0.0 && below == 0.0)
        range[0] -= air * width;
    range[0] -= below * width;
}

static void take_range(double range[2], bool logarithmic, const double asked[2])
{
    if (asked[0] == asked[1])
        return;
    range[0] = scaled(logarithmic, asked[0]);
    range[1] = scaled(logarithmic, asked[1]);
}

static struct frame frame_of(const struct plot *plot, int index)
{
    const struct plot_panel *panel = &plot->panels[index];
    const double top = TOP + index * (PANEL_HEIGHT + GAP);
    const double right = WIDTH - (plot->legend_beside ? BESIDE : RIGHT);
    struct frame frame = {LEFT,
                          right,
                          top,
                          top + PANEL_HEIGHT,
                          {INFINITY, -INFINITY},
                          {panel->log_y ? (double)INFINITY : 0.0, -INFINITY},
                          panel->log_x,
                          panel->log_y,
                          plot->legend_beside};
    double legend = 0.0; /* its height as a share of the panel's */
    for (int i = 0; i < panel->n_curves; i++) {
        const struct plot_curve *curve = &panel->curves[i];
        extend(frame.x, panel->log_x, curve->n, curve->x);
        extend(frame.y, panel->log_y, curve->n, curve->y);
        extend(frame.y, panel->log_y, curve->n, curve->low);
        extend(frame.y, panel->log_y, curve->n, curve->high);
        legend += curve->label != NULL ? (double)LEGEND_STEP / PANEL_HEIGHT : 0.0;
    }
    if (plot->legend_beside)
        legend = 0.0;
    const double side = panel->log_x ? 0.03 : 0.0; /* markers are not cut */
    relax(frame.x, side, side);
    relax(frame.y, 0.06 + 1.2 * (legend < 0.5 ? legend : 0.5), panel->log_y ? 0.04 : 0.0);
    take_range(frame.x, panel->log_x, panel->x_range);
    take_range(frame.y, panel->log_y, panel->y_range);
    return frame;
}

static double page_x(const struct frame *frame, double x)
{
    const double value = scaled(frame->log_x, x);
    const double share = (value - frame->x[0]) / (frame->x[1] - frame->x[0]);
    const double inside = share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0;
    return frame->left + inside * (frame->right - frame->left);
}

static double page_y(const struct frame *frame, double y)
{
    const double value = scaled(frame->log_y, y);
    const double share = (value - frame->y[0]) / (frame->y[1] - frame->y[0]);
    const double inside = share > 0.0 ? (share < 1.0 ? share : 1.0) : 0.0;
    return frame->bottom - inside * (frame->bottom - frame->top);
}

static bool can_show(const struct frame *frame, double x, double y)
{
    return isfinite(scaled(frame->log_x, x)) && isfinite(scaled(frame->log_y, y));
}

static struct ticks ticks_of(bool logarithmic, const double range[2], int wanted)
{
    return logarithmic ? ticks_of_decades(range[0], range[1])
                       : ticks_between(range[0], range[1], wanted);
}

static void write_axes(FILE *stream, const struct plot_panel *panel, const struct frame *frame)
{
    const struct ticks across = ticks_of(frame->log_x, frame->x, 8);
    const struct ticks upwards = ticks_of(frame->log_y, frame->y, 5);
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
    if (panel->heading != NULL)
        write_text(stream, frame->left, frame->top - 6, "font-weight=\"bold\"", panel->heading);
}

static void write_line(FILE *stream, const struct frame *frame, const struct plot_line *line)
{
    static const char style[] = "stroke=\"#5c636e\" stroke-dasharray=\"2 3\"";
    const double *range = line->upright ? frame->x : frame->y;
    const double value = scaled(line->upright ? frame->log_x : frame->log_y, line->at);
    if (!(value >= range[0] && value <= range[1]))
        return;
    if (line->upright) {
        const double x = page_x(frame, line->at);
        fprintf(stream, "<path d=\"M%.2f %.1fV%.1f\" %s/>\n", x, frame->top, frame->bottom,
                style);
        if (line->label != NULL)
            write_text(stream, x + 4, frame->top + 12, "font-size=\"11\"", line->label);
        return;
    }
    const double y = page_y(frame, line->at);
    fprintf(stream, "<path d=\"M%.1f %.2fH%.1f\" %s/>\n", frame->left, y, frame->right, style);
    if (line->label != NULL)
        write_text(stream, frame->right - 4, y - 4, "text-anchor=\"end\" font-size=\"11\"",
                   line->label);
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

/* Where a curve's values scatter: a band, or a bar at each. */
static void write_scatter(FILE *stream, const struct frame *frame,
                          const struct plot_curve *curve)
{
    if (curve->low == NULL || curve->high == NULL)
        return;
    for (int i = 0; curve->bars && i < curve->n; i++) {
        if (!can_show(frame, curve->x[i], curve->high[i]))
            continue;
        const double x = page_x(frame, curve->x[i]);
        const double low = page_y(frame, curve->low[i]), high = page_y(frame, curve->high[i]);
        fprintf(stream, "<path d=\"M%.2f %.2fV%.2fM%.2f %.2fh6M%.2f %.2fh6\" stroke=\"%s\"/>\n",
                x, low, high, x - 3, low, x - 3, high, colour_of(curve->colour));
    }
    if (curve->bars)
        return;
    char pen = 'M';
    fputs("<path d=\"", stream);
    for (int k = 0; k < 2 * curve->n; k++) {
        const int i = k < curve->n ? k : 2 * curve->n - 1 - k;
        if (!can_show(frame, curve->x[i], curve->high[i]))
            continue;
        fprintf(stream, "%c%.2f %.2f", pen, page_x(frame, curve->x[i]),
                page_y(frame, k < curve->n ? curve->high[i] : curve->low[i]));
        pen = 'L';
    }
    fprintf(stream, "\" fill=\"%s\" fill-opacity=\"0.16\"/>\n", colour_of(curve->colour));
}

static void write_markers(FILE *stream, const struct frame *frame,
                          const struct plot_curve *curve)
{
    for (int i = 0; curve->markers && i < curve->n; i++)
        if (can_show(frame, curve->x[i], curve->y[i]))
            fprintf(
                stream, "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"3\" fill=\"%s\" stroke=\"%s\"/>\n",
                page_x(frame, curve->x[i]), page_y(frame, curve->y[i]),
                curve->dashed ? "#ffffff" : colour_of(curve->colour), colour_of(curve->colour));
}

static void write_curve(FILE *stream, const struct frame *frame, const struct plot_curve *curve)
{
    if (curve->bare)
        return;
    char pen = 'M'; /* lifted where a value is not a number */
    fputs("<path d=\"", stream);
    for (int i = 0; i < curve->n; i++) {
        if (!can_show(frame, curve->x[i], curve->y[i])) {
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
    const double left = frame->legend_beside ? frame->right + 10 : frame->left + 12;
    double y = frame->top + 14;
    for (int i = 0; i < panel->n_curves; i++) {
        const struct plot_curve *curve = &panel->curves[i];
        if (curve->label == NULL)
            continue;
        const char *colour = colour_of(curve->colour);
        if (!curve->bare)
            fprintf(stream, "<path d=\"M%.1f %.1fh24\" stroke=\"%s\" stroke-width=\"2\"%s/>\n",
                    left, y, colour, curve->dashed ? " stroke-dasharray=\"6 4\"" : "");
        if (curve->markers)
            fprintf(stream,
                    "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\" stroke=\"%s\"/>\n",
                    left + 12, y, curve->dashed ? "#ffffff" : colour, colour);
        write_text(stream, left + 31, y + 4,
                   "paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"3\"",
                   curve->label);
        y += LEGEND_STEP;
    }
}

static void write_panel(FILE *stream, const struct plot *plot, int index)
{
    const struct plot_panel *panel = &plot->panels[index];
    const struct frame frame = frame_of(plot, index);
    write_axes(stream, panel, &frame);
    for (int i = 0; i < panel->n_bands; i++)
        write_band(stream, &frame, &panel->bands[i]);
    for (int i = 0; i < panel->n_curves; i++)
        write_scatter(stream, &frame, &panel->curves[i]);
    for (int i = 0; i < panel->n_lines; i++)
        write_line(stream, &frame, &panel->lines[i]);
    for (int i = 0; i < panel->n_curves; i++) {
        write_curve(stream, &frame, &panel->curves[i]);
        write_markers(stream, &frame, &panel->curves[i]);
    }
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
        write_panel(stream, plot, i);
    fputs("</svg>\n", stream);
    const bool failed = ferror(stream) != 0;
    if (fclose(stream) != 0 || failed) {
        report_error("cannot write all of %s: %s; check the space on its disk", path,
                     strerror(errno));
        return REPORT_STORAGE;
    }
    return REPORT_FINISHED;
}
