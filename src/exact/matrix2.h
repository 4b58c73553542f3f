/* Complex matrices of order 2: products, inverses, mirror images. */
#ifndef SELAS_MATRIX2_H
#define SELAS_MATRIX2_H

#include "exact/pair.h"

struct matrix2 {
    struct pair a, b, c, d; /* a b; c d */
};

struct vector2 {
    struct pair x, y;
};

static inline struct matrix2 matrix2_product(struct matrix2 l, struct matrix2 r)
{
    return (struct matrix2){plus(times(l.a, r.a), times(l.b, r.c)), plus(times(l.a, r.b), times(l.b, r.d)),
                            plus(times(l.c, r.a), times(l.d, r.c)), plus(times(l.c, r.b), times(l.d, r.d))};
}
static inline struct vector2 matrix2_times(struct matrix2 m, struct vector2 v)
{
    return (struct vector2){plus(times(m.a, v.x), times(m.b, v.y)), plus(times(m.c, v.x), times(m.d, v.y))};
}
static inline struct matrix2 matrix2_inverse(struct matrix2 m)
{
    const struct pair one = {1, 0}, factor = over(one, minus(times(m.a, m.d), times(m.b, m.c)));
    const struct pair less = scaled(-1, factor);
    return (struct matrix2){times(m.d, factor), times(m.b, less), times(m.c, less), times(m.a, factor)};
}
static inline struct matrix2 matrix2_sum(struct matrix2 l, struct matrix2 r)
{
    return (struct matrix2){plus(l.a, r.a), plus(l.b, r.b), plus(l.c, r.c), plus(l.d, r.d)};
}
static inline struct matrix2 matrix2_less(struct matrix2 l, struct matrix2 r)
{
    return (struct matrix2){minus(l.a, r.a), minus(l.b, r.b), minus(l.c, r.c), minus(l.d, r.d)};
}
static inline struct matrix2 matrix2_one_plus(struct matrix2 m)
{
    m.a.re += 1;
    m.d.re += 1;
    return m;
}
/* M m M with M = diag(1, -1) */
static inline struct matrix2 matrix2_mirrored(struct matrix2 m)
{
    return (struct matrix2){m.a, scaled(-1, m.b), scaled(-1, m.c), m.d};
}

#endif
