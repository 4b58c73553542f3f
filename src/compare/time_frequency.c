/* Misfits in time and frequency, after Kristekova, Kristek, Moczo & Day (2006), Misfit criteria for
 * quantitative comparison of seismograms, BSSA 96.
 *
 * Continuous wavelet transform with the Morlet wavelet psi(t) = pi^(-1/4) exp(i w0 t) exp(-t^2/2), w0 = 6, at
 * scale s = w0 / (2 pi f):
 *
 *   W(t, f) = sqrt(s) / (2 pi) integral S(w) conj(psi^(s w)) exp(i w t) dw.
 *
 * Then
 *
 *   EM = sqrt( sum (|W_b| - |W_a|)^2 / sum |W_a|^2 )
 *   PM = sqrt( sum |W_a|^2 (arg(W_b / W_a) / pi)^2 / sum |W_a|^2 )
 *
 * over all times and FREQUENCIES frequencies, equally spaced in log f. */
#include "compare/diff.h"

#include "base/fft_room.h"

#include <complex.h>
#include <fftw3.h>
#include <math.h>
#include <string.h>

enum { FREQUENCIES = 48 };
static const double pi = 3.14159265358979323846;
static const double morlet = 6.0;
/* Frequencies at which the reference has less than this part of its largest amplitude do not count. */
static const double counting = 1e-3;

/* Spectra of both series, padded with zeros to twice their length. */
struct spectra {
    size_t length;
    fftw_complex *a, *b, *line_a, *line_b;
    fftw_plan forward_a, forward_b, backward_a, backward_b;
};

/* FFTW's planner is shared by all threads of the process: one at a time. */
static void spectra_plan(struct spectra *s)
{
    const int length = (int)s->length;
#pragma omp critical(selas_fftw_planner)
    {
        s->forward_a = fftw_plan_dft_1d(length, s->line_a, s->a, FFTW_FORWARD, FFTW_ESTIMATE);
        s->forward_b = fftw_plan_dft_1d(length, s->line_b, s->b, FFTW_FORWARD, FFTW_ESTIMATE);
        s->backward_a = fftw_plan_dft_1d(length, s->line_a, s->line_a, FFTW_BACKWARD, FFTW_ESTIMATE);
        s->backward_b = fftw_plan_dft_1d(length, s->line_b, s->line_b, FFTW_BACKWARD, FFTW_ESTIMATE);
    }
}

static void spectra_free(struct spectra *s)
{
#pragma omp critical(selas_fftw_planner)
    {
        if (s->forward_a != NULL) fftw_destroy_plan(s->forward_a);
        if (s->forward_b != NULL) fftw_destroy_plan(s->forward_b);
        if (s->backward_a != NULL) fftw_destroy_plan(s->backward_a);
        if (s->backward_b != NULL) fftw_destroy_plan(s->backward_b);
        fftw_free(s->a);
        fftw_free(s->b);
        fftw_free(s->line_a);
        fftw_free(s->line_b);
    }
}

static bool spectra_create(struct spectra *spectra, size_t n, const double *a, const double *b)
{
    *spectra = (struct spectra){.length = 2 * n};
    spectra->a = fftw_alloc_complex(spectra->length);
    spectra->b = fftw_alloc_complex(spectra->length);
    spectra->line_a = fftw_alloc_complex(spectra->length);
    spectra->line_b = fftw_alloc_complex(spectra->length);
    if (spectra->a == NULL || spectra->b == NULL || spectra->line_a == NULL || spectra->line_b == NULL ||
        !fft_room(4 * spectra->length))
        return false;
    spectra_plan(spectra);
    if (spectra->forward_a == NULL || spectra->forward_b == NULL || spectra->backward_a == NULL ||
        spectra->backward_b == NULL)
        return false;
    for (size_t i = 0; i < spectra->length; i++) {
        spectra->line_a[i] = i < n ? a[i] : 0.0;
        spectra->line_b[i] = i < n ? b[i] : 0.0;
    }
    fftw_execute(spectra->forward_a);
    fftw_execute(spectra->forward_b);
    return true;
}

