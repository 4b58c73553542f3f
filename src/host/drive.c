/* Loads and motions that a host gives by callbacks or holds at a value.
 *
 * A traction that varies over its patch is cut into pieces no wider than the spacing of the points; each
 * piece is a uniform load of its own along each axis, whose amplitude is the host's vector at the piece's
 * centre (midpoint rule: the error is of second order in the spacing). So every method carries a host's loads
 * with the same care as the deck's, and a uniform traction is exactly the deck's own. A body force becomes
 * forces at the middles of the cells. */
#include "host/simulation.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Pieces of one load, all directions together; each takes memory for its own force pattern. */
enum { MOST_PIECES = 100000 };

bool host_drives(const selas_simulation *simulation)
{
    const struct host *host = &simulation->host;
    bool any = host->loads > 0;
    for (size_t face = 0; face < FACES; face++)
        any = any || host->face[face].function != NULL;
    return any;
}

/* --- Cutting loads into pieces
 * ------------------------------------------------------------------------------------------------------ */

/* How a load is cut: `count` pieces along each axis of the body's frame, about `middle`. */
struct cut {
    size_t count[3];
    double middle[3], extent[3];
};

static selas_status cut_of(const struct scene *scene, const struct load *load, struct cut *cut,
                           struct messages *messages)
{
    const struct body *body = &scene->body;
    *cut = (struct cut){.count = {1, 1, 1}};
    body_from_deck(body, load->centre, cut->middle);
    if (load->kind == LOAD_MOMENT_TENSOR || load->shape == LOAD_DISC || load->velocity[0] != 0 ||
        load->velocity[1] != 0 || load->velocity[2] != 0)
        return fail(
            messages, SELAS_UNSUPPORTED,
            "a function can give tractions on squares, whole faces and points at rest, and body forces");
    if (load->kind == LOAD_BODY_FORCE && load->shape == LOAD_FACE &&
        (body->shape == BODY_POINTS || body->shape == BODY_PLATE_WITH_HOLE))
        return fail(messages, SELAS_UNSUPPORTED, "a function can give the body force of boxes only");
    size_t along = 0, pieces = 1;
    for (int axis = 0; axis < scene->dimension; axis++) {
        const bool whole = load->shape == LOAD_FACE;
        if (load->shape == LOAD_POINT || (load->kind == LOAD_TRACTION && axis == face_axis(load->face)))
            continue;
        cut->extent[axis] = whole ? body->high[axis] - body->low[axis] : load->size[along];
        if (whole) cut->middle[axis] = 0.5 * (body->low[axis] + body->high[axis]);
        cut->count[axis] = (size_t)fmax(1.0, ceil(cut->extent[axis] / body->spacing * (1.0 - 1e-9)));
        pieces *= cut->count[axis];
        along++;
    }
    if (pieces * (size_t)scene->dimension > MOST_PIECES)
        return fail(messages, SELAS_UNSUPPORTED,
                    "a load given by a function would need %zu pieces; at most %d are offered", pieces,
                    MOST_PIECES / scene->dimension);
    return SELAS_OK;
}

static size_t pieces_of(const struct cut *cut)
{
    return cut->count[0] * cut->count[1] * cut->count[2];
}

