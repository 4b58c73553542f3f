/* What must hold of any deck, without a reference: each deck of the command line is run, then run again with a change
 * that must not show (doc/developers/robustness.md). Velocities and displacements of all receivers are compared,
 * relative to the largest number of their kind.
 *
 *   nothing    one load more, of amplitude 0, at the place of the first one
 *   halves     each load as two of half the amplitude
 *   doubled    all that drives, twice as strong (linear methods)
 *   sum        the loads one by one, the others next to nothing
 *   receiver   one receiver more (given box)
 *   depth      places in place of depths below the surface
 *   later      all that drives begins some steps later: the histories too
 *   longer     the first part of a longer run (given box)
 *   rows       every second row
 *   restart    stopped and gone on with at two drawn steps: the same bits
 *   threads    three threads: the same bits
 *   quiet, whole, passes    method%quiet = 0, symmetry = F, fused = F
 *   driven     the loads' values from a host
 *   calls      step by step, the receivers asked at each
 *   displacement ... energy    fields at points where receivers stand
 *   files      run.h5 has places and velocities of the points, run.xdmf the places
 *
 * Arguments: seed, decks. Prints a TAP line a deck, with the worst relation. */
#include "advice/parts.h"
#include "base/memory.h"
#include "host/simulation.h"
#include "scene/ground.h"

#include <hdf5.h>
#include <math.h>
#include <omp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static uint64_t seed;

static size_t chance(size_t n)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (size_t)(seed >> 33) % n;
}

/* --- Decks ------------------------------------------------------------------------------------------------ */

/* A deck while it is changed. */
struct edit {
    struct deck *deck;
    struct messages messages;
    bool good;
};

