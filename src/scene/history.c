/* Time functions f(t) of loads and motions: values, derivatives, integrals, smoothing, kinks.
 *
 * Smoothing S: f * B with the cubic B-spline B of knots 0, h, 2h, 3h, 4h (h = S/4) and unit area,
 *   (f * B)(t) = integral over [0, S] of B(x) f(t - x) dx,                                            (1)
 * by 8-point Gauss panels between the knots of B and the kinks of f: exact to rounding, since both are
 * polynomials there (or vary over plain_scale()). A derivative goes to f where f is smooth in the
 * window, otherwise to B, whose first two derivatives are continuous, so that jumps of f remain. */
#include "scene/history.h"
#include "scene/history_kinds.h"

#include <math.h>
#include <string.h>

static double triangle_value(const struct history *history, double t, int derivative, bool right)
{
    const double half = .5 * history->duration;
    const bool started = right ? t >= 0 : t > 0;
    const bool falls = right ? t >= half : t > half;
    const bool over = right ? t >= history->duration : t > history->duration;
    if (!started) return 0;
    const double left = history->duration - t; /* time to the end */
    switch (derivative) {
    case -1:
        if (over) return half;
        return falls ? half - .5 * left * left / half : .5 * t * t / half;
    case 0:
        if (over) return 0;
        return falls ? left / half : t / half;
    case 1:
        if (over) return 0;
        return falls ? -1 / half : 1 / half;
    default:
        return 0;
    }
}

static double step_value(double t, int derivative, bool right)
{
    if (t < 0 || (t == 0 && !right)) return 0;
    if (derivative == -1) return t;
    return derivative == 0 ? 1 : 0;
}

/* With x = b (t - delay), b = pi frequency: f = (1 - 2 x^2) exp(-x^2), its integral (t - delay) exp(-x^2). */
static double ricker_value(const struct history *history, double t, int derivative, bool right)
{
    if (t < 0 || (t == 0 && !right)) return 0;
    const double b = M_PI * history->frequency, x = b * (t - history->delay), bell = exp(-x * x);
    switch (derivative) {
    case -1:
        return (t - history->delay) * bell + history->delay * exp(-b * b * history->delay * history->delay);
    case 0:
        return (1 - 2 * x * x) * bell;
    case 1:
        return b * x * (4 * x * x - 6) * bell;
    default:
        return b * b * (-6 + 24 * x * x - 8 * x * x * x * x) * bell;
    }
}

static double gaussian_value(const struct history *history, double t, int derivative, bool right)
{
    if (t < 0 || (t == 0 && !right)) return 0;
    const double width = history->width, x = (t - history->delay) / width, bell = exp(-.5 * x * x);
    switch (derivative) {
    case -1:
        return width * sqrt(M_PI / 2) * (erfc(-x * M_SQRT1_2) - erfc(history->delay / width * M_SQRT1_2));
    case 0:
        return bell;
    case 1:
        return -x / width * bell;
    default:
        return (x * x - 1) / (width * width) * bell;
    }
}

/* sin(a t) (1 - cos(a t / n)) / 2 = [2 sin(a t) - sin(a (1 + 1/n) t) - sin(a (1 - 1/n) t)] / 4 */
static double burst_value(const struct history *history, double t, int derivative, bool right)
{
    const double end = history->cycles / history->frequency;
    if (t < 0 || (t == 0 && !right)) return 0;
    const bool over = right ? t >= end : t > end;
    if (over && derivative >= 0) return 0;
    const double time = over ? end : t, a = 2 * M_PI * history->frequency;
    const double rate[3] = {a, a * (1 + 1 / history->cycles), a * (1 - 1 / history->cycles)};
    const double weight[3] = {.5, -.25, -.25};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double phase = rate[i] * time;
        switch (derivative) {
        case -1: /* (1 - cos(phase)) / rate */
            if (rate[i] != 0) sum += weight[i] * 2 * sin(.5 * phase) * sin(.5 * phase) / rate[i];
            break;
        case 0:
            sum += weight[i] * sin(phase);
            break;
        case 1:
            sum += weight[i] * rate[i] * cos(phase);
            break;
        default:
            sum -= weight[i] * rate[i] * rate[i] * sin(phase);
            break;
        }
    }
    return sum;
}

/* With x = t/width: f = 1 - (1 + x) exp(-x). */
static double brune_value(const struct history *history, double t, int derivative)
{
    const double width = history->width, x = t / width, fall = exp(-x);
    if (t <= 0) return derivative == 2 && t == 0 ? 1 / (width * width) : 0;
    switch (derivative) {
    case -1:
        return width * (x - 2 + (x + 2) * fall);
    case 0:
        return 1 - (1 + x) * fall;
    case 1:
        return x * fall / width;
    default:
        return (1 - x) * fall / (width * width);
    }
}