static selas_status no_memory(struct messages *messages, size_t n)
{
    return fail(messages, SELAS_NO_MEMORY, "no memory for the spectrum of %zu values", n);
}

/* Highest frequency (in 1 / length) at which the reference still counts; 0 if it is zero throughout. */
static size_t highest(const struct spectra *spectra)
{
    double largest = 0.0;
    const size_t half = spectra->length / 2;
    for (size_t k = 1; k < half; k++)
        largest = fmax(largest, cabs(spectra->a[k]));
    size_t top = 0;
    for (size_t k = 1; k < half; k++)
        if (largest > 0.0 && cabs(spectra->a[k]) >= counting * largest) top = k;
    return top;
}

/* Adds one frequency's part to the three sums. */
static void add_frequency(struct spectra *spectra, size_t n, double place, double sum[3])
{
    const double factor = pow(pi, -0.25) * sqrt(morlet / place);
    for (size_t k = 0; k < spectra->length; k++) { /* the wavelet has no negative frequencies worth a word */
        const double away = morlet * ((double)k / place - 1.0);
        const double weight = k < spectra->length / 2 ? factor * exp(-0.5 * away * away) : 0.0;
        spectra->line_a[k] = weight * spectra->a[k];
        spectra->line_b[k] = weight * spectra->b[k];
    }
    fftw_execute(spectra->backward_a);
    fftw_execute(spectra->backward_b);
    for (size_t i = 0; i < n; i++) {
        const double size_a = cabs(spectra->line_a[i]), size_b = cabs(spectra->line_b[i]);
        const double turn = carg(spectra->line_b[i] * conj(spectra->line_a[i])) / pi;
        sum[0] += size_a * size_a;
        sum[1] += (size_b - size_a) * (size_b - size_a);
        sum[2] += size_b > 0.0 ? size_a * size_a * turn * turn : size_a * size_a;
    }
}

selas_status time_frequency_misfit(size_t n, const double *a, const double *b, double *envelope,
                                   double *phase, struct messages *messages)
{
    *envelope = *phase = 0.0;
    if (n < 4) return SELAS_OK;
    struct spectra spectra;
    if (!spectra_create(&spectra, n, a, b)) {
        spectra_free(&spectra);
        return no_memory(messages, n);
    }
    const double top = (double)highest(&spectra);
    const double bottom = 2.0; /* one period in the record */
    double sum[3] = {0};
    for (int f = 0; f < FREQUENCIES && top > bottom; f++)
        add_frequency(&spectra, n, bottom * pow(top / bottom, (double)f / (FREQUENCIES - 1)), sum);
    if (sum[0] > 0.0) {
        *envelope = sqrt(sum[1] / sum[0]);
        *phase = sqrt(sum[2] / sum[0]);
    }
    spectra_free(&spectra);
    return SELAS_OK;
}

selas_status correlation_shift(size_t n, const double *a, const double *b, double *shift,
                               struct messages *messages)
{
    *shift = 0.0;
    if (n < 4) return SELAS_OK;
    struct spectra spectra;
    if (!spectra_create(&spectra, n, a, b)) {
        spectra_free(&spectra);
        return no_memory(messages, n);
    }
    const size_t length = spectra.length;
    for (size_t k = 0; k < length; k++)
        spectra.line_a[k] = spectra.b[k] * conj(spectra.a[k]);
    fftw_execute(spectra.backward_a); /* correlation at lag i, negative lags from the end */
    size_t best = 0;
    for (size_t i = 1; i < length; i++)
        if (creal(spectra.line_a[i]) > creal(spectra.line_a[best])) best = i;
    const double left = creal(spectra.line_a[best == 0 ? length - 1 : best - 1]);
    const double middle = creal(spectra.line_a[best]);
    const double right = creal(spectra.line_a[best + 1 == length ? 0 : best + 1]);
    const double bend = left - 2.0 * middle + right;
    *shift = best < length / 2 ? (double)best : (double)best - (double)length;
    if (bend < 0.0) *shift += 0.5 * (left - right) / bend;
    spectra_free(&spectra);
    return SELAS_OK;
}
