/* Sets of points: which are a rank's own, which it knows, which it sends. Those that make a set return false if there
 * is no memory. */
#ifndef SELAS_METHOD_TOTAL_LAGRANGIAN_SETS_H
#define SELAS_METHOD_TOTAL_LAGRANGIAN_SETS_H

#include "parallel/ranks.h"

#include <stdbool.h>
#include <stddef.h>

/* Points from .. end - 1. */
struct tl_range {
    size_t from, end;
};

/* Ranges in ascending order that do not overlap; `points` in all. */
struct tl_set {
    size_t count, points;
    struct tl_range *range;
};

bool tl_set_range(size_t from, size_t end, struct tl_set *set);
bool tl_set_marked(const bool *mark, size_t points, struct tl_set *set); /* mark[points] */
/* The same points, numbers less `before`, in ranges of at most `longest`. */
bool tl_set_cut(const struct tl_set *whole, size_t before, size_t longest, struct tl_set *set);
/* Points of both sets, numbers less `before`. */
bool tl_set_common(const struct tl_set *one, const struct tl_set *other, size_t before, struct tl_set *both);
bool tl_set_has(const struct tl_set *set, size_t point);
/* `width` numbers of each point, from number[width * point] to taken[width * set->points], and back. */
void tl_set_take(const struct tl_set *set, size_t width, const double *number, double *taken);
void tl_set_put(const struct tl_set *set, size_t width, const double *taken, double *number);
/* Together: the set of rank `from`, for all; the same answer on all. */
bool tl_set_spread(struct ranks *ranks, int from, struct tl_set *set);
void tl_set_free(struct tl_set *set); /* empty is fine */

#endif
