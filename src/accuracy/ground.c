/* The spacing that scene%accuracy leads to on half-spaces and boxes of ground (doc/accuracy.md, sections 2 to
 * 4): the largest one for which the error law of surface.c, with the exact velocity's spectrum,
 * gives AIM times the wanted error at every receiver. */
#include "scene/ground.h"
#include "accuracy/kinds.h"
#include "accuracy/outlook.h"
#include "accuracy/surface.h"
#include "base/fft_room.h"
#include "base/memory.h"
#include "exact/half_space.h"
#include "exact/lamb.h"
#include "scene/echo.h"

#include <fftw3.h>
#include <math.h>
#include <stdio.h>

static const double SLOWLY = 1.1;
enum { ROWS = SURFACE_ROWS };

/* The faces of a box that stands for a half-space: the loaded one free, the others mirrors, absorbing layers
 * or so far away that what they send back is too late. */
static const char *faces_refusal(const struct scene *scene)
{
    struct scene seen = *scene;
    seen.snapshots = 0; /* the error is that at the receivers */
    if (!boundary_is_free(&scene->boundary[FACE_Z_LOW])) return "half-spaces with a free surface";
    for (int face = 0; face < FACE_Z_HIGH + 1; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (face == FACE_Z_LOW || boundary_mirrors(boundary) || boundary_has_layer(boundary)) continue;
        if (scene->body.absorbing && !boundary->given) continue;
        if (!scene->body.chosen && echo_seen(&seen, face, 0))
            return "boxes with faces that absorb by layers (layer = 'pml'), are symmetry planes, or stand so "
                   "far away that nothing comes back before end_time";
    }
    return NULL;
}

static bool looks_like(const struct scene *scene)
{
    return scene->dimension == 3 && scene->loads > 0 && scene->initial.kind == INITIAL_REST &&
           scene->load[0].shape != LOAD_FACE;
}

static const char *refusal(const struct scene *scene)
{
    if (!body_is_box(&scene->body)) return "half-spaces and boxes";
    if (ground_is_general(scene)) return "level layers of one material each, without &block";
    if (scene->receivers == 0) return "scenes with receivers, where the error is taken";
    for (size_t k = 0; k < scene->loads; k++) {
        if (scene->load[k].shape != LOAD_SQUARE && scene->load[k].shape != LOAD_DISC)
            return "loads on a square or a disc";
        if (load_moves(&scene->load[k])) return "loads that do not move";
    }
    return faces_refusal(scene);
}

/* --- The exact velocity's spectrum -------------------------------------------------------------------- */

static void set_place(const struct scene *scene, const double position[3], struct surface_place *place)
{
    place->distance = INFINITY;
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        double away[3];
        for (int c = 0; c < 3; c++)
            away[c] = position[c] - load->centre[c];
        body_direction_from_deck(&scene->body, away, away);
        const double across = hypot(away[0], away[1]), distance = hypot(across, away[2]);
        if (distance >= place->distance) continue;
        place->distance = distance;
        place->depth = away[2];
        place->size = load->shape == LOAD_DISC ? load->size[0] : fmin(load->size[0], load->size[1]);
        place->diagonal = across > 0 ? .5 - .5 * cos(4 * atan2(away[1], away[0])) : 0;
    }
}

/* |V|^2 of three components; the history goes on for a quarter of its length, fading out, so that its end
 * makes no frequencies. */
static selas_status find_power(struct exact *exact, double end_time, const struct receiver *receiver,
                               double *power, struct messages *messages)
{
    double *time = array_new(ROWS, sizeof *time);
    double *value = array_new((size_t)6 * ROWS, sizeof *value);
    double *in = fftw_malloc(ROWS * sizeof *in);
    fftw_complex *out = fftw_malloc((ROWS / 2 + 1) * sizeof *out);
    selas_status status = SELAS_NO_MEMORY;
    fftw_plan plan = NULL;
    if (time != NULL && value != NULL && in != NULL && out != NULL && fft_room(ROWS)) {
        for (int i = 0; i < ROWS; i++)
            time[i] = 1.25 * end_time / ROWS * i;
        status = exact->class->history(exact, receiver->position, ROWS, time, value, messages);
#pragma omp critical(selas_fftw_planner)
        plan = fftw_plan_dft_r2c_1d(ROWS, in, out, FFTW_ESTIMATE);
    } else {
        fail(messages, status, "no memory for the spectrum of a receiver");
    }
    for (int c = 3; c < 6 && plan != NULL && status == SELAS_OK; c++) {
        for (int i = 0; i < ROWS; i++) {
            const double late = fmax(0, time[i] / end_time - 1) * 4;
            in[i] = value[6 * i + c] * .5 * (1 + cos(M_PI * late));
        }
        fftw_execute(plan);
        for (int j = 0; j <= ROWS / 2; j++)
            power[j] += creal(out[j] * conj(out[j]));
    }
#pragma omp critical(selas_fftw_planner)
    if (plan != NULL) fftw_destroy_plan(plan);
    fftw_free(in);
    fftw_free(out);
    array_free(time);
    array_free(value);
    return status;
}

