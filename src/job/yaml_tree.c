/*
 * The text is looked at twice.  A first pass over the bytes finds what libyaml reports badly or
 * not at the right place (invalid UTF-8, control characters, tabs that indent).  Then libyaml's
 * events build the tree, with a stack of open containers.  libyaml stops at the first error of
 * syntax, so there is at most one of those; everything that the schema finds later is listed in
 * full.
 */
#include "job/yaml_tree.h"

#include <errno.h>
#include <fcntl.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>
#include <yaml.h>

#include "base/array.h"
#include "base/report.h"

enum {
    CHUNK_BYTES = 64 * 1024,
    REPORTED = 20, /* tabs or duplicate keys; more would not help */
    KEY_LENGTH = 64,
    LAST_INDEX = 100000
};

struct yaml_tree_chunk {
    struct yaml_tree_chunk *next;
    size_t used, size;
    max_align_t bytes[];
};

static void *arena_take(struct yaml_tree *tree, size_t n)
{
    const size_t unit = sizeof(max_align_t);
    const size_t padded = (n + unit - 1) / unit * unit;
    struct yaml_tree_chunk *chunk = tree->chunks;
    if (chunk == NULL || chunk->size - chunk->used < padded) {
        const size_t size = padded > CHUNK_BYTES ? padded : CHUNK_BYTES;
        chunk = array_allocate(1, sizeof *chunk + size);
        *chunk = (struct yaml_tree_chunk){.next = tree->chunks, .size = size};
        tree->chunks = chunk;
    }
    void *memory = (char *)chunk->bytes + chunk->used;
    chunk->used += padded;
    return memory;
}

void yaml_tree_clear(struct yaml_tree *tree)
{
    while (tree->chunks != NULL) {
        struct yaml_tree_chunk *next = tree->chunks->next;
        free(tree->chunks);
        tree->chunks = next;
    }
    *tree = (struct yaml_tree){0};
}

const char *yaml_tree_text(struct yaml_tree *tree, const char *text, size_t n)
{
    char *copy = arena_take(tree, n + 1);
    memcpy(copy, text, n);
    copy[n] = '\0';
    return copy;
}

struct yaml_tree_node *yaml_tree_new(struct yaml_tree *tree, enum yaml_tree_kind kind,
                                     const struct yaml_tree_node *place)
{
    struct yaml_tree_node *node = arena_take(tree, sizeof *node);
    *node = (struct yaml_tree_node){
        .kind = kind, .file = place->file, .line = place->line, .column = place->column};
    return node;
}

void yaml_tree_append(struct yaml_tree_node *parent, const char *key,
                      struct yaml_tree_node *child)
{
    child->key = key;
    child->next = NULL;
    if (parent->last != NULL)
        parent->last->next = child;
    else
        parent->first = child;
    parent->last = child;
    parent->n++;
}

struct yaml_tree_node *yaml_tree_find(const struct yaml_tree_node *mapping, const char *key)
{
    if (mapping == NULL || mapping->kind != YAML_TREE_MAPPING)
        return NULL;
    for (struct yaml_tree_node *child = mapping->first; child != NULL; child = child->next)
        if (strcmp(child->key, key) == 0)
            return child;
    return NULL;
}

struct yaml_tree_node *yaml_tree_child(const struct yaml_tree_node *node, int i)
{
    struct yaml_tree_node *child = node == NULL ? NULL : node->first;
    for (int k = 0; k < i && child != NULL; k++)
        child = child->next;
    return child;
}

const struct yaml_tree_node *yaml_tree_nearest(const struct yaml_tree_node *root,
                                               const char *path)
{
    const struct yaml_tree_node *node = root;
    while (*path != '\0') {
        char key[64];
        const size_t length = strcspn(path, ".");
        snprintf(key, sizeof key, "%.*s", (int)(length < 63 ? length : 63), path);
        const struct yaml_tree_node *next = node->kind == YAML_TREE_LIST
                                                ? yaml_tree_child(node, atoi(key))
                                                : yaml_tree_find(node, key);
        if (next == NULL)
            break;
        node = next;
        path += length + (path[length] == '.');
    }
    return node;
}

