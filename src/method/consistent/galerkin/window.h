/* Rectangles of a plane of control values: columns along x, rows along y. */
#ifndef SELAS_METHOD_CONSISTENT_GALERKIN_WINDOW_H
#define SELAS_METHOD_CONSISTENT_GALERKIN_WINDOW_H

#include <stdbool.h>
#include <stddef.h>

/* x, y: from .. end - 1; empty if one of them has no numbers. */
struct window {
    size_t from[2], end[2];
};

static inline size_t window_points(const struct window *w)
{
    if (w->end[0] <= w->from[0] || w->end[1] <= w->from[1]) return 0;
    return (w->end[0] - w->from[0]) * (w->end[1] - w->from[1]);
}

/* The smallest that holds both. */
static inline struct window window_join(const struct window *a, const struct window *b)
{
    if (window_points(a) == 0) return *b;
    if (window_points(b) == 0) return *a;
    struct window both;
    for (int axis = 0; axis < 2; axis++) {
        both.from[axis] = a->from[axis] < b->from[axis] ? a->from[axis] : b->from[axis];
        both.end[axis] = a->end[axis] > b->end[axis] ? a->end[axis] : b->end[axis];
    }
    return both;
}

/* What both hold. */
static inline struct window window_meet(const struct window *a, const struct window *b)
{
    struct window both;
    for (int axis = 0; axis < 2; axis++) {
        both.from[axis] = a->from[axis] > b->from[axis] ? a->from[axis] : b->from[axis];
        both.end[axis] = a->end[axis] < b->end[axis] ? a->end[axis] : b->end[axis];
    }
    return both;
}

static inline bool window_holds(const struct window *w, size_t x, size_t y)
{
    return x >= w->from[0] && x < w->end[0] && y >= w->from[1] && y < w->end[1];
}

#endif
