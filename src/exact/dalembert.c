/* d'Alembert's solution with ends. A wave that left an end at time t > 0 is the reflection of what arrived
 * there at t, plus what the end itself sent out: f(low - ct) = f(low) + r (g(low + ct) - g(low)) + q(t), and
 * likewise g at the high end, so that any value is found by at most 1 + ct / length steps back to the initial
 * state. */
#include "exact/dalembert.h"

static double source_value(const struct bar_end *end, double t, int derivative)
{
    double sum = 0;
    for (size_t k = 0; k < end->sources; k++)
        sum += end->source[k].factor *
               history_value(end->source[k].history, t, end->source[k].order + derivative);
    return sum;
}

/* f or g, or its slope, at any s: inside the bar the initial wave, beyond its ends what they send out. */
static double wave_anywhere(const struct bar *bar, bool rightward, double s, int derivative)
{
    double factor = 1, sum = 0;
    for (;;) {
        const struct bar_end *end = rightward ? &bar->low : &bar->high;
        const double beyond = rightward ? end->place - s : s - end->place;
        if (beyond <= 0) return sum + factor * bar->wave(bar->context, rightward, s, derivative);
        const double t = beyond / bar->speed;
        if (derivative == 0) {
            sum += factor * (bar->wave(bar->context, rightward, end->place, 0) -
                             end->reflection * bar->wave(bar->context, !rightward, end->place, 0) +
                             source_value(end, t, 0));
            factor *= end->reflection;
        } else { /* d/ds of t is -1/c at the low end, 1/c at the high one; mirroring s turns the slope */
            sum += factor * (rightward ? -1 : 1) * source_value(end, t, 1) / bar->speed;
            factor *= -end->reflection;
        }
        if (factor == 0) return sum;
        s = 2 * end->place - s;
        rightward = !rightward;
    }
}

double bar_value(const struct bar *bar, double x, double t, int derivative)
{
    const double c = bar->speed;
    const double f = wave_anywhere(bar, true, x - c * t, derivative);
    const double g = wave_anywhere(bar, false, x + c * t, derivative);
    return derivative == 0 ? f + g : c * (g - f);
}
