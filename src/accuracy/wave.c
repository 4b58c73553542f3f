/* scene%accuracy for plane waves in bars and boxes by the consistent method (doc/verification/accuracy.md, section 5).
 *
 * What the lattice and the scheme make of a wave of frequency omega is known (doc/theory/consistent-splines.md,
 * section 11): it travels as with the speed c (1 + e(omega)). To first order the error of a history is
 * therefore
 *
 *   d = F^-1 [ e(omega) F q ],   q = dv / d ln c,                                                        (1)
 *
 * F the Fourier transform, v the exact velocity at the receiver, q its change with the speed of waves at the
 * same impedance: travel time times rate of change, arrival by arrival. e is bounded where (1) would make more
 * of a wave than sqrt(2), what it errs when it arrives at any time. */
#include "accuracy/arrivals.h"
#include "accuracy/kinds.h"
#include "base/memory.h"
#include "scene/ground.h"
#include "scene/initial.h"

#include <math.h>
#include <stdio.h>

static bool looks_like(const struct scene *scene)
{
    if (scene->body.shape != BODY_BOX) return false;
    if (scene->initial.kind == INITIAL_PLANE_WAVE || scene->dimension == 1) return true;
    for (int face = 0; face < BOX_FACES; face++)
        if (boundary_moves(&scene->boundary[face]) && scene->boundary[face].amplitude != 0) return true;
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].shape == LOAD_FACE) return true;
    return false;
}

static const char *refusal(const struct scene *scene)
{
    if (scene->receivers == 0) return "scenes with receivers, where the error is taken";
    if (scene->body.layers > 0 || ground_is_general(scene)) return "plane waves in a body of one rock";
    if (scene->initial.kind == INITIAL_PLANE_WAVE) {
        double direction[3];
        body_direction_from_deck(&scene->body, scene->initial.direction, direction);
        const double most = fmax(fabs(direction[0]), fmax(fabs(direction[1]), fabs(direction[2])));
        if (scene->initial.wavelength > 0 || most < 1 - 1e-9)
            return "plane pulses (width, not wavelength) along an axis of the body";
    }
    if ((scene_needs(scene) & ~(unsigned)(CAN_HOLD | CAN_MOVE | CAN_MIRROR | CAN_DAMP)) != 0)
        return "plane waves between faces without absorbing layers (layer = 'lysmer')";
    return NULL;
}

/* --- The choice -------------------------------------------------------------------------------------------
 */

/* Direction and motion of the wave: those of the initial one, or along the axis across the face that sends.
 */
static void set_direction(const struct scene *scene, struct lattice_wave *wave)
{
    const double *motion = NULL;
    int axis = 0;
    const struct material *material = &scene->material[scene->body.material];
    wave->speed = material->p_speed;
    if (scene->initial.kind == INITIAL_PLANE_WAVE) {
        body_direction_from_deck(&scene->body, scene->initial.direction, wave->direction);
        body_direction_from_deck(&scene->body, scene->initial.polarisation, wave->motion);
        wave->speed = plane_wave_speed(scene);
        return;
    }
    for (int face = 0; face < 2 * scene->dimension && motion == NULL; face++)
        if (boundary_moves(&scene->boundary[face]) && scene->boundary[face].amplitude != 0) {
            motion = scene->boundary[face].direction;
            axis = face / 2;
        }
    if (motion == NULL && scene->loads > 0) {
        motion = scene->load[0].direction;
        axis = face_axis(scene->load[0].face);
    }
    wave->direction[axis] = 1;
    if (scene->dimension == 1 || motion == NULL)
        wave->motion[axis] = 1;
    else
        body_direction_from_deck(&scene->body, motion, wave->motion);
    if (fabs(wave->motion[axis]) < .5) wave->speed = material->s_speed;
}

/* True if what a damper at an end sends back is seen: from the middle of the initial wave, or from the other
 * end, to the damper and on to the receiver before the end. */
static bool sees_damper(const struct lattice_wave *wave, const struct arrivals *place)
{
    const struct scene *scene = wave->scene;
    double centre[3];
    body_from_deck(&scene->body, scene->initial.centre, centre);
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const int axis = face / 2;
        if (!boundary_damps(&scene->boundary[face]) || fabs(wave->direction[axis]) < .999) continue;
        const double ends[2] = {scene->body.low[axis], scene->body.high[axis]}, end = ends[face % 2];
        const double start = scene->initial.kind == INITIAL_REST ? ends[1 - face % 2] : centre[axis];
        const double first = place->middle - fabs(place->position[axis] - start) / wave->speed;
        const double way = fabs(end - start) + fabs(end - place->position[axis]);
        const double begun = scene->initial.kind == INITIAL_REST ? fmax(0, first) : 0;
        if (begun + way / wave->speed < scene->end_time) return true;
    }
    return false;
}

