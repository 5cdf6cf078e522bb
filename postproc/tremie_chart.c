/*
 * tremie-chart: draws columns of a CSV file against each other.
 *
 * Rows that agree in the columns --group and --dash are one curve, in the order of the file; a
 * row whose cell is empty is not on the curve, one that says nan leaves a gap.  Lists in an
 * option are separated by commas, what differs from panel to panel by semicolons, the last part
 * holding for the panels that follow, so names with these characters cannot be given.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "base/array.h"
#include "base/report.h"
#include "plot.h"
#include "sheet.h"

enum { NOTHING_TO_DRAW = 1, GREY = PLOT_COLOURS - 1 /* rows without a group */ };

struct wishes {
    const char *path, *out, *title;
    const char *x, *y, *low, *high, *group, *dash, *panel, *where, *points;
    const char *log, *x_range, *y_range, *mark_x, *mark_y, *x_label, *y_label;
    bool bars, markers;
};

/* Texts that differ, in the order they were met. */
struct words {
    int n, capacity;
    const char **list;
};

struct chart {
    struct wishes wishes;
    struct sheet sheet;
    int n_rows;
    int group, dash, panel; /* columns; -1: none */
    struct words groups, dashes, panels;
    struct plot plot;
    int n_kept, kept_capacity;
    void **kept; /* what the plot points to */
};

/* ------------------------------------------------------------------------------------ words */

/* Remembers what is to be freed at the end. */
static void *keep(struct chart *chart, void *pointer)
{
    ARRAY_GROW(chart->kept, chart->n_kept + 1, chart->kept_capacity);
    chart->kept[chart->n_kept++] = pointer;
    return pointer;
}

static int word_index(struct words *words, const char *text)
{
    for (int i = 0; i < words->n; i++)
        if (strcmp(words->list[i], text) == 0)
            return i;
    ARRAY_GROW(words->list, words->n + 1, words->capacity);
    words->list[words->n] = text;
    return words->n++;
}

static int count_parts(const char *text, char separator)
{
    int n = 1;
    for (; *text != '\0'; text++)
        n += *text == separator;
    return n;
}

/* The k-th of the parts of a text; NULL where there are fewer. */
static char *part(struct chart *chart, const char *text, char separator, int k)
{
    for (; text != NULL && k > 0; k--) {
        text = strchr(text, separator);
        text = text != NULL ? text + 1 : NULL;
    }
    if (text == NULL)
        return NULL;
    char *copy = keep(chart, array_string(text));
    copy[strcspn(copy, (const char[]){separator, '\0'})] = '\0';
    return copy;
}

/* What an option says of a panel: its own part, or the last. */
static char *of_panel(struct chart *chart, const char *text, int k)
{
    if (text == NULL)
        return NULL;
    const int n = count_parts(text, ';');
    return part(chart, text, ';', k < n ? k : n - 1);
}

/* Cuts `name=label` in two; without a label the name is one. */
static const char *cut_label(char *text)
{
    char *equals = strchr(text, '=');
    if (equals == NULL)
        return text;
    *equals = '\0';
    return equals + 1;
}

/* ------------------------------------------------------------------------------------ cells */

static const char *cell(const struct chart *chart, int row, int column)
{
    return column >= 0 ? chart->sheet.cells[row * chart->sheet.n_columns + column] : "";
}

static bool find_column(const struct chart *chart, const char *name, int *column)
{
    *column = -1;
    if (name == NULL || name[0] == '\0')
        return true;
    *column = sheet_column(&chart->sheet, name);
    if (*column >= 0)
        return true;
    report_error("%s has no column \"%s\"; see its first line", chart->wishes.path, name);
    return false;
}

static bool read_number(const struct chart *chart, const char *text, double *number)
{
    char *end;
    *number = strtod(text, &end);
    if (end != text && *end == '\0')
        return true;
    report_error("%s: \"%s\" is to be drawn; a number is expected", chart->wishes.path, text);
    return false;
}

static bool is_listed(struct chart *chart, const char *list, char separator, const char *text)
{
    for (int k = 0; list != NULL && k < count_parts(list, separator); k++)
        if (strcmp(part(chart, list, separator, k), text) == 0)
            return true;
    return false;
}

/* Does a row agree with all of NAME=VALUE|VALUE,NAME=VALUE? */
static bool passes(struct chart *chart, int row, const char *where, bool *agrees)
{
    *agrees = true;
    for (int k = 0; where != NULL && *where != '\0' && k < count_parts(where, ','); k++) {
        char *name = part(chart, where, ',', k);
        const char *value = cut_label(name);
        int column;
        if (!find_column(chart, name, &column))
            return false;
        *agrees = *agrees && is_listed(chart, value, '|', cell(chart, row, column));
    }
    return true;
}