/* The pieces' loads (dimension for each) from scene->load[first] on, and their centres. */
static void lay_pieces(struct scene *scene, size_t original, const struct cut *cut, size_t first,
                       double *centre)
{
    const struct body *body = &scene->body;
    const struct load *whole = &scene->load[original];
    const size_t d = (size_t)scene->dimension;
    for (size_t p = 0; p < pieces_of(cut); p++) {
        const size_t at[3] = {p % cut->count[0], p / cut->count[0] % cut->count[1],
                              p / (cut->count[0] * cut->count[1])};
        struct load piece = *whole;
        double place[3], volume = 1.0;
        size_t along = 0;
        for (size_t axis = 0; axis < 3; axis++) {
            const double width = cut->extent[axis] / (double)cut->count[axis];
            place[axis] = cut->middle[axis] - 0.5 * cut->extent[axis] + ((double)at[axis] + 0.5) * width;
            if (width > 0.0) piece.size[along++] = width;
            if (width > 0.0) volume *= width;
        }
        body_to_deck(body, place, piece.centre);
        memcpy(centre + 3 * p, piece.centre, sizeof piece.centre);
        if (whole->kind == LOAD_TRACTION && whole->shape == LOAD_FACE && d > 1) piece.shape = LOAD_SQUARE;
        if (whole->kind == LOAD_BODY_FORCE) piece.shape = LOAD_POINT;
        piece.amplitude = whole->kind == LOAD_BODY_FORCE ? volume : 1.0;
        piece.name[0] = '\0';
        for (size_t c = 0; c < d; c++) {
            /* the histories are never asked; no two are alike, so that no mirror plane is taken for one */
            piece.history = (struct history){.kind = HISTORY_STEP, .delay = (double)(first + d * p + c + 1)};
            memset(piece.direction, 0, sizeof piece.direction);
            piece.direction[c] = 1.0;
            scene->load[first + d * p + c] = piece;
        }
    }
}

static selas_status make_room(selas_simulation *simulation, const struct cut *cut)
{
    struct host *host = &simulation->host;
    struct scene *scene = simulation->scene;
    const size_t d = (size_t)scene->dimension;
    size_t pieces = 0;
    for (size_t i = 0; i < host->loads; i++)
        if (!host->load[i].held) pieces += pieces_of(&cut[i]);
    struct load *all = array_new(scene->loads + d * pieces, sizeof *all);
    array_free(host->centre);
    array_free(host->held);
    host->centre = array_new(3 * pieces, sizeof *host->centre);
    host->held = array_new(scene->loads + d * pieces, sizeof *host->held);
    if (all == NULL || host->centre == NULL || host->held == NULL) {
        array_free(all);
        return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for the pieces of the host's loads");
    }
    if (scene->loads > 0) memcpy(all, scene->load, scene->loads * sizeof *all);
    array_free(scene->load);
    scene->load = all;
    host->pieces = pieces;
    return SELAS_OK;
}

static void take_over(selas_simulation *simulation, const struct cut *cut)
{
    struct host *host = &simulation->host;
    struct scene *scene = simulation->scene;
    const size_t d = (size_t)scene->dimension;
    size_t piece = 0;
    for (size_t i = 0; i < host->loads; i++) {
        struct driven_load *driven = &host->load[i];
        struct load *load = &scene->load[driven->load];
        history_free(&load->history);
        load->history = (struct history){.kind = HISTORY_STEP, .delay = (double)(driven->load + 1)};
        load->amplitude = 1.0;
        host->held[driven->load] = true;
        driven->first = piece;
        driven->pieces = driven->held ? 0 : pieces_of(&cut[i]);
        if (driven->held) continue;
        lay_pieces(scene, driven->load, &cut[i], scene->loads, host->centre + 3 * piece);
        scene->loads += d * driven->pieces;
        piece += driven->pieces;
    }
}

selas_status host_prepare_scene(selas_simulation *simulation)
{
    struct host *host = &simulation->host;
    struct scene *scene = simulation->scene;
    if (!host_drives(simulation)) return SELAS_OK;
    if (scene->stepping.unwarp_given && scene->stepping.unwarp)
        return fail(&simulation->messages, SELAS_BAD_SCENE,
                    "stepping%%unwarp needs histories that are known beforehand; the host drives this scene");
    scene->stepping.unwarp_given = true;
    scene->stepping.unwarp = false;
    struct cut *cut = array_new(host->loads, sizeof *cut);
    if (cut == NULL) return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for the host's loads");
    selas_status status = SELAS_OK;
    for (size_t i = 0; i < host->loads && status == SELAS_OK; i++)
        if (!host->load[i].held)
            status = cut_of(scene, &scene->load[host->load[i].load], &cut[i], &simulation->messages);
    if (status == SELAS_OK) status = make_room(simulation, cut);
    if (status == SELAS_OK) take_over(simulation, cut);
    array_free(cut);
    for (size_t face = 0; face < FACES; face++) {
        struct boundary *boundary = &scene->boundary[face];
        if (host->face[face].function == NULL) continue;
        host->drive.moves = true;
        /* the host's motion may come at any time: the energy watch must not take its end for that of the
         * deck's */
        history_free(&boundary->history);
        boundary->history = (struct history){.kind = HISTORY_TRIANGLE, .duration = scene->end_time};
        boundary->kind = BOUNDARY_DISPLACEMENT;
        boundary->amplitude = 1.0;
    }
    return status;
}

