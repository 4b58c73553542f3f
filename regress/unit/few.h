/* Some scenes of many where each takes long: under valgrind, where vectors take eighty times as long
 * (regress/hardening/valgrind sets SELAS_FEW_SCENES). */
#ifndef FEW_H
#define FEW_H

#include <stdlib.h>

static inline int few_of(int all, int some)
{
    return getenv("SELAS_FEW_SCENES") != NULL ? some : all;
}

#endif
