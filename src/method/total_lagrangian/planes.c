/* Which points of the body a rank makes (doc/developers/ranks.md). Those of a lattice are made in planes over the last
 * axis, `step` apart: the own ones o .. o' - 1 of n, and as many about them as the rows need that forces on the own
 * points take. A row reaches over r planes, one of pairs over p, and rows of lattice points that are L or more away
 * from both ends of the body are alike,
 *
 *   r = ceil((1.5 kernel radius + 2 jitter) / step),   p = ceil((1.6 spacing + 2 jitter) / step),
 *   L = 2 (1 + ceil(1.5 kernel radius / least step of the axes)),                                         (R5)
 *
 * 1.5 radii being the most that a fit may widen to, `spacing` the largest (volume of a point)^(1/dimension), jitter in
 * lengths. With f = min(o, n - L - 1) on a lattice, f = o else, are made
 *
 *   transposed rows of f .. o' - 1,   rows of gradients of f - r - p .. o' - 1 + r + p,
 *   rows of pairs of f - r - b .. o' - 1 + r + b,   b = 1 + floor(64 / points of a plane),                 (R6)
 *   points of f - e .. o' - 1 + e,   e = 2 r + max(p, b) + 2 + cloud_margin(),                             (R7)
 *
 * S and G of (R3) and, for pairs, one block of points beyond; with all neighbours of points with rows, and a plane
 * below the first one with rows. In one process nearly every lattice point has the row of the point below; a row of its
 * own would differ by rounding. So a part that begins further up makes the L + 2 r + 2 first planes besides, and takes
 * the rows of plane L for those of the plane below its first ones. Other points are made by every rank. */
#include "method/total_lagrangian/setup.h"

#include "base/memory.h"
#include "parallel/few_ranks.h"

#include <math.h>

static double one(const void *context, size_t place)
{
    (void)context;
    (void)place;
    return 1;
}

