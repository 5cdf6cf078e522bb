/* See legend.h. */
#include "legend.h"

#include "ticks.h"

enum { NAMES_SHOWN = 16 };
static const struct colours_rgb INK = {0.17f, 0.19f, 0.22f};

static void draw_bar(struct canvas *canvas, const struct legend *legend,
                     struct camera_frame frame, double height)
{
    const double left = frame.left, right = left + 1.5 * height;
    const int n = (int)(frame.bottom - frame.top);
    for (int i = 0; i < n; i++)
        canvas_rectangle(canvas, left, frame.bottom - i - 1, right, frame.bottom - i,
                         colours_of_share((i + 0.5) / n));
    const struct ticks ticks = ticks_between(legend->least, legend->most, 5);
    for (int i = 0; i < ticks.n; i++) {
        const double share = (ticks.values[i] - legend->least) / (legend->most - legend->least);
        const double y = frame.bottom - share * (frame.bottom - frame.top);
        canvas_stroke(canvas, (const double[2]){right, y},
                      (const double[2]){right + 0.4 * height, y}, 0.12 * height, INK);
        canvas_text(canvas, right + 0.9 * height, y + 0.5 * height, height, CANVAS_LEFT, INK,
                    ticks.texts[i]);
    }
}

static void draw_swatches(struct canvas *canvas, const struct legend *legend,
                          struct camera_frame frame, double height)
{
    for (int i = 0; i < legend->n_names && i < NAMES_SHOWN; i++) {
        const double base = frame.top + (2.0 * i + 1.0) * height;
        canvas_rectangle(canvas, frame.left, base - 1.1 * height, frame.left + 1.2 * height,
                         base + 0.1 * height, colours_of_kind(i));
        canvas_text(canvas, frame.left + 1.8 * height, base, height, CANVAS_LEFT, INK,
                    i == NAMES_SHOWN - 1 ? "..." : legend->names[i]);
    }
}

void legend_draw(struct canvas *canvas, const struct legend *legend, struct camera_frame frame,
                 double height)
{
    canvas_text(canvas, frame.left, frame.top - 1.4 * height, height, CANVAS_LEFT, INK,
                legend->title);
    if (legend->n_names > 0)
        draw_swatches(canvas, legend, frame, height);
    else
        draw_bar(canvas, legend, frame, height);
}
