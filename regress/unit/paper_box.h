/* A model of the published smoothed point method for a box made by hand. */
#ifndef PAPER_BOX_H
#define PAPER_BOX_H

#include "box_scene.h"
#include "method/paper/paper.h"

static struct paper *create(struct box_scene *box, const struct paper_options *options)
{
    struct messages messages = {0};
    struct model *model;
    const selas_status status = paper_create(&box->scene, options, &model, &messages);
    if (status != SELAS_OK) print_error("%s", messages.text);
    assert_int_equal(status, SELAS_OK);
    return (struct paper *)model;
}

static void destroy(struct paper *paper)
{
    paper->model.core->destroy(&paper->model);
}

#endif
