#include "compare/misfit.h"

#include <math.h>

struct misfit misfit_of(size_t rows, const double *time, const double *value, const double *reference,
                        size_t stride, size_t components)
{
    struct misfit misfit = {0};
    double last_difference = 0.0, last_reference = 0.0;
    for (size_t i = 0; i < rows; i++) {
        double difference = 0.0, size = 0.0;
        for (size_t c = 0; c < components; c++) {
            const double r = reference[i * stride + c];
            const double d = value[i * stride + c] - r;
            difference += d * d;
            size += r * r;
        }
        if (i > 0) { /* trapezoid */
            const double half = 0.5 * (time[i] - time[i - 1]);
            misfit.l2 += half * (last_difference + difference);
            misfit.l2_of += half * (last_reference + size);
        }
        misfit.linf = fmax(misfit.linf, difference);
        misfit.linf_of = fmax(misfit.linf_of, size);
        last_difference = difference;
        last_reference = size;
    }
    misfit.l2 = sqrt(misfit.l2);
    misfit.l2_of = sqrt(misfit.l2_of);
    misfit.linf = sqrt(misfit.linf);
    misfit.linf_of = sqrt(misfit.linf_of);
    return misfit;
}

void misfits_of(size_t rows, const double *time, const double *value, const double *reference,
                struct misfit misfit[3], struct misfit *largest)
{
    *largest = (struct misfit){0};
    for (size_t c = 0; c < 3; c++) {
        misfit[c] = misfit_of(rows, time, value + c, reference + c, 6, 1);
        largest->l2_of = fmax(largest->l2_of, misfit[c].l2_of);
        largest->linf_of = fmax(largest->linf_of, misfit[c].linf_of);
    }
}

bool misfit_is_small(const struct misfit *misfit, const struct misfit *largest)
{
    return misfit->l2_of <= 1e-3 * largest->l2_of;
}
