/*
 * Items that belong together: each group is known by its first item.
 */
#ifndef TREMIE_BASE_GROUPS_H
#define TREMIE_BASE_GROUPS_H

#include <stdbool.h>

/* n items, each by itself; the caller frees it. */
int *groups_apart(int n);
/* The first item of the group that one is in. */
int groups_first(int *groups, int item);
/* Makes one group of those of two items; false where they were in one already. */
bool groups_join(int *groups, int a, int b);

#endif