/* The child that a step of a dotted path names; made where a mapping lacks it. */
static struct yaml_tree_node *step_into(struct yaml_tree *tree, struct yaml_tree_node *node,
                                        const char *key, const struct yaml_tree_node *place)
{
    if (node->kind == YAML_TREE_LIST) {
        char *end;
        const long i = strtol(key, &end, 10);
        return *end != '\0' || end == key || i < 0 || i > LAST_INDEX
                   ? NULL
                   : yaml_tree_child(node, (int)i);
    }
    if (node->kind != YAML_TREE_MAPPING)
        return NULL;
    struct yaml_tree_node *child = yaml_tree_find(node, key);
    if (child == NULL) {
        child = yaml_tree_new(tree, YAML_TREE_MAPPING, place);
        child->key_line = place->line;
        child->key_column = place->column;
        yaml_tree_append(node, yaml_tree_text(tree, key, strlen(key)), child);
    }
    return child;
}

/* The node at a dotted path, made where it can be; NULL where the path leads nowhere. */
static struct yaml_tree_node *node_ensure(struct yaml_tree *tree, struct yaml_tree_node *root,
                                          const char *path, const struct yaml_tree_node *place)
{
    struct yaml_tree_node *node = root;
    while (node != NULL && *path != '\0') {
        char key[KEY_LENGTH];
        const size_t length = strcspn(path, ".");
        if (length == 0 || length >= KEY_LENGTH)
            return NULL;
        memcpy(key, path, length);
        key[length] = '\0';
        node = step_into(tree, node, key, place);
        path += length + (path[length] == '.');
    }
    return node;
}

void yaml_tree_put(struct yaml_tree *tree, struct yaml_tree_node *root, const char *path,
                   const struct yaml_tree_node *value, const struct yaml_tree_node *place,
                   struct mistakes *mistakes)
{
    char shown[YAML_TREE_SHOWN];
    struct yaml_tree_node *node = node_ensure(tree, root, path, place);
    if (node == NULL) {
        mistakes_add(
            mistakes, place->file, place->line, place->column,
            "'%s' leads nowhere; a path like spheres.0.radius is expected (lists count from 0)",
            yaml_tree_shown(shown, path));
        return;
    }
    struct yaml_tree_node *next = node->next;
    const char *key = node->key;
    *node = *value;
    node->key = key;
    node->next = next;
    node->key_line = place->line;
    node->key_column = place->column;
}

const char *yaml_tree_shown(char shown[YAML_TREE_SHOWN], const char *text)
{
    size_t n = 0;
    for (; n < YAML_TREE_SHOWN - 4 && text[n] != '\0'; n++)
        shown[n] = (unsigned char)text[n] < ' ' || text[n] == 127 ? '?' : text[n];
    while (text[n] != '\0' && n > 0 && (text[n] & 0xc0) == 0x80)
        n--; /* not in the middle of a UTF-8 character */
    snprintf(shown + n, YAML_TREE_SHOWN - n, "%s", text[n] != '\0' ? "..." : "");
    return shown;
}

/* ------------------------------------------------------------------------------- the bytes */

/* Bytes of the UTF-8 character at the start of `text`, 0 when it is not valid. */
static size_t character_length(const unsigned char *text, size_t n)
{
    if (text[0] < 0x80)
        return 1;
    const size_t length = text[0] >= 0xf0 ? 4 : text[0] >= 0xe0 ? 3 : 2;
    if (text[0] < 0xc2 || text[0] > 0xf4 || length > n)
        return 0;
    for (size_t i = 1; i < length; i++)
        if ((text[i] & 0xc0) != 0x80)
            return 0;
    const bool overlong =
        (text[0] == 0xe0 && text[1] < 0xa0) || (text[0] == 0xf0 && text[1] < 0x90);
    const bool surrogate = text[0] == 0xed && text[1] >= 0xa0;
    const bool beyond = text[0] == 0xf4 && text[1] >= 0x90;
    return overlong || surrogate || beyond ? 0 : length;
}

