/* The time-dispersion transform of stepping/time_dispersion.h.
 *
 * With z = exp(s' dt), leapfrog replaces s^2 by
 *
 *   (z - 2 + 1/z) / dt^2 = S(s')^2,   S(s') = (2/dt) sinh(s' dt/2).
 *
 * So if the exact answer is u^(s) = G(s) f^(s), leapfrog driven by g gives
 *
 *   u'^(s') = G(S(s')) g^(s').                                                                          (1)
 *
 * Warp:    g^(s') = f^(S(s')),
 *          g_i = (dt / 2 pi i) integral of g^(s') exp(s' i dt) ds' over one period,                     (2)
 *          on Re s' = eta > 0, by FFT; f^ is the analytic Laplace transform of the history.
 *
 * Un-warp: u^(i omega) = u'^(i omega'),   omega' = (2/dt) asin(omega dt/2),
 *          hence with d omega = cos(omega' dt/2) d omega'
 *          u(t) = 1/(2 pi) integral over |omega'| < pi/dt of
 *                 u'^(i omega') exp(i omega t) cos(omega' dt/2) d omega'.                               (3)
 *
 * Velocity and acceleration get the factors i omega and -omega^2. Waves of the record's end come from later
 * true times (group delay t / cos(omega' dt/2) >= t), so a cut record needs only padding, not more steps. */
#include "stepping/time_dispersion.h"

#include "base/fft_room.h"
#include "base/memory.h"

#include <complex.h>
#include <fftw3.h>
#include <math.h>

static const double PI = 3.14159265358979323846;

static size_t power_of_two_above(size_t n)
{
    size_t p = 1;
    while (p < n)
        p *= 2;
    return p;
}

selas_status time_dispersion_warp(const struct history *history, int integrals, double dt, size_t rows,
                                  size_t stride, double *value, struct messages *messages)
{
    const size_t length = power_of_two_above(4 * rows);
    /* wrap-around exp(-eta length dt) at 1e-12 of the history; it is amplified by exp(eta t) <= exp(28/4) in
     * the rows kept */
    const double eta = 28.0 / ((double)length * dt);
    fftw_complex *spectrum = fftw_alloc_complex(length);
    if (spectrum == NULL || !fft_room(length)) {
        fftw_free(spectrum);
        return fail(messages, SELAS_NO_MEMORY, "no memory to warp a history of %zu rows", rows);
    }
    for (size_t k = 0; k < length; k++) {
        const double phase =
            2.0 * PI * (k <= length / 2 ? (double)k : (double)k - (double)length) / (double)length;
        const double complex half = 0.5 * (eta * dt + I * phase);
        const double complex s = 2.0 / dt * csinh(half);
        double complex f = history_laplace(history, s);
        if (integrals == 1) f /= s;
        spectrum[k] = 2 * k == length ? creal(f) : f;
    }
    fftw_plan plan;
#pragma omp critical(selas_fftw_planner)
    plan = fftw_plan_dft_1d((int)length, spectrum, spectrum, FFTW_BACKWARD, FFTW_ESTIMATE);
    fftw_execute(plan);
#pragma omp critical(selas_fftw_planner)
    fftw_destroy_plan(plan);
    for (size_t i = 0; i < rows; i++)
        value[stride * i] = creal(spectrum[i]) / ((double)length * dt) * exp(eta * (double)i * dt);
    fftw_free(spectrum);
    return SELAS_OK;
}

/* Quadrature of (3): what does not change from row to row. */
struct quadrature {
    size_t half;            /* frequencies 0..half */
    double *omega, *weight; /* true frequency; cos(omega' dt/2) / length, twice that for conjugate pairs */
    double complex *turn, *phasor; /* exp(i omega dt), exp(i omega t) */
};

