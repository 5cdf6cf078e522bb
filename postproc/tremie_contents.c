/*
 * tremie-contents: what was in the regions of a run over time, what came in and what was taken
 * out.
 *
 * All of it is in the run's samples, found by the names of their columns: a region has
 * NAME.velocity_x, an insertion NAME.count_inserted, a removal NAME.count_removed; what is of
 * one material has a name like below.material_ore.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "base/array.h"
#include "base/report.h"
#include "plot.h"
#include "records.h"
#include "sheet.h"

enum { ROWS_SHOWN = 20, NOTHING_TO_REPORT = 1 };

enum kind { KIND_CONTENT, KIND_INSERTED, KIND_REMOVED, KIND_LEFT, N_KINDS };

/* The column that tells each kind, and how its number and mass are called. */
static const struct {
    const char *mark, *count, *mass, *word;
} KINDS[N_KINDS] = {
    [KIND_CONTENT] = {".velocity_x", ".count", ".mass", "content"},
    [KIND_INSERTED] = {".count_inserted", ".count_inserted", ".mass_inserted", "came in by"},
    [KIND_REMOVED] = {".count_removed", ".count_removed", ".mass_removed", "taken out by"},
    [KIND_LEFT] = {".count_left", ".count_left", ".mass_left", "left the"},
};

struct entry {
    enum kind kind;
    char *name;
    double *count, *mass; /* [-], [kg] */
    double *velocity[3];  /* of a content [m/s] */
    double *speed;        /* its magnitude */
};

struct contents {
    const char *run;
    bool by_material;
    int n_rows, n_entries;
    double *time; /* [s] */
    struct entry *entries;
};

/* ---------------------------------------------------------------------------------- reading */

static void clear_entry(struct entry *entry)
{
    free(entry->name);
    free(entry->count);
    free(entry->mass);
    for (int k = 0; k < 3; k++)
        free(entry->velocity[k]);
    free(entry->speed);
}

static void clear(struct contents *contents)
{
    for (int e = 0; e < contents->n_entries; e++)
        clear_entry(&contents->entries[e]);
    free(contents->entries);
    free(contents->time);
}

static bool read_velocity(struct entry *entry, const struct series *series)
{
    static const char axes[] = "xyz";
    const size_t n = (size_t)series->n_rows;
    bool whole = true;
    for (int k = 0; k < 3; k++) {
        entry->velocity[k] = records_column(series, "%s.velocity_%c", entry->name, axes[k]);
        whole = whole && entry->velocity[k] != NULL;
    }
    entry->speed = array_allocate(n, sizeof *entry->speed);
    for (size_t i = 0; whole && i < n; i++) {
        const double x = entry->velocity[0][i], y = entry->velocity[1][i],
                     z = entry->velocity[2][i];
        entry->speed[i] = sqrt(x * x + y * y + z * z);
    }
    return whole;
}

static bool read_entry(struct entry *entry, const struct series *series)
{
    entry->count = records_column(series, "%s%s", entry->name, KINDS[entry->kind].count);
    entry->mass = records_column(series, "%s%s", entry->name, KINDS[entry->kind].mass);
    const bool moves = entry->kind != KIND_CONTENT || read_velocity(entry, series);
    return moves && entry->count != NULL && entry->mass != NULL;
}

/* Was there never anything of this part? */
static bool is_idle_part(const struct contents *contents, const struct entry *entry)
{
    bool idle = strchr(entry->name, '.') != NULL;
    for (int i = 0; i < contents->n_rows && idle; i++)
        idle = entry->count[i] == 0.0;
    return idle;
}

static bool has_column(const struct series *series, const char *name, const char *word)
{
    char *column = array_format("%s%s", name, word);
    bool found = false;
    for (int k = 0; k < series->n_columns && !found; k++)
        found = strcmp(series->columns[k].name, column) == 0;
    free(column);
    return found;
}