/* --- Asking the host
 * ------------------------------------------------------------------------------------------------------ */

static bool ask(selas_simulation *simulation, selas_vector_function function, void *context, double time,
                const double *place, const char *name, double value[3])
{
    struct host *host = &simulation->host;
    const double position[3] = {place[0], place[1], place[2]};
    value[0] = value[1] = value[2] = 0.0;
    if (host->answer < 0) return false;
    simulation->busy = true;
    int answer = function(context, time, position, value);
    simulation->busy = false;
    if (answer >= 0 && !isfinite(value[0] + value[1] + value[2])) answer = -1;
    if (answer != 0 && (host->answer == 0 || answer < 0)) {
        host->answer = answer;
        snprintf(host->refused, sizeof host->refused, "%.60s", name);
    }
    if (answer < 0) value[0] = value[1] = value[2] = 0.0;
    return answer >= 0;
}

static void drive_load(selas_simulation *simulation, const struct driven_load *driven, size_t first,
                       double time, double *load)
{
    const struct scene *scene = simulation->scene;
    const size_t d = (size_t)scene->dimension;
    char number[32];
    snprintf(number, sizeof number, "%zu", driven->load + 1);
    const char *name = scene->load[driven->load].name;
    for (size_t p = 0; p < driven->pieces; p++) {
        double value[3];
        ask(simulation, driven->function, driven->context, time,
            simulation->host.centre + 3 * (driven->first + p), name[0] != '\0' ? name : number, value);
        memcpy(load + first + d * p, value, d * sizeof *load);
    }
}

static void drive_at_time(void *context, double time, double *load, double *displacement)
{
    selas_simulation *simulation = context;
    const struct host *host = &simulation->host;
    const struct scene *scene = simulation->scene;
    const size_t d = (size_t)scene->dimension;
    const size_t own = scene->loads - d * host->pieces;
    for (size_t i = 0; i < host->loads; i++) {
        const struct driven_load *driven = &host->load[i];
        load[driven->load] = driven->held ? driven->value : 0.0;
        if (!driven->held) drive_load(simulation, driven, own + d * driven->first, time, load);
    }
    for (size_t face = 0; face < FACES; face++) {
        if (host->face[face].function == NULL) continue;
        const struct body *body = &scene->body;
        const double *direction = scene->boundary[face].direction;
        double middle[3], place[3], value[3];
        for (size_t c = 0; c < 3; c++)
            middle[c] = 0.5 * (body->low[c] + body->high[c]);
        const int axis = face_axis((enum face)face);
        if (face < BOX_FACES)
            middle[axis] = face_sign((enum face)face) < 0 ? body->low[axis] : body->high[axis];
        body_to_deck(body, middle, place);
        ask(simulation, host->face[face].function, host->face[face].context, time, place,
            face_name((enum face)face), value);
        displacement[face] = value[0] * direction[0] + value[1] * direction[1] + value[2] * direction[2];
    }
}

selas_status host_prepare_stepper(selas_simulation *simulation)
{
    struct host *host = &simulation->host;
    if (!host_drives(simulation)) return SELAS_OK;
    host->drive.context = simulation;
    host->drive.at = drive_at_time;
    host->drive.held = host->held;
    return drive_by_host(simulation->stepper, &host->drive, &simulation->messages);
}

selas_status host_answer(selas_simulation *simulation)
{
    struct host *host = &simulation->host;
    const int answer = host->answer;
    host->answer = 0;
    if (answer == 0) return SELAS_OK;
    if (answer > 0) return SELAS_STOPPED;
    return fail(&simulation->messages, SELAS_CALLBACK_FAILED,
                "the host's function for '%s' failed or gave no finite vector at step %lu (it returned %d)",
                host->refused, simulation->state.step, answer);
}

