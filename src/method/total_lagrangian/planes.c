/* Which points of the body a rank makes (doc/developers/ranks.md). Those of a lattice are made in planes over the last
 * axis, `step` apart, those of a file are cut out of all in layers (points/layers.c): the own planes or layers
 * o .. o' - 1 of n, and as many about them as the rows need that forces on the own points take. A row reaches over r
 * planes, one of pairs over p, and rows of lattice points that are L or more away from both ends of the body are alike,
 *
 *   r = ceil((1.5 kernel radius + 2 jitter) / step),   p = ceil((1.6 spacing + 2 jitter) / step),
 *   L = 2 (1 + ceil(1.5 kernel radius / least step of the axes)),                                         (R5)
 *
 * 1.5 radii being the most that a fit may widen to, `spacing` the largest (volume of a point)^(1/dimension), jitter in
 * lengths. With f = min(o, n - L - 1) on a lattice, f = o else, are made
 *
 *   transposed rows of f .. o' - 1,   rows of gradients of f - r - p .. o' - 1 + r + p,
 *   rows of pairs of f - r - b .. o' - 1 + r + b,   b planes have more than 64 points,                     (R6)
 *   points of f - e .. o' - 1 + e,   e = 2 r + max(p, b) + 2 + cloud_margin() of a lattice,                (R7)
 *
 * S and G of (R3) and, for pairs, one block of points beyond; with all neighbours of points with rows, and a plane
 * below the first one with rows. In one process nearly every lattice point has the row of the point below; a row of its
 * own would differ by rounding. So a part that begins further up makes the L + 2 r + 2 first planes besides, and takes
 * the rows of plane L for those of the plane below its first ones. Other points are made by every rank. */
#include "method/total_lagrangian/setup.h"

#include "base/memory.h"
#include "parallel/few_ranks.h"

#include <math.h>

/* Places of the points of all planes. */
static bool number_planes(struct tl_part *part, const size_t *layer_start)
{
    part->start = array_new(part->planes + 1, sizeof *part->start);
    for (size_t p = 0; part->start != NULL && p <= part->planes; p++)
        part->start[p] = layer_start != NULL ? layer_start[p] : p * part->plane;
    return part->start != NULL;
}

/* Planes that have points: the k-th of them for all k, or how many there are (filled NULL). */
static size_t find_filled(const struct tl_part *part, size_t *filled)
{
    size_t count = 0;
    for (size_t p = 0; p < part->planes; p++) {
        if (part->start[p] == part->start[p + 1]) continue;
        if (filled != NULL) filled[count] = p;
        count++;
    }
    return count;
}

struct filled {
    const size_t *start, *plane;
};

static double points_of(const void *context, size_t place)
{
    const struct filled *filled = context;
    return (double)(filled->start[filled->plane[place] + 1] - filled->start[filled->plane[place]]);
}

/* Deals out the planes by their points; each rank has some. */
static selas_status deal(struct tl_model *tl, struct messages *messages)
{
    struct tl_part *part = &tl->part;
    const size_t count = find_filled(part, NULL);
    const char *what = tl->cloud != NULL ? "layers of points" : "planes over its last axis";
    const selas_status status = ranks_at_most(part->ranks, count, what, messages);
    if (status != SELAS_OK) return status;
    const size_t ranks = (size_t)ranks_count(part->ranks);
    size_t *filled = array_new(count, sizeof *filled);
    part->dealt = array_new(ranks + 1, sizeof *part->dealt);
    part->bound = array_new(ranks + 1, sizeof *part->bound);
    const bool room = filled != NULL && part->dealt != NULL && part->bound != NULL;
    if (room) {
        find_filled(part, filled);
        ranks_deal(count, points_of, &(struct filled){part->start, filled}, ranks, part->dealt);
        for (size_t r = 0; r <= ranks; r++) {
            part->dealt[r] = r == 0 ? 0 : r == ranks ? part->planes : filled[part->dealt[r]];
            part->bound[r] = part->start[part->dealt[r]];
        }
    }
    array_free(filled);
    return room ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
}

/* From plane to plane; may begin before the body and end behind it. */
struct planes {
    ptrdiff_t from, end;
};

static struct planes about(struct planes planes, ptrdiff_t more)
{
    return (struct planes){planes.from - more, planes.end + more};
}

