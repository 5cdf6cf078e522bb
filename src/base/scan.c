/* See scan.h.  Numbers are read by strtod, which rounds correctly: a text has one meaning. */
#include "base/scan.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "base/array.h"

enum { SHOWN = 40 };

void scan_init(struct scan *scan, const char *path, const char *text, size_t n)
{
    *scan = (struct scan){
        .path = path, .at = text, .end = text + n, .line_start = text, .line = 1, .word = text};
}

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\f' || c == '\v';
}

static bool take_word(struct scan *scan, bool beyond_line)
{
    while (scan->at < scan->end && is_blank(*scan->at)) {
        if (*scan->at == '\n') {
            if (!beyond_line)
                return false;
            scan->line++;
            scan->line_start = scan->at + 1;
        }
        scan->at++;
    }
    scan->word = scan->at;
    while (scan->at < scan->end && !is_blank(*scan->at))
        scan->at++;
    scan->length = (size_t)(scan->at - scan->word);
    return scan->length > 0;
}

bool scan_word(struct scan *scan)
{
    return take_word(scan, true);
}

bool scan_word_of_line(struct scan *scan)
{
    return take_word(scan, false);
}

void scan_skip_line(struct scan *scan)
{
    const char *next = memchr(scan->at, '\n', (size_t)(scan->end - scan->at));
    scan->at = next != NULL ? next : scan->end;
}

bool scan_is(const struct scan *scan, const char *word)
{
    return strlen(word) == scan->length && strncasecmp(scan->word, word, scan->length) == 0;
}

bool scan_complain(struct scan *scan, const char *format, ...)
{
    char text[512];
    va_list arguments;
    if (scan->why != NULL)
        return false;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    scan->why = array_format("%s:%d:%d: %s", scan->path, scan->line,
                             (int)(scan->word - scan->line_start) + 1, text);
    return false;
}

bool scan_refuse(struct scan *scan, const char *expected)
{
    char shown[SHOWN + 1];
    const size_t n = scan->length < SHOWN ? scan->length : SHOWN;
    if (n == 0)
        return scan_complain(scan, "the file ends here; %s is expected", expected);
    for (size_t k = 0; k < n; k++) {
        const unsigned char c = (unsigned char)scan->word[k];
        shown[k] = scan->word[k];
        if (c < ' ' || c >= 127) /* the file's text must not steer a terminal */
            shown[k] = '?';
    }
    shown[n] = '\0';
    return scan_complain(scan, "'%s'%s is not what belongs here; %s is expected", shown,
                         n < scan->length ? "..." : "", expected);
}

bool scan_expect(struct scan *scan, const char *word, const char *what)
{
    return (scan_word(scan) && scan_is(scan, word)) || scan_refuse(scan, what);
}

bool scan_number(struct scan *scan, double *value, const char *what)
{
    char *end;
    if (!scan_word(scan))
        return scan_refuse(scan, what);
    *value = strtod(scan->word, &end);
    return (end == scan->at && isfinite(*value)) || scan_refuse(scan, what);
}

bool scan_whole(struct scan *scan, int64_t least, int64_t most, int64_t *value,
                const char *what)
{
    char *end;
    if (!scan_word(scan))
        return scan_refuse(scan, what);
    *value = strtoll(scan->word, &end, 10);
    return (end == scan->at && *value >= least && *value <= most) || scan_refuse(scan, what);
}
