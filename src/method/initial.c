/* The state at t = 0:
 *   uniform velocity   v = velocity
 *   beam mode          v_y = amplitude c0 (M (cos kx - cosh kx) - N (sin kx - sinh kx)) / Q, c0 = sqrt(E /
 * rho) (He & Seaid 2016, Eq 30; x along the body's x axis from its low end, y the body's y axis) plane wave
 * u = amplitude p sin(k (n.x - c t)), k = 2 pi / wavelength, p = n for P waves Gaussian           u =
 * amplitude p exp(-r^2 / (2 width^2)) */
#include "method/initial.h"

#include <math.h>
#include <string.h>

double beam_mode(double x, double length)
{
    const double k = BEAM_MODE_ROOT, kx = k * x / length;
    const double m = sin(k) + sinh(k), n = cos(k) + cosh(k);
    const double q = 2 * (cos(k) * sinh(k) - sin(k) * cosh(k));
    return (m * (cos(kx) - cosh(kx)) - n * (sin(kx) - sinh(kx))) / q;
}

static void beam_velocity(const struct scene *scene, const double *position, double *velocity)
{
    const struct body *body = &scene->body;
    const struct material *material = &scene->material[body->material];
    double place[3], own[3] = {0};
    body_from_deck(body, position, place);
    own[1] = scene->initial.amplitude * sqrt(material->young / material->density) *
             beam_mode(place[0] - body->low[0], body->high[0] - body->low[0]);
    body_direction_to_deck(body, own, velocity);
}

static void plane_wave(const struct scene *scene, const double *position, double *displacement,
                       double *velocity)
{
    const struct initial *initial = &scene->initial;
    const struct material *material = &scene->material[scene->body.material];
    const double speed = initial->shear ? material->s_speed : material->p_speed;
    const double *motion = initial->shear ? initial->polarisation : initial->direction;
    const double k = 2 * M_PI / initial->wavelength;
    double phase = 0;
    for (int a = 0; a < 3; a++)
        phase += k * initial->direction[a] * position[a];
    for (int a = 0; a < 3; a++) {
        displacement[a] = initial->amplitude * motion[a] * sin(phase);
        velocity[a] = -initial->amplitude * motion[a] * k * speed * cos(phase);
    }
}

static void gaussian(const struct initial *initial, const double *position, double *displacement)
{
    double square = 0;
    for (int a = 0; a < 3; a++)
        square += (position[a] - initial->centre[a]) * (position[a] - initial->centre[a]);
    const double value = initial->amplitude * exp(-square / (2 * initial->width * initial->width));
    for (int a = 0; a < 3; a++)
        displacement[a] = value * initial->direction[a];
}

void initial_at(const struct scene *scene, const double position[3], double displacement[3],
                double velocity[3])
{
    memset(displacement, 0, 3 * sizeof *displacement);
    memset(velocity, 0, 3 * sizeof *velocity);
    switch (scene->initial.kind) {
    case INITIAL_REST:
        break;
    case INITIAL_UNIFORM_VELOCITY:
        memcpy(velocity, scene->initial.velocity, 3 * sizeof *velocity);
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