/* Points of the part, which begins at plane `first`, in some of the body's planes. */
static struct tl_range points_in(const struct tl_part *part, ptrdiff_t first, struct planes planes)
{
    const ptrdiff_t last = (ptrdiff_t)part->planes;
    if (planes.from < first || first == 0) planes.from = first;
    if (planes.end > last) planes.end = last;
    const size_t before = part->start[first];
    return (struct tl_range){part->start[planes.from] - before, part->start[planes.end] - before};
}

/* Volume^(1/dimension) of the points of a lattice. */
static double even_spacing(const struct scene *scene, const size_t grid[3])
{
    double volume = 1;
    for (int c = 0; c < scene->dimension && c < 3; c++)
        volume *= (scene->body.high[c] - scene->body.low[c]) / (double)grid[c];
    return pow(volume, 1.0 / scene->dimension);
}

/* Planes that a block of points that begins in one ends in or before, wherever it begins. */
static ptrdiff_t planes_of_block(const struct tl_part *part)
{
    size_t most = 1;
    for (size_t from = 0, end = 1; from < part->planes; from++) {
        while (end < part->planes && part->start[end] - part->start[from] <= TL_LONGEST_BLOCK)
            end++;
        if (end - from > most) most = end - from;
    }
    return (ptrdiff_t)most;
}

/* Of points of even spacing, or of the largest that any has, the numbers of planes that rows reach over. */
struct reaches {
    ptrdiff_t row, pair, layers, block;
};

static struct reaches reaches_of(const struct tl_model *tl, const size_t grid[3], double spacing)
{
    const struct scene *scene = tl->model.scene;
    const double step = tl_plane_step(tl);
    const double radius = (1 + 1e-9) * 1.5 * tl_reach(&tl->options) * spacing;
    const double jitter = grid[0] > 0 ? scene->body.jitter * scene->body.spacing : 0;
    const double moved = 2 * jitter; /* two points, towards each other */
    const ptrdiff_t pair = (ptrdiff_t)ceil((tl_pair_radius(spacing) + moved) / step);
    const ptrdiff_t search = (ptrdiff_t)ceil((radius + moved) / step);
    return (struct reaches){.row = search > pair ? search : pair,
                            .pair = pair,
                            .layers = 2 * (ptrdiff_t)tl_layers_within(scene, grid, radius),
                            .block = planes_of_block(&tl->part)};
}

/* Planes that are made on either side of the own ones (Eq. R7). */
static ptrdiff_t beside(const struct scene *scene, const size_t grid[3], const struct reaches *by)
{
    const ptrdiff_t margin = grid[0] > 0 ? (ptrdiff_t)cloud_margin(scene) : 0;
    return 2 * by->row + (by->pair > by->block ? by->pair : by->block) + 2 + margin;
}

/* Chooses which rows are made (Eqs R5 to R7); returns the planes of the part. */
static struct planes choose(struct tl_model *tl, const size_t grid[3])
{
    struct tl_part *part = &tl->part;
    const struct scene *scene = tl->model.scene;
    const size_t *dealt = part->dealt + ranks_me(part->ranks);
    const struct planes own = {(ptrdiff_t)dealt[0], (ptrdiff_t)dealt[1]};
    const double spacing = part->spacing > 0 ? part->spacing : even_spacing(scene, grid);
    const struct reaches by = reaches_of(tl, grid, spacing);
    const ptrdiff_t planes = (ptrdiff_t)part->planes;
    const bool even = grid[0] > 0 && !(scene->body.jitter > 0), at_top = own.from >= planes - by.layers;
    const struct planes force = {even && at_top ? planes - by.layers - 1 : own.from, own.end};
    const struct planes gradient = about(force, by.row + by.pair), pair = about(force, by.row + by.block);
    const struct planes all = about(force, beside(scene, grid, &by));
    /* are the rows of its first plane those of planes below it? */
    const bool begins = even ? all.from + by.row < by.layers + 2 : all.from < 0;
    const ptrdiff_t first = begins ? 0 : all.from;
    part->gradient = points_in(part, first, gradient);
    part->transposed = points_in(part, first, force);
    part->pair = points_in(part, first, pair);
    part->reach = begins || !even ? 0 : (size_t)by.row;
    part->layers = begins || !even ? 0 : (size_t)by.layers;
    return (struct planes){first, all.end < planes ? all.end : planes};
}

