/* See body_notes.h. */
#include "store/body_notes.h"

#include <stdio.h>
#include <string.h>

#include "model/body.h"
#include "model/rigid.h"
#include "store/notes.h"

_Static_assert((int)RIGID_STATE_SIZE <= (int)NOTES_WIDTH, "a state is one note");

static const char *name_of(char name[NOTES_NAME_SIZE], int body)
{
    snprintf(name, NOTES_NAME_SIZE, "body_%d.state", body);
    return name;
}

void body_notes_add(struct notes *notes, const struct bodies *bodies)
{
    for (int b = 0; b < bodies->n; b++) {
        char name[NOTES_NAME_SIZE];
        double values[RIGID_STATE_SIZE];
        const struct rigid *rigid = bodies->list[b].rigid;
        if (rigid == NULL)
            continue;
        memcpy(values, &rigid->state, sizeof values);
        notes_add(notes, name_of(name, b), RIGID_STATE_SIZE, values);
    }
}

bool body_notes_take(const struct notes *notes, struct bodies *bodies)
{
    for (int b = 0; b < bodies->n; b++) {
        char name[NOTES_NAME_SIZE];
        double values[RIGID_STATE_SIZE];
        struct rigid *rigid = bodies->list[b].rigid;
        if (rigid == NULL)
            continue;
        if (!notes_take(notes, name_of(name, b), RIGID_STATE_SIZE, values))
            return false;
        memcpy(&rigid->state, values, sizeof values);
        rigid_refresh(rigid);
    }
    return true;
}
