/* Relations that every run keeps, on scenes drawn by chance: methods, schemes, faces, loads, initial states,
 * layers. Whatever is true of the equations and of their discrete form must be true of the program, in
 * whatever corner of it a scene ends (doc/developers/robustness.md):
 *
 *   quiet      parts at rest left out or not: the same but for rounding
 *   symmetry   halves computed or the whole body: the same but for rounding
 *   fused      passes fused or not: the same but for rounding
 *   threads    the same bits with more threads
 *   restart    the same bits when stopped and gone on with
 *   receiver   the same bits with another receiver and a snapshot
 *   mirrored   a reflected scene gives reflected histories
 *   exchanged  one with x and y exchanged, exchanged ones
 *   turned     a turned one, turned ones
 *   units      lengths, stresses and densities in other units (powers of two; any): the same in these
 *   linear     four times the amplitude gives four times the histories, bit by bit
 *
 * Arguments: first number, how many. Prints a TAP line a scene; exit status 1 if a relation is broken, whose
 * deck is printed as a comment. With a third one, a folder: the decks, as NUMBER.nml in there, no relations. */
#include "selas.h"

#include "method/methods.h"
#include "stepping/stepping.h"

#include <math.h>
#include <omp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { RECEIVERS = 3, LOADS = 2, TEXT = 8000, STEPS = 50 };

static uint64_t seed;

static size_t chance(size_t n)
{
    seed = seed * 6364136223846793005u + 1442695040888963407u;
    return (size_t)(seed >> 33) % n;
}

static double between(double low, double high)
{
    return low + (high - low) * (double)chance(1u << 20) / (double)(1u << 20);
}

/* --- Scenes ----------------------------------------------------------------------------------------------
 */

struct source {
    const char *kind, *shape, *history;
    int face;
    double centre[3], edge[3], direction[3], moment[3][3], velocity[3], amplitude, duration;
};

struct drawn {
    int dimension;
    char method[300], scheme[100];
    bool consistent, linear, single, jitter, stress, slip;
    double density, lambda, mu, spacing, low[3], cells[3];
    const char *boundary[6];
    long points[6];
    double motion[3];
    size_t loads;
    struct source load[LOADS];
    const char *initial;
    double centre[3], direction[3], width, amplitude;
    double top; /* of a second layer; 0: none */
    double receiver[RECEIVERS + 1][3];
    double time_step, end_time;
};

/* What a variant does to a scene: new component i is sign[i] times old component axis[i]; units; amplitudes;
 * words added to &method; another receiver and a snapshot. */
struct variant {
    int axis[3];
    double sign[3], length, stress, density, amplitude;
    const char *method;
    bool more;
    double rotation[3]; /* degrees, of the body and all that lies in it */
};
static const struct variant plainly = {{0, 1, 2}, {1, 1, 1}, 1, 1, 1, 1, "", false, {0, 0, 0}};

/* Options of a method, by chance; one that is not known here gets none and counts as not linear. */
static void draw_options(struct drawn *s, const char *variant)
{
    static const char *const masses[] = {"exact", "vc1", "vc2", "vc3"};
    static const char *const gradients[] = {"linear", "quadratic", "central"};
    static const char *const laws[] = {"linear", "saint-venant-kirchhoff", "neo-hookean"};
    const char *law = laws[chance(3)];
    char *more = s->method + strlen(s->method);
    const size_t room = sizeof s->method - strlen(s->method);
    const bool paper = strcmp(variant, "paper") == 0, cloud = strcmp(variant, "cloud") == 0,
               total = strcmp(variant, "total-lagrangian") == 0;
    s->linear = s->consistent || paper || cloud || (total && strcmp(law, "linear") == 0);
    if (s->consistent && chance(2) == 0) {
        s->single = s->dimension == 3 && chance(3) == 0;
        snprintf(more, room, ", degree = 2%s", s->single ? ", precision = 'single'" : "");
        if (s->single) s->scheme[0] = '\0';
    } else if (s->consistent)
        snprintf(more, room, ", degree = %zu, mass = '%s', ends = '%s'%s", 1 + chance(4), masses[chance(4)],
                 chance(3) == 0 ? "mapped" : "open", chance(5) == 0 ? ", dissipation = 0.02" : "");
    else if (paper)
        snprintf(more, room, "%s", chance(2) == 0 ? ", filter = 0.1" : "");
    else if (total)
        snprintf(more, room, ", gradient = '%s', law = '%s'", gradients[chance(3)], law);
    else if (strcmp(variant, "updated-lagrangian") == 0)
        snprintf(more, room, "%s", chance(2) == 0 ? ", forces = 'adjoint'" : "");
    s->jitter = !s->consistent && !paper && chance(3) == 0;
}

