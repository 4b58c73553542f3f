/* Sums over long vectors: right, the same bits whatever the number of threads, and not finite where a number
 * is not. */
#include "base/memory.h"
#include "base/sums.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <math.h>

static const size_t MANY = 3000017;

static void sums_of_all_lengths(void **unused)
{
    (void)unused;
    static const size_t length[] = {0, 1, 7, 4095, 4096, 4097, 70001, 256 * 4096, 256 * 4096 + 1, MANY};
    double *x = array_new(MANY, sizeof *x), *y = array_new(MANY, sizeof *y);
    assert_non_null(x);
    assert_non_null(y);
    for (size_t i = 0; i < MANY; i++) {
        x[i] = (double)(i % 97) - 48; /* whole numbers: sums are exact in any order */
        y[i] = (double)(i % 31) - 11;
    }
    for (size_t l = 0; l < sizeof length / sizeof *length; l++) {
        long whole = 0;
        for (size_t i = 0; i < length[l]; i++)
            whole += (long)x[i] * (long)y[i];
        for (int threads = 1; threads <= 4; threads++)
            assert_true(sum_of_products(length[l], x, y, threads) == (double)whole);
    }
    for (size_t i = 0; i < MANY; i++)
        x[i] = sin((double)i) / (1 + (double)(i % 1013)); /* not exact: the order shows */
    const double one = sum_of_products(MANY, x, y, 1);
    for (int threads = 2; threads <= 5; threads++)
        assert_true(sum_of_products(MANY, x, y, threads) == one);
    array_free(x);
    array_free(y);
}

static void what_is_not_finite_shows(void **unused)
{
    (void)unused;
    static const double bad[] = {NAN, INFINITY, 1e200};
    double *x = array_new(MANY, sizeof *x);
    assert_non_null(x);
    for (size_t k = 0; k < 3; k++)
        for (size_t place = 0; place < MANY; place += MANY / 7) {
            x[place] = bad[k];
            assert_true(!isfinite(sum_of_products(MANY, x, x, 2)));
            x[place] = 0;
        }
    assert_true(sum_of_products(MANY, x, x, 2) == 0);
    array_free(x);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sums_of_all_lengths),
        cmocka_unit_test(what_is_not_finite_shows),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
