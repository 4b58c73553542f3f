/* Materials: any of four pairs of elastic constants become lambda and mu (doc/reference/scene.md, Eqs S3-S10).
 *
 * An isotropic solid is stable if its strain energy is positive definite: mu > 0 and 3 lambda + 2 mu > 0, so
 * that -1 < nu < 1/2 (Love 1927, section 70). */
#include "scene/build.h"

#include <math.h>
#include <string.h>
#include <strings.h>

enum { PAIRS = 4 };

static const char *const pairs[PAIRS][2] = {
    {"lambda", "mu"}, {"young", "poisson"}, {"p_speed", "s_speed"}, {"bulk", "shear"}};

/* Index of the one pair that is given whole, or -1 after complaining. */
static int find_pair(struct builder *builder, const struct deck_group *group)
{
    int found = -1, touched = 0;
    for (int i = 0; i < PAIRS; i++) {
        const bool first = deck_given(group, pairs[i][0]), second = deck_given(group, pairs[i][1]);
        if (!first && !second) continue;
        touched++;
        if (touched > 1)
            complain(builder, group, pairs[i][first ? 0 : 1],
                     "'%s' comes on top of another pair; give exactly one pair of lambda, mu / young, "
                     "poisson / p_speed, s_speed / bulk, shear",
                     pairs[i][first ? 0 : 1]);
        else if (!first || !second)
            complain(builder, group, pairs[i][first ? 0 : 1], "'%s' needs '%s' beside it",
                     pairs[i][first ? 0 : 1], pairs[i][first ? 1 : 0]);
        else
            found = i;
    }
    if (touched == 0)
        complain(builder, group, NULL,
                 "no elastic constants; give one pair of lambda, mu / young, poisson / p_speed, s_speed / "
                 "bulk, shear");
    return touched == 1 ? found : -1;
}

/* Poisson's ratio of the deck in (-1, 1/2). */
static bool check_poisson(struct builder *builder, const struct deck_group *group, double poisson)
{
    if (poisson > -1 && poisson < .5) return true;
    if (poisson == .5)
        complain(builder, group, "poisson",
                 "poisson = 0.5 is an incompressible solid, whose P waves are infinitely fast; expected less "
                 "than 0.5, for instance 0.499");
    else
        complain(builder, group, "poisson", "poisson = %g is out of its range; expected -1 < poisson < 0.5",
                 poisson);
    return false;
}

static bool read_constants(struct builder *builder, const struct deck_group *group, int pair,
                           struct material *material)
{
    const double first = deck_real(group, pairs[pair][0], 0), second = deck_real(group, pairs[pair][1], 0);
    const double density = material->density;
    if (pair == 0) {
        material->lambda = first;
        material->mu = second;
    } else if (pair == 1) {
        if (!check_poisson(builder, group, second)) return false;
        material->mu = first / (2 * (1 + second));
        material->lambda = first * second / ((1 + second) * (1 - 2 * second));
    } else if (pair == 2) {
        material->mu = density * second * second;
        material->lambda = density * (first * first - 2 * second * second);
    } else {
        material->mu = second;
        material->lambda = first - 2 * second / 3;
    }
    return true;
}

/* mu > 0 and 3 lambda + 2 mu > 0, in the words of the pair that was given. */
static bool check_definite(struct builder *builder, const struct deck_group *group, int pair,
                           const struct material *material)
{
    const double lambda = material->lambda, mu = material->mu;
    if (!isfinite(3 * lambda + 2 * mu) || !isfinite((lambda + 2 * mu) / material->density)) {
        complain(builder, group, pairs[pair][0], "the elastic constants are too large to be computed with");
        return false;
    }
    if (mu > 0 && 3 * lambda + 2 * mu > 0) return true;
    if (!(mu > 0))
        complain(builder, group, pairs[pair][pair == 1 ? 0 : 1], "the shear modulus is %g; expected mu > 0",
                 mu);
    else if (pair == 2)
        complain(
            builder, group, "s_speed",
            "s_speed = %g is too fast beside p_speed = %g; expected less than sqrt(3)/2 p_speed = %g, so "
            "that the bulk modulus is positive",
            deck_real(group, "s_speed", 0), deck_real(group, "p_speed", 0),
            sqrt(.75) * deck_real(group, "p_speed", 0));
    else
        complain(builder, group, pairs[pair][0],
                 "3 lambda + 2 mu is %g; expected more than 0, so that the bulk modulus is positive",
                 3 * lambda + 2 * mu);
    return false;
}

