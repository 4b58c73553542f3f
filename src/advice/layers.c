/* Absorbing layers that are too thin for the spacing: what they send back then hides what the points reach.
 *
 * Layers alone make the error
 *   e = .0011 exp(-.78 n) (lambda/h)^1.7,                                                               (1)
 * n the points, lambda the P wavelength at the mean frequency: measured at the worst of three receivers of a
 * half-space, n 4 to 12, lambda/h 50 to 100, within a factor of two (doc/verification/accuracy.md, section 3). */
#include "accuracy/outlook.h"
#include "advice/parts.h"
#include "scene/absorbing_layers.h"
#include "scene/echo.h"
#include "scene/extent.h"
#include "scene/ground.h"
#include "scene/guided.h"
#include "scene/late.h"
#include "scene/resolution.h"
#include "scene/rests.h"

#include <math.h>
#include <stdio.h>

static double layers_error(size_t points, double cells_per_wavelength)
{
    return 0.00055 * layer_expected_reflection(points) * pow(cells_per_wavelength, 1.7);
}

static bool layer_size_given(const struct boundary *boundary)
{
    return boundary->layer_points > 0 || boundary->layer_thickness > 0 || boundary->layer_reflection > 0;
}

/* Those that (15) of doc/theory/absorbing-faces.md, a bound, lets send back more than this. */
static void look_at_echoes(struct adviser *adviser)
{
    static const double much = .05, much_of_linear = .01;
    const struct scene *scene = adviser->scene;
    const bool linear = layer_degree(scene) == 1;
    double most = linear ? much_of_linear : much;
    const double allowed = most;
    int worst = -1;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const size_t points =
            linear || layer_size_given(&scene->boundary[face]) ? layer_points(scene, face) : 0;
        const double echo = points > 0 ? echo_of_layer(scene, face, points) : 0;
        if (echo <= most) continue;
        most = echo;
        worst = face;
    }
    if (worst < 0) return;
    const bool helps = echo_of_layer(scene, worst, MOST_POINTS) <= fmax(allowed, most / 2);
    advise(adviser,
           "the absorbing layer of face '%s' may send back up to %.2g of the velocity at the worst place "
           "looked at%s would be right",
           face_name((enum face)worst), fmin(most, 1),
           linear   ? " and up to three times that of the displacement: method%degree = 2"
           : !helps ? ", with any number of points: sides farther from what acts and is looked at"
                    : ": more points, or a thickness that is left to the program,");
}

/* Of layers whose size the deck gives: what the program chooses is proved by echoes (scene/absorbing_layers.c). */
static size_t fewest_layer_points(const struct scene *scene)
{
    size_t fewest = 0;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        const size_t points = layer_size_given(boundary) ? layer_points(scene, face) : 0;
        if (points > 0 && (fewest == 0 || points < fewest)) fewest = points;
    }
    return fewest;
}

void look_at_layers(struct adviser *adviser, const struct stepper *stepper)
{
    const struct scene *scene = adviser->scene;
    const size_t points = fewest_layer_points(scene);
    struct ground_outlook outlook;
    const bool late = !stepper->unwarp && stepper->scheme->order < 4; /* errors in time, of no law */
    look_at_echoes(adviser);
    if (points == 0 || scene->body.accuracy[0] != '\0' || late) return;
    /* Too thin, the P wavelength at the mean frequency would be 13 S wavelengths at the cutoff: this saves
     * the exact solution. */
    if ((double)points > 2.0 * points_per_wavelength(scene)) return;
    if (!ground_outlook(scene, &outlook) || outlook.layer_points <= (long)points) return;
    const double cells = outlook.wavelength / scene->body.spacing, error = layers_error(points, cells);
    if ((double)points >= LAYER_THICKNESS * cells || error <= outlook.error) return;
    advise(
        adviser,
        "absorbing layers of %zu points are only %.2g P wavelengths thick at the mean frequency and leave an "
        "error of about %.1g, the spacing only %.1g; layer = 'pml', layer_points = %ld would be right",
        points, (double)points / cells, error, outlook.error, outlook.layer_points);
}

/* What acts all over the surface sends all of it straight down. Measured (regress/checks/fitted.sh): layers of 8 points
 * sent back .017 to .14 of the velocity, dampers .0035 and less (doc/verification/tables/absorbing.txt, table 9). */
void look_at_columns(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    struct extent load;
    if (ground_is_general(scene) || ground_is_damped(scene)) return;
    for (size_t i = 0; scene_extent(scene, i, &load); i++)
        for (int face = 2 * scene->dimension - 2;
             load.role == EXTENT_ACTS && load.plane && face < 2 * scene->dimension; face++) {
            if (layer_points(scene, face) == 0) continue;
            advise(
                adviser,
                "all moves at right angles to face %s, and the absorbing layer behind it sends slow waves "
                "back: with 8 points .02 to .14 of the velocity; layer = 'lysmer' sends hardly anything back",
                face_name((enum face)face));
            return;
        }
}

