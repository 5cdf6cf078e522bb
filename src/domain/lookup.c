/* See lookup.h. */
#include "domain/lookup.h"

#include <stdlib.h>

#include "base/array.h"

void lookup_clear(struct lookup *lookup)
{
    free(lookup->ids);
    free(lookup->indices);
    *lookup = (struct lookup){0};
}

static uint64_t slot_of(const struct lookup *lookup, int64_t id)
{
    uint64_t mixed = (uint64_t)id * 0x9E3779B97F4A7C15u;
    return (mixed ^ (mixed >> 32)) & lookup->mask;
}

void lookup_fill(struct lookup *lookup, int n, const int64_t *ids)
{
    uint64_t slots = lookup->ids != NULL ? lookup->mask + 1 : 0;
    if (slots < 2 * (uint64_t)n + 2) {
        lookup_clear(lookup);
        for (slots = 64; slots < 2 * (uint64_t)n + 2;)
            slots *= 2;
        lookup->ids = array_allocate(slots, sizeof *lookup->ids);
        lookup->indices = array_allocate(slots, sizeof *lookup->indices);
        lookup->mask = slots - 1;
    }
    for (uint64_t s = 0; s < slots; s++)
        lookup->ids[s] = -1;
    for (int i = 0; i < n; i++) {
        uint64_t slot = slot_of(lookup, ids[i]);
        while (lookup->ids[slot] >= 0)
            slot = (slot + 1) & lookup->mask;
        lookup->ids[slot] = ids[i];
        lookup->indices[slot] = i;
    }
}

int lookup_find(const struct lookup *lookup, int64_t id)
{
    if (lookup->ids == NULL)
        return -1;
    uint64_t slot = slot_of(lookup, id);
    while (lookup->ids[slot] >= 0 && lookup->ids[slot] != id)
        slot = (slot + 1) & lookup->mask;
    return lookup->ids[slot] == id ? lookup->indices[slot] : -1;
}
