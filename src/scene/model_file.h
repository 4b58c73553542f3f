/* Inside of reading a model of the ground from a file (doc/reference/models.md): model_file.c (which
 * format, where the deck's place is, what is checked), model_grid.c (values between those of a grid),
 * model_plain.c, model_text.c, model_rfile.c, model_sfile.c, model_blocks.c (the formats), model_set.c (what
 * those in HDF5 share), model_quality.c (Q). */
#ifndef SELAS_SCENE_MODEL_FILE_H
#define SELAS_SCENE_MODEL_FILE_H

#include "scene/build.h"
#include "scene/ground.h"
#include "scene/model_pieces.h"

#include <hdf5.h>
#include <stdio.h>

/* A file while it is read. */
struct model_source {
    struct builder *builder;
    const struct deck_group *group;
    const char *path;
    struct ground_model *model;
    double range[3][2]; /* what the body needs along the model's own axes (model_place(), the reader) */
    bool si;            /* speeds in m/s and densities in kg/m^3, by the format */
    bool below_sea;     /* formats that know their ground: read it with depth = 'sea' */
    double none;        /* s_speed of air and water is at most that; NAN: there is none (the reader) */
    size_t filled;      /* values of air or water that took those of the rock below */
    double kept;        /* bytes of values that are kept whole */
    double whole[3][2]; /* first and last place in the file along each axis of the last grid */
    double end;         /* model_meets() */
};

/* Complains of the file; false. */
bool model_fault(const struct model_source *source, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

/* How the axes of a file lie. */
struct model_axes {
    int north;          /* 0 or 1: the axis nearest to north; the other one points to the right of it */
    double bearing;     /* of that axis [degrees, clockwise from north] */
    double from[2];     /* place of the axes' origin in the coordinates that model%origin is in, which ... */
    bool turned;        /* ... lie north (else as the axes do) */
    double corner[2];   /* where x = y = 0 of the deck lies without model%origin, along the axes */
    size_t coordinates; /* of model%origin: 2, or 3 where the depth may be shifted */
};
/* Where the body lies: fills origin and turn of the model and range[0], range[1]. False after complaining. */
bool model_place(struct model_source *source, const struct model_axes *axes);
/* Complains if the model, which reaches from `low` to `high` along an axis, does not cover the range. */
bool model_covers(const struct model_source *source, int axis, double low, double high);

/* Complains unless grid i, the last one of which the places are known, begins at the end of grid i - 1. */
bool model_meets(struct model_source *source, size_t i);

/* Says whether the file has q_p and q_s (model_quality.c): how many sets of values are to be read of each grid. */
int model_sets(struct model_source *source, bool damped);
/* Brings Q that is none to 0 in a grid, or a box of one, that has Q. */
void model_no_quality(const struct model_grid *box);
/* Looks at Q of all grids; false after complaining. */
bool model_quality(struct model_source *source);

/* Adds `count` grids or surfaces; false after complaining. */
bool model_grids(struct model_source *source, size_t grids, size_t surfaces);
/* Places of a grid along an axis: those of `count` in the file that the range needs (rising; the first one's
 * index to *first). */
bool model_part(struct model_source *source, struct model_grid *grid, int axis, const double *place,
                size_t count, size_t *first);
bool model_even_part(struct model_source *source, struct model_grid *grid, int axis, double from, double step,
                     size_t count, size_t *first);
/* Room for the values when the places are known: those of the first `sets` that have none. Values of large grids get
 * none: they are read in pieces. */
bool model_room(struct model_source *source, struct model_grid *grid, int sets);
/* In every column from the top values of air and water become those of the first rock below, also in the grid below;
 * false after complaining. */
bool model_fill(struct model_source *source);
/* Complains of values that cannot be read; false. */
bool model_unread(const struct model_source *source);
/* Ends the model's text with where depth 0 is: an elevation, or `ground`. */
void model_tell_depth(struct ground_model *model, const char *ground);
/* Least and greatest value of a surface. */
void model_extremes(const struct model_grid *surface, double *least, double *greatest);
/* model_grid.c: the first `sets` values at a place along the grid's axes. */
void model_grid_at(const struct model_grid *grid, const double place[3], int sets, double *value);

/* model_set.c: attributes of a file, group or data set. */
bool model_numbers(hid_t place, const char *name, size_t count, double *value);
/* A text, or the i-th of several, without blanks at its end, cut to `size`. */
bool model_word(hid_t place, const char *name, size_t i, char *text, size_t size);
/* Extent of a data set of at most 4 axes; 0 if it has more. */
int model_extent(hid_t set, size_t extent[4]);
/* Reads part of a data set: n values from `first` on along each of the first axes, `component` along the next one. */
bool model_read_part(hid_t set, int axes, const size_t n[3], const size_t first[3], size_t component,
                     double *value);
/* Takes values of set `set` of a grid of `sets` from part of a data set, times a factor: reads them, or keeps the data
 * set for reading them in pieces. */
struct model_column {
    hid_t set;
    size_t component;
    double factor;
};
bool model_take(struct model_grid *grid, int sets, int set, const struct model_column *column,
                const size_t first[3]);

/* The formats: each reads all that the model is but its frame. False after complaining. */
bool model_read_plain(struct model_source *source, hid_t file);
bool model_read_sfile(struct model_source *source, hid_t file);
bool model_read_blocks(struct model_source *source, hid_t file);
bool model_read_rfile(struct model_source *source, FILE *file);
bool model_read_text(struct model_source *source, FILE *file);

#endif
