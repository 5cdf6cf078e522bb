/* See deform_state.h. */
#include "run/deform_state.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/report.h"
#include "run/simulation.h"
#include "solid/solid.h"
#include "store/checkpoint.h"
#include "store/table.h"

static int fields_of(const struct deform *deform, enum deform_state_kind kind,
                     const struct field **fields)
{
    *fields = kind == DEFORM_STATE_NODE ? solid_node_fields : solid_element_fields;
    if (kind == DEFORM_STATE_NODE)
        return deform->turns ? SOLID_NODE_N_FIELDS : SOLID_NODE_N_PLAIN;
    return deform->sheets ? SOLID_ELEMENT_N_FIELDS : SOLID_ELEMENT_N_PLAIN;
}

static struct field_view view_of(const struct solid *solid, enum deform_state_kind kind, int f)
{
    return kind == DEFORM_STATE_NODE ? solid_node_view(solid, (enum solid_node_field)f)
                                     : solid_element_view(solid, (enum solid_element_field)f);
}

size_t deform_state_size(const struct deform *deform, enum deform_state_kind kind)
{
    const struct field *fields;
    const int n = fields_of(deform, kind, &fields);
    size_t size = 0;
    for (int f = 0; f < n; f++)
        size += field_size(&fields[f]);
    CHECK(size <= DEFORM_STATE_MOST, "a record of %zu bytes", size);
    return size;
}

void deform_state_pack(const struct deform *deform, const struct solid *solid,
                       enum deform_state_kind kind, int i, unsigned char *record)
{
    const struct field *fields;
    const int n = fields_of(deform, kind, &fields);
    for (int f = 0; f < n; f++) {
        const struct field_view view = view_of(solid, kind, f);
        if (view.base != NULL)
            memcpy(record, field_at(&view, i), field_size(&fields[f]));
        else
            memset(record, 0, field_size(&fields[f]));
        record += field_size(&fields[f]);
    }
}

void deform_state_unpack(const struct deform *deform, struct solid *solid,
                         enum deform_state_kind kind, int i, const unsigned char *record)
{
    const struct field *fields;
    const int n = fields_of(deform, kind, &fields);
    for (int f = 0; f < n; f++) {
        const struct field_view view = view_of(solid, kind, f);
        if (view.base != NULL)
            memcpy(field_at(&view, i), record, field_size(&fields[f]));
        record += field_size(&fields[f]);
    }
}

/* ---- Checkpoints
 * ------------------------------------------------------------------------------ */

/* Nodes or elements of a solid, and the id of the first. */
static int rows_of(const struct deform_body *deform, enum deform_state_kind kind,
                   int64_t *first)
{
    *first = kind == DEFORM_STATE_NODE ? deform->first_node : deform->first_element;
    return kind == DEFORM_STATE_NODE ? deform->solid.n_nodes : deform->solid.n_elements;
}

static void collect(struct table *table, const struct simulation *sim,
                    enum deform_state_kind kind, int64_t begin, int64_t end)
{
    unsigned char *record = array_allocate(1, table->record_size);
    for (int k = 0; k < sim->deform.n; k++) {
        const struct solid *solid = &sim->deform.list[k].solid;
        int64_t id;
        const int n = rows_of(&sim->deform.list[k], kind, &id);
        for (int i = 0; i < n; i++, id++) {
            const bool counts =
                kind == DEFORM_STATE_NODE ? solid->moves[i] : solid_counts(solid, i);
            if (!counts || id < begin || id >= end)
                continue;
            memcpy(record, &id, sizeof id);
            deform_state_pack(&sim->deform, solid, kind, i, record + sizeof id);
            table_append(table, record, 1);
        }
    }
    free(record);
}

static void collect_nodes(struct table *table, const void *from, int64_t begin, int64_t end)
{
    collect(table, from, DEFORM_STATE_NODE, begin, end);
}

static void collect_elements(struct table *table, const void *from, int64_t begin, int64_t end)
{
    collect(table, from, DEFORM_STATE_ELEMENT, begin, end);
}

int deform_state_tables(const struct simulation *sim, struct checkpoint_more *tables)
{
    const struct field *fields;
    if (sim->deform.n == 0)
        return 0;
    int n = fields_of(&sim->deform, DEFORM_STATE_NODE, &fields);
    tables[DEFORM_STATE_NODE] = (struct checkpoint_more){.name = "nodes",
                                                         .n_fields = n,
                                                         .fields = fields,
                                                         .n_ids = sim->deform.n_nodes,
                                                         .collect = collect_nodes,
                                                         .from = sim};
    n = fields_of(&sim->deform, DEFORM_STATE_ELEMENT, &fields);
    tables[DEFORM_STATE_ELEMENT] = (struct checkpoint_more){.name = "elements",
                                                            .n_fields = n,
                                                            .fields = fields,
                                                            .n_ids = sim->deform.n_elements,
                                                            .collect = collect_elements,
                                                            .from = sim};
    return DEFORM_STATE_N_KINDS;
}

/* Elements that were computed here if they were alive are here, too. */
static bool is_here(const struct deform_body *deform, enum deform_state_kind kind, int i)
{
    if (kind == DEFORM_STATE_NODE)
        return deform_share_has(deform, i);
    const struct solid *solid = &deform->solid;
    for (int c = 0; c < solid_element_corners(solid->shape[i]); c++)
        if (solid->moves[solid->corners[i][c]])
            return true;
    return false;
}

void deform_state_restore(struct simulation *sim, const struct checkpoint_more *tables)
{
    for (int k = 0; k < sim->deform.n; k++) {
        struct solid *solid = &sim->deform.list[k].solid;
        for (int kind = 0; kind < DEFORM_STATE_N_KINDS; kind++) {
            const struct checkpoint_more *table = &tables[kind];
            int64_t id;
            const int n = rows_of(&sim->deform.list[k], (enum deform_state_kind)kind, &id);
            for (int i = 0; i < n; i++, id++)
                if (is_here(&sim->deform.list[k], (enum deform_state_kind)kind, i))
                    deform_state_unpack(&sim->deform, solid, (enum deform_state_kind)kind, i,
                                        table->records + (size_t)id * table->record_size +
                                            sizeof id);
        }
        bool *moves = array_allocate((size_t)solid->n_nodes, sizeof *moves);
        memcpy(moves, solid->moves, (size_t)solid->n_nodes * sizeof *moves);
        solid_assign(solid, moves);
        free(moves);
    }
}
