/* What a scene may be wrong in without being refused: warnings in the plan and the report, each with what
 * would be right (doc/howto/troubleshooting.md). */
#include "advice/parts.h"
#include "scene/absorbing_layers.h"

#include "exact/half_space.h"
#include "scene/ground.h"
#include "scene/resolution.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

void advise(struct adviser *adviser, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (adviser->tell != NULL) adviser->tell(adviser->context, "warning", text);
    adviser->count++;
}

/* Does a velocity or a traction jump? A force all over the body lets accelerations jump and velocities go on. */
static bool front_jumps(const struct scene *scene)
{
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        const bool all_over = load->kind == LOAD_BODY_FORCE && load->shape == LOAD_FACE;
        if (load->amplitude != 0 && !all_over && isinf(history_cutoff(&load->history, SOURCE_COUNTS)))
            return true;
    }
    for (int face = 0; face < FACES; face++)
        if (boundary_acts(&scene->boundary[face]) &&
            isinf(history_cutoff(&scene->boundary[face].history, SOURCE_COUNTS)))
            return true;
    return false;
}

static void look_at_resolution(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    const double spacing = scene->body.spacing, points = points_per_wavelength(scene);
    const double slowest = slowest_speed(scene);
    const bool told = scene_has_exact(scene); /* by the exact solution */
    if (front_jumps(scene) && !scene_driven(scene) && !told && isfinite(slowest) && spacing > 0)
        advise(
            adviser,
            "a history jumps, into waves of all lengths that the points do not carry: velocities ring behind "
            "fronts by about a tenth, whatever the spacing; smoothing = %.3g would be right",
            1.01 * jump_smoothing(FEWEST_POINTS * spacing / slowest));
    const bool chosen =
        scene->accuracy > 0 && scene->snapshots == 0 && scene->profiles == 0; /* for the receivers */
    if (points > 0.0 && points < FEWEST_POINTS && !chosen)
        advise(
            adviser,
            "%.3g points per wavelength of the slowest wave at the source's cutoff%s; %g need body%%spacing "
            "= %.3g or a smoother history",
            points, scene_loads_move(scene) ? ", ahead of what moves" : "", FEWEST_POINTS,
            spacing * points / FEWEST_POINTS);
}

/* Nearly incompressible bodies of few points across are too stiff in bending and shear. Measured: frequency
 * of a beam in plane strain, L = 5 W, 5 and 10 points across, against degree 4 (doc/howto/troubleshooting.md). */
static void look_at_stiff_bodies(struct adviser *adviser)
{
    static const double nearly = 0.45;
    const struct scene *scene = adviser->scene;
    const struct material *stiff = &scene->material[0];
    for (size_t m = 1; m < scene->materials; m++)
        if (scene->material[m].poisson > stiff->poisson) stiff = &scene->material[m];
    if (scene->dimension == 1 || (scene->dimension == 2 && scene->plane == PLANE_STRESS) ||
        stiff->poisson <= nearly)
        return;
    advise(adviser,
           "material '%s' has nu = %.4g, near 0.5, where bodies of few points across are too stiff: 5 "
           "across, a beam's "
           "frequency is .01 too high at nu = .49 and .04 at .499 by variant 'consistent', .05 and .2 by "
           "'total-lagrangian', .2 and .3 by 'cloud'; variant = 'consistent' with degree = 3 (.004, .014), "
           "or finer points, would be "
           "right",
           stiff->name, stiff->poisson);
}

/* What a load sends in rock that is nearly incompressible: the splines' strains of S waves change its volume a little,
 * which M / mu makes much of. Measured in the plane, in even ground (regress/studies/blocks BUILD incompressible). */
