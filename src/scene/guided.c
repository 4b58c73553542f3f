#include "scene/guided.h"

#include "scene/absorbing_layers.h"
#include "scene/echo.h"
#include "scene/resolution.h"

#include <math.h>

bool faces_guide(const struct scene *scene, int axis)
{
    const struct boundary *low = &scene->boundary[2 * axis], *high = low + 1;
    return !boundary_absorbs(low) && !boundary_absorbs(high) &&
           !(boundary_slides(low) && boundary_slides(high));
}

/* Distance of two faces that guide alike; unlike ones guide like those of a slab twice as thick. */
static double guide_width(const struct scene *scene, int axis)
{
    const struct boundary *low = &scene->boundary[2 * axis], *high = low + 1;
    const bool alike =
        boundary_is_free(low) == boundary_is_free(high) && boundary_slides(low) == boundary_slides(high);
    return (alike ? 1 : 2) * (scene->body.high[axis] - scene->body.low[axis]);
}

/* From a layer's face, of sources of P wavelengths of up to `longest` widths by the ratio of speeds. */
static void take_latest(const struct scene *scene, int axis, int face, double longest, struct guided *latest)
{
    const double width = guide_width(scene, axis), speed = slowest_speed(scene);
    struct extent acts, seen;
    for (size_t k = 0; scene_extent(scene, k, &acts); k++) {
        if (acts.role != EXTENT_ACTS ||
            (isfinite(acts.wavelength) && acts.wavelength * speed > longest * width * scene_fastest(scene)))
            continue;
        for (size_t i = 0; scene_extent(scene, i, &seen); i++) {
            if (seen.role != EXTENT_SEEN) continue;
            const double unit = (width + echo_way(scene, face, &acts, &seen)) / speed;
            const double ways = (fmin(seen.until, scene->end_time) - acts.from) / unit;
            if (ways > latest->ways) *latest = (struct guided){axis, acts.from, unit, ways};
        }
    }
}

static struct guided latest_waves(const struct scene *scene, double longest)
{
    struct guided latest = {0};
    for (int axis = 0; axis < scene->dimension; axis++)
        for (int face = 0; faces_guide(scene, axis) && face < 2 * scene->dimension; face++)
            if (face / 2 != axis && layer_needed(scene, face))
                take_latest(scene, axis, face, longest, &latest);
    return latest;
}

struct guided guided_waves(const struct scene *scene)
{
    static const double longest = 5; /* sources of longer waves hardly excite any near their cutoff */
    return latest_waves(scene, longest);
}

/* Longer waves leave some that grow, too. */
bool guided_briefly(const struct scene *scene)
{
    const double ways = latest_waves(scene, INFINITY).ways;
    return ways > 0 && ways < 4;
}

/* Factor and power of x: what comes back of waves at grazing incidence falls with R of (9). */
struct law {
    double factor, power;
};

static struct law law_of(const struct scene *scene, const struct guided *guided)
{
    static const struct law slight = {.003, 3.2}, much = {.02, 2.1};
    static const double little = 1e-4;
    double most = 0;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const size_t points = face / 2 == guided->axis ? 0 : layer_points(scene, face);
        if (points > 0) most = fmax(most, layer_profile_reflection(scene, face, points));
    }
    return most < little ? slight : much;
}

double guided_error(const struct scene *scene, const struct guided *guided)
{
    static const double most = .4;
    const struct law law = law_of(scene, guided);
    return guided->ways > 0 ? fmin(most, law.factor * pow(guided->ways, law.power)) : 0;
}

double guided_since(const struct scene *scene, const struct guided *guided, double error)
{
    const struct law law = law_of(scene, guided);
    return guided->from + guided->unit * pow(error / law.factor, 1 / law.power);
}