static void set(struct edit *edit, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void set(struct edit *edit, const char *format, ...)
{
    char text[4000];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    edit->good = edit->good && deck_set(edit->deck, text, &edit->messages) == SELAS_OK;
}

static size_t add(struct edit *edit, const char *group)
{
    size_t number = 0;
    edit->good = edit->good && deck_add(edit->deck, group, &number, &edit->messages) == SELAS_OK;
    return number;
}

static const struct deck_group *group(const struct edit *edit, const char *name, size_t index)
{
    return deck_get(edit->deck, name, index);
}

static double real_or(const struct deck_group *of, const char *word, double otherwise)
{
    return deck_values(of, word) > 0 ? deck_real(of, word, 0) : otherwise;
}

/* All words of load `from` for a new one. */
static size_t copy_load(struct edit *edit, size_t from)
{
    const size_t to = add(edit, "load");
    for (size_t i = 0; edit->good; i++) {
        const struct deck_group *load = group(edit, "load", from);
        const char *word = deck_word(load, i);
        if (word == NULL) break;
        if (!deck_given(load, word) || strcmp(word, "name") == 0) continue;
        char values[3000] = "";
        for (size_t k = 0; k < deck_values(load, word); k++) {
            static const char *const texts[] = {"kind", "face", "shape", "history", "file", "sources"};
            const char *comma = k > 0 ? "," : "";
            bool text = false;
            for (size_t t = 0; t < sizeof texts / sizeof *texts; t++)
                text = text || strcmp(word, texts[t]) == 0;
            char *end = values + strlen(values);
            const size_t room = sizeof values - strlen(values);
            if (!text) {
                snprintf(end, room, "%s%.17g", comma, deck_real(load, word, k));
                continue;
            }
            const char *said = deck_text(load, word, k);
            const bool file = strcmp(word, "file") == 0 || strcmp(word, "sources") == 0;
            char *path = file ? deck_absolute(edit->deck, said) : NULL;
            snprintf(end, room, "%s'%s'", comma, path != NULL ? path : said);
            array_free(path);
        }
        set(edit, "load(%zu)%%%s=%s", to, word, values);
    }
    return to;
}

static double load_amplitude(const struct edit *edit, size_t k)
{
    return real_or(group(edit, "load", k), "amplitude", 1);
}

/* --- Runs ------------------------------------------------------------------------------------------------- */

struct outcome {
    selas_status status;
    char message[400];
    size_t receivers, rows;
    double dt, *time, *value, largest[2]; /* value[receiver][rows][6] */
};

static void outcome_free(struct outcome *o)
{
    free(o->time);
    free(o->value);
    *o = (struct outcome){.status = SELAS_OK};
}

/* A deck and what is done to it. */
struct task {
    const char *path;
    double dt;               /* 0: the program's */
    size_t receivers;        /* that are compared, */
    const struct deck *base; /* of this deck */
    void (*change)(struct edit *edit, const struct task *task);
    selas_status (*march)(selas_simulation *run, const struct task *task, const char *echo);
    size_t one; /* for change: a load */
    double shift, part;
    bool plain;                /* without the time-dispersion transform */
    const struct scene *scene; /* the deck's */
    int threads;
};

static void collect(selas_simulation *run, const struct task *task, struct outcome *o)
{
    const size_t receivers = task->receivers;
    o->dt = selas_time_step(run);
    o->receivers = receivers;
    for (size_t r = 0; r < receivers && o->status == SELAS_OK; r++) {
        const char *name = deck_text(deck_get(task->base, "receiver", r), "name", 0);
        const double *time, *value;
        o->status = selas_history(run, name, &o->rows, &time, &value);
        if (o->status != SELAS_OK) return;
        if (r == 0) {
            o->time = calloc(o->rows, sizeof *o->time);
            o->value = calloc(6 * receivers * o->rows, sizeof *o->value);
            memcpy(o->time, time, o->rows * sizeof *time);
        }
        memcpy(o->value + 6 * r * o->rows, value, 6 * o->rows * sizeof *value);
    }
    for (size_t i = 0; i < 6 * receivers * o->rows; i++)
        o->largest[i % 6 / 3] = fmax(o->largest[i % 6 / 3], fabs(o->value[i]));
}

static selas_simulation *open(const struct task *task, struct outcome *o, char **echo)
{
    struct edit edit = {.good = true};
    selas_simulation *run = NULL;
    o->status = deck_read_file(task->path, 0, NULL, &edit.deck, &edit.messages);
    edit.good = o->status == SELAS_OK;
    set(&edit, "output%%plots=F");
    set(&edit, "output%%history_step="); /* each step, as relations count them */
    if (task->dt > 0) {
        const struct deck_group *stepping = group(&edit, "stepping", 0);
        if (edit.good && (deck_given(stepping, "courant") || deck_given(stepping, "safety")))
            edit.good = false;
        set(&edit, "stepping%%time_step=%.17g", task->dt);
    }
    if (edit.good && task->change != NULL) task->change(&edit, task);
    *echo = edit.good ? deck_echo(edit.deck, &edit.messages) : NULL;
    if (*echo == NULL) {
        o->status = SELAS_BAD_DECK;
        snprintf(o->message, sizeof o->message, "%s", edit.messages.text != NULL ? edit.messages.text : "?");
    } else {
        o->status = selas_open_text("deck", *echo, &run);
        if (o->status == SELAS_OK) o->status = selas_build(run);
    }
    messages_free(&edit.messages);
    deck_free(&edit.deck);
    return run;
}

static struct outcome go(const struct task *task)
{
    struct outcome o = {.status = SELAS_OK};
    char *echo = NULL;
    omp_set_num_threads(task->threads > 0 ? task->threads : 1);
    selas_simulation *run = open(task, &o, &echo);
    if (o.status == SELAS_OK && task->march != NULL) o.status = task->march(run, task, echo);
    if (o.status == SELAS_OK) o.status = selas_finish(run);
    if (o.status == SELAS_OK) collect(run, task, &o);
    if (o.status != SELAS_OK && o.message[0] == '\0')
        snprintf(o.message, sizeof o.message, "%s", run != NULL ? selas_message(run) : "no handle");
    o.message[strcspn(o.message, "\n")] = '\0';
    selas_close(&run);
    free(echo);
    return o;
}

/* Largest difference over the largest number, row `every` i of `base` against row i + `offset`; where all begins later
 * the row of a load's jump, which has its middle, is left out. */
static double apart(const struct outcome *base, const struct outcome *o, double factor, size_t offset,
                    size_t every)
{
    double worst = 0;
    size_t compared = 0;
    if (o->receivers != base->receivers) return INFINITY;
    for (size_t r = 0; r < base->receivers; r++)
        for (size_t i = offset > 0; every * i < base->rows && i + offset < o->rows; i++, compared++)
            for (size_t c = 0; c < 6; c++) {
                const double one = base->value[6 * (r * base->rows + every * i) + c];
                const double other = o->value[6 * (r * o->rows + i + offset) + c];
                const double error = fabs(other - factor * one) / (fabs(factor) * base->largest[c / 3]);
                if (!(error <= worst)) worst = error;
            }
    return compared > 0 ? worst : INFINITY;
}

/* --- Changes ---------------------------------------------------------------------------------------------- */

static void add_nothing(struct edit *edit, const struct task *task)
{
    (void)task;
    set(edit, "load(%zu)%%amplitude=0", copy_load(edit, 0));
}

static void halve(struct edit *edit, const struct task *task)
{
    (void)task;
    const size_t loads = deck_count(edit->deck, "load");
    for (size_t k = 0; k < loads; k++) {
        const double half = load_amplitude(edit, k) / 2;
        set(edit, "load(%zu)%%amplitude=%.17g", copy_load(edit, k), half);
        set(edit, "load(%zu)%%amplitude=%.17g", k + 1, half);
    }
}

static void one_load(struct edit *edit, const struct task *task)
{
    for (size_t k = 0; k < deck_count(edit->deck, "load"); k++)
        if (k != task->one) set(edit, "load(%zu)%%amplitude=%.17g", k + 1, 1e-30 * load_amplitude(edit, k));
}

static void strengthen(struct edit *edit, const struct task *task)
{
    (void)task;
    for (size_t k = 0; k < deck_count(edit->deck, "load"); k++)
        set(edit, "load(%zu)%%amplitude=%.17g", k + 1, 2 * load_amplitude(edit, k));
}

static void add_receiver(struct edit *edit, const struct task *task)
{
    const struct body *body = &task->scene->body;
    char place[100] = "";
    for (int c = 0; c < task->scene->dimension; c++)
        snprintf(place + strlen(place), sizeof place - strlen(place), "%s%.17g", c > 0 ? "," : "",
                 body->low[c] + (.3 + .4 * (double)chance(1000) / 1000) * (body->high[c] - body->low[c]));
    const size_t number = add(edit, "receiver");
    set(edit, "receiver(%zu)%%name='further'", number);
    set(edit, "receiver(%zu)%%position=%s", number, place);
}

static void name_place(struct edit *edit, int dimension, size_t number, const double *x)
{
    set(edit,
        dimension == 3   ? "receiver(%zu)%%position=%.17g,%.17g,%.17g"
        : dimension == 2 ? "receiver(%zu)%%position=%.17g,%.17g"
                         : "receiver(%zu)%%position=%.17g",
        number, x[0], x[1], x[2]);
}

/* Other receivers of the same names take over. */
static void name_places(struct edit *edit, const struct task *task)
{
    for (size_t k = 0; k < task->receivers; k++) {
        char name[NAME_SIZE];
        snprintf(name, sizeof name, "%s", deck_text(group(edit, "receiver", k), "name", 0));
        set(edit, "receiver(%zu)%%name='gone%zu'", k + 1, k);
        const size_t number = add(edit, "receiver");
        set(edit, "receiver(%zu)%%name='%s'", number, name);
        name_place(edit, task->scene->dimension, number, task->scene->receiver[k].position);
    }
}

static void begin_later(struct edit *edit, const struct task *task)
{
    for (size_t k = 0; k < deck_count(edit->deck, "load"); k++)
        set(edit, "load(%zu)%%start=%.17g", k + 1, real_or(group(edit, "load", k), "start", 0) + task->shift);
    for (size_t k = 0; k < deck_count(edit->deck, "boundary"); k++)
        if (deck_values(group(edit, "boundary", k), "history") > 0)
            set(edit, "boundary(%zu)%%start=%.17g", k + 1,
                real_or(group(edit, "boundary", k), "start", 0) + task->shift);
    set(edit, "scene%%end_time=%.17g", deck_real(group(edit, "scene", 0), "end_time", 0) + task->shift);
    if (task->plain) set(edit, "stepping%%unwarp=F");
}

static void run_longer(struct edit *edit, const struct task *task)
{
    set(edit, "scene%%end_time=%.17g", deck_real(group(edit, "scene", 0), "end_time", 0) + task->shift);
    if (task->plain) set(edit, "stepping%%unwarp=F");
}

static void every_second(struct edit *edit, const struct task *task)
{
    set(edit, "output%%history_step=%.17g", 2 * task->dt);
}

static void nothing_quiet(struct edit *edit, const struct task *task)
{
    (void)task;
    set(edit, "method%%quiet=0");
}

static void whole(struct edit *edit, const struct task *task)
{
    (void)task;
    set(edit, "method%%symmetry=F");
}

static void pass_by_pass(struct edit *edit, const struct task *task)
{
    (void)task;
    set(edit, "method%%fused=F");
}

static void not_unwarped(struct edit *edit, const struct task *task)
{
    (void)task;
    set(edit, "stepping%%unwarp=F");
}

/* --- Ways to the end -------------------------------------------------------------------------------------- */

static selas_status stop_twice(selas_simulation *run, const struct task *task, const char *echo)
{
    char path[64];
    (void)task;
    snprintf(path, sizeof path, "/tmp/selas-decks-%ld.h5", (long)getpid());
    selas_status status = SELAS_OK;
    for (int k = 0; k < 2 && status == SELAS_OK; k++) {
        status = selas_step(run, 1 + chance(selas_steps_needed(run) / 2 + 1));
        if (status == SELAS_OK) status = selas_save(run, path);
        selas_simulation *other = NULL;
        if (status == SELAS_OK) status = selas_open_text("deck", echo, &other);
        if (status == SELAS_OK) status = selas_restore(other, path);
        if (status == SELAS_OK) { /* goes on in the same handle */
            struct selas_simulation keep = *run;
            *run = *other;
            *other = keep;
        }
        selas_close(&other);
    }
    (void)remove(path);
    return status;
}

/* The receivers as they are asked for while the run goes on, against the rows of the history. */
static selas_status step_by_step(selas_simulation *run, const struct task *task, const char *echo)
{
    (void)task;
    (void)echo;
    selas_status status = SELAS_OK;
    double value[3];
    const double dt = task->dt;
    for (double t = 0; status == SELAS_OK && t < selas_end_time(run); t += dt * (double)(1 + chance(3))) {
        status = selas_advance(run, t);
        for (size_t r = 0; r < task->receivers && status == SELAS_OK; r++)
            status = selas_receiver(run, deck_text(deck_get(run->deck, "receiver", r), "name", 0),
                                    SELAS_VELOCITY, value);
    }
    return status;
}

static int load_value(void *context, double time, const double position[3], double value[3])
{
    const struct load *load = context;
    (void)position;
    for (int c = 0; c < 3; c++)
        value[c] =
            load->amplitude * load->direction[c] * history_value(&load->history, fmax(time, 1e-300), 0);
    return 0;
}

static selas_status drive(selas_simulation *run, const struct task *task, const char *echo)
{
    (void)echo;
    for (size_t k = 0; k < task->scene->loads; k++) {
        const struct load *load = &task->scene->load[k];
        const char *name = load->name;
        char number[24];
        snprintf(number, sizeof number, "%zu", k + 1);
        if (*name == '\0') name = number;
        const selas_status status = load->kind == LOAD_TRACTION
                                        ? selas_set_traction(run, name, load_value, (void *)load)
                                        : selas_set_body_force(run, name, load_value, (void *)load);
        if (status != SELAS_OK) return status;
    }
    return SELAS_OK;
}

/* --- Snapshots -------------------------------------------------------------------------------------------- */

enum { PLACES = 6 };

struct places {
    size_t count;
    double at[PLACES][3];
    bool kinked[PLACES]; /* receivers there know kinks of displacements that fields do not */
};
static struct places places;

static void add_places(struct edit *edit, const struct task *task)
{
    for (size_t k = 0; k < places.count; k++) {
        const size_t number = add(edit, "receiver");
        set(edit, "receiver(%zu)%%name='place%zu'", number, k);
        name_place(edit, task->scene->dimension, number, places.at[k]);
    }
}

/* Distance of a field at the points from what receivers at them say, over the field's largest number; that of motion at
 * places with kinks is the second. */
static selas_status field_apart(selas_simulation *run, selas_field field, double worst[2])
{
    size_t points, count, components;
    const double *position, *value;
    selas_status status = selas_points(run, &points, &position);
    if (status == SELAS_OK) status = selas_field_values(run, field, &count, &components, &value);
    double largest = 0;
    for (size_t i = 0; status == SELAS_OK && i < points * components; i++)
        largest = fmax(largest, fabs(value[i]));
    for (size_t k = 0; status == SELAS_OK && k < places.count && largest > 0; k++) {
        size_t nearest = 0;
        double away = INFINITY, said[6];
        for (size_t i = 0; i < points; i++) {
            const double *x = position + 3 * i, *y = places.at[k];
            const double d = fabs(x[0] - y[0]) + fabs(x[1] - y[1]) + fabs(x[2] - y[2]);
            if (d < away) {
                away = d;
                nearest = i;
            }
        }
        if (away > 1e-9 * (fabs(places.at[k][0]) + fabs(places.at[k][1]) + fabs(places.at[k][2]))) continue;
        char name[24];
        snprintf(name, sizeof name, "place%zu", k);
        status = selas_receiver(run, name, field, said);
        double *most = &worst[places.kinked[k]];
        for (size_t c = 0; status == SELAS_OK && c < components; c++)
            *most = fmax(*most, fabs(said[c] - value[nearest * components + c]) / largest);
    }
    return status;
}

static double field_worst[7][2];

static selas_status look(selas_simulation *run, const struct task *task, const char *echo)
{
    (void)echo;
    selas_status status = selas_advance(run, task->part * selas_end_time(run));
    for (int field = SELAS_DISPLACEMENT; field <= SELAS_ENERGY && status == SELAS_OK; field++)
        status = field_apart(run, (selas_field)field, field_worst[field]);
    return status == SELAS_UNSUPPORTED ? SELAS_OK : status;
}

/* Does rock jump near a place, so that receivers of the general operator know kinks which fields do not (G30 of
 * doc/theory/general-ground.md), and fields strains that jump, which a host's receivers do not (G34)? */
static bool jumps_near(const struct scene *scene, const double position[3])
{
    enum { REACH = 4, FINE = 8 }; /* spacings; places in one */
    double from[3], place[3];
    ground_from_deck(&scene->body, position, from);
    const struct rock here = ground_at(scene, from);
    for (int code = 0; code < 27; code++)
        for (int n = 1; n <= REACH * FINE; n++) {
            const double away = scene->body.spacing * n / FINE;
            const double way[3] = {code % 3 - 1, code / 3 % 3 - 1, code / 9 - 1};
            for (int axis = 0; axis < 3; axis++)
                place[axis] = from[axis] + (axis < scene->dimension ? way[axis] * away : 0);
            const struct rock rock = ground_at(scene, place);
            if (fabs(log(rock.mu / here.mu)) > .01 || fabs(log(rock.lambda / here.lambda)) > .01) return true;
        }
    return false;
}

/* Six points of the body by chance. */
static bool choose_places(const struct task *task)
{
    struct outcome o = {.status = SELAS_OK};
    char *echo = NULL;
    size_t points = 0;
    const double *position = NULL;
    selas_simulation *run = open(task, &o, &echo);
    places.count = 0;
    if (o.status == SELAS_OK && selas_points(run, &points, &position) == SELAS_OK)
        for (; places.count < PLACES; places.count++) {
            memcpy(places.at[places.count], position + 3 * chance(points), sizeof places.at[0]);
            places.kinked[places.count] =
                by_general_operator(task->scene) && jumps_near(task->scene, places.at[places.count]);
        }
    selas_close(&run);
    free(echo);
    return places.count > 0;
}

/* --- Relations -------------------------------------------------------------------------------------------- */

struct tally {
    bool good;
    double worst;
    const char *name;
};

static void judge(struct tally *tally, const char *path, const char *name, double error, double allowed)
{
    printf("# %s %s %.2e of %.0e\n", path, name, error, allowed);
    if (!(error <= allowed)) {
        tally->good = false;
        printf("not ok - %s: %s: %.2g apart, allowed %.1g\n", path, name, error, allowed);
    }
    const double ratio = allowed > 0 ? error / allowed : error > 0 ? INFINITY : 0;
    if (!(ratio <= tally->worst)) {
        tally->worst = ratio;
        tally->name = name;
    }
}

struct relation {
    const char *name;
    void (*change)(struct edit *edit, const struct task *task);
    selas_status (*march)(selas_simulation *run, const struct task *task, const char *echo);
    int threads;
    double factor;
    double allowed;
    bool loads, given, consistent; /* it needs these */
};
static const struct relation relations[] = {
    {"threads", NULL, NULL, 3, 1, 0, false, false, false},
    {"restart", NULL, stop_twice, 2, 1, 0, false, false, false},
    {"calls", NULL, step_by_step, 1, 1, 0, false, false, false},
    {"depth", name_places, NULL, 1, 1, 1e-10, false, false, false},
    {"receiver", add_receiver, NULL, 1, 1, 0, false, true, false},
    {"nothing", add_nothing, NULL, 1, 1, 1e-9, true, false, false},
    {"halves", halve, NULL, 1, 1, 1e-9, true, false, false},
    {"doubled", strengthen, NULL, 1, 2, 1e-9, true, false, true},
    {"quiet", nothing_quiet, NULL, 1, 1, 1e-9, false, false, true},
    {"whole", whole, NULL, 1, 1, 1e-9, false, false, true},
    {"passes", pass_by_pass, NULL, 1, 1, 1e-9, false, false, true},
};

static bool has_file_sources(const struct scene *scene)
{
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].group != k) return true;
    return false;
}

