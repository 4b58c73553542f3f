/* What waves err by on their way: those of loads and moved faces, on points of any method. */
#include "advice/parts.h"

#include "method/methods.h"
#include "scene/extent.h"
#include "scene/initial.h"
#include "scene/resolution.h"

#include <math.h>
#include <string.h>

/* What waves err by for each wavelength, whatever the spacing, is told of from here on. */
#define LASTING .005

static bool along(const struct scene *scene, const double direction[3], int axis)
{
    double own[3];
    body_direction_from_deck(&scene->body, direction, own);
    return fabs(own[axis]) > 1 - 1e-9;
}

/* Do loads and moved faces send plane P waves along an axis alone, between sides that leave them as they are? */
static bool sends_plane_p(const struct scene *scene, int axis)
{
    bool plane = body_is_box(&scene->body) && scene->materials == 1;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (face / 2 != axis)
            plane = plane && boundary_slides(boundary) && !boundary_moves(boundary);
        else if (boundary_acts(boundary))
            plane = plane && along(scene, boundary->direction, axis);
    }
    for (size_t k = 0; k < scene->loads && plane; k++)
        plane = scene->load[k].amplitude == 0 ||
                (scene->load[k].shape == LOAD_FACE && along(scene, scene->load[k].direction, axis) &&
                 (scene->load[k].kind != LOAD_TRACTION || face_axis(scene->load[k].face) == axis));
    return plane;
}

/* Speed of the slowest waves that loads send. */
static double slowest_sent(const struct scene *scene)
{
    for (int axis = 0; axis < scene->dimension; axis++)
        if (sends_plane_p(scene, axis)) return scene->material[0].p_speed;
    return slowest_speed(scene);
}

/* Largest distance of what acts from what is looked at, within the body. */
static double farthest(const struct scene *scene)
{
    const struct body *body = &scene->body;
    double low[2][3], high[2][3], away = 0;
    struct extent extent;
    for (int c = 0; c < 3; c++)
        for (int seen = 0; seen < 2; seen++) {
            low[seen][c] = body->high[c];
            high[seen][c] = body->low[c];
        }
    for (size_t k = 0; scene_extent(scene, k, &extent); k++)
        for (int c = 0, seen = extent.role == EXTENT_SEEN; c < 3 && extent.role != EXTENT_IDLE; c++) {
            low[seen][c] = fmin(low[seen][c], fmax(extent.low[c], body->low[c]));
            high[seen][c] = fmax(high[seen][c], fmin(extent.high[c], body->high[c]));
        }
    for (int c = 0; c < 3 && c < scene->dimension; c++)
        away = hypot(away, fmax(0, fmax(high[0][c] - low[1][c], high[1][c] - low[0][c])));
    return away;
}

/* How far waves of a number k that loads send run until they are seen last, or 1/e is left of them. */
static double seen_way(const struct scene *scene, double speed, double k)
{
    bool leave = true;
    double quality = 0;
    for (size_t m = 0; m < scene->materials; m++) {
        const double larger = fmax(scene->material[m].q_p, scene->material[m].q_s);
        quality = fmax(quality, larger > 0 ? larger : INFINITY);
    }
    for (int axis = 0; axis < scene->dimension; axis++)
        leave = leave && (boundary_absorbs(&scene->boundary[2 * axis]) ||
                          boundary_absorbs(&scene->boundary[2 * axis + 1]));
    const double way = fmin(longest_way(scene, speed), quality > 0 ? 2 * quality / k : INFINITY);
    return fmin(way, leave || scene->body.chosen ? farthest(scene) : INFINITY);
}

/* What loads send on splines. By end_time bars erred by .8 to 1.4 of what is told up to .4 (regress/studies/bodies/
 * long-way), by less where more is told; boxes in the plane by .2 to 1.3, since much in them is P waves. */
void look_at_long_way(struct adviser *adviser, const struct model *model)
{
    static const double seen = .1;
    const struct scene *scene = adviser->scene;
    const struct wave_law law = {.constant = model->waves.sent, .order = model->waves.sent_order};
    const bool told = scene_has_exact(scene) || scene->body.accuracy[0] != '\0' ||
                      points_per_wavelength(scene) < FEWEST_POINTS; /* (advice.c tells) */
    const double slowest = slowest_sent(scene), k = typical_frequency(scene) / slowest;
    if (told || !(scene->body.spacing > 0) || !on_splines(model)) return;
    const double error = error_of_waves(scene, &law, k, seen_way(scene, slowest, k));
    if (error > seen)
        advise(adviser,
               "waves that loads send, %.3g points each at half the largest amplitude, err by up to about "
               "%.2g on their longest way; body%%spacing = %.3g%s would be right",
               2 * M_PI / k / scene->body.spacing, fmin(1, error),
               scene->body.spacing * pow(seen / 2 / error, 1 / law.order),
               law.order < 3 ? ", or method%degree = 2," : "");
}