static bool quadrature_create(double dt, size_t length, struct quadrature *q)
{
    q->half = length / 2;
    q->omega = array_new(q->half + 1, sizeof *q->omega);
    q->weight = array_new(q->half + 1, sizeof *q->weight);
    q->turn = array_new(q->half + 1, sizeof *q->turn);
    q->phasor = array_new(q->half + 1, sizeof *q->phasor);
    if (q->omega == NULL || q->weight == NULL || q->turn == NULL || q->phasor == NULL) return false;
    for (size_t k = 0; k <= q->half; k++) {
        const double angle = PI * (double)k / (double)length;
        q->omega[k] = 2.0 / dt * sin(angle);
        q->weight[k] = cos(angle) * (k == 0 || k == q->half ? 1.0 : 2.0) / (double)length;
        q->turn[k] = cexp(I * q->omega[k] * dt);
        q->phasor[k] = 1.0;
    }
    return true;
}

static void quadrature_free(struct quadrature *q)
{
    array_free(q->omega);
    array_free(q->weight);
    array_free(q->turn);
    array_free(q->phasor);
}

/* Sums (3) for all rows and its first two derivatives. */
static void unwarp_rows(struct quadrature *q, size_t n, fftw_complex *const spectrum[3], double *u, double *v,
                        double *a)
{
    for (size_t i = 0; i < n; i++) {
        double sum[9] = {0.0};
        for (size_t k = 0; k <= q->half; k++) {
            const double complex factor = q->weight[k] * q->phasor[k];
            const double omega = q->omega[k];
            for (size_t c = 0; c < 3; c++) {
                const double complex term = spectrum[c][k] * factor;
                sum[c] += creal(term);
                sum[3 + c] -= omega * cimag(term);
                sum[6 + c] -= omega * omega * creal(term);
            }
            q->phasor[k] *= q->turn[k];
        }
        for (size_t c = 0; c < 3; c++) {
            u[3 * i + c] = sum[c];
            v[3 * i + c] = sum[3 + c];
            a[3 * i + c] = sum[6 + c];
        }
    }
}

/* The record goes on beyond its end with its last value, faded out over its own length, so that the end does
 * not ring. */
static double faded(const double *u, size_t n, size_t c, size_t i)
{
    if (i < n) return u[3 * i + c];
    if (i >= 2 * n) return 0.0;
    return u[3 * (n - 1) + c] * 0.5 * (1.0 + cos(PI * (double)(i - n) / (double)n));
}

selas_status time_dispersion_unwarp(double dt, size_t n, double *u, double *v, double *a,
                                    struct messages *messages)
{
    if (n < 2) return SELAS_OK;
    const size_t length = power_of_two_above(4 * n);
    fftw_complex *spectrum[3] = {NULL, NULL, NULL};
    double *padded = fftw_alloc_real(length);
    struct quadrature quadrature = {0};
    bool room = quadrature_create(dt, length, &quadrature) && padded != NULL && fft_room(length);
    for (size_t c = 0; c < 3; c++) {
        spectrum[c] = fftw_alloc_complex(length / 2 + 1);
        room = room && spectrum[c] != NULL;
    }
    if (room) {
        fftw_plan plan;
#pragma omp critical(selas_fftw_planner)
        plan = fftw_plan_dft_r2c_1d((int)length, padded, spectrum[0], FFTW_ESTIMATE);
        for (size_t c = 0; c < 3; c++) {
            for (size_t i = 0; i < length; i++)
                padded[i] = faded(u, n, c, i);
            fftw_execute_dft_r2c(plan, padded, spectrum[c]);
        }
#pragma omp critical(selas_fftw_planner)
        fftw_destroy_plan(plan);
        unwarp_rows(&quadrature, n, spectrum, u, v, a);
    }
    for (size_t c = 0; c < 3; c++)
        fftw_free(spectrum[c]);
    fftw_free(padded);
    quadrature_free(&quadrature);
    if (!room) return fail(messages, SELAS_NO_MEMORY, "no memory to un-warp a history of %zu rows", n);
    return SELAS_OK;
}
