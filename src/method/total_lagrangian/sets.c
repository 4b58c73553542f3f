/* Sets of points: ranges of their numbers. */
#include "method/total_lagrangian/sets.h"

#include "base/memory.h"

#include <string.h>

static bool make_room(struct tl_set *set, size_t ranges)
{
    *set = (struct tl_set){.range = array_new(ranges, sizeof *set->range)};
    return set->range != NULL;
}

/* A range more; one that goes on where the last one ends lengthens it. */
static void add(struct tl_set *set, size_t from, size_t end)
{
    struct tl_range *last = set->count > 0 ? &set->range[set->count - 1] : NULL;
    if (from >= end) return;
    set->points += end - from;
    if (last != NULL && last->end == from)
        last->end = end;
    else
        set->range[set->count++] = (struct tl_range){from, end};
}

bool tl_set_range(size_t from, size_t end, struct tl_set *set)
{
    const bool room = make_room(set, 1);
    if (room) add(set, from, end);
    return room;
}

bool tl_set_marked(const bool *mark, size_t points, struct tl_set *set)
{
    size_t ranges = 0;
    for (size_t i = 0; i < points; i++)
        ranges += mark[i] && (i == 0 || !mark[i - 1]);
    if (!make_room(set, ranges)) return false;
    for (size_t i = 0; i < points; i++)
        if (mark[i]) add(set, i, i + 1);
    return true;
}

bool tl_set_cut(const struct tl_set *whole, size_t before, size_t longest, struct tl_set *set)
{
    size_t ranges = 0;
    for (size_t r = 0; r < whole->count; r++)
        ranges += (whole->range[r].end - whole->range[r].from + longest - 1) / longest;
    if (!make_room(set, ranges)) return false;
    set->points = whole->points;
    for (size_t r = 0; r < whole->count; r++) {
        const size_t end = whole->range[r].end - before;
        for (size_t from = whole->range[r].from - before; from < end; from += longest)
            set->range[set->count++] = (struct tl_range){from, end - from < longest ? end : from + longest};
    }
    return true;
}

bool tl_set_common(const struct tl_set *one, const struct tl_set *other, size_t before, struct tl_set *both)
{
    if (!make_room(both, one->count + other->count)) return false;
    for (size_t r = 0, s = 0; r < one->count && s < other->count;) {
        const struct tl_range *a = &one->range[r], *b = &other->range[s];
        const size_t from = a->from > b->from ? a->from : b->from, end = a->end < b->end ? a->end : b->end;
        if (from < end) add(both, from - before, end - before);
        if (a->end < b->end)
            r++;
        else
            s++;
    }
    return true;
}

bool tl_set_has(const struct tl_set *set, size_t point)
{
    size_t low = 0, high = set->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (point < set->range[middle].from)
            high = middle;
        else if (point >= set->range[middle].end)
            low = middle + 1;
        else
            return true;
    }
    return false;
}

void tl_set_take(const struct tl_set *set, size_t width, const double *number, double *taken)
{
    for (size_t r = 0; r < set->count; r++) {
        const size_t from = width * set->range[r].from, count = width * set->range[r].end - from;
        memcpy(taken, number + from, count * sizeof *number);
        taken += count;
    }
}

void tl_set_put(const struct tl_set *set, size_t width, const double *taken, double *number)
{
    for (size_t r = 0; r < set->count; r++) {
        const size_t from = width * set->range[r].from, count = width * set->range[r].end - from;
        memcpy(number + from, taken, count * sizeof *number);
        taken += count;
    }
}

bool tl_set_spread(struct ranks *ranks, int from, struct tl_set *set)
{
    size_t counts[2] = {set->count, set->points};
    ranks_spread(ranks, from, counts, sizeof counts);
    bool room = true;
    if (ranks_me(ranks) != from) {
        room = make_room(set, counts[0]);
        set->count = counts[0];
        set->points = counts[1];
    }
    double missing = room ? 0 : 1;
    ranks_largest(ranks, 1, &missing);
    if (missing == 0) ranks_spread(ranks, from, set->range, counts[0] * sizeof *set->range);
    return missing == 0;
}

void tl_set_free(struct tl_set *set)
{
    array_free(set->range);
    *set = (struct tl_set){0};
}
