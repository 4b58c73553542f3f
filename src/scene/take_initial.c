/* The words of &initial: each kind has its own parameters, and takes no others. */
#include "scene/build.h"
#include "scene/initial.h"

#include <math.h>

enum { PARAMETERS = 8 };

static const char *const parameters[PARAMETERS] = {"velocity",     "amplitude",  "wave",   "direction",
                                                   "polarisation", "wavelength", "centre", "width"};

static const struct {
    const char *purpose;
    bool takes[PARAMETERS];
} kinds[] = {
    [INITIAL_REST] = {"initial kind 'rest'", {false}},
    [INITIAL_UNIFORM_VELOCITY] = {"initial kind 'uniform-velocity'", {true}},
    [INITIAL_BEAM_MODE] = {"initial kind 'beam-mode'", {false, true}},
    [INITIAL_PLANE_WAVE] = {"initial kind 'plane-wave'", {false, true, true, true, true, true, true, true}},
    [INITIAL_GAUSSIAN] = {"initial kind 'gaussian'", {false, true, false, true, false, false, true, true}},
};

/* P waves move along the direction, S waves across it: in 2D there is just one way, in 3D it must be said. */
static void take_polarisation(struct builder *builder, const struct deck_group *group,
                              struct initial *initial, bool direction_known)
{
    static const char *const words[] = {"polarisation", NULL};
    const int dimension = builder->scene->dimension;
    const double *n = initial->direction;
    double *p = initial->polarisation, along = 0;
    char text[VECTOR_TEXT_SIZE];
    if (!initial->shear) {
        refuse(builder, group, words, "a P wave, which moves along its direction");
        for (int c = 0; c < 3; c++)
            p[c] = n[c];
        return;
    }
    if (dimension == 1) {
        complain(builder, group, "wave", "there are no S waves in one dimension; expected 'p'");
        return;
    }
    if (dimension == 2 && !deck_given(group, "polarisation")) {
        p[0] = -n[1];
        p[1] = n[0];
        return;
    }
    if (!need_direction(builder, group, "polarisation", "an S wave", p) || !direction_known) return;
    for (int c = 0; c < 3; c++)
        along += p[c] * n[c];
    if (fabs(along) <= 1e-9) return;
    double across[3];
    for (int c = 0; c < 3; c++)
        across[c] = p[c] - along * n[c];
    if (fabs(along) > 1 - 1e-9)
        complain(builder, group, "polarisation",
                 "an S wave moves across its direction, not along it; expected another polarisation");
    else
        complain(builder, group, "polarisation",
                 "the polarisation is not across the direction; expected for instance %s",
                 vector_text(text, across, dimension));
}

static void take_plane_wave(struct builder *builder, const struct deck_group *group, struct initial *initial)
{
    const char *purpose = kinds[INITIAL_PLANE_WAVE].purpose;
    const bool train = deck_given(group, "wavelength"), pulse = deck_given(group, "width");
    const bool known = need_direction(builder, group, "direction", purpose, initial->direction);
    initial->shear = deck_chosen(group, "wave", "s");
    need_real(builder, group, "amplitude", purpose, &initial->amplitude);
    take_polarisation(builder, group, initial, known);
    if (train == pulse)
        complain(builder, group, train ? "width" : NULL,
                 "%s needs %swavelength (of a train of waves) or width (of a single pulse)%s", purpose,
                 train ? "either " : "", train ? ", not both" : "");
    if (train) initial->wavelength = deck_real(group, "wavelength", 0);
    if (pulse) initial->width = deck_real(group, "width", 0);
    if (pulse)
        need_vector(builder, group, "centre", "a pulse", initial->centre);
    else
        take_vector(builder, group, "centre", initial->centre);
}

static void take_gaussian(struct builder *builder, const struct deck_group *group, struct initial *initial)
{
    const char *purpose = kinds[INITIAL_GAUSSIAN].purpose;
    need_real(builder, group, "amplitude", purpose, &initial->amplitude);
    need_real(builder, group, "width", purpose, &initial->width);
    need_vector(builder, group, "centre", purpose, initial->centre);
    need_direction(builder, group, "direction", purpose, initial->direction);
}

void build_initial(struct builder *builder)
{
    struct initial *initial = &builder->scene->initial;
    if (deck_count(builder->deck, "initial") == 0) return;
    const struct deck_group *group = deck_get(builder->deck, "initial", 0);
    initial->kind = (enum initial_kind)deck_choice(group, "kind", 0);
    const char *purpose = kinds[initial->kind].purpose;
    for (int i = 0; i < PARAMETERS; i++) {
        const char *const one[] = {parameters[i], NULL};
        if (!kinds[initial->kind].takes[i]) refuse(builder, group, one, purpose);
    }
    if (initial->kind == INITIAL_UNIFORM_VELOCITY)
        need_vector(builder, group, "velocity", purpose, initial->velocity);
    if (initial->kind == INITIAL_BEAM_MODE) {
        need_real(builder, group, "amplitude", purpose, &initial->amplitude);
        if (builder->scene->dimension == 1)
            complain(builder, group, "kind", "a beam cannot bend in one dimension");
        else if (beam_ends_of(builder->scene) == BEAM_ENDS)
            complain(builder, group, "kind",
                     "a beam has its first mode clamped-free ('x-' fixed), clamped-clamped ('x-', 'x+' "
                     "fixed), free-free "
                     "(neither named), or simply supported ('x-', 'x+' of kind 'displacement', direction = "
                     "0, 1, slip = "
                     ".true., amplitude = 0); expected one of these");
    }
    if (initial->kind == INITIAL_PLANE_WAVE) take_plane_wave(builder, group, initial);
    if (initial->kind == INITIAL_GAUSSIAN) take_gaussian(builder, group, initial);
}
