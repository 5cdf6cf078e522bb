/*
 * Files of facets: the same cube from STL, ASCII and binary, and from Gmsh's formats; damaged
 * files say where and what; files changed at random are read or refused, never more.
 */
#include "check.h"
#include "model/gmsh.h"
#include "model/mesh.h"
#include "model/stl.h"

#include <math.h>
#include <stdint.h>
#include <stdlib.h>

enum { ROOM = 8192, HEAD = 84, TRIANGLE = 50 };

/* Bytes of a file, and a zero after them. */
struct file {
    size_t n;
    char bytes[ROOM];
};

/* The triangles of a cube, outwards, by its corners (bit 0: x, 1: y, 2: z). */
static const int TRIANGLES[12][3] = {{0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},
                                     {0, 1, 5}, {0, 5, 4}, {2, 6, 7}, {2, 7, 3},
                                     {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}};

static float coordinate(int corner, int axis)
{
    return (corner >> axis & 1) != 0 ? 0.3F : 0.1F;
}

static void put(struct file *file, const char *text)
{
    const size_t n = strlen(text);
    memcpy(file->bytes + file->n, text, n + 1);
    file->n += n;
}

static struct file ascii_cube(void)
{
    struct file file = {0};
    char line[128];
    put(&file, "solid a cube\n");
    for (int f = 0; f < 12; f++) {
        put(&file, "  facet normal nan 0 0\n    outer loop\n");
        for (int k = 0; k < 3; k++) {
            const int c = TRIANGLES[f][k];
            snprintf(line, sizeof line, "      vertex %.9g %.9g %.9g\n",
                     (double)coordinate(c, 0), (double)coordinate(c, 1),
                     (double)coordinate(c, 2));
            put(&file, line);
        }
        put(&file, "    endloop\n  endfacet\n");
    }
    put(&file, "endsolid a cube\n");
    return file;
}

static struct file binary_cube(const char *header)
{
    struct file file = {.n = HEAD + 12 * TRIANGLE};
    memcpy(file.bytes, header, strlen(header));
    file.bytes[HEAD - 4] = 12;
    for (int f = 0; f < 12; f++)
        for (int k = 0; k < 3; k++)
            for (int axis = 0; axis < 3; axis++) {
                const float x = coordinate(TRIANGLES[f][k], axis);
                memcpy(file.bytes + HEAD + TRIANGLE * f + 12 + 12 * k + 4 * axis, &x, sizeof x);
            }
    return file;
}

/* Two physical surfaces: the cube without its top, as quads but for one; and the top. */
static const char GMSH_22[] = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                              "$PhysicalNames\n3\n1 9 \"rim\"\n2 5 \"the walls\"\n2 6 \"lid\"\n"
                              "$EndPhysicalNames\n"
                              "$Nodes\n8\n"
                              "10 0 0 0\n11 1 0 0\n12 0 1 0\n13 1 1 0\n"
                              "24 0 0 1\n23 1 0 1\n22 0 1 1\n21 1 1 1\n$EndNodes\n"
                              "$Elements\n9\n"
                              "1 15 2 0 1 10\n2 1 2 9 1 10 11\n"
                              "3 3 2 5 1 10 24 22 12\n4 3 2 5 1 11 13 21 23\n"
                              "5 3 2 5 1 10 11 23 24\n6 3 2 5 1 12 22 21 13\n"
                              "7 2 2 5 1 10 12 13\n8 2 2 5 1 10 13 11\n"
                              "9 3 2 6 2 24 23 21 22\n$EndElements\n";

static const char GMSH_41[] =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
    "$PhysicalNames\n2\n2 5 \"the walls\"\n2 6 \"lid\"\n$EndPhysicalNames\n"
    "$Entities\n1 1 2 0\n1 0 0 0 0\n1 0 0 0 1 1 1 0 2 1 1\n"
    "1 0 0 0 1 1 1 1 5 1 1\n2 0 0 1 1 1 1 2 7 6 0\n$EndEntities\n"
    "$Nodes\n2 8 10 24\n"
    "2 1 0 4\n10\n11\n12\n13\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n"
    "2 2 1 4\n24\n23\n22\n21\n0 0 1 .1 .2\n1 0 1 .1 .2\n0 1 1 .1 .2\n1 1 1 .1 .2\n$EndNodes\n"
    "$Elements\n4 8 2 9\n1 1 1 1\n2 10 11\n"
    "2 1 3 4\n3 10 24 22 12\n4 11 13 21 23\n5 10 11 23 24\n6 12 22 21 13\n"
    "2 1 2 2\n7 10 12 13\n8 10 13 11\n"
    "2 2 3 1\n9 24 23 21 22\n$EndElements\n";

