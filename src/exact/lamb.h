/* Reference kind 'lamb'. */
#ifndef SELAS_LAMB_H
#define SELAS_LAMB_H

#include "exact/exact.h"

extern const struct exact_class exact_lamb;

#endif
