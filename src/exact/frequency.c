/* Frequency of a history: for each w the weighted linear least-squares fit of a cos + b sin + c is a 3 x 3
 * system; w minimises the residual (GSL, Brent's method; variable projection of Golub & Pereyra 1973). */
#include "exact/frequency.h"

#include "base/gsl_errors.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_min.h>
#include <math.h>

struct series {
    size_t n, stride;
    const double *time, *value;
};

/* Weighted sum of squares left by the best fit at w, as a part of all. */
static double residual(double w, void *data)
{
    const struct series *series = data;
    const double from = series->time[0];
    const double span = series->time[series->n - 1] - from;
    double normal[9] = {0};
    double right[3] = {0};
    double fit[3];
    double all = 0;
    for (size_t i = 0; i < series->n; i++) {
        const double t = series->time[i] - from;
        const double weight = 1 - cos(2 * M_PI * t / span);
        const double basis[3] = {cos(w * t), sin(w * t), 1};
        const double y = series->value[series->stride * i];
        for (int a = 0; a < 3; a++) {
            right[a] += weight * basis[a] * y;
            for (int b = 0; b < 3; b++)
                normal[3 * a + b] += weight * basis[a] * basis[b];
        }
        all += weight * y * y;
    }
    gsl_matrix_view matrix = gsl_matrix_view_array(normal, 3, 3);
    const gsl_vector_view side = gsl_vector_view_array(right, 3);
    gsl_vector_view solution = gsl_vector_view_array(fit, 3);
    if (gsl_linalg_cholesky_decomp1(&matrix.matrix) != GSL_SUCCESS) return INFINITY;
    gsl_linalg_cholesky_solve(&matrix.matrix, &side.vector, &solution.vector);
    return 1 - (fit[0] * right[0] + fit[1] * right[1] + fit[2] * right[2]) / all;
}

selas_status fit_frequency(size_t n, const double *time, const double *value, size_t stride, double guess,
                           double *frequency, struct messages *messages)
{
    enum { SCAN = 400, ITERATIONS = 100 };
    static const double mostly = 0.5; /* of the motion's square that no oscillation takes up */
    if (n < 8 || !(guess > 0) || !((time[n - 1] - time[0]) * guess > 4 * M_PI))
        return fail(messages, SELAS_BAD_ARGUMENT, "a frequency needs a history of two periods");
    struct series series = {n, stride, time, value};
    const double step = (1.5 - 1 / 1.5) * guess / SCAN;
    gsl_errors_returned();
    double best = guess;
    double least = INFINITY;
    for (int k = 0; k < SCAN; k++) {
        const double w = guess / 1.5 + k * step;
        const double left = residual(w, &series);
        if (!(left < least)) continue;
        least = left;
        best = w;
    }
    gsl_function function = {residual, &series};
    gsl_min_fminimizer *search = gsl_min_fminimizer_alloc(gsl_min_fminimizer_brent);
    if (search == NULL) {
        gsl_errors_as_before();
        return fail(messages, SELAS_NO_MEMORY, "no memory to fit a frequency");
    }
    int status = gsl_min_fminimizer_set(search, &function, best, best - step, best + step);
    for (int k = 0; k < ITERATIONS && status == GSL_SUCCESS; k++) {
        status = gsl_min_fminimizer_iterate(search);
        if (gsl_min_test_interval(gsl_min_fminimizer_x_lower(search), gsl_min_fminimizer_x_upper(search), 0,
                                  1e-9) == GSL_SUCCESS)
            break;
    }
    *frequency = gsl_min_fminimizer_x_minimum(search);
    least = gsl_min_fminimizer_f_minimum(search);
    gsl_min_fminimizer_free(search);
    gsl_errors_as_before();
    if (!(least < mostly) || !(*frequency > 0))
        return fail(messages, SELAS_NOT_CONVERGED, "the motion is no oscillation of %.4g to %.4g",
                    guess / 1.5, 1.5 * guess);
    return SELAS_OK;
}
