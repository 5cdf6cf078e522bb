/*
 * Sheets of text cells: aligned for a terminal, or as comma-separated values for other
 * programs and read back from there.  Cells are given row by row, as many as there are
 * columns.
 */
#ifndef TREMIE_POSTPROC_SHEET_H
#define TREMIE_POSTPROC_SHEET_H

#include <stdbool.h>
#include <stdio.h>

struct sheet {
    int n_columns, n_cells, column_capacity, cell_capacity;
    char **headings;
    char **cells;
};

void sheet_init(struct sheet *sheet);
void sheet_clear(struct sheet *sheet);
void sheet_heading(struct sheet *sheet, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
void sheet_cell(struct sheet *sheet, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* Words and the first column to the left, numbers to the right, two blanks between. */
void sheet_print(const struct sheet *sheet, FILE *stream);
/* Writes the sheet to `path`.  Returns a REPORT_ status, the reason said. */
int sheet_write_csv(const struct sheet *sheet, const char *path);
/* Fills a sheet from such a file: a line of headings, then rows; lines that start with # and
 * empty ones are passed over.  Returns a REPORT_ status, the reason said. */
int sheet_read_csv(struct sheet *sheet, const char *path);
/* The column with this heading; -1: none. */
int sheet_column(const struct sheet *sheet, const char *heading);

#endif
