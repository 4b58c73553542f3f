/* SW4's rfile: binary, in either order of bytes. Integers magic = 1, bytes of a number, attenuation; reals
 * azimuth of x, longitude, latitude; a projection's text with its length; the number of blocks; of each block the
 * steps along the surface and over depth, the depth z0 below the sea of its first values, and integers components,
 * ni, nj, nk. Then the blocks' numbers, [ni][nj][nk][components]: the first block the elevation of the ground, the
 * others density, p_speed, s_speed (and q_p, q_s), -999 in air, s_speed -999 in water (SW4 User's Guide, file
 * formats). Depths of the body are those below the ground, or below the sea; air and water take what is below
 * them, as SW4 does. */
#include "base/memory.h"
#include "scene/model_file.h"

#include <errno.h>
#include <math.h>
#include <string.h>

enum { MOST_BLOCKS = 100 };

struct block {
    double step[2], top;
    int components;
    size_t n[3];
    off_t from; /* of its numbers in the file */
};

struct rfile {
    struct model_source *source;
    FILE *file;
    bool swapped;
    size_t bytes; /* of a number */
    double azimuth;
    bool damped; /* the file is; */
    int sets;    /* are read */
    size_t blocks;
    struct block block[MOST_BLOCKS];
};

/* Where the values of a block lie that are read. */
struct rows {
    FILE *file;
    bool swapped;
    size_t bytes;       /* of a number */
    unsigned char *row; /* of a column's numbers */
    struct block block;
    size_t first[3];
    int sets;
};

static void swap(void *number, size_t bytes)
{
    unsigned char *byte = number;
    for (size_t i = 0; i < bytes / 2; i++) {
        const unsigned char kept = byte[i];
        byte[i] = byte[bytes - 1 - i];
        byte[bytes - 1 - i] = kept;
    }
}

static bool read_number(const struct rfile *rfile, void *number, size_t bytes)
{
    if (fread(number, bytes, 1, rfile->file) != 1) return false;
    if (rfile->swapped) swap(number, bytes);
    return true;
}

static bool read_integers(const struct rfile *rfile, int *value, int count)
{
    for (int i = 0; i < count; i++)
        if (!read_number(rfile, &value[i], sizeof value[i])) return false;
    return true;
}

static bool read_reals(const struct rfile *rfile, double *value, int count)
{
    for (int i = 0; i < count; i++)
        if (!read_number(rfile, &value[i], sizeof value[i]) || !isfinite(value[i])) return false;
    return true;
}

static bool read_head(struct rfile *rfile)
{
    int start[3], length = 0, blocks = 0;
    double place[3];
    unsigned char first = 0;
    if (fread(&first, 1, 1, rfile->file) != 1) return false;
    const int one = 1;
    rfile->swapped = first != *(const unsigned char *)&one;
    rewind(rfile->file);
    if (!read_integers(rfile, start, 3) || !read_reals(rfile, place, 3) ||
        !read_integers(rfile, &length, 1) || length < 0 || fseeko(rfile->file, length, SEEK_CUR) != 0 ||
        !read_integers(rfile, &blocks, 1))
        return false;
    if ((start[1] != 4 && start[1] != 8) || blocks < 2 || blocks > MOST_BLOCKS) return false;
    rfile->bytes = (size_t)start[1];
    rfile->sets = model_sets(rfile->source, start[2] == 1);
    rfile->damped = start[2] == 1;
    rfile->azimuth = place[0];
    rfile->blocks = (size_t)blocks;
    return true;
}

