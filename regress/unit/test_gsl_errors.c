/* A host's handler of GSL's errors is not called within gsl_errors_returned() and stands again after it:
 * nested, in several threads, and where the host sets another one meanwhile. */
#include "base/gsl_errors.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <omp.h>

static int met;

static void host(const char *reason, const char *file, int line, int error)
{
    (void)reason, (void)file, (void)line, (void)error;
#pragma omp atomic
    met++;
}

static void other(const char *reason, const char *file, int line, int error)
{
    host(reason, file, line, error);
}

/* What GSL says of a matrix that has no Cholesky factor. */
static int wrong_matrix(void)
{
    double a[4] = {1, 2, 2, 1};
    gsl_matrix_view view = gsl_matrix_view_array(a, 2, 2);
    return gsl_linalg_cholesky_decomp1(&view.matrix);
}

static void test_nested(void **unused)
{
    (void)unused;
    gsl_set_error_handler(host);
    met = 0;
    gsl_errors_returned();
    gsl_errors_returned();
    assert_int_equal(wrong_matrix(), GSL_EDOM);
    gsl_errors_as_before();
    assert_int_equal(wrong_matrix(), GSL_EDOM);
    gsl_errors_as_before();
    assert_int_equal(met, 0);
    wrong_matrix();
    assert_int_equal(met, 1);
    assert_true(gsl_set_error_handler(NULL) == host);
}

static void test_threads(void **unused)
{
    (void)unused;
    gsl_set_error_handler(host);
    met = 0;
    int wrong = 0;
#pragma omp parallel for num_threads(4) schedule(dynamic, 1) reduction(+ : wrong)
    for (int k = 0; k < 20000; k++) {
        gsl_errors_returned();
        wrong += wrong_matrix() != GSL_EDOM;
        gsl_errors_as_before();
    }
    assert_int_equal(wrong, 0);
    assert_int_equal(met, 0);
    assert_true(gsl_set_error_handler(NULL) == host);
}

static void test_host_sets_another(void **unused)
{
    (void)unused;
    gsl_set_error_handler(host);
    gsl_errors_returned();
    gsl_set_error_handler(other);
    gsl_errors_as_before();
    assert_true(gsl_set_error_handler(NULL) == other);
}

/* GSL's own handler, which ends the program, is NULL. */
static void test_none(void **unused)
{
    (void)unused;
    gsl_errors_returned();
    assert_int_equal(wrong_matrix(), GSL_EDOM);
    gsl_errors_as_before();
    assert_null(gsl_set_error_handler(NULL));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_nested), cmocka_unit_test(test_threads),
                                       cmocka_unit_test(test_host_sets_another), cmocka_unit_test(test_none)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
