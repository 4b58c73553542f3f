/* The loops of the layers' shared passes (pml_fast.h) for each kind of processor, in double and single
 * precision: pml_kernels_double.c and pml_kernels_single.c. */
#ifndef SELAS_METHOD_CONSISTENT_ABSORBING_PML_KERNELS_H
#define SELAS_METHOD_CONSISTENT_ABSORBING_PML_KERNELS_H

#include "base/processor.h"
#include "method/consistent/absorbing/pml_fast.h"

/* Numbers that are wanted soon, at these steps from row to row and along rows: fetched into the cache while a product
 * is made, those in the place of what is made. */
struct ahead {
    const void *place;
    size_t step_row, step;
};

/* What the functions do is said in pml_loops.h; set, add, change and along by the number of rows;
 * ahead: NULL if nothing is. */
#define PML_KERNELS(real, precision)                                                                         \
    struct pml_kernels_##precision {                                                                         \
        void (*set[FAST_ROWS + 1])(const real *weight, size_t inputs, const real *in, size_t in_step,        \
                                   size_t width, real *out, size_t out_step, const struct ahead *ahead);     \
        void (*add[FAST_ROWS + 1])(const real *weight, size_t inputs, const real *in, size_t in_step,        \
                                   size_t width, real *out, size_t out_step, const struct ahead *ahead);     \
        void (*change[FAST_ROWS + 1])(const real *weight, size_t inputs, const real *in, size_t in_step,     \
                                      size_t width, real *out, size_t out_step, const struct ahead *ahead);  \
        void (*along[FAST_ROWS + 1])(const real *matrix, size_t taps, const real *in, size_t in_step,        \
                                     size_t width, real *out);                                               \
        void (*load)(const real *u, const real *v, real factor, size_t rows, size_t step_row, size_t n,      \
                     size_t step, size_t width, real *out);                                                  \
        void (*store)(const real *in, real factor, size_t rows, size_t step_row, size_t n, size_t step,      \
                      size_t width, real *a);                                                                \
        void (*sum)(size_t n, const real *in, real *out);                                                    \
        void (*move)(size_t n, real q, real kept, const real *g, real *memory, real *middle);                \
        bool (*loud)(size_t rows, size_t step, size_t n, real level, const real *x);                         \
    };                                                                                                       \
    EACH_PROCESSOR(struct pml_kernels_##precision, pml_kernels_##precision)
PML_KERNELS(double, double)
PML_KERNELS(float, single)
#undef PML_KERNELS

#endif