/* Heads of the blocks; the file must be as long as they say. */
static bool read_block_heads(struct rfile *rfile)
{
    double from = 0;
    for (size_t b = 0; b < rfile->blocks; b++) {
        struct block *block = &rfile->block[b];
        double real[3];
        int n[4];
        if (!read_reals(rfile, real, 3) || !read_integers(rfile, n, 4)) return false;
        if (n[0] != (b == 0 ? 1 : rfile->damped ? 5 : 3) || n[1] < 2 || n[2] < 2 || n[3] < (b == 0 ? 1 : 2))
            return model_fault(rfile->source,
                               "block %zu has %d components and %d x %d x %d values; expected 1 of the "
                               "elevation, then 3 or, with attenuation, 5, and at least 2 values along each "
                               "axis",
                               b + 1, n[0], n[1], n[2], n[3]);
        *block = (struct block){
            {real[0], real[1]}, real[2], n[0], {(size_t)n[1], (size_t)n[2], b == 0 ? 1 : (size_t)n[3]}, 0};
        block->from = (off_t)from;
        from += (double)rfile->bytes * n[0] * n[1] * n[2] * n[3];
        if (from > 1e18) return false;
    }
    const off_t head = ftello(rfile->file);
    if (head < 0 || fseeko(rfile->file, 0, SEEK_END) != 0) return false;
    const double size = (double)ftello(rfile->file);
    for (size_t b = 0; b < rfile->blocks; b++)
        rfile->block[b].from += head;
    if (size == (double)head + from) return true;
    return model_fault(rfile->source, "it has %.15g bytes; its blocks need %.15g: cut short, or no rfile",
                       size, (double)head + from);
}

/* One of a row's numbers. */
static double number_at(const struct rows *rows, size_t i)
{
    double number;
    float single;
    unsigned char byte[8];
    memcpy(byte, rows->row + i * rows->bytes, rows->bytes);
    if (rows->swapped) swap(byte, rows->bytes);
    memcpy(&number, byte, sizeof number);
    memcpy(&single, byte, sizeof single);
    return rows->bytes == 4 ? (double)single : number;
}

static bool read_column(const struct rows *rows, const struct model_grid *box, const size_t first[3],
                        size_t i, size_t j)
{
    const struct block *block = &rows->block;
    const size_t components = (size_t)block->components, count = box->n[2] * components;
    const size_t at = (((first[0] + i) * block->n[1] + first[1] + j) * block->n[2] + first[2]) * components;
    if (fseeko(rows->file, block->from + (off_t)(at * rows->bytes), SEEK_SET) != 0 ||
        fread(rows->row, rows->bytes, count, rows->file) != count)
        return false;
    for (size_t k = 0; k < box->n[2]; k++)
        for (int set = 0; set < rows->sets; set++)
            box->value[set][(i * box->n[1] + j) * box->n[2] + k] =
                number_at(rows, k * components + (size_t)set);
    return true;
}

static bool read_rows(void *context, const struct model_grid *box, const size_t from[3])
{
    struct rows *rows = context;
    size_t first[3];
    bool good = true;
    for (int axis = 0; axis < 3; axis++)
        first[axis] = rows->first[axis] + from[axis];
    for (size_t i = 0; i < box->n[0] && good; i++)
        for (size_t j = 0; j < box->n[1] && good; j++)
            good = read_column(rows, box, first, i, j);
    if (good && rows->sets == MODEL_SETS) model_no_quality(box);
    return good;
}

static void close_rows(void *context)
{
    struct rows *rows = context;
    if (rows == NULL) return;
    if (rows->file != NULL) fclose(rows->file);
    array_free(rows->row);
    array_free(rows);
}

static struct rows *open_rows(const struct rfile *rfile, const struct block *block, const size_t first[3],
                              size_t column)
{
    struct rows *rows = scene_array(rfile->source->builder, 1, sizeof *rows);
    if (rows == NULL) return NULL;
    rows->swapped = rfile->swapped;
    rows->bytes = rfile->bytes;
    rows->block = *block;
    rows->sets = block->components == 1 ? 1 : rfile->sets;
    memcpy(rows->first, first, sizeof rows->first);
    rows->row = scene_array(rfile->source->builder, column * (size_t)block->components, rfile->bytes);
    rows->file = fopen(rfile->source->path, "rb");
    if (rows->file != NULL && rows->row != NULL) return rows;
    if (rows->file == NULL) model_fault(rfile->source, "cannot read it: %s", strerror(errno));
    close_rows(rows);
    return NULL;
}

