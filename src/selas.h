/* selas.h - smoothed-point elastodynamics: the only public header.
 *
 * A simulation is an opaque handle. Every call that can fail returns a status; selas_message() says where it
 * failed, what was wrong and what would be right. The library never prints, exits or installs a signal
 * handler. A handle that is not open (or is closed: a copy of it), and one that another thread is inside of, are
 * answered with SELAS_BAD_ARGUMENT. Inside a call the thread's floating-point arithmetic is that of the standard,
 * without traps, and its locale "C"; functions of the host are called in its own. */
#ifndef SELAS_H
#define SELAS_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define SELAS_API __attribute__((visibility("default")))
#else
#define SELAS_API
#endif

#define SELAS_VERSION "0.1.0"

/* Status codes and their glosses: one list, so that they cannot part. */
#define SELAS_STATUS_LIST(X)                                                                                 \
    X(SELAS_OK, 0, "success")                                                                                \
    X(SELAS_BAD_DECK, 1, "the deck or an override is wrong")                                                 \
    X(SELAS_BAD_SCENE, 2, "the scene cannot be computed")                                                    \
    X(SELAS_BAD_ARGUMENT, 3, "an argument is out of its range")                                              \
    X(SELAS_NO_MEMORY, 4, "not enough memory")                                                               \
    X(SELAS_FILE_ERROR, 5, "a file cannot be read or written")                                               \
    X(SELAS_UNSTABLE, 6, "the run went unstable")                                                            \
    X(SELAS_NOT_CONVERGED, 7, "an iteration or a quadrature did not converge")                               \
    X(SELAS_UNSUPPORTED, 8, "this combination is not offered")                                               \
    X(SELAS_CALLBACK_FAILED, 9, "a callback of the host failed")                                             \
    X(SELAS_STOPPED, 10, "stopped on request; the state is kept")

typedef enum {
#define SELAS_STATUS_ENTRY(name, value, gloss) name = (value),
    SELAS_STATUS_LIST(SELAS_STATUS_ENTRY)
#undef SELAS_STATUS_ENTRY
} selas_status;

/* What a receiver, a profile or a snapshot can show. Units are the deck's own (any consistent set). */
typedef enum {
    SELAS_DISPLACEMENT, /* 3 components: x y z */
    SELAS_VELOCITY,     /* 3 */
    SELAS_ACCELERATION, /* 3 */
    SELAS_STRESS,       /* 6: xx yy zz xy yz zx */
    SELAS_STRAIN,       /* 6: xx yy zz xy yz zx (tensor shear, not engineering shear) */
    SELAS_PRESSURE,     /* 1: minus a third of the trace of the stress */
    SELAS_ENERGY        /* 1: kinetic plus strain energy per volume */
} selas_field;

typedef struct selas_simulation selas_simulation;

/* --- A simulation, from deck to results --- */

/* Opens a simulation from a deck file (doc/reference/deck.md). Reads and checks the deck and builds the scene; points
 * and operator are made by the first call that needs them. A failed open still sets *simulation to a handle
 * that holds only the message (NULL if there was no memory even for that): close it as any other; calls that would
 * use it return the status of the open. Errors:
 * SELAS_BAD_DECK, SELAS_BAD_SCENE, SELAS_FILE_ERROR, SELAS_BAD_ARGUMENT (a NULL pointer), SELAS_NO_MEMORY. */
SELAS_API selas_status selas_open_deck(const char *path, selas_simulation **simulation);

/* The same with overrides[0..count-1], each "group%name=value" as on the command line. */
SELAS_API selas_status selas_open_deck_with(const char *path, size_t count, const char *const *overrides,
                                            selas_simulation **simulation);

/* The same from deck text in memory (ended by '\0'); name stands for the file's name in messages and in
 * output/NAME. */
SELAS_API selas_status selas_open_text(const char *name, const char *text, selas_simulation **simulation);

/* selas_share of selas_mpi.h for the Fortran handle of a communicator. */
SELAS_API selas_status selas_share_handle(selas_simulation *simulation, int communicator);

