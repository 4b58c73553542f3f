/* selas.h - smoothed-point elastodynamics: the only public header.
 *
 * A simulation is an opaque handle. Every call that can fail returns a status; selas_message() says where it
 * failed, what was wrong and what would be right. The library never prints, exits or installs a signal
 * handler. */
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

/* --- A simulation, from deck to results
 * ------------------------------------------------------------------------ */

/* Opens a simulation from a deck file (doc/deck.md). Reads and checks the deck and builds the scene; points
 * and operator are made by the first call that needs them. A failed open still sets *simulation to a handle
 * that holds only the message (NULL if there was no memory even for that): close it as any other. Errors:
 * SELAS_BAD_DECK, SELAS_BAD_SCENE, SELAS_FILE_ERROR, SELAS_BAD_ARGUMENT (a NULL pointer), SELAS_NO_MEMORY. */
SELAS_API selas_status selas_open_deck(const char *path, selas_simulation **simulation);

/* The same with overrides[0..count-1], each "group%name=value" as on the command line. */
SELAS_API selas_status selas_open_deck_with(const char *path, size_t count, const char *const *overrides,
                                            selas_simulation **simulation);

/* The same from deck text in memory (ended by '\0'); name stands for the file's name in messages and in
 * output/NAME. */
SELAS_API selas_status selas_open_text(const char *name, const char *text, selas_simulation **simulation);

/* Runs to the first step at or past `time` (to rounding); steps are never shortened. Past the end time it
 * goes on. Errors: SELAS_UNSTABLE (the message says where and when), SELAS_BAD_SCENE (no stable step),
 * SELAS_UNSUPPORTED. */
SELAS_API selas_status selas_advance(selas_simulation *simulation, double time);
/* Runs `steps` steps. */
SELAS_API selas_status selas_step(selas_simulation *simulation, unsigned long steps);

/* Time reached, end time of the deck, time step (0 before the first call that needs it), steps done and steps
 * that the finished histories need in all. NaN resp. 0 for a NULL or failed simulation. */
SELAS_API double selas_time(const selas_simulation *simulation);
SELAS_API double selas_end_time(const selas_simulation *simulation);
SELAS_API double selas_time_step(selas_simulation *simulation);
SELAS_API unsigned long selas_steps(const selas_simulation *simulation);
SELAS_API unsigned long selas_steps_needed(selas_simulation *simulation);

/* Values of a receiver at the step reached, in deck coordinates: value[0..2] (vectors), [0..5] (tensors), [0]
 * (scalars). Errors: SELAS_BAD_ARGUMENT for an unknown receiver or field. */
SELAS_API selas_status selas_receiver(selas_simulation *simulation, const char *name, selas_field field,
                                      double *value);

/* Runs on as far as the finished histories need and corrects them (time-dispersion transform, low-pass,
 * output rows). */
SELAS_API selas_status selas_finish(selas_simulation *simulation);
/* After selas_finish: rows of a receiver's history, value[6 * row] = ux uy uz vx vy vz. The arrays belong to
 * the simulation. */
SELAS_API selas_status selas_history(selas_simulation *simulation, const char *name, size_t *rows,
                                     const double **time, const double **value);

/* Asks for result files: call before the first step; selas_write then leaves them in the deck's output
 * directory. */
SELAS_API selas_status selas_record(selas_simulation *simulation);
/* Finishes if need be, computes the exact solution if the deck asks for one, writes all results. */
SELAS_API selas_status selas_write(selas_simulation *simulation);
/* Writes only RECEIVER.exact.dat of every receiver, at history_step or 600 rows to end_time; builds no
 * points. */
SELAS_API selas_status selas_write_exact(selas_simulation *simulation);

/* The plan: tells one line after the other as key and value (points, memory, time step, resolution, ...);
 * runs nothing. */
SELAS_API selas_status selas_plan(selas_simulation *simulation,
                                  void (*tell)(void *context, const char *key, const char *value),
                                  void *context);

/* All messages so far (errors and warnings, one a line), "" if none; valid until the next call. Never NULL.
 */
SELAS_API const char *selas_message(const selas_simulation *simulation);
/* Folder that selas_write fills; "" if the simulation has none. */
SELAS_API const char *selas_output_directory(const selas_simulation *simulation);

/* Ends a simulation and sets the handle to NULL; NULL or a pointer to NULL is fine. */
SELAS_API void selas_close(selas_simulation **simulation);

/* --- Names
 * ----------------------------------------------------------------------------------------------------- */

/* Short gloss of a status, e.g. "the deck or an override is wrong"; never NULL. */
SELAS_API const char *selas_status_gloss(selas_status status);
/* Name of a status as written in this header, e.g. "SELAS_BAD_DECK"; never NULL. */
SELAS_API const char *selas_status_name(selas_status status);
SELAS_API const char *selas_version(void);

#ifdef __cplusplus
}
#endif
#endif
