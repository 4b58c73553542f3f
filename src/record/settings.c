/* Every setting of the deck, one call each: taken from the echo, which has all names with their values. */
#include "record/parts.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_GROUPS = 64 };

/* Counts the occurrences of groups by name. */
struct tally {
    size_t groups;
    char name[MOST_GROUPS][NAME_SIZE];
    size_t count[MOST_GROUPS];
};

static size_t occurrence_of(struct tally *tally, const char *name)
{
    for (size_t g = 0; g < tally->groups; g++)
        if (strcmp(tally->name[g], name) == 0) return ++tally->count[g];
    if (tally->groups == MOST_GROUPS) return 0;
    snprintf(tally->name[tally->groups], NAME_SIZE, "%s", name);
    tally->count[tally->groups] = 1;
    tally->groups++;
    return 1;
}

static const char *skip_blank(const char *at)
{
    while (isspace((unsigned char)*at) || *at == ',')
        at++;
    return at;
}

static const char *read_word(const char *at, char *word)
{
    size_t length = 0;
    while (isalnum((unsigned char)*at) || *at == '_') {
        if (length + 1 < NAME_SIZE) word[length++] = *at;
        at++;
    }
    word[length] = '\0';
    return at;
}

/* End of a list of values: where the next `name =`, the group's `/` or a comment begins; strings are skipped.
 */
static const char *end_of_values(const char *at)
{
    bool fresh = true; /* at the beginning of a word */
    while (*at != '\0' && *at != '/' && *at != '!') {
        if (*at == '\'' || *at == '"') {
            const char *close = strchr(at + 1, *at);
            at = close != NULL ? close + 1 : at + strlen(at);
            fresh = true;
            continue;
        }
        if (fresh && isalpha((unsigned char)*at)) {
            char word[NAME_SIZE];
            const char *after = read_word(at, word);
            if (*skip_blank(after) == '=') break;
            at = after;
            continue;
        }
        fresh = isspace((unsigned char)*at) || *at == ',';
        at++;
    }
    return at;
}

typedef void tell_setting(void *context, const char *group, size_t occurrence, const char *name,
                          const char *value);

/* Behind the group; NULL without memory. */
static const char *walk_group(const char *at, const char *group, size_t occurrence, tell_setting *tell,
                              void *context)
{
    for (at = skip_blank(at); *at != '\0' && *at != '/'; at = skip_blank(at)) {
        if (*at == '!') {
            at += strcspn(at, "\n");
            continue;
        }
        char name[NAME_SIZE];
        const char *after = read_word(at, name);
        const char *equals = skip_blank(after);
        if (after == at || *equals != '=') break; /* not a form that the echo has */
        const char *value = skip_blank(equals + 1);
        const char *end = end_of_values(value);
        at = end;
        while (end > value && (isspace((unsigned char)end[-1]) || end[-1] == ','))
            end--;
        char *text = strndup(value, (size_t)(end - value));
        if (text == NULL) return NULL;
        tell(context, group, occurrence, name, text);
        free(text);
    }
    while (*at != '\0' && *at != '/')
        at++;
    return *at == '/' ? at + 1 : at;
}

bool settings_walk(const struct deck *deck, tell_setting *tell, void *context, struct messages *messages)
{
    if (deck == NULL) return true;
    char *echo = NULL;
    size_t size = 0;
    FILE *memory = open_memstream(&echo, &size);
    if (memory == NULL) return false;
    const selas_status status = deck_write(deck, memory, messages);
    const bool good = fclose(memory) == 0 && status == SELAS_OK;
    const char *at = good ? echo : NULL;
    if (good) {
        struct tally tally = {0};
        while (at != NULL && *at != '\0') {
            at += strspn(at, " \t\r\n");
            if (*at != '&') { /* comments between groups */
                at += strcspn(at, "\n");
                continue;
            }
            char group[NAME_SIZE];
            at = read_word(at + 1, group);
            at = walk_group(at, group, occurrence_of(&tally, group), tell, context);
        }
    }
    free(echo);
    return at != NULL;
}
