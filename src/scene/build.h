/* What the files that build a scene from its deck share: where they build, how they complain, how they read
 * vectors and time functions. */
#ifndef SELAS_SCENE_BUILD_H
#define SELAS_SCENE_BUILD_H

#include "scene/point_sources.h"
#include "scene/scene.h"

struct builder {
    const struct deck *deck;
    struct scene *scene;
    struct messages *messages;
    selas_status status; /* SELAS_OK, or what went wrong first */
    bool body_known;     /* box and frame are right: places can be checked against them */
    bool accurate;       /* scene%accuracy: the spacing is not the deck's ... */
    double spacing;      /* ... but this one, or 0 for a first guess ... */
    double grading;      /* ... graded so where the deck says none; 0: even ... */
    const char *large;   /* ... why in a box from which nothing returns; NULL: where that is cheaper ... */
    long layer_points; /* ... with absorbing layers of at least so many points, where the program adds them */
};

/* Adds a line with the place of `name` in the group (deck_error); the building goes on. */
void complain(struct builder *builder, const struct deck_group *group, const char *name, const char *format,
              ...) __attribute__((format(printf, 4, 5)));
/* Notes that memory ran out. */
void complain_of_memory(struct builder *builder);

/* Zeroed array for an entry of the scene; NULL after complaining. */
void *scene_array(struct builder *builder, size_t count, size_t size);

/* Copies a name of at most NAME_SIZE - 1 bytes that must not be empty. */
bool take_name(struct builder *builder, const struct deck_group *group, const char *name,
               char text[NAME_SIZE]);
/* A vector with as many values as the scene has dimensions. take_: false if it is not given; need_: that is
 * an error, said with `purpose` ("a traction"). Both are false after an error; missing components are 0. */
bool take_vector(struct builder *builder, const struct deck_group *group, const char *name, double vector[3]);
bool need_vector(struct builder *builder, const struct deck_group *group, const char *name,
                 const char *purpose, double vector[3]);
/* topography_build.c: a place, by its vector or by all of it but the last and the depth below the surface. */
bool need_place(struct builder *builder, const struct deck_group *group, const char *name,
                const char *purpose, double place[3]);
/* A direction of any length but zero, made a unit vector. */
bool need_direction(struct builder *builder, const struct deck_group *group, const char *name,
                    const char *purpose, double unit[3]);
/* A real that `purpose` cannot do without. */
bool need_real(struct builder *builder, const struct deck_group *group, const char *name, const char *purpose,
               double *value);
/* Complains of each given name of the list (ended by NULL): it does not belong to `purpose`. */
void refuse(struct builder *builder, const struct deck_group *group, const char *const *names,
            const char *purpose);
/* The words of a time function; on an error it is empty. */
bool take_history(struct builder *builder, const struct deck_group *group, const char *purpose,
                  struct history *history);
/* The words of a time function, for refuse(). */
extern const char *const history_words[];

/* Path of a file that the deck names, relative to the deck's folder; free with array_free. */
char *deck_path(struct builder *builder, const char *path);

/* listed_loads.c: the file of point sources that a &load names; none after complaining. */
struct point_sources take_sources(struct builder *builder, const struct deck_group *group,
                                  enum load_kind kind);
/* Makes loads [sources->count] of it from the first, which holds what they have in common. */
void read_sources(struct builder *builder, const struct deck_group *group,
                  const struct point_sources *sources, struct load *load);

/* The parts, in this order; each reads its groups. */
void build_materials(struct builder *builder);
void build_body(struct builder *builder);
void build_layers(struct builder *builder);
void build_boundaries(struct builder *builder);
void build_topography(struct builder *builder); /* topography_build.c */
void build_grading(struct builder *builder);    /* grading_build.c */
void build_loads(struct builder *builder);
void build_initial(struct builder *builder);
void build_receivers(struct builder *builder);
void build_profiles(struct builder *builder);
void build_snapshots(struct builder *builder);

/* body.c: index of the material that a word names, or scene->materials after complaining. */
size_t find_material(struct builder *builder, const struct deck_group *group, const char *word);
/* model_file.c */
void build_model(struct builder *builder);
/* blocks.c */
void build_blocks(struct builder *builder);
/* blocks.c: a layer's upper face (dip and strike, or a file) and what it goes over to (bottom). */
void read_interface(struct builder *builder, const struct deck_group *group, struct layer *layer);
void read_grade(struct builder *builder, const struct deck_group *group, struct layer *layer);

/* body.c: spacing of the deck, or the one chosen for it; false (without complaint) if there is none. */
bool take_spacing(const struct builder *builder, const struct deck_group *group, double *spacing);

/* body.c: the largest spacing of at most `at_most` that divides every edge of the box; 0 if none above a
 * quarter of it does. */
double dividing_spacing(const struct body *body, int dimension, double at_most);

/* fitted_box.c: chooses low, high and the treatment of the sides of a half-space; false after complaining. */
bool choose_half_space(struct builder *builder, const struct deck_group *group);

/* fitted_box.c, when all else is built: refuses what the sides of a half-space whose box the deck gives cannot
 * serve, warns of dampers there. */
void check_half_space(struct builder *builder);

/* frame.c: sets body->frame, pivot and rotated from rotation, low and high. */
void body_set_frame(struct body *body);
/* Sine and cosine of an angle in degrees, exact at multiples of 90. */
void sine_of(double degrees, double *sine, double *cosine);

/* True if a place lies in the body, faces included (to a millionth of the spacing); `nearest` (may be NULL)
 * is then that place, else the nearest one of the box, both in the deck's coordinates. */
bool body_holds(const struct body *body, int dimension, const double position[3], double nearest[3]);
/* Distance below which two places are the same one. */
double body_tolerance(const struct body *body);

/* Text such as "1, 2.5, 0" of the first `count` components. */
enum { VECTOR_TEXT_SIZE = 96 };
const char *vector_text(char text[VECTOR_TEXT_SIZE], const double *vector, int count);

#endif
