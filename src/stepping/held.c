/* Loads that a host holds at a value (see the header). */
#include "stepping/held.h"

#include "base/memory.h"
#include "parallel/ranks.h"

#include <math.h>
#include <string.h>

static const double nothing = 1e-18; /* of the largest acceleration by a load */

/* Numbers of the held loads; none if something else is the host's. */
static selas_status list(struct held *held, const struct scene *scene, struct messages *messages)
{
    held->load = array_new(scene->loads, sizeof *held->load);
    held->others = array_new(scene->loads, sizeof *held->others);
    if (held->load == NULL || held->others == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the host's loads");
    bool functions = false;
    for (size_t face = 0; face < FACES; face++)
        functions = functions || scene->boundary[face].driven != BY_HISTORY;
    for (size_t k = 0; k < scene->loads; k++) {
        functions = functions || scene->load[k].driven == BY_HOST;
        if (scene->load[k].driven == HELD_BY_HOST) held->load[held->loads++] = k;
    }
    if (functions) held->loads = 0;
    return SELAS_OK;
}

/* Takes all g_k; `whole` has room for [loads + 1][unknowns], of which the first row is 0. */
static selas_status take(struct held *held, const struct model *model, held_acceleration *accelerate,
                         void *scheme, double *whole, struct messages *messages)
{
    const size_t n = model->unknowns;
    double largest = 0;
    const struct drive drive = {.load = held->others};
    for (size_t k = 0; k < held->loads; k++) {
        held->others[held->load[k]] = 1;
        accelerate(scheme, &drive, whole, whole, whole + (k + 1) * n);
        held->others[held->load[k]] = 0;
    }
    for (size_t i = 0; i < held->loads * n; i++)
        largest = fmax(largest, fabs(whole[n + i]));
    ranks_largest(model->scene->ranks, 1, &largest);
    held->index = array_new(n, sizeof *held->index);
    if (held->index == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the host's loads");
    for (size_t i = 0; i < n; i++) {
        bool moves = false;
        for (size_t k = 1; k <= held->loads; k++)
            moves = moves || fabs(whole[k * n + i]) > nothing * largest;
        if (moves) held->index[held->count++] = i;
    }
    held->rest = array_new(held->count, sizeof *held->rest);
    held->pull = array_new(held->loads * held->count, sizeof *held->pull);
    if (held->rest == NULL || held->pull == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the host's loads");
    for (size_t k = 0; k < held->loads; k++)
        for (size_t i = 0; i < held->count; i++)
            held->pull[k * held->count + i] = whole[(k + 1) * n + held->index[i]];
    return SELAS_OK;
}

selas_status held_create(struct held *held, const struct model *model, held_acceleration *accelerate,
                         void *scheme, struct messages *messages)
{
    *held = (struct held){0};
    const struct scene *scene = model->scene;
    if (accelerate == NULL || !scene_driven(scene) || model->spatial->linearise != NULL) return SELAS_OK;
    selas_status status = list(held, scene, messages);
    if (status == SELAS_OK && held->loads == 0) return status;
    double *whole = array_new((held->loads + 1) * model->unknowns, sizeof *whole);
    if (status == SELAS_OK && whole == NULL)
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the host's loads");
    status = ranks_agree(scene->ranks, status, messages);
    if (status == SELAS_OK && whole != NULL) status = take(held, model, accelerate, scheme, whole, messages);
    array_free(whole);
    return status;
}

void held_free(struct held *held)
{
    array_free(held->load);
    array_free(held->index);
    array_free(held->rest);
    array_free(held->pull);
    array_free(held->others);
    *held = (struct held){0};
}

struct drive held_left_out(const struct held *held, const struct scene *scene, const struct drive *drive)
{
    struct drive without = *drive;
    if (held->loads == 0) return without;
    memcpy(held->others, drive->load, scene->loads * sizeof *held->others);
    for (size_t k = 0; k < held->loads; k++)
        held->others[held->load[k]] = 0;
    without.load = held->others;
    return without;
}

/* a of (H1) at place i. */
static double accelerated(const struct held *held, const struct drive *drive, size_t i)
{
    double a = held->rest[i];
    for (size_t k = 0; k < held->loads; k++)
        a += drive->load[held->load[k]] * held->pull[k * held->count + i];
    return a;
}

void held_add(struct held *held, const struct drive *drive, double *a)
{
    for (size_t i = 0; i < held->count; i++) {
        held->rest[i] = a[held->index[i]];
        a[held->index[i]] = accelerated(held, drive, i);
    }
}

void held_change(const struct held *held, const struct drive *drive, double half, double *v, double *a)
{
    for (size_t i = 0; i < held->count; i++) {
        const size_t at = held->index[i];
        const double now = accelerated(held, drive, i);
        v[at] += half * (now - a[at]);
        a[at] = now;
    }
}
