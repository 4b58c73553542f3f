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

/* Short gloss of a status, e.g. "the deck or an override is wrong"; never NULL. */
SELAS_API const char *selas_status_gloss(selas_status status);
/* Name of a status as written in this header, e.g. "SELAS_BAD_DECK"; never NULL. */
SELAS_API const char *selas_status_name(selas_status status);
SELAS_API const char *selas_version(void);

#ifdef __cplusplus
}
#endif
#endif