static void look_at_volumes(struct adviser *adviser)
{
    static const double seen = .05, of_moments = 3, of_forces = 1.7;
    const struct scene *scene = adviser->scene;
    const double points = points_per_wavelength(scene);
    double worst = 0, nu = 0;
    size_t which = 0;
    if (strcmp(scene->method.variant, "consistent") != 0 || scene->dimension == 1 || !(points > 0) ||
        (scene->dimension == 2 && scene->plane == PLANE_STRESS) || scene_has_exact(scene))
        return;
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        double place[3] = {0, 0, 0};
        if (load->shape == LOAD_FACE || load->amplitude == 0) continue;
        ground_from_deck(&scene->body, load->centre, place);
        const struct rock rock = ground_at(scene, place);
        const double here = points * sqrt(rock.mu / rock.density) / slowest_speed(scene);
        const double law = load->kind == LOAD_MOMENT_TENSOR ? of_moments : of_forces,
                     error = law * (rock.lambda + 2 * rock.mu) / rock.mu / pow(here, 4);
        if (!(rock.lambda > 2 * rock.mu) || error <= worst) continue;
        worst = error;
        nu = rock.lambda / (2 * (rock.lambda + rock.mu));
        which = load->group + 1;
    }
    if (worst > seen)
        advise(adviser,
               "load %zu acts in rock of nu = %.3g, where volumes that the splines change a little let "
               "velocities err "
               "by up to about %.2g; body%%spacing = %.3g would be right",
               which, nu, fmin(1, worst), scene->body.spacing * pow(seen / 2 / worst, .25));
}

static void look_at_incompressible(struct adviser *adviser)
{
    look_at_stiff_bodies(adviser);
    look_at_volumes(adviser);
    look_at_pressures(adviser);
}

/* A moment tensor pulls at one point's neighbours: by gradients of total-Lagrangian points it is coarse
 * (doc/theory/sources.md). */
static void look_at_moments(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    bool moment = false;
    for (size_t k = 0; k < scene->loads; k++)
        moment = moment || scene->load[k].kind == LOAD_MOMENT_TENSOR;
    if (!moment || strcmp(scene->method.variant, "total-lagrangian") != 0) return;
    advise(adviser,
           "moment tensors on total-Lagrangian points were .4 to 5 wrong (.13 to 1.4 with gradient = "
           "'central') at 4 "
           "points per wavelength; method%%name = 'smoothed-point', variant = 'consistent', would be right");
}

static void look_at_step(struct adviser *adviser, const struct stepper *stepper)
{
    static const double smallest = 0.1;
    const double part = stepper->dt / stepper->limit;
    if (stepper->limit > 0.0 && isfinite(stepper->limit) && part < smallest)
        advise(adviser,
               "the time step is only %.2g of the stability limit %.3g: %.0f times the steps that are "
               "needed; leave stepping%%time_step and courant out",
               part, stepper->limit, 0.9 / part);
}

static void look_at_receivers(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    const struct body *body = &scene->body;
    for (size_t r = 0; r < scene->receivers; r++)
        for (int face = 0; face < 2 * scene->dimension; face++) {
            if (!boundary_absorbs(&scene->boundary[face])) continue;
            double place[3];
            body_from_deck(body, scene->receiver[r].position, place);
            const double depth = fabs(place[face_axis((enum face)face)] - face_plane(body, (enum face)face));
            if (depth < 0.999 * layer_spacing(scene, face))
                advise(adviser,
                       "receiver '%s' lies at the absorbing face %s and sees what it does to waves; two "
                       "spacings (%.3g) inside it would not",
                       scene->receiver[r].name, face_name((enum face)face), 2.0 * layer_spacing(scene, face));
        }
}

bool has_patch(const struct load *load)
{
    return load->kind == LOAD_TRACTION && (load->shape == LOAD_SQUARE || load->shape == LOAD_DISC);
}

double half_size(const struct load *load, int axis)
{
    if (load->shape == LOAD_DISC) return axis == face_axis(load->face) ? 0.0 : 0.5 * load->size[0];
    int place = 0;
    for (int c = 0; c < axis; c++)
        place += c != face_axis(load->face);
    return axis == face_axis(load->face) ? 0.0 : 0.5 * load->size[place];
}

/* Tractions on an absorbing face, and forces and moments right behind it. */
static void look_at_absorbers(struct adviser *adviser, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    double centre[3];
    if (load->kind == LOAD_TRACTION) {
        if (boundary_absorbs(&scene->boundary[load->face]))
            advise(adviser,
                   "load %zu acts on the absorbing face %s, which takes up part of it; a free face would not",
                   scene->load[k].group + 1, face_name(load->face));
        return;
    }
    body_from_deck(&scene->body, load->centre, centre);
    for (int face = 0; face < 2 * scene->dimension && load->shape == LOAD_POINT; face++) {
        const double depth =
            fabs(centre[face_axis((enum face)face)] - face_plane(&scene->body, (enum face)face));
        if (boundary_absorbs(&scene->boundary[face]) && depth < 1.999 * layer_spacing(scene, face) &&
            !(load->kind == LOAD_MOMENT_TENSOR && layer_points(scene, face) > 0)) /* told of in layers.c */
            advise(adviser,
                   "load %zu acts at the absorbing face %s, which takes up part of it; two spacings (%.3g) "
                   "inside it "
                   "would not",
                   scene->load[k].group + 1, face_name((enum face)face), 2.0 * layer_spacing(scene, face));
    }
}

