/* Exact solutions: know the scene and nothing of the model. Table of kinds in exact/exact.c, one file each.
 */
#ifndef SELAS_EXACT_H
#define SELAS_EXACT_H

#include "scene/scene.h"

struct exact;

struct exact_class {
    const char *kind; /* as in &reference */
    bool any_ground;  /* takes blocks, tilted and graded layers */
    bool damped;      /* takes materials with q_p and q_s */
    /* Says in messages why a scene has no such solution (SELAS_BAD_SCENE), in no time. */
    selas_status (*create)(const struct scene *scene, struct exact **exact, struct messages *messages);
    /* What the scene's receivers share, which makes their histories cheaper: for who will ask for them; NULL: nothing.
     * At most once. */
    selas_status (*compute)(struct exact *exact, struct messages *messages);
    void (*destroy)(struct exact *exact);
    /* Displacement and velocity at `position` (deck coordinates) at n ascending times: value[6 * i] = ux uy
     * uz vx vy vz. Must be safe to call from several threads. */
    selas_status (*history)(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages);
    /* Stress there, value[6 * i] = xx yy zz xy yz zx; NULL: not offered. As history(). */
    selas_status (*stress)(struct exact *exact, const double position[3], size_t n, const double *time,
                           double *value, struct messages *messages);
    /* Lines for the report: how accurate, how it was computed. */
    void (*describe)(const struct exact *exact,
                     void (*tell)(void *context, const char *key, const char *value), void *context);
    /* Lines for the report on a receiver's computed history (rows as history() gives them), e.g. its
     * frequency; NULL: none. */
    void (*judge)(const struct exact *exact, const struct receiver *receiver, size_t rows, const double *time,
                  const double *value, void (*tell)(void *context, const char *key, const char *value),
                  void *context);
};

struct exact {
    const struct exact_class *class;
    const struct scene *scene;
    bool computed; /* what its receivers share */
};

const struct exact_class *exact_find(const char *kind);
/* Solution named by scene->reference; SELAS_BAD_SCENE if there is none. */
selas_status exact_create(const struct scene *scene, struct exact **exact, struct messages *messages);
/* What its receivers share, once. */
selas_status exact_compute(struct exact *exact, struct messages *messages);
void exact_free(struct exact **exact);

#endif
