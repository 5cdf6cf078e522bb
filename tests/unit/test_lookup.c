/* From ids to storage indices: every id finds its own index, strangers find none. */
#include "domain/lookup.h"

#include <stdlib.h>

#include "base/array.h"
#include "check.h"

static struct lookup lookup;

/* Enters n ids, `step` apart, and looks for each and for those between. */
static void fill_and_find(int n, int64_t first, int64_t step)
{
    int64_t *ids = array_allocate((size_t)n, sizeof *ids);
    for (int i = 0; i < n; i++)
        ids[i] = first + step * ((int64_t)i * 7919 % 10007);
    lookup_fill(&lookup, n, ids);
    bool found = true, strangers = false;
    for (int i = 0; i < n; i++) {
        found = found && lookup_find(&lookup, ids[i]) == i;
        strangers = strangers || (step > 1 && lookup_find(&lookup, ids[i] + 1) >= 0);
    }
    EXPECT(found && !strangers);
    EXPECT(lookup_find(&lookup, first + step * 10007) == -1);
    free(ids);
}

TEST(nothing_is_found_in_an_empty_table)
{
    EXPECT(lookup_find(&lookup, 0) == -1);
    lookup_fill(&lookup, 0, NULL);
    EXPECT(lookup_find(&lookup, 0) == -1 && lookup_find(&lookup, 77) == -1);
}

TEST(every_id_finds_its_index)
{
    fill_and_find(1, 0, 1);
    fill_and_find(5000, 0, 1);
    fill_and_find(40, 3, 2); /* the same table, now mostly free */
    fill_and_find(10000, (int64_t)1 << 60, 3);
    fill_and_find(31, 0, 1); /* half of the least table's slots */
    fill_and_find(32, 0, 1);
}

/* Multiples of large powers of two would all fall into a few slots of a naive table. */
TEST(ids_far_apart)
{
    for (int bits = 0; bits < 48; bits += 6)
        fill_and_find(1000, 1, (int64_t)1 << bits);
}

TEST(forgets_what_was_there_before)
{
    const int64_t before[3] = {10, 20, 30}, now[2] = {30, 40};
    lookup_fill(&lookup, 3, before);
    lookup_fill(&lookup, 2, now);
    EXPECT(lookup_find(&lookup, 10) == -1 && lookup_find(&lookup, 20) == -1);
    EXPECT(lookup_find(&lookup, 30) == 0 && lookup_find(&lookup, 40) == 1);
}

int main(int argc, char **argv)
{
    const int status = check_run(argc, argv);
    lookup_clear(&lookup);
    return status;
}