/* ---- The same two files in bytes */

static void put_bytes(struct file *file, const void *bytes, size_t n)
{
    EXPECT(file->n + n < ROOM);
    memcpy(file->bytes + file->n, bytes, n);
    file->n += n;
}

/* The next n numbers of a text, as doubles, or whole numbers of 4 or 8 bytes: d, i, l; returns
 * the last. */
static int64_t put_numbers(struct file *file, const char **text, char kind, int64_t n)
{
    double value = 0.0;
    for (int64_t k = 0; k < n; k++) {
        char *end;
        value = strtod(*text, &end);
        *text = end;
        const int32_t narrow = (int32_t)value;
        const int64_t wide = (int64_t)value;
        if (kind == 'd')
            put_bytes(file, &value, sizeof value);
        else if (kind == 'i')
            put_bytes(file, &narrow, sizeof narrow);
        else
            put_bytes(file, &wide, sizeof wide);
    }
    return (int64_t)value;
}

/* Copies a text up to and with this line; returns where it goes on. */
static const char *put_until(struct file *file, const char *text, const char *line)
{
    const char *end = strstr(text, line) + strlen(line);
    put_bytes(file, text, (size_t)(end - text));
    return end;
}

static int64_t corners_of(int64_t type)
{
    return type == 15 ? 1 : type == 1 ? 2 : type == 2 ? 3 : 4;
}

static struct file binary_22(void)
{
    struct file file = {0};
    const char *at = GMSH_22 + strlen("$MeshFormat\n2.2 0 8\n");
    const int32_t one = 1;
    put(&file, "$MeshFormat\n2.2 1 8\n");
    put_bytes(&file, &one, sizeof one);
    at = put_until(&file, at, "$Nodes\n8\n");
    for (int k = 0; k < 8; k++) {
        put_numbers(&file, &at, 'i', 1);
        put_numbers(&file, &at, 'd', 3);
    }
    at = put_until(&file, at, "$Elements\n9\n");
    for (int k = 0; k < 9;) { /* the four quads are a block */
        struct file words = {0};
        const int32_t number = (int32_t)put_numbers(&words, &at, 'i', 1);
        const int64_t type = put_numbers(&words, &at, 'i', 1);
        const int32_t n = type == 3 && k < 6 ? 4 : 1;
        const int32_t head[2] = {(int32_t)type, n};
        put_bytes(&file, head, sizeof head);
        const int64_t n_tags = put_numbers(&file, &at, 'i', 1);
        put_bytes(&file, &number, sizeof number);
        put_numbers(&file, &at, 'i', n_tags + corners_of(type));
        for (int32_t m = 1; m < n; m++) {
            put_numbers(&file, &at, 'i', 1);
            put_numbers(&words, &at, 'i', 2);
            put_numbers(&file, &at, 'i', n_tags + corners_of(type));
        }
        k += n;
    }
    put(&file, at);
    return file;
}

static void put_entity(struct file *file, const char **at, int dimension)
{
    put_numbers(file, at, 'i', 1);
    put_numbers(file, at, 'd', dimension == 0 ? 3 : 6);
    put_numbers(file, at, 'i', put_numbers(file, at, 'l', 1));
    if (dimension > 0)
        put_numbers(file, at, 'i', put_numbers(file, at, 'l', 1));
}

static struct file binary_41(void)
{
    static const int entities[4] = {0, 1, 2, 2};
    struct file file = {0};
    const char *at = GMSH_41 + strlen("$MeshFormat\n4.1 0 8\n");
    const int32_t one = 1;
    put(&file, "$MeshFormat\n4.1 1 8\n");
    put_bytes(&file, &one, sizeof one);
    at = put_until(&file, at, "$Entities\n");
    put_numbers(&file, &at, 'l', 4);
    for (int k = 0; k < 4; k++)
        put_entity(&file, &at, entities[k]);
    at = put_until(&file, at, "$Nodes\n");
    put_numbers(&file, &at, 'l', 4);
    for (int64_t b = 0; b < 2; b++) {
        put_numbers(&file, &at, 'i', 2);
        const int64_t parametric = put_numbers(&file, &at, 'i', 1);
        const int64_t n = put_numbers(&file, &at, 'l', 1);
        put_numbers(&file, &at, 'l', n);
        put_numbers(&file, &at, 'd', n * (parametric != 0 ? 5 : 3));
    }
    at = put_until(&file, at, "$Elements\n");
    put_numbers(&file, &at, 'l', 4);
    for (int b = 0; b < 4; b++) {
        put_numbers(&file, &at, 'i', 2);
        const int64_t type = put_numbers(&file, &at, 'i', 1);
        put_numbers(&file, &at, 'l', put_numbers(&file, &at, 'l', 1) * (1 + corners_of(type)));
    }
    put(&file, at);
    return file;
}

