/* What the tests of updated-Lagrangian SPH share: a model of a plain scene with its own state. */
#ifndef UPDATED_RUN_H
#define UPDATED_RUN_H

#include "near.h"

#include "method/updated_lagrangian/updated_lagrangian.h"
#include "plain_scene.h"

#include <stdlib.h>

struct fixture {
    struct plain_scene plain;
    struct updated_options options;
    struct model *model;
    double *y, *rate;
};

/* Fills model, y and rate from plain and options. */
static inline void make(struct fixture *f)
{
    struct messages messages = {0};
    struct cloud *cloud = NULL;
    if (cloud_create(&f->plain.scene, &cloud, &messages) != SELAS_OK ||
        updated_lagrangian_new(&f->plain.scene, &f->options, cloud, &f->model, &messages) != SELAS_OK)
        fail_msg("%s", messages.text);
    f->y = calloc(f->model->state_size, sizeof *f->y);
    f->rate = calloc(f->model->state_size, sizeof *f->rate);
    updated_initialise(f->model, f->y);
}

static inline void drop(struct fixture *f)
{
    free(f->y);
    free(f->rate);
    f->model->core->destroy(f->model);
}

#endif
