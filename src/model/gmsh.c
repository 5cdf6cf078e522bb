/*
 * A file is read for its surfaces or for its solids: what of it is kept is decided where an
 * element is met, all else is the same.
 *
 * A file is a sequence of sections, $Name to $EndName, of which four matter: the format, the
 * names of physical groups, the nodes, the elements; and in 4.1 the entities, which say what
 * groups a surface belongs to (in 2.2 each element does).  Nodes have numbers of any size; they
 * are found by bisection.  Counts are believed only as far as the file is long.
 *
 * In a binary file entities, nodes and elements are the same numbers as in text, as bytes, most
 * of them of four, in 4.1 counts and tags of nodes and elements of eight; 2.2 counts in text
 * and gathers elements of a type into blocks.  The least byte comes first, as in this machine.
 *
 * Format: https://gmsh.info/doc/texinfo/gmsh.html#File-formats, chapters "MSH file format" and
 * "MSH file format version 2 (Legacy)".
 */
#include "model/gmsh.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/scan.h"
#include "job/job.h"

enum { LINE = 1, TRIANGLE = 2, QUAD = 3, TETRAHEDRON = 4, HEXAHEDRON = 5, POINT = 15 };
enum { SURFACE = 2, NAME_SHOWN = 300 };

struct node {
    int64_t tag;
    struct vec3 place;
};

/* A physical group by its dimension and number, and its name where it has one. */
struct name {
    int dimension;
    int64_t tag;
    const char *text; /* in the file */
    size_t length;
};

/* 4.1: what is meshed, and the physical groups that it belongs to. */
struct entity {
    int dimension;
    int64_t tag;
    int first, n; /* in the list of their numbers */
};

/* An item of a group while groups are mixed. */
struct member {
    int group, item[4];
};

/* Solids, while they are read. */
struct solids {
    struct job_volume *into;
    int n_names, name_capacity, n_entities, entity_capacity, n_physicals, physical_capacity;
    int n_members, member_capacity, element_capacity, number_capacity, group_capacity;
    struct name *names;
    struct entity *entities;
    int64_t *physicals;
    struct member *members;
    struct name last; /* whose group was asked for last, and that group */
    int last_group;
};

struct reader {
    struct scan scan;
    int64_t n_bytes; /* of the file */
    struct surface *surface;
    struct solids *solids;   /* NULL where surfaces are read */
    const char *group;       /* NULL: all */
    int version;             /* 22 or 41; 0: not said yet */
    bool binary, bytes;      /* the file; what is read now */
    int64_t physical;        /* of the group; 0: not found */
    char others[NAME_SHOWN]; /* the groups that there are */
    int n_nodes, node_capacity;
    struct node *nodes;
    bool nodes_ascend;
    int n_chosen, chosen_capacity; /* 4.1: surfaces in the group */
    int64_t *chosen;
    int64_t n_surface_elements; /* of any group */
};

static const char COUNT[] = "a count that fits the file";
static const char TAG[] = "a whole number above 0";

/* Bytes that a number takes in a binary file: most, and in 4.1 counts and tags of nodes and
 * elements. */
enum { SHORT = 4, LONG = 8 };

static int tag_size(const struct reader *reader)
{
    return reader->version == 41 ? LONG : SHORT;
}

static bool complain_at_byte(struct reader *reader, const char *at, const char *what,
                             const char *expected)
{
    struct scan *scan = &reader->scan;
    const char *start = scan->end - reader->n_bytes;
    if (scan->why == NULL)
        scan->why = array_format("%s: byte %lld: %s; %s is expected", scan->path,
                                 (long long)(at - start) + 1, what, expected);
    return false;
}

/* Goes over n pieces of these many bytes. */
static bool skip_bytes(struct reader *reader, int64_t n, int64_t size)
{
    struct scan *scan = &reader->scan;
    if (n > (scan->end - scan->at) / size)
        return complain_at_byte(reader, scan->end, "the file ends here", "the rest of it");
    scan->at += n * size;
    return true;
}

static bool take(struct reader *reader, void *into, int size)
{
    const char *at = reader->scan.at;
    if (!skip_bytes(reader, 1, size))
        return false;
    memcpy(into, at, (size_t)size);
    return true;
}

