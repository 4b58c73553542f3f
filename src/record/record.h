/* Record: what a run leaves. The recorder watches the state step by step; nothing is written in half: each
 * file goes to a temporary name in the same folder, is flushed and renamed. */
#ifndef SELAS_RECORD_H
#define SELAS_RECORD_H

#include "exact/exact.h"
#include "stepping/stepping.h"

#include <stdio.h>

struct recorder;

/* History of one receiver, finished (corrected by the scheme, low-passed, on the rows of history_step). */
struct history_rows {
    size_t rows;
    const double *time;  /* [rows] */
    const double *value; /* [6 * rows]: ux uy uz vx vy vz, deck coordinates */
};

/* Wall seconds of a rank in steps since this process began: at work, and in exchanges with others. */
struct rank_times {
    double worked, waited;
};

/* What has to be known of the run for the report besides what the recorder saw. */
struct run_figures {
    double wall_seconds, cpu_seconds;             /* stepping */
    double setup_wall_seconds, setup_cpu_seconds; /* trial of scene%accuracy, points, operator, time step */
    double exact_cpu_seconds;
    int threads;
    double halo_bytes; /* that this rank sent in the last step */
    double
        ground[2]; /* bytes of values of a model in pieces: read for the lattice by the rank with most, all */
    struct rank_times here, mean, longest;
};

/* Prepares probes, buffers and the folder's name; writes nothing yet. */
selas_status recorder_create(const struct scene *scene, struct model *model, const struct stepper *stepper,
                             struct recorder **recorder, struct messages *messages);
/* Together: remembers the files that the deck names, for checkpoints and results: soon after they were read.
 * SELAS_FILE_ERROR where they are not the same on all ranks. */
selas_status recorder_keep_files(struct recorder *recorder, struct messages *messages);
/* Together, on ranks: the memory of the largest rank, for the plan. */
void recorder_weigh(struct recorder *recorder);
/* Together: makes the folder and locks it against other runs. Not called for `check` and by hosts that want no files.
 * `work`: folder with the snapshots of the run that goes on (checkpoint_read), NULL: begins anew. */
selas_status recorder_open(struct recorder *recorder, const char *work, struct messages *messages);
/* To be called with the initial state and after every step: receivers, due snapshots and profiles, energy
 * watch. SELAS_UNSTABLE (with place and time) if the state is not finite or energy grows without work done.
 */
selas_status recorder_observe(struct recorder *recorder, const struct state *state,
                              struct messages *messages);
/* Before and after a change of the loads at the time of the step that was seen last: that step once more, in place
 * of what was seen of it; of finished histories nothing changes any more. */
void recorder_forget(struct recorder *recorder, const struct state *state);
selas_status recorder_observe_again(struct recorder *recorder, const struct state *state,
                                    struct messages *messages);
/* After the last step: corrects and resamples the histories. */
selas_status recorder_finish(struct recorder *recorder, struct messages *messages);
struct history_rows recorder_history(const struct recorder *recorder, size_t receiver);
/* Writes everything: deck.nml, NAME.dat, NAME.exact.dat (exact may be NULL), PROFILE.dat, run.h5, run.xdmf,
 * report.txt, and with output%plots the PNGs. */
selas_status recorder_write(struct recorder *recorder, struct exact *exact, const struct run_figures *figures,
                            struct messages *messages);
/* After recorder_write: the last lines of the report, with the errors of the velocity alone. */
void recorder_summary(const struct recorder *recorder, const struct run_figures *figures, FILE *out);
/* Of a run that was stopped: RECEIVER.dat and, with output%plots, their pictures, and PROFILE.dat, as far as
 * it came, marked unfinished, into the folder of what is not finished; they go when the run is over. */
selas_status recorder_write_so_far(struct recorder *recorder, struct messages *messages);
/* Value of a receiver at the state given (mid-run, as computed), deck coordinates; `value` has room for 6. */
void recorder_value(struct recorder *recorder, size_t receiver, selas_field field, const struct state *state,
                    double *value);
/* The plan that `selas check` prints and report.txt begins with, one key and value after the other: points,
 * unknowns, lattice, method, scheme, time step and how it was chosen, steps, memory and bytes per point,
 * points per wavelength of the slowest wave at the loads' cutoff (history_cutoff), which parts are on,
 * model's describe, estimated time (some steps are timed; `stepper` is NULL once the run has begun: no time).
 */
void recorder_plan(struct recorder *recorder, struct stepper *stepper,
                   void (*tell)(void *context, const char *key, const char *value), void *context);
/* Writes RECEIVER.exact.dat of every receiver without any run: rows at history_step, or 600 to end_time. */
selas_status record_exact(const struct scene *scene, struct exact *exact, struct messages *messages);
/* plots/ground.c: ground.png in the folder of the results, the ground as a run will see it. SELAS_UNSUPPORTED
 * unless the body is a box in two or three dimensions. */
selas_status record_ground(const struct scene *scene, struct messages *messages);
/* checkpoint.c: state and recorder to a file and back, bit for bit. Writing checks the file by reading it
 * back before it gets its name; the one before stays as NAME_before.h5 if `keep` says so. Reading wants the
 * same scene, and with result files (recorder_open) the snapshots beside the checkpoint; SELAS_FILE_ERROR
 * with the reason, after which state and recorder are of no use. `spent`: seconds of stepping, kept too. */
enum checkpoint_keep {
    KEEP_NOTHING,
    KEEP_LAST,           /* as NAME_before.h5 */
    KEEP_LAST_AND_BEFORE /* and what has that name as NAME_earlier.h5 */
};
selas_status checkpoint_write(struct recorder *recorder, struct state *state, const struct run_figures *spent,
                              const char *path, enum checkpoint_keep keep, struct messages *messages);
selas_status checkpoint_read(struct recorder *recorder, struct state *state, struct run_figures *spent,
                             const char *path, struct messages *messages);
/* The folder with what is not finished (recorder_open), made if it is not there. */
selas_status recorder_unfinished(struct recorder *recorder, const char **folder, struct messages *messages);
void recorder_free(struct recorder **recorder);

#endif
