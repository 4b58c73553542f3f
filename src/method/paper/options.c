/* Options of the published method from the names of &method; what is not given keeps its default. */
#include "method/paper/paper.h"

static void read_logical(const struct deck_group *group, const char *name, bool *value)
{
    if (deck_given(group, name)) *value = deck_logical(group, name, 0);
}

static void read_real(const struct deck_group *group, const char *name, double *value)
{
    if (deck_given(group, name)) *value = deck_real(group, name, 0);
}

/* True for one of two choices. */
static void read_choice(const struct deck_group *group, const char *name, const char *choice, bool *chosen)
{
    if (deck_given(group, name)) *chosen = deck_chosen(group, name, choice);
}

selas_status paper_options_read(const struct scene *scene, struct paper_options *options,
                                struct messages *messages)
{
    const struct deck_group *group = scene->method.group;
    *options = paper_options_default();
    if (group == NULL) return SELAS_OK;
    read_real(group, "smoothing_length", &options->smoothing_length);
    read_real(group, "filter", &options->filter);
    read_logical(group, "volume_factors", &options->volume_factors);
    read_logical(group, "area_factors", &options->area_factors);
    read_logical(group, "kernel_correction", &options->kernel_correction);
    read_logical(group, "boundary_term", &options->boundary_term);
    read_logical(group, "patch_overlap", &options->patch_overlap);
    read_logical(group, "deconvolution", &options->deconvolution);
    read_choice(group, "row_sums", "zero", &options->zero_row_sums);
    read_choice(group, "load_sum", "distributed", &options->load_distributed);
    read_choice(group, "filter_form", "increment", &options->filter_increment);
    if (deck_given(group, "kernel")) options->kernel = kernel_find(deck_text(group, "kernel", 0));
    if (options->kernel == NULL)
        return deck_error(scene->deck, group, "kernel", messages, "unknown kernel '%s'",
                          deck_text(group, "kernel", 0));
    return SELAS_OK;
}
