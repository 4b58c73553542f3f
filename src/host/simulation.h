/* Inside of a simulation: what host/simulation.c and the rooms behind the library's door share. */
#ifndef SELAS_SIMULATION_H
#define SELAS_SIMULATION_H

#include "base/c_locale.h"
#include "base/float_rules.h"
#include "compare/diff.h"
#include "deck/deck.h"
#include "exact/exact.h"
#include "record/record.h"
#include "scene/scene.h"
#include "selas.h"
#include "stepping/stepping.h"

/* A load whose traction, force or body force the host gives. */
struct driven_load {
    size_t group;                   /* occurrence of &load */
    size_t load;                    /* in the scene: another one once a list of sources before it grows */
    selas_vector_function function; /* NULL: the host holds the load at `value` along its direction */
    void *context;
    double value;
    size_t first,
        pieces; /* with a function: its pieces, loads of their own along each axis, behind the deck's */
};

/* A face whose motion a function of the host gives. */
struct driven_face {
    selas_vector_function function;
    void *context;
};

struct host {
    size_t loads, room;
    struct driven_load *load;
    struct driven_face face[FACES];
    struct host_drive drive;
    int answer;              /* what the callbacks returned since this was last looked at: the worst */
    char refused[NAME_SIZE]; /* the load or face whose callback it was */
    bool told;               /* that a function gives what the sides of the box hold */
};

struct selas_simulation {
    struct messages messages;
    struct deck *deck;
    struct scene *scene;
    struct model *model;
    struct stepper *stepper;
    struct state state;
    struct recorder *recorder;
    struct exact *exact;
    struct run_figures figures;
    bool prepared, recording, finished;
    bool advised;        /* the host, or the user by the program, has been told the advice on the scene */
    bool warned;         /* that it looks where the deck does not */
    bool strained;       /* that a receiver's stress is that of a smooth strain */
    bool erring;         /* that stresses of particles err more than velocities */
    bool busy;           /* a callback of the host is running */
    bool dirty;          /* loads at the time reached have changed; the acceleration has not yet */
    selas_status broken; /* why no scene could be opened or built from what was set so far */
    selas_status failed; /* why no step can follow */
    size_t call;         /* where in the messages the last call began */
    size_t failure[2];   /* first and last byte of the failure that keeps later calls from being done */
    bool consequence;    /* the last call was not done because of that failure */
    char *last;          /* what selas_last_message handed out */
    struct host host;
    struct ranks *ranks;  /* that share the work, borrowed; NULL: one alone */
    struct ranks *joined; /* the same of a host's communicator; NULL: there is none */
    struct given_points points;
    double *point_position, *point_volume;
    size_t *point_material;
    double *values; /* fields handed out: [values_room] */
    size_t values_room;
    double *scratch;      /* [state_size + loads], for means */
    unsigned mirrors;     /* the scene's planes, known beside it */
    double *lattice;      /* [3 * points]: positions, once a host asks and the model does not store them */
    char *results;        /* folder of the results in place of the deck's; NULL */
    char *work;           /* folder of the checkpoint from which the run goes on; NULL */
    locale_t host_locale; /* of the host's thread: its functions are called in it */
    fenv_t host_rules;    /* the same of its floating-point arithmetic */
    const char *inside;   /* the thread inside a call of this simulation; NULL: none (door.c) */
};

/* host/door.c */
struct door {
    struct c_locale locale;
    struct float_rules rules;
    selas_simulation
        *entered; /* no longer by its thread once this call returns; NULL: by an outer call, or refused */
};
/* First in every function of the library that computes, or may read or write a number, in a file or a message: until it
 * returns the thread's locale is "C", its arithmetic that of the standard, and no other thread can use the simulation.
 * `simulation` may be NULL. */
#define AT_THE_DOOR(simulation)                                                                              \
    __attribute__((cleanup(door_leave), unused)) const struct door at_the_door = door_enter(simulation)
struct door door_enter(selas_simulation *simulation);
void door_leave(const struct door *door);
/* The handle is that of an open simulation from now on; false without memory. And: is it no longer, is it one? */
bool door_open(const selas_simulation *simulation);
void door_close(const selas_simulation *simulation);
bool door_known(const selas_simulation *simulation);
/* Nobody was inside, this thread is now. */
bool door_taken(selas_simulation *simulation);
/* Another thread was inside when this one came, or the handle is none: this thread may not look into it. */
bool door_refused(const selas_simulation *simulation);

/* An empty handle. */
selas_status simulation_new(selas_simulation **simulation);

/* A function of the library begins: what it says from here on is the message of the last call. NULL is fine. */
void simulation_call(selas_simulation *simulation);
/* What this call has said keeps later calls from being done. */
void simulation_keep_failure(selas_simulation *simulation);
/* No step can follow, for what this call has said. */
void simulation_failed(selas_simulation *simulation, selas_status status);
/* A call that is not done because of what an earlier one has said; that is not said again. */
selas_status simulation_consequence(selas_simulation *simulation, selas_status status);
/* SELAS_OK if the handle can be used by this thread, and is not inside one of its own callbacks. */
selas_status simulation_check(selas_simulation *simulation);
/* The same; builds the scene if it is not there. */
selas_status simulation_scene(selas_simulation *simulation);
/* The same, with model, time step and recorder, without files. */
selas_status simulation_prepare(selas_simulation *simulation);
/* SELAS_OK if a folder of results that is no whole path is that of the deck's opening. */
selas_status simulation_at_home(selas_simulation *simulation);
/* The state at rest of one that is prepared; remembers the files that its deck names. Together, on ranks. */
selas_status simulation_state(selas_simulation *simulation);
/* The same as simulation_prepare, with the state at t = 0 or later, sound, and the loads as they are now; else why no
 * step can follow. */