static bool read_whole(struct reader *reader, int size, int64_t least, int64_t most,
                       int64_t *value, const char *expected)
{
    const char *at = reader->scan.at;
    int32_t narrow = 0;
    if (!reader->bytes)
        return scan_whole(&reader->scan, least, most, value, expected);
    if (!(size == SHORT ? take(reader, &narrow, size) : take(reader, value, size)))
        return false;
    if (size == SHORT)
        *value = narrow;
    if (*value >= least && *value <= most)
        return true;
    char what[64];
    snprintf(what, sizeof what, "%lld is not what belongs here", (long long)*value);
    return complain_at_byte(reader, at, what, expected);
}

static bool read_count(struct reader *reader, int64_t *count)
{
    /* Whatever is counted takes two bytes at least. */
    const int64_t most = (reader->scan.end - reader->scan.at) / 2;
    return read_whole(reader, tag_size(reader), 0, most, count, COUNT);
}

static bool read_any(struct reader *reader, int size, int64_t *value)
{
    return read_whole(reader, size, -INT64_MAX, INT64_MAX, value, "a whole number");
}

static bool read_number(struct reader *reader, double *value)
{
    static const char EXPECTED[] = "a finite number";
    const char *at = reader->scan.at;
    if (!reader->bytes)
        return scan_number(&reader->scan, value, EXPECTED);
    if (!take(reader, value, sizeof *value))
        return false;
    return isfinite(*value) ||
           complain_at_byte(reader, at, "infinity, or no number, does not belong here",
                            EXPECTED);
}

static bool read_numbers(struct reader *reader, int64_t n, double *values, int keep)
{
    double value;
    for (int64_t k = 0; k < n; k++) {
        if (!read_number(reader, &value))
            return false;
        if (k < keep)
            values[k] = value;
    }
    return true;
}

/* From here on there are bytes, in a binary file; the line's end belongs to the text. */
static void begin_bytes(struct reader *reader)
{
    struct scan *scan = &reader->scan;
    if (!reader->binary)
        return;
    scan_skip_line(scan);
    scan->at += scan->at < scan->end;
    reader->bytes = true;
}

/* ---- Head
 * ------------------------------------------------------------------------------------- */

/* A binary file says how long numbers are, and shows a one. */
static bool read_byte_order(struct reader *reader)
{
    struct scan *scan = &reader->scan;
    int64_t one;
    if (!scan_word(scan) || !scan_is(scan, "8"))
        return scan_refuse(scan, "8, the bytes of a number,");
    begin_bytes(reader);
    const char *at = scan->at;
    if (!read_any(reader, SHORT, &one))
        return false;
    reader->bytes = false;
    if (one == 0x01000000)
        return complain_at_byte(reader, at, "this is a big-endian file",
                                "a little-endian one, or an ASCII one (gmsh -bin 0)");
    return one == 1 || complain_at_byte(reader, at, "this is no byte order", "a one");
}

static bool read_format(struct reader *reader)
{
    struct scan *scan = &reader->scan;
    if (!scan_word(scan))
        return scan_refuse(scan, "the version of the format");
    if (scan_is(scan, "2.2") || scan_is(scan, "2.1") || scan_is(scan, "2"))
        reader->version = 22;
    else if (scan_is(scan, "4.1"))
        reader->version = 41;
    else
        return scan_refuse(scan, "version 2.2 or 4.1 (gmsh -format msh41)");
    if (!scan_word(scan) || !(scan_is(scan, "0") || scan_is(scan, "1")))
        return scan_refuse(scan, "0 for an ASCII file or 1 for a binary one");
    reader->binary = scan_is(scan, "1");
    if (reader->binary)
        return read_byte_order(reader);
    scan_skip_line(scan);
    return true;
}

static void list_group(struct reader *reader, const char *name, size_t length)
{
    const size_t used = strlen(reader->others);
    if (used + length + 3 < sizeof reader->others) {
        memcpy(reader->others + used, used > 0 ? ", " : "", used > 0 ? 3 : 1);
        strncat(reader->others, name, length);
    }
}

