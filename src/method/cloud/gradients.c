/* Gradients of the cloud method: antisymmetric pair weights that sum by parts and are exact for linear
 * fields, as near as may be to those of moving least squares (doc/theory/cloud-method.md, Eqs 1 to 6).
 *
 * For each axis c the pairs a_ij = -a_ji minimise sum (a_ij - a0_ij)^2 / w_ij under
 *     sum_j a_ij = -B_i / 2,   sum_j a_ij (x_j - x_i) = V_i e_c        (B_i = n_c A_i on faces, else 0);
 * a = a0 + w C^T l with (C w C^T) l = b - C a0, a sparse symmetric system, not negative and consistent, which
 * solver.c solves. */
#include "method/cloud/cloud.h"
#include "method/cloud/pairs.h"

#include "base/memory.h"
#include "points/least_squares.h"

#include <math.h>
#include <string.h>

static const double wanted = 1e-11; /* residual, root mean square, in volumes over spacings */

static void pairs_free(struct cloud_pairs *pairs)
{
    void *const arrays[] = {(void *)pairs->position, pairs->start,  pairs->index, pairs->back,
                            pairs->offset,           pairs->weight, pairs->value};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        array_free(arrays[k]);
}

static bool pairs_allocate(struct cloud_pairs *pairs, size_t entries)
{
    pairs->index = array_new(entries, sizeof *pairs->index);
    pairs->back = array_new(entries, sizeof *pairs->back);
    pairs->offset = array_new(pairs->d * entries, sizeof *pairs->offset);
    pairs->weight = array_new(entries, sizeof *pairs->weight);
    pairs->value = array_new(pairs->d * entries, sizeof *pairs->value);
    return pairs->index != NULL && pairs->back != NULL && pairs->offset != NULL && pairs->weight != NULL &&
           pairs->value != NULL;
}

static double offset_of(const struct tl_model *tl, size_t i, size_t j, double offset[3])
{
    double square = 0;
    for (size_t c = 0; c < 3; c++) {
        offset[c] = (tl->site_position[3 * j + c] - tl->site_position[3 * i + c]) / tl->cloud->spacing;
        square += offset[c] * offset[c];
    }
    return sqrt(square);
}

/* Pairs closer than the radius of the weights; their kernel values. */
static selas_status find_pairs(const struct tl_model *tl, const struct neighbours *near,
                               struct cloud_pairs *pairs, struct messages *messages)
{
    const double reach = tl_radius(tl) / tl->cloud->spacing;
    const double h = reach / tl->options.kernel->support;
    pairs->points = tl->cloud->points;
    pairs->d = (size_t)tl->cloud->dimension;
    pairs->start = array_new(pairs->points + 1, sizeof *pairs->start);
    double *position = array_new(3 * pairs->points, sizeof *position);
    pairs->position = position;
    if (pairs->start == NULL || position == NULL || !pairs_allocate(pairs, near->start[pairs->points]))
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu pairs", near->start[pairs->points]);
    for (size_t k = 0; k < 3 * pairs->points; k++)
        position[k] = tl->cloud->position[k] / tl->cloud->spacing;
    for (size_t c = 0; c < 3; c++) {
        pairs->low[c] = tl->model.scene->body.low[c] / tl->cloud->spacing;
        pairs->high[c] = tl->model.scene->body.high[c] / tl->cloud->spacing;
    }
    size_t entries = 0;
    for (size_t i = 0; i < pairs->points; i++) {
        for (size_t k = near->start[i]; k < near->start[i + 1]; k++) {
            double offset[3];
            const double r = offset_of(tl, i, near->index[k], offset);
            if (near->index[k] == i || r >= reach) continue;
            pairs->index[entries] = near->index[k];
            memcpy(pairs->offset + pairs->d * entries, offset, pairs->d * sizeof *offset);
            pairs->weight[entries++] = kernel_value(tl->options.kernel, tl->cloud->dimension, r, h);
        }
        pairs->start[i + 1] = entries;
    }
    for (size_t i = 0; i < pairs->points; i++)
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
            const size_t j = pairs->index[k];
            size_t low = pairs->start[j];
            size_t high = pairs->start[j + 1];
            while (high - low > 1) {
                const size_t middle = (low + high) / 2;
                if (pairs->index[middle] <= i)
                    low = middle;
                else
                    high = middle;
            }
            pairs->back[k] = (uint32_t)(low - pairs->start[j]);
        }
    return SELAS_OK;
}

/* V_i times the moving-least-squares gradient weights of point i: quadratic, linear where points are few. */
static bool least_squares(const struct tl_model *tl, struct cloud_pairs *pairs, size_t i, double *work)
{
    const size_t d = pairs->d;
    const size_t from = pairs->start[i];
    const size_t count = pairs->start[i + 1] - from + 1; /* the point itself last */
    double *offset = work;
    double *weight = offset + 3 * count;
    double *gradient = weight + count;
    memset(offset, 0, 3 * count * sizeof *offset);
    for (size_t k = 0; k + 1 < count; k++) {
        memcpy(offset + 3 * k, pairs->offset + d * (from + k), d * sizeof *offset);
        weight[k] = pairs->weight[from + k];
    }
    weight[count - 1] = kernel_value(tl->options.kernel, tl->cloud->dimension, 0,
                                     tl_radius(tl) / tl->cloud->spacing / tl->options.kernel->support);
    struct fit fit = {(int)d, 2, 1, count, offset, weight, gradient + 3 * count};
    bool done = fit_free(&fit, NULL, gradient);
    while (!done && fit.degree > 1) {
        fit.degree--;
        done = fit_free(&fit, NULL, gradient);
    }
    for (size_t k = 0; k + 1 < count && done; k++)
        for (size_t c = 0; c < d; c++)
            pairs->value[d * (from + k) + c] =
                tl->cloud->volume[i] * gradient[3 * k + c] / tl->cloud->spacing;
    return done;
}

