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

/* --- Cutting loads into pieces --- */

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
    if (load->kind == LOAD_MOMENT_TENSOR || load->shape == LOAD_DISC || load->face == FACE_HOLE ||
        load_moves(load))
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

selas_status host_can_drive(const struct scene *scene, const struct load *load, struct messages *messages)
{
    struct cut cut;
    return cut_of(scene, load, &cut, messages);
}

/* The pieces' loads, one along each axis, from scene->load[driven->first] on. */
static void lay_pieces(const struct scene *scene, const struct driven_load *driven, const struct cut *cut)
{
    const struct load *whole = &scene->load[driven->load];
    const size_t d = (size_t)scene->dimension;
    for (size_t p = 0; p < driven->pieces; p++) {
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
        body_to_deck(&scene->body, place, piece.centre);
        if (whole->kind == LOAD_TRACTION && whole->shape == LOAD_FACE && d > 1) piece.shape = LOAD_SQUARE;
        if (whole->kind == LOAD_BODY_FORCE) piece.shape = LOAD_POINT;
        if (whole->kind == LOAD_BODY_FORCE) piece.amplitude = volume;
        piece.driven = BY_HOST;
        piece.name[0] = '\0';
        for (size_t c = 0; c < d; c++) {
            memset(piece.direction, 0, sizeof piece.direction);
            piece.direction[c] = 1.0;
            scene->load[driven->first + d * p + c] = piece;
        }
    }
}

selas_status host_drives_all(selas_simulation *simulation, size_t load)
{
    const struct scene *scene = simulation->scene;
    const struct load *next = load + 1 < scene->loads ? &scene->load[load + 1] : NULL;
    char number[LOAD_NUMBER_SIZE];
    if (next == NULL || next->driven == BY_HOST || next->group != scene->load[load].group) return SELAS_OK;
    return fail(
        &simulation->messages, SELAS_UNSUPPORTED,
        "load '%s' is several sources, which no host drives as one; a &load for each of them would do",
        load_name(scene, load, number));
}

/* Marks a load as the host's, wherever the scene has it; behind the scene's loads come the pieces of one that a
 * function gives. */
static selas_status take_over(selas_simulation *simulation, struct driven_load *driven)
{
    struct scene *scene = simulation->scene;
    driven->load = 0;
    while (scene->load[driven->load].group != driven->group) /* each &load is a load at least */
        driven->load++;
    struct load *load = &scene->load[driven->load];
    struct cut cut;
    if (host_drives_all(simulation, driven->load) != SELAS_OK) return SELAS_UNSUPPORTED;
    history_free(&load->history);
    load->history = (struct history){0};
    load->driven = HELD_BY_HOST; /* at 0 if a function gives its pieces */
    load->amplitude = 1.0;
    if (driven->function == NULL) return SELAS_OK;
    const selas_status status = cut_of(scene, load, &cut, &simulation->messages);
    if (status != SELAS_OK) return status;
    driven->pieces = cut.count[0] * cut.count[1] * cut.count[2];
    driven->first = scene->loads;
    const size_t loads = driven->first + (size_t)scene->dimension * driven->pieces;
    struct load *all = array_new(loads, sizeof *all);
    if (all == NULL)
        return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for the pieces of the host's loads");
    memcpy(all, scene->load, driven->first * sizeof *all);
    array_free(scene->load);
    scene->load = all;
    scene->loads = loads;
    lay_pieces(scene, driven, &cut);
    return SELAS_OK;
}

/* An exact solution is that of the deck's histories, which nobody asks for. */
static void drop_reference(selas_simulation *simulation)
{
    struct reference *reference = &simulation->scene->reference;
    if (reference->kind[0] == '\0' || strcmp(reference->kind, "file") == 0) return;
    if (reference->group != NULL)
        warn(&simulation->messages,
             "reference '%s' knows the histories of the deck, not what a host drives: nothing is compared; "
             "reference 'file' would be right",
             reference->kind);
    reference->kind[0] = '\0';
}

selas_status host_moves(selas_simulation *simulation, enum face face)
{
    if (boundary_moves(&simulation->scene->boundary[face])) return SELAS_OK;
    return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                "a function of the host moves face '%s', which has no &boundary of kind 'displacement' (its "
                "direction "
                "says which way)",
                face_name(face));
}

selas_status host_prepare_scene(selas_simulation *simulation)
{
    const struct host *host = &simulation->host;
    selas_status status = SELAS_OK;
    for (size_t face = 0; face < FACES; face++) {
        struct boundary *boundary = &simulation->scene->boundary[face];
        if (host->face[face].function == NULL) continue;
        if (host_moves(simulation, (enum face)face) != SELAS_OK) return SELAS_BAD_SCENE;
        history_free(&boundary->history);
        boundary->history = (struct history){0};
        boundary->driven = BY_HOST;
        boundary->kind = BOUNDARY_DISPLACEMENT;
        boundary->amplitude = 1.0;
    }
    for (size_t i = 0; i < host->loads && status == SELAS_OK; i++)
        status = take_over(simulation, &host->load[i]);
    if (scene_driven(simulation->scene)) drop_reference(simulation);
    return status;
}

