/* A box of one material, made by hand: what tests of methods need of a scene, without a deck. */
#ifndef PLAIN_SCENE_H
#define PLAIN_SCENE_H

#include "scene/scene.h"

#include <math.h>
#include <string.h>

enum { PLAIN_MATERIALS = 2, PLAIN_LOADS = 6, PLAIN_LAYERS = 4 };

struct plain_scene {
    struct scene scene;
    struct material material[PLAIN_MATERIALS];
    struct load load[PLAIN_LOADS];
    struct layer layer[PLAIN_LAYERS];
};

static void plain_material(struct material *material, double density, double lambda, double mu)
{
    *material = (struct material){.density = density, .lambda = lambda, .mu = mu, .plane_lambda = lambda};
    material->young = mu * (3 * lambda + 2 * mu) / (lambda + mu);
    material->poisson = lambda / (2 * (lambda + mu));
    material->p_speed = sqrt((lambda + 2 * mu) / density);
    material->s_speed = sqrt(mu / density);
}

/* Box from the origin with edges `size`; all faces free, no loads, at rest. The scene points into `plain`,
 * which must not move. */
static inline void plain_box(struct plain_scene *plain, int dimension, const double size[3], double spacing)
{
    memset(plain, 0, sizeof *plain);
    struct scene *scene = &plain->scene;
    scene->dimension = dimension;
    scene->end_time = 1;
    scene->materials = PLAIN_MATERIALS;
    scene->material = plain->material;
    scene->load = plain->load;
    scene->body.layer = plain->layer;
    scene->body.spacing = spacing;
    plain_material(&plain->material[0], 1.3, 1.7, .9);
    plain_material(&plain->material[1], 2.1, .6, 2.4);
    for (int axis = 0; axis < dimension; axis++)
        scene->body.high[axis] = size[axis];
    for (int i = 0; i < 3; i++)
        scene->body.frame[i][i] = 1;
    for (int face = 0; face < FACES; face++)
        scene->boundary[face].normal_factor = scene->boundary[face].shear_factor = 1;
    strcpy(scene->stepping.scheme, "leapfrog");
    scene->stepping.safety = .9;
}

/* Strata of both materials; shares of the depth of the first and the second. */
static inline void plain_strata(struct plain_scene *plain, double first, double second)
{
    struct body *body = &plain->scene.body;
    const int depth = plain->scene.dimension - 1;
    const double deep = body->high[depth] - body->low[depth];
    plain->layer[0] = (struct layer){.material = 1, .top = 0};
    plain->layer[1] = (struct layer){.material = 0, .top = first * deep};
    plain->layer[2] = (struct layer){.material = 1, .top = (first + second) * deep};
    body->layers = 3;
}

/* Uniform traction on a whole face; gives the load. */
static inline struct load *plain_face_load(struct plain_scene *plain, enum face face,
                                           const double traction[3])
{
    struct load *load = &plain->load[plain->scene.loads++];
    *load = (struct load){.kind = LOAD_TRACTION, .shape = LOAD_FACE, .face = face, .amplitude = 1};
    memcpy(load->direction, traction, sizeof load->direction);
    return load;
}

#endif
