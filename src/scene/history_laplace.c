/* Laplace transforms F(s) = integral of f(t) exp(-s t) dt of time functions, and their cutoff frequencies.
 *
 * Smoothing by the cubic B-spline on [0, S] multiplies by ((1 - exp(-s S/4)) / (s S/4))^4. The Gaussian and
 * the Ricker wavelet are cut at t = 0, which needs the error function of a complex argument. */
#include "base/faddeeva.h"
#include "base/memory.h"
#include "scene/history.h"
#include "scene/history_kinds.h"

#include <math.h>

double complex history_decay_ratio(double complex x)
{
    if (cabs(x) > .1) return (1 - cexp(-x)) / x;
    return 1 -
           x / 2 *
               (1 -
                x / 3 *
                    (1 -
                     x / 4 *
                         (1 - x / 5 * (1 - x / 6 * (1 - x / 7 * (1 - x / 8 * (1 - x / 9 * (1 - x / 10))))))));
}

/* Integral from 0 to infinity of exp(-(t - delay)^2 / (2 width^2) - s t) dt
 *   = width sqrt(pi/2) exp(-delay^2/(2 width^2)) erfcx(z),  z = (s width - delay/width) / sqrt 2,      (1)
 * with erfcx(z) = exp(z^2) erfc(z) = 2 exp(z^2) - erfcx(-z), the latter form where Re z < 0. */
static double complex cut_gaussian(double width, double delay, double complex s)
{
    const double ratio = delay / width, factor = width * sqrt(M_PI / 2), tail = exp(-.5 * ratio * ratio);
    const double complex z = (s * width - ratio) * M_SQRT1_2;
    if (creal(z) >= 0) return factor * tail * scaled_erfc(z);
    return factor * (2 * cexp(s * (.5 * s * width * width - delay)) - tail * scaled_erfc(-z));
}

/* f = -g''/(2 b^2) with g = exp(-b^2 (t - delay)^2), b = pi frequency; L[g''] = s^2 G - s g(0) - g'(0). */
static double complex cut_ricker(double frequency, double delay, double complex s)
{
    const double b = M_PI * frequency, start = exp(-b * b * delay * delay);
    const double complex bell = cut_gaussian(M_SQRT1_2 / b, delay, s);
    return -(s * s * bell - s * start - 2 * b * b * delay * start) / (2 * b * b);
}

/* f' is a Gaussian of unit area; f(0) is what the cut leaves of it before t = 0. */
static double complex cut_error_function(double width, double delay, double complex s)
{
    const double start = .5 * erfc(delay / width * M_SQRT1_2);
    return (start + cut_gaussian(width, delay, s) / (width * sqrt(2 * M_PI))) / s;
}

/* Sum of three sines over [0, end]: integral of sin(a t) exp(-s t) dt
 *   = [a - exp(-s end) (s sin(a end) + a cos(a end))] / (s^2 + a^2).                                   (2) */
static double complex burst(const struct history *history, double complex s)
{
    const double end = history->cycles / history->frequency, a = 2 * M_PI * history->frequency;
    const double rate[3] = {a, a * (1 + 1 / history->cycles), a * (1 - 1 / history->cycles)};
    const double weight[3] = {.5, -.25, -.25};
    double complex sum = 0;
    for (int i = 0; i < 3; i++)
        sum += weight[i] *
               (rate[i] - cexp(-s * end) * (s * sin(rate[i] * end) + rate[i] * cos(rate[i] * end))) /
               (s * s + rate[i] * rate[i]);
    return sum;
}

static double complex plain_laplace(const struct history *history, double complex s)
{
    switch (history->kind) {
    case HISTORY_TRIANGLE: {
        const double half = .5 * history->duration;
        const double complex ratio = history_decay_ratio(s * half);
        return half * ratio * ratio;
    }
    case HISTORY_STEP:
        return 1 / s;
    case HISTORY_RICKER:
        return cut_ricker(history->frequency, history->delay, s);
    case HISTORY_GAUSSIAN:
        return cut_gaussian(history->width, history->delay, s);
    case HISTORY_SINE_BURST:
        return burst(history, s);
    case HISTORY_TABLE:
        return history->rows > 0 ? history_table_laplace(history, s) : 0;
    case HISTORY_BRUNE:
        return 1 / (s * (1 + s * history->width) * (1 + s * history->width));
    case HISTORY_ERROR_FUNCTION:
        return cut_error_function(history->width, history->delay, s);
    }
    return 0;
}

