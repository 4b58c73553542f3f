/* Switches of updated-Lagrangian SPH as decks give them. */
#include "method/updated_lagrangian/updated_lagrangian.h"

static double real_or(const struct deck_group *group, const char *name, double standard)
{
    return deck_values(group, name) > 0 ? deck_real(group, name, 0) : standard;
}

static bool logical_or(const struct deck_group *group, const char *name, bool standard)
{
    return deck_values(group, name) > 0 ? deck_logical(group, name, 0) : standard;
}

struct updated_options updated_lagrangian_published(void)
{
    return (struct updated_options){.kernel = kernel_find("cubic"),
                                    .smoothing_length = 1.5,
                                    .alpha = 2.5,
                                    .beta = 2.5,
                                    .artificial_stress = .3,
                                    .correction = true,
                                    .jaumann = true};
}

static selas_status create(const struct scene *scene, struct model **model, struct messages *messages)
{
    const struct deck_group *group = scene->method.group;
    struct updated_options options = updated_lagrangian_published();
    *model = NULL;
    if (group != NULL) {
        if (deck_values(group, "kernel") > 0) options.kernel = kernel_find(deck_text(group, "kernel", 0));
        options.smoothing_length = real_or(group, "smoothing_length", options.smoothing_length);
        options.alpha = real_or(group, "viscosity_alpha", options.alpha);
        options.beta = real_or(group, "viscosity_beta", options.beta);
        options.artificial_stress = real_or(group, "artificial_stress", options.artificial_stress);
        options.correction = logical_or(group, "gradient_correction", options.correction);
        options.adjoint = deck_chosen(group, "forces", "adjoint");
        options.hourglass = real_or(group, "hourglass", options.hourglass);
        options.jaumann = logical_or(group, "jaumann", options.jaumann);
    }
    return updated_lagrangian_new(scene, &options, NULL, model, messages);
}

const struct method method_updated_lagrangian = {
    .name = "sph",
    .variant = "updated-lagrangian",
    .words = "kernel smoothing_length viscosity_alpha viscosity_beta artificial_stress gradient_correction "
             "jaumann forces hourglass",
    .faces = CAN_HOLD | CAN_MOVE | CAN_MIRROR | CAN_DAMP,
    .ranks = true,
    .create = create,
};
