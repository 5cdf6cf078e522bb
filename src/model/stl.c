/*
 * A binary file is 80 bytes of anything, a count, and 50 bytes a triangle, so its length says
 * what it is: a file of that length is binary even where it begins with "solid", as many
 * programs' do.  What begins with "solid" and holds no byte that a text has not is ASCII.  The
 * rest is a binary file that is damaged.
 *
 * An ASCII file may hold several solids; keywords are read in any case.
 */
#include "model/stl.h"

#include <inttypes.h>
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <strings.h>

#include "base/array.h"
#include "base/scan.h"

enum { HEAD = 84, TRIANGLE = 50, NORMAL = 12, LOOKED_AT = 1024 };

/* ---- Binary
 * ----------------------------------------------------------------------------------- */

static uint32_t word_at(const char *bytes)
{
    const unsigned char *b = (const unsigned char *)bytes;
    return (uint32_t)b[0] | (uint32_t)b[1] << 8 | (uint32_t)b[2] << 16 | (uint32_t)b[3] << 24;
}

static double float_at(const char *bytes)
{
    const uint32_t word = word_at(bytes);
    float value;
    memcpy(&value, &word, sizeof value);
    return (double)value;
}

static bool read_triangle(struct surface *surface, const char *path, uint32_t f,
                          const char *bytes, char **why)
{
    int corners[3];
    for (int k = 0; k < 3; k++) {
        const char *at = bytes + NORMAL + 12 * k;
        const struct vec3 x = {float_at(at), float_at(at + 4), float_at(at + 8)};
        if (!(isfinite(x.x) && isfinite(x.y) && isfinite(x.z))) {
            *why = array_format("%s: facet %" PRIu32 ": a coordinate is no finite number; "
                                "lengths are expected",
                                path, f + 1);
            return false;
        }
        corners[k] = surface_add_vertex(surface, x);
    }
    surface_add_facet(surface, corners[0], corners[1], corners[2], -1);
    return true;
}

static bool read_binary(struct surface *surface, const char *path, const char *bytes, size_t n,
                        char **why)
{
    if (n < HEAD) {
        *why = array_format("%s: %zu bytes, which are no STL file; 'solid' and facets, or a "
                            "binary header of %d bytes, are expected",
                            path, n, HEAD);
        return false;
    }
    const uint32_t said = word_at(bytes + HEAD - 4);
    const uint64_t wanted = HEAD + (uint64_t)TRIANGLE * said;
    if (n != wanted) {
        *why = array_format("%s: facet %zu: the file %s, but its header says %" PRIu32
                            " facets; %" PRIu64 " bytes are expected, there are %zu",
                            path, (n - HEAD) / TRIANGLE + (n < wanted ? 1 : 0),
                            n < wanted ? "ends here" : "goes on after this", said, wanted, n);
        return false;
    }
    if (said == 0 || said > SURFACE_FACETS_MOST) {
        *why = array_format("%s: %" PRIu32 " facets; 1 to %d are expected", path, said,
                            SURFACE_FACETS_MOST);
        return false;
    }
    for (uint32_t f = 0; f < said; f++)
        if (!read_triangle(surface, path, f, bytes + HEAD + (size_t)f * TRIANGLE, why))
            return false;
    return true;
}

/* ---- ASCII
 * ------------------------------------------------------------------------------------ */

/* After the word "facet". */
static bool read_facet(struct scan *scan, struct surface *surface)
{
    static const char normal[] = "'normal' and three numbers",
                      loop[] = "'outer loop' and three vertices",
                      vertex[] = "'vertex' and three finite numbers";
    double value;
    int corners[3];
    if (!scan_expect(scan, "normal", normal))
        return false;
    for (int k = 0; k < 3; k++) /* some programs write nan here: nobody uses it */
        if (!scan_word(scan))
            return scan_refuse(scan, normal);
    if (!scan_expect(scan, "outer", loop) || !scan_expect(scan, "loop", loop))
        return false;
    for (int k = 0; k < 3; k++) {
        double x[3];
        if (!scan_expect(scan, "vertex", vertex))
            return false;
        for (int c = 0; c < 3; c++) {
            if (!scan_number(scan, &value, vertex))
                return false;
            x[c] = value;
        }
        corners[k] = surface_add_vertex(surface, (struct vec3){x[0], x[1], x[2]});
    }
    if (!scan_expect(scan, "endloop", "'endloop' after three vertices") ||
        !scan_expect(scan, "endfacet", "'endfacet'"))
        return false;
    if (surface->n_facets == SURFACE_FACETS_MOST)
        return scan_complain(scan, "more than %d facets; fewer are expected",
                             SURFACE_FACETS_MOST);
    surface_add_facet(surface, corners[0], corners[1], corners[2], -1);
    return true;
}

static bool read_ascii(struct surface *surface, struct scan *scan)
{
    while (scan_word(scan)) {
        if (!scan_is(scan, "solid"))
            return scan_refuse(scan, "'solid'");
        scan_skip_line(scan); /* its name */
        for (;;) {
            if (!scan_word(scan))
                return scan_refuse(scan, "'facet' or 'endsolid'");
            if (scan_is(scan, "endsolid"))
                break;
            if (!scan_is(scan, "facet"))
                return scan_refuse(scan, "'facet' or 'endsolid'");
            if (!read_facet(scan, surface))
                return false;
        }
        scan_skip_line(scan);
    }
    return surface->n_facets > 0 ||
           scan_complain(scan, "there are no facets in it; at least one is expected");
}

/* ---- Which
 * ------------------------------------------------------------------------------------ */

static bool is_text(const char *bytes, size_t n)
{
    const size_t looked_at = n < LOOKED_AT ? n : LOOKED_AT;
    size_t blank = 0;
    while (blank < looked_at && strchr(" \t\r\n", bytes[blank]) != NULL && bytes[blank] != '\0')
        blank++;
    return looked_at - blank >= 5 && strncasecmp(bytes + blank, "solid", 5) == 0 &&
           memchr(bytes, '\0', looked_at) == NULL;
}

bool stl_read(struct surface *surface, const char *path, const char *bytes, size_t n,
              char **why)
{
    *surface = (struct surface){0};
    *why = NULL;
    bool fine;
    if ((n >= HEAD && n == HEAD + (uint64_t)TRIANGLE * word_at(bytes + HEAD - 4)) ||
        !is_text(bytes, n)) {
        fine = read_binary(surface, path, bytes, n, why);
    } else {
        struct scan scan;
        scan_init(&scan, path, bytes, n);
        fine = read_ascii(surface, &scan);
        *why = scan.why;
    }
    if (!fine)
        surface_clear(surface);
    return fine;
}
