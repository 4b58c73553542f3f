/* Point sources of a &load that names a file of them. */
#include "base/memory.h"
#include "scene/build.h"

#include <math.h>
#include <string.h>

struct point_sources take_sources(struct builder *builder, const struct deck_group *group,
                                  enum load_kind kind)
{
    static const char *const other_words[] = {"name",   "face",      "shape",     "centre",   "depth", "size",
                                              "moment", "mechanism", "direction", "velocity", NULL};
    struct point_sources sources = {0};
    struct messages said = {0};
    if (kind == LOAD_TRACTION) {
        complain(builder, group, "sources",
                 "a file of sources holds forces or moment tensors; expected kind = 'body-force' or "
                 "'moment-tensor'");
        return sources;
    }
    if (builder->scene->dimension != 3)
        complain(builder, group, "sources", "a file of sources needs scene%%dimension = 3");
    refuse(builder, group, other_words, "a load with sources");
    char *path = deck_path(builder, deck_text(group, "sources", 0));
    if (path == NULL) return sources;
    if (point_sources_read(path, kind == LOAD_MOMENT_TENSOR ? 6 : 3, &sources, &said) != SELAS_OK) {
        const char *text = said.text != NULL ? said.text : "";
        if (strncmp(text, "error: ", 7) == 0) text += 7;
        complain(builder, group, "sources", "the sources cannot be used: %.*s", (int)strcspn(text, "\n"),
                 text);
    }
    messages_free(&said);
    array_free(path);
    return sources;
}

static bool check_place(struct builder *builder, const struct deck_group *group, size_t number,
                        const double place[3])
{
    char near[VECTOR_TEXT_SIZE];
    double nearest[3];
    if (!builder->body_known || body_holds(&builder->scene->body, 3, place, nearest)) return true;
    complain(builder, group, "sources",
             "source %zu of the file lies outside the body; the nearest place is %s", number,
             vector_text(near, nearest, 3));
    return false;
}

/* A load of unit length in force, or with the moment, of one source; false after complaining. */
static bool set_source(struct builder *builder, const struct deck_group *group, size_t number,
                       const struct point_source *source, struct load *load)
{
    double largest = 0, length = 0;
    load->shape = LOAD_POINT;
    load->amplitude *= source->amplitude;
    load->history.start += source->start;
    memcpy(load->centre, source->position, sizeof load->centre);
    for (size_t i = 0; i < 6; i++)
        largest = fmax(largest, fabs(source->value[i]));
    if (largest == 0) {
        complain(builder, group, "sources", "source %zu of the file is zero", number);
        return false;
    }
    if (!check_place(builder, group, number, load->centre)) return false;
    if (load->kind == LOAD_MOMENT_TENSOR) {
        memcpy(load->moment, source->value, sizeof load->moment);
        return true;
    }
    for (int c = 0; c < 3; c++)
        length += source->value[c] / largest * (source->value[c] / largest);
    length = sqrt(length);
    load->amplitude *= length * largest;
    for (int c = 0; c < 3; c++)
        load->direction[c] = source->value[c] / largest / length;
    return true;
}

/* Gives a history tables of its own. */
static bool copy_tables(struct builder *builder, struct history *history)
{
    const double *const old[2] = {history->table_time, history->table_value};
    double **const table[2] = {&history->table_time, &history->table_value};
    history->table_time = history->table_value = NULL;
    for (int i = 0; i < 2 && old[i] != NULL; i++) {
        *table[i] = scene_array(builder, history->rows, sizeof **table[i]);
        if (*table[i] == NULL) return false;
        memcpy(*table[i], old[i], history->rows * sizeof **table[i]);
    }
    return true;
}

void read_sources(struct builder *builder, const struct deck_group *group,
                  const struct point_sources *sources, struct load *load)
{
    const struct load common = load[0];
    for (size_t i = 0; i < sources->count; i++) {
        load[i] = common;
        if (i > 0 && !copy_tables(builder, &load[i].history)) return;
        if (!set_source(builder, group, i + 1, &sources->source[i], &load[i])) return;
    }
}
