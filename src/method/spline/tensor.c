/* Sums of Kronecker products applied plane by plane (doc/theory/consistent-method.md, section 3). */
#include "method/spline/tensor_plan.h"

#include "base/memory.h"

#include <string.h>

static size_t rounded(size_t n)
{
    return (n + TENSOR_ALIGN - 1) / TENSOR_ALIGN * TENSOR_ALIGN;
}

static size_t find_z(struct tensor_plan *plan, const struct tensor_term *term)
{
    for (size_t i = 0; i < plan->z_items; i++)
        if (plan->z[i].in == term->in && plan->z[i].matrix == term->matrix[2]) return i;
    if (term->in >= plan->inputs) plan->inputs = term->in + 1;
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
    const struct y_item item = {find_z(plan, term), find_x(plan, term), term->matrix[1], term->factor, NULL};
    struct z_item *source = &plan->z[item.source];
    if (item.matrix != NULL && item.matrix->half > source->reach) source->reach = item.matrix->half;
    for (int slot = 0; slot < 3; slot++)
        if (term->matrix[slot] != NULL && term->matrix[slot]->half > plan->reach[slot])
            plan->reach[slot] = term->matrix[slot]->half;
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

/* Weights across, by groups of rows. */
static bool lay_weights(struct tensor_plan *plan)
{
    for (size_t i = 0; i < plan->y_items; i++) {
        struct y_item *item = &plan->y[i];
        if (item->matrix == NULL) continue;
        const size_t n = plan->n[1], size = group_size(item->matrix);
        item->weight = array_new((n + PASS_ROWS - 1) / PASS_ROWS * size, sizeof *item->weight);
        if (item->weight == NULL) return false;
        for (size_t j = 0; j < n; j += PASS_ROWS)
            take_rows(item->matrix, j, n - j < PASS_ROWS ? n - j : PASS_ROWS, item->factor,
                      item->weight + j / PASS_ROWS * size);
    }
    return true;
}

/* Rings of strips, each as long as what is made ahead and what is read behind. */
static size_t lay_rings(struct tensor_plan *plan)
{
    const size_t strips = (plan->n[1] + TENSOR_STRIP - 1) / TENSOR_STRIP;
    size_t at = 0;
    plan->ahead = (plan->reach[1] + TENSOR_STRIP - 1) / TENSOR_STRIP;
    for (size_t i = 0; i < plan->z_items; i++) {
        struct z_item *item = &plan->z[i];
        item->strips = (item->reach + TENSOR_STRIP - 1) / TENSOR_STRIP + 1 + plan->ahead;
        item->strips = item->strips < strips ? item->strips : strips;
        item->at = at;
        item->size = rounded(item->strips * TENSOR_STRIP * plan->n[0]);
        at += PASS_ROWS * item->size;
    }
    return at;
}

static bool lay_buffers(struct tensor_plan *plan)
{
    plan->pad = rounded(plan->reach[0]);
    plan->inputs_z = 2 * plan->reach[2] + PASS_ROWS;
    plan->row = rounded(plan->n[0]) + 2 * plan->pad;
    plan->row_at = lay_rings(plan);
    plan->out_at = plan->row_at + PASS_ROWS * plan->row;
    plan->weight_at = plan->out_at + (size_t)plan->components * rounded(plan->plane);
    plan->thread_size = plan->weight_at + plan->z_items * plan->inputs_z * PASS_ROWS;
    plan->buffer = array_new((size_t)plan->threads, sizeof *plan->buffer);
    plan->plane_sums = array_new(plan->n[2], sizeof *plan->plane_sums);
    if (plan->buffer == NULL || plan->plane_sums == NULL) return false;
    for (int t = 0; t < plan->threads; t++) {
        plan->buffer[t] = array_new(plan->thread_size, sizeof **plan->buffer);
        if (plan->buffer[t] == NULL) return false;
    }
    return lay_weights(plan);
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
    for (size_t i = 0; plan->y != NULL && i < plan->y_items; i++)
        array_free(plan->y[i].weight);
    array_free(plan->z);
    array_free(plan->y);
    array_free(plan->x);
    array_free(plan);
}

size_t tensor_plan_bytes(const struct tensor_plan *plan)
{
    return (size_t)plan->threads * plan->thread_size * sizeof(double);
}

size_t tensor_reach(const struct tensor_plan *plan, int slot)
{
    return plan->reach[slot];
}
