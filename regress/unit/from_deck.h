/* A scene from the text of a deck, for tests. */
#ifndef FROM_DECK_H
#define FROM_DECK_H

#include "accuracy/accuracy.h"
#include "scene/scene.h"

#include "near.h"

#include <stdio.h>
#include <string.h>

struct from_deck {
    struct deck *deck;
    struct scene *scene; /* NULL: refused */
    struct messages messages;
    selas_status status;
};

/* Overrides: up to `count` texts. The deck's name in messages is "t.nml". */
static inline struct from_deck from_text(const char *text, size_t count, const char *const *overrides)
{
    struct from_deck result = {0};
    result.status =
        deck_read_text("t.nml", text, strlen(text), count, overrides, &result.deck, &result.messages);
    if (result.status == SELAS_OK)
        result.status = accuracy_build(result.deck, NULL, &result.scene, &result.messages);
    return result;
}

static inline void from_deck_free(struct from_deck *result)
{
    scene_free(&result->scene);
    deck_free(&result->deck);
    messages_free(&result->messages);
}

/* The scene of a deck that must be right. */
static inline struct from_deck right_scene(const char *text)
{
    struct from_deck result = from_text(text, 0, NULL);
    if (result.scene == NULL) {
        print_error("refused:\n%s", result.messages.text != NULL ? result.messages.text : "(no message)\n");
        assert_non_null(result.scene);
    }
    return result;
}

/* A deck that must be refused with `place` ("t.nml:3:7: error:") and each of the words (ended by NULL) in one
 * line. */
static inline void assert_refused(const char *text, const char *place, const char *const *words)
{
    struct from_deck result = from_text(text, 0, NULL);
    bool found = false;
    const char *all = result.messages.text != NULL ? result.messages.text : "";
    if (result.status != SELAS_BAD_DECK) print_error("not refused:\n%s", text);
    assert_int_equal(result.status, SELAS_BAD_DECK);
    assert_null(result.scene);
    for (const char *line = all; *line != '\0' && !found; line += strcspn(line, "\n") + 1) {
        char copy[1024];
        snprintf(copy, sizeof copy, "%.*s", (int)strcspn(line, "\n"), line);
        found = strncmp(copy, place, strlen(place)) == 0;
        for (const char *const *word = words; *word != NULL && found; word++)
            found = strstr(copy, *word) != NULL;
    }
    if (!found) {
        print_error("expected \"%s ... %s\" in:\n%s", place, words[0], all);
        assert_true(found);
    }
    from_deck_free(&result);
}

#endif
