/* Decks: text to words to scene, as far as no points are made. A deck that is right has an echo that is
 * right too, says the same, and makes a scene or refuses it the same way. */
#include "accuracy/accuracy.h"
#include "fuzz.h"

#include "scene/scene.h"

#include <string.h>

static char *echo_of(const struct deck *deck, size_t *length)
{
    struct messages messages = {0};
    char *text = NULL;
    FILE *file = open_memstream(&text, length);
    if (file == NULL) abort();
    const selas_status status = deck_write(deck, file, &messages);
    if (fclose(file) != 0) abort();
    fuzz_told(status, &messages);
    fuzz_require(status == SELAS_OK, "a deck that was read can be written");
    return text;
}

static selas_status build(const struct deck *deck)
{
    struct messages messages = {0};
    struct scene *scene = NULL;
    const selas_status status = accuracy_build(deck, NULL, &scene, &messages);
    fuzz_require((status == SELAS_OK) == (scene != NULL), "a scene only where there is no error");
    fuzz_told(status, &messages);
    scene_free(&scene);
    return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct messages messages = {0};
    struct deck *deck = NULL, *again = NULL;
    const selas_status status =
        deck_read_text("deck.nml", (const char *)data, size, 0, NULL, &deck, &messages);
    fuzz_told(status, &messages);
    if (status != SELAS_OK) return 0;
    const selas_status built = build(deck);
    size_t length = 0, length_again = 0;
    char *echo = echo_of(deck, &length);
    const selas_status read = deck_read_text("deck.nml", echo, length, 0, NULL, &again, &messages);
    if (read != SELAS_OK) fprintf(stderr, "%s\n%s\n", echo, messages.text);
    fuzz_told(read, &messages);
    fuzz_require(read == SELAS_OK, "an echo can be read");
    char *echo_again = echo_of(again, &length_again);
    fuzz_require(length == length_again && memcmp(echo, echo_again, length) == 0, "the echo of an echo");
    fuzz_require(build(again) == built, "a deck and its echo are one scene");
    free(echo);
    free(echo_again);
    deck_free(&again);
    deck_free(&deck);
    return 0;
}
