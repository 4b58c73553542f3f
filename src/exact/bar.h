/* What a bar's wave looks like, without and with artificial viscosity. */
#ifndef SELAS_BAR_H
#define SELAS_BAR_H

#include "exact/exact.h"

extern const struct exact_class exact_bar;

#endif
