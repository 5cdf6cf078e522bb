/* From a sphere's id to its storage index on this rank: an open-addressing hash table, made
 * anew when spheres have moved in memory. */
#ifndef TREMIE_DOMAIN_LOOKUP_H
#define TREMIE_DOMAIN_LOOKUP_H

#include <stdint.h>

struct lookup {
    int64_t *ids; /* -1: free */
    int *indices;
    uint64_t mask; /* slots - 1, a power of two less one */
};

void lookup_clear(struct lookup *lookup);
/* Enters n ids; the index of ids[i] is i. */
void lookup_fill(struct lookup *lookup, int n, const int64_t *ids);
/* Storage index, -1 when the sphere is not here. */
int lookup_find(const struct lookup *lookup, int64_t id);

#endif