/* Runs to the first step at or past `time` (to rounding); steps are never shortened. Past the end time it
 * goes on; there faces that the deck leaves open send waves back (a warning), and histories have no rows.
 * Errors: SELAS_UNSTABLE (the message says where and when), SELAS_BAD_SCENE (no stable step),
 * SELAS_UNSUPPORTED. */
SELAS_API selas_status selas_advance(selas_simulation *simulation, double time);
/* Runs `steps` steps. Errors: as selas_advance; SELAS_BAD_ARGUMENT beyond LONG_MAX, as numbers below 0 are. */
SELAS_API selas_status selas_step(selas_simulation *simulation, unsigned long steps);

/* Time reached, end time of the deck, time step (0 before the first call that needs it), steps done and steps
 * that the finished histories need in all. NaN resp. 0 for a NULL or failed simulation. */
SELAS_API double selas_time(const selas_simulation *simulation);
SELAS_API double selas_end_time(selas_simulation *simulation);
SELAS_API double selas_time_step(selas_simulation *simulation);
SELAS_API unsigned long selas_steps(const selas_simulation *simulation);
SELAS_API unsigned long selas_steps_needed(selas_simulation *simulation);

/* Values of a receiver at the step reached (for all ranks), in deck coordinates: value[0..2] (vectors), [0..5]
 * (tensors), [0] (scalars). Errors: SELAS_BAD_ARGUMENT for an unknown receiver or field. */
SELAS_API selas_status selas_receiver(selas_simulation *simulation, const char *name, selas_field field,
                                      double *value);

/* Runs on as far as the finished histories need and corrects them (time-dispersion transform, low-pass,
 * output rows). */
SELAS_API selas_status selas_finish(selas_simulation *simulation);
/* After selas_finish: rows of a receiver's history, value[6 * row] = ux uy uz vx vy vz. The arrays belong to
 * the simulation. */
SELAS_API selas_status selas_history(selas_simulation *simulation, const char *name, size_t *rows,
                                     const double **time, const double **value);

/* Asks for result files: call before the first step and before a value is read at t = 0; selas_write then leaves
 * them in the deck's output directory. */
SELAS_API selas_status selas_record(selas_simulation *simulation);
/* Finishes if need be, computes the exact solution if the deck asks for one, writes all results. */
SELAS_API selas_status selas_write(selas_simulation *simulation);
/* Writes only RECEIVER.exact.dat of every receiver, at history_step or 600 rows to end_time; builds no
 * points. */
SELAS_API selas_status selas_write_exact(selas_simulation *simulation);

/* The plan: tells one line after the other as key and value (points, memory, time step, resolution, ...);
 * runs nothing. `tell` must not call functions of the same simulation (they return SELAS_BAD_ARGUMENT). */
SELAS_API selas_status selas_plan(selas_simulation *simulation,
                                  void (*tell)(void *context, const char *key, const char *value),
                                  void *context);

/* All messages so far (errors and warnings, one a line), "" if none; valid until the next call. Never NULL. The advice
 * on a scene (doc/howto/troubleshooting.md) is said at the first step. A
 * failure that keeps all later calls from being done (a deck that cannot be opened, a scene that cannot be
 * built, a run that went unstable, values of which are not read either) is told once. */
SELAS_API const char *selas_message(const selas_simulation *simulation);
/* What the last call that returns a status said, "" if nothing; of a call that was not done because an
 * earlier one had failed, what that one said. Valid until the next call of this function. Never NULL. */
SELAS_API const char *selas_last_message(selas_simulation *simulation);
/* Folder that selas_write fills; "" if the simulation has none. */
SELAS_API const char *selas_output_directory(selas_simulation *simulation);

/* Ends a simulation and sets the handle to NULL; NULL or a pointer to NULL or to a closed one is fine. Not while a call
 * of it runs. */
SELAS_API void selas_close(selas_simulation **simulation);

/* --- Building a scene by calls ---
 *
 * A scene has the words of a deck (doc/reference/deck.md), set one by one; what is not set has the deck's default. Each
 * value is checked at once, as those of a deck are (name, type, number, range, choice); a call that is refused
 * changes nothing. What the words mean together is checked when the scene is first used, or by selas_build.
 * The calls also change a simulation that was opened from a deck. All of them, and the functions further below
 * that say so, must come before the first step. */