static struct mesh_survey survey_of(const struct surface *surface)
{
    struct mesh mesh;
    mesh_build(&mesh, surface->n_vertices, surface->vertices, surface->n_facets,
               (const int(*)[4])surface->facets);
    const struct mesh_survey survey = mesh_survey(&mesh);
    mesh_clear(&mesh);
    return survey;
}

static void expect_cube(const struct file *file)
{
    struct surface surface;
    char *why;
    EXPECT(stl_read(&surface, "cube.stl", file->bytes, file->n, &why));
    const struct mesh_survey survey = survey_of(&surface);
    EXPECT(surface.n_facets == 12 && survey.closed && survey.n_turned == 0);
    EXPECT_NEAR(survey.volume, 0.008, 2e-9); /* 0.1 and 0.3 are rounded to single precision */
    EXPECT(survey.low.x == (double)0.1F && survey.high.z == (double)0.3F);
    surface_clear(&surface);
}

TEST(a_cube_is_the_same_from_text_and_from_bytes)
{
    struct file file = ascii_cube();
    for (size_t k = 0; k + 1 < file.n; k++) /* other ends of lines: .9g gives back the float */
        EXPECT(file.bytes[k] != '\0');
    struct surface surface;
    char *why;
    EXPECT(stl_read(&surface, "cube.stl", file.bytes, file.n, &why));
    EXPECT((float)surface.vertices[1].z == 0.3F && surface.n_vertices == 36);
    EXPECT(survey_of(&surface).closed);
    EXPECT_NEAR(survey_of(&surface).volume, 0.008, 2e-9);
    surface_clear(&surface);
    file = binary_cube("made by hand");
    expect_cube(&file);
    file = binary_cube("solid made by hand"); /* as many programs begin */
    expect_cube(&file);
}

static void refused(const struct file *file, const char *expected)
{
    struct surface surface;
    char *why = NULL;
    EXPECT(!stl_read(&surface, "f", file->bytes, file->n, &why));
    EXPECT_STRING(why, expected);
    EXPECT(surface.n_facets == 0 && surface.facets == NULL);
    free(why);
}

TEST(damaged_stl_files_say_where_and_what)
{
    struct file file = binary_cube("");
    file.n -= 1;
    refused(&file, "f: facet 12: the file ends here, but its header says 12 facets; 684 bytes "
                   "are expected, there are 683");
    file.n += 51;
    refused(&file, "f: facet 13: the file goes on after this, but its header says 12 facets; "
                   "684 bytes are expected, there are 734");
    file.n = 40;
    refused(&file, "f: 40 bytes, which are no STL file; 'solid' and facets, or a binary header "
                   "of 84 bytes, are expected");
    file.n = HEAD;
    file.bytes[HEAD - 4] = 0;
    refused(&file, "f: 0 facets; 1 to 20000000 are expected");
    file = binary_cube("");
    const float nan_value = (float)NAN;
    memcpy(file.bytes + HEAD + 2 * TRIANGLE + 12, &nan_value, sizeof nan_value);
    refused(&file, "f: facet 3: a coordinate is no finite number; lengths are expected");
    file = (struct file){.n = 0};
    refused(&file, "f: 0 bytes, which are no STL file; 'solid' and facets, or a binary header "
                   "of 84 bytes, are expected");
    file = (struct file){.n = 0};
    put(&file, "solid\nendsolid\n");
    refused(&file, "f:3:1: there are no facets in it; at least one is expected");
    file = (struct file){.n = 0};
    put(&file, "solid x\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 inf\n");
    refused(&file, "f:4:15: 'inf' is not what belongs here; 'vertex' and three finite numbers "
                   "is expected");
    file = ascii_cube();
    file.n -= 40;
    file.bytes[file.n] = '\0';
    refused(&file, "f:83:49: the file ends here; 'endloop' after three vertices is expected");
}