void material_complete(const struct scene *scene, struct material *material)
{
    const double lambda = material->lambda, mu = material->mu;
    material->young = (3 * lambda + 2 * mu) / (lambda + mu) * mu;
    material->poisson = lambda / (2 * (lambda + mu));
    material->plane_lambda = lambda;
    if (scene->plane == PLANE_STRESS && scene->dimension == 2)
        material->plane_lambda = 2 * mu / (lambda + 2 * mu) * lambda;
    if (scene->plane == PLANE_STRESS && scene->dimension == 1)
        material->plane_lambda = material->young - 2 * mu;
    material->p_speed = sqrt((material->plane_lambda + 2 * mu) / material->density);
    material->s_speed = sqrt(mu / material->density);
}

/* Rock in units that are not of one system: 2.7 g/cm^3 beside m/s, 2700 kg/m^3 beside km/s. A density of 1 is of none,
 * and what is as slow as this in m/s, gels and tissue, is lighter or has faster waves of compression. */
static void warn_of_units(struct builder *builder, const struct deck_group *group,
                          const struct material *material)
{
    const double density = material->density, speed = material->s_speed;
    const bool light = density > 1.2 && density < 9.0 && speed > 200.0 && speed < 9e3;
    const bool heavy = density > 1.4e3 && density < 9e3 && speed > .2 && material->p_speed < 15.0;
    if (!light && !heavy) return;
    deck_warning(
        builder->deck, group, "density", builder->messages,
        "density = %g beside shear waves of %.4g are rock in %s: what loads move and stresses are of no one "
        "system of units; %s would be right",
        density, speed, light ? "g/cm^3 and m/s" : "kg/m^3 and km/s",
        light ? "kg/m^3, with forces in N and lengths in m," : "metres and seconds");
}

/* Waves of a damped solid lose energy in shear and in compression: the quality of the bulk modulus is
 * positive if q_p <= 3/4 (c_p/c_s)^2 q_s, to first order in 1/q (hence the hundredth). */
static void read_quality(struct builder *builder, const struct deck_group *group, struct material *material)
{
    static const char *const words[] = {"q_p", "q_s", "q_frequency", "q_power"};
    double *const values[] = {&material->q_p, &material->q_s, &material->q_frequency, &material->q_power};
    int given = 0;
    for (int i = 0; i < 4; i++)
        if (deck_values(group, words[i]) > 0) {
            *values[i] = deck_real(group, words[i], 0);
            given++;
        }
    for (int i = 0; i < 2 && given > 0; i++)
        if (!(*values[i] > 0))
            complain(builder, group, NULL, "a damped material needs q_p and q_s; '%s' is not given",
                     words[i]);
    if (!(material->q_p > 0 && material->q_s > 0 && material->mu > 0)) return;
    const double ratio = (material->lambda + 2 * material->mu) / material->mu;
    if (material->q_p > 1.01 * .75 * ratio * material->q_s)
        complain(builder, group, "q_p",
                 "q_p = %g is too large beside q_s = %g: compression would gain energy; expected at most 3/4 "
                 "(p_speed/s_speed)^2 q_s = %g",
                 material->q_p, material->q_s, .75 * ratio * material->q_s);
}

void build_materials(struct builder *builder)
{
    struct scene *scene = builder->scene;
    const size_t count = deck_count(builder->deck, "material");
    const size_t from_model = deck_count(builder->deck, "model") > 0 ? 2 : 0; /* model_file.c */
    if (count + from_model == 0) {
        complain(builder, deck_get(builder->deck, "scene", 0), NULL,
                 "the deck has no &material; a body needs one");
        return;
    }
    scene->material = scene_array(builder, count + from_model, sizeof *scene->material);
    if (scene->material == NULL) return;
    scene->materials = count;
    for (size_t i = 0; i < count; i++) {
        const struct deck_group *group = deck_get(builder->deck, "material", i);
        struct material *material = &scene->material[i];
        take_name(builder, group, "name", material->name);
        for (size_t k = 0; k < i; k++)
            if (material->name[0] != '\0' && strcasecmp(scene->material[k].name, material->name) == 0)
                complain(builder, group, "name",
                         "there is a material '%s' already (&material %zu); expected another name",
                         material->name, k + 1);
        material->density = deck_real(group, "density", 0);
        const int pair = find_pair(builder, group);
        if (pair >= 0 && read_constants(builder, group, pair, material) &&
            check_definite(builder, group, pair, material)) {
            material_complete(scene, material);
            warn_of_units(builder, group, material);
        }
        read_quality(builder, group, material);
    }
}