selas_status host_refresh(selas_simulation *simulation)
{
    if (!simulation->dirty) return SELAS_OK;
    simulation->dirty = false;
    drive_again(simulation->stepper, &simulation->state);
    return recorder_observe_again(simulation->recorder, &simulation->state, &simulation->messages);
}

void host_free(selas_simulation *simulation)
{
    struct host *host = &simulation->host;
    free(host->load);
    array_free(host->centre);
    array_free(host->held);
}

/* --- What hosts call
 * ------------------------------------------------------------------------------------------------------ */

/* Index of a load by its name, or its number from 1 where it has none. */
static selas_status find_load(selas_simulation *simulation, const char *name, size_t *index)
{
    const struct scene *scene = simulation->scene;
    const size_t own = deck_count(simulation->deck, "load");
    for (size_t i = 0; name != NULL && i < own; i++) {
        char number[32];
        snprintf(number, sizeof number, "%zu", i + 1);
        if (strcmp(scene->load[i].name[0] != '\0' ? scene->load[i].name : number, name) != 0) continue;
        *index = i;
        return SELAS_OK;
    }
    return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                "there is no load '%.60s'; expected the name of a &load, or its number if it has none",
                name != NULL ? name : "(NULL)");
}

static struct driven_load *driven_of(struct host *host, size_t load)
{
    for (size_t i = 0; i < host->loads; i++)
        if (host->load[i].load == load) return &host->load[i];
    return NULL;
}

static selas_status drive_new_load(selas_simulation *simulation, const struct driven_load *wanted)
{
    struct host *host = &simulation->host;
    const selas_status status = simulation_change(simulation);
    if (status != SELAS_OK) return status;
    struct driven_load *driven = driven_of(host, wanted->load);
    if (driven == NULL) {
        if (host->loads == host->room) {
            const size_t room = 2 * host->room + 4;
            struct driven_load *grown = realloc(host->load, room * sizeof *grown);
            if (grown == NULL)
                return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for the host's loads");
            host->load = grown;
            host->room = room;
        }
        driven = &host->load[host->loads++];
    }
    *driven = *wanted;
    return SELAS_OK;
}

static selas_status set_function(selas_simulation *simulation, const char *load, enum load_kind kind,
                                 selas_vector_function function, void *context)
{
    struct driven_load wanted = {.function = function, .context = context};
    struct cut cut;
    selas_status status = simulation_scene(simulation);
    if (status == SELAS_OK && function == NULL)
        status = fail(&simulation->messages, SELAS_BAD_ARGUMENT, "the function is NULL");
    if (status == SELAS_OK) status = find_load(simulation, load, &wanted.load);
    if (status != SELAS_OK) return status;
    const struct load *named = &simulation->scene->load[wanted.load];
    if (named->kind != kind)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "load '%s' is no %s", load,
                    kind == LOAD_TRACTION ? "traction" : "body force");
    status = cut_of(simulation->scene, named, &cut, &simulation->messages);
    return status == SELAS_OK ? drive_new_load(simulation, &wanted) : status;
}

selas_status selas_set_traction(selas_simulation *simulation, const char *load,
                                selas_vector_function traction, void *context)
{
    return set_function(simulation, load, LOAD_TRACTION, traction, context);
}

selas_status selas_set_body_force(selas_simulation *simulation, const char *load, selas_vector_function force,
                                  void *context)
{
    return set_function(simulation, load, LOAD_BODY_FORCE, force, context);
}

