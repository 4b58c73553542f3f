/* The schemes of the list in deck/choices.h: a new scheme is a file and a line there. */
#include "stepping/schemes.h"
#include "stepping/runge_kutta.h"

#include <stdio.h>
#include <string.h>

#define ENTRY(symbol, word) &scheme_##symbol,
const struct scheme_class *const scheme_table[] = {SCHEMES(ENTRY) NULL};

const struct scheme_class *scheme_find(const char *name)
{
    for (size_t i = 0; scheme_table[i] != NULL; i++)
        if (strcmp(scheme_table[i]->name, name) == 0) return scheme_table[i];
    return NULL;
}

bool scheme_fits(const struct scheme_class *scheme, const struct model *model)
{
    return !scheme->needs_acceleration || model->spatial->accelerate != NULL;
}

double scheme_limit(const struct scheme_class *scheme, const struct spectrum *spectrum, long stages)
{
    if (scheme->polynomial == NULL) return scheme->limit(spectrum, stages);
    return stability_limit(scheme->polynomial, stages, spectrum);
}

const struct scheme_class *scheme_default(const struct model *model)
{
    const enum scheme_default wanted = model->spatial->accelerate != NULL ? DEFAULT_FOR_ACCELERATE
                                       : model->damped                    ? DEFAULT_FOR_DAMPED
                                                                          : DEFAULT_FOR_UNDAMPED;
    for (size_t i = 0; scheme_table[i] != NULL; i++)
        if (scheme_table[i]->default_for == wanted) return scheme_table[i];
    return NULL;
}

static bool can(const struct scheme_class *scheme, const struct model *model, unsigned abilities)
{
    return scheme_fits(scheme, model) && (scheme->can & abilities) == abilities;
}

const char *scheme_names(const struct model *model, unsigned abilities, char text[SCHEME_NAMES_SIZE])
{
    size_t left = 0, length = 0;
    snprintf(text, SCHEME_NAMES_SIZE, "(none fits this method)");
    for (size_t i = 0; scheme_table[i] != NULL; i++)
        left += can(scheme_table[i], model, abilities);
    for (size_t i = 0; scheme_table[i] != NULL && length < SCHEME_NAMES_SIZE; i++) {
        if (!can(scheme_table[i], model, abilities)) continue;
        const char *between = length == 0 ? "" : left == 1 ? " or " : ", ";
        length += (size_t)snprintf(text + length, SCHEME_NAMES_SIZE - length, "%s'%s'", between,
                                   scheme_table[i]->name);
        left--;
    }
    return text;
}
