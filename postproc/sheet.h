/*
 * Sheets of text cells: aligned for a terminal, or as comma-separated values for other
 * programs.  Cells are given row by row, as many as there are columns.
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

#endif
