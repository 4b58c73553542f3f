/* A scene made by hand for tests of point methods: a box of one material, free on all faces. */
#ifndef BOX_SCENE_H
#define BOX_SCENE_H

#include "near.h"
#include "scene/scene.h"

#include <math.h>

struct box_scene {
    struct scene scene;
    struct material material;
    struct load load;
};

static void set_material(struct material *material, double lambda, double mu, double density)
{
    *material = (struct material){.name = "rock",
                                  .density = density,
                                  .lambda = lambda,
                                  .mu = mu,
                                  .young = mu * (3 * lambda + 2 * mu) / (lambda + mu),
                                  .poisson = lambda / (2 * (lambda + mu)),
                                  .plane_lambda = lambda,
                                  .p_speed = sqrt((lambda + 2 * mu) / density),
                                  .s_speed = sqrt(mu / density)};
}

/* Box [0, size]^dimension with lambda = 1.5, mu = 0.8, density = 1.3 and no loads. */
static __attribute__((unused)) void make_box(struct box_scene *box, int dimension, double size,
                                             double spacing)
{
    *box = (struct box_scene){.scene = {.dimension = dimension, .materials = 1, .end_time = 1}};
    set_material(&box->material, 1.5, .8, 1.3);
    box->scene.material = &box->material;
    box->scene.load = &box->load;
    struct body *body = &box->scene.body;
    body->spacing = spacing;
    for (int c = 0; c < 3; c++) {
        body->high[c] = c < dimension ? size : 0;
        body->pivot[c] = body->high[c] / 2;
        body->frame[c][c] = 1;
    }
    for (int face = 0; face < BOX_FACES; face++) {
        box->scene.boundary[face].normal_factor = 1;
        box->scene.boundary[face].shear_factor = 1;
    }
}

/* Pulls at the faces x- and x+ by the traction .3; `load` must live as long as the scene. */
static __attribute__((unused)) void pull_box(struct box_scene *box, struct load load[2])
{
    for (int k = 0; k < 2; k++) {
        load[k] =
            (struct load){.shape = LOAD_FACE, .face = k == 0 ? FACE_X_LOW : FACE_X_HIGH, .amplitude = .3};
        load[k].direction[0] = k == 0 ? -1 : 1;
    }
    box->scene.loads = 2;
    box->scene.load = load;
}

/* The uniform stretch of a pulled box, u [points][dimension]: e_xx = .3 / modulus, the others -contraction
 * e_xx (plane strain across in 1D, 2D). */
static __attribute__((unused)) void stretch_box(const struct box_scene *box, const double *position,
                                                size_t points, double *u)
{
    const size_t d = (size_t)box->scene.dimension;
    const double across = (double)d - 1, lambda = box->material.lambda, mu = box->material.mu;
    const double contraction = d == 1 ? 0 : lambda / (across * lambda + 2 * mu);
    const double strain = .3 / (lambda * (1 - across * contraction) + 2 * mu);
    for (size_t i = 0; i < points; i++)
        for (size_t c = 0; c < d; c++)
            u[d * i + c] = position[3 * i + c] * strain * (c == 0 ? 1 : -contraction);
}

/* Turns the body by angles (radians) about x, then y, then z: frame = Rz Ry Rx. */
static __attribute__((unused)) void rotate_box(struct box_scene *box, double ax, double ay, double az)
{
    const double cx = cos(ax), sx = sin(ax), cy = cos(ay), sy = sin(ay), cz = cos(az), sz = sin(az);
    const double frame[3][3] = {{cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx},
                                {sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx},
                                {-sy, cy * sx, cy * cx}};
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            box->scene.body.frame[i][j] = frame[i][j];
    box->scene.body.rotated = true;
}

/* Reproducible numbers in [-1, 1). */
static __attribute__((unused)) double noise(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 11) * 0x1p-52 - 1;
}

#endif
