/* Complex numbers as pairs: the compiler's own complex products test for NaN, which costs half the time. */
#ifndef SELAS_PAIR_H
#define SELAS_PAIR_H

#include <math.h>

struct pair {
    double re, im;
};

static inline struct pair plus(struct pair a, struct pair b)
{
    return (struct pair){a.re + b.re, a.im + b.im};
}
static inline struct pair times(struct pair a, struct pair b)
{
    return (struct pair){a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
static inline struct pair scaled(double factor, struct pair a)
{
    return (struct pair){factor * a.re, factor * a.im};
}
static inline struct pair over(struct pair a, struct pair b)
{
    const double norm = 1 / (b.re * b.re + b.im * b.im);
    return (struct pair){(a.re * b.re + a.im * b.im) * norm, (a.im * b.re - a.re * b.im) * norm};
}
/* Principal root, for im >= 0. */
static inline struct pair root(struct pair a)
{
    const double size = sqrt(a.re * a.re + a.im * a.im), large = sqrt(.5 * (size + fabs(a.re)));
    const double small = large > 0 ? .5 * a.im / large : 0;
    return a.re >= 0 ? (struct pair){large, small} : (struct pair){small, large};
}
static inline struct pair decay(struct pair rate, double z)
{
    const double size = exp(-rate.re * z), cosine = cos(rate.im * z), sine = sin(rate.im * z);
    return (struct pair){size * cosine, -size * sine};
}
/* exp(x) - 1 */
static inline struct pair exp_minus_one(struct pair x)
{
    const double half = sin(.5 * x.im), less = expm1(x.re);
    const double versine = -2 * half * half; /* cos - 1 */
    return (struct pair){less + versine + less * versine, (1 + less) * sin(x.im)};
}

static inline struct pair minus(struct pair a, struct pair b)
{
    return (struct pair){a.re - b.re, a.im - b.im};
}

#endif
