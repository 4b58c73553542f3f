/* The parts of the recorder, shared by the files of this room only. */
#ifndef SELAS_RECORD_PARTS_H
#define SELAS_RECORD_PARTS_H

#include "record/record.h"

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* One receiver: what every step showed, and the finished rows. */
struct trace {
    struct probe probe;
    size_t rows, room;
    double *u, *v, *a; /* [3 * room], rows at step 0, 1, 2, ... */
    double *value;     /* [6 * finished rows] */
};

/* A profile: at each of its times the fields of all its points, interpolated over four steps. */
struct profile_record {
    const struct profile *profile;
    struct probe *probe;  /* [points] */
    unsigned fields;      /* the profile's; in single precision displacements beside stresses, not shown */
    size_t columns;       /* of all these together */
    unsigned long *first; /* [times] first of the four steps */
    double *weight;       /* [4 * times] Lagrange weights of these */
    double *value;        /* [times * points * columns] */
    unsigned char *seen;  /* [times] how many of the four steps have come */
};

/* A group of snapshots and the part of the body that it shows. */
struct snapshot_record {
    const struct snapshot *snapshot;
    size_t due;        /* index of the next time */
    size_t points;     /* that are shown */
    size_t grid[3];    /* of the points shown, 0 0 0 if they form no lattice */
    size_t corner[3];  /* of the body's lattice, where that of a part begins */
    size_t *index;     /* [points] which ones, ascending, of a part that is no lattice; else NULL */
    bool regular;      /* the lattice lies along the deck's axes ... */
    double origin[3];  /* ... begins here ... */
    double step[3];    /* ... and has these spacings */
    size_t room;       /* points in the largest piece of the body */
    double *buffer;    /* [room * 6] one field of a piece */
    char position[48]; /* path of the positions in run.h5 */
};

/* One snapshot that was written. */
struct snapshot_entry {
    size_t group; /* occurrence of &snapshot */
    size_t number;
    double time;
};

struct run_file;

/* The watch over the energy of a run. */
struct watch {
    /* numbers that go on with a run: a checkpoint holds them all, in this order */
    double work, gross, absorbed;      /* trapezoid sums; gross: of positive power only */
    double power, power_absorbed;      /* at the last step */
    double damped, power_damped;       /* what damped materials take, if output%balance asks for it */
    double initial, largest;           /* energy: at the start, largest so far */
    double reference, reference_until; /* without work: largest energy up to this time */
    double turn, strain;               /* largest rotation [rad] and strain at recorder->place */
    double due, arrived; /* energy that was given, about when it was most, and what the body had of it */
    struct energy last;
    double worked, let_out, taken; /* of `work`, `absorbed` and `damped`, at that time */
    double largest_defect;         /* largest |E - E0 - work + absorbed + damped| */
    double gained;                 /* E - E0 - work + absorbed + damped at the end */
    double last_time;
    double sampled; /* sum of squares of a sample of the velocities when they were last energetic */
    double next;    /* step of the next look at the whole state */
    double untold;  /* 1: dampers did not tell all in some step, here or where the run was before (ranks) */
    /* what watch_start() makes anew */
    double face_energy, face_rate; /* moved faces do work of the order of face_energy (1 + face_rate t)^2 */
    bool with_faces;               /* there are such */
    bool by_work;                  /* the model tells the power of loads and dampers */
};
enum { WATCH_NUMBERS = offsetof(struct watch, face_energy) / sizeof(double) };

struct recorder {
    const struct scene *scene;
    struct model *model;
    const struct stepper *stepper;
    struct trace *trace; /* [scene->receivers] */
    size_t rows;         /* finished */
    double *time;        /* [rows] */
    double *exact;       /* [receivers * rows * 6] or NULL */
    double *stress;      /* the same of exact stresses, behind it; NULL: not asked for */
    bool finished, written;
    const char *folder; /* of text results and their plots: that of the results or of what is unfinished */
    bool so_far;        /* these are of a run that goes on later */
    struct profile_record *profile;   /* [scene->profiles] */
    struct snapshot_record *snapshot; /* [scene->snapshots] */
    size_t entries, entry_room;
    struct snapshot_entry *entry;
    double shown[SELAS_ENERGY + 1]; /* the largest numbers of snapshots, field by field */
    struct run_file *file;
    struct watch watch;
    struct watch before; /* as it was before the last step was seen */
    double before_time;  /* last_time then */
    size_t places;       /* at which rotations are looked at */
    struct probe *place;
    double
        turned; /* the largest rotation that was seen beside small strains, too large for level images; 0: none */
    bool looked_back; /* hindsight has told what it has to tell */
    unsigned long last_step;
    double last_time;
    bool started;
    bool recording; /* with result files, which the first rank has */
    char *files;    /* kept_files() as they were read; NULL: not yet */
    double memory;  /* planned bytes of the largest rank; 0: one alone */
};

/* recorder.c; together: true for the first rank, which then has all that receivers and profiles have seen */
bool recorder_gather(struct recorder *recorder);

/* trace.c: receivers step by step, and their finished rows */
selas_status trace_create(struct recorder *recorder, struct messages *messages);
selas_status trace_observe(struct recorder *recorder, const struct state *state, struct messages *messages);
/* Together: the first rank gets what every step showed at the receivers of others. */
void trace_gather(struct recorder *recorder);
selas_status trace_finish(struct recorder *recorder, struct messages *messages);
/* Room for as many rows of all receivers. */
selas_status trace_reserve(struct recorder *recorder, size_t rows, struct messages *messages);
/* Lets the finished rows go: they are made anew. */
void trace_unfinish(struct recorder *recorder);
/* Forgets the last row of all receivers. */
void trace_forget(struct recorder *recorder);
void trace_free(struct recorder *recorder);

