/* The state that others see of one that is kept half a step ahead, for numbers of type REAL; included by the
 * steps in one pass. */
#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* Displacements, velocities half a step ahead, accelerations, n numbers each. */
struct NAME(settled) {
    size_t n;
    int threads;
    const REAL *u, *w, *acceleration;
};

/* y[i] = value[i], i < count, unless it is that already: what was never written to takes no memory. */
static void put(size_t count, const double *value, double *y)
{
    if (memcmp(y, value, count * sizeof *y) != 0) memcpy(y, value, count * sizeof *y);
}

/* u and v = w - dt/2 a in y; a if it is not NULL. */
static void NAME(settle)(const struct NAME(settled) * of, double dt, double *y, double *a)
{
    enum { PAGE = 512 };
    const bool apart = (const void *)of->u != (const void *)y;
#pragma omp parallel for num_threads(of->threads) schedule(static)
    for (size_t from = 0; from < of->n; from += PAGE) {
        const size_t count = of->n - from < PAGE ? of->n - from : PAGE;
        double value[PAGE] = {0};
        for (size_t i = 0; i < count; i++)
            value[i] = of->w[from + i] - dt / 2 * of->acceleration[from + i];
        put(count, value, y + of->n + from);
        for (size_t i = 0; i < count && apart; i++)
            value[i] = of->u[from + i];
        if (apart) put(count, value, y + from);
        for (size_t i = 0; i < count && a != NULL; i++)
            value[i] = of->acceleration[from + i];
        if (a != NULL) put(count, value, a + from);
    }
}