/* value_ij := (value_ij - value_ji) / 2. */
static void antisymmetrise(struct cloud_pairs *pairs)
{
    const size_t d = pairs->d;
    for (size_t i = 0; i < pairs->points; i++)
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
            if (pairs->index[k] < i) continue;
            double *here = pairs->value + d * k;
            double *there = pairs->value + d * (pairs->start[pairs->index[k]] + pairs->back[k]);
            for (size_t c = 0; c < d; c++) {
                here[c] = 0.5 * (here[c] - there[c]);
                there[c] = -here[c];
            }
        }
}

/* What the constraints of each axis still lack. */
static void remainder_of(const struct tl_model *tl, const struct cloud_pairs *pairs, const double *boundary,
                         vec4 *rest)
{
    const size_t d = pairs->d;
    for (size_t i = 0; i < pairs->points; i++) {
        vec4 *r = rest + (d + 1) * i;
        for (size_t axis = 0; axis < d; axis++) {
            r[0][axis] = -0.5 * boundary[d * i + axis];
            r[axis + 1][axis] = tl->cloud->volume[i] / tl->cloud->spacing;
        }
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
            vec4 value = {0};
            for (size_t axis = 0; axis < d; axis++)
                value[axis] = pairs->value[d * k + axis];
            r[0] -= value;
            for (size_t c = 0; c < d; c++)
                r[c + 1] -= value * pairs->offset[d * k + c];
        }
    }
}

static selas_status pair_correction(const struct tl_model *tl, struct cloud_pairs *pairs,
                                    struct messages *messages)
{
    const size_t d = pairs->d;
    const size_t n = (d + 1) * pairs->points;
    const double size = pow(tl->cloud->spacing, (double)d - 1);
    double *boundary = array_new(d * pairs->points, sizeof *boundary);
    vec4 *rest = array_new(n, sizeof *rest);
    vec4 *multiplier = array_new(n, sizeof *multiplier);
    const struct cloud_solvers *solvers = taken_cloud_solvers();
    struct cloud_solver *solver = NULL;
    selas_status status = SELAS_OK;
    if (boundary == NULL || rest == NULL || multiplier == NULL)
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the gradients of %zu points", pairs->points);
    for (size_t e = 0; status == SELAS_OK && boundary != NULL && e < tl->cloud->elements; e++) {
        const struct face_element *element = &tl->cloud->element[e];
        const size_t i = neighbours_nearest(&tl->near, element->position);
        for (size_t c = 0; c < d; c++)
            boundary[d * i + c] += element->area * element->normal[c];
    }
    if (status == SELAS_OK) status = solvers->create(pairs, &solver, messages);
    if (status == SELAS_OK) {
        remainder_of(tl, pairs, boundary, rest);
        if (solvers->solve(solver, rest, wanted * size, multiplier) >= 0)
            solvers->correct(pairs, multiplier);
        else
            status =
                fail(messages, SELAS_BAD_SCENE,
                     "no gradients that sum by parts were found for these points: they are too uneven, or "
                     "method%%smoothing_length is too small");
    }
    solvers->free(&solver);
    array_free(boundary);
    array_free(rest);
    array_free(multiplier);
    return status;
}

static selas_status first_guess(const struct tl_model *tl, struct cloud_pairs *pairs,
                                struct messages *messages)
{
    size_t longest = 0;
    for (size_t i = 0; i < pairs->points; i++)
        longest = (size_t)fmax((double)longest, (double)(pairs->start[i + 1] - pairs->start[i] + 1));
    double *work = array_new((7 + FIT_TERMS) * longest, sizeof *work);
    if (work == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for gradients");
    bool done = true;
    size_t lonely = 0;
    for (size_t i = 0; i < pairs->points && done; i++) {
        done = least_squares(tl, pairs, i, work);
        lonely = i;
    }
    array_free(work);
    if (!done)
        return fail(
            messages, SELAS_BAD_SCENE,
            "point %zu at (%g, %g, %g) has too few neighbours for a gradient: the body is too thin for "
            "its spacing",
            lonely + 1, tl->cloud->position[3 * lonely], tl->cloud->position[3 * lonely + 1],
            tl->cloud->position[3 * lonely + 2]);
    antisymmetrise(pairs);
    return SELAS_OK;
}

selas_status cloud_gradients(struct tl_model *tl, const struct neighbours *near, struct messages *messages)
{
    struct cloud_pairs pairs = {0};
    selas_status status = find_pairs(tl, near, &pairs, messages);
    if (status == SELAS_OK) status = first_guess(tl, &pairs, messages);
    if (status == SELAS_OK) status = pair_correction(tl, &pairs, messages);
    const size_t d = pairs.d;
    bool room = true;
    for (size_t i = 0; i < pairs.points && status == SELAS_OK && room; i++) {
        struct tl_like like;
        for (size_t k = pairs.start[i]; k < pairs.start[i + 1] && room; k++) {
            double weight[3] = {0};
            for (size_t c = 0; c < d; c++)
                weight[c] = pairs.value[d * k + c] / tl->cloud->volume[i];
            room = tl_rows_add(&tl->gradient, i, pairs.index[k], weight);
        }
        tl_likes(tl, i, 0, &like);
        room = room && tl_rows_close(&tl->gradient, i, &like, NULL, 0);
    }
    if (status == SELAS_OK && !(room && tl_rows_end(&tl->gradient)))
        status = fail(messages, SELAS_NO_MEMORY, "no memory for %zu pairs", pairs.start[pairs.points]);
    pairs_free(&pairs);
    return status;
}
