/* Building a scene by calls: each call becomes a word of the deck, with the deck's own checks and messages.
 */
#include "host/simulation.h"

#include "base/memory.h"
#include "deck/words.h"

#include <ctype.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Text that grows; numbers have a decimal point whatever the locale of the host. */
struct text {
    char *start;
    size_t length, room;
    bool lacking;
};

static void put(struct text *text, const char *piece, size_t length)
{
    if (text->length + length + 1 > text->room && !text->lacking) {
        const size_t room = 2 * (text->room + length) + 64;
        char *grown = realloc(text->start, room);
        /* cppcheck-suppress memleak ; there is nothing to lose where it is NULL */
        text->lacking = grown == NULL;
        // cppcheck-suppress memleak ; grown is NULL here
        if (text->lacking) return;
        text->start = grown;
        text->room = room;
    }
    if (text->lacking) return;
    memcpy(text->start + text->length, piece, length);
    text->length += length;
    text->start[text->length] = '\0';
}

static void put_number(struct text *text, double number)
{
    char piece[40];
    snprintf(piece, sizeof piece, "%.17g", number);
    put(text, piece, strlen(piece));
}

/* In quotes, those inside doubled. */
static void put_quoted(struct text *text, const char *value)
{
    put(text, "'", 1);
    for (; *value != '\0'; value++)
        put(text, *value == '\'' ? "''" : value, *value == '\'' ? 2 : 1);
    put(text, "'", 1);
}

/* Checks what all setters have in common and begins the text "word=". */
static selas_status begin_word(selas_simulation *simulation, const char *word, size_t count,
                               const void *values, struct text *text)
{
    selas_status status = simulation_may_change(simulation);
    if (status != SELAS_OK) return status;
    if (word == NULL || values == NULL || count == 0)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "%s",
                    word == NULL ? "the word to set is NULL" : "there are no values to set");
    if (count > LIST_SIZE)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "%zu values for '%.60s': no word of the deck takes more than %d", count, word, LIST_SIZE);
    const char *percent = strchr(word, '%');
    if (percent == NULL || strchr(word, '=') != NULL || strlen(word) > 200)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "'%.60s' names no word of the deck; expected 'group%%word' or 'group(2)%%word'", word);
    put(text, word, strlen(word));
    put(text, "=", 1);
    return SELAS_OK;
}

/* The scene borrows the deck's groups, which move when there is one more. */
static selas_status end_word(selas_simulation *simulation, struct text *text)
{
    if (text->lacking)
        return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a word of the deck");
    const struct deck_group *before = deck_get(simulation->deck, "method", 0);
    const selas_status status = deck_set(simulation->deck, text->start, &simulation->messages);
    if (status == SELAS_OK || deck_get(simulation->deck, "method", 0) != before)
        simulation_discard(simulation);
    return status;
}

selas_status selas_set_real(selas_simulation *simulation, const char *word, size_t count,
                            const double *values)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    struct text text = {0};
    selas_status status = begin_word(simulation, word, count, values, &text);
    for (size_t i = 0; status == SELAS_OK && i < count; i++) {
        if (i > 0) put(&text, ",", 1);
        put_number(&text, values[i]);
        if (!isfinite(values[i]))
            status = fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                          "value %zu of '%.60s' is not a finite number", i + 1, word);
    }
    if (status == SELAS_OK) status = end_word(simulation, &text);
    free(text.start);
    return status;
}

selas_status selas_set_integer(selas_simulation *simulation, const char *word, long value)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    struct text text = {0};
    char piece[40];
    selas_status status = begin_word(simulation, word, 1, &value, &text);
    const int length = snprintf(piece, sizeof piece, "%ld", value);
    put(&text, piece, (size_t)length);
    if (status == SELAS_OK) status = end_word(simulation, &text);
    free(text.start);
    return status;
}