static double error_function_value(const struct history *history, double t, int derivative, bool right)
{
    if (t < 0 || (t == 0 && !right)) return 0;
    const double width = history->width, x = (t - history->delay) / width, first = history->delay / width;
    const double bell = exp(-.5 * x * x) / (width * sqrt(2 * M_PI));
    switch (derivative) {
    case -1: /* of x erfc(-x/sqrt 2)/2 + bell */
        return .5 * width * (x * erfc(-x * M_SQRT1_2) + first * erfc(first * M_SQRT1_2)) +
               width * width * bell - width * exp(-.5 * first * first) / sqrt(2 * M_PI);
    case 0:
        return .5 * erfc(-x * M_SQRT1_2);
    case 1:
        return bell;
    default:
        return -x / width * bell;
    }
}

static double one_side(const struct history *history, double t, int derivative, bool right)
{
    switch (history->kind) {
    case HISTORY_TRIANGLE:
        return triangle_value(history, t, derivative, right);
    case HISTORY_STEP:
        return step_value(t, derivative, right);
    case HISTORY_RICKER:
        return ricker_value(history, t, derivative, right);
    case HISTORY_GAUSSIAN:
        return gaussian_value(history, t, derivative, right);
    case HISTORY_SINE_BURST:
        return burst_value(history, t, derivative, right);
    case HISTORY_TABLE:
        return history_table_value(history, t, derivative, right);
    case HISTORY_BRUNE:
        return brune_value(history, t, derivative);
    case HISTORY_ERROR_FUNCTION:
        return error_function_value(history, t, derivative, right);
    }
    return 0;
}

/* Smallest kink (or jump, or cut) later than t of the history without smoothing; INFINITY if there is none. */
static double plain_kink_after(const struct history *history, double t)
{
    if (history->kind == HISTORY_TABLE) return history_table_kink_after(history, t);
    if (t < 0) return 0;
    if (history->kind == HISTORY_TRIANGLE) {
        if (t < .5 * history->duration) return .5 * history->duration;
        if (t < history->duration) return history->duration;
    }
    if (history->kind == HISTORY_SINE_BURST && t < history->cycles / history->frequency)
        return history->cycles / history->frequency;
    return INFINITY;
}

double history_plain_value(const struct history *history, double t, int derivative)
{
    const double value = one_side(history, t, derivative, true);
    if (plain_kink_after(history, nextafter(t, -INFINITY)) != t) return value;
    return .5 * (value + one_side(history, t, derivative, false));
}

/* Time over which the history without smoothing may be taken as a polynomial of low degree between kinks;
 * INFINITY where it is one. */
static double plain_scale(const struct history *history)
{
    switch (history->kind) {
    case HISTORY_RICKER:
        return .5 / (M_PI * history->frequency);
    case HISTORY_GAUSSIAN:
    case HISTORY_BRUNE:
    case HISTORY_ERROR_FUNCTION:
        return history->width;
    case HISTORY_SINE_BURST:
        return .5 / (2 * M_PI * history->frequency * (1 + 1 / history->cycles));
    case HISTORY_TRIANGLE:
    case HISTORY_STEP:
    case HISTORY_TABLE:
        break;
    }
    return INFINITY;
}

/* Time after which the history without smoothing is constant (to rounding for Gaussian and Ricker). */
static double plain_end(const struct history *history)
{
    switch (history->kind) {
    case HISTORY_TRIANGLE:
        return history->duration;
    case HISTORY_STEP:
        return 0;
    case HISTORY_RICKER: /* (1 - 2 a) exp(-a) < 4e-17 from a = 42 on */
        return fmax(0, history->delay + sqrt(42.) / (M_PI * history->frequency));
    case HISTORY_BRUNE: /* (1 + x) exp(-x) < 1e-17 from x = 43 on */
        return 43 * history->width;
    case HISTORY_GAUSSIAN: /* exp(-a) < 6e-17 from a = 37.5 on */
    case HISTORY_ERROR_FUNCTION:
        return fmax(0, history->delay + sqrt(75.) * history->width);
    case HISTORY_SINE_BURST:
        return history->cycles / history->frequency;
    case HISTORY_TABLE:
        return history->rows > 0 ? history->table_time[history->rows - 1] : 0;
    }
    return 0;
}

double history_end(const struct history *history)
{
    return history->start + plain_end(history) + fmax(0, history->smoothing);
}

/* Derivative of order 0, 1 or 2 of the cubic B-spline with knots 0..4 and unit area (Schoenberg 1946). */
static double spline_value(double x, int derivative)
{
    const double y = fabs(x - 2), sign = x < 2 ? -1 : 1;
    if (y >= 2) return 0;
    switch (derivative) {
    case 0:
        return y < 1 ? 2. / 3 - y * y * (1 - .5 * y) : (2 - y) * (2 - y) * (2 - y) / 6;
    case 1:
        return sign * (y < 1 ? y * (1.5 * y - 2) : -.5 * (2 - y) * (2 - y));
    default:
        return y < 1 ? 3 * y - 2 : 2 - y;
    }
}

/* Abscissae and weights of the 8-point Gauss rule on [-1, 1]. */
static const double gauss_node[4] = {.18343464249564980494, .52553240991632898582, .79666647741362673959,
                                     .96028985649753623168};