/* Rows 0, step, 2 step, ... up to end (to rounding); SELAS_BAD_SCENE beyond a thousand million. */
selas_status row_count(double end, double step, size_t *rows, struct messages *messages);

/* low_pass.c: zero-phase low-pass exp(-(omega / cutoff)^4) of `columns` interleaved series, in place. With
 * `from_rest` the series is zero before its first row; its other end goes on by point reflection. */
selas_status low_pass(double dt, double cutoff, bool from_rest, size_t rows, size_t columns, double *series,
                      struct messages *messages);

/* profile.c */
selas_status profile_create(struct recorder *recorder, struct messages *messages);
bool profile_due(const struct recorder *recorder, unsigned long step); /* is it looked at? */
void profile_observe(struct recorder *recorder, const struct state *state);
/* Takes away what was seen of the state, which is as it was then. */
void profile_forget(struct recorder *recorder, const struct state *state);
/* Largest component of a field in all profiles; 0 where none shows it. */
double profiles_largest(const struct recorder *recorder, selas_field field);
/* Together: the first rank gets the values of others. */
void profile_gather(struct recorder *recorder);
selas_status profile_write(struct recorder *recorder, struct messages *messages);
void profile_free(struct recorder *recorder);

/* snapshot.c: which points, which times */
selas_status snapshot_create(struct recorder *recorder, struct messages *messages);
bool snapshot_due(const struct recorder *recorder, const struct state *state);
selas_status snapshot_observe(struct recorder *recorder, const struct state *state,
                              struct messages *messages);
/* Writes those of the state's time again. */
selas_status snapshot_observe_again(struct recorder *recorder, const struct state *state,
                                    struct messages *messages);
void snapshot_free(struct recorder *recorder);
/* The k-th body point that is shown. */
size_t snapshot_point(const struct model *model, const struct snapshot_record *record, size_t k);
/* Body points one piece after the other: where the piece ends that begins at point `from`, and the rank that can show
 * it. Pieces of a model with `holder` are planes, 10^5 points or a sixteenth of what a rank has; without it each rank
 * has one. */
size_t snapshot_piece(const struct model *model, size_t from, int *holder);

/* run_file.c: run.h5. `work`: folder of the run that goes on, or NULL (unfinished.h). */
selas_status run_file_open(struct recorder *recorder, const char *work, struct messages *messages);
/* snapshot_file.c; together */
selas_status run_file_snapshot(struct recorder *recorder, const struct snapshot_record *record,
                               const struct state *state, size_t number, struct messages *messages);
/* Together: points, snapshots, histories, settings, provenance: writes the file and gives it its name. */
selas_status run_file_finish(struct recorder *recorder, const struct run_figures *figures,
                             struct messages *messages);
/* Lets the folder go; when all results are there (`complete`), what was kept of the unfinished run goes too.
 */
void run_file_close(struct recorder *recorder, bool complete);
/* Reads `count` blocks of `block` rows, `stride` rows apart, of one field of one snapshot from the finished
 * run.h5; value [count * block * components]. */
selas_status run_file_read(const struct recorder *recorder, size_t number, selas_field field, size_t start,
                           size_t stride, size_t count, size_t block, double *value,
                           struct messages *messages);

/* xdmf.c: run.xdmf */
selas_status xdmf_write(const struct recorder *recorder, struct messages *messages);

/* watch.c: energy and finite values */
void watch_start(struct recorder *recorder);
selas_status watch_observe(struct recorder *recorder, const struct state *state, struct messages *messages);
/* SELAS_UNSTABLE if the state is not finite: for a look out of turn, which leaves no trace. */
selas_status watch_sound(const struct recorder *recorder, const struct state *state,
                         struct messages *messages);

/* histories.c: the exact histories into recorder->exact, NULL if they cannot be had; NAME.dat and
 * NAME.exact.dat */
selas_status histories_compare(struct recorder *recorder, struct exact *exact, struct messages *messages);
/* Relative L2 error of the velocity vector at the worst receiver; recorder->exact must be there. */
double histories_error(const struct recorder *recorder);
enum { MISSED_TEXT = 256 };
/* True if that is more than scene%accuracy asked for, with what to say. */
bool histories_missed(const struct recorder *recorder, char text[MISSED_TEXT]);
selas_status histories_write(struct recorder *recorder, struct messages *messages);
/* A line of comment that says so if they are of a run that goes on later. */
void histories_note(FILE *out, const struct recorder *recorder);

/* plan.c: the plan without timing anything */
void plan_tell(const struct recorder *recorder,
               void (*tell)(void *context, const char *key, const char *value), void *context);

/* estimate.c: wall-clock seconds of a step and its record, measured; negative without memory. To be called
 * before the state of the run is made. */
double estimate_step(const struct recorder *recorder, struct stepper *stepper);

/* report.c: report.txt */
selas_status report_write(struct recorder *recorder, struct exact *exact, const struct run_figures *figures,
                          struct messages *messages);

/* plots: PNGs and the GIF; what goes wrong here is a warning */
void plot_histories(struct recorder *recorder, struct messages *messages);
void plot_snapshots(struct recorder *recorder, struct messages *messages);
/* Nothing where no material is damped. */
void plot_damping(struct recorder *recorder, struct messages *messages);
/* plots/ground.c: does a run draw its ground, ground.png? Where it is not even. */
bool plots_ground(const struct scene *scene);
void plot_ground(const struct scene *scene, struct messages *messages);

/* provenance.c: commit of the source ("unknown") */
const char *build_commit(void);
/* Version, commit, compiler, flags, libraries, host, and date. */
void provenance_tell(void (*tell)(void *context, const char *key, const char *value), void *context);

#endif
