/*
 * A YAML file as a tree of nodes that know where they stand, so that every later message can
 * name file, line and column.
 *
 * Plain YAML only: no anchors and aliases (a few lines of them can expand to gigabytes), no
 * tags, one document.  Size, depth and number of nodes are capped.  All mistakes of the text go
 * to a list.
 */
#ifndef TREMIE_JOB_YAML_TREE_H
#define TREMIE_JOB_YAML_TREE_H

#include <stdbool.h>
#include <stddef.h>

struct mistakes;

enum { YAML_TREE_MAX_BYTES = 4 << 20, YAML_TREE_MAX_DEPTH = 32, YAML_TREE_MAX_NODES = 1000000 };

enum yaml_tree_kind { YAML_TREE_SCALAR, YAML_TREE_LIST, YAML_TREE_MAPPING };

struct yaml_tree_node {
    enum yaml_tree_kind kind;
    const char *file;
    int line, column;         /* from 1 */
    const char *text;         /* scalar: its text; else NULL */
    const char *key;          /* in a mapping: the key of this value; else NULL */
    int key_line, key_column; /* where the key stands */
    int n;                    /* children */
    struct yaml_tree_node *first, *last, *next;
};

/* Nodes and texts live in one arena, so nodes of several trees may be linked to each other
 * as long as all the trees live. */
struct yaml_tree {
    struct yaml_tree_node *root; /* NULL when nothing could be read */
    struct yaml_tree_chunk *chunks;
};

/* Reads a file; false with mistakes listed when there is any.  The root is NULL when they
 * forbid to look further (a key given twice does not).  Local. */
bool yaml_tree_read(struct yaml_tree *tree, const char *path, struct mistakes *mistakes);
/* Reads a text of n bytes; `file` is what messages call it, and columns of the first line
 * count from `column`.  No cap on size or nodes: for texts of our own. */
bool yaml_tree_parse(struct yaml_tree *tree, const char *file, int column, const char *text,
                     size_t n, struct mistakes *mistakes);
void yaml_tree_clear(struct yaml_tree *tree);

/* The value of a key, the i-th child; NULL where there is none. */
struct yaml_tree_node *yaml_tree_find(const struct yaml_tree_node *mapping, const char *key);
struct yaml_tree_node *yaml_tree_child(const struct yaml_tree_node *node, int i);
/* The node at a dotted path ("spheres.0.radius"), or the last one there is on the way. */
const struct yaml_tree_node *yaml_tree_nearest(const struct yaml_tree_node *root,
                                               const char *path);

/* Appends a child; `key` (kept, not copied) for mappings, else NULL. */
void yaml_tree_append(struct yaml_tree_node *parent, const char *key,
                      struct yaml_tree_node *child);
/* Puts a value where a dotted path leads, or lists that it leads nowhere; mappings that are
 * missing on the way are made in `tree`.  In messages the key stands where `place` does. */
void yaml_tree_put(struct yaml_tree *tree, struct yaml_tree_node *root, const char *path,
                   const struct yaml_tree_node *value, const struct yaml_tree_node *place,
                   struct mistakes *mistakes);
/* A new node of this tree that stands where `place` does. */
struct yaml_tree_node *yaml_tree_new(struct yaml_tree *tree, enum yaml_tree_kind kind,
                                     const struct yaml_tree_node *place);
/* A copy of n bytes of text that lives as long as the tree. */
const char *yaml_tree_text(struct yaml_tree *tree, const char *text, size_t n);

/* Text fit for a message: control characters replaced, cut to a readable length. */
enum { YAML_TREE_SHOWN = 48 };
const char *yaml_tree_shown(char shown[YAML_TREE_SHOWN], const char *text);

#endif