/* What is cut from pulses at t = 0; 1 where there are others than smooth ones. */
static double cut_of(const struct scene *scene)
{
    double cut = 0;
    for (size_t k = 0; k < scene->loads; k++) {
        const struct history *history = &scene->load[k].history;
        if (history->kind == HISTORY_GAUSSIAN || history->kind == HISTORY_RICKER ||
            history->kind == HISTORY_ERROR_FUNCTION)
            cut = fmax(cut, fabs(history_value(history, history->start * (1 + 1e-12) + 1e-300, 0)));
        else
            return 1;
    }
    return cut;
}

static void hold_times(const struct task *task, const struct outcome *base, struct tally *tally,
                       const char *name, void (*change)(struct edit *edit, const struct task *task),
                       size_t steps, size_t offset, double allowed)
{
    struct task other = *task;
    other.change = change;
    other.shift = (double)steps * task->dt;
    struct outcome o = go(&other);
    if (o.status == SELAS_OK)
        judge(tally, task->path, name, apart(base, &o, 1, offset, change == every_second ? 2 : 1), allowed);
    else
        printf("# %s %s: %s\n", task->path, name, o.message);
    outcome_free(&o);
}

/* The transform takes what comes behind the record's end for nothing. */
static void hold_time(const struct task *task, const struct outcome *base, struct tally *tally, bool given,
                      bool consistent, bool single)
{
    const size_t steps = 5 + chance(20);
    const double rounding = single ? 3e-5 : 1e-9;
    struct task other = *task;
    other.change = not_unwarped;
    other.plain = true;
    struct outcome plain = go(&other);
    const bool smooth = cut_of(task->scene) < 1;    /* the transform of a kink rings */
    const double record = consistent ? 1e-5 : 1e-4; /* of the record's end */
    if (task->scene->initial.kind == INITIAL_REST && !scene_loads_move(task->scene) && given) {
        if (plain.status == SELAS_OK)
            hold_times(&other, &plain, tally, "later, as stepped", begin_later, steps, steps,
                       smooth ? fmax(rounding, cut_of(task->scene)) : rounding);
        if (smooth)
            hold_times(task, base, tally, "later", begin_later, steps, steps,
                       fmax(fmax(rounding, record), cut_of(task->scene)));
    }
    if (given) {
        if (plain.status == SELAS_OK)
            hold_times(&other, &plain, tally, "longer, as stepped", run_longer, 10 * steps, 0, rounding);
        if (smooth)
            hold_times(task, base, tally, "longer", run_longer, 10 * steps, 0, fmax(rounding, record));
    }
    hold_times(task, base, tally, "rows", every_second, 0, 0, rounding);
    outcome_free(&plain);
}

