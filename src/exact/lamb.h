/* Reference kind 'lamb'. */
#ifndef SELAS_LAMB_H
#define SELAS_LAMB_H

#include "exact/exact.h"

extern const struct exact_class exact_lamb;

/* exact_lamb.create with a wanted error of its own (struct lamb_problem); 0: the default. */
selas_status lamb_create_within(const struct scene *scene, double tolerance, struct exact **exact,
                                struct messages *messages);

#endif