/* On the Mach lines of the Rayleigh wave displacements have kinks and velocities poles (doc/theory/sources.md, Eq
 * 11). */
static bool outruns_rayleigh(struct adviser *adviser, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    double centre[3] = {0}, speed = 0.0;
    for (int axis = 0; axis < 3; axis++)
        speed = hypot(speed, load->velocity[axis]);
    if (load->kind != LOAD_TRACTION || speed <= 0.0) return false;
    ground_from_deck(&scene->body, load->centre, centre);
    const struct rock rock = ground_at(scene, centre);
    struct half_space ground;
    half_space_set(&ground, rock.density, rock.lambda, rock.mu);
    if (!(speed > ground.rayleigh_speed)) return false;
    advise(
        adviser,
        "load %zu moves at %.4g, faster than the Rayleigh wave (%.4g): its Mach lines have velocities that "
        "no spacing resolves; compare displacements, or velocities through a window of some spacings, or "
        "move it slower",
        scene->load[k].group + 1, speed, ground.rayleigh_speed);
    return true;
}

size_t advice_tell(const struct scene *whole, const struct stepper *stepper,
                   void (*tell)(void *context, const char *key, const char *value), void *context)
{
    struct scene deck = *whole; /* the pieces of a host's load are one load */
    const struct scene *scene = &deck;
    struct adviser adviser = {scene, tell, context, 0};
    deck.loads = scene_deck_loads(whole);
    look_at_resolution(&adviser);
    look_at_short_waves(&adviser, stepper->model);
    look_at_cut_start(&adviser);
    look_at_impact(&adviser);
    look_at_time_error(&adviser, stepper);
    look_at_method(&adviser, stepper->model);
    look_at_long_way(&adviser, stepper->model);
    look_at_incompressible(&adviser);
    look_at_moments(&adviser);
    look_at_step(&adviser, stepper);
    look_at_nothing(&adviser);
    look_at_idle_words(&adviser, stepper);
    look_at_tables(&adviser, stepper);
    look_at_ligament(&adviser);
    look_at_voids(&adviser, stepper->model);
    for (size_t k = 0; k < scene->loads; k++)
        if (has_patch(&scene->load[k])) look_at_points(&adviser, stepper->model, k);
    look_at_mirrors(&adviser);
    look_at_meetings(&adviser);
    look_at_receivers(&adviser);
    look_at_beyond(&adviser);
    for (size_t k = 0; k < scene->loads; k++)
        look_at_absorbers(&adviser, k);
    if (!body_is_box(&scene->body)) return adviser.count;
    look_at_nearness(&adviser);
    look_at_interfaces(&adviser);
    look_at_fields(&adviser);
    look_at_crossed_rock(&adviser);
    look_at_ringing_body(&adviser);
    look_at_cut_moment(&adviser);
    look_at_layers(&adviser, stepper);
    look_at_guided(&adviser);
    look_at_contrast(&adviser);
    look_at_clearance(&adviser);
    look_at_shallow(&adviser, stepper->model);
    look_at_rests(&adviser);
    look_at_late(&adviser);
    look_at_weights(&adviser);
    look_at_walls(&adviser);
    look_at_stacks(&adviser);
    look_at_soft_layers(&adviser);
    look_at_covers(&adviser);
    look_at_damped_cells(&adviser);
    look_at_columns(&adviser);
    look_at_fallen_layers(&adviser);
    look_at_levelled(&adviser);
    look_at_smoothed(&adviser);
    look_at_tilted(&adviser);
    look_at_grading(&adviser);
    for (size_t k = 0; k < scene->loads; k++)
        if (!outruns_rayleigh(&adviser, k)) look_at_passed(&adviser, k);
    return adviser.count;
}
