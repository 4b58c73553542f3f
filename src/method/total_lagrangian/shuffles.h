/* Numbers of LANES points between their order in memory, point by point, and vectors of one component each.
 */
#ifndef SELAS_METHOD_TOTAL_LAGRANGIAN_SHUFFLES_H
#define SELAS_METHOD_TOTAL_LAGRANGIAN_SHUFFLES_H

#include "base/vectors.h"

#include <stddef.h>

#define SHUFFLE __builtin_shufflevector

/* apart_2, apart_3: vectors as they stand in memory into one for each component; together_2, together_3 back.
 */
#if VECTOR_BYTES == 64
INLINED void apart_2(const lanes *t, lanes *c)
{
    c[0] = SHUFFLE(t[0], t[1], 0, 2, 4, 6, 8, 10, 12, 14);
    c[1] = SHUFFLE(t[0], t[1], 1, 3, 5, 7, 9, 11, 13, 15);
}

INLINED void apart_3(const lanes *t, lanes *c)
{
    const lanes x = SHUFFLE(t[0], t[1], 0, 3, 6, 9, 12, 15, 0, 0);
    const lanes y = SHUFFLE(t[0], t[1], 1, 4, 7, 10, 13, 0, 0, 0);
    const lanes z = SHUFFLE(t[0], t[1], 2, 5, 8, 11, 14, 0, 0, 0);
    c[0] = SHUFFLE(x, t[2], 0, 1, 2, 3, 4, 5, 10, 13);
    c[1] = SHUFFLE(y, t[2], 0, 1, 2, 3, 4, 8, 11, 14);
    c[2] = SHUFFLE(z, t[2], 0, 1, 2, 3, 4, 9, 12, 15);
}

INLINED void together_2(const lanes *c, lanes *t)
{
    t[0] = SHUFFLE(c[0], c[1], 0, 8, 1, 9, 2, 10, 3, 11);
    t[1] = SHUFFLE(c[0], c[1], 4, 12, 5, 13, 6, 14, 7, 15);
}

INLINED void together_3(const lanes *c, lanes *t)
{
    const lanes first = SHUFFLE(c[0], c[1], 0, 8, 0, 1, 9, 0, 2, 10);
    const lanes second = SHUFFLE(c[0], c[1], 0, 3, 11, 0, 4, 12, 0, 5);
    const lanes third = SHUFFLE(c[0], c[1], 13, 0, 6, 14, 0, 7, 15, 0);
    t[0] = SHUFFLE(first, c[2], 0, 1, 8, 3, 4, 9, 6, 7);
    t[1] = SHUFFLE(second, c[2], 10, 1, 2, 11, 4, 5, 12, 7);
    t[2] = SHUFFLE(third, c[2], 0, 13, 2, 3, 14, 5, 6, 15);
}
#elif VECTOR_BYTES == 32
INLINED void apart_2(const lanes *t, lanes *c)
{
    c[0] = SHUFFLE(t[0], t[1], 0, 2, 4, 6);
    c[1] = SHUFFLE(t[0], t[1], 1, 3, 5, 7);
}

INLINED void apart_3(const lanes *t, lanes *c)
{
    const lanes x = SHUFFLE(t[0], t[1], 0, 3, 6, 0);
    const lanes y = SHUFFLE(t[0], t[1], 1, 4, 7, 0);
    const lanes z = SHUFFLE(t[0], t[1], 2, 5, 0, 0);
    c[0] = SHUFFLE(x, t[2], 0, 1, 2, 5);
    c[1] = SHUFFLE(y, t[2], 0, 1, 2, 6);
    c[2] = SHUFFLE(z, t[2], 0, 1, 4, 7);
}

INLINED void together_2(const lanes *c, lanes *t)
{
    t[0] = SHUFFLE(c[0], c[1], 0, 4, 1, 5);
    t[1] = SHUFFLE(c[0], c[1], 2, 6, 3, 7);
}

INLINED void together_3(const lanes *c, lanes *t)
{
    const lanes first = SHUFFLE(c[0], c[1], 0, 4, 0, 1);
    const lanes second = SHUFFLE(c[0], c[1], 5, 0, 2, 6);
    const lanes third = SHUFFLE(c[0], c[1], 0, 3, 7, 0);
    t[0] = SHUFFLE(first, c[2], 0, 1, 4, 3);
    t[1] = SHUFFLE(second, c[2], 0, 5, 2, 3);
    t[2] = SHUFFLE(third, c[2], 6, 1, 2, 7);
}
#else
INLINED void apart_2(const lanes *t, lanes *c)
{
    c[0] = SHUFFLE(t[0], t[1], 0, 2);
    c[1] = SHUFFLE(t[0], t[1], 1, 3);
}

INLINED void apart_3(const lanes *t, lanes *c)
{
    c[0] = SHUFFLE(t[0], t[1], 0, 3);
    c[1] = SHUFFLE(t[0], t[2], 1, 2);
    c[2] = SHUFFLE(t[1], t[2], 0, 3);
}

INLINED void together_2(const lanes *c, lanes *t)
{
    apart_2(c, t);
}

INLINED void together_3(const lanes *c, lanes *t)
{
    t[0] = SHUFFLE(c[0], c[1], 0, 2);
    t[1] = SHUFFLE(c[2], c[0], 0, 3);
    t[2] = SHUFFLE(c[1], c[2], 1, 3);
}
#endif

/* For d = 1, 2 or 3 components. */
INLINED void apart(const size_t d, const lanes *t, lanes *c)
{
    if (d == 1)
        c[0] = t[0];
    else if (d == 2)
        apart_2(t, c);
    else
        apart_3(t, c);
}

INLINED void together(const size_t d, const lanes *c, lanes *t)
{
    if (d == 1)
        t[0] = c[0];
    else if (d == 2)
        together_2(c, t);
    else
        together_3(c, t);
}

#undef SHUFFLE

#endif
