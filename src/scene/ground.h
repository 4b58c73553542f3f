/* The ground as a field: what the rock is at any place of the body, and where it jumps. */
#ifndef SELAS_SCENE_GROUND_H
#define SELAS_SCENE_GROUND_H

#include "scene/scene.h"

/* Beyond a face, and within this many spacings of it, the ground is what lies there below it: averages and absorbing
 * layers reach beyond, and blocks often end on the face. */
#define GROUND_FILM .02

struct rock {
    double density, lambda, mu; /* lambda: that of the scene's dimension and plane */
};

/* Of a part of damped ground (method/damped/damped.h): its bulk and shear modulus over those of the whole. */
struct shares {
    double bulk, shear;
};

/* Rock at a place in the body's frame; outside the body that of its nearest face or beyond. Of damped ground with
 * unrelaxed moduli; of a part of it that of the whole. */
struct rock ground_at(const struct scene *scene, const double place[3]);
/* What a part of damped ground has of it, and what that leaves of the rock; graded ground has shares that go over
 * evenly. ground_part_at(): of any other scene all. */
struct shares ground_shares_at(const struct scene *scene, const double place[3]);
struct rock ground_part_at(const struct scene *scene, const double place[3]);
/* Is the ground within this box of the body's frame, none of it above the surface, sure to be one rock? */
bool ground_is_even(const struct scene *scene, const double low[3], const double high[3]);
/* Speeds of P and S waves; in damped ground at the source's frequencies. */
void ground_speeds_at(const struct scene *scene, const double place[3], double speed[2]);
/* model_grid.c: even between the values of the grids, beyond the body as at its nearest face. */
struct rock ground_model_at(const struct ground_model *model, const double place[3]);
struct shares ground_model_shares(const struct ground_model *model, const double place[3]);
/* Depths from < z < to at which its values lie on the line through `place`, falling together with neither end; even
 * between them. */
size_t ground_model_kinks(const struct ground_model *model, const double place[3], double from, double to,
                          double *at);
/* A value of one of the model's grids, without a name. */
struct material ground_model_material(const struct ground_model *model, const struct model_grid *grid,
                                      size_t i);
/* How far the ground of a model lies above the plane of face z-; of one with a surface of its own, read with depth =
 * 'sea'. */
double ground_model_height(const struct ground_model *model, const double place[2]);
/* Least distance of the heights of that surface in the file. */
double ground_model_step(const struct ground_model *model);
/* Lets go of what is kept of grids that are read in pieces; no other thread asks for values meanwhile. Takes NULL. */
void ground_model_forget(const struct ground_model *model);
/* Bytes of values that were asked for of them since then, and of all their values. Takes NULL. */
void ground_model_bytes(const struct ground_model *model, double bytes[2]);
/* False: values that were asked for could not be read (or had no memory). Takes NULL. */
bool ground_model_sound(const struct ground_model *model);
void ground_model_free(struct ground_model *model); /* takes NULL */
/* Places from < x < to along a line through `place` at which the rock may jump, in no order; at most
 * ground_jumps_at_most(). */
size_t ground_jumps(const struct scene *scene, const double place[3], int axis, double from, double to,
                    double *at);
size_t ground_jumps_at_most(const struct scene *scene);
/* The surface above or below a place, along depth, of the body's frame. */
double ground_surface(const struct scene *scene, const double place[3]);
/* Where the ground begins along an axis of the body's frame: along depth at the highest point of the surface. */
double ground_low(const struct body *body, int axis);
/* Does the rock change smoothly anywhere? */
bool ground_grades(const struct scene *scene);
/* Length over which the rock changes along an axis of the surface; 0: it may jump. */
double ground_detail(const struct scene *scene, int axis);
/* Is its upper face not level? */
bool layer_leans(const struct layer *layer);
/* Does the layer begin at the surface, wherever that is? */
bool layer_covers(const struct layer *layer);
/* Depth of a layer's upper face above or below a place. */
double layer_top_at(const struct layer *layer, const double place[3]);
/* Does a layer that is level or tilted begin below all of the body? */
bool layer_is_below(const struct body *body, const struct layer *layer);
/* Can the rock be another one further along this axis? */
bool ground_varies(const struct scene *scene, int axis);

/* More than layers of even rock: what only the general operator takes. */
bool ground_is_general(const struct scene *scene);
/* The same, or its lattice is graded over depth. */
bool ground_needs_general(const struct scene *scene);
/* Does the last axis point down, from a surface? Pictures of the plane have it upwards else. */
bool ground_has_depth(const struct scene *scene);
/* Is any of its materials damped? */
bool ground_is_damped(const struct scene *scene);

#endif