static void note_name(struct solids *solids, struct name name)
{
    ARRAY_GROW(solids->names, solids->n_names + 1, solids->name_capacity);
    solids->names[solids->n_names++] = name;
}

static bool read_names(struct reader *reader)
{
    struct scan *scan = &reader->scan;
    int64_t n, dimension, tag;
    if (!read_count(reader, &n))
        return false;
    for (int64_t k = 0; k < n; k++) {
        if (!read_any(reader, SHORT, &dimension) || !read_any(reader, SHORT, &tag))
            return false;
        if (!scan_word_of_line(scan) || scan->word[0] != '"')
            return scan_refuse(scan, "the group's name in quotes");
        const char *name = scan->word + 1;
        scan_skip_line(scan);
        const char *quote = name;
        while (quote < scan->at && *quote != '"')
            quote++;
        const size_t length = (size_t)(quote - name);
        if (reader->solids != NULL)
            note_name(reader->solids, (struct name){(int)dimension, tag, name, length});
        if (dimension != SURFACE || reader->solids != NULL)
            continue;
        list_group(reader, name, length);
        if (reader->group != NULL && strlen(reader->group) == length &&
            memcmp(reader->group, name, length) == 0)
            reader->physical = tag;
    }
    return true;
}

/* ---- Entities, 4.1
 * ---------------------------------------------------------------------------- */

/* Leaves out the last list of an entity: what is left of its line. */
static bool skip_list(struct reader *reader)
{
    int64_t n;
    if (reader->bytes)
        return read_count(reader, &n) && skip_bytes(reader, n, SHORT);
    scan_skip_line(&reader->scan);
    return true;
}

/* Leaves out a point or a curve: tag, place or box, physical groups, of a curve its ends. */
static bool skip_entity(struct reader *reader, int dimension)
{
    if (reader->bytes)
        return skip_bytes(reader, 1, SHORT + (dimension == 0 ? 3 : 6) * LONG) &&
               skip_list(reader) && (dimension == 0 || skip_list(reader));
    if (!scan_word(&reader->scan))
        return scan_refuse(&reader->scan, "an entity");
    return skip_list(reader);
}

static void note_entity(struct solids *solids, int dimension, int64_t tag, int first)
{
    ARRAY_GROW(solids->entities, solids->n_entities + 1, solids->entity_capacity);
    solids->entities[solids->n_entities++] =
        (struct entity){dimension, tag, first, solids->n_physicals - first};
}

/* An entity's tag, place or box, physical groups and borders; one of a surface is chosen where
 * it is in the group. */
static bool read_entity(struct reader *reader, int dimension)
{
    struct solids *solids = reader->solids;
    const int first = solids != NULL ? solids->n_physicals : 0;
    int64_t tag, n, value;
    bool chosen = false;
    if (!read_any(reader, SHORT, &tag) ||
        !read_numbers(reader, dimension == 0 ? 3 : 6, NULL, 0) || !read_count(reader, &n))
        return false;
    for (int64_t k = 0; k < n; k++) {
        if (!read_any(reader, SHORT, &value))
            return false;
        chosen = chosen || value == reader->physical || -value == reader->physical;
        if (solids == NULL)
            continue;
        ARRAY_GROW(solids->physicals, solids->n_physicals + 1, solids->physical_capacity);
        solids->physicals[solids->n_physicals++] = value < 0 ? -value : value;
    }
    if (dimension > 0 && !skip_list(reader))
        return false;
    if (solids != NULL)
        note_entity(solids, dimension, tag, first);
    if (chosen && reader->physical != 0) {
        ARRAY_GROW(reader->chosen, reader->n_chosen + 1, reader->chosen_capacity);
        reader->chosen[reader->n_chosen++] = tag;
    }
    return true;
}

static bool read_entities(struct reader *reader)
{
    int64_t n[4];
    begin_bytes(reader);
    for (int d = 0; d < 4; d++)
        if (!read_count(reader, &n[d]))
            return false;
    if (!reader->bytes)
        scan_skip_line(&reader->scan);
    for (int d = 0; d <= (reader->solids != NULL ? 3 : SURFACE); d++)
        for (int64_t k = 0; k < n[d]; k++) /* in text a line each */
            if (!(d == SURFACE || reader->solids != NULL ? read_entity(reader, d)
                                                         : skip_entity(reader, d)))
                return false;
    return true;
}