/* Any scheme, one time in three the default; any method, most often the first one. */
static void draw_method(struct drawn *s)
{
    size_t methods = 0, schemes = 0;
    while (method_table[methods] != NULL)
        methods++;
    while (scheme_table[schemes] != NULL)
        schemes++;
    const struct method *method = method_table[chance(2) == 0 ? 0 : chance(methods)];
    if (chance(3) > 0)
        snprintf(s->scheme, sizeof s->scheme, "scheme = '%s'", scheme_table[chance(schemes)]->name);
    snprintf(s->method, sizeof s->method, "name = '%s', variant = '%s'", method->name, method->variant);
    s->consistent = method == method_find("smoothed-point", "consistent");
    draw_options(s, method->variant);
}

static void draw_faces(struct drawn *s)
{
    for (int face = 0; face < 2 * s->dimension; face++) {
        static const char *const kinds[] = {"free",     "free", "free",   "free",         "fixed",   "roller",
                                            "symmetry", "pml",  "lysmer", "displacement", "velocity"};
        s->boundary[face] = kinds[chance(sizeof kinds / sizeof *kinds)];
        s->points[face] = 4 + (long)chance(5);
    }
    for (int axis = 0; axis < 3; axis++)
        s->motion[axis] = axis < s->dimension ? between(-1, 1) : 0;
}

static void inside(const struct drawn *s, double part, double place[3])
{
    for (int axis = 0; axis < 3; axis++)
        place[axis] = axis < s->dimension
                          ? s->low[axis] + s->cells[axis] * s->spacing * (.5 + part * between(-.5, .5))
                          : 0;
}

static void draw_load(struct drawn *s, struct source *load)
{
    static const char *const histories[] = {"gaussian", "step", "triangle", "ricker"};
    const size_t kind = chance(6);
    *load = (struct source){.kind = kind < 4    ? "traction"
                                    : kind == 4 ? "body-force"
                                                : "moment-tensor",
                            .face = (int)chance((size_t)s->dimension * 2),
                            .history = histories[chance(4)],
                            .amplitude = between(.1, 1) * 1e-3,
                            .duration = s->spacing * between(2, 6)};
    static const char *const shapes[] = {"square", "square", "disc", "face"};
    load->shape = kind < 4 ? shapes[chance(4)] : "point";
    if (s->dimension == 1 && kind < 4) load->shape = "face";
    inside(s, .6, load->centre);
    const int across = load->face / 2;
    if (kind < 4) load->centre[across] = s->low[across] + (load->face % 2) * s->cells[across] * s->spacing;
    for (int axis = 0; axis < 3; axis++) {
        load->edge[axis] = s->spacing * (double)(2 + chance(4));
        load->direction[axis] = axis < s->dimension ? between(-1, 1) : 0;
        for (int other = 0; other <= axis; other++)
            load->moment[axis][other] = load->moment[other][axis] = axis < s->dimension ? between(-1, 1) : 0;
        if (strcmp(load->shape, "square") == 0 && axis != across && axis < s->dimension && kind == 0)
            load->velocity[axis] = between(-.3, .3);
    }
}

/* The same on both sides of the middle of an axis: the program then computes halves and quarters. */
static void make_even(struct drawn *s, int axis)
{
    const double middle = s->low[axis] + .5 * s->cells[axis] * s->spacing;
    s->boundary[2 * axis + 1] = s->boundary[2 * axis];
    s->points[2 * axis + 1] = s->points[2 * axis];
    s->motion[axis] = s->direction[axis] = 0;
    s->centre[axis] = middle;
    for (size_t k = 0; k < s->loads; k++) {
        struct source *load = &s->load[k];
        if (load->face / 2 == axis) { /* to another face */
            const int across = s->dimension - 1;
            load->face = 2 * across;
            load->centre[across] = s->low[across];
            load->velocity[across] = 0;
        }
        load->centre[axis] = middle;
        load->direction[axis] = load->velocity[axis] = 0;
        for (int other = 0; other < 3; other++)
            if (other != axis) load->moment[axis][other] = load->moment[other][axis] = 0;
    }
}