/* Does a tab stand in what indents the line that begins at `text`? */
static bool tab_indents(const unsigned char *text, size_t n, size_t *where)
{
    size_t i = 0;
    bool tab = false;
    for (; i < n && (text[i] == ' ' || text[i] == '\t'); i++) {
        if (text[i] == '\t' && !tab) {
            tab = true;
            *where = i;
        }
    }
    return tab && i < n && text[i] != '\n' && text[i] != '\r' && text[i] != '#';
}

/* Lists what is wrong with the bytes; true when nothing is. */
static bool bytes_are_fine(const char *file, int column, const char *text, size_t n,
                           struct mistakes *mistakes)
{
    const unsigned char *bytes = (const unsigned char *)text;
    int line = 1, n_tabs = 0;
    size_t where = 0;
    for (size_t i = 0; i < n;) {
        if ((i == 0 || bytes[i - 1] == '\n') && tab_indents(bytes + i, n - i, &where) &&
            n_tabs++ < REPORTED)
            mistakes_add(mistakes, file, line, (int)where + 1,
                         "a tab indents this line; YAML wants spaces");
        const size_t length = character_length(bytes + i, n - i);
        const bool control = (bytes[i] < ' ' && strchr("\t\n\r", bytes[i]) == NULL) ||
                             bytes[i] == 0 || bytes[i] == 127;
        if (length == 0 || control) {
            mistakes_add(
                mistakes, file, line, column,
                length == 0
                    ? "byte 0x%02x is not valid UTF-8; text in UTF-8 is expected"
                    : "there is a control character (0x%02x); text in UTF-8 is expected",
                bytes[i]);
            return false;
        }
        column = bytes[i] == '\n' ? 1 : column + 1;
        line += bytes[i] == '\n';
        i += length;
    }
    return n_tabs == 0;
}

/* ------------------------------------------------------------------------------- the events */

struct build {
    struct yaml_tree *tree;
    struct mistakes *mistakes;
    const char *file;
    int column; /* of the first line */
    int n_nodes, max_nodes, n_duplicates;
    int depth;
    struct yaml_tree_node *open[YAML_TREE_MAX_DEPTH];
    struct yaml_tree_node *key[YAML_TREE_MAX_DEPTH]; /* read, waiting for its value */
    bool stopped;
};

static int mark_column(const struct build *build, yaml_mark_t mark)
{
    return (int)mark.column + (mark.line == 0 ? build->column : 1);
}

static void refuse(struct build *build, yaml_mark_t mark, const char *text)
{
    mistakes_add(build->mistakes, build->file, (int)mark.line + 1, mark_column(build, mark),
                 "%s", text);
    build->stopped = true;
}

static struct yaml_tree_node *node_new(struct build *build, enum yaml_tree_kind kind,
                                       yaml_mark_t mark)
{
    const struct yaml_tree_node place = {
        .file = build->file, .line = (int)mark.line + 1, .column = mark_column(build, mark)};
    if (++build->n_nodes > build->max_nodes)
        refuse(
            build, mark,
            "there are more than 1000000 values up to here; a smaller file is expected (many "
            "spheres belong in a CSV file)");
    return yaml_tree_new(build->tree, kind, &place);
}

/* Puts a finished node where the innermost open container wants it. */
static void node_place(struct build *build, struct yaml_tree_node *node, yaml_mark_t mark)
{
    if (build->depth == 0) {
        build->tree->root = node;
        return;
    }
    struct yaml_tree_node *parent = build->open[build->depth - 1];
    struct yaml_tree_node **key = &build->key[build->depth - 1];
    if (parent->kind == YAML_TREE_LIST) {
        yaml_tree_append(parent, NULL, node);
    } else if (*key != NULL) {
        node->key_line = (*key)->line;
        node->key_column = (*key)->column;
        yaml_tree_append(parent, (*key)->text, node);
        *key = NULL;
    } else if (node->kind == YAML_TREE_SCALAR) {
        *key = node;
    } else {
        refuse(build, mark,
               "a list or a mapping stands where a key is expected; 'key: value' is expected");
    }
}

