/* Sums of Kronecker products applied plane by plane (doc/theory/consistent-method.md, section 3). */
#include "method/spline/tensor.h"

#include "base/memory.h"
#include "method/spline/passes.h"

#include <omp.h>
#include <string.h>

/* Doubles a cache line; numbers of a plane that products over depth take together. */
enum { ALIGN = 8, PIECE = 128, MAX_TAPS = 2 * TENSOR_MOST_HALF + 1 };

struct z_item {
    int in;
    const struct band *matrix;
};
struct y_item {
    size_t source, target; /* z item, x item */
    const struct band *matrix;
    double factor;
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
    size_t pad, row; /* zeros left and right of each row of the x passes; length of a padded row */
    size_t thread_size;
    size_t taps; /* entries in a row of a z matrix, at most */
    double *
        *buffer; /* [threads]: z planes, padded x row, output planes of tensor_form, rows of the z matrices */
    double *plane_sums; /* [n[2]] */
};

static size_t rounded(size_t n)
{
    return (n + ALIGN - 1) / ALIGN * ALIGN;
}

static size_t find_z(struct tensor_plan *plan, const struct tensor_term *term)
{
    for (size_t i = 0; i < plan->z_items; i++)
        if (plan->z[i].in == term->in && plan->z[i].matrix == term->matrix[2]) return i;
    if (term->in >= plan->inputs) plan->inputs = term->in + 1;
    if (term->matrix[2] != NULL && 2 * term->matrix[2]->half + 1 > plan->taps)
        plan->taps = 2 * term->matrix[2]->half + 1;
    plan->z[plan->z_items] = (struct z_item){.in = term->in, .matrix = term->matrix[2]};
    return plan->z_items++;
}

static size_t find_x(struct tensor_plan *plan, const struct tensor_term *term)
{
    for (size_t i = 0; i < plan->x_items; i++)
        if (plan->x[i].out == term->out && plan->x[i].matrix == term->matrix[0]) return i;
    plan->x[plan->x_items] = (struct x_item){.out = term->out, .matrix = term->matrix[0]};
    return plan->x_items++;
}

/* One y item for each different (source, y matrix, target); equal ones add their factors. */
static void add_term(struct tensor_plan *plan, const struct tensor_term *term)
{
    const struct y_item item = {find_z(plan, term), find_x(plan, term), term->matrix[1], term->factor};
    if (term->matrix[0] != NULL && term->matrix[0]->half > plan->pad) plan->pad = term->matrix[0]->half;
    for (size_t i = 0; i < plan->y_items; i++)
        if (plan->y[i].source == item.source && plan->y[i].target == item.target &&
            plan->y[i].matrix == item.matrix) {
            plan->y[i].factor += item.factor;
            return;
        }
    plan->y[plan->y_items++] = item;
}

static void sort_by_target(struct tensor_plan *plan)
{
    for (size_t i = 1; i < plan->y_items; i++) {
        const struct y_item item = plan->y[i];
        size_t j = i;
        for (; j > 0 && plan->y[j - 1].target > item.target; j--)
            plan->y[j] = plan->y[j - 1];
        plan->y[j] = item;
    }
}

static bool lay_buffers(struct tensor_plan *plan)
{
    plan->pad = rounded(plan->pad);
    plan->row = rounded(plan->n[0]) + 2 * plan->pad;
    plan->thread_size = plan->z_items * (rounded(plan->plane) + plan->taps) + plan->row +
                        (size_t)plan->components * rounded(plan->plane);
    plan->buffer = array_new((size_t)plan->threads, sizeof *plan->buffer);
    plan->plane_sums = array_new(plan->n[2], sizeof *plan->plane_sums);
    if (plan->buffer == NULL || plan->plane_sums == NULL) return false;
    for (int t = 0; t < plan->threads; t++) {
        plan->buffer[t] = array_new(plan->thread_size, sizeof **plan->buffer);
        if (plan->buffer[t] == NULL) return false;
    }
    return true;
}

struct tensor_plan *tensor_plan_new(const size_t n[3], int components, const struct tensor_term *terms,
                                    size_t count, int threads)
{
    struct tensor_plan *plan = array_new(1, sizeof *plan);
    if (plan == NULL) return NULL;
    memcpy(plan->n, n, sizeof plan->n);
    plan->plane = n[0] * n[1];
    plan->volume = plan->plane * n[2];
    plan->components = components;
    plan->threads = threads;
    plan->z = array_new(count, sizeof *plan->z);
    plan->y = array_new(count, sizeof *plan->y);
    plan->x = array_new(count, sizeof *plan->x);
    if (plan->z != NULL && plan->y != NULL && plan->x != NULL) {
        bool narrow = true;
        for (size_t i = 0; i < count; i++) {
            add_term(plan, &terms[i]);
            for (int slot = 0; slot < 3; slot++)
                narrow = narrow &&
                         (terms[i].matrix[slot] == NULL || terms[i].matrix[slot]->half <= TENSOR_MOST_HALF);
        }
        sort_by_target(plan);
        if (narrow && lay_buffers(plan)) return plan;
    }
    tensor_plan_free(plan);
    return NULL;
}

void tensor_plan_free(struct tensor_plan *plan)
{
    if (plan == NULL) return;
    for (int t = 0; plan->buffer != NULL && t < plan->threads; t++)
        array_free(plan->buffer[t]);
    array_free(plan->buffer);
    array_free(plan->plane_sums);
    array_free(plan->z);
    array_free(plan->y);
    array_free(plan->x);
    array_free(plan);
}

size_t tensor_plan_bytes(const struct tensor_plan *plan)
{
    return (size_t)plan->threads * plan->thread_size * sizeof(double);
}

