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
#include <string.h>

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

/* Quadrature of (3): true frequencies 0..half and their weights cos(omega' dt/2) / length, twice that for conjugate
 * pairs. They are not even in omega, but the rows are in time: each is smeared over a grid of frequencies by a
 * Gaussian, which an FFT takes to the rows, times a Gaussian in time that is divided out (Greengard & Lee 2004, SIAM
 * Review 46, Eqs 3 to 9; SPREAD cells to either side: 1e-12). */
enum { SPREAD = 12, ORDERS = 3 };
struct quadrature {
    size_t half;
    double *omega, *weight;
    size_t rows, grid;          /* an even number of rows; cells of 2 pi / grid in omega dt */
    double tau;                 /* of the Gaussian exp(-(omega dt)^2 / (4 tau)) */
    fftw_complex *cell[ORDERS]; /* of u, v, a */
};

static bool quadrature_create(double dt, size_t n, size_t length, struct quadrature *q)
{
    q->half = length / 2;
    q->rows = n + n % 2;
    q->grid = power_of_two_above(q->rows > SPREAD ? 2 * q->rows : 2 * SPREAD);
    const double finer = (double)q->grid / (double)q->rows;
    q->tau = PI * SPREAD / (finer * (finer - .5)) / ((double)q->rows * (double)q->rows);
    q->omega = array_new(q->half + 1, sizeof *q->omega);
    q->weight = array_new(q->half + 1, sizeof *q->weight);
    bool room = q->omega != NULL && q->weight != NULL && fft_room(q->grid);
    for (size_t order = 0; order < ORDERS; order++) {
        q->cell[order] = fftw_alloc_complex(q->grid);
        room = room && q->cell[order] != NULL;
    }
    for (size_t k = 0; k <= q->half && room; k++) {
        const double angle = PI * (double)k / (double)length;
        q->omega[k] = 2.0 / dt * sin(angle);
        q->weight[k] = cos(angle) * (k == 0 || k == q->half ? 1.0 : 2.0) / (double)length;
    }
    return room;
}

static void quadrature_free(struct quadrature *q)
{
    array_free(q->omega);
    array_free(q->weight);
    for (size_t order = 0; order < ORDERS; order++)
        fftw_free(q->cell[order]);
}

static void smear(const struct quadrature *q, double dt, const fftw_complex *spectrum)
{
    const double cell = 2.0 * PI / (double)q->grid;
    for (size_t order = 0; order < ORDERS; order++)
        memset(q->cell[order], 0, q->grid * sizeof *q->cell[order]);
    for (size_t k = 0; k <= q->half; k++) {
        const double omega = q->omega[k], angle = omega * dt;
        const double complex u = q->weight[k] * spectrum[k] * cexp(I * angle * .5 * (double)q->rows);
        const double complex part[ORDERS] = {u, I * omega * u, -omega * omega * u};
        const double first = floor(angle / cell) - SPREAD + 1;
        for (int m = 0; m < 2 * SPREAD; m++) {
            const double away = (first + m) * cell - angle;
            const double share = exp(-away * away / (4.0 * q->tau));
            const size_t at = (size_t)((long)first + m + (long)(SPREAD * q->grid)) % q->grid;
            for (size_t order = 0; order < ORDERS; order++)
                q->cell[order][at] += share * part[order];
        }
    }
}

/* Sums (3) for all rows of a component and its first two derivatives. */
static void unwarp_rows(const struct quadrature *q, double dt, size_t n, fftw_plan plan,
                        const fftw_complex *spectrum, double *const row[ORDERS])
{
    const double scale = sqrt(PI / q->tau) / (double)q->grid;
    smear(q, dt, spectrum);
    for (size_t order = 0; order < ORDERS; order++) {
        fftw_execute_dft(plan, q->cell[order], q->cell[order]);
        for (size_t i = 0; i < n; i++) {
            const double from_middle = (double)i - .5 * (double)q->rows;
            const size_t at = (i + q->grid - q->rows / 2) % q->grid;
            row[order][3 * i] = scale * exp(q->tau * from_middle * from_middle) * creal(q->cell[order][at]);
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
    fftw_complex *spectrum = fftw_alloc_complex(length / 2 + 1);
    double *padded = fftw_alloc_real(length);
    struct quadrature quadrature = {0};
    const bool room = quadrature_create(dt, n, length, &quadrature) && padded != NULL && spectrum != NULL &&
                      fft_room(length);
    if (room) {
        fftw_plan there, back;
#pragma omp critical(selas_fftw_planner)
        {
            there = fftw_plan_dft_r2c_1d((int)length, padded, spectrum, FFTW_ESTIMATE);
            back = fftw_plan_dft_1d((int)quadrature.grid, quadrature.cell[0], quadrature.cell[0],
                                    FFTW_BACKWARD, FFTW_ESTIMATE);
        }
        for (size_t c = 0; c < 3; c++) {
            double *const row[ORDERS] = {u + c, v + c, a + c};
            for (size_t i = 0; i < length; i++)
                padded[i] = faded(u, n, c, i);
            fftw_execute(there);
            unwarp_rows(&quadrature, dt, n, back, spectrum, row);
        }
#pragma omp critical(selas_fftw_planner)
        {
            fftw_destroy_plan(there);
            fftw_destroy_plan(back);
        }
    }
    fftw_free(spectrum);
    fftw_free(padded);
    quadrature_free(&quadrature);
    if (!room) return fail(messages, SELAS_NO_MEMORY, "no memory to un-warp a history of %zu rows", n);
    return SELAS_OK;
}