/* Together, whatever the status so far: the largest spacing of points with jitter. */
static selas_status find_spacing(struct tl_model *tl, selas_status status, struct messages *messages)
{
    struct tl_part *part = &tl->part;
    const struct scene *scene = tl->model.scene;
    const size_t margin = cloud_margin(scene), *dealt = part->dealt + ranks_me(part->ranks);
    struct cloud *cloud = NULL;
    if (status == SELAS_OK) {
        const size_t from = dealt[0] < margin ? 0 : dealt[0] - margin;
        const size_t end = part->planes - dealt[1] < margin ? part->planes : dealt[1] + margin;
        status = cloud_create_planes(scene, from, end, &cloud, messages);
    }
    status = tl_agree(tl, status, messages);
    double spacing = 0;
    for (size_t i = status == SELAS_OK ? part->start[dealt[0]] : 0;
         status == SELAS_OK && cloud != NULL && i < part->start[dealt[1]]; i++)
        spacing = fmax(spacing, pow(cloud->volume[i - cloud->first], 1.0 / scene->dimension));
    if (status == SELAS_OK) ranks_largest(part->ranks, 1, &spacing);
    part->spacing = spacing;
    cloud_free(&cloud);
    return status;
}

/* Deals out the planes of a lattice and makes the part of this rank. */
static selas_status make_part(struct tl_model *tl, const size_t grid[3], struct messages *messages)
{
    selas_status status = deal(tl, messages);
    if (status == SELAS_STOPPED) return status;
    if (tl->model.scene->body.jitter > 0) status = find_spacing(tl, status, messages);
    if (status != SELAS_OK) return status;
    const struct planes all = choose(tl, grid);
    return cloud_create_planes(tl->model.scene, (size_t)all.from, (size_t)all.end, &tl->cloud, messages);
}

/* All points; divide.c deals them out when their rows are there. */
static selas_status take_all(struct tl_model *tl, struct messages *messages)
{
    struct tl_part *part = &tl->part;
    const size_t n = tl->cloud->points, *grid = tl->cloud->grid;
    part->axis = tl->cloud->axis;
    part->plane = grid[0] > 0 ? n / grid[tl->cloud->dimension - 1] : 1;
    part->planes = n / part->plane;
    part->gradient = part->transposed = part->pair = (struct tl_range){0, n};
    return part->ranks != NULL ? ranks_at_most(part->ranks, n, "points", messages) : SELAS_OK;
}

static selas_status make_all(struct tl_model *tl, struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    const struct tl_form *form = tl->options.form;
    const selas_status status =
        form != NULL ? form->points(scene, &tl->cloud, messages) : cloud_create(scene, &tl->cloud, messages);
    return status == SELAS_OK ? take_all(tl, messages) : status;
}

/* Memory is shared over the planes of a lattice where these are across its longest axis, or where a rank has as many
 * of its own as it makes besides. */
static bool pays(const struct tl_model *tl, const size_t grid[3])
{
    const struct scene *scene = tl->model.scene;
    const size_t last = (size_t)scene->dimension - 1;
    bool longest = true;
    for (size_t c = 0; c < last; c++)
        longest = longest && grid[c] <= grid[last];
    const struct reaches by = reaches_of(tl, grid, even_spacing(scene, grid));
    return longest ||
           grid[last] / (size_t)ranks_count(tl->part.ranks) >= 2 * (size_t)beside(scene, grid, &by);
}

/* Points of a file: all are read by each rank, which keeps its part where that has fewer layers than the body. */
static selas_status make_of_file(struct tl_model *tl, struct messages *messages)
{
    static const size_t no_grid[3] = {0};
    struct tl_part *part = &tl->part;
    const struct scene *scene = tl->model.scene;
    selas_status status = cloud_create(scene, &tl->cloud, messages);
    if (status == SELAS_OK) status = cloud_sort(tl->cloud, &scene->body, messages);
    if (part->ranks == NULL && status == SELAS_OK) return take_all(tl, messages);
    if (part->ranks == NULL) return status;
    if (status == SELAS_OK) {
        part->axis = tl->cloud->axis;
        part->planes = tl->cloud->layers;
        part->plane = 1;
        for (size_t i = 0; i < tl->cloud->points; i++)
            part->spacing = fmax(part->spacing, pow(tl->cloud->volume[i], 1.0 / scene->dimension));
        if (!number_planes(part, tl->cloud->start))
            status = fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
    }
    status = ranks_agree(part->ranks, status, messages);
    if (status != SELAS_OK) return status;
    const struct reaches by = reaches_of(tl, no_grid, part->spacing);
    const size_t ranks = (size_t)ranks_count(part->ranks), ends = ranks > 2 ? 2 : 1;
    part->shared = part->planes / ranks + 1 + ends * (size_t)beside(scene, no_grid, &by) < part->planes;
    if (!part->shared) return take_all(tl, messages);
    status = deal(tl, messages);
    if (status != SELAS_OK) return status;
    const struct planes all = choose(tl, no_grid);
    return cloud_cut(&tl->cloud, &scene->body, (size_t)all.from, (size_t)all.end, messages);
}

