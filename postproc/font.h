/*
 * A tiny built-in font, so that pictures carry numbers without any library.
 *
 * Glyphs are bitmaps of 5 x 7 dots with two more rows for descenders.  They are not drawn as
 * squares: neighbouring dots are joined by strokes (diagonal ones only where no straight way
 * joins them), so that text looks drawn with a pen at any size.  Printable ASCII only; anything
 * else shows as a box.
 */
#ifndef TREMIE_POSTPROC_FONT_H
#define TREMIE_POSTPROC_FONT_H

enum { FONT_WIDTH = 5, FONT_HEIGHT = 9, FONT_ADVANCE = 6, FONT_STROKES_MAX = 128 };

/* A stroke in dots from the glyph's top left corner; a lone dot has equal ends. */
struct font_stroke {
    float x[2], y[2];
};

/* The strokes of one character; returns their number. */
int font_strokes(char character, struct font_stroke *strokes);

#endif
