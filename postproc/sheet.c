/* See sheet.h. */
#include "sheet.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"

void sheet_init(struct sheet *sheet)
{
    *sheet = (struct sheet){0};
}

void sheet_clear(struct sheet *sheet)
{
    for (int i = 0; i < sheet->n_columns; i++)
        free(sheet->headings[i]);
    for (int i = 0; i < sheet->n_cells; i++)
        free(sheet->cells[i]);
    free(sheet->headings);
    free(sheet->cells);
    sheet_init(sheet);
}

static char *print_text(const char *format, va_list arguments)
    __attribute__((format(printf, 1, 0)));
static char *print_text(const char *format, va_list arguments)
{
    va_list copy;
    va_copy(copy, arguments);
    const int length = vsnprintf(NULL, 0, format, copy);
    va_end(copy);
    CHECK(length >= 0, "cannot format %s", format);
    char *text = array_allocate((size_t)length + 1, 1);
    vsnprintf(text, (size_t)length + 1, format, arguments);
    return text;
}

void sheet_heading(struct sheet *sheet, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    ARRAY_GROW(sheet->headings, sheet->n_columns + 1, sheet->column_capacity);
    sheet->headings[sheet->n_columns++] = print_text(format, arguments);
    va_end(arguments);
}

void sheet_cell(struct sheet *sheet, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    ARRAY_GROW(sheet->cells, sheet->n_cells + 1, sheet->cell_capacity);
    sheet->cells[sheet->n_cells++] = print_text(format, arguments);
    va_end(arguments);
}

/* Characters of UTF-8 text. */
static int text_width(const char *text)
{
    int n = 0;
    for (; *text != '\0'; text++)
        n += ((unsigned char)*text & 0xC0) != 0x80;
    return n;
}

static int column_width(const struct sheet *sheet, int column)
{
    int width = text_width(sheet->headings[column]);
    for (int i = column; i < sheet->n_cells; i += sheet->n_columns) {
        const int cell = text_width(sheet->cells[i]);
        width = cell > width ? cell : width;
    }
    return width;
}

/* Does the column hold words?  Numbers, and what stands for a missing one, do not count. */
static bool column_is_text(const struct sheet *sheet, int column)
{
    for (int i = column; i < sheet->n_cells; i += sheet->n_columns) {
        const char *cell = sheet->cells[i];
        if (strspn(cell, "0123456789.+-") == 0 && cell[0] != '\0' && strcmp(cell, "nan") != 0 &&
            strcmp(cell, "inf") != 0)
            return true;
    }
    return column == 0;
}

static void print_padded(FILE *stream, const char *text, int width, bool left, bool last)
{
    const int blanks = width - text_width(text);
    if (left)
        fprintf(stream, "%s%*s", text, last ? 0 : blanks, "");
    else
        fprintf(stream, "%*s%s", blanks, "", text);
    fputs(last ? "\n" : "  ", stream);
}

void sheet_print(const struct sheet *sheet, FILE *stream)
{
    const int n = sheet->n_columns;
    int *widths = array_allocate((size_t)n, sizeof *widths);
    bool *left = array_allocate((size_t)n, sizeof *left);
    for (int c = 0; c < n; c++) {
        widths[c] = column_width(sheet, c);
        left[c] = column_is_text(sheet, c);
    }
    for (int c = 0; c < n; c++)
        print_padded(stream, sheet->headings[c], widths[c], left[c], c == n - 1);
    for (int i = 0; i < sheet->n_cells; i++)
        print_padded(stream, sheet->cells[i], widths[i % n], left[i % n], i % n == n - 1);
    free(widths);
    free(left);
}

static void write_csv_cell(FILE *stream, const char *text, bool last)
{
    if (strpbrk(text, ",\"\n") == NULL) {
        fputs(text, stream);
    } else {
        fputc('"', stream);
        for (; *text != '\0'; text++) {
            if (*text == '"')
                fputc('"', stream);
            fputc(*text, stream);
        }
        fputc('"', stream);
    }
    fputc(last ? '\n' : ',', stream);
}

int sheet_write_csv(const struct sheet *sheet, const char *path)
{
    FILE *stream = fopen(path, "w");
    if (stream == NULL) {
        report_error("cannot write %s: %s; check the folder", path, strerror(errno));
        return REPORT_STORAGE;
    }
    const int n = sheet->n_columns;
    for (int c = 0; c < n; c++)
        write_csv_cell(stream, sheet->headings[c], c == n - 1);
    for (int i = 0; i < sheet->n_cells; i++)
        write_csv_cell(stream, sheet->cells[i], i % n == n - 1);
    const bool failed = ferror(stream) != 0;
    if (fclose(stream) != 0 || failed) {
        report_error("cannot write all of %s: %s; check the space on its disk", path,
                     strerror(errno));
        return REPORT_STORAGE;
    }
    return REPORT_FINISHED;
}

/* Takes a cell off a line, in place: what stands before a comma, or between quotes.  Returns
 * where the next begins; NULL after the last. */
static char *take_csv_cell(char *at, char **cell)
{
    char *to = *cell = at;
    const bool quoted = *at == '"';
    for (at += quoted; *at != '\0' && (quoted || *at != ','); at++) {
        if (quoted && *at == '"' && *++at != '"')
            break;
        *to++ = *at;
    }
    const bool more = *at == ',';
    *to = '\0';
    return more ? at + 1 : NULL;
}

static bool read_csv_line(struct sheet *sheet, char *line, bool first)
{
    int n = 0;
    line[strcspn(line, "\r\n")] = '\0';
    for (char *next = line, *cell; next != NULL; n++) {
        next = take_csv_cell(next, &cell);
        if (first)
            sheet_heading(sheet, "%s", cell);
        else
            sheet_cell(sheet, "%s", cell);
    }
    return n == sheet->n_columns;
}

int sheet_read_csv(struct sheet *sheet, const char *path)
{
    FILE *stream = fopen(path, "r");
    if (stream == NULL) {
        report_error("cannot read %s: %s; give a CSV file", path, strerror(errno));
        return REPORT_STORAGE;
    }
    char *line = NULL;
    size_t capacity = 0;
    bool fine = true;
    for (int n = 1; fine && getline(&line, &capacity, stream) >= 0; n++) {
        if (line[0] == '#' || line[strspn(line, " \t\r\n")] == '\0')
            continue;
        fine = read_csv_line(sheet, line, sheet->n_columns == 0);
        if (!fine)
            report_error("%s:%d: this row has another number of cells than there are headings; "
                         "as many are expected",
                         path, n);
    }
    free(line);
    fclose(stream);
    if (fine && sheet->n_columns == 0) {
        report_error("%s: there is no line in it; headings and rows are expected", path);
        fine = false;
    }
    return fine ? REPORT_FINISHED : REPORT_STORAGE;
}

int sheet_column(const struct sheet *sheet, const char *heading)
{
    for (int c = 0; c < sheet->n_columns; c++)
        if (strcmp(sheet->headings[c], heading) == 0)
            return c;
    return -1;
}
