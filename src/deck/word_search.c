/* Finding words: by name, by the nearest spelling, and what their choices and ranges say. */
#include "deck/words.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

size_t words_find_group(const struct word_table *table, const char *name, size_t length)
{
    size_t i = 0;
    while (i < table->groups &&
           (strlen(table->group[i].name) != length || strncasecmp(table->group[i].name, name, length) != 0))
        i++;
    return i;
}

size_t words_find(const struct word_group *group, const char *name, size_t length)
{
    size_t i = 0;
    while (i < group->words &&
           (strlen(group->word[i].name) != length || strncasecmp(group->word[i].name, name, length) != 0))
        i++;
    return i;
}

const struct retired_word *words_find_retired(const struct word_group *group, const char *name, size_t length)
{
    for (const struct retired_word *word = group->retired; word != NULL && word->group != NULL; word++)
        if (strcasecmp(word->group, group->name) == 0 && strlen(word->old) == length &&
            strncasecmp(word->old, name, length) == 0)
            return word;
    return NULL;
}

size_t word_choices(const struct word *word)
{
    size_t count = 1;
    for (const char *c = word->range; *c != '\0'; c++)
        if (*c == '|') count++;
    return count;
}

void word_choice(const struct word *word, size_t index, char *text, size_t size)
{
    const char *start = word->range;
    for (size_t i = 0; i < index && start != NULL; i++) {
        start = strchr(start, '|');
        if (start != NULL) start++;
    }
    size_t length = start == NULL ? 0 : strcspn(start, "|");
    if (length >= size) length = size - 1;
    if (start != NULL) memcpy(text, start, length);
    text[length] = '\0';
}

size_t word_find_choice(const struct word *word, const char *text)
{
    const size_t count = word_choices(word);
    char choice[TEXT_SIZE];
    size_t i = 0;
    for (; i < count; i++) {
        word_choice(word, i, choice, sizeof choice);
        if (strcmp(choice, text) == 0) break;
    }
    return i;
}

bool word_in_range(const struct word *word, double value)
{
    if (!isfinite(value)) return false;
    if (word->range == NULL) return true;
    char *end;
    const double low = strtod(word->range + 1, &end);
    const double high = strtod(end + 1, &end);
    const bool above = *word->range == '[' ? value >= low : value > low;
    const bool below = *end == ']' ? value <= high : value < high;
    return above && below;
}

static size_t least(size_t a, size_t b)
{
    return a < b ? a : b;
}

static int lower(char c)
{
    return c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c;
}

size_t words_distance(const char *one, const char *other)
{
    enum { LONGEST = 63 };
    const size_t rows = strnlen(one, LONGEST + 1), columns = strnlen(other, LONGEST + 1);
    if (rows > LONGEST || columns > LONGEST) return SIZE_MAX;
    size_t cost[3][LONGEST + 1]; /* three rows of the table of distances between beginnings, used in turn */
    for (size_t j = 0; j <= columns; j++)
        cost[0][j] = j;
    for (size_t i = 1; i <= rows; i++) {
        size_t *now = cost[i % 3];
        const size_t *last = cost[(i - 1) % 3], *before = cost[(i + 1) % 3];
        now[0] = i;
        for (size_t j = 1; j <= columns; j++) {
            const bool same = lower(one[i - 1]) == lower(other[j - 1]);
            now[j] = least(least(last[j], now[j - 1]) + 1, last[j - 1] + (same ? 0 : 1));
            if (i > 1 && j > 1 && lower(one[i - 1]) == lower(other[j - 2]) &&
                lower(one[i - 2]) == lower(other[j - 1]))
                now[j] = least(now[j], before[j - 2] + 1);
        }
    }
    return cost[rows % 3][columns];
}

/* What groups, words and choices are called elsewhere, each with a blank on either side. */
static const char usual_names[] =
    " vp=p_speed vs=s_speed alpha=p_speed beta=s_speed rho=density e=young youngs_modulus=young nu=poisson "
    "poissons_ratio=poisson g=shear shear_modulus=shear k=bulk bulk_modulus=bulk dx=spacing h=spacing "
    "dt=time_step dt=history_step sampling=history_step cfl=courant position=centre force=amplitude "
    "m0=amplitude sigma=width t0=delay f0=frequency fc=frequency freq=frequency peak_frequency=frequency "
    "dir=directory folder=directory path=directory interval=every absorbing=transmitting station=receiver "
    "stations=receiver source=load time=stepping grid=body domain=body surface=topography ";

static bool is_usual(const char *word, const char *name)
{
    char pair[160];
    return snprintf(pair, sizeof pair, " %s=%s ", word, name) < (int)sizeof pair &&
           strcasestr(usual_names, pair) != NULL;
}

struct nearest {
    char name[64];
    size_t distance;
};

/* Keeps the nearer of two spellings; what differs in half of its letters is not near. */
static void keep_nearest(const char *word, const char *name, struct nearest *nearest)
{
    const size_t distance = is_usual(word, name) ? 0 : words_distance(word, name);
    if (distance >= nearest->distance || 2 * distance >= strlen(name) || 2 * distance > strlen(word) + 1)
        return;
    nearest->distance = distance;
    snprintf(nearest->name, sizeof nearest->name, "%s", name);
}

static const char *suggestion(const struct nearest *nearest, const char *mark, char text[SUGGESTION_SIZE])
{
    const bool near = nearest->name[0] != '\0';
    snprintf(text, SUGGESTION_SIZE, "%s%s%s%s", near ? "; did you mean '" : "", near ? mark : "",
             nearest->name, near ? "'?" : "");
    return text;
}

const char *suggest_group(const struct word_table *table, const char *word, const char *mark,
                          char text[SUGGESTION_SIZE])
{
    struct nearest nearest = {"", SIZE_MAX};
    for (size_t i = 0; i < table->groups; i++)
        keep_nearest(word, table->group[i].name, &nearest);
    return suggestion(&nearest, mark, text);
}

const char *suggest_word(const struct word_table *table, const struct word_group *group, const char *word,
                         char text[SUGGESTION_SIZE])
{
    struct nearest nearest = {"", SIZE_MAX};
    size_t used = 0;
    for (size_t i = 0, told = 0; table != NULL && i < table->groups && told < 3; i++) {
        const struct word_group *other = &table->group[i];
        if (words_find(other, word, strlen(word)) == other->words) continue;
        const int more = snprintf(text + used, SUGGESTION_SIZE - used, "%s&%s",
                                  told++ > 0 ? ", " : "; it is a word of ", other->name);
        used = more > 0 && used + (size_t)more < SUGGESTION_SIZE ? used + (size_t)more : SUGGESTION_SIZE - 1;
    }
    if (used > 0) return text;
    for (int expert = 0; expert < 2; expert++)
        for (size_t i = 0; i < group->words; i++)
            if ((group->word[i].need == EXPERT) == expert) keep_nearest(word, group->word[i].name, &nearest);
    return suggestion(&nearest, "", text);
}

const char *suggest_choice(const struct word *word, const char *choice, char text[SUGGESTION_SIZE])
{
    struct nearest nearest = {"", SIZE_MAX};
    char name[sizeof nearest.name];
    for (size_t i = 0; i < word_choices(word); i++) {
        word_choice(word, i, name, sizeof name);
        keep_nearest(choice, name, &nearest);
    }
    return suggestion(&nearest, "", text);
}
