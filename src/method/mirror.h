/* Half, quarter or eighth of a body in place of the whole where the scene has mirror planes
 * (scene/symmetry.h). */
#ifndef SELAS_MIRROR_H
#define SELAS_MIRROR_H

#include "model/model.h"

/* Model of the whole scene that computes the part below its mirror planes (mask `axes`, not 0) by the class
 * given and answers for the images too: positions, probes, fields and energies are those of the whole body.
 */
selas_status mirror_create(const struct method *method, const struct scene *scene, unsigned axes,
                           struct model **model, struct messages *messages);

#endif
