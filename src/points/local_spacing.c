/* The spacing of points from place to place, where it is graded. */
#include "points/cloud.h"
#include "points/neighbours.h"

#include "base/memory.h"

#include <math.h>

static double own_spacing(const struct cloud *cloud, size_t i)
{
    return pow(cloud->volume[i], 1.0 / cloud->dimension);
}

static void smooth(const struct cloud *cloud, const struct neighbours *near, uint32_t *index, double *spacing)
{
    static const double reach = 3;
    for (size_t i = 0; i < cloud->points; i++) {
        const size_t count = neighbours_within(near, cloud->position + 3 * i, reach * own_spacing(cloud, i),
                                               cloud->points, index);
        double volume = 0;
        for (size_t k = 0; k < count; k++)
            volume += cloud->volume[index[k]];
        spacing[i] = count > 0 ? pow(volume / (double)count, 1.0 / cloud->dimension) : own_spacing(cloud, i);
    }
}

selas_status cloud_local_spacing(const struct cloud *cloud, double *spacing, struct messages *messages)
{
    struct neighbours near = {0};
    uint32_t *index = array_new(cloud->points, sizeof *index);
    double radius = INFINITY;
    for (size_t i = 0; i < cloud->points; i++)
        radius = fmin(radius, 3 * own_spacing(cloud, i));
    selas_status status = index != NULL
                              ? neighbours_cells(&near, cloud->dimension, cloud->points, cloud->position,
                                                 fmax(radius, cloud->spacing), messages)
                              : fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", cloud->points);
    if (status == SELAS_OK) smooth(cloud, &near, index, spacing);
    neighbours_free(&near);
    array_free(index);
    return status;
}

double cloud_mean_power(const struct cloud *cloud, double order)
{
    double sum = 0, volume = 0;
    if (cloud->all != NULL && order == 2) return cloud->all->square;
    for (size_t i = 0; i < cloud->points; i++) {
        sum += cloud->volume[i] * pow(own_spacing(cloud, i) / cloud->spacing, order);
        volume += cloud->volume[i];
    }
    return sum / volume;
}