static const double gauss_weight[4] = {.36268378337836198297, .31370664587788728734, .22238103445337447054,
                                       .10122853629037625915};

struct window {
    const struct history *history;
    double t, knot_spacing;
    int of_history, of_spline; /* orders of the derivatives */
};

static double panel(const struct window *window, double from, double to)
{
    const double centre = .5 * (from + to), half = .5 * (to - from);
    double sum = 0;
    for (int i = 0; i < 4; i++)
        for (int sign = -1; sign <= 1; sign += 2) {
            const double x = centre + sign * half * gauss_node[i];
            sum += gauss_weight[i] * spline_value(x / window->knot_spacing, window->of_spline) *
                   one_side(window->history, window->t - x, window->of_history, true);
        }
    return half * sum;
}

double history_value(const struct history *history, double t, int derivative)
{
    t -= history->start;
    if (fabs(t) <= 1e-14 * history->start)
        t = 0; /* a step of time on the start but for rounding: the jump's middle */
    if (history->smoothing <= 0) return history_plain_value(history, t, derivative);
    if (t <= 0) return 0;
    const double h = .25 * history->smoothing, scale = plain_scale(history);
    const bool smooth_inside = plain_kink_after(history, t - history->smoothing) >= t;
    struct window window = {history, t, h, derivative, 0};
    if (!smooth_inside && derivative > 0) {
        window.of_history = 0;
        window.of_spline = derivative;
    }
    /* In time tau = t - x from the oldest part of the window to the newest. */
    double sum = 0, old = t - history->smoothing;
    int knot = 3;
    while (knot >= 0) {
        const double end_of_knot = knot == 0 ? t : t - knot * h;
        double next = fmin(end_of_knot, plain_kink_after(history, old));
        if (next - old > scale) next = old + scale;
        if (next > 0) sum += panel(&window, t - next, t - fmax(old, 0));
        old = next;
        if (old >= end_of_knot) knot--;
    }
    return sum / pow(h, window.of_spline + 1);
}

size_t history_kinks(const struct history *history, double *times, size_t room)
{
    const int copies = history->smoothing > 0 ? 5 : 1;
    const double h = .25 * history->smoothing;
    double next[5] = {0};
    for (int i = 0; i < copies; i++)
        next[i] = plain_kink_after(history, -1);
    size_t count = 0;
    double last = -INFINITY;
    for (;;) {
        int first = 0;
        for (int i = 1; i < copies; i++)
            if (next[i] + i * h < next[first] + first * h) first = i;
        const double kink = next[first] + first * h;
        if (isinf(kink)) return count;
        if (kink > last * (1 + 4e-16)) { /* knots of two copies may fall together */
            if (count < room) times[count] = history->start + kink;
            count++;
            last = kink;
        }
        next[first] = plain_kink_after(history, next[first]);
    }
}

bool history_alike(const struct history *a, const struct history *b)
{
    if (a->kind != b->kind || a->duration != b->duration || a->frequency != b->frequency ||
        a->delay != b->delay || a->width != b->width || a->cycles != b->cycles ||
        a->smoothing != b->smoothing || a->rows != b->rows)
        return false;
    const size_t bytes = a->rows * sizeof(double);
    return a->rows == 0 || (memcmp(a->table_time, b->table_time, bytes) == 0 &&
                            memcmp(a->table_value, b->table_value, bytes) == 0);
}

bool history_same(const struct history *a, const struct history *b)
{
    return a->start == b->start && history_alike(a, b);
}

void history_set_rate(struct history *history, double end_time)
{
    enum { PARTS = 4000 };
    static const double slope_of_bell = 1.7320508075688772, stays = .1;
    const double end = history_end(history);
    const bool lasting = !(end < end_time) || history_value(history, end * (1 + 1e-9), 0) != 0;
    const double step = (lasting ? end_time : end) / PARTS;
    double square[3] = {0}, largest = 0, whole = 0, size = 0, moment = 0;
    for (int i = 0; i < PARTS; i++)
        for (int derivative = 0; derivative < 3; derivative++) {
            const double value = history_value(history, (i + .5) * step, derivative);
            square[derivative] += value * value;
            if (derivative > 0) continue;
            largest = fmax(largest, fabs(value));
            whole += value;
            size += fabs(value);
            moment += fabs(value) * (i + .5) * step;
        }
    history->rate = history->lasts = history->middle = 0;
    if (lasting && fabs(history_value(history, end_time, 0)) > stays * largest) {
        if (square[1] > 0) history->rate = sqrt(square[2] / square[1]);
    } else if (square[0] > 0) {
        history->rate = slope_of_bell * sqrt(square[1] / square[0]);
        history->lasts = fabs(whole) / largest * step;
        history->middle = moment / size;
    }
}

double history_rate_norm(const struct history *history)
{
    enum { STEPS = 2000 };
    const double step = (history_end(history) - history->start) / STEPS;
    double sum = 0;
    for (int i = 0; i < STEPS && step > 0; i++) {
        const double rate = history_value(history, history->start + (i + .5) * step, 1);
        sum += rate * rate * step;
    }
    return sqrt(sum);
}