/* What a box sends back that is fitted without the source's spectrum, which a host does not tell. */
static double fitted(const struct scene *scene)
{
    return scene->body.chosen ? 1e-3 : 1e-9;
}

static void hold_driven(const struct task *task, struct tally *tally)
{
    struct task other = *task;
    for (size_t k = 0; k < task->scene->loads; k++) {
        const struct load *load = &task->scene->load[k];
        if (load_moves(load) || load->shape == LOAD_DISC || load->kind == LOAD_MOMENT_TENSOR) return;
    }
    other.change = not_unwarped;
    struct outcome one = go(&other);
    other.march = drive;
    struct outcome o = one.status == SELAS_OK ? go(&other) : (struct outcome){.status = one.status};
    if (o.status == SELAS_OK)
        judge(tally, task->path, "driven", apart(&one, &o, 1, 0, 1), fitted(task->scene));
    else
        printf("# %s driven: %s\n", task->path, o.message);
    outcome_free(&one);
    outcome_free(&o);
}

/* Damped rock is fitted to the spectra of all that act, by their strength: each load alone has moduli of its own, .0007
 * off in decks/damped.nml. */
static double summed(const struct scene *scene, bool single)
{
    return ground_is_damped(scene) ? 2e-3 : single ? 3e-5 : 1e-9;
}

