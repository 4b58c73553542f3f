/* What a plan has: tensor.c makes it, tensor_apply.c applies it. */
#ifndef SELAS_METHOD_SPLINE_TENSOR_PLAN_H
#define SELAS_METHOD_SPLINE_TENSOR_PLAN_H

#include "method/spline/passes.h"
#include "method/spline/tensor.h"

/* Doubles a cache line; entries in the rows of a matrix that make PASS_ROWS numbers. A strip is whole groups of
 * PASS_ROWS rows. */
enum { TENSOR_ALIGN = 8, TENSOR_MOST_INPUTS = 2 * TENSOR_MOST_HALF + PASS_ROWS };

/* A product over depth. Its rows are kept as long as passes across read them: strips in a ring. */
struct z_item {
    int in;
    const struct band *matrix;
    size_t reach;    /* rows that passes across read on each side */
    size_t strips;   /* in the ring */
    size_t at, size; /* in a thread's buffer: the first plane; numbers in a plane */
};
struct y_item {
    size_t source, target; /* z item, x item */
    const struct band *matrix;
    double factor;
    double *weight; /* by groups of rows: [inputs][rows], with the factor */
};
struct x_item {
    int out;
    const struct band *matrix;
};

struct tensor_plan {
    size_t n[3], plane, volume; /* values in a plane, in a component */
    int components, inputs, threads;
    size_t z_items, y_items, x_items;
    struct z_item *z;
    struct y_item *y; /* in the order of their targets */
    struct x_item *x;
    size_t ahead;          /* strips that products over depth are ahead of passes across */
    size_t reach[3];       /* by slot */
    size_t pad, row;       /* zeros left and right of each row of the x passes; length of a padded row */
    size_t row_at, out_at; /* in a thread's buffer: padded rows; output planes of tensor_form */
    size_t weight_at;      /* weights over depth */
    size_t inputs_z;       /* planes that a product over depth reads, at most */
    size_t thread_size;
    double **buffer;    /* [threads] */
    double *plane_sums; /* [n[2]] */
};

/* Columns that some rows of a matrix have. */
struct columns {
    size_t first, count;
};

static inline struct columns columns_of(const struct band *matrix, size_t row, size_t rows)
{
    const size_t half = matrix->half, first = row < half ? 0 : row - half, end = row + rows + half;
    return (struct columns){first, (end < matrix->n ? end : matrix->n) - first};
}

/* The rows by columns: [columns][rows], times a factor. */
static inline void take_rows(const struct band *matrix, size_t row, size_t rows, double factor,
                             double *weight)
{
    const struct columns columns = columns_of(matrix, row, rows);
    for (size_t d = 0; d < columns.count; d++)
        for (size_t r = 0; r < rows; r++)
            weight[d * rows + r] = factor * band_get(matrix, row + r, columns.first + d);
}

/* Numbers that the weights of a group of rows across take. */
static inline size_t group_size(const struct band *matrix)
{
    return (2 * matrix->half + PASS_ROWS) * PASS_ROWS;
}

#endif
