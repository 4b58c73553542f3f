/* Inside of the advice on scenes: advice.c (resolution, step, receivers, loads), start.c (states at t = 0),
 * waves.c (what waves err by on their way), points.c (patches on points), ringing.c (damped bodies), jumps.c
 * (states and weights where the rock jumps), fields.c (stresses there), places.c (receivers near sources, surfaces
 * before layers), layers.c (absorbing layers), mirrors.c (symmetry planes), edges.c (moved faces that meet
 * others), voids.c (places in holes and gaps), beyond.c (ground that goes on), stacks.c (ground that goes to and
 * fro), soft.c (thin soft layers), heights.c (what splines leave out of heights), bending.c (slender bodies of
 * particles), idle.c (words that change nothing). */
#ifndef SELAS_ADVICE_PARTS_H
#define SELAS_ADVICE_PARTS_H

#include "advice/advice.h"
#include "scene/ground.h"

struct adviser {
    const struct scene *scene;
    void (*tell)(void *context, const char *key, const char *value);
    void *context;
    size_t count;
};

/* One warning: what may be wrong, and what would be right. */
void advise(struct adviser *adviser, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Waves of fewer points are not waves but noise, whatever the method. */
#define FEWEST_POINTS 4.0

/* What waves on points err by is told of from here on. */
#define WAVES_SEEN .1

/* At so many widths a pulse or Gaussian is 2e-3 of its peak. */
#define STATE_REACH 3.5

/* Is the ground, level layers too, carried by the general operator? */
bool by_general_operator(const struct scene *scene);
/* Has the consistent method the exact mass there? */
bool by_exact_mass(const struct scene *scene);
/* Largest distance of neighbouring points about a place of the deck. */
double spacing_at(const struct scene *scene, const double position[3]);
/* A traction on a square or a disc. */
bool has_patch(const struct load *load);
/* Half its extent along an axis; 0 across its face. */
double half_size(const struct load *load, int axis);

/* What waves of a number k err by after a way. */
double error_of_waves(const struct scene *scene, const struct wave_law *law, double k, double way);
/* How far waves run by end_time, or before they leave through absorbing faces. */
double longest_way(const struct scene *scene, double speed);
/* Wave number of what is typical in the velocity of the initial state where phases err as its power order + 1 (the
 * root of the mean of its power 2 order + 2); angular frequency that loads send with half their largest amplitude; 0:
 * not known. */
double typical_number(const struct scene *scene, double order);
double typical_frequency(const struct scene *scene);
/* Would the cloud method take the scene, and is not that of the model? */
bool cloud_would_run(const struct adviser *adviser, const struct model *model);
/* When loads and moved faces begin to send waves. */
double sending_begins(const struct scene *scene);
/* The consistent method? */
bool on_splines(const struct model *model);

/* Do moduli differ by more than a twentieth (jumps.c)? */
bool rocks_differ(struct rock one, struct rock other);
/* Which places count, of what; NULL: all do. */
typedef bool jump_counts(const struct scene *scene, const void *of, const double place[3]);
/* Does the rock jump on a line through `place`, in the ground, at a place that counts (jumps.c)? */
bool jumps_on(const struct scene *scene, const double place[3], int axis, double from, double to,
              jump_counts *counts, const void *of);
/* The same of lines through a box of the lattice: evenly over it, and through each block. */
bool jumps_in(const struct scene *scene, const double low[3], const double high[3], jump_counts *counts,
              const void *of);

/* What does nothing (nothing.c). */
void look_at_nothing(struct adviser *adviser);
/* Words that change nothing (idle.c). */
void look_at_idle_words(struct adviser *adviser, const struct stepper *stepper);
/* Short waves in the state at t = 0, faces that cut it, a velocity that jumps at them. */
void look_at_short_waves(struct adviser *adviser, const struct model *model);
void look_at_cut_start(struct adviser *adviser);
void look_at_impact(struct adviser *adviser);
/* A state that lies where the rock jumps (jumps.c). */
void look_at_crossed_rock(struct adviser *adviser);
/* Damped bodies that ring below the source's band (ringing.c). */
void look_at_ringing_body(struct adviser *adviser);
/* Moment tensors that begin with a jump. */
void look_at_cut_moment(struct adviser *adviser);
/* Tables that are samples too far apart. */
void look_at_tables(struct adviser *adviser, const struct stepper *stepper);
/* Leapfrog's time error where it stays. */
void look_at_time_error(struct adviser *adviser, const struct stepper *stepper);
/* Waves that a method's points carry badly (waves.c). */
void look_at_method(struct adviser *adviser, const struct model *model);
/* Slender bodies that bend too softly, where that is more than is told already. */
void look_at_bending(struct adviser *adviser, const struct model *model, double told);
/* Loads' waves that splines carry too far. */
void look_at_long_way(struct adviser *adviser, const struct model *model);
/* A patch on points that do not see it as it is. */
void look_at_points(struct adviser *adviser, const struct model *model, size_t load);
/* Absorbing layers thinner than the spacing deserves. */
void look_at_layers(struct adviser *adviser, const struct stepper *stepper);
/* Slabs between faces that guide waves, which grow in layers. */
void look_at_guided(struct adviser *adviser);
void look_at_contrast(struct adviser *adviser);
/* Places that are looked at where there is no body (voids.c). */
void look_at_voids(struct adviser *adviser, const struct model *model);
/* Few points between a hole and an edge. */
void look_at_ligament(struct adviser *adviser);
/* Loads that stay on between layers that give way, and what pulses leave there. */
void look_at_rests(struct adviser *adviser);
void look_at_late(struct adviser *adviser);
/* What acts as far as faces behind which the ground goes on, or beyond them (beyond.c). */
void look_at_beyond(struct adviser *adviser);
/* Moment tensors too near to layers. */
void look_at_clearance(struct adviser *adviser);
/* Moment tensors right below free faces, of other splines than those of degree 2 with open ends. */
void look_at_shallow(struct adviser *adviser, const struct model *model);
/* Receivers in the midst of a point source. */
void look_at_nearness(struct adviser *adviser);
/* Receivers that the edges of a moving patch come by. */
void look_at_passed(struct adviser *adviser, size_t load);
/* Moment tensors beside interfaces of general ground. */
void look_at_interfaces(struct adviser *adviser);
/* Stresses that are asked for where the rock jumps (fields.c). */
void look_at_fields(struct adviser *adviser);
/* What a snapshot shows and a spacing about it, on the lattice (fields.c). */
void snapshot_box(const struct scene *scene, const struct snapshot *snapshot, double low[3], double high[3]);
/* Stresses in rock that is nearly incompressible (fields.c). */
void look_at_pressures(struct adviser *adviser);
/* Rock that jumps in general ground (jumps.c, stacks.c, soft.c). */
void look_at_weights(struct adviser *adviser);
void look_at_walls(struct adviser *adviser);
void look_at_stacks(struct adviser *adviser);
void look_at_soft_layers(struct adviser *adviser);
void look_at_covers(struct adviser *adviser);
void look_at_damped_cells(struct adviser *adviser);
/* Absorbing layers where dampers send nothing back. */
void look_at_columns(struct adviser *adviser);
/* Dampers where an absorbing layer cannot be, and nobody asked for them. */
void look_at_fallen_layers(struct adviser *adviser);
/* Tilted layers that go on beyond a box that the program chose. */
void look_at_tilted(struct adviser *adviser);
void look_at_grading(struct adviser *adviser);
/* A surface that absorbing layers change. */
void look_at_levelled(struct adviser *adviser);
void look_at_smoothed(struct adviser *adviser);
/* Edges in which faces prescribe different motions. */
void look_at_meetings(struct adviser *adviser);
/* Scenes that their own mirror images do not continue. */
void look_at_mirrors(struct adviser *adviser);

#endif