/* Transform of what begins at `start` and is smoothed, from that of the plain history. */
static double complex completed(const struct history *history, double complex s, double complex plain)
{
    if (history->start > 0) plain *= cexp(-s * history->start);
    if (history->smoothing <= 0) return plain;
    const double complex ratio = history_decay_ratio(.25 * s * history->smoothing), square = ratio * ratio;
    return plain * square * square;
}

double complex history_laplace(const struct history *history, double complex s)
{
    return completed(history, s, plain_laplace(history, s));
}

double complex history_laplace_uncut(const struct history *history, double complex s)
{
    static const double unseen = 5e-5;
    const enum history_kind kind = history->kind;
    const bool bell = kind == HISTORY_GAUSSIAN || kind == HISTORY_ERROR_FUNCTION,
               wavelet = kind == HISTORY_RICKER;
    if ((!bell && !wavelet) || fabs(history_plain_value(history, 0, 0)) > .5 * unseen)
        return history_laplace(history, s);
    const double width = bell ? history->width : M_SQRT1_2 / (M_PI * history->frequency);
    double complex plain = width * sqrt(2 * M_PI) * cexp(s * (.5 * s * width * width - history->delay));
    if (wavelet) plain *= -s * s * width * width;
    if (kind == HISTORY_ERROR_FUNCTION) plain /= width * sqrt(2 * M_PI) * s;
    return completed(history, s, plain);
}

/* The spectrum that history_cutoff() judges: of f, or of f' where f does not come back to zero. */
static bool comes_back(const struct history *history)
{
    if (history->kind == HISTORY_STEP || history->kind == HISTORY_BRUNE ||
        history->kind == HISTORY_ERROR_FUNCTION)
        return false;
    return history->kind != HISTORY_TABLE || history_table_ends(history);
}

/* Frequency beyond which envelope() holds. */
static double highest_peak(const struct history *history)
{
    /* of a step: where its smoothing begins to count; without one its spectrum is the same at all frequencies */
    const double step = history->smoothing > 0 ? 8 / history->smoothing : 1;
    switch (history->kind) {
    case HISTORY_TRIANGLE:
        return 4 / history->duration;
    case HISTORY_GAUSSIAN:
    case HISTORY_BRUNE:
    case HISTORY_ERROR_FUNCTION:
        return 1 / history->width;
    case HISTORY_RICKER:
        return 2 * M_PI * history->frequency;
    case HISTORY_SINE_BURST:
        return 2 * M_PI * history->frequency * (1 + 1 / history->cycles);
    case HISTORY_TABLE:
        return history->rows > 1 ? history_table_top(history) : step;
    case HISTORY_STEP:
        break;
    }
    return step;
}

/* Bound of |F(i w)| (of |w F| if f does not come back) that decreases for w > highest_peak(). */
static double plain_envelope(const struct history *history, double w)
{
    switch (history->kind) {
    case HISTORY_TRIANGLE:
        return 8 / (history->duration * w * w);
    case HISTORY_STEP:
        return 1;
    case HISTORY_GAUSSIAN: {
        const double x = w * history->width, ratio = history->delay / history->width;
        return history->width * sqrt(2 * M_PI) * exp(-.5 * x * x) + exp(-.5 * ratio * ratio) / w;
    }
    case HISTORY_RICKER: {
        const double b = M_PI * history->frequency, x = w / b, cut = b * history->delay;
        return sqrt(M_PI) / (2 * b) * x * x * exp(-.25 * x * x) + (1 + 2 * cut * cut) * exp(-cut * cut) / w;
    }
    case HISTORY_SINE_BURST: { /* Eq 2 with the sines summed; a (1 +- 1/n) end = a end +- 2 pi */
        const double a = 2 * M_PI * history->frequency, x = 1 / history->cycles;
        const double phase = 2 * M_PI * history->cycles;
        const double rate[3] = {a, a * (1 + x), a * (1 - x)}, weight[3] = {.5, -.25, -.25};
        double odd = 0, even = 0;
        for (int i = 0; i < 3; i++) {
            odd += weight[i] * rate[i] / (w * w - rate[i] * rate[i]);
            even += weight[i] / (w * w - rate[i] * rate[i]);
        }
        return (1 + fabs(cos(phase))) * fabs(odd) + fabs(sin(phase)) * w * fabs(even);
    }
    case HISTORY_TABLE: {
        const double sum = fabs(history->table_value[0]) / w + history_table_kinks(history) / (w * w);
        return comes_back(history) ? sum : w * sum;
    }
    case HISTORY_BRUNE: {
        const double x = w * history->width;
        return 1 / (1 + x * x);
    }
    case HISTORY_ERROR_FUNCTION: {
        const double x = w * history->width, ratio = history->delay / history->width;
        return exp(-.5 * x * x) + exp(-.5 * ratio * ratio) / (x * sqrt(2 * M_PI)) +
               .5 * erfc(ratio * M_SQRT1_2);
    }
    }
    return 0;
}

