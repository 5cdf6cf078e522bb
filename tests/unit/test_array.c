/* Memory: large arrays of which parts are given back. */
#include "base/array.h"

#include <stdint.h>
#include <stdlib.h>

#include "check.h"

enum { ROWS = 40000 };

struct row {
    double lane[24];
};

/* Rows 1000 to 29999 and every hundredth one are kept. */
static bool is_kept(int i)
{
    return (i >= 1000 && i < 30000) || i % 100 == 0;
}

TEST(rows_are_kept_and_given_back)
{
    struct row *rows = array_allocate_sparse(ROWS, sizeof *rows);
    bool *keep = array_allocate(ROWS, sizeof *keep);
    int n_wrong = 0, n_left = 0;
    EXPECT((uintptr_t)rows % 64 == 0);
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < 24; k++) {
            n_wrong += rows[i].lane[k] != 0.0;
            rows[i].lane[k] = i + 1;
        }
    for (int i = 0; i < ROWS; i++)
        keep[i] = is_kept(i);
    array_forget(rows, ROWS, sizeof *rows, keep);
    for (int i = 0; i < ROWS; i++)
        for (int k = 0; k < 24; k++) {
            n_wrong += is_kept(i) && rows[i].lane[k] != i + 1;
            n_left += !is_kept(i) && rows[i].lane[k] != 0.0;
        }
    EXPECT(n_wrong == 0);
    EXPECT(n_left < 24 * 2 * 22 * 110); /* less than a page at either end of each gap */
    rows[ROWS - 1].lane[0] = 2.0;
    EXPECT(rows[ROWS - 1].lane[0] == 2.0);
    free(keep);
    free(rows);
}

TEST(small_arrays_stay)
{
    double *values = array_allocate_sparse(5, sizeof *values);
    const bool keep[5] = {false, true, false, false, true};
    for (int i = 0; i < 5; i++)
        values[i] = i;
    array_forget(values, 5, sizeof *values, keep);
    EXPECT(values[1] == 1.0 && values[4] == 4.0);
    free(values);
    free(array_allocate_sparse(0, 8));
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