/* ---- Nodes
 * ------------------------------------------------------------------------------------ */

static int compare_nodes(const void *a, const void *b)
{
    const struct node *p = a, *q = b;
    return (p->tag > q->tag) - (p->tag < q->tag);
}

static void add_node(struct reader *reader, int64_t tag)
{
    ARRAY_GROW(reader->nodes, reader->n_nodes + 1, reader->node_capacity);
    if (reader->n_nodes > 0 && tag <= reader->nodes[reader->n_nodes - 1].tag)
        reader->nodes_ascend = false;
    reader->nodes[reader->n_nodes++] = (struct node){.tag = tag};
}

static bool read_place(struct reader *reader, struct node *node, int64_t n_numbers)
{
    double x[3];
    if (!read_numbers(reader, n_numbers, x, 3))
        return false;
    node->place = (struct vec3){x[0], x[1], x[2]};
    return true;
}

static bool read_nodes_22(struct reader *reader)
{
    int64_t n, tag;
    if (!read_count(reader, &n))
        return false;
    begin_bytes(reader);
    for (int64_t k = 0; k < n; k++) {
        if (!read_whole(reader, SHORT, 1, INT64_MAX, &tag, TAG))
            return false;
        add_node(reader, tag);
        if (!read_place(reader, &reader->nodes[reader->n_nodes - 1], 3))
            return false;
    }
    return true;
}

/* A block: the numbers of its nodes, then their places. */
static bool read_node_block(struct reader *reader)
{
    int64_t dimension, entity, parametric, n, tag;
    if (!read_whole(reader, SHORT, 0, 3, &dimension, "a dimension, 0 to 3,") ||
        !read_any(reader, SHORT, &entity) ||
        !read_whole(reader, SHORT, 0, 1, &parametric, "0 or 1") || !read_count(reader, &n))
        return false;
    const int first = reader->n_nodes;
    for (int64_t k = 0; k < n; k++) {
        if (!read_whole(reader, LONG, 1, INT64_MAX, &tag, TAG))
            return false;
        add_node(reader, tag);
    }
    for (int k = first; k < reader->n_nodes; k++)
        if (!read_place(reader, &reader->nodes[k], 3 + (parametric != 0 ? dimension : 0)))
            return false;
    return true;
}

static bool read_nodes_41(struct reader *reader)
{
    int64_t n_blocks, value;
    begin_bytes(reader);
    if (!read_count(reader, &n_blocks))
        return false;
    for (int k = 0; k < 3; k++) /* how many nodes, least and largest number */
        if (!read_any(reader, LONG, &value))
            return false;
    for (int64_t b = 0; b < n_blocks; b++)
        if (!read_node_block(reader))
            return false;
    return true;
}

static bool read_nodes(struct reader *reader)
{
    if (reader->n_nodes > 0)
        return scan_complain(&reader->scan, "nodes a second time; one section is expected");
    const bool fine = reader->version == 22 ? read_nodes_22(reader) : read_nodes_41(reader);
    if (fine && !reader->nodes_ascend)
        qsort(reader->nodes, (size_t)reader->n_nodes, sizeof *reader->nodes, compare_nodes);
    return fine;
}

/* ---- Elements
 * --------------------------------------------------------------------------------- */

/* Of what solids are made, and what their groups may hold; all else is refused. */
static int corners_of_solids(int64_t type, int *dimension)
{
    switch (type) {
    case POINT:
        *dimension = 0;
        return 1;
    case LINE:
        *dimension = 1;
        return 2;
    case TRIANGLE:
    case QUAD:
        *dimension = SURFACE;
        return type == TRIANGLE ? 3 : 4;
    case TETRAHEDRON:
    case HEXAHEDRON:
        *dimension = 3;
        return type == TETRAHEDRON ? 4 : 8;
    default:
        return -1;
    }
}

