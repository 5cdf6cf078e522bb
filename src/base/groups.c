/* See groups.h.  Items point to earlier ones of their group; ways are halved as they are
 * gone. */
#include "base/groups.h"

#include "base/array.h"

int *groups_apart(int n)
{
    int *groups = array_allocate((size_t)n, sizeof *groups);
    for (int k = 0; k < n; k++)
        groups[k] = k;
    return groups;
}

int groups_first(int *groups, int item)
{
    while (groups[item] != item)
        item = groups[item] = groups[groups[item]];
    return item;
}

bool groups_join(int *groups, int a, int b)
{
    const int p = groups_first(groups, a), q = groups_first(groups, b);
    groups[p > q ? p : q] = p > q ? q : p;
    return p != q;
}