/* Takes the column as the mark of an entry where it is one.  False when columns lack. */
static bool read_column(struct contents *contents, const struct series *series,
                        const char *column)
{
    const size_t length = strlen(column);
    for (int kind = 0; kind < N_KINDS; kind++) {
        const size_t mark = strlen(KINDS[kind].mark);
        if (length <= mark || strcmp(column + length - mark, KINDS[kind].mark) != 0)
            continue;
        struct entry entry = {.kind = (enum kind)kind, .name = array_string(column)};
        entry.name[length - mark] = '\0';
        if (kind == KIND_CONTENT && !has_column(series, entry.name, KINDS[kind].count)) {
            clear_entry(&entry); /* of a body that moves */
            return true;
        }
        const bool wanted = contents->by_material || strchr(entry.name, '.') == NULL;
        const bool whole = !wanted || read_entry(&entry, series);
        if (wanted && whole && !is_idle_part(contents, &entry))
            contents->entries[contents->n_entries++] = entry;
        else
            clear_entry(&entry);
        return whole;
    }
    return true;
}

static int read_run(struct contents *contents)
{
    struct series series;
    const int status = records_read(&series, contents->run, "series");
    if (status != REPORT_FINISHED)
        return status;
    contents->n_rows = series.n_rows;
    contents->time = records_column(&series, "time");
    contents->entries = array_allocate((size_t)series.n_columns, sizeof *contents->entries);
    bool whole = contents->time != NULL;
    for (int k = 0; k < series.n_columns; k++)
        whole = read_column(contents, &series, series.columns[k].name) && whole;
    series_clear(&series);
    if (whole)
        return REPORT_FINISHED;
    report_error(
        "the series of %s lack columns that every run writes; was it written by tremie?",
        contents->run);
    return REPORT_STORAGE;
}

/* ---------------------------------------------------------------------------------- showing */

static void print_content(const struct contents *contents, const struct entry *entry)
{
    static const char *const headings[] = {"time [s]",  "spheres",   "mass [kg]",
                                           "v_x [m/s]", "v_y [m/s]", "v_z [m/s]"};
    const int n_shown = contents->n_rows < ROWS_SHOWN ? contents->n_rows : ROWS_SHOWN;
    struct sheet sheet;
    sheet_init(&sheet);
    for (size_t k = 0; k < sizeof headings / sizeof *headings; k++)
        sheet_heading(&sheet, "%s", headings[k]);
    for (int k = 0; k < n_shown; k++) {
        const int i =
            n_shown > 1 ? (int)((int64_t)k * (contents->n_rows - 1) / (n_shown - 1)) : 0;
        sheet_cell(&sheet, "%.6g", contents->time[i]);
        sheet_cell(&sheet, "%.0f", entry->count[i]);
        sheet_cell(&sheet, "%.6g", entry->mass[i]);
        for (int c = 0; c < 3; c++) {
            if (entry->count[i] > 0.0)
                sheet_cell(&sheet, "%.4g", entry->velocity[c][i]);
            else
                sheet_cell(&sheet, "-");
        }
    }
    printf("\ncontent %s\n", entry->name);
    sheet_print(&sheet, stdout);
    sheet_clear(&sheet);
}

static void print_all(const struct contents *contents)
{
    const int last = contents->n_rows - 1;
    printf("contents of %s: %d samples from %.6g s to %.6g s\n", contents->run,
           contents->n_rows, contents->time[0], contents->time[last]);
    for (int e = 0; e < contents->n_entries; e++)
        if (contents->entries[e].kind == KIND_CONTENT)
            print_content(contents, &contents->entries[e]);
    printf("\n");
    for (int e = 0; e < contents->n_entries; e++) {
        const struct entry *entry = &contents->entries[e];
        if (entry->kind != KIND_CONTENT)
            printf("%s %s: %.0f spheres, %.6g kg\n", KINDS[entry->kind].word, entry->name,
                   entry->count[last], entry->mass[last]);
    }
}