/* Corners of the elements that are taken; 0: left aside; -1: refused. */
static int corners_of(const struct reader *reader, int64_t type)
{
    int dimension;
    if (reader->solids != NULL)
        return corners_of_solids(type, &dimension);
    static const char second_order[] = {9, 10, 16, 20, 21, 22, 23, 24, 25};
    if (type == TRIANGLE || type == QUAD)
        return type == TRIANGLE ? 3 : 4;
    for (size_t k = 0; k < sizeof second_order; k++)
        if (type == second_order[k])
            return -1;
    return 0;
}

static bool refuse_solid(struct reader *reader, const char *at, int64_t type)
{
    const char *kind = type == 6   ? "prisms"
                       : type == 7 ? "pyramids"
                                   : "which are curved or of higher order";
    static const char EXPECTED[] = "a mesh of hexahedra with 8 and tetrahedra with 4 nodes "
                                   "(gmsh -order 1)";
    char what[96];
    snprintf(what, sizeof what, "elements of type %lld, %s", (long long)type, kind);
    return reader->bytes ? complain_at_byte(reader, at, what, EXPECTED)
                         : scan_complain(&reader->scan, "%s; %s is expected", what, EXPECTED);
}

static bool read_type(struct reader *reader, int64_t *type)
{
    const char *at = reader->scan.at;
    if (!read_whole(reader, SHORT, 1, 1000, type, "the type of an element"))
        return false;
    if (corners_of(reader, *type) >= 0)
        return true;
    if (reader->solids != NULL)
        return refuse_solid(reader, at, *type);
    if (!reader->bytes)
        return scan_complain(&reader->scan,
                             "elements of type %lld, which are curved; triangles and quads of "
                             "first order (gmsh -order 1) are expected",
                             (long long)*type);
    char what[64];
    snprintf(what, sizeof what, "elements of type %lld, which are curved", (long long)*type);
    return complain_at_byte(reader, at, what,
                            "a mesh of triangles and quads of first order (gmsh -order 1)");
}

/* Leaves out what is left of an element: in a binary file its nodes, which each type has its
 * number of. */
static bool skip_element(struct reader *reader, int64_t type)
{
    static const char NODES[] = {0, 2,  3,  4,  4, 8,  6,  5,  3,  6,  9, 10, 27, 18, 14, 1,
                                 8, 20, 15, 13, 9, 10, 12, 15, 15, 21, 4, 5,  6,  20, 35, 56};
    if (!reader->bytes) {
        scan_skip_line(&reader->scan);
        return true;
    }
    if (type < (int64_t)sizeof NODES)
        return skip_bytes(reader, NODES[type], tag_size(reader));
    char what[64];
    snprintf(what, sizeof what, "elements of type %lld", (long long)type);
    return complain_at_byte(reader, reader->scan.at, what, "a mesh of lower order");
}

/* The next corner of an element: its node. */
static bool read_corner(struct reader *reader, int *corner)
{
    struct node wanted = {0};
    if (!read_whole(reader, tag_size(reader), 1, INT64_MAX, &wanted.tag, TAG))
        return false;
    const struct node *node = reader->n_nodes > 0
                                  ? bsearch(&wanted, reader->nodes, (size_t)reader->n_nodes,
                                            sizeof *reader->nodes, compare_nodes)
                                  : NULL;
    if (node == NULL)
        return scan_complain(&reader->scan,
                             "there is no node %lld; one of the section $Nodes before it "
                             "is expected",
                             (long long)wanted.tag);
    *corner = (int)(node - reader->nodes);
    return true;
}

/* The corners of an element that is in the group. */
static bool read_corners(struct reader *reader, int n)
{
    int corners[4] = {-1, -1, -1, -1};
    if (reader->surface->n_facets == SURFACE_FACETS_MOST)
        return scan_complain(&reader->scan, "more than %d facets; fewer are expected",
                             SURFACE_FACETS_MOST);
    for (int k = 0; k < n; k++)
        if (!read_corner(reader, &corners[k]))
            return false;
    surface_add_facet(reader->surface, corners[0], corners[1], corners[2], corners[3]);
    return true;
}

