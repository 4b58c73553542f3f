/* The error law of scene%accuracy for loads on the surface of the ground (doc/verification/accuracy.md,
 * sections 2 and 3).
 *
 * The error at a receiver has, at each frequency, three parts relative to the exact velocity (measured,
 * regress/studies/accuracy/law.sh): that of the load's own field, of the source and the surface, and of the way,
 *
 *   e^2 = (S n^-s (size/r)^q d)^2 + (A kappa^a)^2 + (B kappa^b g r/h)^2,   kappa = omega h / c,          (1)
 *
 * n the points along the load's shortest edge, r the distance, d and g 1 along the axes of the lattice and
 * less between them, c the speed of the surface wave. On the rim of a patch, where stresses are singular, and as
 * near as two thirds of a spacing the first part is of first order; from there on it falls as at the centre,
 *
 *   R (h/a) min(1, 3 h / (2 rim))^4.2,   where that is more.                                            (1a)
 *
 * With V the exact velocity's spectrum the relative L2
 * error of the history is
 *
 *   E(h)^2 = sum e^2 |V|^2 / sum |V|^2.                                                                  (2) */
#include "accuracy/surface.h"

#include "exact/half_space.h"
#include "scene/echo.h"

#include <math.h>

struct law {
    double near, near_order, near_distance, near_diagonal, source, source_order, way, way_order, diagonal;
};
/* Coefficients of (1), fitted by regress/studies/accuracy/law.sh to runs of the default method: nu .1 to .4,
 * 3 to 10 points along the load's edge, receivers up to two edges away; errors predicted within a factor
 * of 1.36 (r.m.s.). */
static const struct law plain = {16.3, 5.22, 2.54, 1, 0.0068, 5.95, 0.000861, 3.41, 0.29};
/* The same for layered ground without absorbing layers, where splines of degree 4 are tuned; layers of
 * thickness .5 to 1, waves 1.5 and 2 times as fast below, 5 to 10 points along the edge; within a factor
 * of 1.48. */
static const struct law tuned = {61.3, 5.05, 2.74, 0.12, 0.000202, 6.44, 5.74e-6, 8.55, 0.12};
/* What a frequency that the lattice cannot carry errs, relative. */
static const double LARGEST = 1.22;
static const double RIM = .2, RIM_REACH = 1.5, RIM_ORDER = 4.2; /* (1a) */
static const double BURIED = 0.6; /* receivers in the ground err less (measured) */
/* A surface wave feels the ground down to some wavelengths: its slowness is the mean of the layers', each
 * weighted by exp(-depth / (FELT wavelength)) over its depth. */
static const double FELT = 0.5;

static void add_layer(struct surface_ground *ground, const struct material *material, double top)
{
    struct half_space here;
    half_space_set(&here, material->density, material->lambda, material->mu);
    ground->rayleigh_speed = fmin(ground->rayleigh_speed, here.rayleigh_speed);
    ground->p_speed = fmax(ground->p_speed, here.p_speed);
    if (ground->layers == SURFACE_LAYERS) return;
    ground->top[ground->layers] = top;
    ground->slowness[ground->layers++] = 1 / here.rayleigh_speed;
}

struct surface_ground surface_ground_of(const struct scene *scene, double spacing)
{
    const struct body *body = &scene->body;
    struct surface_ground ground = {.rayleigh_speed = INFINITY};
    if (body->layers == 0 || body->layer[0].top > 0) add_layer(&ground, scene_material_at(scene, 0), 0);
    for (size_t k = 0; k < body->layers; k++)
        add_layer(&ground, &scene->material[body->layer[k].material], body->layer[k].top);
    ground.tuned = ground.layers > 1 && !(body->most_stretch > 1);
    for (int face = 0; face <= FACE_Z_HIGH; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (!boundary_has_layer(boundary)) continue;
        if (boundary->always || echo_seen(scene, face, 4 * spacing)) ground.tuned = false;
    }
    return ground;
}

/* Speed of the surface wave of a frequency. */
static double surface_speed(const struct surface_ground *ground, double omega)
{
    enum { ROUNDS = 6 };
    double mean = ground->slowness[0];
    for (int round = 0; round < ROUNDS && ground->layers > 1; round++) {
        const double felt = FELT * 2 * M_PI / (omega * mean);
        mean = ground->slowness[ground->layers - 1];
        for (size_t k = ground->layers - 1; k > 0; k--)
            mean += (ground->slowness[k - 1] - ground->slowness[k]) * (1 - exp(-ground->top[k] / felt));
    }
    return 1 / mean;
}

double surface_error(const struct surface_place *place, double h, double end_time,
                     const struct surface_ground *ground)
{
    const struct law *law = ground->tuned ? &tuned : &plain;
    const double field = law->near * pow(h / place->size, law->near_order) *
                         pow(fmin(1, place->size / place->distance), law->near_distance) *
                         (1 - place->diagonal * (1 - law->near_diagonal));
    const double rim = RIM * h / place->size * pow(fmin(1, RIM_REACH * h / place->rim), RIM_ORDER);
    const double near = fmax(field, rim);
    const double way = law->way * place->distance / h * (1 - place->diagonal * (1 - law->diagonal));
    const double step = 2 * M_PI / (1.25 * end_time);
    double error = 0, whole = 0;
    for (int j = 1; j <= SURFACE_ROWS / 2; j++) {
        const double kappa = j * step * h / surface_speed(ground, j * step);
        const double source = law->source * pow(kappa, law->source_order);
        const double path = way * pow(kappa, law->way_order);
        error += place->power[j] * fmin(near * near + source * source + path * path, LARGEST * LARGEST);
        whole += place->power[j];
    }
    const double law_error =
        place->factor * sqrt(error / whole) * (place->depth > .5 * place->size ? BURIED : 1);
    if (h >= place->tried) return law_error;
    return fmax(law_error, place->reached * pow(h / place->tried, place->order));
}
