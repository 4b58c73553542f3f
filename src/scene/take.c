/* Reading single values of a deck's group, with the complaints that they share. */
#include "base/memory.h"
#include "scene/build.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

void complain(struct builder *builder, const struct deck_group *group, const char *name, const char *format,
              ...)
{
    char text[1024];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    const selas_status status = deck_error(builder->deck, group, name, builder->messages, "%s", text);
    if (builder->status == SELAS_OK) builder->status = status;
}

void complain_of_memory(struct builder *builder)
{
    if (builder->status == SELAS_NO_MEMORY) return;
    builder->status = fail(builder->messages, SELAS_NO_MEMORY, "no memory for the scene");
}

void *scene_array(struct builder *builder, size_t count, size_t size)
{
    void *array = array_new(count, size);
    if (array == NULL) complain_of_memory(builder);
    return array;
}

bool take_name(struct builder *builder, const struct deck_group *group, const char *name,
               char text[NAME_SIZE])
{
    if (deck_values(group, name) == 0) return false;
    const char *given = deck_text(group, name, 0);
    if (given[0] == '\0') {
        complain(builder, group, name, "the %s is empty; expected a name", name);
        return false;
    }
    if (strlen(given) >= NAME_SIZE) {
        complain(builder, group, name, "'%.40s...' is too long; expected at most %d characters", given,
                 NAME_SIZE - 1);
        return false;
    }
    memcpy(text, given, strlen(given) + 1);
    return true;
}

bool take_vector(struct builder *builder, const struct deck_group *group, const char *name, double vector[3])
{
    const size_t dimension = (size_t)builder->scene->dimension;
    if (!deck_given(group, name)) return false;
    const size_t count = deck_values(group, name);
    if (count != dimension) {
        complain(builder, group, name,
                 "%s has %zu value%s; expected %zu, as many as the scene has dimensions", name, count,
                 count == 1 ? "" : "s", dimension);
        return false;
    }
    for (size_t c = 0; c < 3; c++)
        vector[c] = c < count ? deck_real(group, name, c) : 0;
    return true;
}

bool need_vector(struct builder *builder, const struct deck_group *group, const char *name,
                 const char *purpose, double vector[3])
{
    if (!deck_given(group, name)) {
        complain(builder, group, NULL, "%s needs %s (%d value%s)", purpose, name, builder->scene->dimension,
                 builder->scene->dimension == 1 ? "" : "s");
        return false;
    }
    return take_vector(builder, group, name, vector);
}

/* The length of a direction is nothing: a force or a motion is as large as `amplitude`. Askew ones have lengths such as
 * those of (1, 1) or (3, 4). */
static void warn_of_length(struct builder *builder, const struct deck_group *group, const double vector[3],
                           double length)
{
    static const double most = 10;
    const double sum = fabs(vector[0]) + fabs(vector[1]) + fabs(vector[2]);
    const bool along_axis = sum == length, askew = length >= 1 / most && length <= most;
    if (deck_given(group, "amplitude") || (along_axis ? length == 1 : askew)) return;
    deck_warning(builder->deck, group, "direction", builder->messages,
                 "direction has the length %g, which says nothing of how large: that is amplitude, here 1; "
                 "amplitude = %g would be right if that is meant",
                 length, length);
}

bool need_direction(struct builder *builder, const struct deck_group *group, const char *name,
                    const char *purpose, double unit[3])
{
    double vector[3], largest = 0, length = 0;
    if (!need_vector(builder, group, name, purpose, vector)) return false;
    for (int c = 0; c < 3; c++)
        largest = fmax(largest, fabs(vector[c]));
    if (largest == 0) {
        complain(builder, group, name, "%s is zero; expected a vector of any other length", name);
        return false;
    }
    for (int c = 0; c < 3; c++) /* scaled first: squares neither overflow nor vanish */
        length += vector[c] / largest * (vector[c] / largest);
    length = sqrt(length);
    for (int c = 0; c < 3; c++)
        unit[c] = vector[c] / largest / length;
    if (strcmp(name, "direction") == 0) warn_of_length(builder, group, vector, largest * length);
    return true;
}

bool need_real(struct builder *builder, const struct deck_group *group, const char *name, const char *purpose,
               double *value)
{
    if (deck_values(group, name) == 0) {
        complain(builder, group, NULL, "%s needs %s", purpose, name);
        return false;
    }
    *value = deck_real(group, name, 0);
    return true;
}

void refuse(struct builder *builder, const struct deck_group *group, const char *const *names,
            const char *purpose)
{
    for (; *names != NULL; names++)
        if (deck_given(group, *names))
            complain(builder, group, *names, "'%s' does not belong to %s; leave it out", *names, purpose);
}

char *deck_path(struct builder *builder, const char *path)
{
    char *whole = deck_resolve(builder->deck, path);
    if (whole == NULL) complain_of_memory(builder);
    return whole;
}