static struct drawn draw(void)
{
    struct drawn s = {.dimension = 1 + (int)chance(3)};
    if (chance(2) == 0) s.dimension = 3;
    s.density = between(.5, 2);
    s.mu = between(.5, 2);
    s.lambda = s.mu * between(.2, 4);
    s.spacing = between(.1, .5);
    for (int axis = 0; axis < s.dimension; axis++) {
        s.cells[axis] = (double)(8 + chance(s.dimension == 3 ? 12 : s.dimension == 2 ? 20 : 40));
        s.low[axis] = s.spacing * (double)chance(5) - 2 * s.spacing;
    }
    s.stress = s.dimension < 3 && chance(3) == 0;
    s.slip = chance(3) == 0;
    draw_method(&s);
    draw_faces(&s);
    s.loads = chance(LOADS + 1);
    for (size_t k = 0; k < s.loads; k++)
        draw_load(&s, &s.load[k]);
    static const char *const initials[] = {"gaussian", "plane-wave", "uniform-velocity"};
    s.initial = s.loads > 0 && chance(3) > 0 ? "rest" : initials[chance(3)];
    inside(&s, .7, s.centre);
    for (int axis = 0; axis < s.dimension; axis++)
        s.direction[axis] = between(-1, 1);
    s.width = s.spacing * between(1, 3);
    s.amplitude = 1e-3 * s.spacing * between(.1, 1);
    if (s.dimension > 1 && s.consistent && chance(4) == 0)
        s.top = s.spacing * floor(s.cells[s.dimension - 1] * between(.3, .6));
    for (int axis = 0; axis < s.dimension - 1; axis++)
        if (s.consistent && chance(3) == 0) make_even(&s, axis);
    for (int r = 0; r <= RECEIVERS; r++)
        inside(&s, .8, s.receiver[r]);
    return s;
}

/* --- Decks -----------------------------------------------------------------------------------------------
 */

static void add(char *text, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(char *text, const char *format, ...)
{
    const size_t length = strlen(text);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text + length, TEXT - length, format, arguments);
    va_end(arguments);
}

static double time_unit(const struct variant *v)
{
    return v->length * sqrt(v->density / v->stress);
}

static void turn(const struct variant *v, double factor, const double old[3], double new[3])
{
    for (int i = 0; i < 3; i++)
        new[i] = factor * v->sign[i] * old[v->axis[i]];
}

/* x := Rz Ry Rx x */
static void rotate(const struct drawn *s, const struct variant *v, double x[3])
{
    for (int about = 0; about < 3; about++) {
        const int a = (about + 1) % 3, b = (about + 2) % 3;
        const double angle = s->dimension == 3 || (s->dimension == 2 && about == 2) ? v->rotation[about] : 0;
        const double sine = sin(angle * M_PI / 180), cosine = cos(angle * M_PI / 180), old = x[a];
        x[a] = cosine * old - sine * x[b];
        x[b] = sine * old + cosine * x[b];
    }
}

static void rotate_about_middle(const struct drawn *s, const struct variant *v, double x[3])
{
    double middle[3];
    for (int i = 0; i < 3; i++) {
        middle[i] = s->low[i] + .5 * s->cells[i] * s->spacing;
        x[i] -= middle[i];
    }
    rotate(s, v, x);
    for (int i = 0; i < 3; i++)
        x[i] += middle[i];
}

static bool rotated(const struct variant *v)
{
    return v->rotation[0] != 0 || v->rotation[1] != 0 || v->rotation[2] != 0;
}

static void add_vector(char *text, const struct drawn *s, const struct variant *v, const char *word,
                       double factor, const double old[3])
{
    double new[3];
    turn(v, factor, old, new);
    if (rotated(v) && (strcmp(word, "centre") == 0 || strcmp(word, "position") == 0))
        rotate_about_middle(s, v, new);
    else
        rotate(s, v, new);
    add(text, ", %s = ", word);
    for (int i = 0; i < s->dimension; i++)
        add(text, "%s%.17g", i == 0 ? "" : ", ", new[i]);
}

