/* The swinging beam of He & Seaid 2016, section 4.2: v_y = V_f c0 f(x) cos(w t), f of their Eq 30, with the
 * best frequency known for the scene. It is a reference for the fundamental mode: the start is Euler and
 * Bernoulli's mode, so a true beam also rings a little in higher ones. */
#include "exact/beam.h"

#include "base/memory.h"
#include "exact/frequency.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct solution {
    struct exact exact;
    struct beam beam;
    double frequency, speed; /* c0 V_f: velocity scale */
    const char *theory;
};

static double fundamental(const struct beam *beam)
{
    return beam_mode_root(beam->ends) / beam->length;
}

double beam_euler_bernoulli(const struct beam *beam)
{
    const double kappa = fundamental(beam);
    return kappa * kappa * sqrt(beam->young * beam->width * beam->width / (12 * beam->density));
}

/* e = exp(a) of 4 x 4 matrices in rows: the series of a / 2^HALVES, squared HALVES times. */
static void exponential(const double a[16], double e[16])
{
    enum { HALVES = 8, TERMS = 12 };
    double term[16], next[16];
    for (int k = 0; k < 16; k++)
        e[k] = term[k] = k % 5 == 0;
    for (int pass = 1; pass < TERMS + HALVES; pass++) {
        const bool series = pass < TERMS;
        for (int i = 0; i < 4; i++)
            for (int j = 0; j < 4; j++) {
                double sum = 0;
                for (int k = 0; k < 4; k++)
                    sum += series ? term[4 * i + k] * ldexp(a[4 * k + j], -HALVES) / pass
                                  : e[4 * i + k] * e[4 * k + j];
                next[4 * i + j] = sum;
            }
        memcpy(series ? term : e, next, sizeof next);
        for (int k = 0; series && k < 16; k++)
            e[k] += term[k];
    }
}

/* Timoshenko's equations for (w, psi, M, Q) with harmonic motion, lengths in L and per unit of depth:
 *   w' = psi + Q / (k G A),  psi' = M / (E I),  M' = -Q - rho I w^2 psi,  Q' = -rho A w^2 w.
 * Two of the four are 0 at each end: clamped w = psi = 0, free M = Q = 0, supported w = M = 0. The determinant of the
 * block of exp(matrix L) that takes those which are not 0 at x = 0 to those which must be 0 at L. */
static double determinant(const struct beam *beam, double frequency)
{
    const double area = beam->width;
    const double inertia = area * area * area / 12;
    const double factor = 10 * (1 + beam->poisson) / (12 + 11 * beam->poisson);
    const double square = beam->density * frequency * frequency;
    double a[16] = {0,
                    1,
                    0,
                    1 / (factor * beam->shear * area),
                    0,
                    0,
                    1 / (beam->young * inertia),
                    0,
                    0,
                    -square * inertia,
                    0,
                    -1,
                    -square * area,
                    0,
                    0,
                    0};
    /* same units for all four: M and Q per E I / L and E I / L^2 */
    const double scale[4] = {beam->length, 1, beam->young * inertia / beam->length,
                             beam->young * inertia / (beam->length * beam->length)};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 4; j++)
            a[4 * i + j] *= beam->length * scale[j] / scale[i];
    static const int given[BEAM_ENDS][2] = {{2, 3}, {2, 3}, {1, 3}, {0, 1}};  /* not 0 at x = 0 */
    static const int vanish[BEAM_ENDS][2] = {{2, 3}, {0, 1}, {0, 2}, {2, 3}}; /* 0 at x = L */
    const int *column = given[beam->ends], *row = vanish[beam->ends];
    double e[16];
    exponential(a, e);
    return e[row[0] * 4 + column[0]] * e[row[1] * 4 + column[1]] -
           e[row[0] * 4 + column[1]] * e[row[1] * 4 + column[0]];
}

double beam_timoshenko(const struct beam *beam)
{
    double high = beam_euler_bernoulli(beam);
    double low = 0.3 * high; /* slender beams are a little, stout ones much below */
    const double sign = determinant(beam, high);
    while (high - low > 1e-13 * high) {
        const double middle = 0.5 * (low + high);
        if (determinant(beam, middle) * sign > 0)
            high = middle;
        else
            low = middle;
    }
    return 0.5 * (low + high);
}

struct beam beam_of(const struct scene *scene)
{
    const struct material *material = &scene->material[scene->body.material];
    const bool strain = scene->dimension == 2 && scene->plane == PLANE_STRAIN;
    return (struct beam){.length = scene->body.high[0] - scene->body.low[0],
                         .width = scene->body.high[1] - scene->body.low[1],
                         .young = material->young / (strain ? 1 - material->poisson * material->poisson : 1),
                         .shear = material->mu,
                         .density = material->density,
                         .poisson = material->poisson,
                         .ends = beam_ends_of(scene)};
}