/* The group of this dimension and number, made where there is none yet. */
static int find_group(struct solids *solids, int dimension, int64_t tag)
{
    struct job_volume *volume = solids->into;
    char name[JOB_VOLUME_NAME];
    if (volume->n_groups > 0 && solids->last.dimension == dimension && solids->last.tag == tag)
        return solids->last_group;
    solids->last = (struct name){.dimension = dimension, .tag = tag};
    snprintf(name, sizeof name, "%lld", (long long)tag);
    for (int k = 0; k < solids->n_names; k++) {
        const struct name *known = &solids->names[k];
        if (known->dimension == dimension && known->tag == tag)
            snprintf(name, sizeof name, "%.*s", (int)known->length, known->text);
    }
    for (int g = 0; g < volume->n_groups; g++)
        if (volume->groups[g].dimension == dimension &&
            strcmp(volume->groups[g].name, name) == 0)
            return solids->last_group = g;
    ARRAY_GROW(volume->groups, volume->n_groups + 1, solids->group_capacity);
    struct job_volume_group *group = &volume->groups[volume->n_groups];
    group->dimension = dimension;
    memcpy(group->name, name, sizeof name);
    return solids->last_group = volume->n_groups++;
}

/* An element of these physical groups, as it stands or falls to solids. */
static bool read_solid(struct reader *reader, int64_t type, int64_t number, int n_physicals,
                       const int64_t *physicals)
{
    struct solids *solids = reader->solids;
    struct job_volume *volume = solids->into;
    int corners[8] = {-1, -1, -1, -1, -1, -1, -1, -1}, dimension = 0;
    const int n = corners_of_solids(type, &dimension);
    for (int k = 0; k < n; k++)
        if (!read_corner(reader, &corners[k]))
            return false;
    if (dimension == 3) {
        if (volume->n_elements == GMSH_ELEMENTS_MOST)
            return scan_complain(&reader->scan, "more than %d elements; fewer are expected",
                                 GMSH_ELEMENTS_MOST);
        ARRAY_GROW(volume->elements, volume->n_elements + 1, solids->element_capacity);
        ARRAY_GROW(volume->element_numbers, volume->n_elements + 1, solids->number_capacity);
        volume->element_numbers[volume->n_elements] = number;
        memcpy(volume->elements[volume->n_elements], corners, sizeof corners);
        corners[0] = volume->n_elements++;
    }
    for (int k = 0; k < n_physicals; k++) {
        if (physicals[k] == 0)
            continue;
        struct member member = {find_group(solids, dimension, physicals[k]), {0}};
        memcpy(member.item, corners, sizeof member.item);
        ARRAY_GROW(solids->members, solids->n_members + 1, solids->member_capacity);
        solids->members[solids->n_members++] = member;
    }
    return true;
}

/* The tags and the corners of an element. */
static bool read_element_22(struct reader *reader, int64_t type, int64_t number, int64_t n_tags)
{
    int64_t tag, physical = 0;
    for (int64_t k = 0; k < n_tags; k++) {
        if (!read_any(reader, SHORT, &tag))
            return false;
        physical = k == 0 ? tag : physical;
    }
    if (physical < 0 && physical > -INT64_MAX) /* looks the other way: no matter */
        physical = -physical;
    if (reader->solids != NULL)
        return read_solid(reader, type, number, 1, &physical);
    const int n = corners_of(reader, type);
    reader->n_surface_elements += n > 0;
    if (n == 0 || (reader->group != NULL && physical != reader->physical))
        return skip_element(reader, type);
    return read_corners(reader, n);
}

/* number type how-many-tags, of each element in text; in bytes of a block: type, how many
 * elements, how many tags, and each with its number.  Gives how many were read. */
static bool read_elements_22(struct reader *reader, int64_t left, int64_t *n_read)
{
    int64_t number = 0, type, n_tags, n = 1;
    if (!reader->bytes && !read_any(reader, SHORT, &number))
        return false;
    if (!read_type(reader, &type) ||
        (reader->bytes &&
         !read_whole(reader, SHORT, 1, left, &n, "the number of elements of a block")) ||
        !read_whole(reader, SHORT, 0, 100000, &n_tags, "the number of the element's tags"))
        return false;
    for (int64_t k = 0; k < n; k++)
        if ((reader->bytes && !read_any(reader, SHORT, &number)) ||
            !read_element_22(reader, type, number, n_tags))
            return false;
    *n_read = n;
    return true;
}

