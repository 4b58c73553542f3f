/* Reference 'file': histories that were measured or computed before, in place of an exact solution. */
#ifndef SELAS_RECORDED_H
#define SELAS_RECORDED_H

#include "exact/exact.h"

extern const struct exact_class exact_recorded;

#endif