/* Columns of a row that a matrix has. */
struct columns {
    size_t first, count;
};

static struct columns columns_of(const struct band *matrix, size_t row)
{
    const size_t half = matrix->half, first = row < half ? 0 : row - half;
    const size_t end = row + half < matrix->n ? row + half + 1 : matrix->n;
    return (struct columns){first, end - first};
}

/* Times a factor. */
static void take_row(const struct band *matrix, size_t row, double factor, double *weight)
{
    const struct columns columns = columns_of(matrix, row);
    for (size_t d = 0; d < columns.count; d++)
        weight[d] = factor * matrix->value[(columns.first + d + matrix->half - row) * matrix->n + row];
}

/* out[i] += factor * sum over columns j of row `at` of A times in[j * n + i], i < n. */
static void pass_across(const struct passes *passes, const struct band *matrix, size_t at, double factor,
                        const double *in, size_t n, double *out)
{
    const struct columns columns = columns_of(matrix, at);
    double weight[MAX_TAPS];
    take_row(matrix, at, factor, weight);
    passes->over_rows(weight, columns.count, in + columns.first * n, n, n, out, out);
}

/* The products over depth in plane k, piece by piece of the plane: all those of an input while its planes are in the
 * nearest cache. */
static void pass_down(const struct tensor_plan *plan, const struct passes *passes, int thread, size_t k,
                      const double *u)
{
    const size_t plane = plan->plane, step = rounded(plane);
    double *weight = plan->buffer[thread] + plan->thread_size - plan->z_items * plan->taps;
    for (size_t i = 0; i < plan->z_items; i++)
        if (plan->z[i].matrix != NULL) take_row(plan->z[i].matrix, k, 1, weight + i * plan->taps);
    for (size_t at = 0; at < plane; at += PIECE)
        for (int input = 0; input < plan->inputs; input++)
            for (size_t i = 0; i < plan->z_items; i++) {
                if (plan->z[i].in != input) continue;
                const size_t n = plane - at < PIECE ? plane - at : PIECE;
                const struct band *matrix = plan->z[i].matrix;
                const struct columns columns =
                    matrix == NULL ? (struct columns){k, 1} : columns_of(matrix, k);
                const double *in = u + (size_t)input * plan->volume + columns.first * plane + at;
                double *out = plan->buffer[thread] + i * step + at;
                if (matrix == NULL)
                    memcpy(out, in, n * sizeof *in);
                else
                    passes->over_rows(weight + i * plan->taps, columns.count, in, plane, n, NULL, out);
            }
}

static void add_row(double factor, const double *restrict in, size_t n, double *restrict out)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        out[i] += factor * in[i];
}

void tensor_plane(const struct tensor_plan *plan, int thread, size_t k, double factor, const double *u,
                  double *const *out)
{
    tensor_rows(plan, thread, k, 0, plan->n[1], factor, u, out);
}

void tensor_rows(const struct tensor_plan *plan, int thread, size_t k, size_t from, size_t end, double factor,
                 const double *u, double *const *out)
{
    const struct passes *passes = taken_passes();
    const size_t nx = plan->n[0], plane = plan->plane, step = rounded(plane);
    double *buffer = plan->buffer[thread];
    double *row = buffer + plan->z_items * step + plan->pad;
    pass_down(plan, passes, thread, k, u);
    for (size_t x = 0, y = 0; x < plan->x_items; x++) {
        const struct x_item *target = &plan->x[x];
        size_t y_end = y;
        while (y_end < plan->y_items && plan->y[y_end].target == x)
            y_end++;
        for (size_t j = from; j < end; j++) {
            double *result = out[target->out] + j * nx;
            const bool along = target->matrix != NULL;
            double *sum = along ? row : result;
            const double scale = along ? 1 : factor;
            if (along) memset(row, 0, nx * sizeof *row);
            for (size_t i = y; i < y_end; i++) {
                const double *in = buffer + plan->y[i].source * step;
                if (plan->y[i].matrix != NULL)
                    pass_across(passes, plan->y[i].matrix, j, scale * plan->y[i].factor, in, nx, sum);
                else
                    add_row(scale * plan->y[i].factor, in + j * nx, nx, sum);
            }
            if (along)
                passes->over_neighbours(target->matrix->value, 2 * target->matrix->half + 1, factor,
                                        row - target->matrix->half, nx, result);
        }
        y = y_end;
    }
}

double tensor_form(struct tensor_plan *plan, const double *w, const double *u)
{
    return tensor_form_planes(plan, 0, plan->n[2], w, u);
}

double tensor_form_planes(struct tensor_plan *plan, size_t from, size_t end, const double *w, const double *u)
{
    const size_t plane = plan->plane, step = rounded(plane);
    const int components = plan->components;
#pragma omp parallel for num_threads(plan->threads) schedule(static)
    for (size_t k = from; k < end; k++) {
        const int thread = omp_get_thread_num();
        double *out[3] = {NULL, NULL, NULL}, sum = 0;
        for (int c = 0; c < components; c++) {
            out[c] = plan->buffer[thread] + plan->z_items * step + plan->row + (size_t)c * step;
            memset(out[c], 0, plane * sizeof **out);
        }
        tensor_plane(plan, thread, k, 1, u, out);
        for (int c = 0; c < components; c++)
            for (size_t i = 0; i < plane; i++)
                sum += out[c][i] * w[(size_t)c * plan->volume + k * plane + i];
        plan->plane_sums[k] = sum;
    }
    double total = 0;
    for (size_t k = from; k < end; k++)
        total += plan->plane_sums[k];
    return total;
}