/* ----------------------------------------------------------------------------------- curves */

/* What the curves of a panel are made of. */
struct source {
    int x, y, low, high; /* columns; -1: none */
    const char *name;    /* of y */
    bool named;          /* in the legend: there are several */
    int index;           /* among the y of the panel */
    bool bare;
    bool *chosen; /* rows of the panel */
};

/* Rows of one curve, `numbers` in the order x, y, low, high. */
static bool gather(struct chart *chart, const struct source *source, int group, int dash,
                   struct plot_curve *curve)
{
    const int columns[4] = {source->x, source->y, source->low, source->high};
    double *numbers[4];
    for (int k = 0; k < 4; k++)
        numbers[k] =
            columns[k] < 0
                ? NULL
                : keep(chart, array_allocate((size_t)chart->n_rows + 1, sizeof(double)));
    for (int row = 0; row < chart->n_rows; row++) {
        const bool ours = source->chosen[row] && cell(chart, row, source->y)[0] != '\0' &&
                          word_index(&chart->groups, cell(chart, row, chart->group)) == group &&
                          word_index(&chart->dashes, cell(chart, row, chart->dash)) == dash;
        for (int k = 0; ours && k < 4; k++)
            if (columns[k] >= 0 &&
                !read_number(chart, cell(chart, row, columns[k]), &numbers[k][curve->n]))
                return false;
        curve->n += ours;
    }
    curve->x = numbers[0];
    curve->y = numbers[1];
    curve->low = numbers[2];
    curve->high = numbers[3];
    return true;
}

/* Names of y, group and dash where there are several of each; NULL where nothing differs. */
static char *legend_of(struct chart *chart, const struct source *source, int group, int dash)
{
    const char *words[3] = {source->named ? source->name : "", chart->groups.list[group],
                            chart->dashes.list[dash]};
    char *label = NULL;
    for (int k = 0; k < 3; k++)
        if (words[k][0] != '\0')
            label = keep(chart, label == NULL ? array_string(words[k])
                                              : array_format("%s, %s", label, words[k]));
    return label;
}

static bool add_curves(struct chart *chart, struct plot_panel *panel,
                       const struct source *source)
{
    const int n_groups = chart->groups.n, n_dashes = chart->dashes.n;
    for (int k = 0; k < n_groups * n_dashes; k++) {
        const int group = k / n_dashes, dash = k % n_dashes;
        const bool stray = chart->group >= 0 && chart->groups.list[group][0] == '\0';
        struct plot_curve curve = {.colour = stray ? GREY : group + source->index * n_groups,
                                   .dashed = dash > 0,
                                   .markers = chart->wishes.markers || source->bare,
                                   .bare = source->bare,
                                   .bars = chart->wishes.bars};
        if (!gather(chart, source, group, dash, &curve))
            return false;
        curve.label = legend_of(chart, source, group, dash);
        if (curve.n > 0)
            plot_add_curve(panel, curve);
    }
    return true;
}

/* ----------------------------------------------------------------------------------- panels */

static bool choose_rows(struct chart *chart, int k, int facet, bool *chosen)
{
    const char *where = of_panel(chart, chart->wishes.where, k);
    for (int row = 0; row < chart->n_rows; row++) {
        if (!passes(chart, row, where, &chosen[row]))
            return false;
        chosen[row] =
            chosen[row] && word_index(&chart->panels, cell(chart, row, chart->panel)) == facet;
    }
    return true;
}

static bool take_range(struct chart *chart, const char *text, double range[2])
{
    if (text == NULL || *text == '\0')
        return true;
    if (count_parts(text, ':') == 2 && read_number(chart, part(chart, text, ':', 0), range) &&
        read_number(chart, part(chart, text, ':', 1), range + 1) && range[0] < range[1])
        return true;
    report_error("\"%s\" is no range; give LEAST:MOST", text);
    return false;
}

static bool add_marks(struct chart *chart, struct plot_panel *panel, const char *text,
                      bool upright)
{
    for (int k = 0; text != NULL && *text != '\0' && k < count_parts(text, ','); k++) {
        char *at = part(chart, text, ',', k);
        const char *label = cut_label(at);
        struct plot_line line = {.label = label == at ? NULL : label, .upright = upright};
        if (!read_number(chart, at, &line.at))
            return false;
        plot_add_line(panel, line);
    }
    return true;
}

