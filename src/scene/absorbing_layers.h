/* Absorbing layers as the scene asks for them (doc/theory/absorbing-faces.md, sections 3, 5 and 6). */
#ifndef SELAS_SCENE_ABSORBING_LAYERS_H
#define SELAS_SCENE_ABSORBING_LAYERS_H

#include "scene/scene.h"

/* Why the scene's method cannot have absorbing layers, so that transmitting faces have dampers where the deck
 * does not say; NULL: it can. */
const char *layers_refusal(const struct scene *scene);

enum { LAYER_POINTS = 8, LEAST_POINTS = 4, MOST_POINTS = 40 };
/* alpha of (9), times c_p / L: with alpha = 0 motions of frequency 0 in the layer would drift for ever. */
#define LAYER_RELAXATION .1

/* What a point costs besides in each layer that it lies in (edges: two), against one of the body
 * (doc/developers/performance.md, section 5). */
double layer_cost(const struct scene *scene);
/* Work of a step as for so many points of the body, below the scene's mirror planes; layers: those of the faces, as the
 * scene has them. */
double scene_work(const struct scene *scene);
/* Steps with layers for one without: limits of the modified equation, sqrt(12 / 6). */
double layer_steps(const struct scene *scene);

/* The inverse of the mass carries the forces of a moment tensor on into layers: what stays behind there of one so many
 * cells away, in parts of its largest displacement, and the cells that it ought to keep
 * (doc/theory/absorbing-faces.md, section 2). room: cells between it and the nearest end of the lattice along that
 * axis, 0 where the ground changes along it. */
double layer_left_behind(const struct scene *scene, double room, double cells);
double layer_clearance(const struct scene *scene, double room);

/* The degree of the splines beside layers. */
long layer_degree(const struct scene *scene);

/* Is there an absorbing layer behind a face? How many points it has, 0 if there is none. */
bool layer_needed(const struct scene *scene, int face);
size_t layer_points(const struct scene *scene, int face);
/* Distance of points across a face, in the layer too. */
double layer_spacing(const struct scene *scene, int face);
/* Has any face one? */
bool layer_anywhere(const struct scene *scene);
/* Reflection at normal incidence that the profile of an absorbing layer of so many points is made for, and
 * the one to be expected by measurement. */
double layer_profile_reflection(const struct scene *scene, int face, size_t points);
double layer_expected_reflection(size_t points);
/* ln(1/R) as fields that hardly change feel it: where velocities are damped (11) the outer part does not move. */
double layer_stretch(const struct scene *scene, int face, size_t points);
/* The least R of (9) where waves are guided, for what grows in layers goes by its logarithm; 0: none are. */
double layer_least_reflection(const struct scene *scene, int face);
/* Speed of S waves in the fastest material over that in the slowest. */
double ground_contrast(const struct scene *scene);
/* Waves guided along a layer, whose phase and group velocities may be opposite, would grow in it: velocities there
 * are damped besides, at this share of the layer's own damping d times (d / largest d)^4 (Eq 11a); 0: none are. */
double layer_drag(const struct scene *scene, int face);
/* Is a block's rock that of the layer behind a face? Those that end on the face are; they go on beyond it. */
bool block_goes_on(const struct scene *scene, const struct ground_block *block, int face);
/* Is an absorbing layer that the scene asks for left out, since no wave that the face sends back is seen by
 * receivers and profiles within end_time? */
bool layer_left_out(const struct scene *scene, int face);

#endif