static int new_axis(const struct variant *v, int old)
{
    for (int i = 0; i < 3; i++)
        if (v->axis[i] == old) return i;
    return 0;
}

static void face_word(const struct variant *v, int face, char word[3])
{
    const int axis = new_axis(v, face / 2);
    const bool high = (face % 2 == 1) == (v->sign[axis] > 0);
    snprintf(word, 3, "%c%c", "xyz"[axis], high ? '+' : '-');
}

static void add_history(char *text, const struct variant *v, const char *history, double duration)
{
    const double unit = time_unit(v) * duration;
    add(text, ", history = '%s'", history);
    if (strcmp(history, "gaussian") == 0) add(text, ", width = %.17g, delay = %.17g", unit / 4, unit);
    if (strcmp(history, "ricker") == 0) add(text, ", frequency = %.17g, delay = %.17g", 1 / unit, 1.5 * unit);
    if (strcmp(history, "triangle") == 0) add(text, ", duration = %.17g", unit);
}

static void add_load(char *text, const struct drawn *s, const struct variant *v, const struct source *load)
{
    static const int row[6] = {0, 1, 2, 0, 1, 0}, column[6] = {0, 1, 2, 1, 2, 2};
    const bool traction = strcmp(load->kind, "traction") == 0,
               tensor = strcmp(load->kind, "moment-tensor") == 0;
    const bool point = strcmp(load->shape, "point") == 0,
               patch = traction && strcmp(load->shape, "face") != 0;
    double unit = v->amplitude * v->stress;
    char face[3];
    for (int k = 1; point && k < s->dimension; k++) /* a force, by its dimension */
        unit *= v->length;
    if (tensor) unit *= v->length;
    face_word(v, load->face, face);
    add(text, "&load kind = '%s', amplitude = %.17g", load->kind, unit * load->amplitude);
    if (!tensor) add(text, ", shape = '%s'", load->shape);
    if (traction) add(text, ", face = '%s'", face);
    if (patch || point) add_vector(text, s, v, "centre", v->length, load->centre);
    if (!tensor) add_vector(text, s, v, "direction", 1, load->direction);
    if (patch && strcmp(load->shape, "disc") == 0) add(text, ", size = %.17g", v->length * load->edge[0]);
    if (patch && strcmp(load->shape, "square") == 0) {
        const char *between_them = ", size = ";
        for (int i = 0; i < s->dimension; i++) {
            if (v->axis[i] == load->face / 2) continue;
            add(text, "%s%.17g", between_them, v->length * load->edge[v->axis[i]]);
            between_them = ", ";
        }
        double still = 0;
        for (int i = 0; i < 3; i++)
            still = fmax(still, fabs(load->velocity[i]));
        if (still > 0) add_vector(text, s, v, "velocity", v->length / time_unit(v), load->velocity);
    }
    if (tensor) {
        double moment[3][3], column_of[3];
        for (int a = 0; a < 3; a++)
            for (int b = 0; b < 3; b++)
                moment[a][b] = v->sign[a] * v->sign[b] * load->moment[v->axis[a]][v->axis[b]];
        for (int a = 0; a < 3; a++)
            rotate(s, v, moment[a]);
        for (int b = 0; b < 3; b++) {
            for (int a = 0; a < 3; a++)
                column_of[a] = moment[a][b];
            rotate(s, v, column_of);
            for (int a = 0; a < 3; a++)
                moment[a][b] = column_of[a];
        }
        add(text, ", moment = ");
        for (int k = 0; k < 6; k++)
            add(text, "%s%.17g", k == 0 ? "" : ", ", moment[row[k]][column[k]]);
    }
    add_history(text, v, load->history, load->duration);
    add(text, " /\n");
}

