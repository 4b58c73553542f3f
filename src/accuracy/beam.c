/* scene%accuracy for the swinging beam (He & Seaid 2016, section 4.2; doc/verification/accuracy.md, section 6). What is
 * wanted of it is the frequency of its first bending mode, as the report names it: the velocity also holds
 * waves of shear across the beam that the start sets going (Euler and Bernoulli's mode moves no section along
 * the beam), and those no method has right for long. Measured (regress/studies/accuracy/beams.sh), with n
 * spacings across a beam of width W and length L, nu' = nu, in plane strain nu / (1 - nu), |error of the
 * frequency| = a (W / L)^q (1 + m nu'^4) / (n^p + b) + d (W / L) nu'^2 n^-r,              (1) the last part
 * that of the corners of the clamp, where the stress has no bound. */
#include "exact/beam.h"
#include "accuracy/kinds.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct setting {
    const char *variant, *gradient; /* of the deck; NULL: any */
    const char *scheme;
    double factor, slender, thick, order, shift, corner, corner_order; /* a, q, m, p, b, d, r of (1) */
    double cost;        /* of an unknown and step, in those of the first one */
    int degree, sweeps; /* of the consistent method, or 0 */
    int least;          /* n for which (1) was measured begin here */
    bool thinner;       /* n counts across the thinner side */
};
static const struct setting settings[] = {
    {"consistent", NULL, "leapfrog", .264, 0, 7.2, 2, .32, 0, 0, 1, 1, 3, 1, false},
    {"consistent", NULL, "leapfrog", .0733, 1, 0, 2.88, 0, .224, 1.56, 1.3, 2, 3, 1, true},
    {"consistent", NULL, "modified-equation", .000241, 1, 0, 2.03, 0, .108, 1.64, 4.6, 3, 0, 1, true},
    {"total-lagrangian", "quadratic", NULL, .415, 0, 0, 2, 0, 0, 0, 1, 0, 0, 4, false},
    {"total-lagrangian", "linear", NULL, 5.61, 0, 0, 2, 4.7, 0, 0, 1, 0, 0, 4, false},
};
enum { SETTINGS = sizeof settings / sizeof *settings };
enum { MOST_ACROSS = 64 }; /* (1) was measured to 30 */
/* The frequency falls by so much times the square of deflection over length (measured, the same script): no
 * error of a method, but what the report compares with. */
static const double LARGE_SWING = .0418;

static bool looks_like(const struct scene *scene)
{
    return scene->initial.kind == INITIAL_BEAM_MODE && scene->body.shape == BODY_BOX && scene->dimension > 1;
}

static bool serves(const struct setting *setting, const struct scene *scene)
{
    return strcmp(setting->variant, scene->method.variant) == 0 &&
           (setting->gradient == NULL || strcmp(setting->gradient, accuracy_gradient(scene)) == 0);
}

static bool viscous(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    static const char *const words[2] = {"viscosity_alpha", "viscosity_beta"};
    for (int k = 0; k < 2; k++)
        if (deck_values(group, words[k]) > 0 && deck_real(group, words[k], 0) > 0) return true;
    return false;
}

static const char *refusal(const struct scene *scene)
{
    static const double slender = 4, swings = 2;
    const struct beam beam = beam_of(scene);
    bool served = false;
    for (int s = 0; s < SETTINGS; s++)
        served = served || serves(&settings[s], scene);
    if (!served)
        return "beams by method 'smoothed-point', variant 'consistent', or 'sph', variant "
               "'total-lagrangian', "
               "gradient 'quadratic' or 'linear' (others have the frequency wrong by 15 % and more)";
    if (viscous(scene)) return "beams without viscosity, which changes their frequency";
    for (int face = 0; face < 2 * scene->dimension; face++)
        if (!(face == FACE_X_LOW ? boundary_is_fixed : boundary_is_free)(&scene->boundary[face]))
            return "beams that are fixed at 'x-' and free elsewhere";
    if (scene->loads > 0) return "beams without loads";
    if (beam.length < slender * beam.width) return "beams at least four times as long as wide";
    if (scene->receivers == 0) return "scenes with receivers, where the frequency is taken";
    if (scene->end_time * beam_timoshenko(&beam) < swings * 2 * M_PI)
        return "beams that swing twice or more before end_time, so that their frequency can be told";
    return NULL;
}

static double smaller(double one, double other)
{
    return one < other ? one : other;
}

static double side(const struct scene *scene, const struct setting *setting)
{
    const double *low = scene->body.low, *high = scene->body.high, width = high[1] - low[1];
    return scene->dimension == 3 && setting->thinner ? smaller(width, high[2] - low[2]) : width;
}

