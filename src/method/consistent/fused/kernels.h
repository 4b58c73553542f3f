/* The kernels of the fused operator (fused.h, F1) for each kind of processor, in double and single precision:
 * kernels_double.c and kernels_single.c. */
#ifndef SELAS_METHOD_CONSISTENT_FUSED_KERNELS_H
#define SELAS_METHOD_CONSISTENT_FUSED_KERNELS_H

#include "base/processor.h"
#include "method/consistent/fused/fused.h"

/* Degree 2: 5 taps for S and G, 2 * 2 * sweeps + 1 for N, four more for products over depth. `ends`: rows
 * whose weights differ. What the functions do is said in passes_over.h. */
#define FUSED_KERNELS(real, precision)                                                                       \
    typedef void fused_depth_##precision(const real *const *in, const real *const *weight, size_t n,         \
                                         size_t ahead, real *const *result);                                 \
    typedef void fused_mixed_##precision(const real *const *in, const real *const *other,                    \
                                         const real *const *weight, const real *share, size_t n,             \
                                         size_t ahead, real *const *result);                                 \
    typedef void fused_x_##precision(const real *matrix, const real *in, const real *init, size_t width,     \
                                     size_t stride, real *out);                                              \
    typedef void fused_y_##precision(const real *weight, const real *const *in, const real *init,            \
                                     size_t width, size_t stride, real *out);                                \
    struct fused_kernels_##precision {                                                                       \
        struct {                                                                                             \
            int taps;                                                                                        \
            fused_x_##precision *x;                                                                          \
            fused_y_##precision *y, *y_ends;                                                                 \
            fused_depth_##precision *depth[3][2]; /* [B: identity, matrix, three][A is 0] */                 \
            fused_mixed_##precision *mixed[2][2]; /* [B is a matrix of its own][of u_z] */                   \
        } of[3];                      /* one, two and three sweeps; the first is that of G too */            \
        fused_x_##precision *x_stiff; /* S */                                                                \
        fused_y_##precision *y_stiff, *y_stiff_ends;                                                         \
        real (*measure)(size_t n, size_t rows, size_t step, const real *u, real *column);                    \
        real (*drift)(size_t n, size_t rows, size_t step, real dt, const real *w, real *u, real *column);    \
        void (*relax)(size_t n, const struct fused_relax *relax, const real *w, real *const *field,          \
                      real *const *change);                                                                  \
        void (*kick)(size_t n, real dt, const real *a, real *w);                                             \
        void (*gather)(size_t n, size_t count, const real *weight, const real *const *row, real *out);       \
        void (*weigh)(size_t n, size_t taps, const double *weight, const real *in, real *out);               \
        void (*spread)(size_t rows, size_t step, const real *weight, const real *value, real *sum);          \
        void (*keep)(size_t n, const double *weight, size_t step, real *row);                                \
    };                                                                                                       \
    EACH_PROCESSOR(struct fused_kernels_##precision, fused_kernels_##precision)
FUSED_KERNELS(double, double)
FUSED_KERNELS(float, single)
#undef FUSED_KERNELS

#endif