static void hold_sum(const struct task *task, const struct outcome *base, struct tally *tally, double allowed)
{
    struct task other = *task;
    struct outcome sum = {.status = SELAS_OK};
    other.change = one_load;
    for (other.one = 0; other.one < deck_count(task->scene->deck, "load"); other.one++) {
        struct outcome o = go(&other);
        if (o.status != SELAS_OK || (sum.value != NULL && o.rows != sum.rows)) {
            printf("# %s sum: %s\n", task->path, o.message);
            outcome_free(&o);
            outcome_free(&sum);
            return;
        }
        if (sum.value == NULL) {
            sum = o;
            continue;
        }
        for (size_t i = 0; i < 6 * o.receivers * o.rows; i++)
            sum.value[i] += o.value[i];
        outcome_free(&o);
    }
    judge(tally, task->path, "sum", apart(base, &sum, 1, 0, 1), allowed);
    outcome_free(&sum);
}

/* --- Files ------------------------------------------------------------------------------------------------ */

static char folder[64];
static double file_worst[2]; /* places, velocities */
static bool mesh_right;

static void add_snapshot(struct edit *edit, const struct task *task)
{
    const size_t number = add(edit, "snapshot");
    set(edit, "snapshot(%zu)%%times=%.17g", number, task->shift);
    set(edit, "output%%directory='%s'", folder);
}

