/*
 * The description of state: what is not in a field table is not state, is not migrated, not
 * saved, not compared.  Adding a field is adding a row.
 */
#ifndef TREMIE_BASE_FIELD_H
#define TREMIE_BASE_FIELD_H

#include <stddef.h>
#include <stdint.h>

/* FIELD_FLOAT: 32 bits, for pictures; state is never rounded. */
enum field_type { FIELD_DOUBLE, FIELD_INT64, FIELD_INT32, FIELD_FLOAT };

enum field_use {
    FIELD_GHOST = 1,  /* given to a ghost when it is made */
    FIELD_MOTION = 2, /* refreshed on ghosts each step */
    FIELD_SAVED = 4,  /* in checkpoints.  Every field migrates. */
    FIELD_PLOTTED = 8,
};

struct field {
    const char *name; /* as in checkpoints */
    const char *unit; /* "1" for a pure number */
    const char *help;
    enum field_type type;
    int width; /* components */
    int use;   /* set of enum field_use */
};

/* Where a field lies in memory: element i begins at base + i * stride and has `width`
 * components side by side. */
struct field_view {
    unsigned char *base;
    size_t stride; /* [bytes] */
};

static inline size_t field_component_size(enum field_type type)
{
    return type == FIELD_INT32 || type == FIELD_FLOAT ? 4 : 8;
}
static inline size_t field_size(const struct field *field)
{
    return field_component_size(field->type) * (size_t)field->width;
}
static inline void *field_at(const struct field_view *view, int64_t i)
{
    return view->base + (size_t)i * view->stride;
}

#endif