/* Dampers that nobody asked for. */
void look_at_fallen_layers(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    if (scene->initial.kind == INITIAL_PLANE_WAVE) return;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        if (!scene->boundary[face].fallen || !echo_seen(scene, face, 0)) continue;
        advise(adviser,
               "face %s, transmitting, has dampers, which send back a good part of the waves that meet them "
               "askew: "
               "%s; layer = 'lysmer' says that dampers are meant",
               face_name((enum face)face), layers_refusal(scene));
        return;
    }
}

/* Slabs between two faces that guide waves, which come back from layers (doc/theory/absorbing-faces.md, section 4). */
void look_at_guided(struct adviser *adviser)
{
    static const double little = .03;
    const struct scene *scene = adviser->scene;
    const struct guided guided = guided_waves(scene);
    const double error = guided_error(scene, &guided);
    if (!(error > little)) return;
    advise(adviser,
           "absorbing layers send back waves that faces %s and %s guide: velocities may err by %g of the "
           "largest from about t = %.3g on, by %.2g at the end, mostly by half of that or less; sides "
           "farther from what acts and is looked at would be right",
           face_name((enum face)(2 * guided.axis)), face_name((enum face)(2 * guided.axis + 1)), little,
           guided_since(scene, &guided, little), error);
}

/* Layers beside ground of more contrast than they were measured at (doc/theory/absorbing-faces.md, section 4). */
void look_at_contrast(struct adviser *adviser)
{
    static const double measured = 10;
    const struct scene *scene = adviser->scene;
    const double contrast = ground_contrast(scene);
    for (int face = 0; face < 2 * scene->dimension && contrast > measured; face++) {
        if (layer_points(scene, face) == 0 || layer_drag(scene, face) == 0) continue;
        advise(adviser,
               "S speeds differ 1 : %.3g, and absorbing layers beside such ground are measured to 1 : %.0f: "
               "beyond, waves that soft ground guides may grow in the layer behind face %s; sides so far off "
               "that nothing comes back by end_time would be right",
               contrast, measured, face_name((enum face)face));
        return;
    }
}

/* Cells between what a load acts on and a face. */
static double cells_to(const struct scene *scene, const struct extent *load, int face)
{
    const struct body *body = &scene->body;
    const int axis = face / 2;
    const double away =
        face % 2 == 0 ? load->low[axis] - body->low[axis] : body->high[axis] - load->high[axis];
    return away / layer_spacing(scene, face);
}

/* Cells of the lattice beyond a load along an axis, on the side that has fewer; 0 where the ground changes along it. */
static double cells_beyond(const struct scene *scene, const struct extent *load, int axis)
{
    double least = INFINITY;
    if (axis == scene->dimension - 1 && body_is_layered(&scene->body)) return 0;
    for (int face = 2 * axis; face < 2 * axis + 2; face++)
        if (!boundary_mirrors(&scene->boundary[face]))
            least = fmin(least, cells_to(scene, load, face) + (double)layer_points(scene, face));
    return least;
}

void look_at_clearance(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    struct extent load;
    for (size_t i = 0; scene_extent(scene, i, &load); i++) {
        double most = 0, least = 0, clearance = 0;
        int worst = -1;
        for (int face = 0; load.dipole && face < 2 * scene->dimension; face++) {
            const double room = cells_beyond(scene, &load, face / 2), cells = cells_to(scene, &load, face);
            const double wanted = layer_clearance(scene, room), left = layer_left_behind(scene, room, cells);
            if (cells > wanted - 1e-6 || left <= most || layer_points(scene, face) == 0) continue;
            most = left;
            least = cells;
            clearance = wanted;
            worst = face;
        }
        if (worst < 0) continue;
        advise(adviser,
               "the moment tensor of load %zu lies %.2g cells from the absorbing layer behind face %s, which "
               "leaves a displacement of up to about %.1g of the largest behind; %.0f cells would be right",
               scene->load[load.index].group + 1, least, face_name((enum face)worst), most, ceil(clearance));
    }
}

void look_at_rests(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    struct rest rest;
    char right[48] = "body%low and body%high farther off";
    if (scene_has_exact(scene) || !worst_rest(scene, &rest) || rest.error < REST_SEEN) return;
    const bool grows = scene->dimension == 2 && scene->load[rest.load].kind != LOAD_MOMENT_TENSOR;
    if (rest.points > 0) snprintf(right, sizeof right, "boundary%%layer_points = %ld", rest.points);
    advise(
        adviser,
        "load %zu stays on, and absorbing layers give way to what stays: by the end displacements%s may err "
        "by %.1g of what is left at receiver '%s'; %s would be right",
        scene->load[rest.load].group + 1, grows ? " and, as these go on growing, velocities" : "", rest.error,
        scene->receiver[rest.receiver].name, right);
}

void look_at_late(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    char right[48] = "body%low and body%high farther off";
    const double error = scene_has_exact(scene) ? 0 : late_error(scene);
    if (error < REST_SEEN) return;
    const long points = late_points(scene);
    if (points > 0) snprintf(right, sizeof right, "boundary%%layer_points = %ld", points);
    advise(
        adviser,
        "absorbing layers give way to what a pulse leaves: by the end displacements may err by %.1g of the "
        "largest; %s would be right",
        error, right);
}