static void expect_group(const struct file *file, const char *group, int n_facets, double area)
{
    struct surface surface;
    char *why = NULL;
    EXPECT(gmsh_read(&surface, "f", file->bytes, file->n, group, &why));
    EXPECT(why == NULL && surface.n_facets == n_facets);
    EXPECT_NEAR(survey_of(&surface).area, area, 1e-14);
    EXPECT(survey_of(&surface).closed == (group == NULL) && survey_of(&surface).n_turned == 0);
    surface_clear(&surface);
    free(why);
}

TEST(gmsh_files_give_their_physical_groups)
{
    struct file files[4] = {{0}, {0}, binary_22(), binary_41()};
    put(&files[0], GMSH_22);
    put(&files[1], GMSH_41);
    for (int k = 0; k < 4; k++) {
        expect_group(&files[k], NULL, 7, 6.0);
        expect_group(&files[k], "the walls", 6, 5.0);
        expect_group(&files[k], "lid", 1, 1.0);
        expect_group(&files[k], "6", 1, 1.0);
    }
}

static void refused_binary(const struct file *file, const char *expected)
{
    struct surface surface;
    char *why = NULL;
    EXPECT(!gmsh_read(&surface, "f", file->bytes, file->n, NULL, &why));
    EXPECT_STRING(why, expected);
    EXPECT(surface.n_facets == 0 && surface.facets == NULL);
    free(why);
}

TEST(damaged_binary_gmsh_files_say_at_which_byte)
{
    struct file file = binary_22();
    const size_t order = strlen("$MeshFormat\n2.2 1 8\n");
    file.bytes[order] = 0;
    file.bytes[order + 3] = 1;
    refused_binary(&file, "f: byte 21: this is a big-endian file; a little-endian one, or an "
                          "ASCII one (gmsh -bin 0) is expected");
    file.bytes[order + 3] = 2;
    refused_binary(&file, "f: byte 21: this is no byte order; a one is expected");
    file = binary_22();
    file.bytes[order - 2] = '4';
    refused_binary(&file, "f:2:7: '4' is not what belongs here; 8, the bytes of a number, is "
                          "expected");
    file = binary_41(); /* cut anywhere before the elements end */
    const char *const end = "$EndElements";
    const size_t whole = file.n - strlen(end) - 1;
    for (size_t n = 1; n < whole; n++) {
        struct surface surface;
        char *why = NULL;
        struct file cut = {.n = n};
        memcpy(cut.bytes, file.bytes, n);
        EXPECT(!gmsh_read(&surface, "f", cut.bytes, cut.n, NULL, &why) && why != NULL);
        free(why);
    }
    file.n = whole - 9;
    refused_binary(&file, "f: byte 1233: the file ends here; the rest of it is expected");
}

/* A text with one piece of it replaced. */
static void refused_gmsh(const char *text, const char *piece, const char *other,
                         const char *group, const char *expected)
{
    struct file file = {0};
    struct surface surface;
    char *why = NULL;
    const char *at = strstr(text, piece);
    EXPECT(at != NULL);
    memcpy(file.bytes, text, (size_t)(at - text));
    file.n = (size_t)(at - text);
    put(&file, other);
    put(&file, at + strlen(piece));
    EXPECT(!gmsh_read(&surface, "f", file.bytes, file.n, group, &why));
    EXPECT_STRING(why, expected);
    EXPECT(surface.n_facets == 0 && surface.facets == NULL);
    free(why);
}