/* The method as published presses and holds faces to order 0. Measured: patches on held
 * boxes .4 to .6, on free ones .6 to 1.1, half-spaces .2 to .7 (paper-method.md). */
static void look_at_pressed_faces(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    bool pressed = false;
    for (size_t k = 0; k < scene->loads; k++)
        pressed = pressed || (scene->load[k].kind == LOAD_TRACTION && scene->load[k].amplitude != 0);
    for (int face = 0; face < FACES; face++)
        pressed = pressed || boundary_acts(&scene->boundary[face]);
    if (pressed)
        advise(adviser, "variant 'paper' carries what acts on faces to order 0: velocities were .1 to 1.5 "
                        "wrong, whatever "
                        "the spacing (most where faces are free); variant = 'consistent' would be right");
}

/* What the paper's waves err by where they meet faces, carried to order 0, by end_time: each time .15 at free faces and
 * dampers (which send little back: twice at most), .05 at held ones (paper-method.md). In a bar free ends are
 * right, but on springs as printed. */
static double error_at_faces(const struct scene *scene, double ends, double way)
{
    static const double loose = .15, held = .05;
    double most = 0;
    for (int axis = 0; axis < 3 && axis < scene->dimension; axis++) {
        const double edge = scene->body.high[axis] - scene->body.low[axis];
        double each = 0, times = way / edge;
        if (!(way > edge) && !(ends > 0)) continue;
        for (int face = 2 * axis; face < 2 * axis + 2; face++) {
            const bool absorbs = boundary_absorbs(&scene->boundary[face]);
            const bool free = boundary_is_free(&scene->boundary[face]);
            if (absorbs) times = fmin(times, 2);
            each += absorbs                 ? fmax(loose, ends)
                    : scene->dimension == 1 ? (free ? ends : 0)
                    : free                  ? loose
                                            : held;
        }
        most = fmax(most, each / 2 * times);
    }
    return most;
}

/* Free, and no load presses on it? */
static bool is_bare(const struct scene *scene, int face)
{
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].kind == LOAD_TRACTION && (int)scene->load[k].face == face) return false;
    return boundary_is_free(&scene->boundary[face]);
}

/* What waves of a number k err by that have met bare faces on their way: each time they come back so much too early
 * (doc/theory/sph-updated-lagrangian.md, U14). */
static double error_at_bare(const struct scene *scene, const struct wave_law *law, double k, double way)
{
    double most = 0;
    for (int axis = 0; axis < 3 && axis < scene->dimension; axis++) {
        const double edge = scene->body.high[axis] - scene->body.low[axis];
        const bool leaves =
            boundary_absorbs(&scene->boundary[2 * axis]) || boundary_absorbs(&scene->boundary[2 * axis + 1]);
        const double each = (is_bare(scene, 2 * axis) + is_bare(scene, 2 * axis + 1)) / 2.;
        const double times =
            fmin(way / edge, way * k / M_PI); /* a wave longer than twice the edge runs along it */
        most = fmax(most, each * (leaves ? fmin(times, 2) : times));
    }
    return most * law->bare * k * scene->body.spacing;
}

/* What loads and moved faces give to walls. Of 30 boxes drawn by chance seven were stopped, one erred by 1.3
 * (doc/theory/sph-updated-lagrangian.md). */
static void look_at_alternation(struct adviser *adviser, const struct model *model)
{
    if (model->alternates && sending_begins(adviser->scene) < adviser->scene->end_time)
        advise(
            adviser,
            "nothing holds motions that alternate from particle to particle: runs may be stopped, velocities "
            "have been up to 1.3 wrong; method%%hourglass = 0.02, or method%%viscosity_alpha = 0.5, "
            "viscosity_beta = 0.5, "
            "would be right");
}

/* When a history first has half its largest amplitude. */
static double half_begins(const struct history *history, double end)
{
    enum { LOOKS = 256 };
    const double each = (fmin(history_end(history), end) - history->start) / LOOKS;
    double largest = 0;
    int first = 0;
    for (int k = 1; k <= LOOKS; k++)
        largest = fmax(largest, fabs(history_value(history, history->start + k * each, 0)));
    while (first < LOOKS && fabs(history_value(history, history->start + first * each, 0)) < largest / 2)
        first++;
    return history->start + first * each;
}