static double worst(const struct scene *scene, const struct surface_place *place, double h,
                    const struct surface_ground *ground)
{
    double most = 0;
    for (size_t i = 0; i < scene->receivers; i++)
        most = fmax(most, surface_error(&place[i], h, scene->end_time, ground));
    return most;
}

/* P wavelength at the mean frequency of |V|^2, the longest of all receivers. */
static double mean_wavelength(const struct scene *scene, const struct surface_place *place, double p_speed)
{
    double slowest = INFINITY;
    for (size_t i = 0; i < scene->receivers; i++) {
        double first = 0, whole = 0;
        for (int j = 1; j <= ROWS / 2; j++) {
            whole += place[i].power[j];
            first += j * place[i].power[j];
        }
        slowest = fmin(slowest, first / whole * 2 * M_PI / (1.25 * scene->end_time));
    }
    return 2 * M_PI * p_speed / slowest;
}

/* Absorbing layers are as thick as a seventh of the P wavelength that carries most, and have so many points
 * that little enough comes back (measured). */
static long enough_layer_points(double accuracy, double h, double wavelength)
{
    const long points = accuracy >= .02 ? 8 : accuracy >= .005 ? 10 : 12;
    return (long)fmin(fmax((double)points, ceil(LAYER_THICKNESS * wavelength / h)), 40);
}

/* Where the error falls slower than h^2.5 it is that of waves that the lattice cannot carry: a history with
 * kinks. What of them rings on under the load depends on where its rim lies between the knots, and is several
 * times less where the edge is a whole number of spacings (measured): the next smaller one of that kind. */
static double quiet_spacing(const struct scene *scene, const struct surface_place *place, double h,
                            double gain)
{
    double size = INFINITY;
    for (size_t i = 0; i < scene->receivers; i++)
        size = fmin(size, place[i].size);
    if (gain >= pow(SLOWLY, 2.5)) return h;
    if (scene->body.chosen) return size / ceil(size / h - 1e-9);
    double finer = h;
    while (finer > .5 * h) {
        if (fabs(size / finer - round(size / finer)) < 1e-6) return finer;
        finer = dividing_spacing(&scene->body, 3, .999 * finer);
    }
    return h;
}

/* True if the edges of all squares lie on knots, where tuned splines err least. */
static bool rims_on_knots(const struct scene *scene, double h)
{
    for (size_t k = 0; k < scene->loads; k++)
        for (int c = 0; c < 4 && scene->load[k].shape == LOAD_SQUARE; c++) {
            const int axis = c / 2;
            const double edge = scene->load[k].centre[axis] + (c % 2 - .5) * scene->load[k].size[axis];
            const double cells = (edge - scene->body.low[axis]) / h;
            if (cells > 0 && fabs(cells - round(cells)) > 1e-6) return false;
        }
    return true;
}

/* The largest spacing up to h that will do; 0 if there is none. */
static double possible_spacing(const struct scene *scene, const struct surface_ground *ground, double h)
{
    const struct load *load = &scene->load[0];
    if (scene->body.chosen && (!ground->tuned || load->shape != LOAD_SQUARE)) return h;
    if (scene->body.chosen) { /* the lattice stands on the load's centre */
        const double half = .5 * fmin(load->size[0], load->size[1]);
        return half / ceil(half / h - 1e-9);
    }
    const double first = dividing_spacing(&scene->body, 3, h);
    double finer = first;
    while (ground->tuned && finer > .5 * first && !rims_on_knots(scene, finer))
        finer = dividing_spacing(&scene->body, 3, .999 * finer);
    return finer > .5 * first ? finer : first;
}