selas_status simulation_begin(selas_simulation *simulation);
/* Together: what drives a step, beyond end_time too. */
selas_status simulation_reach(selas_simulation *simulation, unsigned long step);
/* Runs on as far as the finished histories need, and finishes them. */
selas_status simulation_finish(selas_simulation *simulation);
/* SELAS_OK as long as the scene may still be changed: before the first step. */
selas_status simulation_may_change(selas_simulation *simulation);
/* Throws away everything behind the deck: it has changed. */
void simulation_discard(selas_simulation *simulation);

/* host/checkpoints.c */
/* Opens the deck that a checkpoint keeps; selas_record and selas_restore make a run of it that goes on in the
 * checkpoint's folder. SELAS_FILE_ERROR with the reason. */
selas_status simulation_open_checkpoint(const char *path, struct ranks *ranks, selas_simulation **simulation);
/* Opens the deck that run.h5 keeps, with overrides; results go to output/NAME-rerun. */
selas_status simulation_open_run(const char *path, size_t count, const char *const *overrides,
                                 selas_simulation **simulation);
/* Path of the checkpoint of a run with result files (free it); NULL without memory. */
char *simulation_checkpoint_path(selas_simulation *simulation);
/* Saves the state there, if it is sound. */
selas_status simulation_checkpoint(selas_simulation *simulation, enum checkpoint_keep keep);

/* host/shared.c: together: from now on the ranks share the work of this simulation, before its model is made. What
 * opening came to on all; SELAS_BAD_DECK where their decks are not the same. */
selas_status simulation_share(selas_simulation *simulation, struct ranks *ranks, selas_status status);
/* Together: what the model's making and all of the preparing came to, on all ranks. Values of a &model that were read
 * meanwhile are counted and let go; SELAS_FILE_ERROR where some could not be read. */
selas_status shared_made(selas_simulation *simulation, selas_status status);
selas_status shared_prepared(selas_simulation *simulation, selas_status status);
/* SELAS_UNSUPPORTED for what is not done on more than one rank. */
selas_status shared_check(selas_simulation *simulation);
/* Time of this rank in steps; together: that of all, for the report. */
void shared_add_times(selas_simulation *simulation, double wall, double waited);
void shared_gather_times(selas_simulation *simulation);
/* The same for a call: "WHAT: on one rank only". */
selas_status shared_alone(selas_simulation *simulation, const char *what);
/* Together: SELAS_BAD_ARGUMENT on all ranks where a load's value is not finite on one, or not the same on all. */
selas_status shared_value(selas_simulation *simulation, const char *load, double value);

/* host/trial.c: a trial_run (accuracy/trial.h). */
selas_status host_trial(struct scene *scene, struct exact *exact, double *error, struct history_file *kept,
                        struct messages *messages);

/* host/driven_loads.c */
/* Gives the loads and faces that the host drives their pieces: after the scene is built. */
selas_status host_prepare_scene(selas_simulation *simulation);
/* Puts the host behind the driver: after the stepper is made. */
void host_prepare_stepper(selas_simulation *simulation);
/* What the callbacks said since the last call: SELAS_OK, SELAS_STOPPED or SELAS_CALLBACK_FAILED. */
selas_status host_answer(selas_simulation *simulation);
/* Makes the state's acceleration that of the loads as they are now. */
selas_status host_refresh(selas_simulation *simulation);
/* Name of a load, or the number of its &load if it has none. */
enum { LOAD_NUMBER_SIZE = 32 };
const char *load_name(const struct scene *scene, size_t load, char number[LOAD_NUMBER_SIZE]);
/* SELAS_OK if this load is all of its &load; SELAS_UNSUPPORTED: one of several sources. */
selas_status host_drives_all(selas_simulation *simulation, size_t load);
/* SELAS_OK if a function can move this face. */
selas_status host_moves(selas_simulation *simulation, enum face face);
/* SELAS_OK if a function can give this load, or the reason why not. */
selas_status host_can_drive(const struct scene *scene, const struct load *load, struct messages *messages);
void host_free(selas_simulation *simulation);

/* looks.c: the advice on the scene as messages, once; and a warning, once, where what is asked for, of the whole body
 * or at a place, may hold what a face sends back that has no absorbing layer. */
void host_advise(selas_simulation *simulation);
void host_looks_at_all(selas_simulation *simulation);
void host_looks_at(selas_simulation *simulation, const double position[3], const char *what);
/* Warns, once, that strains of receivers are smooth where the rock jumps; and of what those of particles err by. */
void host_reads(selas_simulation *simulation, const struct receiver *receiver, selas_field field);

#endif