double sending_begins(const struct scene *scene)
{
    double first = scene->end_time;
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].amplitude != 0) first = fmin(first, half_begins(&scene->load[k].history, first));
    for (size_t face = 0; face < FACES; face++)
        if (boundary_acts(&scene->boundary[face]))
            first = fmin(first, half_begins(&scene->boundary[face].history, first));
    return first;
}

bool cloud_would_run(const struct adviser *adviser, const struct model *model)
{
    const struct method *cloud = method_find("smoothed-point", "cloud");
    return model->method != cloud && method_takes(cloud, adviser->scene);
}

/* What would carry waves better on the same body; "": finer points alone. */
static const char *better_points(const struct adviser *adviser, const struct model *model)
{
    const struct body *body = &adviser->scene->body;
    const bool scattered = body->jitter > 0 || body->shape == BODY_POINTS;
    if (scattered && cloud_would_run(adviser, model)) return "variant = 'cloud'";
    if (body_is_box(body)) return "variant = 'consistent'";
    if (model->waves.floor > 2 * model->waves.scatter) return "variant = 'total-lagrangian'";
    return model->waves.scatter > LASTING ? "points in the order of a lattice" : "";
}

/* Wave number of the slowest wave that stands between held faces: half a wave between two, a quarter behind one. */
static double standing_number(const struct scene *scene)
{
    double number = 0;
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double edge = scene->body.high[axis] - scene->body.low[axis];
        int held = 0;
        for (int face = 2 * axis; face < 2 * axis + 2; face++)
            held += boundary_meaning(&scene->boundary[face])->holds == HOLDS_ALL ||
                    (scene->dimension == 1 && boundary_slides(&scene->boundary[face]));
        number = hypot(number, held * M_PI / 2 / edge);
    }
    return number;
}

/* What a state at t = 0 errs by when it is seen last: what is lost on the way, and what stays whatever the spacing. */
static double error_of_first(const struct scene *scene, const struct wave_law *law)
{
    const struct wave_law lost = {.constant = law->constant, .order = law->order};
    const struct wave_law lasting = {.floor = law->floor + (scene->initial.shear ? law->shear : 0)};
    const double way = plane_wave_speed(scene) * scene->end_time;
    return error_of_waves(scene, &lost, typical_number(scene, law->order), way) +
           error_of_waves(scene, &lasting, typical_number(scene, 0), way) +
           error_at_bare(scene, law, typical_number(scene, 0), way);
}

/* What waves err by that loads and moved faces send. In a body that is held they are as short as it is small, and go on
 * if the source has their frequency; else the body follows (doc/howto/spacing.md, Eq 2). */
static double error_of_sent(const struct scene *scene, const struct wave_law *waves)
{
    static const double counts = 1e-3;
    const double slowest = slowest_sent(scene), sent = typical_frequency(scene) / slowest;
    const double standing = standing_number(scene), k = hypot(sent, standing);
    const bool follows = standing * slowest > source_cutoff_at(scene, counts);
    const double whole = slowest * (scene->end_time - sending_begins(scene));
    const double way = follows ? fmin(whole, M_PI / k) : whole;
    const struct wave_law law = {.constant = waves->sent,
                                 .order = waves->sent_order,
                                 .floor = waves->floor + (slowest < scene_fastest(scene) ? waves->shear : 0)};
    return sent > 0 ? error_of_waves(scene, &law, k, way) + error_at_bare(scene, waves, k, way) : 0;
}

/* What strains err by more, in a box that a face which is no mirror plane meets: more where a patch, whose edges are
 * jumps, presses on it. */
static double error_beside_faces(const struct scene *scene, const double low[3], const double high[3])
{
    static const double one_sided = .1, jumps = .3;
    double most = 0;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const int axis = face / 2;
        if (boundary_mirrors(&scene->boundary[face])) continue;
        const double plane = face_plane(&scene->body, (enum face)face);
        if (plane < low[axis] || plane > high[axis]) continue;
        most = fmax(most, one_sided);
        for (size_t k = 0; k < scene->loads; k++)
            if (has_patch(&scene->load[k]) && (int)scene->load[k].face == face) most = jumps;
    }
    return most;
}

/* The same at a place of the deck, a spacing about it. */
static double error_beside(const struct scene *scene, const double deck[3])
{
    double place[3], low[3], high[3];
    body_from_deck(&scene->body, deck, place);
    for (int axis = 0; axis < 3; axis++) {
        low[axis] = place[axis] - scene->body.spacing;
        high[axis] = place[axis] + scene->body.spacing;
    }
    return error_beside_faces(scene, low, high);
}

