/* The loops of sweep.h over the memory of absorbing layers, which is in double precision, for numbers of type REAL;
 * included by sweep_over.h. */
enum { CACHE_LINE = 8 }; /* doubles */

static void recall(size_t n, const double *restrict psi, REAL *restrict slope)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        slope[i] += (REAL)psi[i];
}

INLINED void remembered(const size_t step, size_t n, const double *restrict kept,
                        const double *restrict taken, REAL half, const REAL *restrict rate,
                        double *restrict psi, REAL *restrict slope)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        const double value = kept[step * i] * psi[i] - taken[step * i] * (double)(slope[i] - half * rate[i]);
        psi[i] = value;
        slope[i] += (REAL)value;
    }
}

static void remember(size_t n, bool along, const double *kept, const double *taken, REAL half,
                     const REAL *rate, double *psi, REAL *slope)
{
    for (size_t i = 0; i < n; i += CACHE_LINE) /* the next row's */
        FETCH(psi + n + i);
    if (along)
        remembered(1, n, kept, taken, half, rate, psi, slope);
    else
        remembered(0, n, kept, taken, half, rate, psi, slope);
}

static void pull(size_t n, const double *restrict phi, const REAL *restrict root, REAL *restrict out)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        out[i] += root[i] * (REAL)phi[i];
}

static void keep(size_t n, REAL a, const REAL *restrict one, REAL b, const REAL *restrict other,
                 REAL *restrict out)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        out[i] -= a * one[i] + b * other[i];
}
