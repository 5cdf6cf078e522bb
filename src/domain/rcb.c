/* See rcb.h. */
#include "domain/rcb.h"

#include <stdlib.h>
#include <string.h>

#include "base/array.h"
#include "base/comm.h"
#include "domain/boxes.h"

enum { BINS = 256, ROUNDS = 3 };

/* A set of ranks whose points are still to be divided. */
struct group {
    int first_rank, n_ranks;
    int *link; /* where its code goes in the tree */
    int axis;
    double low, high;     /* the cut lies between */
    int64_t total, below; /* weight of the group; weight under `low` */
};

struct work {
    int n_groups;
    struct group *groups;
    int n_points;
    const struct rcb_point *points;
    int *group_of;      /* of each point; -1 when its rank is decided */
    double *extent;     /* 6 a group: least, and minus the largest, coordinates */
    int64_t *histogram; /* BINS a group */
};

static void measure_extents(struct work *work, const struct comm *comm)
{
    for (int k = 0; k < 6 * work->n_groups; k++)
        work->extent[k] = 1e300;
    for (int i = 0; i < work->n_points; i++) {
        if (work->group_of[i] < 0)
            continue;
        const double *x = work->points[i].place;
        double *extent = work->extent + 6 * work->group_of[i];
        for (int k = 0; k < 3; k++) {
            extent[k] = x[k] < extent[k] ? x[k] : extent[k];
            extent[3 + k] = -x[k] < extent[3 + k] ? -x[k] : extent[3 + k];
        }
    }
    comm_min(comm, work->extent, 6 * work->n_groups);
    for (int g = 0; g < work->n_groups; g++) {
        const double *extent = work->extent + 6 * g;
        struct group *group = &work->groups[g];
        group->axis = 0;
        for (int k = 1; k < 3; k++) {
            if (-extent[3 + k] - extent[k] > -extent[3 + group->axis] - extent[group->axis])
                group->axis = k;
        }
        const bool empty = !(extent[0] < 1e299);
        group->low = empty ? 0.0 : extent[group->axis];
        group->high = empty ? 0.0 : -extent[3 + group->axis];
        group->below = 0;
    }
}

/* Weight by bin between low and high of each group, summed over ranks. */
static void fill_histograms(struct work *work, const struct comm *comm)
{
    memset(work->histogram, 0, (size_t)work->n_groups * BINS * sizeof *work->histogram);
    for (int i = 0; i < work->n_points; i++) {
        if (work->group_of[i] < 0)
            continue;
        const struct group *group = &work->groups[work->group_of[i]];
        const double x = work->points[i].place[group->axis];
        if (!(x >= group->low && x <= group->high))
            continue;
        const double span = group->high - group->low;
        int bin = span > 0.0 ? (int)((x - group->low) / span * BINS) : 0;
        bin = bin < BINS ? bin : BINS - 1;
        work->histogram[work->group_of[i] * BINS + bin] += work->points[i].weight;
    }
    comm_sum_int(comm, work->histogram, work->n_groups * BINS);
}

/* Narrows the cut to the bin in which the lower half's share is reached. */
static void narrow(struct group *group, const int64_t *histogram, bool first_round)
{
    if (first_round) {
        group->total = 0;
        for (int b = 0; b < BINS; b++)
            group->total += histogram[b];
    }
    const int64_t share = group->total / group->n_ranks * (group->n_ranks / 2);
    int64_t below = group->below;
    int bin = 0;
    while (bin < BINS - 1 && below + histogram[bin] < share)
        below += histogram[bin++];
    const double width = (group->high - group->low) / BINS;
    group->high = group->low + width * (bin + 1);
    group->low += width * bin;
    group->below = below;
}

static int code_of(int first_rank, int n_ranks, struct boxes *boxes)
{
    return n_ranks == 1 ? -1 - first_rank : boxes->n_nodes++;
}

/* Cuts every group and makes the next level's groups. */
static void divide(struct work *work, struct boxes *boxes)
{
    struct group *next = array_allocate((size_t)boxes->n_ranks, sizeof *next);
    int *lower_of = array_allocate((size_t)work->n_groups, sizeof *lower_of);
    int *upper_of = array_allocate((size_t)work->n_groups, sizeof *upper_of);
    int n_next = 0;
    for (int g = 0; g < work->n_groups; g++) {
        const struct group *group = &work->groups[g];
        struct boxes_node *node = &boxes->nodes[*group->link];
        const int n_lower = group->n_ranks / 2, n_upper = group->n_ranks - n_lower;
        node->axis = group->axis;
        node->cut = group->high;
        node->child[0] = code_of(group->first_rank, n_lower, boxes);
        node->child[1] = code_of(group->first_rank + n_lower, n_upper, boxes);
        lower_of[g] = n_lower > 1 ? n_next : -1;
        if (n_lower > 1)
            next[n_next++] =
                (struct group){group->first_rank, n_lower, &node->child[0], 0, 0.0, 0.0, 0, 0};
        upper_of[g] = n_upper > 1 ? n_next : -1;
        if (n_upper > 1)
            next[n_next++] = (struct group){
                group->first_rank + n_lower, n_upper, &node->child[1], 0, 0.0, 0.0, 0, 0};
    }
    for (int i = 0; i < work->n_points; i++) {
        const int g = work->group_of[i];
        if (g < 0)
            continue;
        const bool lower = work->points[i].place[work->groups[g].axis] < work->groups[g].high;
        work->group_of[i] = lower ? lower_of[g] : upper_of[g];
    }
    free(lower_of);
    free(upper_of);
    free(work->groups);
    work->groups = next;
    work->n_groups = n_next;
}

void rcb_partition(struct boxes *boxes, const struct comm *comm, int n,
                   const struct rcb_point *points)
{
    const size_t n_ranks = (size_t)comm->n_ranks;
    if (comm->n_ranks == 1)
        return;
    struct work work = {.n_groups = 1, .n_points = n, .points = points};
    work.groups = array_allocate(n_ranks, sizeof *work.groups);
    work.group_of = array_allocate((size_t)n, sizeof *work.group_of);
    work.extent = array_allocate(6 * n_ranks, sizeof *work.extent);
    work.histogram = array_allocate(BINS * n_ranks, sizeof *work.histogram);
    int root = 0;
    boxes->n_nodes = 1;
    work.groups[0] = (struct group){0, comm->n_ranks, &root, 0, 0.0, 0.0, 0, 0};
    while (work.n_groups > 0) {
        measure_extents(&work, comm);
        for (int round = 0; round < ROUNDS; round++) {
            fill_histograms(&work, comm);
            for (int g = 0; g < work.n_groups; g++)
                narrow(&work.groups[g], work.histogram + g * BINS, round == 0);
        }
        divide(&work, boxes);
    }
    boxes_update(boxes);
    free(work.groups);
    free(work.group_of);
    free(work.extent);
    free(work.histogram);
}