static bool strains_in(unsigned fields)
{
    return (fields & (1U << SELAS_STRESS | 1U << SELAS_STRAIN | 1U << SELAS_PRESSURE | 1U << SELAS_ENERGY)) !=
           0;
}

/* Are strains, or what follows from them, shown by profiles and snapshots? What they err by beside faces, in *more. */
static bool shows_strains(const struct scene *scene, double *more)
{
    bool shown = false;
    *more = 0;
    for (size_t k = 0; k < scene->profiles; k++) {
        if (!strains_in(scene->profile[k].fields)) continue;
        shown = true;
        for (size_t i = 0; i < scene->profile[k].points; i++) {
            double deck[3] = {0.0};
            profile_position(&scene->profile[k], i, deck);
            *more = fmax(*more, error_beside(scene, deck));
        }
    }
    for (size_t k = 0; k < scene->snapshots; k++) {
        if (!strains_in(scene->snapshot[k].fields)) continue;
        shown = true;
        double low[3] = {0.0}, high[3] = {0.0};
        snapshot_box(scene, &scene->snapshot[k], low, high);
        *more = fmax(*more, error_beside_faces(scene, low, high));
    }
    return shown;
}

/* What strains of particles err by, where velocities err so much by the state at t = 0 and by what is sent, and `more`
 * beside faces; 0: no more than is told of velocities. Those that loads give a body that nothing holds are largely of
 * the whole body, of which strains know nothing (doc/theory/sph-total-lagrangian.md, section 6). */
static double error_of_strains(const struct scene *scene, const struct model *model, double first,
                               double sent, double more)
{
    static const double flying = 5;
    bool free = true;
    if (strcmp(model->method->variant, "total-lagrangian") != 0) return 0;
    for (int face = 0; face < 2 * scene->dimension; face++)
        free = free && boundary_is_free(&scene->boundary[face]);
    const double error = fmax(first, sent * (free ? flying : 1)) + more;
    return error > WAVES_SEEN && error > fmax(first, sent) ? fmin(1, error) : 0;
}

double advice_strain_error(const struct model *model, const double position[3], selas_field field)
{
    const struct scene *scene = model->scene;
    if (!strains_in(1U << field) || scene_has_exact(scene) || !(scene->body.spacing > 0)) return 0;
    return error_of_strains(scene, model, error_of_first(scene, &model->waves),
                            error_of_sent(scene, &model->waves), error_beside(scene, position));
}

static void look_at_strains(struct adviser *adviser, const struct model *model, double first, double sent)
{
    double more;
    if (!shows_strains(adviser->scene, &more)) return;
    const double error = error_of_strains(adviser->scene, model, first, sent, more);
    if (error > 0)
        advise(adviser,
               "stresses and strains that profiles and snapshots show err by up to about %.2g%s; variant = "
               "'consistent'%s would be right",
               error, more > 0 ? " within a spacing of faces" : "",
               more > 0 ? ", or places farther inside with finer points," : ", or finer points,");
}

void look_at_method(struct adviser *adviser, const struct model *model)
{
    const struct scene *scene = adviser->scene;
    if (scene_has_exact(scene) || !(scene->body.spacing > 0) || on_splines(model)) return;
    const bool papers = strcmp(model->method->variant, "paper") == 0;
    if (papers) look_at_pressed_faces(adviser);
    const double faces =
        papers ? error_at_faces(scene, model->waves.ends, plane_wave_speed(scene) * scene->end_time) : 0;
    const double first = error_of_first(scene, &model->waves), sent = error_of_sent(scene, &model->waves);
    const double error = fmax(first, sent) + faces;
    const bool remains = model->waves.floor + model->waves.shear > LASTING || faces > WAVES_SEEN;
    const char *better = error > WAVES_SEEN ? better_points(adviser, model) : "";
    if (error > WAVES_SEEN)
        advise(adviser,
               "waves on the points of variant '%s' err by up to %.2g when they have travelled to "
               "end_time%s; %s%s%s would be right",
               model->method->variant, fmin(1, error), remains ? ", much of it whatever the spacing" : "",
               remains && *better ? "" : "finer points", remains || !*better ? "" : " or ", better);
    look_at_strains(adviser, model, first, sent);
    look_at_alternation(adviser, model);
    look_at_bending(adviser, model, fmax(error, WAVES_SEEN));
}