selas_status selas_set_logical(selas_simulation *simulation, const char *word, bool value)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    struct text text = {0};
    selas_status status = begin_word(simulation, word, 1, &value, &text);
    put(&text, value ? ".true." : ".false.", value ? 6 : 7);
    if (status == SELAS_OK) status = end_word(simulation, &text);
    free(text.start);
    return status;
}

static selas_status set_texts(selas_simulation *simulation, const char *word, size_t count,
                              const char *const *values)
{
    struct text text = {0};
    selas_status status = begin_word(simulation, word, count, values, &text);
    for (size_t i = 0; status == SELAS_OK && i < count; i++) {
        if (values[i] == NULL) {
            status =
                fail(&simulation->messages, SELAS_BAD_ARGUMENT, "value %zu of '%.60s' is NULL", i + 1, word);
            break;
        }
        if (i > 0) put(&text, ",", 1);
        put_quoted(&text, values[i]);
    }
    if (status == SELAS_OK) status = end_word(simulation, &text);
    free(text.start);
    return status;
}

selas_status selas_set_text(selas_simulation *simulation, const char *word, size_t count,
                            const char *const *values)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    return set_texts(simulation, word, count, values);
}

selas_status selas_add(selas_simulation *simulation, const char *group, size_t *number)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    const selas_status status = simulation_may_change(simulation);
    if (status != SELAS_OK) return status;
    if (group == NULL || number == NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "the group's name or the room for its number is NULL");
    *number = 0;
    const selas_status added = deck_add(simulation->deck, group, number, &simulation->messages);
    if (added == SELAS_OK) simulation_discard(simulation);
    return added;
}

/* --- Points of the host's own --- */

static void *copy_of(const void *from, size_t count, size_t size)
{
    void *copy = from != NULL ? array_new(count, size) : NULL;
    if (copy != NULL) memcpy(copy, from, count * size);
    return copy;
}

static selas_status check_points(selas_simulation *simulation, size_t count, const double *position,
                                 const double *volume)
{
    if (count == 0 || position == NULL || volume == NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "there are no points, positions or volumes");
    if (count > (size_t)1 << 40)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "%zu points are too many", count);
    for (size_t i = 0; i < count; i++)
        if (!isfinite(position[3 * i]) || !isfinite(position[3 * i + 1]) || !isfinite(position[3 * i + 2]) ||
            !isfinite(volume[i]) || !(volume[i] > 0.0))
            return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                        "point %zu needs a finite position and a volume above 0", i + 1);
    return SELAS_OK;
}

selas_status selas_set_points(selas_simulation *simulation, size_t count, const double *position,
                              const double *volume, const size_t *material)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_may_change(simulation);
    if (status == SELAS_OK) status = check_points(simulation, count, position, volume);
    if (status != SELAS_OK) return status;
    const size_t materials = deck_count(simulation->deck, "material");
    for (size_t i = 0; material != NULL && i < count; i++)
        if (material[i] < 1 || material[i] > materials)
            return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                        "point %zu has material %zu; the scene has &material 1 to %zu", i + 1, material[i],
                        materials);
    double *positions = copy_of(position, 3 * count, sizeof *positions);
    double *volumes = copy_of(volume, count, sizeof *volumes);
    size_t *materials_of = copy_of(material, count, sizeof *materials_of);
    const char *const shape[1] = {"points"};
    if (positions == NULL || volumes == NULL || (material != NULL && materials_of == NULL))
        status = fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for %zu points", count);
    if (status == SELAS_OK) status = set_texts(simulation, "body%shape", 1, shape);
    if (status != SELAS_OK) {
        array_free(positions);
        array_free(volumes);
        array_free(materials_of);
        return status;
    }
    for (size_t i = 0; materials_of != NULL && i < count; i++)
        materials_of[i]--;
    array_free(simulation->point_position);
    array_free(simulation->point_volume);
    array_free(simulation->point_material);
    simulation->point_position = positions;
    simulation->point_volume = volumes;
    simulation->point_material = materials_of;
    simulation->points = (struct given_points){count, positions, volumes, materials_of};
    deck_hand_points(simulation->deck, &simulation->points);
    return SELAS_OK;
}
