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
    if (load->kind == LOAD_MOMENT_TENSOR || load->shape == LOAD_DISC || load_moves(load))
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

/* --- Asking the host --- */

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
