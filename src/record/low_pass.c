/* Zero-phase low-pass of a finished history: multiplies its spectrum by exp(-(omega / cutoff)^4).
 *
 * The impulse response of this filter falls off faster than any exponential: 8 periods of the cutoff hold it
 * to rounding. The series goes on that far on both sides before it meets itself. */
#include "record/parts.h"

#include "base/fft_room.h"

#include <complex.h>
#include <fftw3.h>
#include <math.h>

/* The series with its continuation: zeros (from rest) or point reflection before, point reflection after;
 * then a straight line back to where it began, so that the periodic series has no jump. */
static double continued(const double *series, size_t rows, size_t columns, size_t column, size_t pad,
                        bool from_rest, size_t length, size_t i)
{
    const double first = series[column], last = series[(rows - 1) * columns + column];
    if (i >= pad && i < pad + rows) return series[(i - pad) * columns + column];
    if (i < pad) {
        if (from_rest) return first;
        const size_t back = pad - i < rows ? pad - i : rows - 1;
        return 2.0 * first - series[back * columns + column];
    }
    const size_t beyond = i - pad - rows + 1;
    const double reflected_end =
        2.0 * last - series[(rows - 1 - (pad < rows ? pad : rows - 1)) * columns + column];
    if (beyond <= pad) {
        const size_t back = beyond < rows ? beyond : rows - 1;
        return 2.0 * last - series[(rows - 1 - back) * columns + column];
    }
    const double start = continued(series, rows, columns, column, pad, from_rest, length, 0);
    const double portion = (double)(i - 2 * pad - rows + 1) / (double)(length - 2 * pad - rows + 1);
    return reflected_end + portion * (start - reflected_end);
}

selas_status low_pass(double dt, double cutoff, bool from_rest, size_t rows, size_t columns, double *series,
                      struct messages *messages)
{
    if (rows < 2 || !(cutoff > 0.0)) return SELAS_OK;
    const double two_pi = 6.283185307179586477;
    const double reach = ceil(8.0 * two_pi / cutoff / dt);
    if (!(3.0 * reach + (double)rows < 1e9))
        return fail(messages, SELAS_BAD_SCENE, "output%%low_pass = %g is too low for steps of %g", cutoff,
                    dt);
    const size_t pad = (size_t)reach;
    const size_t length = rows + 3 * pad;
    double *line = fftw_alloc_real(length);
    fftw_complex *spectrum = fftw_alloc_complex(length / 2 + 1);
    if (line == NULL || spectrum == NULL || !fft_room(length)) {
        fftw_free(line);
        fftw_free(spectrum);
        return fail(messages, SELAS_NO_MEMORY, "no memory to filter a history of %zu rows", rows);
    }
    fftw_plan forward;
#pragma omp critical(selas_fftw_planner)
    forward = fftw_plan_dft_r2c_1d((int)length, line, spectrum, FFTW_ESTIMATE);
    fftw_plan backward;
#pragma omp critical(selas_fftw_planner)
    backward = fftw_plan_dft_c2r_1d((int)length, spectrum, line, FFTW_ESTIMATE);
    const double unit = two_pi / ((double)length * dt * cutoff);
    for (size_t c = 0; c < columns; c++) {
        for (size_t i = 0; i < length; i++)
            line[i] = continued(series, rows, columns, c, pad, from_rest, length, i);
        fftw_execute(forward);
        for (size_t k = 0; k <= length / 2; k++)
            spectrum[k] *= exp(-pow(unit * (double)k, 4.0)) / (double)length;
        fftw_execute(backward);
        for (size_t i = 0; i < rows; i++)
            series[i * columns + c] = line[i + pad];
    }
#pragma omp critical(selas_fftw_planner)
    fftw_destroy_plan(forward);
#pragma omp critical(selas_fftw_planner)
    fftw_destroy_plan(backward);
    fftw_free(line);
    fftw_free(spectrum);
    return SELAS_OK;
}