static bool is_chosen(const struct reader *reader, int64_t entity)
{
    for (int k = 0; k < reader->n_chosen; k++)
        if (reader->chosen[k] == entity)
            return true;
    return reader->group == NULL;
}

/* The elements of an entity. */
static bool read_solid_block(struct reader *reader, int64_t dimension, int64_t tag,
                             int64_t type, int64_t n_elements)
{
    const struct solids *solids = reader->solids;
    const struct entity *entity = NULL;
    int64_t number;
    for (int k = 0; k < solids->n_entities && entity == NULL; k++)
        if (solids->entities[k].dimension == dimension && solids->entities[k].tag == tag)
            entity = &solids->entities[k];
    for (int64_t k = 0; k < n_elements; k++)
        if (!read_any(reader, LONG, &number) ||
            !read_solid(reader, type, number, entity != NULL ? entity->n : 0,
                        entity != NULL ? solids->physicals + entity->first : NULL))
            return false;
    return true;
}

/* number corners..., a line each */
static bool read_element_block(struct reader *reader)
{
    int64_t dimension, entity, type, n_elements, number;
    if (!read_whole(reader, SHORT, 0, 3, &dimension, "a dimension, 0 to 3,") ||
        !read_any(reader, SHORT, &entity) || !read_type(reader, &type) ||
        !read_count(reader, &n_elements))
        return false;
    if (reader->solids != NULL)
        return read_solid_block(reader, dimension, entity, type, n_elements);
    const int n = corners_of(reader, type);
    const bool taken = n > 0 && is_chosen(reader, entity);
    reader->n_surface_elements += n > 0 ? n_elements : 0;
    for (int64_t k = 0; k < n_elements; k++) {
        if (!read_any(reader, LONG, &number) ||
            !(taken ? read_corners(reader, n) : skip_element(reader, type)))
            return false;
    }
    return true;
}

static bool read_blocks(struct reader *reader)
{
    int64_t n, value;
    begin_bytes(reader);
    if (!read_count(reader, &n))
        return false;
    for (int k = 0; k < 3; k++)
        if (!read_any(reader, LONG, &value))
            return false;
    for (int64_t k = 0; k < n; k++)
        if (!read_element_block(reader))
            return false;
    return true;
}

static bool read_elements(struct reader *reader)
{
    int64_t n, n_read;
    if (reader->version == 41)
        return read_blocks(reader);
    if (!read_count(reader, &n))
        return false;
    begin_bytes(reader);
    for (; n > 0; n -= n_read)
        if (!read_elements_22(reader, n, &n_read))
            return false;
    return true;
}

/* ---- File
 * ------------------------------------------------------------------------------------- */

/* Leaves out a section that nobody needs. */
static bool skip_section(struct scan *scan, const char *end)
{
    while (scan_word(scan)) {
        if (scan_is(scan, end))
            return true;
        scan_skip_line(scan);
    }
    return scan_refuse(scan, end);
}

static bool read_section(struct reader *reader)
{
    enum { SECTION = 64 };
    struct scan *scan = &reader->scan;
    char end[SECTION] = "$End";
    if (scan->word[0] != '$' || scan->length > SECTION - 5)
        return scan_refuse(scan, "a section, like $Nodes,");
    strncat(end, scan->word + 1, scan->length - 1);
    bool (*read)(struct reader *) = NULL;
    if (scan_is(scan, "$MeshFormat"))
        read = read_format;
    else if (reader->version == 0 && !scan_is(scan, "$Comments"))
        return scan_refuse(scan, "$MeshFormat, the first section of a .msh file,");
    else if (scan_is(scan, "$PhysicalNames"))
        read = read_names;
    else if (scan_is(scan, "$Entities") && reader->version == 41)
        read = read_entities;
    else if (scan_is(scan, "$Nodes"))
        read = read_nodes;
    else if (scan_is(scan, "$Elements"))
        read = read_elements;
    if (read == NULL)
        return skip_section(scan, end);
    const bool fine = read(reader);
    reader->bytes = false;
    return fine && skip_section(scan, end);
}

