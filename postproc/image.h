/* Pictures: 8-bit RGB pixels, row by row from the top, written as PNG. */
#ifndef TREMIE_POSTPROC_IMAGE_H
#define TREMIE_POSTPROC_IMAGE_H

struct image {
    int width, height;
    unsigned char *pixels; /* width * height * 3 */
};

void image_init(struct image *image, int width, int height);
void image_clear(struct image *image);
/* Returns a REPORT_ status, the reason said. */
int image_write_png(const struct image *image, const char *path);

#endif
