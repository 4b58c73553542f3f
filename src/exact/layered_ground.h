/* Reference 'layered' (layered_ground.c). */
#ifndef SELAS_LAYERED_GROUND_H
#define SELAS_LAYERED_GROUND_H

#include "exact/exact.h"

extern const struct exact_class exact_layered;

#endif
