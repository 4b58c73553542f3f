/* Steps of leapfrog in one pass as functions of the consistent model, and what is looked at after each. */
#include "method/fused.h"
#include "method/hform.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

static int by_place(const void *one, const void *other)
{
    const size_t a = *(const size_t *)one, b = *(const size_t *)other;
    return a < b ? -1 : a > b;
}

/* Each entry once, in the order of memory. */
static void sort_watched(struct fused_watch *watch)
{
    if (watch->sorted || watch->count == 0) return;
    qsort(watch->entry, watch->count, sizeof *watch->entry, by_place);
    size_t kept = 1;
    for (size_t i = 1; i < watch->count; i++)
        if (watch->entry[i] != watch->entry[kept - 1]) watch->entry[kept++] = watch->entry[i];
    watch->count = kept;
    watch->sorted = true;
}

bool fused_watch(struct consistent *c, size_t count, const size_t *place)
{
    if (c->own_class.advance == NULL) return true;
    struct fused_watch *watch = &c->fused->watch;
    if (watch->room < watch->count + 3 * count) {
        sort_watched(watch);
        const size_t room = 2 * watch->count + 3 * count;
        size_t *entry = array_new(room, sizeof *entry);
        double *before = array_new(room, sizeof *before);
        if (entry != NULL && watch->count > 0) memcpy(entry, watch->entry, watch->count * sizeof *entry);
        array_free(watch->entry);
        array_free(watch->before);
        watch->entry = entry;
        watch->before = before;
        watch->room = room;
        if (entry == NULL || before == NULL) return false;
    }
    for (size_t component = 0; component < 3; component++)
        for (size_t i = 0; i < count; i++)
            watch->entry[watch->count++] = component * c->volume + place[i];
    watch->sorted = false;
    return true;
}

/* The power of a load is that of the velocities it touches. */
static bool watch_loads(struct consistent *c)
{
    for (size_t l = 0; l < c->model.scene->loads; l++) {
        const struct sparse *load = &c->load[l];
        for (size_t at = 0; at < 3 * c->n[DEPTH]; at++)
            for (size_t e = load->start[at]; e < load->start[at + 1]; e++) {
                const size_t place = at % c->n[DEPTH] * c->plane + load->index[e];
                if (!fused_watch(c, 1, &place)) return false;
            }
    }
    return true;
}

static void begin(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const size_t n = model->unknowns;
    sort_watched(&c->fused->watch);
    memcpy(c->fused->w, y + n, n * sizeof *y);
    fused_begin_double(c, drive, dt, y, c->fused->w, c->hform->work, a);
    model->evaluations++;
}

static void advance(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    fused_advance_double(c, drive, dt, y, c->fused->w, y, a);
    model->evaluations++;
}

static void settle(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    fused_settle_double(c, drive, dt, y, c->fused->w, c->hform->work, y, a);
}

static void *kept(struct model *model, size_t *bytes)
{
    *bytes = model->unknowns * sizeof(double);
    return consistent_of(model)->fused->w;
}

bool fused_steps_create(struct consistent *c)
{
    bool moving = c->moving_loads > 0;
    for (int face = 0; face < BOX_FACES; face++)
        moving = moving || c->moving[face];
    if (c->fused == NULL || moving || c->model.damped || c->hform->dissipation != NULL || c->pml != NULL)
        return true;
    struct model_class *class = &c->own_class;
    class->begin = begin;
    class->advance = advance;
    class->settle = settle;
    class->kept = kept;
    c->fused->w = array_new(c->model.unknowns, sizeof *c->fused->w);
    c->fused->bytes += c->model.unknowns * sizeof *c->fused->w;
    return c->fused->w != NULL && watch_loads(c);
}
