/*
 * What bodies that deform remember, as records: for checkpoints, and for ranks that take nodes
 * and elements over from others.  A record holds the fields of solid/solid.h one behind the
 * other, without gaps.
 */
#ifndef TREMIE_RUN_DEFORM_STATE_H
#define TREMIE_RUN_DEFORM_STATE_H

#include <stddef.h>

struct checkpoint_more;
struct deform;
struct simulation;
struct solid;

enum deform_state_kind { DEFORM_STATE_NODE, DEFORM_STATE_ELEMENT, DEFORM_STATE_N_KINDS };
enum { DEFORM_STATE_MOST = 768 /* bytes of a record, at most */ };

/* Bytes of a record, of any body that deforms: where one has sheets, fields of sheets are in
 * those of all, zero elsewhere. */
size_t deform_state_size(const struct deform *deform, enum deform_state_kind kind);
/* Writes node or element i as a record; reads it from one. */
void deform_state_pack(const struct deform *deform, const struct solid *solid,
                       enum deform_state_kind kind, int i, unsigned char *record);
void deform_state_unpack(const struct deform *deform, struct solid *solid,
                         enum deform_state_kind kind, int i, const unsigned char *record);

/* Tables of nodes and elements for checkpoints: two, none without solids. */
int deform_state_tables(const struct simulation *sim, struct checkpoint_more *tables);
/* Takes over what is here of them, as read. */
void deform_state_restore(struct simulation *sim, const struct checkpoint_more *tables);

#endif