static void add_face(char *text, const struct drawn *s, const struct variant *v, int face)
{
    const char *kind = s->boundary[face];
    const bool pml = strcmp(kind, "pml") == 0, velocity = strcmp(kind, "velocity") == 0;
    const bool moved = velocity || strcmp(kind, "displacement") == 0;
    char word[3];
    face_word(v, face, word);
    add(text, "&boundary face = '%s', kind = '%s'", word,
        pml || strcmp(kind, "lysmer") == 0 ? "transmitting" : kind);
    if (pml) add(text, ", layer = 'pml', layer_points = %ld, always = .true.", s->points[face]);
    if (strcmp(kind, "lysmer") == 0) add(text, ", layer = 'lysmer'");
    if (moved) {
        add_vector(text, s, v, "direction", 1, s->motion);
        add(text, ", amplitude = %.17g",
            v->amplitude * v->length * s->amplitude / (velocity ? time_unit(v) : 1));
        if (velocity) add(text, ", slip = %s", s->slip ? ".true." : ".false.");
        add_history(text, v, velocity ? "triangle" : "gaussian", 8 * s->spacing);
    }
    add(text, " /\n");
}

static void write_deck(const struct drawn *s, const struct variant *v, char *text)
{
    double one[3], other[3], low[3], high[3];
    for (int i = 0; i < 3; i++)
        other[i] = s->low[i] + s->cells[i] * s->spacing;
    turn(v, v->length, s->low, one);
    turn(v, v->length, other, high);
    for (int i = 0; i < 3; i++) {
        low[i] = fmin(one[i], high[i]);
        high[i] = fmax(one[i], high[i]);
    }
    text[0] = '\0';
    const double unit = time_unit(v);
    add(text, "&scene dimension = %d%s, end_time = %.17g /\n&method %s%s /\n", s->dimension,
        s->stress ? ", plane = 'stress'" : "", unit * s->end_time, s->method, v->method);
    add(text, "&stepping %s%s", s->scheme, s->scheme[0] == '\0' || s->time_step <= 0 ? "" : ", ");
    if (s->time_step > 0) add(text, "time_step = %.17g", unit * s->time_step);
    add(text, " /\n&material name = 'rock', density = %.17g, lambda = %.17g, mu = %.17g /\n",
        v->density * s->density, v->stress * s->lambda, v->stress * s->mu);
    add(text, "&body name = 'body', material = 'rock', spacing = %.17g%s", v->length * s->spacing,
        s->jitter ? ", jitter = 0.2" : "");
    add(text, ", low = ");
    for (int i = 0; i < s->dimension; i++)
        add(text, "%s%.17g", i == 0 ? "" : ", ", low[i]);
    add(text, ", high = ");
    for (int i = 0; i < s->dimension; i++)
        add(text, "%s%.17g", i == 0 ? "" : ", ", high[i]);
    if (rotated(v))
        add(text, ", rotation = %.17g, %.17g, %.17g", s->dimension == 3 ? v->rotation[0] : 0,
            s->dimension == 3 ? v->rotation[1] : 0, v->rotation[2]);
    add(text, " /\n");
    if (s->top > 0)
        add(text,
            "&material name = 'soft', density = %.17g, lambda = %.17g, mu = %.17g /\n"
            "&layer material = 'soft', top = 0 /\n&layer material = 'rock', top = %.17g /\n",
            v->density * s->density, v->stress * s->lambda / 2, v->stress * s->mu / 2, v->length * s->top);
    for (int face = 0; face < 2 * s->dimension; face++)
        if (strcmp(s->boundary[face], "free") != 0) add_face(text, s, v, face);
    for (size_t k = 0; k < s->loads; k++)
        add_load(text, s, v, &s->load[k]);
    if (strcmp(s->initial, "rest") != 0) {
        const bool uniform = strcmp(s->initial, "uniform-velocity") == 0;
        add(text, "&initial kind = '%s'", s->initial);
        if (uniform)
            add_vector(text, s, v, "velocity", v->amplitude * v->length / unit * 1e-3, s->direction);
        else {
            add_vector(text, s, v, "centre", v->length, s->centre);
            add_vector(text, s, v, "direction", 1, s->direction);
            add(text, ", width = %.17g, amplitude = %.17g", v->length * s->width,
                v->amplitude * v->length * s->amplitude);
        }
        add(text, " /\n");
    }
    for (int r = 0; r < RECEIVERS + (v->more ? 1 : 0); r++) {
        add(text, "&receiver name = 'r%d'", r);
        add_vector(text, s, v, "position", v->length, s->receiver[r]);
        add(text, " /\n");
    }
    if (v->more) add(text, "&snapshot every = %.17g /\n", unit * s->end_time / 7);
    add(text, "&output plots = .false. /\n");
}