/* A table of run.h5 as doubles; NULL: none of this size. */
static double *table(hid_t file, const char *name, size_t numbers)
{
    double *value = NULL;
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = set >= 0 ? H5Dget_space(set) : -1;
    if (space >= 0 && H5Sget_simple_extent_npoints(space) == (hssize_t)numbers) {
        value = calloc(numbers, sizeof *value);
        if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) < 0) value[0] = NAN;
    }
    if (space >= 0) H5Sclose(space);
    if (set >= 0) H5Dclose(set);
    return value;
}

static double largest_difference(const double *one, const double *other, size_t n)
{
    double most = 0, largest = 0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(one[i] - other[i]));
        largest = fmax(largest, fabs(one[i]));
        if (isnan(other[i])) return INFINITY;
    }
    return largest > 0 ? most / largest : most;
}

/* run.xdmf names the places of run.h5, or an even mesh that has them. */
static bool mesh_has(const double *position, size_t points)
{
    char path[96], text[6000] = "";
    snprintf(path, sizeof path, "%s/run.xdmf", folder);
    FILE *file = fopen(path, "r");
    if (file == NULL) return false;
    text[fread(text, 1, sizeof text - 1, file)] = '\0';
    fclose(file);
    const char *even = strstr(text, "ORIGIN_DXDYDZ"), *size = strstr(text, "3DCoRectMesh\" Dimensions=\"");
    if (even == NULL) return strstr(text, "run.h5:/points/position") != NULL;
    size_t n[3];
    double origin[3], step[3];
    const char *first = strstr(even, "XML\">"), *second = first != NULL ? strstr(first + 5, "XML\">") : NULL;
    if (size == NULL || second == NULL || sscanf(size + 26, "%zu %zu %zu", &n[2], &n[1], &n[0]) != 3 ||
        sscanf(first + 5, "%lf %lf %lf", &origin[2], &origin[1], &origin[0]) != 3 ||
        sscanf(second + 5, "%lf %lf %lf", &step[2], &step[1], &step[0]) != 3 || n[0] * n[1] * n[2] != points)
        return false;
    for (size_t i = 0; i < points; i++) {
        const size_t at[3] = {i % n[0], i / n[0] % n[1], i / n[0] / n[1]};
        for (size_t c = 0; c < 3; c++)
            if (n[c] > 1 &&
                !(fabs(origin[c] + (double)at[c] * step[c] - position[3 * i + c]) < 1e-6 * fabs(step[c])))
                return false;
    }
    return true;
}

