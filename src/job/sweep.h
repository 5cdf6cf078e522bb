/*
 * The `sweep` of a job: keys that vary, and the variants that come of it, one for each
 * combination of their values.
 *
 * A variant is the job with these values put where `--set` would put them, so it is the same
 * job as one that has them written in.  Variants are counted from 1, the first key of the list
 * changing the slowest.  Each has the name of a folder, made of its values and not of its
 * number, so that a study to which values are added keeps the runs that it has.
 *
 * All functions are local.
 */
#ifndef TREMIE_JOB_SWEEP_H
#define TREMIE_JOB_SWEEP_H

#include <stdbool.h>

struct mistakes;
struct yaml_tree;
struct yaml_tree_node;

enum { SWEEP_MOST = 10000 }; /* variants, and values of a key */

enum sweep_spacing { SWEEP_LINEAR, SWEEP_LOG };

/* An entry as the job has it; its values are read from the tree. */
struct sweep_item {
    char *key, *name;
    char *from, *to;
    int count;
    enum sweep_spacing spacing;
    int n_together;
    struct sweep_item *together;
};

struct sweep {
    int n_keys, n_variants;
    char **keys, **names;
    char **folders; /* of the variants */
    char **values;  /* n_variants x n_keys, as the job writes them; long ones v1, v2, ... */
    /* The same where they stand in the tree, and where the keys do; NULL when it has gone. */
    const struct yaml_tree_node **nodes, **places;
};

/* Reads the sweep of a job's tree, which must live as long as variants are applied; without
 * one there are no variants.  Returns false with its mistakes listed. */
bool sweep_read(struct sweep *sweep, struct yaml_tree *tree, struct mistakes *mistakes);
/* Puts the values of a variant into the tree. */
void sweep_apply(const struct sweep *sweep, int variant, struct yaml_tree *tree,
                 struct mistakes *mistakes);
/* Lists it when this key=value would set what varies. */
void sweep_refuse(const struct sweep *sweep, const char *override, struct mistakes *mistakes);
/* What is left once the tree has gone. */
void sweep_forget_places(struct sweep *sweep);
void sweep_clear(struct sweep *sweep);

/* A value that a variant, counted from 1, gives to a key. */
const char *sweep_value(const struct sweep *sweep, int variant, int key);
/* All of them in a line: "friction 0.3, outlet 60 mm".  The caller frees it. */
char *sweep_describe(const struct sweep *sweep, int variant);

#endif