TEST(damaged_gmsh_files_say_where_and_what)
{
    refused_gmsh(GMSH_22, "2.2", "1.0", NULL,
                 "f:2:1: '1.0' is not what belongs here; version 2.2 or 4.1 (gmsh -format "
                 "msh41) is expected");
    refused_gmsh(
        GMSH_41, "4.1 0", "4.1 2", NULL,
        "f:2:5: '2' is not what belongs here; 0 for an ASCII file or 1 for a binary one "
        "is expected");
    refused_gmsh(GMSH_22, "3 3 2 5", "3 10 2 5", NULL,
                 "f:25:3: elements of type 10, which are curved; triangles and quads of first "
                 "order (gmsh -order 1) are expected");
    refused_gmsh(
        GMSH_22, "10 24 22", "10 99 22", NULL,
        "f:25:14: there is no node 99; one of the section $Nodes before it is expected");
    refused_gmsh(GMSH_22, "$Nodes\n8", "$Nodes\n8000", NULL,
                 "f:11:1: '8000' is not what belongs here; a count that fits the file is "
                 "expected");
    refused_gmsh(GMSH_22, "$Nodes\n8", "$Nodes\n9", NULL,
                 "f:20:1: '$EndNodes' is not what belongs here; a whole number above 0 is "
                 "expected");
    refused_gmsh(
        GMSH_41, "lid", "lid", "cover",
        "f:52:1: there is no physical group 'cover' of surfaces; one of the walls, lid "
        "is expected");
    refused_gmsh(GMSH_41, "2 3 1\n9 24 23 21 22\n$EndElements\n", "2 3 1\n9 24", NULL,
                 "f:50:5: the file ends here; a whole number above 0 is expected");
    refused_gmsh(GMSH_22, GMSH_22, "", NULL,
                 "f:1:1: there is nothing in it; $MeshFormat is expected");
    refused_gmsh(
        GMSH_22, "$MeshFormat", "solid", NULL,
        "f:1:1: 'solid' is not what belongs here; a section, like $Nodes, is expected");
    refused_gmsh(GMSH_22, "$Elements", "$NoElements", NULL,
                 "f:33:1: the file ends here; $EndNoElements is expected");
}

/* ---- Files changed at random
 * ------------------------------------------------------------------- */

static uint64_t random_state = 1;

static size_t random_below(size_t n)
{
    random_state = random_state * 6364136223846793005u + 1442695040888963407u;
    return (size_t)(random_state >> 33) % n;
}

/* Changes bytes, takes some out, doubles some, or cuts the end off. */
static void mutate(struct file *file)
{
    static const char likely[] = "0123456789-+.eE \n\"$solidvertexn\xff";
    for (size_t changes = 1 + random_below(4); changes > 0 && file->n > 16; changes--) {
        const size_t at = random_below(file->n), span = 1 + random_below(12);
        const size_t rest = file->n - at, cut = span < rest ? span : rest;
        switch (random_below(5)) {
        case 0:
            file->bytes[at] = likely[random_below(sizeof likely)];
            break;
        case 1:
            file->bytes[at] = (char)(file->bytes[at] ^ (1 << random_below(8)));
            break;
        case 2:
            memmove(file->bytes + at, file->bytes + at + cut, rest - cut);
            file->n -= cut;
            break;
        case 3:
            if (file->n + cut < ROOM) {
                memmove(file->bytes + at + cut, file->bytes + at, rest);
                file->n += cut;
            }
            break;
        default:
            if (random_below(8) == 0)
                file->n = at;
        }
    }
    file->bytes[file->n] = '\0';
}

/* Reads from memory of exactly the file's size, so that a sanitizer sees every byte beyond. */
static void read_or_refuse(const struct file *file, bool stl, const char *group)
{
    struct surface surface;
    char *why = NULL, *bytes = malloc(file->n + 1);
    memcpy(bytes, file->bytes, file->n + 1);
    const bool fine = stl ? stl_read(&surface, "f", bytes, file->n, &why)
                          : gmsh_read(&surface, "f", bytes, file->n, group, &why);
    EXPECT(fine == (why == NULL));
    EXPECT(fine == (surface.n_facets > 0));
    for (int f = 0; fine && f < surface.n_facets; f++)
        for (int k = 0; k < 4; k++)
            EXPECT(surface.facets[f][k] < surface.n_vertices &&
                   surface.facets[f][k] >= (k < 3 ? 0 : -1));
    if (fine && random_below(16) == 0)
        survey_of(&surface);
    surface_clear(&surface);
    free(bytes);
    free(why);
}

TEST(files_changed_at_random_are_read_or_refused)
{
    const char *count = getenv("MUTATIONS");
    const int n = count != NULL ? atoi(count) : 1000;
    for (int k = 0; k < n; k++) {
        struct file files[6] = {ascii_cube(), binary_cube("solid"), {0},
                                {0},          binary_22(),          binary_41()};
        put(&files[2], GMSH_22);
        put(&files[3], GMSH_41);
        for (int f = 0; f < 6; f++) {
            mutate(&files[f]);
            read_or_refuse(&files[f], f < 2, k % 2 == 0 ? "lid" : NULL);
        }
    }
}

int main(int argc, char **argv)
{
    return check_run(argc, argv);
}