static void container_open(struct build *build, enum yaml_tree_kind kind, yaml_mark_t mark)
{
    struct yaml_tree_node *node = node_new(build, kind, mark);
    node_place(build, node, mark);
    if (build->depth == YAML_TREE_MAX_DEPTH) {
        refuse(build, mark,
               "lists and mappings are nested more than 32 deep; fewer levels are expected");
        return;
    }
    build->open[build->depth] = node;
    build->key[build->depth] = NULL;
    build->depth++;
}

static int compare_keys(const void *a, const void *b)
{
    const struct yaml_tree_node *const *p = a, *const *q = b;
    const int order = strcmp((*p)->key, (*q)->key);
    if (order != 0)
        return order;
    return (*p)->key_line != (*q)->key_line ? (*p)->key_line - (*q)->key_line
                                            : (*p)->key_column - (*q)->key_column;
}

/* Lists the keys that a mapping holds twice. */
static void duplicates_report(struct build *build, const struct yaml_tree_node *mapping)
{
    const size_t n = (size_t)mapping->n;
    const struct yaml_tree_node **sorted = array_allocate(n, sizeof *sorted);
    size_t k = 0;
    for (const struct yaml_tree_node *child = mapping->first; child != NULL;
         child = child->next)
        sorted[k++] = child;
    qsort(sorted, n, sizeof *sorted, compare_keys);
    for (size_t i = 1; i < n; i++) {
        char shown[YAML_TREE_SHOWN];
        if (strcmp(sorted[i - 1]->key, sorted[i]->key) == 0 && build->n_duplicates++ < REPORTED)
            mistakes_add(build->mistakes, build->file, sorted[i]->key_line,
                         sorted[i]->key_column,
                         "the key '%s' is given twice (before in line %d); once is expected",
                         yaml_tree_shown(shown, sorted[i]->key), sorted[i - 1]->key_line);
    }
    free(sorted);
}

static void anchor_refuse(struct build *build, const yaml_char_t *anchor,
                          const yaml_char_t *tag, yaml_mark_t mark)
{
    if (anchor != NULL)
        refuse(build, mark,
               "an anchor (&) is used; values written out are expected, aliases are not read");
    else if (tag != NULL)
        refuse(build, mark, "a tag (!) is used; plain values are expected");
}

static void event_take(struct build *build, const yaml_event_t *event)
{
    const yaml_mark_t mark = event->start_mark;
    struct yaml_tree_node *node;
    switch ((int)event->type) {
    case YAML_DOCUMENT_START_EVENT:
        if (build->tree->root != NULL)
            refuse(build, mark, "a second document begins (---); one is expected");
        break;
    case YAML_ALIAS_EVENT:
        refuse(build, mark,
               "an alias (*) is used; values written out are expected, aliases are not read");
        break;
    case YAML_SCALAR_EVENT:
        anchor_refuse(build, event->data.scalar.anchor, event->data.scalar.tag, mark);
        node = node_new(build, YAML_TREE_SCALAR, mark);
        node->text = yaml_tree_text(build->tree, (const char *)event->data.scalar.value,
                                    event->data.scalar.length);
        node_place(build, node, mark);
        break;
    case YAML_SEQUENCE_START_EVENT:
        anchor_refuse(build, event->data.sequence_start.anchor, event->data.sequence_start.tag,
                      mark);
        container_open(build, YAML_TREE_LIST, mark);
        break;
    case YAML_MAPPING_START_EVENT:
        anchor_refuse(build, event->data.mapping_start.anchor, event->data.mapping_start.tag,
                      mark);
        container_open(build, YAML_TREE_MAPPING, mark);
        break;
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT:
        build->depth--;
        if (build->open[build->depth]->kind == YAML_TREE_MAPPING)
            duplicates_report(build, build->open[build->depth]);
        break;
    default: /* stream start and end, document end */
        break;
    }
}

static void syntax_report(struct build *build, const yaml_parser_t *parser)
{
    const bool has_context = parser->context != NULL;
    mistakes_add(build->mistakes, build->file, (int)parser->problem_mark.line + 1,
                 mark_column(build, parser->problem_mark), "%s%s%s%s; valid YAML is expected",
                 parser->problem != NULL ? parser->problem : "cannot read on",
                 has_context ? " (" : "", has_context ? parser->context : "",
                 has_context ? ")" : "");
    build->stopped = true;
}