/* A scene with nothing in it; name is that of a deck: results go to output/NAME. */
SELAS_API selas_status selas_open_new(const char *name, selas_simulation **simulation);
/* Adds a group ("material", "load", "receiver", ...; not those that a deck always has: scene, method,
 * stepping, output); *number is its number, from 1, for words such as "load(2)%amplitude". Errors:
 * SELAS_BAD_DECK for an unknown group or one that may occur once and is there. */
SELAS_API selas_status selas_add(selas_simulation *simulation, const char *group, size_t *number);
/* Sets "group%word" or "group(2)%word" to values[0..count-1], in place of what it had. Errors: SELAS_BAD_DECK
 * for an unknown group or word, a wrong type, too many values, a value out of its range or choices, or a
 * group of which there are several ("load%face": say which); SELAS_BAD_ARGUMENT for NaN, infinities, NULL, no
 * values, or after the first step. */
SELAS_API selas_status selas_set_real(selas_simulation *simulation, const char *word, size_t count,
                                      const double *values);
SELAS_API selas_status selas_set_integer(selas_simulation *simulation, const char *word, long value);
SELAS_API selas_status selas_set_logical(selas_simulation *simulation, const char *word, bool value);
SELAS_API selas_status selas_set_text(selas_simulation *simulation, const char *word, size_t count,
                                      const char *const *values);
/* Gives the body points of the host's own (sets body%shape to 'points', in place of body%file): position[3 *
 * i] to [3 * i + 2] in the body's frame (unused components 0), volume[i] > 0 (area in 2D, length in 1D), and,
 * if not NULL, material[i] = number of a &material, from 1 (method 'sph', variant 'total-lagrangian'; others
 * refuse it). The arrays are copied. */
SELAS_API selas_status selas_set_points(selas_simulation *simulation, size_t count, const double *position,
                                        const double *volume, const size_t *material);
/* Checks the whole scene now. Errors: SELAS_BAD_DECK, SELAS_BAD_SCENE. */
SELAS_API selas_status selas_build(selas_simulation *simulation);

/* --- Loads that the host drives ---
 *
 * A host that drives anything switches the time-dispersion transform off (stepping%unwarp), because that
 * needs histories known beforehand. A load is named by its word `name`, or by its number ("1", "2", that of its
 * &load) if it has none; one whose `sources` names several cannot be driven (SELAS_UNSUPPORTED). */

/* A vector at a time and a place (deck coordinates). Returns 0 to go on, > 0 to stop after this step with the
 * state kept (the advancing call returns SELAS_STOPPED; the next one goes on), < 0 to fail
 * (SELAS_CALLBACK_FAILED; no step can follow). A value that is not finite counts as a failure. Called in
 * order of time, once for each step's time and place (Runge-Kutta schemes: once for each stage, for motions also the
 * times around it), and one step ahead of the state by the scheme 'modified-equation' and for motions; from the time
 * reached on again where set_load changes a load beside it. Only the thread that advances the
 * simulation calls it. It must not call functions of the same simulation (they return SELAS_BAD_ARGUMENT). */
typedef int (*selas_vector_function)(void *context, double time, const double position[3], double value[3]);

/* Traction [force/area] on a load of kind 'traction' (shape 'square' or 'face'; with 'point' a force; in 1D
 * the end's), in place of its direction, amplitude and history. The patch is cut into pieces no wider than
 * the spacing, each with the traction at its centre. Before the first step. Errors: SELAS_BAD_ARGUMENT,
 * SELAS_UNSUPPORTED (discs, moving patches, more than 100,000 pieces). */
SELAS_API selas_status selas_set_traction(selas_simulation *simulation, const char *load,
                                          selas_vector_function traction, void *context);
/* The same for a load of kind 'body-force': force per volume over the body (boxes), or a force with shape
 * 'point'. */
SELAS_API selas_status selas_set_body_force(selas_simulation *simulation, const char *load,
                                            selas_vector_function force, void *context);