selas_status selas_set_motion(selas_simulation *simulation, const char *face,
                              selas_vector_function displacement, void *context)
{
    selas_status status = simulation_scene(simulation);
    if (status != SELAS_OK) return status;
    if (displacement == NULL) return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "the function is NULL");
    size_t index = FACES;
    for (size_t i = 0; face != NULL && i < FACES; i++)
        if (strcmp(face_name((enum face)i), face) == 0) index = i;
    if (index == FACES)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "there is no face '%.60s'; expected x-, x+, ... z+", face != NULL ? face : "(NULL)");
    const enum boundary_kind kind = simulation->scene->boundary[index].kind;
    if (kind != BOUNDARY_DISPLACEMENT && kind != BOUNDARY_VELOCITY)
        return fail(
            &simulation->messages, SELAS_BAD_ARGUMENT,
            "face '%s' has no &boundary of kind 'displacement' (its direction says which way it moves)",
            face);
    status = simulation_change(simulation);
    if (status == SELAS_OK) simulation->host.face[index] = (struct driven_face){displacement, context};
    return status;
}

selas_status selas_set_load(selas_simulation *simulation, const char *load, double value)
{
    struct driven_load wanted = {.held = true, .value = value};
    selas_status status = simulation_scene(simulation);
    if (status == SELAS_OK) status = find_load(simulation, load, &wanted.load);
    if (status != SELAS_OK) return status;
    if (!isfinite(value))
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "the value of load '%s' is not a finite number", load);
    struct driven_load *driven = driven_of(&simulation->host, wanted.load);
    if (driven != NULL && !driven->held)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "load '%s' is given by a function of the host",
                    load);
    if (driven == NULL) return drive_new_load(simulation, &wanted);
    driven->value = value;
    simulation->dirty = simulation->state.y != NULL;
    return SELAS_OK;
}

/* The velocities of a body that moves as one in the direction given (deck coordinates): their power is the
 * load's resultant. */
static void translate(const struct model *model, const double direction[3], double *velocity)
{
    const size_t d = (size_t)model->scene->dimension;
    double own[3] = {direction[0], direction[1], direction[2]};
    if (model->frame != NULL) body_direction_from_deck(&model->scene->body, direction, own);
    for (size_t i = 0; i < model->unknowns / d; i++)
        for (size_t c = 0; c < 3 && c < d; c++)
            velocity[c * model->component_stride + i * model->point_stride] = own[c];
}

selas_status selas_load_mean(selas_simulation *simulation, const char *load, selas_field field, double *value)
{
    selas_status status = simulation_begin(simulation);
    size_t index = 0;
    if (status == SELAS_OK) status = find_load(simulation, load, &index);
    if (status != SELAS_OK) return status;
    struct model *model = simulation->model;
    const struct load *named = &simulation->scene->load[index];
    if (value == NULL || field < SELAS_DISPLACEMENT || field > SELAS_ACCELERATION)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "means are those of displacement, velocity or acceleration, and need room for a value");
    if (model->class->power == NULL || model->state_size < 2 * model->unknowns ||
        named->kind == LOAD_MOMENT_TENSOR || named->amplitude == 0.0)
        return fail(&simulation->messages, SELAS_UNSUPPORTED, "this load or method has no mean displacement");
    const struct state *state = &simulation->state;
    const size_t n = model->unknowns, loads = simulation->scene->loads;
    if (simulation->scratch == NULL)
        simulation->scratch = array_new(model->state_size + 2 * loads, sizeof(double));
    if (simulation->scratch == NULL)
        return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a mean");
    /* the power of a unit load is the integral of what it does work on */
    double *y = simulation->scratch, *unit = y + model->state_size;
    const double *part = field == SELAS_DISPLACEMENT ? state->y
                         : field == SELAS_VELOCITY   ? state->y + n
                                                     : state->a;
    for (size_t k = 0; k < loads; k++)
        unit[k] = k == index ? 1.0 / named->amplitude : 0.0;
    const struct drive drive = {.time = state->time, .load = unit};
    double measure = 0.0, power = 0.0, absorbed = 0.0;
    state_settle(simulation->stepper, state, true);
    memcpy(y, state->y, model->state_size * sizeof *y);
    translate(model, named->direction, y + n);
    model->class->power(model, &drive, y, &measure, &absorbed);
    memcpy(y + n, part, n * sizeof *y);
    model->class->power(model, &drive, y, &power, &absorbed);
    *value = power / measure;
    return SELAS_OK;
}