static bool read_block(struct rfile *rfile, const struct block *block, struct model_grid *grid)
{
    struct model_source *source = rfile->source;
    size_t first[3] = {0};
    for (int axis = 0; axis < 2; axis++)
        if (!model_even_part(source, grid, axis, 0, block->step[0], block->n[axis], &first[axis]) ||
            !model_covers(source, axis, 0, block->step[0] * (double)(block->n[axis] - 1)))
            return false;
    const bool solid = block->components > 1;
    if (solid && !model_even_part(source, grid, 2, block->top, block->step[1], block->n[2], &first[2]))
        return false;
    if (!model_room(source, grid, solid ? rfile->sets : 1)) return false;
    struct rows *rows = open_rows(rfile, block, first, grid->n[2]);
    if (rows == NULL) return false;
    const struct model_origin origin = {read_rows, close_rows, rows, rows->sets, NULL};
    if (grid->value[0] == NULL) {
        if (model_pieces_new(grid, &origin)) return true;
        complain_of_memory(source->builder);
        close_rows(rows);
        return false;
    }
    const bool good = read_rows(rows, grid, (const size_t[3]){0});
    close_rows(rows);
    return good || model_unread(source);
}

static bool read_surface(struct rfile *rfile)
{
    struct model_source *source = rfile->source;
    struct model_grid *surface = &source->model->surface[0];
    if (!read_block(rfile, &rfile->block[0], surface)) return false;
    double *value = surface->value[0];
    for (size_t i = 0; i < surface->n[0]; i++)
        for (size_t j = 0; j < surface->n[1]; j++, value++) {
            *value = -*value;
            if (!(fabs(*value) < 1e6))
                return model_fault(source, "the elevation of the ground is %g at (%g, %g)", -*value,
                                   surface->at[0][i], surface->at[1][j]);
        }
    double least = 0, greatest = 0;
    model_extremes(surface, &least, &greatest);
    source->range[2][0] += source->model->sea ? source->model->shift : least;
    source->range[2][1] += source->model->sea ? source->model->shift : greatest;
    snprintf(source->model->text, sizeof source->model->text,
             "rfile of %zu blocks, x points %.6g degrees from north, ground %.6g to %.6g above the sea; "
             "depth 0 is ",
             rfile->blocks - 1, rfile->azimuth, -greatest, -least);
    model_tell_depth(source->model, "its ground, to which the blocks below are shifted");
    const struct block *top = &rfile->block[1], *end = &rfile->block[rfile->blocks - 1];
    return model_covers(source, 2, top->top, end->top + end->step[1] * (double)(end->n[2] - 1));
}

bool model_read_rfile(struct model_source *source, FILE *file)
{
    struct rfile rfile = {.source = source, .file = file};
    const selas_status before = source->builder->status;
    source->si = true;
    source->none = -999;
    source->model->sea = source->model->sea || source->below_sea;
    if (!read_head(&rfile) || !read_block_heads(&rfile)) {
        if (source->builder->status != before) return false;
        return model_fault(source, "it begins as SW4's rfiles do, but its head is cut short or wrong");
    }
    const struct model_axes axes = {.bearing = rfile.azimuth, .coordinates = 2};
    source->model->depth = MODEL_BELOW;
    if (!model_place(source, &axes) || !model_grids(source, rfile.blocks - 1, 1) || !read_surface(&rfile))
        return false;
    for (size_t b = 1; b < rfile.blocks; b++)
        if (!read_block(&rfile, &rfile.block[b], &source->model->grid[b - 1]) || !model_meets(source, b - 1))
            return false;
    return true;
}
