/* A plan applied to a block of planes (tensor.h). Strips of rows go through all passes one after the other; products
 * over depth are ahead by the rows that passes across read. */
#include "method/spline/tensor_plan.h"

#include <omp.h>
#include <string.h>

/* Numbers of a strip that products over depth take together, so that what they read stays in the nearest cache. */
enum { PIECE = 128 };

/* A block of planes at work. */
struct work {
    const struct tensor_plan *plan;
    const struct passes *passes;
    size_t k, planes;
    double factor;
    const double *u;
    double *buffer;
    double *const *out;
};

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* Row j of plane p of a product over depth. */
static double *row_of(const struct work *w, const struct z_item *item, size_t p, size_t j)
{
    const size_t slot = j / TENSOR_STRIP % item->strips * TENSOR_STRIP + j % TENSOR_STRIP;
    return w->buffer + item->at + p * item->size + slot * w->plan->n[0];
}

static double *weight_of(const struct work *w, size_t z)
{
    return w->buffer + w->plan->weight_at + z * w->plan->inputs_z * PASS_ROWS;
}

/* Part of a product over depth: n numbers from `at` on in the rows from j on. */
static void piece_down(const struct work *w, size_t z, size_t j, size_t at, size_t n)
{
    const struct tensor_plan *plan = w->plan;
    const struct z_item *item = &plan->z[z];
    const double *in[TENSOR_MOST_INPUTS],
        *field = w->u + (size_t)item->in * plan->volume + j * plan->n[0] + at;
    double *out[PASS_ROWS];
    for (size_t p = 0; p < w->planes; p++)
        out[p] = row_of(w, item, p, j) + at;
    if (item->matrix == NULL) {
        for (size_t p = 0; p < w->planes; p++)
            memcpy(out[p], field + (w->k + p) * plan->plane, n * sizeof *field);
        return;
    }
    const struct columns columns = columns_of(item->matrix, w->k, w->planes);
    for (size_t t = 0; t < columns.count; t++)
        in[t] = field + (columns.first + t) * plan->plane;
    w->passes->rows[w->planes](weight_of(w, z), columns.count, in, n, false, out);
}

/* The products over depth in a strip, piece by piece: all those of an input while its planes are in the nearest
 * cache. */
static void strip_down(const struct work *w, size_t strip)
{
    const struct tensor_plan *plan = w->plan;
    const size_t j = strip * TENSOR_STRIP, n = smaller(TENSOR_STRIP, plan->n[1] - j) * plan->n[0];
    for (size_t at = 0; at < n; at += PIECE)
        for (int input = 0; input < plan->inputs; input++)
            for (size_t z = 0; z < plan->z_items; z++)
                if (plan->z[z].in == input) piece_down(w, z, j, at, smaller(PIECE, n - at));
}

/* What an item across makes in a group of rows of plane p. */
static void group_across(const struct work *w, const struct y_item *item, size_t p, size_t j, size_t rows,
                         double factor, bool add, double *const *sum)
{
    const size_t nx = w->plan->n[0];
    const struct z_item *source = &w->plan->z[item->source];
    if (item->matrix == NULL) {
        const double weight = factor * item->factor;
        for (size_t r = 0; r < rows; r++) {
            const double *in = row_of(w, source, p, j + r);
            w->passes->rows[1](&weight, 1, &in, nx, add, &sum[r]);
        }
        return;
    }
    const struct columns columns = columns_of(item->matrix, j, rows);
    const double *in[TENSOR_MOST_INPUTS];
    const double *weight = item->weight + j / PASS_ROWS * group_size(item->matrix);
    double own[TENSOR_MOST_INPUTS * PASS_ROWS];
    for (size_t t = 0; t < columns.count; t++)
        in[t] = row_of(w, source, p, columns.first + t);
    if (factor != 1) {
        for (size_t t = 0; t < columns.count * rows; t++)
            own[t] = factor * weight[t];
        weight = own;
    }
    w->passes->rows[rows](weight, columns.count, in, nx, add, sum);
}

