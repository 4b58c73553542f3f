/* The consistent smoothed point method (doc/theory/consistent-method.md). */
#ifndef SELAS_METHOD_CONSISTENT_CONSISTENT_H
#define SELAS_METHOD_CONSISTENT_CONSISTENT_H

#include "method/consistent/galerkin/hform.h"

/* What the deck says of the method's options; what it leaves open has the method's defaults. */
struct consistent_options consistent_options_of(const struct scene *scene);
/* What pulses err by that the modified equation moves on at .9 of its limit (regress/studies/bodies/pulse). */
struct wave_law consistent_waves(const struct consistent_options *options);

/* Refuses options that cannot serve the scene: SELAS_BAD_SCENE, SELAS_UNSUPPORTED. */
selas_status consistent_check(const struct scene *scene, const struct consistent_options *options,
                              struct messages *messages);

selas_status consistent_create_with(const struct scene *scene, const struct consistent_options *options,
                                    struct model **model, struct messages *messages);
extern const struct method method_consistent;

/* shorter.c: the model on a body whose axes of more cells than `longest` are cut to so many (but
 * see cells_of()), on one rank; `longest` 0: not cut; free it with model_free(). */
selas_status consistent_cut(const struct consistent *c, size_t longest, struct model **cut,
                            struct messages *messages);
/* Bound on the part of the largest frequency that this one lacks. */
double consistent_deficit(const struct consistent *c, size_t longest);
/* The model's shorten(). */
selas_status consistent_shorten(const struct model *model, struct model **shorter, double *deficit,
                                struct messages *messages);

/* shared.c: lines of the plan on ranks; model_core's `unseen`. */
void shared_describe(const struct consistent *c,
                     void (*tell)(void *context, const char *key, const char *value), void *context);
void consistent_unseen(struct model *model, const double *y, struct unseen *found);

/* observe.c */
bool observe_create(struct consistent *c);
bool collocation_create(struct consistent *c);
void consistent_initialise(struct model *model, double *y);
selas_status consistent_probe(struct model *model, const double position[3], struct probe *probe,
                              struct messages *messages);
void consistent_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                        const double *a, double *value);
void consistent_share(struct model *model, enum model_array array, struct spread *shares);
int consistent_holder(const struct model *model, size_t point);
void consistent_field(struct model *model, selas_field field, const double *y, const double *a, size_t from,
                      size_t end, double *value);

/* accelerate.c: a = M^-1 (F - K u - C v), with the halo if it travels, M v and energies with the H-form. */
void hform_accelerate(struct consistent *c, const struct drive *drive, double half_step, const double *u,
                      const double *v, bool travels, double *a);
void hform_weigh(struct consistent *c, const double *v, double *product); /* M v */
void hform_energy(struct consistent *c, const double *y, struct energy *energy);

#endif
