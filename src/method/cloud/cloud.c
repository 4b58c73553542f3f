/* Smoothed points on clouds (doc/theory/cloud-method.md): the forces of the total-Lagrangian model with Hooke's law
 * on gradients that sum by parts. */
#include "method/cloud/cloud.h"

const struct tl_form cloud_form = {
    .method = &method_cloud,
    .gradient = "summation by parts",
    .points = cloud_method_points,
    .gradients = cloud_gradients,
    .hold = cloud_hold,
    .traction = cloud_traction,
};

static selas_status suits(const struct scene *scene, struct messages *messages)
{
    struct cloud *cloud = NULL;
    const selas_status status =
        scene_loads_move(scene) ? SELAS_UNSUPPORTED : cloud_method_points(scene, &cloud, messages);
    cloud_free(&cloud);
    return status;
}

static selas_status create(const struct scene *scene, struct model **model, struct messages *messages)
{
    struct tl_options options = tl_default_options();
    const struct deck_group *group = scene->method.group;
    options.form = &cloud_form;
    options.law = LAW_LINEAR;
    options.hourglass = 1; /* doc/theory/cloud-method.md, section 3 */
    if (deck_values(group, "kernel") > 0) options.kernel = kernel_find(deck_text(group, "kernel", 0));
    if (deck_values(group, "smoothing_length") > 0)
        options.smoothing_length = deck_real(group, "smoothing_length", 0);
    if (deck_values(group, "hourglass") > 0) options.hourglass = deck_real(group, "hourglass", 0);
    return total_lagrangian_create(scene, &options, model, messages);
}

const struct method method_cloud = {
    .name = "smoothed-point",
    .variant = "cloud",
    .words = "kernel smoothing_length hourglass",
    .faces = CAN_HOLD | CAN_MIRROR | CAN_DAMP,
    .suits = suits,
    .create = create,
};