/* --- Runs ------------------------------------------------------------------------------------------------
 */

struct outcome {
    selas_status status;
    char message[600];
    size_t rows, points;
    double step, largest[2]; /* of u and v, over the body in the end and the receivers always */
    double *history, *field; /* [RECEIVERS][rows][6]; [2][points][3] in the end */
};

static void outcome_free(struct outcome *o)
{
    free(o->history);
    free(o->field);
    *o = (struct outcome){.status = SELAS_OK};
}

static selas_status collect(selas_simulation *run, struct outcome *o)
{
    const double *time, *value;
    o->step = selas_time_step(run);
    for (int r = 0; r < RECEIVERS; r++) {
        char name[8];
        snprintf(name, sizeof name, "r%d", r);
        const selas_status status = selas_history(run, name, &o->rows, &time, &value);
        if (status != SELAS_OK) return status;
        if (r == 0) o->history = calloc(RECEIVERS * 6 * (o->rows + 1), sizeof(double));
        memcpy(o->history + (size_t)r * 6 * o->rows, value, 6 * o->rows * sizeof *value);
    }
    for (size_t i = 0; i < RECEIVERS * 6 * o->rows; i++)
        o->largest[i % 6 / 3] = fmax(o->largest[i % 6 / 3], fabs(o->history[i]));
    for (int which = 0; which < 2; which++) {
        size_t components;
        const selas_status status = selas_field_values(run, which == 0 ? SELAS_DISPLACEMENT : SELAS_VELOCITY,
                                                       &o->points, &components, &value);
        if (status != SELAS_OK) return status;
        if (o->field == NULL) o->field = calloc(6 * o->points + 1, sizeof(double));
        for (size_t i = 0; i < o->points * components; i++) {
            o->field[(size_t)which * 3 * o->points + i] = value[i];
            o->largest[which] = fmax(o->largest[which], fabs(value[i]));
        }
    }
    return SELAS_OK;
}

/* Runs a variant to its end; stop > 0: stopped after so many steps and gone on with from a checkpoint. */
static struct outcome run(const struct drawn *s, const struct variant *v, int threads, unsigned long stop)
{
    static char text[TEXT];
    struct outcome o = {.status = SELAS_OK};
    selas_simulation *run = NULL;
    write_deck(s, v, text);
    omp_set_num_threads(threads);
    o.status = selas_open_text("drawn", text, &run);
    if (o.status == SELAS_OK && stop > 0) {
        char path[64];
        snprintf(path, sizeof path, "/tmp/selas-relations-%ld.h5", (long)getpid());
        o.status = selas_step(run, stop);
        if (o.status == SELAS_OK) o.status = selas_save(run, path);
        if (o.status == SELAS_OK) selas_close(&run);
        if (o.status == SELAS_OK) o.status = selas_open_text("drawn", text, &run);
        if (o.status == SELAS_OK) o.status = selas_restore(run, path);
        (void)remove(path);
    }
    if (o.status == SELAS_OK && s->time_step > 0) o.status = selas_finish(run);
    if (o.status == SELAS_OK && s->time_step > 0) o.status = collect(run, &o);
    if (o.status == SELAS_OK) o.step = selas_time_step(run);
    snprintf(o.message, sizeof o.message, "%s", run != NULL ? selas_message(run) : "no handle");
    selas_close(&run);
    return o;
}

/* --- Relations -------------------------------------------------------------------------------------------
 */