double beam_plane(const struct scene *scene)
{
    /* w L / c0, c0 = sqrt(E / rho): magnesium L .5, W .1 and .05; the strip of Gray et al. 2001, L .2, W .02
     */
    static const struct {
        enum plane plane;
        double ratio, poisson, frequency;
    } known[] = {{PLANE_STRESS, 5, .35, 2008.3 * .5 / 5088.401487},
                 {PLANE_STRESS, 10, .35, 1026.2 * .5 / 5088.401487},
                 {PLANE_STRAIN, 5, .35, 2144.7 * .5 / 5088.401487},
                 {PLANE_STRAIN, 10, .35, 1096.7 * .5 / 5088.401487},
                 {PLANE_STRESS, 10, .3975, 22.55 * .2 / 44.721360}};
    const struct material *material = &scene->material[scene->body.material];
    const struct beam beam = beam_of(scene);
    if (scene->dimension != 2 || beam.ends != BEAM_CLAMPED_FREE) return 0;
    for (size_t k = 0; k < sizeof known / sizeof *known; k++)
        if (scene->plane == known[k].plane && fabs(beam.length / beam.width - known[k].ratio) < 1e-6 &&
            fabs(material->poisson - known[k].poisson) < 1e-6)
            return known[k].frequency * sqrt(material->young / material->density) / beam.length;
    return 0;
}

/* Does a face keep the beam from bending, or take energy from it? */
static bool hinders(const struct scene *scene, int face)
{
    const struct boundary *boundary = &scene->boundary[face];
    const int axis = face_axis((enum face)face);
    return axis > 0 && !boundary_is_free(boundary) && (axis == 1 || !boundary_slides(boundary));
}

static selas_status create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    *exact = NULL;
    bool free = true;
    for (int face = 0; face < 2 * scene->dimension; face++)
        free = free && !hinders(scene, face);
    if (scene->dimension == 1 || scene->body.shape != BODY_BOX || scene->initial.kind != INITIAL_BEAM_MODE ||
        beam_ends_of(scene) == BEAM_ENDS || scene->loads > 0 || !free)
        return fail(
            messages, SELAS_BAD_SCENE,
            "reference 'beam' needs a box in 2D or 3D without loads, started by &initial kind = 'beam-mode', "
            "held at 'x-' and 'x+' alone: clamped-free, clamped-clamped, simply supported or free-free");
    struct solution *solution = array_new(1, sizeof *solution);
    if (solution == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the reference");
    const struct material *material = &scene->material[scene->body.material];
    solution->exact = (struct exact){.class = &exact_beam, .scene = scene};
    solution->beam = beam_of(scene);
    solution->speed = scene->initial.amplitude * sqrt(material->young / material->density);
    solution->frequency = beam_plane(scene);
    solution->theory = "two-dimensional elasticity";
    if (!(solution->frequency > 0)) {
        solution->frequency = beam_timoshenko(&solution->beam);
        solution->theory = "Timoshenko";
    }
    *exact = &solution->exact;
    return SELAS_OK;
}

static void destroy(struct exact *exact)
{
    array_free(exact);
}

static selas_status history(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages)
{
    (void)messages;
    const struct solution *solution = (const struct solution *)exact;
    const struct body *body = &exact->scene->body;
    double own[3];
    body_from_deck(body, position, own);
    const double x = own[0] - body->low[0];
    const double across = own[1] - 0.5 * (body->low[1] + body->high[1]);
    const struct beam *beam = &solution->beam;
    const double bend = solution->speed * beam_mode(beam->ends, x, beam->length, 0);
    const double turn = -across * solution->speed * beam_mode(beam->ends, x, beam->length, 1);
    const double w = solution->frequency;
    for (size_t i = 0; i < n; i++) {
        const double u[3] = {turn * sin(w * time[i]) / w, bend * sin(w * time[i]) / w, 0};
        const double v[3] = {turn * cos(w * time[i]), bend * cos(w * time[i]), 0};
        body_direction_to_deck(body, u, value + 6 * i);
        body_direction_to_deck(body, v, value + 6 * i + 3);
    }
    return SELAS_OK;
}

static void tell_number(void (*tell)(void *context, const char *key, const char *value), void *context,
                        const char *key, double number)
{
    char text[48];
    snprintf(text, sizeof text, "%.8g", number);
    tell(context, key, text);
}

static void describe(const struct exact *exact,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct solution *solution = (const struct solution *)exact;
    char theory[64];
    snprintf(theory, sizeof theory, "%s, linear, %s", solution->theory, beam_ends_name(solution->beam.ends));
    tell(context, "frequency from", theory);
    tell_number(tell, context, "frequency", solution->frequency);
    tell_number(tell, context, "frequency Euler-Bernoulli", beam_euler_bernoulli(&solution->beam));
    tell_number(tell, context, "frequency Timoshenko", beam_timoshenko(&solution->beam));
}

/* The frequency of the computed deflection. */
static void judge(const struct exact *exact, const struct receiver *receiver, size_t rows, const double *time,
                  const double *value, void (*tell)(void *context, const char *key, const char *value),
                  void *context)
{
    const struct solution *solution = (const struct solution *)exact;
    struct messages messages = {0};
    double frequency = 0;
    char key[NAME_SIZE + 32], none[128];
    snprintf(key, sizeof key, "frequency at %s", receiver->name);
    if (fit_frequency(rows, time, value + 1, 6, solution->frequency, &frequency, &messages) != SELAS_OK) {
        const char *why = messages.text != NULL ? strchr(messages.text, ' ') : NULL;
        snprintf(none, sizeof none, "none:%.*s", why != NULL ? (int)strcspn(why, "\n") : 0,
                 why != NULL ? why : "");
        tell(context, key, none);
    } else {
        tell_number(tell, context, key, frequency);
        snprintf(key, sizeof key, "frequency error at %s", receiver->name);
        tell_number(tell, context, key, frequency / solution->frequency - 1);
    }
    messages_free(&messages);
}

const struct exact_class exact_beam = {
    .kind = "beam",
    .create = create,
    .destroy = destroy,
    .history = history,
    .describe = describe,
    .judge = judge,
};