/* Poisson's ratio that the clamp hinders: across the plane too in plane strain and, where n counts the wider
 * side, in space. */
static double hindered(const struct scene *scene, const struct setting *setting)
{
    const double poisson = scene->material[scene->body.material].poisson;
    const bool strain = scene->dimension == 3 ? !setting->thinner : scene->plane == PLANE_STRAIN;
    return strain ? poisson / (1 - poisson) : poisson;
}

static double error_of(const struct scene *scene, const struct setting *setting, double spacing)
{
    const struct beam beam = beam_of(scene);
    const double slender = beam.width / beam.length, across = side(scene, setting) / spacing;
    const double square = pow(hindered(scene, setting), 2);
    return setting->factor * pow(slender, setting->slender) * (1 + setting->thick * square * square) /
               (pow(across, setting->order) + setting->shift) +
           setting->corner * slender * square * pow(across, -setting->corner_order);
}

/* The largest spacing that errs little enough; 0 if there is none. */
static double enough(const struct scene *scene, const struct setting *setting, double accuracy)
{
    const double across = side(scene, setting);
    for (int n = setting->least; n <= MOST_ACROSS; n++) {
        double spacing = dividing_spacing(&scene->body, scene->dimension, across / n);
        if (!(spacing > 0) && setting->degree == 0) spacing = across / n; /* fitted edge by edge */
        if (spacing > 0 && error_of(scene, setting, spacing) <= ACCURACY_MOST * accuracy) return spacing;
    }
    return 0;
}

static double work_of(const struct scene *scene, const struct setting *setting, double spacing)
{
    double work = setting->cost / spacing;
    for (int c = 0; c < scene->dimension; c++)
        work *= (scene->body.high[c] - scene->body.low[c]) / spacing + setting->degree;
    return work;
}

/* Tip's deflection over the length, where it changes the frequency; 0 for linear models. */
static double deflection(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    for (int s = 0; s < SETTINGS; s++)
        if (settings[s].degree > 0 && serves(&settings[s], scene)) return 0;
    if (deck_chosen(group, "law", "linear")) return 0;
    const struct beam beam = beam_of(scene);
    const struct material *material = &scene->material[scene->body.material];
    const double speed = scene->initial.amplitude * sqrt(material->young / material->density);
    return fabs(speed) / beam_timoshenko(&beam) / beam.length;
}

static selas_status choose(const struct scene *scene, double accuracy, const struct trial *trial,
                           struct scene_choice *choice, struct messages *messages)
{
    (void)trial;
    static const double seen = .2;
    const double swing = deflection(scene), shift = LARGE_SWING * swing * swing;
    double least = INFINITY;
    if (shift > seen * accuracy)
        return fail(
            messages, SELAS_BAD_SCENE,
            "scene%%accuracy = %g: the beam swings by %.2g of its length, which changes its frequency by "
            "some %.1g beside any error; there is no exact frequency to promise that error of: make "
            "initial%%amplitude smaller, take law = 'linear', or give body%%spacing",
            accuracy, swing, shift);
    for (int s = 0; s < SETTINGS; s++) {
        const struct setting *setting = &settings[s];
        if (!serves(setting, scene)) continue;
        const double spacing = enough(scene, setting, accuracy);
        if (!(spacing > 0) || !(work_of(scene, setting, spacing) < least)) continue;
        least = work_of(scene, setting, spacing);
        choice->spacing = spacing;
        choice->degree = setting->degree;
        choice->sweeps = setting->sweeps;
        choice->scheme = setting->scheme;
        char how[64];
        if (setting->degree > 0)
            snprintf(how, sizeof how, "degree %d, mass %s, %s", setting->degree,
                     setting->sweeps > 0 ? "vc3" : "exact", setting->scheme);
        else
            snprintf(how, sizeof how, "gradient %s", accuracy_gradient(scene));
        snprintf(choice->text, sizeof choice->text,
                 "%g wanted of the frequency of the swing: spacing %.6g, %s; predicted error %.2g", accuracy,
                 spacing, how, error_of(scene, setting, spacing));
    }
    if (isfinite(least)) return SELAS_OK;
    return fail(
        messages, SELAS_BAD_SCENE,
        "scene%%accuracy = %g is out of reach for this beam: %d points across it would still err more, "
        "or no spacing divides its edges; give body%%spacing",
        accuracy, MOST_ACROSS);
}

const struct accuracy_kind accuracy_beam = {
    .looks_like = looks_like,
    .refusal = refusal,
    .choose = choose,
    .particles = true,
};
