/* d'Alembert's solution of the wave equation in one dimension between two ends, by following the two waves
 * u = f(x - ct) + g(x + ct) back through their reflections to the initial state (doc/theory/initial-states.md, Eqs 4
 * and 5). */
#ifndef SELAS_DALEMBERT_H
#define SELAS_DALEMBERT_H

#include "scene/scene.h"

/* An end of the bar: the wave that leaves it is
 *   out(t) = out(0) + reflection (in(t) - in(0)) + source(t). */
struct bar_end {
    double place;      /* x */
    double reflection; /* 1: free, -1: held, 0: absorbing, in between: a damper */
    /* source(t) = sum over k of factor[k] * (derivative of history[k] of order[k]) */
    size_t sources;
    struct bar_source {
        const struct history *history;
        double factor;
        int order;
    } * source;
};

/* State at t = 0: initial waves f and g (and their slopes) at x. */
struct bar {
    double speed;
    struct bar_end low, high;
    /* f (rightward) or g (leftward) at t = 0: value or slope in x. */
    double (*wave)(const void *context, bool rightward, double x, int derivative);
    const void *context;
};

/* Displacement (derivative 0) or velocity (1) at x in [low, high] and t >= 0. */
double bar_value(const struct bar *bar, double x, double t, int derivative);

#endif