/* Displacement [length] of a face ("x-", ...) of kind 'displacement' or 'velocity', which moves as one: the
 * function is asked at the face's middle and its component along boundary%direction counts. */
SELAS_API selas_status selas_set_motion(selas_simulation *simulation, const char *face,
                                        selas_vector_function displacement, void *context);
/* Holds a load at `value` (traction, force per volume or force, along its direction) from the time reached
 * on, in place of amplitude times history, until it is changed again: the acceleration at the time reached is
 * made anew with it. The first call for a load must come before the first step, later ones may come at any
 * time until the histories are finished. With Runge-Kutta schemes the value acts from the next step on. */
SELAS_API selas_status selas_set_load(selas_simulation *simulation, const char *load, double value);
/* Mean of SELAS_DISPLACEMENT, SELAS_VELOCITY or SELAS_ACCELERATION over the patch of a load (or the body, or
 * at the point), along the load's direction: that through which the load does work. */
SELAS_API selas_status selas_load_mean(selas_simulation *simulation, const char *load, selas_field field,
                                       double *value);
/* Mean acceleration over the patch of load `moved`, along its direction, that a unit of `load` makes at once (its
 * accelerance over one step): what set_load(load, value) adds to selas_load_mean of the acceleration is value times
 * this, at every time but t = 0, where faces with dampers beside the patch do not act yet. For loads that set_load
 * holds, with leapfrog or the modified equation and linear methods, where no function drives anything (else
 * SELAS_UNSUPPORTED). With one row and column a load it is what contact with a body needs (doc/howto/calling.md,
 * section 5). */
SELAS_API selas_status selas_load_response(selas_simulation *simulation, const char *load, const char *moved,
                                           double *value);

/* --- Whole fields --- */

/* The body's own points: mirror images included, points of absorbing layers left out; position[3 * i + c],
 * deck coordinates; total-Lagrangian points of a file in layers over its longest axis, others of a file in its order.
 * The array belongs to the simulation and stays until it is closed or changed. */
SELAS_API selas_status selas_points(selas_simulation *simulation, size_t *count, const double **position);
/* A field at all points at the step reached: value[components * i + c], deck coordinates. The array belongs
 * to the simulation and stays as it is until the next call of this function. */
SELAS_API selas_status selas_field_values(selas_simulation *simulation, selas_field field, size_t *count,
                                          size_t *components, const double **value);
/* Kinetic and strain energy of the body at the step reached. Errors: SELAS_UNSUPPORTED. */
SELAS_API selas_status selas_energy(selas_simulation *simulation, double *kinetic, double *strain);

/* --- Checkpoints --- */

/* Saves state, time and histories in the file `path` (HDF5; it has its name only when it is complete, on the
 * disk, and read back). With result files the snapshots so far are kept in the folder `unfinished` of the
 * output directory. Errors: SELAS_FILE_ERROR, SELAS_UNSTABLE (the state is not finite). */
SELAS_API selas_status selas_save(selas_simulation *simulation, const char *path);
/* Goes on where selas_save left off: on a simulation of the same scene before its first step, with the same
 * loads driven by the host; with result files right after selas_record. What follows is bit for bit what the
 * saved simulation would have given (of another commit of the version: a warning). Errors: SELAS_FILE_ERROR (no
 * checkpoint, another version, byte order or scene, cut short, damaged, snapshots missing: no step can follow),
 * SELAS_BAD_ARGUMENT. */
SELAS_API selas_status selas_restore(selas_simulation *simulation, const char *path);

/* --- Names --- */

/* Numbers that a field has at each place: 3, 6 or 1; 0 for no field. */
SELAS_API int selas_field_components(selas_field field);
/* Short gloss of a status, e.g. "the deck or an override is wrong"; never NULL. */
SELAS_API const char *selas_status_gloss(selas_status status);
/* Name of a status as written in this header, e.g. "SELAS_BAD_DECK"; never NULL. */
SELAS_API const char *selas_status_name(selas_status status);
SELAS_API const char *selas_version(void);

#ifdef __cplusplus
}
#endif
#endif