static bool read_sections(struct reader *reader)
{
    struct scan *scan = &reader->scan;
    bool any = false;
    for (; scan_word(scan); any = true)
        if (!read_section(reader))
            return false;
    return any || scan_complain(scan, "there is nothing in it; $MeshFormat is expected");
}

static bool read_file(struct reader *reader)
{
    struct scan *scan = &reader->scan;
    if (!read_sections(reader))
        return false;
    if (reader->group != NULL && reader->physical == 0)
        return scan_complain(scan,
                             "there is no physical group '%s' of surfaces; %s%s is expected",
                             reader->group, reader->others[0] != '\0' ? "one of " : "a name",
                             reader->others[0] != '\0' ? reader->others : " in $PhysicalNames");
    if (reader->surface->n_facets == 0)
        return scan_complain(
            scan, "there are no triangles or quads in it%s%s%s; at least one is expected",
            reader->n_surface_elements > 0 ? " in group '" : "",
            reader->n_surface_elements > 0 ? reader->group : "",
            reader->n_surface_elements > 0 ? "'" : "");
    return true;
}

bool gmsh_read(struct surface *surface, const char *path, const char *bytes, size_t n,
               const char *group, char **why)
{
    struct reader reader = {
        .n_bytes = (int64_t)n, .surface = surface, .group = group, .nodes_ascend = true};
    *surface = (struct surface){0};
    scan_init(&reader.scan, path, bytes, n);
    if (group != NULL && strspn(group, "0123456789") == strlen(group)) /* one without a name */
        reader.physical = strtoll(group, NULL, 10);
    const bool fine = read_file(&reader);
    *why = reader.scan.why;
    if (fine)
        for (int k = 0; k < reader.n_nodes; k++)
            surface_add_vertex(surface, reader.nodes[k].place);
    else
        surface_clear(surface);
    free(reader.nodes);
    free(reader.chosen);
    return fine;
}

/* Puts nodes in their place, and the items of groups one behind the other. */
static void finish_solids(const struct reader *reader)
{
    const struct solids *solids = reader->solids;
    struct job_volume *volume = solids->into;
    volume->n_nodes = reader->n_nodes;
    volume->nodes = array_allocate((size_t)volume->n_nodes, sizeof *volume->nodes);
    volume->node_numbers =
        array_allocate((size_t)volume->n_nodes, sizeof *volume->node_numbers);
    for (int k = 0; k < volume->n_nodes; k++) {
        volume->nodes[k] = reader->nodes[k].place;
        volume->node_numbers[k] = reader->nodes[k].tag;
    }
    volume->n_items = solids->n_members;
    volume->items = array_allocate((size_t)volume->n_items, sizeof *volume->items);
    for (int k = 0; k < solids->n_members; k++)
        volume->groups[solids->members[k].group].n++;
    for (int g = 1; g < volume->n_groups; g++)
        volume->groups[g].first = volume->groups[g - 1].first + volume->groups[g - 1].n;
    for (int g = 0; g < volume->n_groups; g++)
        volume->groups[g].n = 0;
    for (int k = 0; k < solids->n_members; k++) {
        struct job_volume_group *group = &volume->groups[solids->members[k].group];
        memcpy(volume->items[group->first + group->n++], solids->members[k].item,
               sizeof *volume->items);
    }
}

bool gmsh_read_solid(struct job_volume *volume, const char *path, const char *bytes, size_t n,
                     char **why)
{
    struct solids solids = {.into = volume};
    struct reader reader = {.n_bytes = (int64_t)n, .solids = &solids, .nodes_ascend = true};
    *volume = (struct job_volume){0};
    scan_init(&reader.scan, path, bytes, n);
    bool fine = read_sections(&reader);
    if (fine && volume->n_elements == 0)
        fine = scan_complain(&reader.scan, "there are no hexahedra or tetrahedra in it; a mesh "
                                           "of volumes (gmsh -3) is expected");
    *why = reader.scan.why;
    if (fine)
        finish_solids(&reader);
    else
        job_volume_clear(volume);
    free(reader.nodes);
    free(reader.chosen);
    free(solids.names);
    free(solids.entities);
    free(solids.physicals);
    free(solids.members);
    return fine;
}