static bool add_all_curves(struct chart *chart, struct plot_panel *panel, int k,
                           const char *names, struct source source)
{
    const struct wishes *wishes = &chart->wishes;
    const char *low = of_panel(chart, wishes->low, k), *high = of_panel(chart, wishes->high, k);
    source.named = count_parts(names, ',') > 1;
    for (; source.index < count_parts(names, ','); source.index++) {
        char *name = part(chart, names, ',', source.index);
        source.name = cut_label(name);
        source.bare = is_listed(chart, wishes->points, ',', name);
        if (!find_column(chart, name, &source.y) ||
            !find_column(chart, part(chart, low, ',', source.index), &source.low) ||
            !find_column(chart, part(chart, high, ',', source.index), &source.high) ||
            !add_curves(chart, panel, &source))
            return false;
    }
    return true;
}

/* The k-th part of --y, for the rows that have this value in the column --panel. */
static bool add_panel(struct chart *chart, int k, int facet)
{
    const struct wishes *wishes = &chart->wishes;
    if (chart->plot.n_panels == PLOT_PANELS_MAX) {
        report_error("more than %d panels are asked for; draw some in another file",
                     PLOT_PANELS_MAX);
        return false;
    }
    struct plot_panel *panel = &chart->plot.panels[chart->plot.n_panels++];
    const char *x = of_panel(chart, wishes->x, k), *names = part(chart, wishes->y, ';', k);
    const char *log = of_panel(chart, wishes->log, k);
    const char *x_label = of_panel(chart, wishes->x_label, k);
    const char *y_label = of_panel(chart, wishes->y_label, k);
    panel->x_label = x_label != NULL ? x_label : x;
    panel->y_label = y_label != NULL ? y_label : names;
    panel->log_x = log != NULL && strchr(log, 'x') != NULL;
    panel->log_y = log != NULL && strchr(log, 'y') != NULL;
    panel->heading = chart->panel >= 0 ? chart->panels.list[facet] : NULL;
    struct source source = {
        .chosen = keep(chart, array_allocate((size_t)chart->n_rows + 1, sizeof(bool)))};
    return find_column(chart, x, &source.x) &&
           take_range(chart, of_panel(chart, wishes->x_range, k), panel->x_range) &&
           take_range(chart, of_panel(chart, wishes->y_range, k), panel->y_range) &&
           add_marks(chart, panel, of_panel(chart, wishes->mark_x, k), true) &&
           add_marks(chart, panel, of_panel(chart, wishes->mark_y, k), false) &&
           choose_rows(chart, k, facet, source.chosen) &&
           add_all_curves(chart, panel, k, names, source);
}

/* ------------------------------------------------------------------------------------ chart */

static void meet_words(struct chart *chart)
{
    for (int row = 0; row < chart->n_rows; row++) {
        word_index(&chart->groups, cell(chart, row, chart->group));
        word_index(&chart->dashes, cell(chart, row, chart->dash));
        word_index(&chart->panels, cell(chart, row, chart->panel));
    }
}

static int draw(struct chart *chart)
{
    const struct wishes *wishes = &chart->wishes;
    const int status = sheet_read_csv(&chart->sheet, wishes->path);
    if (status != REPORT_FINISHED)
        return status;
    chart->n_rows = chart->sheet.n_cells / chart->sheet.n_columns;
    if (!find_column(chart, wishes->group, &chart->group) ||
        !find_column(chart, wishes->dash, &chart->dash) ||
        !find_column(chart, wishes->panel, &chart->panel))
        return REPORT_BAD_INPUT;
    meet_words(chart);
    const int n_parts = count_parts(wishes->y, ';');
    int n_curves = 0;
    for (int i = 0; i < chart->panels.n * n_parts; i++) {
        if (!add_panel(chart, i % n_parts, i / n_parts))
            return REPORT_BAD_INPUT;
        n_curves += chart->plot.panels[i].n_curves;
    }
    if (n_curves == 0) {
        printf("%s has no rows to draw\n", wishes->path);
        return NOTHING_TO_DRAW;
    }
    chart->plot.title = wishes->title;
    chart->plot.legend_beside = true;
    return plot_write_svg(&chart->plot, wishes->out);
}

static void clear(struct chart *chart)
{
    for (int i = 0; i < chart->n_kept; i++)
        free(chart->kept[i]);
    free(chart->kept);
    free(chart->groups.list);
    free(chart->dashes.list);
    free(chart->panels.list);
    sheet_clear(&chart->sheet);
}