static int write_csv(const struct contents *contents, const char *path)
{
    struct sheet sheet;
    sheet_init(&sheet);
    sheet_heading(&sheet, "time_s");
    for (int e = 0; e < contents->n_entries; e++) {
        const struct entry *entry = &contents->entries[e];
        sheet_heading(&sheet, "%s%s", entry->name, KINDS[entry->kind].count);
        sheet_heading(&sheet, "%s%s_kg", entry->name, KINDS[entry->kind].mass);
        for (int k = 0; k < 3 && entry->kind == KIND_CONTENT; k++)
            sheet_heading(&sheet, "%s.velocity_%c_m_s", entry->name, "xyz"[k]);
    }
    for (int i = 0; i < contents->n_rows; i++) {
        sheet_cell(&sheet, "%.12g", contents->time[i]);
        for (int e = 0; e < contents->n_entries; e++) {
            const struct entry *entry = &contents->entries[e];
            sheet_cell(&sheet, "%.0f", entry->count[i]);
            sheet_cell(&sheet, "%.12g", entry->mass[i]);
            for (int k = 0; k < 3 && entry->kind == KIND_CONTENT; k++) {
                if (entry->count[i] > 0.0)
                    sheet_cell(&sheet, "%.9g", entry->velocity[k][i]);
                else
                    sheet_cell(&sheet, "%s", ""); /* of nothing there is no velocity */
            }
        }
    }
    const int status = sheet_write_csv(&sheet, path);
    sheet_clear(&sheet);
    return status;
}

static void plot_entry(const struct contents *contents, const struct entry *entry, int colour,
                       struct plot_panel *masses, struct plot_panel *speeds)
{
    struct plot_curve curve = {.label = entry->name,
                               .n = contents->n_rows,
                               .x = contents->time,
                               .y = entry->mass,
                               .colour = colour,
                               .dashed = entry->kind != KIND_CONTENT};
    plot_add_curve(masses, curve);
    curve.y = entry->speed;
    if (entry->kind == KIND_CONTENT)
        plot_add_curve(speeds, curve);
}

static int write_svg(const struct contents *contents, const char *path)
{
    char *title = array_format("Contents of %s", contents->run);
    struct plot plot = {.title = title,
                        .n_panels = 1,
                        .panels = {{.x_label = "time [s]", .y_label = "mass [kg]"},
                                   {.x_label = "time [s]", .y_label = "mean speed [m/s]"}}};
    for (int e = 0; e < contents->n_entries; e++) {
        plot_entry(contents, &contents->entries[e], e, &plot.panels[0], &plot.panels[1]);
        if (contents->entries[e].kind == KIND_CONTENT)
            plot.n_panels = 2;
    }
    const int status = plot_write_svg(&plot, path);
    free(title);
    return status;
}

static int show(const struct contents *contents, const char *csv, const char *svg)
{
    if (contents->n_entries == 0) {
        printf("%s has no region whose content is recorded, and nothing comes in or is taken "
               "out; name one under `contents:` in the job\n",
               contents->run);
        return NOTHING_TO_REPORT;
    }
    if (contents->n_rows == 0) {
        printf("%s has no samples so far\n", contents->run);
        return NOTHING_TO_REPORT;
    }
    print_all(contents);
    int status = csv != NULL ? write_csv(contents, csv) : REPORT_FINISHED;
    if (svg != NULL && status == REPORT_FINISHED)
        status = write_svg(contents, svg);
    return status;
}

int main(int argc, char **argv)
{
    const char *csv = NULL, *svg = NULL;
    struct contents contents = {0};
    const struct arguments_entry entries[] = {
        {"materials", 0, ARGUMENTS_FLAG, &contents.by_material, NULL,
         "shows what is counted apart by material, too", NULL},
        {"csv", 0, ARGUMENTS_TEXT, &csv, "FILE", "writes all samples as comma-separated values",
         NULL},
        {"svg", 0, ARGUMENTS_TEXT, &svg, "FILE", "draws masses and mean speeds over time",
         NULL},
    };
    const struct arguments_page page = {
        "tremie-contents",
        "RUN [--materials] [--csv FILE] [--svg FILE]",
        "Shows over time how many spheres, what mass and which mean velocity was in each region under\n"
        "`contents:` in the job, and what came in and was taken out.  RUN is the run's folder.\n"
        "\n"
        "Exit status: 0 shown; 1 nothing to show (no region, no samples); 2 bad arguments;\n"
        "4 a file cannot be read or written.\n",
        sizeof entries / sizeof *entries,
        entries,
        1,
        1};
    int n;
    int status = arguments_read(&page, argc, argv, &n);
    if (status != ARGUMENTS_GO_ON)
        return status;
    contents.run = argv[1];
    status = read_run(&contents);
    if (status == REPORT_FINISHED)
        status = show(&contents, csv, svg);
    clear(&contents);
    return status;
}
