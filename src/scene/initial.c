/* The state at t = 0: formulas in initial.h and doc/theory/initial-states.md (Eqs 1-3). */
#include "scene/initial.h"

#include "scene/ground.h"

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

/* Of P and S waves in the rock at a place of the deck. */
static void speeds_at(const struct scene *scene, const double position[3], double speed[2])
{
    const struct body *body = &scene->body;
    double place[3];
    speed[0] = scene->material[body->material].p_speed;
    speed[1] = scene->material[body->material].s_speed;
    ground_from_deck(body, position, place);
    if (body->layers > 0 || body->blocks > 0 || body->model != NULL) ground_speeds_at(scene, place, speed);
}

void initial_speeds(const struct scene *scene, double speed[2])
{
    const struct initial *initial = &scene->initial;
    const struct body *body = &scene->body;
    double place[3], away = 0;
    for (int c = 0; c < 3; c++)
        place[c] = (body->low[c] + body->high[c]) / 2;
    body_to_deck(body, place, place);
    for (int c = 0; c < 3; c++)
        away += initial->direction[c] * (initial->centre[c] - place[c]);
    for (int c = 0; c < 3; c++)
        place[c] += away * initial->direction[c];
    speeds_at(scene, initial->kind == INITIAL_PLANE_WAVE ? place : initial->centre, speed);
}

double plane_wave_speed(const struct scene *scene)
{
    double speed[2];
    initial_speeds(scene, speed);
    return speed[scene->initial.shear];
}

static void plane_wave(const struct scene *scene, const double position[3], double displacement[3],
                       double velocity[3])
{
    const struct initial *initial = &scene->initial;
    double s = 0;
    for (int c = 0; c < 3; c++)
        s += initial->direction[c] * (position[c] - initial->centre[c]);
    const double value = plane_wave_shape(initial, s, 0);
    double speed[2];
    speeds_at(scene, position, speed);
    const double rate = -speed[initial->shear] * plane_wave_shape(initial, s, 1);
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

/* Held along y and free along x? */
static bool supported(const struct scene *scene, enum face face)
{
    const struct boundary *boundary = &scene->boundary[face];
    double own[3];
    if (!boundary_moves(boundary)) return false;
    body_direction_from_deck(&scene->body, boundary->direction, own);
    return boundary->slip && boundary->amplitude == 0 && fabs(fabs(own[1]) - 1) < 1e-9;
}

enum beam_ends beam_ends_of(const struct scene *scene)
{
    const struct boundary *low = &scene->boundary[FACE_X_LOW], *high = &scene->boundary[FACE_X_HIGH];
    if (boundary_is_fixed(low) && boundary_is_free(high)) return BEAM_CLAMPED_FREE;
    if (boundary_is_fixed(low) && boundary_is_fixed(high)) return BEAM_CLAMPED_CLAMPED;
    if (boundary_is_free(low) && boundary_is_free(high)) return BEAM_FREE_FREE;
    return supported(scene, FACE_X_LOW) && supported(scene, FACE_X_HIGH) ? BEAM_SIMPLY_SUPPORTED : BEAM_ENDS;
}

const char *beam_ends_name(enum beam_ends ends)
{
    static const char *const name[] = {"clamped-free", "clamped-clamped", "simply supported", "free-free"};
    return name[ends];
}

double beam_mode_root(enum beam_ends ends)
{
    static const double root[] = {1.8751040687119611664, 4.7300407448627040260, M_PI, 4.7300407448627040260};
    return ends < BEAM_ENDS ? root[ends] : NAN;
}

static double clamped_free(double k, double kx, double slope, int derivative)
{
    const double m = sin(k) + sinh(k), n = cos(k) + cosh(k);
    const double q = 2 * (cos(k) * sinh(k) - sin(k) * cosh(k));
    if (derivative == 0) return (m * (cos(kx) - cosh(kx)) - n * (sin(kx) - sinh(kx))) / q;
    return slope * (-m * (sin(kx) + sinh(kx)) - n * (cos(kx) - cosh(kx))) / q;
}

/* cosh z - sign cos z - s (sinh z - sign sin z), or its derivative: sign 1 has clamped ends, -1 free ones. */
static double both_ends(double k, double z, double sign, int derivative)
{
    const double s = (cosh(k) - cos(k)) / (sinh(k) - sin(k));
    if (derivative == 0) return cosh(z) - sign * cos(z) - s * (sinh(z) - sign * sin(z));
    return sinh(z) + sign * sin(z) - s * (cosh(z) - sign * cos(z));
}

double beam_mode(enum beam_ends ends, double x, double length, int derivative)
{
    const double k = beam_mode_root(ends), z = k * x / length, slope = derivative == 0 ? 1 : k / length;
    switch (ends) {
    case BEAM_CLAMPED_CLAMPED:
        return slope * both_ends(k, z, 1, derivative) / both_ends(k, k / 2, 1, 0);
    case BEAM_FREE_FREE:
        return slope * both_ends(k, z, -1, derivative) / both_ends(k, 0, -1, 0);
    case BEAM_SIMPLY_SUPPORTED:
        return slope * (derivative == 0 ? sin(z) : cos(z));
    default:
        return clamped_free(k, z, slope, derivative);
    }
}

static void beam_velocity(const struct scene *scene, const double position[3], double velocity[3])
{
    const struct body *body = &scene->body;
    const struct material *material = &scene->material[body->material];
    double place[3], own[3] = {0, 0, 0};
    body_from_deck(body, position, place);
    own[1] = scene->initial.amplitude * sqrt(material->young / material->density) *
             beam_mode(beam_ends_of(scene), place[0] - body->low[0], body->high[0] - body->low[0], 0);
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
