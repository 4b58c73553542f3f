/* Options of the published method from the names of &method. */
#include "method/paper.h"

selas_status paper_options_read(const struct scene *scene, struct paper_options *options,
                                struct messages *messages)
{
    const struct deck_group *group = scene->method.group;
    *options = paper_options_default();
    options->kernel = kernel_find(deck_text(group, "kernel", 0));
    if (options->kernel == NULL)
        return deck_error(scene->deck, group, "kernel", messages,
                          "unknown kernel '%s'; known are '%s', '%s' and '%s'", deck_text(group, "kernel", 0),
                          kernel_name(0), kernel_name(1), kernel_name(2));
    if (deck_given(group, "smoothing_length"))
        options->smoothing_length = deck_real(group, "smoothing_length", 0);
    if (deck_given(group, "filter")) options->filter = deck_real(group, "filter", 0);
    options->volume_factors = deck_logical(group, "volume_factors", 0);
    options->area_factors = deck_logical(group, "area_factors", 0);
    options->kernel_correction = deck_logical(group, "kernel_correction", 0);
    options->boundary_term = deck_logical(group, "boundary_term", 0);
    options->zero_row_sums = deck_choice(group, "row_sums", 0) == 1;    /* 'as-printed', 'zero' */
    options->load_distributed = deck_choice(group, "load_sum", 0) == 0; /* 'distributed', 'local' */
    options->patch_overlap = deck_logical(group, "patch_overlap", 0);
    options->filter_increment = deck_choice(group, "filter_form", 0) == 0; /* 'increment', 'displacement' */
    options->deconvolution = deck_logical(group, "deconvolution", 0);
    return SELAS_OK;
}