const char *load_name(const struct scene *scene, size_t load, char number[LOAD_NUMBER_SIZE])
{
    snprintf(number, LOAD_NUMBER_SIZE, "%zu", scene->load[load].group + 1);
    return scene->load[load].name[0] != '\0' ? scene->load[load].name : number;
}

/* --- Asking the host --- */

static bool ask(selas_simulation *simulation, selas_vector_function function, void *context, double time,
                const double *place, const char *name, double value[3])
{
    struct host *host = &simulation->host;
    const double position[3] = {place[0], place[1], place[2]};
    value[0] = value[1] = value[2] = 0.0;
    if (host->answer < 0) return false;
    simulation->busy = true;
    const locale_t own = uselocale(simulation->host_locale);
    fesetenv(&simulation->host_rules);
    int answer = function(context, time, position, value);
    fesetenv(FE_DFL_ENV);
    uselocale(own);
    simulation->busy = false;
    if (answer >= 0 && !isfinite(value[0] + value[1] + value[2])) answer = -1;
    if (answer != 0 && (host->answer == 0 || answer < 0)) {
        host->answer = answer;
        snprintf(host->refused, sizeof host->refused, "%.60s", name);
    }
    if (answer < 0) value[0] = value[1] = value[2] = 0.0;
    return answer >= 0;
}

/* Sides that the program made rollers, for the deck's load is alike all over the surface along its normal, hold no
 * other: of several pieces each is held against the first. */
static void look_at_sides(selas_simulation *simulation, const char *name, const double first[3],
                          const double value[3])
{
    const struct scene *scene = simulation->scene;
    const int down = scene->dimension - 1;
    double other = fabs(value[down] - first[down]);
    bool made = false;
    for (const struct boundary *side = scene->boundary; side < scene->boundary + 2 * down; side++)
        made = made || (side->kind == BOUNDARY_ROLLER && !side->given);
    if (simulation->host.told || scene->body.shape != BODY_HALF_SPACE || !made) return;
    for (int c = 0; c < 2 && c < down; c++)
        other = fmax(other, fabs(value[c]));
    if (!(other > 1e-9 * fabs(first[down]))) return;
    simulation->host.told = true;
    warn(&simulation->messages,
         "the function for load '%s' gives what is not alike all over the surface along its normal, but the "
         "sides are rollers, which hold it: the box of the half-space (body%%low and high) with faces of its "
         "own would "
         "be right",
         name);
}

static void drive_load(selas_simulation *simulation, const struct driven_load *driven, double time,
                       double *load)
{
    const struct scene *scene = simulation->scene;
    const size_t d = (size_t)scene->dimension;
    char number[LOAD_NUMBER_SIZE];
    const char *name = load_name(scene, driven->load, number);
    double first[3] = {0.0};
    load[driven->load] = driven->value;
    for (size_t p = 0; p < driven->pieces; p++) {
        const size_t piece = driven->first + d * p;
        double value[3];
        ask(simulation, driven->function, driven->context, time, scene->load[piece].centre, name, value);
        if (p == 0) memcpy(first, value, sizeof first);
        if (scene->load[driven->load].shape == LOAD_FACE) look_at_sides(simulation, name, first, value);
        memcpy(load + piece, value, d * sizeof *load);
    }
}

static void drive_at_time(void *context, double time, double *load, double *displacement)
{
    selas_simulation *simulation = context;
    const struct host *host = &simulation->host;
    const struct scene *scene = simulation->scene;
    for (size_t i = 0; i < host->loads; i++)
        drive_load(simulation, &host->load[i], time, load);
    for (size_t face = 0; face < FACES; face++) {
        if (host->face[face].function == NULL) continue;
        const struct body *body = &scene->body;
        const double *direction = scene->boundary[face].direction;
        double middle[3], place[3], value[3];
        for (size_t c = 0; c < 3; c++)
            middle[c] = 0.5 * (body->low[c] + body->high[c]);
        if (face < BOX_FACES) middle[face_axis((enum face)face)] = face_plane(body, (enum face)face);
        body_to_deck(body, middle, place);
        ask(simulation, host->face[face].function, host->face[face].context, time, place,
            face_name((enum face)face), value);
        displacement[face] = value[0] * direction[0] + value[1] * direction[1] + value[2] * direction[2];
    }
}

void host_prepare_stepper(selas_simulation *simulation)
{
    struct host *host = &simulation->host;
    host->drive = (struct host_drive){simulation, drive_at_time};
    if (scene_driven(simulation->scene)) simulation->stepper->driver.host = &host->drive;
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
    struct stepper *stepper = simulation->stepper;
    recorder_forget(simulation->recorder, &simulation->state);
    driver_changed(&stepper->driver, simulation->state.step);
    stepper->scheme->again(stepper, &simulation->state);
    return recorder_observe_again(simulation->recorder, &simulation->state, &simulation->messages);
}

void host_free(selas_simulation *simulation)
{
    struct host *host = &simulation->host;
    free(host->load);
}
