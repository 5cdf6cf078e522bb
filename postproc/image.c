/* See image.h.  libpng reports failures by longjmp; nothing that it could leave half done lives
 * across the jump but the stream and its own structures, which the caller of the jump's
 * function holds. */
#include "image.h"

#include <errno.h>
#include <png.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"

void image_init(struct image *image, int width, int height)
{
    *image = (struct image){width, height, array_allocate((size_t)width * (size_t)height, 3)};
}

void image_clear(struct image *image)
{
    free(image->pixels);
    *image = (struct image){0};
}

static void png_fails(png_structp png, png_const_charp text)
{
    (void)text; /* the reason is in errno; libpng's "Write Error" adds nothing */
    longjmp(png_jmpbuf(png), 1);
}

static bool write_stream(const struct image *image, FILE *stream, png_structp png,
                         png_infop info)
{
    if (setjmp(png_jmpbuf(png)) != 0)
        return false;
    png_init_io(png, stream);
    png_set_IHDR(png, info, (png_uint_32)image->width, (png_uint_32)image->height, 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_write_info(png, info);
    for (int y = 0; y < image->height; y++)
        png_write_row(png, image->pixels + (size_t)y * (size_t)image->width * 3);
    png_write_end(png, NULL);
    return true;
}

int image_write_png(const struct image *image, const char *path)
{
    FILE *stream = fopen(path, "wb");
    if (stream == NULL) {
        report_error("cannot write %s: %s; check the folder", path, strerror(errno));
        return REPORT_STORAGE;
    }
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, png_fails, NULL);
    CHECK(png != NULL, "out of memory for libpng");
    png_infop info = png_create_info_struct(png);
    CHECK(info != NULL, "out of memory for libpng");
    const bool written = write_stream(image, stream, png, info);
    png_destroy_write_struct(&png, &info);
    if (fclose(stream) != 0 || !written) {
        report_error("cannot write all of %s: %s; check the space on its disk", path,
                     strerror(errno));
        return REPORT_STORAGE;
    }
    return REPORT_FINISHED;
}
