/* The schemes: a table of names. A new scheme is one new file and one line here. */
#include "stepping/schemes.h"

#include <string.h>

static const struct scheme_class *const schemes[] = {
    &scheme_leapfrog, &scheme_modified_equation,
    &scheme_euler,    &scheme_pc2,
    &scheme_rk4,      &scheme_rkc,
    &scheme_lsrk54,   NULL,
};

const struct scheme_class *scheme_find(const char *name)
{
    for (size_t i = 0; schemes[i] != NULL; i++)
        if (strcmp(schemes[i]->name, name) == 0) return schemes[i];
    return NULL;
}
