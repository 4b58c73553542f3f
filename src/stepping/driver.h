/* What drives a model over time: amplitudes of its loads, motions of its faces. Behind it stand the deck's
 * histories, these histories warped (time_dispersion.h), or a host of the library. */
#ifndef SELAS_DRIVER_H
#define SELAS_DRIVER_H

#include "model/model.h"

/* A host that drives what the scene marks so (enum driven). */
struct host_drive {
    void *context;
    /* Amplitudes [loads] and displacements of faces (per amplitude) [FACES] at `time`: come in as the deck
     * has them; the host changes those that it drives. Called once for each step's time, in order, and for
     * one step ahead where second differences are taken. */
    void (*at)(void *context, double time, double *load, double *displacement);
};

enum { DRIVER_ROWS = 4 };

/* A row holds the amplitudes of all loads and the displacements of all faces at one step. */
struct driver {
    const struct scene *scene;
    double dt;
    bool moves;                    /* a face moves */
    const struct host_drive *host; /* borrowed; NULL: nothing is a host's */
    double *warped;                /* [warped_rows][loads + FACES]; NULL: histories as they are */
    unsigned long warped_rows;
    double *row;                     /* [DRIVER_ROWS][loads + FACES] */
    unsigned long step[DRIVER_ROWS]; /* of each row */
    double
        *last; /* [loads + 3 * FACES]: the drive made last; faces: displacements, velocities, accelerations */
};

/* The deck's histories drive. On failure (SELAS_NO_MEMORY) driver_free() is still to be called. */
selas_status driver_create(struct driver *driver, const struct scene *scene, double dt,
                           struct messages *messages);
void driver_free(struct driver *driver);
/* Takes warped histories for the first `rows` steps; from then on driver_at() is not to be asked. */
selas_status driver_warp(struct driver *driver, unsigned long rows, struct messages *messages);
/* Are there the rows of this step and the one after it? As many more as that takes: a host goes on past end_time. */
bool driver_reaches(const struct driver *driver, unsigned long step);
selas_status driver_reach(struct driver *driver, unsigned long step, struct messages *messages);

/* The drive at any time: derivatives of motions are exact, with a host differences over half a step. A drive
 * holds until the next one is asked for. */
struct drive driver_at(struct driver *driver, double time);
/* Amplitudes as they are; with the load term of the modified equation, one twelfth of their own second differences;
 * that term alone, with faces at rest. */
enum driver_terms { DRIVER_PLAIN, DRIVER_CORRECTED, DRIVER_CORRECTION };
/* The drive at step n: derivatives of motions are differences over dt. */
struct drive driver_at_step(struct driver *driver, unsigned long n, enum driver_terms terms);
/* The drive that was made last. */
struct drive driver_last(const struct driver *driver, double time);

/* The host has changed what it drives: steps from the one given on are asked for again. */
void driver_changed(struct driver *driver, unsigned long step);

#endif
