/* The contact law in vectors over a batch: see facet_kernel.h. Lanes beyond the last contact
 * repeat it; nobody reads what they give. */
#define LANES_WIDTH 2

#include "contact/facet_kernel.h"

#include "physics/contact_law.h"

enum { WIDTH = LANES_WIDTH };

_Static_assert(FACET_KERNEL_BATCH % WIDTH == 0, "a batch is whole vectors");
_Static_assert((int)CONTACT_LANES == (int)CONTACT_LAW_LANES, "one idea of history");

/* One member of the last contact again in the rest of its vector. */
static void repeat_last(double *member, int n)
{
    for (int k = n; k % WIDTH != 0; k++)
        member[k] = member[n - 1];
}

static void pad(struct facet_kernel_batch *batch)
{
    for (int x = 0; x < 3; x++) {
        repeat_last(batch->normal[x], batch->n);
        repeat_last(batch->velocity[x], batch->n);
    }
    for (int h = 0; h < CONTACT_LANES; h++)
        repeat_last(batch->history[h], batch->n);
    for (int x = 0; x < 3; x++)
        repeat_last(batch->spin[x], batch->n);
    repeat_last(batch->overlap, batch->n);
    repeat_last(batch->inverse_radius, batch->n);
    repeat_last(batch->inverse_mass, batch->n);
    for (int k = batch->n; k % WIDTH != 0; k++)
        batch->pair[k] = batch->pair[batch->n - 1];
}

LANES_INLINE void apply(struct facet_kernel_batch *batch, double dt,
                        struct contact_law_choice choice)
{
    for (int k = 0; k < batch->n; k += WIDTH) {
        struct contact_law_meeting meeting;
        lanes history[CONTACT_LANES];
        for (int x = 0; x < 3; x++) {
            meeting.normal[x] = lanes_load(&batch->normal[x][k]);
            meeting.velocity[x] = lanes_load(&batch->velocity[x][k]);
            meeting.spin[x] = lanes_load(&batch->spin[x][k]);
        }
        meeting.overlap = lanes_load(&batch->overlap[k]);
        meeting.inverse_radius = lanes_load(&batch->inverse_radius[k]);
        meeting.inverse_mass = lanes_load(&batch->inverse_mass[k]);
        const struct contact_law_constants pair =
            contact_law_constants_of_each(&batch->pair[k], choice.full);
        for (int h = 0; h < CONTACT_LANES; h++)
            if (contact_lane_used(h, choice.full, choice.ledger))
                history[h] = lanes_load(&batch->history[h][k]);

        struct contact_law_result result;
        contact_law(&meeting, &pair, lanes_all(dt), choice, history, &result);

        lanes_store(&batch->push[k], result.normal);
        for (int x = 0; x < 3; x++) {
            lanes_store(&batch->grip[x][k], result.tangential[x]);
            if (choice.full)
                lanes_store(&batch->torque[x][k], result.torque[x]);
        }
        for (int h = 0; h < CONTACT_LANES; h++)
            if (contact_lane_used(h, choice.full, choice.ledger))
                lanes_store(&batch->history[h][k], history[h]);
        if (!choice.ledger)
            continue;
        lanes_store(&batch->lost_friction[k], result.lost_friction);
        lanes_store(&batch->lost_damping[k], result.lost_damping);
        lanes_store(&batch->lost_law[k], result.lost_law);
    }
}

void facet_kernel_apply(struct facet_kernel_batch *batch, double dt, bool full, bool ledger)
{
    if (batch->n == 0)
        return;
    pad(batch);
    if (full && ledger)
        apply(batch, dt, (struct contact_law_choice){.full = true, .ledger = true});
    else if (full)
        apply(batch, dt, (struct contact_law_choice){.full = true});
    else if (ledger)
        apply(batch, dt, (struct contact_law_choice){.ledger = true});
    else
        apply(batch, dt, (struct contact_law_choice){.ledger = false});
}
