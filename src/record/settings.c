/* /settings in run.h5: every name of the deck that has a value, by the table of words. */
#include "record/run_file.h"

#include "base/memory.h"
#include "deck/words.h"

#include <stdlib.h>
#include <string.h>

/* One text as it is, several as 'one', 'other'; new memory (free it). */
static char *texts_of(const struct deck_group *group, const char *name, size_t count)
{
    char *text = NULL;
    size_t size = 0;
    if (count == 1) return strdup(deck_text(group, name, 0));
    FILE *memory = open_memstream(&text, &size);
    if (memory == NULL) return NULL;
    for (size_t i = 0; i < count; i++)
        fprintf(memory, "%s'%s'", i > 0 ? ", " : "", deck_text(group, name, i));
    if (fclose(memory) == 0) return text;
    free(text);
    return NULL;
}

static bool write_texts(const struct deck_group *group, const char *name, size_t count, hid_t place)
{
    char *text = texts_of(group, name, count);
    const bool good = text != NULL && hdf_text(place, name, text);
    free(text);
    return good;
}

static bool write_numbers(const struct deck_group *group, const struct word *word, size_t count, hid_t place)
{
    double number[LIST_SIZE];
    for (size_t i = 0; i < count; i++)
        number[i] = word->type == WORD_REAL ? deck_real(group, word->name, i)
                                            : (double)deck_integer(group, word->name, i);
    return hdf_numbers(place, word->name, count, number);
}

static bool write_setting(const struct deck *deck, const struct deck_group *group, const struct word *word,
                          hid_t place)
{
    const size_t count = deck_values(group, word->name);
    if (count == 0) return true;
    char *path;
    bool good;
    switch (word->type) {
    case WORD_LOGICAL:
        return hdf_text(place, word->name, deck_logical(group, word->name, 0) ? ".true." : ".false.");
    case WORD_FILE:
        path = deck_absolute(deck, deck_text(group, word->name, 0));
        good = path != NULL && hdf_text(place, word->name, path);
        array_free(path);
        return good;
    case WORD_TEXT:
    case WORD_CHOICE:
        return write_texts(group, word->name, count, place);
    case WORD_REAL:
    case WORD_INTEGER:
        break;
    }
    return write_numbers(group, word, count, place);
}

static bool write_group(const struct deck *deck, const struct word_group *kind, size_t number, hid_t settings)
{
    char name[NAME_SIZE + 24];
    snprintf(name, sizeof name, "%s_%zu", kind->name, number + 1);
    const hid_t place = hdf_group(settings, name);
    bool good = place >= 0;
    for (size_t w = 0; good && w < kind->words; w++)
        good = write_setting(deck, deck_get(deck, kind->name, number), &kind->word[w], place);
    if (place >= 0) H5Gclose(place);
    return good;
}

bool write_settings(const struct deck *deck, hid_t file)
{
    const struct word_table *table = deck_words();
    const hid_t settings = hdf_group(file, "settings");
    bool good = settings >= 0;
    for (size_t g = 0; deck != NULL && g < table->groups; g++)
        for (size_t i = 0; good && i < deck_count(deck, table->group[g].name); i++)
            good = write_group(deck, &table->group[g], i, settings);
    if (settings >= 0) H5Gclose(settings);
    return good;
}