/* Largest difference from what the variant makes of the first one, over the largest number. */
static double apart(const struct drawn *s, const struct outcome *base, const struct outcome *o,
                    const struct variant *v, bool fields)
{
    const double unit[2] = {v->amplitude * v->length, v->amplitude * v->length / time_unit(v)};
    const double nothing = 1e-290; /* denormal numbers have no bits to lose */
    double worst = 0;
    if (o->rows != base->rows || o->points != base->points) return INFINITY;
    for (size_t row = 0; row < RECEIVERS * base->rows; row++)
        for (size_t which = 0; which < 2; which++) {
            double expected[3];
            turn(v, unit[which], base->history + 6 * row + 3 * which, expected);
            rotate(s, v, expected);
            for (size_t i = 0; i < 3; i++) {
                const double error = fabs(o->history[6 * row + 3 * which + i] - expected[i]);
                const double size = unit[which] * base->largest[which];
                if (!(error <= worst * size) && !(error < nothing)) worst = error / size;
            }
        }
    for (size_t i = 0; fields && i < 6 * base->points; i++) {
        const int which = i < 3 * base->points ? 0 : 1;
        const double error = fabs(o->field[i] - unit[which] * base->field[i]);
        const double size = unit[which] * base->largest[which];
        if (!(error <= worst * size) && !(error < nothing)) worst = error / size;
    }
    return worst;
}

struct relation {
    const char *name;
    struct variant variant;
    int threads;
    bool stopped, same_bits, same_points;
};

enum { UNITS };
static const struct relation relations[] = {
    {"units", {{0, 1, 2}, {1, 1, 1}, 8, 4, 64, 1, "", false, {0, 0, 0}}, 1, false, false, true},
    {"other units",
     {{0, 1, 2}, {1, 1, 1}, 1 / .3048, 1 / 47.88, 1 / 515.4, 1, "", false, {0, 0, 0}},
     1,
     false,
     false,
     true},
    {"quiet", {{0, 1, 2}, {1, 1, 1}, 1, 1, 1, 1, ", quiet = 0", false, {0, 0, 0}}, 1, false, false, true},
    {"symmetry",
     {{0, 1, 2}, {1, 1, 1}, 1, 1, 1, 1, ", symmetry = .false.", false, {0, 0, 0}},
     1,
     false,
     false,
     true},
    {"fused",
     {{0, 1, 2}, {1, 1, 1}, 1, 1, 1, 1, ", fused = .false.", false, {0, 0, 0}},
     1,
     false,
     false,
     true},
    {"threads", {{0, 1, 2}, {1, 1, 1}, 1, 1, 1, 1, "", false, {0, 0, 0}}, 3, false, true, true},
    {"restart", {{0, 1, 2}, {1, 1, 1}, 1, 1, 1, 1, "", false, {0, 0, 0}}, 2, true, true, true},
    {"receiver", {{0, 1, 2}, {1, 1, 1}, 1, 1, 1, 1, "", true, {0, 0, 0}}, 1, false, true, true},
    {"mirrored", {{0, 1, 2}, {-1, 1, 1}, 1, 1, 1, 1, "", false, {0, 0, 0}}, 1, false, false, false},
    {"exchanged", {{1, 0, 2}, {1, 1, 1}, 1, 1, 1, 1, "", false, {0, 0, 0}}, 1, false, false, false},
    {"turned", {{0, 1, 2}, {1, 1, 1}, 1, 1, 1, 1, "", false, {35, -20, 50}}, 1, false, false, false},
    {"linear", {{0, 1, 2}, {1, 1, 1}, 1, 1, 1, 4, "", false, {0, 0, 0}}, 1, false, true, true},
};

/* Where a moved face meets one that is held or moved differently they contradict each other: ghosts follow
 * the first axis, the consistent method the first face that moves. */
static bool contradicts(const struct drawn *s)
{
    const bool particles = strstr(s->method, "updated") != NULL;
    size_t moved = 0, others = 0;
    for (int face = 0; face < 2 * s->dimension; face++) {
        moved += strcmp(s->boundary[face], "displacement") == 0;
        others += strcmp(s->boundary[face], "velocity") == 0;
        others +=
            particles && strcmp(s->boundary[face], "lysmer") == 0; /* shear tractions differ in the edge */
    }
    return s->consistent ? moved > 0 && others > 0 : moved + others > 0;
}

static bool applies(const struct relation *relation, const struct drawn *s)
{
    const char *name = relation->name;
    if (strcmp(name, "fused") == 0) return s->consistent && !s->single;
    if (relation->variant.method[0] != '\0') return s->consistent;
    if (strcmp(name, "mirrored") == 0) return !s->jitter;
    if (strcmp(name, "exchanged") == 0) return !s->jitter && s->dimension == 3 && !contradicts(s);
    if (strcmp(name, "turned") == 0) return s->dimension > 1;
    if (strcmp(name, "linear") == 0) return s->linear;
    return true;
}

