/* The schemes of the list in deck/choices.h: a new scheme is a file and a line there. */
#include "stepping/schemes.h"

#include <string.h>

#define ENTRY(symbol, word) &scheme_##symbol,
static const struct scheme_class *const schemes[] = {SCHEMES(ENTRY) NULL};

const struct scheme_class *scheme_find(const char *name)
{
    for (size_t i = 0; schemes[i] != NULL; i++)
        if (strcmp(schemes[i]->name, name) == 0) return schemes[i];
    return NULL;
}