static bool parse(struct yaml_tree *tree, const char *file, int column, const char *text,
                  size_t n, int max_nodes, struct mistakes *mistakes)
{
    const int n_before = mistakes->n;
    struct build build = {.tree = tree,
                          .mistakes = mistakes,
                          .file = yaml_tree_text(tree, file, strlen(file)),
                          .column = column,
                          .max_nodes = max_nodes};
    if (!bytes_are_fine(file, column, text, n, mistakes))
        return false;
    yaml_parser_t parser;
    CHECK(yaml_parser_initialize(&parser), "libyaml has no memory");
    yaml_parser_set_input_string(&parser, (const unsigned char *)text, n);
    for (bool end = false; !end && !build.stopped;) {
        yaml_event_t event;
        if (!yaml_parser_parse(&parser, &event)) {
            syntax_report(&build, &parser);
            break;
        }
        event_take(&build, &event);
        end = event.type == YAML_STREAM_END_EVENT;
        yaml_event_delete(&event);
    }
    yaml_parser_delete(&parser);
    if (build.stopped)
        tree->root = NULL; /* half a tree would only mislead */
    else if (tree->root == NULL)
        mistakes_add(mistakes, file, 1, column,
                     "there is nothing in it; 'key: value' lines are expected");
    return mistakes->n == n_before;
}

bool yaml_tree_parse(struct yaml_tree *tree, const char *file, int column, const char *text,
                     size_t n, struct mistakes *mistakes)
{
    *tree = (struct yaml_tree){0};
    return parse(tree, file, column, text, n, INT32_MAX, mistakes);
}

/* ------------------------------------------------------------------------------- the file */

/* All bytes of an open file; NULL with the mistake listed. */
static char *file_bytes(int descriptor, const char *path, size_t *n, struct mistakes *mistakes)
{
    struct stat about;
    if (fstat(descriptor, &about) != 0) {
        mistakes_add(mistakes, path, 1, 1, "cannot be read: %s; a readable file is expected",
                     strerror(errno));
        return NULL;
    }
    if (!S_ISREG(about.st_mode)) {
        mistakes_add(mistakes, path, 1, 1, "is %s; a YAML file is expected",
                     S_ISDIR(about.st_mode) ? "a directory" : "not a regular file");
        return NULL;
    }
    if (about.st_size > YAML_TREE_MAX_BYTES) {
        mistakes_add(
            mistakes, path, 1, 1,
            "has %lld bytes; at most %d (4 MiB) are expected (many spheres belong in a CSV "
            "file)",
            (long long)about.st_size, YAML_TREE_MAX_BYTES);
        return NULL;
    }
    char *bytes = array_allocate((size_t)about.st_size + 1, 1);
    *n = 0;
    while (*n < (size_t)about.st_size) {
        const ssize_t got = read(descriptor, bytes + *n, (size_t)about.st_size - *n);
        if (got <= 0)
            break;
        *n += (size_t)got;
    }
    if (*n == (size_t)about.st_size)
        return bytes;
    mistakes_add(mistakes, path, 1, 1,
                 "cannot be read to its end; a readable file is expected");
    free(bytes);
    return NULL;
}

bool yaml_tree_read(struct yaml_tree *tree, const char *path, struct mistakes *mistakes)
{
    *tree = (struct yaml_tree){0};
    /* Not to hang on a pipe that nobody writes to. */
    const int descriptor = open(path, O_RDONLY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) {
        mistakes_add(mistakes, path, 1, 1, "cannot be opened: %s; a readable file is expected",
                     strerror(errno));
        return false;
    }
    size_t n;
    char *bytes = file_bytes(descriptor, path, &n, mistakes);
    close(descriptor);
    if (bytes == NULL)
        return false;
    const bool fine = parse(tree, path, 1, bytes, n, YAML_TREE_MAX_NODES, mistakes);
    free(bytes);
    return fine;
}