static double allowed(const struct relation *relation, const struct drawn *s)
{
    if (relation->same_bits) return 0;
    return s->single ? 3e-5 : 1e-9;
}

static void show(const struct drawn *s)
{
    static char text[TEXT];
    write_deck(s, &plainly, text);
    for (const char *line = text; *line != '\0';) {
        const char *end = strchr(line, '\n');
        printf("# %.*s\n", (int)(end - line), line);
        line = end + 1;
    }
}

static bool keep(const struct drawn *s, const char *folder, unsigned long number)
{
    static char text[TEXT];
    char name[1000];
    snprintf(name, sizeof name, "%s/%lu.nml", folder, number);
    write_deck(s, &plainly, text);
    FILE *file = fopen(name, "w");
    if (file == NULL) return false;
    const bool written = fputs(text, file) >= 0;
    return fclose(file) == 0 && written;
}

/* Tries all relations on a scene, or keeps it in the folder; 1 if it is none that can be run. */
static int hold(unsigned long number, struct drawn *s, const char *folder, bool *good)
{
    struct outcome base = run(s, &plainly, 1, 0);
    if (base.status != SELAS_OK || !(base.step > 0)) return 1;
    const struct variant *units = &relations[UNITS].variant;
    const double measured = run(s, units, 1, 0).step / time_unit(units);
    double worst = fabs(measured / base.step - 1);
    const char *worst_one = "time step in other units";
    if (!(worst <= 1e-9)) {
        *good = false;
        printf("not ok - scene %lu: time step %.9g, %.9g in other units\n", number, base.step, measured);
    }
    s->time_step = .6 * base.step;
    s->end_time = STEPS * s->time_step;
    base = run(s, &plainly, 1, 0);
    if (base.status != SELAS_OK) return 1;
    if (!(base.largest[0] > 0 && base.largest[1] > 0)) {
        outcome_free(&base);
        return 1;
    }
    if (folder != NULL) {
        *good = keep(s, folder, number);
        outcome_free(&base);
        return 0;
    }
    for (size_t k = 0; k < sizeof relations / sizeof *relations; k++) {
        const struct relation *relation = &relations[k];
        if (!applies(relation, s)) continue;
        struct outcome o =
            run(s, &relation->variant, relation->threads, relation->stopped ? 1 + chance(STEPS - 2) : 0);
        if (o.status != SELAS_OK) {
            *good = false;
            printf("not ok - scene %lu: %s: %s\n", number, relation->name, o.message);
        } else {
            const double error = apart(s, &base, &o, &relation->variant, relation->same_points);
            if (!(error <= allowed(relation, s))) {
                *good = false;
                printf("not ok - scene %lu: %s: %.2g apart, allowed %.1g\n", number, relation->name, error,
                       allowed(relation, s));
            }
            if (error > worst) {
                worst = error;
                worst_one = relation->name;
            }
        }
        outcome_free(&o);
    }
    if (*good)
        printf("ok - scene %lu: %d-D, %s, %s: %.1e %s\n", number, s->dimension, s->method, s->initial, worst,
               worst_one);
    else
        show(s);
    outcome_free(&base);
    return 0;
}

int main(int count, char **word)
{
    const unsigned long first = count > 1 ? strtoul(word[1], NULL, 10) : 1;
    const unsigned long all = count > 2 ? strtoul(word[2], NULL, 10) : 20;
    unsigned long bad = 0, refused = 0;
    for (unsigned long number = first; number < first + all; number++) {
        bool good = true;
        for (int again = 0, none = 1; none != 0 && again < 200; again++) {
            seed = 1000 * number + (unsigned long)again;
            chance(2);
            struct drawn s = draw();
            s.end_time = 1;
            none = hold(number, &s, count > 3 ? word[3] : NULL, &good);
            refused += none != 0;
        }
        bad += good ? 0 : 1;
        (void)fflush(stdout);
    }
    printf("%lu passed, %lu failed; %lu scenes drawn besides that are refused, unstable or at rest\n",
           all - bad, bad, refused);
    return bad > 0;
}