/* Reflections at held ends on the mean way of what arrives, and the sending out by a moving one. */
static double held_ends(const struct lattice_wave *wave, const struct arrivals *place)
{
    const struct scene *scene = wave->scene;
    double held = 0;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        const int axis = face / 2;
        const bool roller = boundary_slides(boundary) && !boundary_mirrors(boundary);
        if (fabs(wave->direction[axis]) < .999) continue;
        if (!boundary_is_fixed(boundary) && !boundary_moves(boundary) &&
            !(roller && fabs(wave->motion[axis]) > .5))
            continue;
        held += wave->speed * place->travel / (2 * (scene->body.high[axis] - scene->body.low[axis]));
        if (boundary_moves(boundary) && boundary->amplitude != 0) held++;
    }
    return held;
}

static double worst(const struct lattice_wave *wave, const struct arrivals *place, double spacing,
                    double *work)
{
    double most = 0, *speed = work + 2 * ARRIVAL_ROWS;
    for (int j = 0; j < ARRIVAL_ROWS; j++)
        speed[j] =
            lattice_speed_error(wave, spacing, M_PI * (j + 1) / ((ARRIVAL_ROWS + 1) * place->time_step));
    for (size_t k = 0; k < wave->scene->receivers; k++)
        most = fmax(most, arrivals_error(wave, &place[k], spacing, speed, work));
    return most;
}

/* Splines between two symmetry planes need more cells than others. */
static double least_cells(const struct lattice_wave *wave)
{
    enum { FEWEST = 3 };
    for (int c = 0; c < wave->scene->dimension; c++)
        if (boundary_mirrors(&wave->scene->boundary[2 * c]) &&
            boundary_mirrors(&wave->scene->boundary[2 * c + 1]))
            return 2 * wave->setting->degree + 1;
    return FEWEST;
}

/* Faces that are held along themselves and slip across need the exact mass in three dimensions. */
static bool slips(const struct scene *scene)
{
    for (int face = 0; face < 2 * scene->dimension; face++)
        if (scene->boundary[face].slip && scene->dimension == 3) return true;
    return false;
}

/* Largest spacing that divides the box's edges and errs little enough; 0 if there is none. Looks for it in
 * large steps, then between the last two. */
static double enough(const struct lattice_wave *wave, const struct arrivals *place, double accuracy,
                     double *work, double *error)
{
    static const double coarse = 1.15, fine = 1.02, finest = 20000;
    const struct body *body = &wave->scene->body;
    const int dimension = wave->scene->dimension;
    double shortest = INFINITY, found = 0, last = INFINITY;
    for (int c = 0; c < dimension; c++)
        shortest = fmin(shortest, body->high[c] - body->low[c]);
    double h = dividing_spacing(body, dimension, shortest / least_cells(wave));
    while (h > shortest / finest) {
        *error = worst(wave, place, h, work);
        found = h;
        if (*error <= ACCURACY_AIM * accuracy) break;
        last = h;
        h = dividing_spacing(body, dimension, h / coarse);
    }
    if (!(h > shortest / finest)) return 0;
    h = isfinite(last) ? dividing_spacing(body, dimension, last / fine) : 0;
    while (h > found * (1 + 1e-9)) {
        const double here = worst(wave, place, h, work), most = ACCURACY_MOST * accuracy;
        if (here <= most && (here <= ACCURACY_AIM * accuracy || *error <= ACCURACY_LEAST * accuracy)) {
            *error = here;
            return h;
        }
        h = dividing_spacing(body, dimension, h / fine);
    }
    return found;
}

static double work_of(const struct lattice_wave *wave, double spacing)
{
    const struct body *body = &wave->scene->body;
    double work = wave->setting->cost / wave->setting->courant[wave->scene->dimension - 1] / spacing;
    for (int c = 0; c < wave->scene->dimension; c++)
        work *= (body->high[c] - body->low[c]) / spacing + wave->setting->degree;
    return work;
}

