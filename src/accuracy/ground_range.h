/* What scene%accuracy serves on ground, and how far its laws were measured (doc/verification/accuracy.md). */
#ifndef SELAS_ACCURACY_GROUND_RANGE_H
#define SELAS_ACCURACY_GROUND_RANGE_H

#include "scene/scene.h"

/* NULL: such scenes are served; else which would be. */
const char *ground_refusal(const struct scene *scene);
/* NULL: the laws were measured for such scenes; else for which. Beyond, only a trial can tell. */
const char *ground_range_refusal(const struct scene *scene);
/* SELAS_BAD_SCENE: without a trial the laws do not hold for this scene. h: the spacing that is needed. */
selas_status ground_in_range(const struct scene *scene, double h, struct messages *messages);
/* The power of the spacing with which errors fall from a trial on (measured): no trial promises more. */
double ground_order(const struct scene *scene);

#endif