/* Deals out `planes` of part->plane points each. */
static selas_status deal(struct tl_model *tl, size_t planes, struct messages *messages)
{
    struct tl_part *part = &tl->part;
    const selas_status status = ranks_at_most(part->ranks, planes, "planes over its last axis", messages);
    if (status != SELAS_OK) return status;
    const size_t ranks = (size_t)ranks_count(part->ranks);
    part->bound = array_new(ranks + 1, sizeof *part->bound);
    if (part->bound == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
    ranks_deal(planes, one, NULL, ranks, part->bound);
    for (size_t r = 0; r <= ranks; r++)
        part->bound[r] *= part->plane; /* of points */
    return SELAS_OK;
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
static struct tl_range points_in(const struct tl_model *tl, const size_t grid[3], ptrdiff_t first,
                                 struct planes planes)
{
    const ptrdiff_t last = (ptrdiff_t)grid[tl->model.scene->dimension - 1], plane = (ptrdiff_t)tl->part.plane;
    if (planes.from < first || first == 0) planes.from = first;
    if (planes.end > last) planes.end = last;
    return (struct tl_range){(size_t)((planes.from - first) * plane), (size_t)((planes.end - first) * plane)};
}

/* Volume^(1/dimension) of the points of a lattice. */
static double even_spacing(const struct scene *scene, const size_t grid[3])
{
    double volume = 1;
    for (int c = 0; c < scene->dimension; c++)
        volume *= (scene->body.high[c] - scene->body.low[c]) / (double)grid[c];
    return pow(volume, 1.0 / scene->dimension);
}

/* Of points of even spacing, or of the largest that any has, the numbers of planes that rows reach over. */
struct reaches {
    ptrdiff_t row, pair, layers, block;
};

static struct reaches reaches_of(const struct tl_model *tl, const size_t grid[3], double spacing)
{
    const struct scene *scene = tl->model.scene;
    const int last = scene->dimension - 1;
    const double step = (scene->body.high[last] - scene->body.low[last]) / (double)grid[last];
    const double radius = (1 + 1e-9) * 1.5 * tl_reach(&tl->options) * spacing;
    const double moved = 2 * scene->body.jitter * scene->body.spacing; /* two points, towards each other */
    const ptrdiff_t pair = (ptrdiff_t)ceil((tl_pair_radius(spacing) + moved) / step);
    const ptrdiff_t search = (ptrdiff_t)ceil((radius + moved) / step);
    return (struct reaches){.row = search > pair ? search : pair,
                            .pair = pair,
                            .layers = 2 * (ptrdiff_t)tl_layers_within(scene, grid, radius),
                            .block = TL_LONGEST_BLOCK / (ptrdiff_t)tl->part.plane + 1};
}

/* Planes that are made on either side of the own ones (Eq. R7). */
static ptrdiff_t beside(const struct scene *scene, const struct reaches *by)
{
    return 2 * by->row + (by->pair > by->block ? by->pair : by->block) + 2 + (ptrdiff_t)cloud_margin(scene);
}

/* Chooses which rows are made (Eqs R5 to R7); returns the planes of the part. */
static struct planes choose(struct tl_model *tl, const size_t grid[3], struct planes own)
{
    struct tl_part *part = &tl->part;
    const struct scene *scene = tl->model.scene;
    const double spacing = part->spacing > 0 ? part->spacing : even_spacing(scene, grid);
    const struct reaches by = reaches_of(tl, grid, spacing);
    const ptrdiff_t planes = (ptrdiff_t)grid[scene->dimension - 1];
    const bool even = !(scene->body.jitter > 0), at_top = own.from >= planes - by.layers;
    const struct planes force = {even && at_top ? planes - by.layers - 1 : own.from, own.end};
    const struct planes gradient = about(force, by.row + by.pair), pair = about(force, by.row + by.block);
    const struct planes all = about(force, beside(scene, &by));
    /* are the rows of its first plane those of planes below it? */
    const bool begins = even ? all.from + by.row < by.layers + 2 : all.from < 0;
    const ptrdiff_t first = begins ? 0 : all.from;
    part->gradient = points_in(tl, grid, first, gradient);
    part->transposed = points_in(tl, grid, first, force);
    part->pair = points_in(tl, grid, first, pair);
    part->reach = begins || !even ? 0 : (size_t)by.row;
    part->layers = begins || !even ? 0 : (size_t)by.layers;
    return (struct planes){first, all.end < planes ? all.end : planes};
}

/* Together, whatever the status so far: the largest spacing of points with jitter. */
static selas_status find_spacing(struct tl_model *tl, const size_t grid[3], struct planes own,
                                 selas_status status, struct messages *messages)
{
    struct tl_part *part = &tl->part;
    const struct scene *scene = tl->model.scene;
    const ptrdiff_t planes = (ptrdiff_t)grid[scene->dimension - 1], plane = (ptrdiff_t)part->plane;
    const struct planes more = about(own, (ptrdiff_t)cloud_margin(scene));
    const size_t from = more.from > 0 ? (size_t)more.from : 0;
    const size_t end = (size_t)(more.end < planes ? more.end : planes);
    struct cloud *cloud = NULL;
    if (status == SELAS_OK) status = cloud_create_planes(scene, from, end, &cloud, messages);
    status = tl_agree(tl, status, messages);
    double spacing = 0;
    for (ptrdiff_t i = own.from * plane; status == SELAS_OK && cloud != NULL && i < own.end * plane; i++)
        spacing = fmax(spacing, pow(cloud->volume[(size_t)i - cloud->first], 1.0 / scene->dimension));
    if (status == SELAS_OK) ranks_largest(part->ranks, 1, &spacing);
    part->spacing = spacing;
    cloud_free(&cloud);
    return status;
}

/* Deals out the planes of a lattice and makes the part of this rank. */
static selas_status make_part(struct tl_model *tl, const size_t grid[3], struct messages *messages)
{
    struct tl_part *part = &tl->part;
    const size_t planes = grid[tl->model.scene->dimension - 1], me = (size_t)ranks_me(part->ranks);
    struct planes own = {0, 0};
    selas_status status = deal(tl, planes, messages);
    if (status == SELAS_STOPPED) return status;
    if (status == SELAS_OK)
        own = (struct planes){(ptrdiff_t)(part->bound[me] / part->plane),
                              (ptrdiff_t)(part->bound[me + 1] / part->plane)};
    if (tl->model.scene->body.jitter > 0) status = find_spacing(tl, grid, own, status, messages);
    if (status != SELAS_OK) return status;
    const struct planes all = choose(tl, grid, own);
    return cloud_create_planes(tl->model.scene, (size_t)all.from, (size_t)all.end, &tl->cloud, messages);
}

/* Makes all points; divide.c deals them out when their rows are there. */
static selas_status make_all(struct tl_model *tl, struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    const struct tl_form *form = tl->options.form;
    struct tl_part *part = &tl->part;
    selas_status status =
        form != NULL ? form->points(scene, &tl->cloud, messages) : cloud_create(scene, &tl->cloud, messages);
    if (status != SELAS_OK) return status;
    const size_t n = tl->cloud->points, *grid = tl->cloud->grid;
    part->plane = grid[0] > 0 ? n / grid[tl->cloud->dimension - 1] : 1;
    part->gradient = part->transposed = part->pair = (struct tl_range){0, n};
    return part->ranks != NULL ? ranks_at_most(part->ranks, n, "points", messages) : SELAS_OK;
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
    return longest || grid[last] / (size_t)ranks_count(tl->part.ranks) >= 2 * (size_t)beside(scene, &by);
}

selas_status tl_make_points(struct tl_model *tl, struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    size_t grid[3] = {0};
    bool planes = false;
    if (ranks_count(scene->ranks) > 1) tl->part.ranks = scene->ranks;
    if (tl->part.ranks != NULL && tl->options.form == NULL && cloud_in_planes(scene, grid)) {
        tl->part.plane = grid[0] * grid[1] * grid[2] / grid[scene->dimension - 1];
        planes = tl->part.shared = pays(tl, grid);
    }
    return planes ? make_part(tl, grid, messages) : make_all(tl, messages);
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
    const int last = tl->cloud->dimension - 1;
    const size_t planes = tl->cloud->whole / tl->part.plane;
    return (body->high[last] - body->low[last]) / (double)planes;
}

/* The plane of points that a place is nearest to. */
static size_t plane_of(const struct tl_model *tl, const double place[3])
{
    const struct body *body = &tl->model.scene->body;
    const int last = tl->cloud->dimension - 1;
    const size_t planes = tl->cloud->whole / tl->part.plane;
    const double part = (place[last] - body->low[last]) / (body->high[last] - body->low[last]);
    return (size_t)fmin(fmax(floor(part * (double)planes), 0), (double)planes - 1);
}

int tl_owner(const struct tl_model *tl, const double place[3])
{
    const size_t point = plane_of(tl, place) * tl->part.plane;
    int rank = 0;
    while (point >= tl->part.bound[rank + 1])
        rank++;
    return rank;
}

bool tl_owns(const struct tl_model *tl, const double place[3])
{
    return !tl->part.shared || tl_owner(tl, place) == ranks_me(tl->part.ranks);
}