static selas_status write_files(selas_simulation *run, const struct task *task, const char *echo)
{
    (void)echo;
    size_t points = 0, count, components;
    const double *position = NULL, *value = NULL;
    selas_status status = selas_record(run);
    if (status == SELAS_OK) status = selas_advance(run, task->shift);
    if (status == SELAS_OK) status = selas_points(run, &points, &position);
    if (status == SELAS_OK) status = selas_field_values(run, SELAS_VELOCITY, &count, &components, &value);
    double *there = calloc(3 * points + 1, sizeof *there);
    if (status == SELAS_OK) memcpy(there, value, 3 * points * sizeof *there);
    if (status == SELAS_OK) status = selas_write(run);
    char path[96];
    snprintf(path, sizeof path, "%s/run.h5", folder);
    const hid_t file = status == SELAS_OK ? H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT) : -1;
    if (file >= 0) {
        double *places_there = table(file, "/points/position", 3 * points);
        double *velocity = table(file, "/snapshots/0001/velocity", 3 * points);
        if (velocity == NULL) velocity = table(file, "/snapshots/0000/velocity", 3 * points);
        file_worst[0] =
            places_there != NULL ? largest_difference(position, places_there, 3 * points) : INFINITY;
        file_worst[1] = velocity != NULL ? largest_difference(there, velocity, 3 * points) : INFINITY;
        mesh_right = places_there != NULL && mesh_has(places_there, points);
        free(places_there);
        free(velocity);
        H5Fclose(file);
    } else {
        file_worst[0] = file_worst[1] = INFINITY;
    }
    free(there);
    return status;
}

static void hold_files(const struct task *task, struct tally *tally)
{
    struct task other = *task;
    if (task->scene->snapshots > 0) return;
    snprintf(folder, sizeof folder, "/tmp/selas-decks-%ld", (long)getpid());
    other.change = add_snapshot;
    other.march = write_files;
    other.shift = task->dt * (double)(5 + chance((size_t)(.7 * task->scene->end_time / task->dt)));
    struct outcome o = go(&other);
    if (o.status != SELAS_OK) {
        printf("# %s files: %s\n", task->path, o.message);
    } else {
        judge(tally, task->path, "places in run.h5", file_worst[0], 0);
        judge(tally, task->path, "velocities in run.h5", file_worst[1], 1e-7);
        judge(tally, task->path, "run.xdmf", mesh_right ? 0 : 1, 0);
    }
    outcome_free(&o);
    char command[96];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    if (system(command) != 0) printf("# %s stays\n", folder);
}

