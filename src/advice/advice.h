/* What may be wrong in a scene without being refused (doc/howto/troubleshooting.md). */
#ifndef SELAS_ADVICE_ADVICE_H
#define SELAS_ADVICE_ADVICE_H

#include "stepping/stepping.h"

/* Tells each thing (key "warning") and what would be right, and how many there are; tell may be NULL. */
size_t advice_tell(const struct scene *scene, const struct stepper *stepper,
                   void (*tell)(void *context, const char *key, const char *value), void *context);
/* Are a field's values of a host's receiver at a place made from a strain that is smooth where the rock jumps, within a
 * spacing? */
bool advice_smooth_strain(const struct scene *scene, const double position[3], selas_field field);
/* What a host's receiver of total-Lagrangian particles there errs by in such a field, relative; 0: no more than in
 * velocities. */
double advice_strain_error(const struct model *model, const double position[3], selas_field field);

#endif