static double envelope(const struct history *history, double w)
{
    const double plain = plain_envelope(history, w);
    if (history->smoothing <= 0) return plain;
    return plain * fmin(1, pow(8 / (w * history->smoothing), 4)); /* |2 sin(x/2) / x|^4, x = w S/4 */
}

/* The spectrum that history_cutoff() judges, of a table below highest_peak(): its largest value, and the frequency
 * above which it stays below `level`, highest_peak() or more if there is none. One that has fallen so far is that of a
 * smooth function: what straight lines between its rows add beyond is not meant. */
static double table_spectrum(const struct history *history, double level, double *above)
{
    struct table_spectrum spectrum;
    const bool back = comes_back(history);
    const size_t last = history->rows - 1;
    double largest = back ? fabs(history_table_value(history, history->table_time[last], -1, true))
                          : fabs(history->table_value[last]);
    *above = 0;
    if (!history_table_spectrum(history, &spectrum)) {
        *above = INFINITY;
        return largest;
    }
    for (size_t k = 1; k <= spectrum.count; k++) {
        const double w = (double)k * spectrum.step;
        double value = spectrum.amplitude[k] * (back ? 1 : w);
        if (history->smoothing > 0)
            value *= pow(cabs(history_decay_ratio(.25 * I * w * history->smoothing)), 4);
        largest = fmax(largest, value);
        if (value > level) *above = w + spectrum.step;
    }
    array_free(spectrum.amplitude);
    return largest;
}

/* Largest |F(i w)|, or |w F| if f does not come back, for w <= highest_peak(). */
static double spectrum_peak(const struct history *history)
{
    enum { SAMPLES = 512 };
    double above;
    if (history->kind == HISTORY_TABLE && history->rows > 1) return table_spectrum(history, INFINITY, &above);
    struct history still = *history;
    still.start = 0;
    const double top = highest_peak(&still), span = fmax(history_end(&still), 1 / top);
    const bool back = comes_back(&still);
    double largest = 0;
    for (int i = 0; i < SAMPLES; i++) {
        const double complex s = 1e-6 / span + I * (top * i / SAMPLES);
        largest = fmax(largest, cabs(history_laplace(&still, s)) * (back ? 1 : cabs(s)));
    }
    return largest;
}

void history_set_peak(struct history *history)
{
    history->peak = spectrum_peak(history);
}

double history_cutoff(const struct history *history, double fraction)
{
    if (history->kind == HISTORY_TABLE && history->rows == 0) return 0;
    const double top = highest_peak(history),
                 largest = history->peak > 0 ? history->peak : spectrum_peak(history);
    double low = top * (1 + 1e-9), high = low;
    if (!(largest > 0)) return 0;
    if (history->kind == HISTORY_TABLE && history->rows > 1) {
        table_spectrum(history, fraction * largest, &high);
        if (high < top) return high;
        high = low;
    }
    while (envelope(history, high) > fraction * largest) {
        low = high;
        high *= 2;
        if (high > 1e15 * top) return INFINITY;
    }
    for (int i = 0; i < 60 && high > low; i++) {
        const double middle = .5 * (low + high);
        if (envelope(history, middle) > fraction * largest)
            low = middle;
        else
            high = middle;
    }
    return high;
}
