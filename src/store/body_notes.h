/* State of the bodies that forces move, as notes in checkpoints: body_B.state, B the body's
 * number in the job, holds struct rigid_state.  Local. */
#ifndef TREMIE_STORE_BODY_NOTES_H
#define TREMIE_STORE_BODY_NOTES_H

#include <stdbool.h>

struct bodies;
struct notes;

void body_notes_add(struct notes *notes, const struct bodies *bodies);
/* False, having said which one is missing; bodies must then be placed. */
bool body_notes_take(const struct notes *notes, struct bodies *bodies);

#endif