static selas_status choose_setting(const struct scene *scene, struct arrivals *place, double accuracy,
                                   double *work, struct scene_choice *choice, struct messages *messages)
{
    double least = INFINITY;
    for (int s = 0; s < ACCURACY_SETTINGS; s++) {
        const struct accuracy_setting *setting = &accuracy_settings[s];
        struct lattice_wave wave = {.scene = scene};
        double error = 0;
        if (setting->sweeps > 0 && slips(scene)) continue;
        set_direction(scene, &wave);
        lattice_wave_set(&wave, setting);
        for (size_t k = 0; k < scene->receivers; k++) {
            place[k].damped = sees_damper(&wave, &place[k]);
            place[k].held = held_ends(&wave, &place[k]);
        }
        const double spacing = enough(&wave, place, accuracy, work, &error);
        if (!(spacing > 0) || !(work_of(&wave, spacing) < least)) continue;
        least = work_of(&wave, spacing);
        choice->spacing = spacing;
        choice->degree = setting->degree;
        choice->sweeps = setting->sweeps;
        choice->scheme = setting->scheme;
        choice->courant = wave.transformed ? 0 : setting->courant[scene->dimension - 1];
        snprintf(choice->text, sizeof choice->text,
                 "%g wanted: spacing %.6g, degree %d, mass %s, %s%s; predicted error %.2g", accuracy, spacing,
                 choice->degree, choice->sweeps > 0 ? "vc3" : "exact", choice->scheme,
                 wave.transformed ? " with the time-dispersion transform" : "", error);
    }
    if (isfinite(least)) return SELAS_OK;
    return fail(
        messages, SELAS_BAD_SCENE,
        "scene%%accuracy = %g is out of reach here: no spacing that divides every edge of the box does it; "
        "change low or high, or give body%%spacing",
        accuracy);
}

/* An initial wave must not begin with a jump of stress or velocity at the ends that it runs to and from: what
 * starts there is no smooth wave. */
static bool begins_smoothly(const struct scene *scene, double accuracy)
{
    static const double little = .1;
    const struct initial *initial = &scene->initial;
    double centre[3], direction[3];
    if (initial->kind != INITIAL_PLANE_WAVE) return true;
    body_from_deck(&scene->body, initial->centre, centre);
    body_direction_from_deck(&scene->body, initial->direction, direction);
    const double most = initial->amplitude / initial->width * exp(-.5);
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const int axis = face / 2;
        if (fabs(direction[axis]) < .999) continue;
        const bool leaves = direction[axis] * face_sign((enum face)face) > 0;
        const double end = face_plane(&scene->body, (enum face)face);
        const double slope = plane_wave_shape(initial, (end - centre[axis]) * direction[axis], 1);
        if (leaves && boundary_damps(&scene->boundary[face])) continue;
        if (fabs(slope) > little * accuracy * fabs(most)) return false;
    }
    return true;
}

static bool known_exactly(const struct scene *scene)
{
    struct exact *exact = NULL;
    struct messages unsaid = {0};
    const bool known = exact_find("plane-wave")->create(scene, &exact, &unsaid) == SELAS_OK;
    exact_free(&exact);
    messages_free(&unsaid);
    return known;
}

static selas_status choose(const struct scene *scene, double accuracy, const struct trial *trial,
                           struct scene_choice *choice, struct messages *messages)
{
    (void)trial;
    static const double seen = .1;
    if (!begins_smoothly(scene, accuracy))
        return fail(
            messages, SELAS_BAD_SCENE,
            "scene%%accuracy: the initial wave has stress and velocity at an end of the body, where that "
            "begins with a jump; no such error is predicted: move its centre, or give body%%spacing");
    struct arrivals *place = NULL;
    double *work = array_new(3 * ARRIVAL_ROWS, sizeof *work);
    selas_status status = work == NULL ? fail(messages, SELAS_NO_MEMORY, "no memory for scene%%accuracy")
                                       : arrivals_create(scene, &place, messages);
    for (size_t k = 0; place != NULL && k < scene->receivers && status == SELAS_OK; k++)
        if (fabs(place[k].velocity[0]) > seen * place[k].largest)
            status = fail(messages, SELAS_BAD_SCENE,
                          "scene%%accuracy: receiver '%s' is in the initial wave already at t = 0, where no "
                          "error is predicted; move it on, or give body%%spacing",
                          scene->receiver[k].name);
    if (place != NULL && status == SELAS_OK)
        status = choose_setting(scene, place, accuracy, work, choice, messages);
    if (status == SELAS_OK && known_exactly(scene)) choice->exact = "plane-wave";
    array_free(work);
    arrivals_free(&place);
    return status;
}

const struct accuracy_kind accuracy_wave = {
    .looks_like = looks_like,
    .variant = "consistent",
    .served = "method 'smoothed-point', variant 'consistent'",
    .refusal = refusal,
    .choose = choose,
    .velocity = true,
};