/* Fails only if no spacing will do. */
static selas_status choose(const struct scene *scene, const struct surface_place *place, double accuracy,
                           struct scene_choice *choice, struct messages *messages)
{
    enum { MOST = 800 };
    static const double finer = 1.01; /* 800 times: 1/2800 */
    double most = INFINITY, error = INFINITY;
    for (size_t k = 0; k < scene->receivers; k++)
        most = fmin(most, place[k].size / 2); /* at least two points along an edge */
    const struct surface_ground ground = surface_ground_of(scene, most);
    most = fmin(most, ground.rayleigh_speed * scene->end_time);
    double h = most, last = INFINITY, last_error = INFINITY;
    for (int i = 0; i < MOST && h > 0 && !(error <= ACCURACY_AIM * accuracy); i++) {
        last = h;
        last_error = error;
        h = possible_spacing(scene, &ground, i > 0 ? h / finer : h);
        error = h > 0 ? worst(scene, place, h, &ground) : INFINITY;
    }
    if (error < ACCURACY_LEAST * accuracy &&
        last_error <= ACCURACY_MOST * accuracy) { /* few spacings divide */
        h = last;
        error = last_error;
    }
    if (!(error <= ACCURACY_MOST * accuracy))
        return fail(messages, SELAS_BAD_SCENE,
                    "scene%%accuracy = %g is out of reach here: a spacing of %.3g would still leave %.2g",
                    accuracy, h, error);
    const double gain = error / worst(scene, place, h / SLOWLY, &ground);
    if (!ground.tuned) h = quiet_spacing(scene, place, h, gain);
    error = worst(scene, place, h, &ground);
    choice->spacing = h;
    choice->layer_points = enough_layer_points(accuracy, h, mean_wavelength(scene, place, ground.p_speed));
    if (ground.layers > 1) {
        choice->degree = ground.tuned ? 4 : 2;
        choice->sweeps = ground.tuned ? 0 : 3;
    }
    snprintf(choice->text, sizeof choice->text,
             "%g wanted: spacing %.6g, %s, leapfrog with the time-dispersion transform; predicted error %.2g",
             accuracy, h, ground.tuned ? "degree 4, mass exact, tuned" : "degree 2, mass vc3", error);
    return SELAS_OK;
}

/* Places and spectra of all receivers; both arrays are array_free()d by the caller, whatever comes back. */
static selas_status find_places(const struct scene *scene, struct surface_place **place, double **power,
                                struct messages *messages)
{
    struct exact *exact = NULL;
    struct scene longer = *scene;
    longer.end_time *= 1.25;
    *place = array_new(scene->receivers, sizeof **place);
    *power = array_new(scene->receivers * (ROWS / 2 + 1), sizeof **power);
    if (*place == NULL || *power == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the spectra at receivers");
    selas_status status = lamb_create_within(&longer, 1e-3, &exact, messages);
    for (size_t i = 0; i < scene->receivers && status == SELAS_OK; i++) {
        (*place)[i].power = *power + i * (ROWS / 2 + 1);
        set_place(scene, scene->receiver[i].position, &(*place)[i]);
        status = find_power(exact, scene->end_time, &scene->receiver[i], (*place)[i].power, messages);
    }
    exact_free(&exact);
    return status;
}

static selas_status choose_for(const struct scene *scene, double accuracy, struct scene_choice *choice,
                               struct messages *messages)
{
    struct surface_place *place = NULL;
    double *power = NULL;
    selas_status status = find_places(scene, &place, &power, messages);
    if (status == SELAS_OK) status = choose(scene, place, accuracy, choice, messages);
    array_free(place);
    array_free(power);
    return status;
}

/* The law is that of degree 2 with three sweeps and open ends, of histories as they are. */
static bool measured_setting(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    return (!deck_given(group, "degree") || deck_integer(group, "degree", 0) == 2) &&
           (!deck_given(group, "mass") || deck_chosen(group, "mass", "vc3")) &&
           !deck_chosen(group, "ends", "mapped") && !(scene->output.low_pass > 0);
}

bool ground_outlook(const struct scene *scene, struct ground_outlook *outlook)
{
    enum { ENOUGH = 8 }; /* receivers looked at: each costs an exact history */
    struct scene few = *scene;
    struct messages unsaid = {0};
    struct surface_place *place = NULL;
    double *power = NULL;
    bool known = false;
    if (!looks_like(scene) || accuracy_refusal(&accuracy_ground, scene) != NULL) return false;
    if (!measured_setting(scene)) return false;
    if (scene->body.layers > 0) return false; /* exact histories take seconds there */
    if (few.receivers > ENOUGH) few.receivers = ENOUGH;
    if (find_places(&few, &place, &power, &unsaid) == SELAS_OK) {
        const double h = scene->body.spacing;
        const struct surface_ground ground = surface_ground_of(scene, h);
        outlook->error = worst(&few, place, h, &ground);
        outlook->wavelength = mean_wavelength(&few, place, ground.p_speed);
        outlook->layer_points = enough_layer_points(outlook->error / ACCURACY_AIM, h, outlook->wavelength);
        known = isfinite(outlook->error) && isfinite(outlook->wavelength);
    }
    array_free(place);
    array_free(power);
    messages_free(&unsaid);
    return known;
}

const struct accuracy_kind accuracy_ground = {
    .looks_like = looks_like,
    .variant = "consistent",
    .served = "method 'smoothed-point', variant 'consistent'",
    .refusal = refusal,
    .choose = choose_for,
};