/* A target, with the items first .. end - 1 across, in a group of rows of plane p. */
static void group_along(const struct work *w, const struct x_item *target, size_t first, size_t end, size_t p,
                        size_t j, size_t rows)
{
    const struct tensor_plan *plan = w->plan;
    const bool along = target->matrix != NULL;
    const size_t nx = plan->n[0];
    double *result = w->out[target->out] + p * plan->plane + j * nx;
    double *padded = w->buffer + plan->row_at + plan->pad, *sum[PASS_ROWS];
    for (size_t r = 0; r < rows; r++)
        sum[r] = along ? padded + r * plan->row : result + r * nx;
    for (size_t i = first; i < end; i++)
        group_across(w, &plan->y[i], p, j, rows, along ? 1 : w->factor, !along || i > first, sum);
    if (along)
        w->passes->neighbours[rows](target->matrix->value, 2 * target->matrix->half + 1, w->factor,
                                    padded - target->matrix->half, plan->row, nx, result, nx);
}

/* Passes across and along in a strip. */
static void strip_across(const struct work *w, size_t strip)
{
    const struct tensor_plan *plan = w->plan;
    const size_t from = strip * TENSOR_STRIP, end = smaller(from + TENSOR_STRIP, plan->n[1]);
    for (size_t x = 0, y = 0; x < plan->x_items; x++) {
        size_t y_end = y;
        while (y_end < plan->y_items && plan->y[y_end].target == x)
            y_end++;
        for (size_t p = 0; p < w->planes; p++)
            for (size_t j = from; j < end; j += PASS_ROWS)
                group_along(w, &plan->x[x], y, y_end, p, j, smaller(PASS_ROWS, end - j));
        y = y_end;
    }
}

void tensor_planes(const struct tensor_plan *plan, int thread, size_t k, size_t planes, size_t from,
                   size_t end, double factor, const double *u, double *const *out)
{
    const struct work work = {plan, taken_passes(), k, planes, factor, u, plan->buffer[thread], out};
    const size_t strips = (plan->n[1] + TENSOR_STRIP - 1) / TENSOR_STRIP, first = from / TENSOR_STRIP;
    for (size_t z = 0; z < plan->z_items; z++)
        if (plan->z[z].matrix != NULL) take_rows(plan->z[z].matrix, k, planes, 1, weight_of(&work, z));
    size_t down = first < plan->ahead ? 0 : first - plan->ahead;
    for (size_t strip = first; strip * TENSOR_STRIP < end; strip++) {
        for (; down < strips && down <= strip + plan->ahead; down++)
            strip_down(&work, down);
        strip_across(&work, strip);
    }
}

void tensor_plane(const struct tensor_plan *plan, int thread, size_t k, double factor, const double *u,
                  double *const *out)
{
    tensor_planes(plan, thread, k, 1, 0, plan->n[1], factor, u, out);
}

double tensor_form(struct tensor_plan *plan, const double *w, const double *u)
{
    return tensor_form_part(plan, (const size_t[]){0, plan->n[1]}, (const size_t[]){0, plan->n[2]}, w, u);
}

double tensor_form_part(struct tensor_plan *plan, const size_t rows[2], const size_t planes[2],
                        const double *w, const double *u)
{
    const size_t from = planes[0], end = planes[1];
    const size_t plane = plan->plane, step = (plane + TENSOR_ALIGN - 1) / TENSOR_ALIGN * TENSOR_ALIGN;
    const int components = plan->components;
#pragma omp parallel for num_threads(plan->threads) schedule(static)
    for (size_t k = from; k < end; k++) {
        const int thread = omp_get_thread_num();
        double *out[3] = {NULL, NULL, NULL}, sum = 0;
        for (int c = 0; c < components; c++) {
            out[c] = plan->buffer[thread] + plan->out_at + (size_t)c * step;
            memset(out[c], 0, plane * sizeof **out);
        }
        tensor_plane(plan, thread, k, 1, u, out);
        for (int c = 0; c < components; c++)
            for (size_t i = rows[0] * plan->n[0]; i < rows[1] * plan->n[0]; i++)
                sum += out[c][i] * w[(size_t)c * plan->volume + k * plane + i];
        plan->plane_sums[k] = sum;
    }
    double total = 0;
    for (size_t k = from; k < end; k++)
        total += plan->plane_sums[k];
    return total;
}
