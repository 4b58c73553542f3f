/* What the two targets of points files share: whatever is read makes sense or is refused. */
#ifndef SELAS_FUZZ_CLOUD_H
#define SELAS_FUZZ_CLOUD_H

#include "fuzz.h"

#include "points/cloud.h"

#include <math.h>

static inline void fuzz_cloud(int dimension, char *path)
{
    struct messages messages = {0};
    struct scene scene = {.dimension = dimension};
    struct cloud *cloud = NULL;
    scene.body = (struct body){.shape = BODY_POINTS, .high = {1, 1, 1}, .spacing = 0.1, .file = path};
    const selas_status status = cloud_read(&scene, &cloud, &messages);
    fuzz_told(status, &messages);
    fuzz_require((status == SELAS_OK) == (cloud != NULL), "a cloud only where there is no error");
    for (size_t i = 0; cloud != NULL && i < cloud->points; i++) {
        const double *x = cloud->position + 3 * i;
        fuzz_require(isfinite(x[0]) && isfinite(x[1]) && isfinite(x[2]), "positions are finite");
        fuzz_require(isfinite(cloud->volume[i]) && cloud->volume[i] > 0, "volumes are above 0");
    }
    for (size_t i = 0; cloud != NULL && i < cloud->elements; i++)
        fuzz_require(fabs(hypot(hypot(cloud->element[i].normal[0], cloud->element[i].normal[1]),
                                cloud->element[i].normal[2]) -
                          1) < 1e-9 &&
                         cloud->element[i].area >= 0,
                     "normals are of length 1, areas not below 0");
    cloud_free(&cloud);
}

#endif
