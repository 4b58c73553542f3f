/* The state at t = 0: formulas in initial.h and doc/scene.md (Eqs 12-16). */
#include "scene/initial.h"

#include <math.h>

double plane_wave_shape(const struct initial *initial, double s, int derivative)
{
    if (initial->wavelength > 0) {
        const double k = 2 * M_PI / initial->wavelength;
        return initial->amplitude * (derivative == 0 ? sin(k * s) : k * cos(k * s));
    }
    const double r = s / initial->width, value = initial->amplitude * exp(-r * r / 2);
    return derivative == 0 ? value : -r / initial->width * value;
}

double plane_wave_speed(const struct scene *scene)
{
    const struct material *material = &scene->material[scene->body.material];
    return scene->initial.shear ? material->s_speed : material->p_speed;
}

static void plane_wave(const struct scene *scene, const double position[3], double displacement[3],
                       double velocity[3])
{
    const struct initial *initial = &scene->initial;
    double s = 0;
    for (int c = 0; c < 3; c++)
        s += initial->direction[c] * (position[c] - initial->centre[c]);
    const double value = plane_wave_shape(initial, s, 0);
    const double rate = -plane_wave_speed(scene) * plane_wave_shape(initial, s, 1);
    for (int c = 0; c < 3; c++) {
        displacement[c] = value * initial->polarisation[c];
        velocity[c] = rate * initial->polarisation[c];
    }
}

static void gaussian(const struct initial *initial, const double position[3], double displacement[3])
{
    double square = 0;
    for (int c = 0; c < 3; c++) {
        const double r = (position[c] - initial->centre[c]) / initial->width;
        square += r * r;
    }
    for (int c = 0; c < 3; c++)
        displacement[c] = initial->amplitude * exp(-square / 2) * initial->direction[c];
}

double beam_mode(double x, double length)
{
    const double k = BEAM_MODE_ROOT, kx = k * x / length;
    const double m = sin(k) + sinh(k), n = cos(k) + cosh(k);
    const double q = 2 * (cos(k) * sinh(k) - sin(k) * cosh(k));
    return (m * (cos(kx) - cosh(kx)) - n * (sin(kx) - sinh(kx))) / q;
}

static void beam_velocity(const struct scene *scene, const double position[3], double velocity[3])
{
    const struct body *body = &scene->body;
    const struct material *material = &scene->material[body->material];
    double place[3], own[3] = {0, 0, 0};
    body_from_deck(body, position, place);
    own[1] = scene->initial.amplitude * sqrt(material->young / material->density) *
             beam_mode(place[0] - body->low[0], body->high[0] - body->low[0]);
    body_direction_to_deck(body, own, velocity);
}

void initial_at(const struct scene *scene, const double position[3], double displacement[3],
                double velocity[3])
{
    for (int c = 0; c < 3; c++)
        displacement[c] = velocity[c] = 0;
    switch (scene->initial.kind) {
    case INITIAL_REST:
        break;
    case INITIAL_UNIFORM_VELOCITY:
        for (int c = 0; c < 3; c++)
            velocity[c] = scene->initial.velocity[c];
        break;
    case INITIAL_BEAM_MODE:
        beam_velocity(scene, position, velocity);
        break;
    case INITIAL_PLANE_WAVE:
        plane_wave(scene, position, displacement, velocity);
        break;
    case INITIAL_GAUSSIAN:
        gaussian(&scene->initial, position, displacement);
        break;
    }
}
