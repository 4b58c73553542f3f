/* Un-warping against its sums as they stand (doc/theory/stepping.md), for records of chance of any length. */

#include "stepping/time_dispersion.h"

#include <complex.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

enum { MOST = 301, LENGTH = 2048 };
static const double PI = 3.14159265358979323846;

static double chance(void)
{
    static unsigned long seed = 1;
    seed = seed * 6364136223846793005UL + 1442695040888963407UL;
    return (double)(seed >> 33) / 1073741824.0 - 1;
}

/* The record goes on with its last value, faded out over its own length. */
static double record_at(const double *u, size_t n, size_t i)
{
    if (i < n) return u[i];
    return i < 2 * n ? u[n - 1] * .5 * (1 + cos(PI * (double)(i - n) / (double)n)) : 0;
}

/* u, v and a at row i, from the spectrum [length / 2 + 1]. */
static void sums(const double complex *spectrum, size_t length, double dt, size_t i, double value[3])
{
    value[0] = value[1] = value[2] = 0;
    for (size_t k = 0; k <= length / 2; k++) {
        const double angle = PI * (double)k / (double)length, omega = 2 / dt * sin(angle);
        const double weight = cos(angle) * (k == 0 || 2 * k == length ? 1 : 2) / (double)length;
        const double complex term = weight * spectrum[k] * cexp(I * omega * dt * (double)i);
        value[0] += creal(term);
        value[1] += creal(I * omega * term);
        value[2] -= creal(omega * omega * term);
    }
}

static void rows_are_the_sums(void **state)
{
    (void)state;
    static const size_t size[] = {2, 3, 5, 16, 47, MOST};
    static const double dt = .03;
    static double u[3 * MOST], v[3 * MOST], a[3 * MOST], record[MOST];
    static double complex spectrum[LENGTH / 2 + 1];
    double worst = 0;
    for (size_t s = 0; s < sizeof size / sizeof *size; s++) {
        const size_t n = size[s];
        struct messages messages = {0};
        size_t length = 1;
        while (length < 4 * n)
            length *= 2;
        assert_true(length <= LENGTH);
        for (size_t i = 0; i < 3 * n; i++)
            u[i] = chance();
        for (size_t i = 0; i < n; i++)
            record[i] = u[3 * i + 1];
        for (size_t k = 0; k <= length / 2; k++) {
            spectrum[k] = 0;
            for (size_t i = 0; i < length; i++)
                spectrum[k] +=
                    record_at(record, n, i) * cexp(-2 * PI * I * (double)(i * k % length) / (double)length);
        }
        assert_int_equal(time_dispersion_unwarp(dt, n, u, v, a, &messages), SELAS_OK);
        for (size_t i = 0; i < n; i++) {
            double value[3];
            sums(spectrum, length, dt, i, value);
            worst = fmax(worst, fabs(u[3 * i + 1] - value[0]));
            worst = fmax(worst, fabs(v[3 * i + 1] - value[1]) * dt);
            worst = fmax(worst, fabs(a[3 * i + 1] - value[2]) * dt * dt);
        }
    }
    print_message("# rows against sums: %.1e\n", worst);
    assert_true(worst < 1e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(rows_are_the_sums)};
    return cmocka_run_group_tests_name("time_dispersion", tests, NULL, NULL);
}