selas_status tl_make_points(struct tl_model *tl, struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    struct tl_part *part = &tl->part;
    size_t grid[3] = {0};
    if (ranks_count(scene->ranks) > 1) part->ranks = scene->ranks;
    if (tl->options.form == NULL && scene->body.shape == BODY_POINTS && scene->body.file != NULL)
        return make_of_file(tl, messages);
    if (part->ranks == NULL || tl->options.form != NULL || !cloud_in_planes(scene, grid))
        return make_all(tl, messages);
    part->axis = scene->dimension - 1;
    part->planes = grid[part->axis];
    part->plane = grid[0] * grid[1] * grid[2] / part->planes;
    if (!number_planes(part, NULL)) return fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
    part->shared = pays(tl, grid);
    return part->shared ? make_part(tl, grid, messages) : make_all(tl, messages);
}

selas_status tl_make_beside(const struct tl_model *tl, size_t from, size_t end, struct tl_model **beside,
                            struct messages *messages)
{
    struct tl_model *made = *beside = array_new(1, sizeof *made);
    if (made == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the model");
    made->model.scene = tl->model.scene;
    made->options = tl->options;
    made->part = (struct tl_part){.shared = true, .plane = tl->part.plane};
    const selas_status status = cloud_create_planes(tl->model.scene, from, end, &made->cloud, messages);
    return status == SELAS_OK ? tl_fill_points(made, messages) : status;
}

selas_status tl_make_below(const struct tl_model *tl, struct tl_model **below, struct messages *messages)
{
    const size_t reach = tl->part.reach, planes = tl->part.layers + 2 * reach + 2, plane = tl->part.plane;
    const selas_status status = tl_make_beside(tl, 0, planes, below, messages);
    if (status != SELAS_OK || *below == NULL) return status;
    struct tl_part *part = &(*below)->part;
    part->gradient = part->pair = (struct tl_range){0, (planes - reach) * plane};
    part->transposed = (struct tl_range){0, (planes - 2 * reach) * plane};
    return SELAS_OK;
}

selas_status tl_agree(const struct tl_model *tl, selas_status status, struct messages *messages)
{
    return tl->part.shared ? ranks_agree(tl->part.ranks, status, messages) : status;
}

struct tl_range tl_summed(const struct tl_model *tl)
{
    const size_t *bound = tl->part.bound, me = (size_t)ranks_me(tl->part.ranks), first = tl->cloud->first;
    if (tl->part.shared) return (struct tl_range){bound[me] - first, bound[me + 1] - first};
    return (struct tl_range){0, tl->cloud->points};
}

double tl_sum_in_order(struct tl_model *tl,
                       void (*add)(struct tl_model *tl, const void *context, double *sum),
                       const void *context)
{
    struct ranks *ranks = tl->part.shared ? tl->part.ranks : NULL;
    double sum = 0;
    for (int r = 0; r < ranks_count(ranks); r++) {
        if (r == ranks_me(ranks)) add(tl, context, &sum);
        ranks_spread(ranks, r, &sum, sizeof sum);
    }
    return sum;
}

double tl_plane_step(const struct tl_model *tl)
{
    const struct body *body = &tl->model.scene->body;
    const int axis = tl->part.axis;
    return (body->high[axis] - body->low[axis]) / (double)tl->part.planes;
}

size_t tl_planes_within(const struct tl_model *tl, double radius)
{
    const double planes = radius / tl_plane_step(tl);
    return (size_t)(tl->cloud->all != NULL ? ceil(planes) : 0.5 + planes);
}

int tl_owner(const struct tl_model *tl, const double place[3])
{
    const struct body *body = &tl->model.scene->body;
    const struct tl_part *part = &tl->part;
    const double low = body->low[part->axis], high = body->high[part->axis];
    const double plane = floor((place[part->axis] - low) / (high - low) * (double)part->planes);
    int rank = 0;
    while (rank + 1 < ranks_count(part->ranks) && plane >= (double)part->dealt[rank + 1])
        rank++;
    return rank;
}

bool tl_owns(const struct tl_model *tl, const double place[3])
{
    return !tl->part.shared || tl_owner(tl, place) == ranks_me(tl->part.ranks);
}
