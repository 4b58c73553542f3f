/* What is looked at after each step in one pass. */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

static int by_place(const void *one, const void *other)
{
    const size_t a = *(const size_t *)one, b = *(const size_t *)other;
    return a < b ? -1 : a > b;
}

void watch_sort(struct watch *watch)
{
    if (watch->sorted || watch->count == 0) return;
    qsort(watch->entry, watch->count, sizeof *watch->entry, by_place);
    watch->sorted = true;
}

static bool make_room(struct watch *watch, size_t count)
{
    if (watch->room >= count) return true;
    size_t *entry = array_new(2 * count, sizeof *entry);
    double *before = array_new(2 * count, sizeof *before);
    if (entry != NULL && watch->count > 0) memcpy(entry, watch->entry, watch->count * sizeof *entry);
    array_free(watch->entry);
    array_free(watch->before);
    watch->entry = entry;
    watch->before = before;
    watch->room = 2 * count;
    return entry != NULL && before != NULL;
}

bool watch_places(struct consistent *c, size_t count, const size_t *place)
{
    if (c->model.one_pass == NULL) return true;
    struct watch *watch = &c->watch;
    if (watch->taken == NULL) watch->taken = array_new(c->volume / 8 + 1, 1);
    if (watch->taken == NULL || !make_room(watch, watch->count + 3 * count)) return false;
    for (size_t i = 0; i < count; i++) {
        unsigned char *taken = &watch->taken[place[i] / 8];
        const unsigned bit = 1U << place[i] % 8;
        if ((*taken & bit) != 0) continue;
        *taken = (unsigned char)(*taken | bit);
        for (size_t component = 0; component < 3; component++)
            watch->entry[watch->count++] = component * c->volume + place[i];
        watch->sorted = false;
    }
    return true;
}

bool watch_loads(struct consistent *c)
{
    for (size_t l = 0; l < c->model.scene->loads; l++) {
        const struct sparse *load = &c->load.of[l];
        for (size_t p = 0; p < load->planes; p++)
            for (size_t e = load->start[p]; e < load->start[p + 1]; e++) {
                const size_t place = load->plane[p] % c->n[DEPTH] * c->plane + load->index[e];
                if (!watch_places(c, 1, &place)) return false;
            }
    }
    return true;
}

void watch_free(struct watch *watch)
{
    array_free(watch->entry);
    array_free(watch->before);
    array_free(watch->taken);
}