static void hold_fields(const struct task *task, struct tally *tally, bool single)
{
    static const char *const names[7] = {"displacement", "velocity", "acceleration", "stress",
                                         "strain",       "pressure", "energy"};
    static const char *const beside[3] = {"displacement beside jumps", "velocity beside jumps",
                                          "acceleration beside jumps"};
    struct task other = *task;
    if (!choose_places(&other)) return;
    memset(field_worst, 0, sizeof field_worst);
    other.change = add_places;
    other.march = look;
    other.part = .3 + .6 * (double)chance(1000) / 1000;
    struct outcome o = go(&other);
    if (o.status != SELAS_OK) printf("# %s fields: %s\n", task->path, o.message);
    for (int field = 0; field < 7 && o.status == SELAS_OK; field++) {
        judge(tally, task->path, names[field], field_worst[field][0], single ? 1e-5 : 1e-9);
        if (field <= SELAS_ACCELERATION && field_worst[field][1] > 0)
            judge(tally, task->path, beside[field], field_worst[field][1], .02);
    }
    outcome_free(&o);
}

static void hold(const char *path, size_t *refused, size_t *bad)
{
    struct task task = {.path = path, .threads = 1};
    struct outcome base = {.status = SELAS_OK};
    struct tally tally = {true, 0, "none"};
    char *echo = NULL;
    selas_simulation *run = open(&task, &base, &echo);
    if (base.status == SELAS_OK) task.receivers = deck_count(run->deck, "receiver");
    if (base.status != SELAS_OK || task.receivers == 0 || selas_step(run, 0) != SELAS_OK) {
        printf("# %s: %s\n", path, run != NULL ? selas_message(run) : base.message);
        *refused += 1;
        selas_close(&run);
        free(echo);
        return;
    }
    task.scene = run->scene;
    task.base = run->deck;
    task.dt = (deck_given(deck_get(run->deck, "stepping", 0), "time_step") ? 1 : .9) * selas_time_step(run);
    base = go(&task);
    const struct deck_group *body = deck_get(run->deck, "body", 0),
                            *method = deck_get(run->deck, "method", 0);
    const bool given = deck_given(body, "high") || !deck_chosen(body, "shape", "half-space");
    const bool consistent =
        deck_values(method, "variant") == 0 || deck_chosen(method, "variant", "consistent");
    const bool single = deck_chosen(method, "precision", "single");
    const bool loads = run->scene->loads > 0 && !has_file_sources(run->scene);
    if (base.status != SELAS_OK || !(base.largest[1] > 0)) {
        printf("# %s: %s\n", path, base.message);
        *refused += 1;
    } else {
        for (size_t k = 0; k < sizeof relations / sizeof *relations; k++) {
            const struct relation *relation = &relations[k];
            if ((relation->loads && !loads) || (relation->given && !given) ||
                (relation->consistent && !consistent))
                continue;
            if (relation->factor != 1 && run->scene->initial.kind != INITIAL_REST) continue;
            struct task other = task;
            other.change = relation->change;
            other.march = relation->march;
            other.threads = relation->threads;
            struct outcome o = go(&other);
            const double least = single && relation->allowed > 0 ? 3e-5 : relation->allowed;
            if (o.status == SELAS_OK)
                judge(&tally, path, relation->name, apart(&base, &o, relation->factor, 0, 1), least);
            else
                printf("# %s %s: %s\n", path, relation->name, o.message);
            outcome_free(&o);
        }
        hold_time(&task, &base, &tally, given, consistent, single);
        if (loads && run->scene->initial.kind == INITIAL_REST && consistent) hold_driven(&task, &tally);
        if (loads && run->scene->loads > 1 && run->scene->initial.kind == INITIAL_REST && consistent)
            hold_sum(&task, &base, &tally, summed(run->scene, single));
        if (consistent) hold_fields(&task, &tally, single); /* points without order are seen through fits */
        hold_files(&task, &tally);
        if (tally.good) printf("ok - %s: worst %.2g of what is allowed, %s\n", path, tally.worst, tally.name);
        *bad += !tally.good;
    }
    outcome_free(&base);
    selas_close(&run);
    free(echo);
}

int main(int count, char **word)
{
    size_t refused = 0, bad = 0;
    seed = count > 1 ? strtoull(word[1], NULL, 10) : 1;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    for (int k = 2; k < count; k++) {
        hold(word[k], &refused, &bad);
        (void)fflush(stdout);
    }
    printf("# %d decks, %zu refused, %zu failed\n", count - 2, refused, bad);
    return bad > 0;
}