static int read_wishes(struct wishes *wishes, int argc, char **argv)
{
    const struct arguments_entry entries[] = {
        {"out", 'o', ARGUMENTS_TEXT, &wishes->out, "FILE", "the picture, SVG", NULL},
        {"x", 0, ARGUMENTS_TEXT, &wishes->x, "COLUMN;..", "across", NULL},
        {"y", 0, ARGUMENTS_TEXT, &wishes->y, "COLUMN[=NAME],..;..", "upwards", NULL},
        {"low", 0, ARGUMENTS_TEXT, &wishes->low, "COLUMN,..;..",
         "where the scatter of y begins, in the order of --y", NULL},
        {"high", 0, ARGUMENTS_TEXT, &wishes->high, "COLUMN,..;..", "where it ends", NULL},
        {"group", 0, ARGUMENTS_TEXT, &wishes->group, "COLUMN", "a curve and colour a value",
         NULL},
        {"dash", 0, ARGUMENTS_TEXT, &wishes->dash, "COLUMN",
         "a curve a value, dashed but for the first", NULL},
        {"panel", 0, ARGUMENTS_TEXT, &wishes->panel, "COLUMN", "a panel a value", NULL},
        {"where", 0, ARGUMENTS_TEXT, &wishes->where, "COLUMN=VALUE|..,..;..",
         "takes only rows that agree with all of these", NULL},
        {"log", 0, ARGUMENTS_TEXT, &wishes->log, "x|y|xy;..", "logarithmic axes", NULL},
        {"markers", 0, ARGUMENTS_FLAG, &wishes->markers, NULL, "a dot at each value", NULL},
        {"points", 0, ARGUMENTS_TEXT, &wishes->points, "COLUMN,..",
         "these of --y as dots without lines", NULL},
        {"bars", 0, ARGUMENTS_FLAG, &wishes->bars, NULL, "scatter as bars, else as a band",
         NULL},
        {"mark-x", 0, ARGUMENTS_TEXT, &wishes->mark_x, "X[=LABEL],..;..",
         "upright reference lines", NULL},
        {"mark-y", 0, ARGUMENTS_TEXT, &wishes->mark_y, "Y[=LABEL],..;..",
         "level reference lines", NULL},
        {"x-range", 0, ARGUMENTS_TEXT, &wishes->x_range, "A:B;..", "ends of the axis", NULL},
        {"y-range", 0, ARGUMENTS_TEXT, &wishes->y_range, "A:B;..", "ends of the axis", NULL},
        {"x-label", 0, ARGUMENTS_TEXT, &wishes->x_label, "TEXT;..",
         "below the axis, else the column's name", NULL},
        {"y-label", 0, ARGUMENTS_TEXT, &wishes->y_label, "TEXT;..", "beside the axis", NULL},
        {"title", 0, ARGUMENTS_TEXT, &wishes->title, "TEXT", "above all", NULL},
    };
    const struct arguments_page page = {
        "tremie-chart",
        "FILE.csv -o FILE.svg --x COLUMN --y COLUMN [options]",
        "Draws columns of a CSV file, whose first line names them; lines that start with # are passed\n"
        "over.  Rows are joined in the order of the file.  Parts between commas are several curves,\n"
        "parts between semicolons several panels; the last part holds for the panels that follow.  An\n"
        "empty cell is not on the curve, nan leaves a gap.\n"
        "\n"
        "Exit status: 0 drawn; 1 no rows to draw; 2 bad arguments or cells; 4 a file cannot be read\n"
        "or written.\n",
        sizeof entries / sizeof *entries,
        entries,
        1,
        1};
    int n;
    const int status = arguments_read(&page, argc, argv, &n);
    if (status != ARGUMENTS_GO_ON)
        return status;
    wishes->path = argv[1];
    if (wishes->out != NULL && wishes->x != NULL && wishes->y != NULL)
        return ARGUMENTS_GO_ON;
    report_error("there is no name for the picture, or no column; give -o, --x and --y");
    return REPORT_BAD_INPUT;
}

int main(int argc, char **argv)
{
    struct chart chart = {.wishes = {.title = ""}};
    int status = read_wishes(&chart.wishes, argc, argv);
    if (status != ARGUMENTS_GO_ON)
        return status;
    sheet_init(&chart.sheet);
    status = draw(&chart);
    clear(&chart);
    return status;
}
